"""What a person reviews next, in the report for the terminal (rule S11).

In: a JSON document of the contract. Out: lines. What can wait, and what a file of the program proposes to take as
mundane, is one line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import counted
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import key, kind_of, label_name, shown_name
from rosprivacy.report.review_groups import AT_CHANNELS, BEHIND, FIRST, SHOWN, review_groups, sources_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.report.review_groups import ReviewGroup

TITLES = {
    FIRST: "Review next (nodes that data reaches first)",
    AT_CHANNELS: "Channels not reviewed",
    BEHIND: "Nodes behind those",
}
INFRASTRUCTURE = "read `rosprivacy labels --infrastructure`; -l rosprivacy:infrastructure takes them as mundane"
Line = tuple[str, str]  # text, style


def review_lines(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    """Return open elements: nodes on the frontier, then channels, then what lies behind."""
    brings = sources_of(report)
    for group in review_groups(report):
        if not group.questions:
            continue
        yield "", ""
        count = count_rows(group.questions)
        yield f"{TITLES[group.key]}: {count.elements}{count.more}", "bold"
        for question in group.questions if verbose else group.now[:SHOWN]:
            steps = f"{counted(question['distance'], 'step')} from a source"
            what = "; ".join((kind_of(question["element"]), steps, review_text(question, brings)))
            yield f"   {label_name(question)}  ({what})", ""
        if not verbose:
            yield from _more(group)


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


def _more(group: ReviewGroup) -> Iterator[Line]:
    left = len(group.now) - SHOWN
    if left > 0:
        yield f"   … and {left} more (-v shows all)", "dim"
    if waiting := count_rows(group.waiting).elements:
        yield f"   {waiting} can wait: from there data gets to no leak and no node that is not reviewed (-v)", "dim"
    if proposed := count_rows(group.proposed).elements:
        yield f"   {proposed} are lifecycle or other infrastructure channels: {INFRASTRUCTURE}", "dim"
