"""What a person reviews next, in the report for the terminal (rule S11).

In: a JSON document of the contract. Out: lines. In each group what closes most comes first; what can wait, and what a
file of the program proposes to take as mundane, is one line.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CHANNELS
from rosprivacy.analysis.text import counted
from rosprivacy.report.naming import key, kind_of, label_name, shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

SHOWN = 12  # open elements of a kind without --verbose
INFRASTRUCTURE = "read `rosprivacy labels --infrastructure`; -l rosprivacy:infrastructure takes them as mundane"
Line = tuple[str, str]  # text, style


def review_lines(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    """Return open elements: nodes on the frontier, then channels, then what lies behind."""
    brings = sources_of(report)
    for title, questions in _groups(report):
        if not questions:
            continue
        yield "", ""
        yield f"{title}: {len(questions)}", "bold"
        listed = questions if verbose else [q for q in questions if not _folded(q)]
        for question in listed if verbose else listed[:SHOWN]:
            steps = f"{counted(question['distance'], 'step')} from a source"
            what = "; ".join((kind_of(question["element"]), steps, review_text(question, brings)))
            yield f"   {label_name(question)}  ({what})", ""
        if not verbose:
            yield from _more(questions, len(listed) - SHOWN)


def sources_of(report: Mapping[str, Any]) -> Mapping[Any, list[str]]:
    """Return which kinds of data each source brings in."""
    brings: dict[Any, list[str]] = defaultdict(list)
    for said in report["roles"]:
        if "source" in said["roles"]:
            brings[key(said["element"])].append(said["category"])
    return brings


def review_text(question: Mapping[str, Any], brings: Mapping[Any, Sequence[str]]) -> str:
    """Return which data is at an open element, through which element it comes, and what a label there can close."""
    kinds = ", ".join(question["categories"])
    own = brings.get(key(question["element"]), ())
    parts = [f"{kinds} through {shown_name(question['through'])}" if question.get("through") else kinds]
    parts += [f"no {what} is stated" for what in question.get("missing", ())]
    parts += [f"a source of {', '.join(own)}: if it passes on the rest, add conduit: [{kinds}]"] if own else []
    behind = [counted(question["closes"], "other open element")] if question.get("closes") else []
    behind += [counted(question["leaks"], "leak")] if question.get("leaks") else []
    return "; ".join([*parts, *([f"only past it: {' and '.join(behind)}"] if behind else [])])


def next_round(report: Mapping[str, Any], most: int = SHOWN) -> list[Mapping[str, Any]]:
    """Return what to review next: nodes that data reaches first, and channels; at last what could wait."""
    (_, first), (_, channels), (_, behind) = _groups(report)
    now = [*first[:most], *[q for q in channels if not _folded(q)][:most]]
    return now or [*behind, *channels][:most]


def _groups(report: Mapping[str, Any]) -> Sequence[tuple[str, list[Mapping[str, Any]]]]:
    rows = sorted(report["open"], key=lambda q: (-q.get("leaks", 0), -q.get("closes", 0), q["distance"]))
    channels = [q for q in rows if q["element"]["kind"] in CHANNELS]
    nodes = [q for q in rows if q["element"]["kind"] not in CHANNELS]
    return (
        ("Review next (nodes that data reaches first)", [q for q in nodes if q["frontier"]]),
        ("Channels not reviewed", channels),
        ("Nodes behind those", [q for q in nodes if not q["frontier"]]),
    )


def _folded(question: Mapping[str, Any]) -> bool:
    return bool(question.get("infrastructure") or question.get("waits"))


def _more(questions: Sequence[Mapping[str, Any]], left: int) -> Iterator[Line]:
    proposed = sum(bool(q.get("infrastructure")) for q in questions)
    waiting = sum(_folded(q) for q in questions) - proposed
    if left > 0:
        yield f"   … and {left} more (-v shows all)", "dim"
    if waiting:
        yield f"   {waiting} can wait: from there data gets to no leak and no node that is not reviewed (-v)", "dim"
    if proposed:
        yield f"   {proposed} are lifecycle or other infrastructure channels: {INFRASTRUCTURE}", "dim"
