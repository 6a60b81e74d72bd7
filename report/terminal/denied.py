"""Denied flows -> lines for the terminal: what one policy line allows and another takes back (rule S5).

In: a JSON document of the contract. Out: lines, with the places of both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


def denied_lines(report: Mapping[str, Any], words: Words, *, most: int | None) -> Iterator[Line]:
    """Return the denied flows; ``most`` of them, all if None."""
    flows = report["denied"]
    if not flows:
        return
    yield "", ""
    yield words("tty.denied", n=len(flows)), "bold"
    for flow in flows[:most]:
        allowed, denied = _places(flow["allowed_by"], words), _places(flow["denied_by"], words)
        ends = f"{shown_name(flow['source'])} -> {shown_name(flow['target'])}"
        line = words("tty.denied.line", ends=ends, role=flow["role"], allowed=allowed, denied=denied)
        yield f"   {line}", ""
    if most is not None and len(flows) > most:
        yield f"   {words('tty.rest', n=len(flows) - most)}", "dim"


def _places(lines: Iterable[Mapping[str, Any]], words: Words) -> str:
    places = list(dict.fromkeys(f"{shown(line['file'])}:{line['line']}" for line in lines))
    return places[0] + words("tty.more", n=len(places) - 1) if len(places) > 1 else places[0]
