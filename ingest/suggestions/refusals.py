"""What a person has said no to, in a label file: comments, so that it is not asked again and who said so is kept.

A comment is one line, ``# not: {"nodes": {"/camera": {"source": ["DepthImage"]}}} by Ada on 2026-11-23``: JSON in
ASCII, so that no name can end the line. It changes no answer: nothing is suggested that it says. Who removes the line
is asked again.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import LONGEST_LINE, blanked, cut, printable

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.suggesting.written import WrittenLabel

MARK = "# not: "
_DECODER = json.JSONDecoder()


def refusal_key(label: WrittenLabel) -> str:
    """Return by what a label is known that was refused.

    >>> from rosprivacy.analysis.suggesting.written import WrittenLabel
    >>> refusal_key(WrittenLabel("nodes", "/camera", {"source": ["Video"]}))
    '{"nodes": {"/camera": {"source": ["Video"]}}}'
    """
    return json.dumps({label.section: {label.name: label.said}}, sort_keys=True)


def refusal(label: WrittenLabel, who: str, day: str) -> str:
    """Return the line that remembers a no.

    >>> from rosprivacy.analysis.suggesting.written import WrittenLabel
    >>> refusal(WrittenLabel("nodes", "/camera", {"source": ["Video"]}), "Ada", "2026-11-23")
    '# not: {"nodes": {"/camera": {"source": ["Video"]}}} by Ada on 2026-11-23'
    """
    return f"{MARK}{refusal_key(label)} by {blanked(cut(printable(who), LONGEST_LINE), '?')} on {day}"


def refusals_in(text: str) -> frozenset[str]:
    r"""Return what was refused in a label file, as ``refusal_key`` has it.

    A line that begins so and says something else is a comment as any other: it is asked again, which harms nobody.

    >>> sorted(refusals_in('# not: {"nodes": {"/a": {"source": ["Video"]}}} by Ada on 2026-11-23\n# not: used'))
    ['{"nodes": {"/a": {"source": ["Video"]}}}']
    """
    return frozenset(said for line in text.split("\n") if (said := _said(line)))


def _said(line: str) -> str:
    """What a line refuses; nothing if it is no refusal."""
    if not line.startswith(MARK):
        return ""
    try:
        said, _ = _DECODER.raw_decode(line.removeprefix(MARK))
    except (ValueError, RecursionError):
        return ""
    return json.dumps(said, sort_keys=True) if isinstance(said, dict) else ""


def without_refusals(text: str) -> tuple[str, list[str]]:
    """Return a text without its refusals, and these."""
    kept: list[str] = []
    refusals: list[str] = []
    for line in text.split("\n"):
        if _said(line):
            refusals.append(line.rstrip("\r"))
        else:
            kept.append(line)
    return "\n".join(kept), refusals


def with_refusals(text: str, more: Iterable[str]) -> str:
    """Return a text with lines that remember a no at its end, each once."""
    rest, there = without_refusals(text)
    lines = list(dict.fromkeys([*there, *more]))
    end = "\r\n" if "\r\n" in text else "\n"
    return rest + (end if rest and not rest.endswith("\n") and lines else "") + "".join(f"{one}{end}" for one in lines)
