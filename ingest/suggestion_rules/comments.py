"""Comments in a label file: suggestions, that say what would be written, and what a person has said no to.

A suggestion is one line, ``# suggest: likely {"nodes": {"/camera": {"source": ["Video"]}}} because …``; a refusal is
``# not: {"nodes": {"/camera": {"source": ["DepthImage"]}}} by Ada on 2026-11-23``: JSON in ASCII, so that no name can
end the line. They stand at the end of the file. People may remove lines, and change what they say. A refusal changes no
answer: nothing is suggested that it says, and who removes the line is asked again.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import CONDUIT, LEAK, SENSITIVE, SOURCE, written
from rosprivacy.analysis.suggesting.outdated_reasons import surest
from rosprivacy.analysis.text import LONGEST_LINE, blanked, cut, printable
from rosprivacy.ingest.labels.entries import SECTIONS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.suggesting.evidence import LabelProposal, WrittenLabel

MARK, REFUSED = "# suggest: ", "# not: "
BECAUSE = " because "
EXAMPLE = f'{MARK}likely {{"nodes": {{"/camera": {{"source": ["Video"]}}}}}}{BECAUSE}…'
ADDING = frozenset([SOURCE, LEAK, "derives", SENSITIVE])  # no label of these hides anything; people may write others
_DECODER = json.JSONDecoder()


class Comment(NamedTuple):
    """A suggestion that stands in a line of a label file: a role and what it names, and the reasons."""

    line: int
    confidence: Confidence
    section: str
    name: str
    roles: dict[str, Any]
    why: str

    @property
    def hides(self) -> bool:
        """Whether a wrong one could hide a leak, or that nobody has looked."""
        return hides(self.roles)

    @property
    def takes_away(self) -> bool:
        """Whether it says that data do not go on: a wrong one could hide a leak."""
        return self.hides and CONDUIT not in self.roles


def hides(roles: Iterable[str]) -> bool:
    """Return whether a wrong label of these roles could hide a leak, or that nobody has looked.

    >>> hides({"leak": ["Video"]}), hides({"conduit": ["Video"]})
    (False, True)
    """
    return not ADDING.issuperset(roles)


def comment_of(proposal: LabelProposal) -> str:
    """Return the line of a proposal.

    >>> from rosprivacy.analysis.model import Element, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, SuggestedLabel, LabelProposal
    >>> label = SuggestedLabel(Element("node", "/camera"), "source", "Video")
    >>> why = Evidence(label, "type", Confidence.LIKELY, "type sensor_msgs/msg/Image of /image", Place("t.yaml", 1))
    >>> print(comment_of(LabelProposal(label, Confidence.LIKELY, (why,))))
    # suggest: likely {"nodes": {"/camera": {"source": ["Video"]}}} because type sensor_msgs/msg/Image of /image
    """
    at = written(proposal.label)
    said = json.dumps({at.section: {at.name: at.roles}})
    reasons = surest(cut(printable(reason.reason), LONGEST_LINE) for reason in proposal.evidence)
    return f"{MARK}{proposal.confidence} {said}{BECAUSE}{blanked(reasons, '?')}"


def taken_apart(file: str, text: str) -> tuple[str, tuple[Comment, ...]]:
    """Return the text of a label file without the comments that are suggestions, and these.

    Raises
    ------
    InputErrors
        With every comment that begins as a suggestion and is none.
    """
    kept, comments, problems = [], [], []
    for number, line in enumerate(text.split("\n"), 1):
        if not line.startswith(MARK):
            kept.append(line)
            continue
        comment = _comment(number, line.removeprefix(MARK).rstrip("\r"))
        if comment is None:
            hint = f"write it as {EXAMPLE}, or remove the line"
            problems.append(LabelError(file, number, f"{shown(line.strip())!r} is no suggestion", hint))
        else:
            comments.append(comment)
    if problems:
        raise InputErrors(problems)
    return "\n".join(kept), tuple(comments)


def with_comments(text: str, comments: Iterable[str]) -> str:
    """Return a text with comments at its end."""
    lines = "".join(f"{line}\n" for line in comments)
    if "\r\n" in text:
        lines = lines.replace("\n", "\r\n")
    return text + ("\n" if text and not text.endswith("\n") and lines else "") + lines


def as_written(comment: Comment) -> str:
    """Return the line of a comment that was read."""
    said = json.dumps({comment.section: {comment.name: comment.roles}})
    return f"{MARK}{comment.confidence} {said}{BECAUSE}{comment.why}"


def _comment(number: int, line: str) -> Comment | None:
    """What a line says; None if it is no suggestion. Whether it is a label, the label file's reader says."""
    sure, _, rest = line.partition(" ")
    try:
        top, end = _DECODER.raw_decode(rest)
        ((section, names),) = top.items()
        ((name, said),) = names.items()
        ((_, value),) = said.items()
    except (ValueError, AttributeError, RecursionError):
        return None
    why = rest[end:].removeprefix(BECAUSE)
    if sure not in tuple(Confidence) or section not in SECTIONS or not isinstance(value, list | dict):
        return None
    return Comment(number, Confidence(sure), section, name, said, why)


def refusal_key(label: WrittenLabel) -> str:
    """Return by what a label is known that was refused.

    >>> from rosprivacy.analysis.suggesting.evidence import WrittenLabel
    >>> refusal_key(WrittenLabel("nodes", "/camera", {"source": ["Video"]}))
    '{"nodes": {"/camera": {"source": ["Video"]}}}'
    """
    return json.dumps({label.section: {label.name: label.roles}}, sort_keys=True)


def refusal(label: WrittenLabel, person: str, day: str) -> str:
    """Return the line that remembers a no."""
    return f"{REFUSED}{refusal_key(label)} by {blanked(cut(printable(person), LONGEST_LINE), '?')} on {day}"


def refusals_in(text: str) -> frozenset[str]:
    r"""Return what was refused in a label file, as ``refusal_key`` has it.

    A line that begins so and says something else is a comment as any other: it is asked again, which harms nobody.

    >>> sorted(refusals_in('# not: {"nodes": {"/a": {"source": ["Video"]}}} by Ada on 2026-11-23\n# not: used'))
    ['{"nodes": {"/a": {"source": ["Video"]}}}']
    """
    return frozenset(said for line in text.split("\n") if (said := _refused(line)))


def _refused(line: str) -> str:
    """What a line refuses; nothing if it is no refusal."""
    if not line.startswith(REFUSED):
        return ""
    try:
        said, _ = _DECODER.raw_decode(line.removeprefix(REFUSED))
    except (ValueError, RecursionError):
        return ""
    return json.dumps(said, sort_keys=True) if isinstance(said, dict) else ""


def without_refusals(text: str) -> tuple[str, list[str]]:
    """Return a text without its refusals, and these."""
    kept: list[str] = []
    refusals: list[str] = []
    for line in text.split("\n"):
        if _refused(line):
            refusals.append(line.rstrip("\r"))
        else:
            kept.append(line)
    return "\n".join(kept), refusals


def with_refusals(text: str, lines_to_add: Iterable[str]) -> str:
    """Return a text with lines that remember a no at its end, each once."""
    rest, old = without_refusals(text)
    lines = list(dict.fromkeys([*old, *lines_to_add]))
    end = "\r\n" if "\r\n" in text else "\n"
    return rest + (end if rest and not rest.endswith("\n") and lines else "") + "".join(f"{one}{end}" for one in lines)
