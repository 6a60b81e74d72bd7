"""What is not known in the report for the terminal: where data's path ends without anybody known (rule S11).

In: a JSON document of the contract. Out: parts of the verdict's line, and lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import counted
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import shown_name, whole

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
SAYS = {  # what is unknown -> of one, of several, title of the list
    "reader": (
        "channel ends at no known reader",
        "channels end at no known reader",
        "Channels with data that nobody known reads (who reads them may stand in a policy that was not given)",
    ),
    "flow": (
        "element outside ROS is reached by no flow",
        "elements outside ROS are reached by no flow",
        "Elements outside ROS that no flow reaches (say what flows into them, or remove them)",
    ),
}


def ends_at_verdict(report: Mapping[str, Any]) -> Iterator[str]:
    """Return how many ends are not known, for the line of a verdict that nothing was found; on all robots alike."""
    alike = {row["robot"]: len(row["robots"]) for row in report.get("fleet", {}).get("alike", ())}
    if report["verdict"] == "no-leak-found":
        for what, (one, several, _) in SAYS.items():
            ends = {whole(end["element"]) for end in report["unknown_ends"] if end["unknown"] == what}
            count = sum(alike.get(robot, 1) for robot, *_ in ends)
            if count:
                yield counted(count, one, several)


def end_lines(report: Mapping[str, Any], most: int | None) -> Iterator[Line]:
    """Return the names of the ends that are not known, ``most`` of each kind."""
    for what, (*_, title) in SAYS.items():
        ends = [end for end in report["unknown_ends"] if end["unknown"] == what]
        if not ends:
            continue
        yield "", ""
        count = count_rows(ends)
        yield f"{title}: {count.elements}{count.more}", "bold"
        for end in ends[:most]:
            element = end["element"]
            kind = " ".join(part for part in (element["kind"], element.get("leg", "")) if part)
            about = "; ".join(part for part in (kind, ", ".join(end["categories"])) if part)
            yield f"   {shown_name(element)}  ({about})", ""
        if most is not None and len(ends) > most:
            yield f"   … and {len(ends) - most} more (-v shows all)", "dim"
