"""Why data does not get from one element to another, for the terminal.

In: ``WhyNot`` facts. Out: lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import CANNOT
from rosprivacy.analysis.whatif.why_not import NO_LEAK, NO_SOURCE, THROUGH

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.whatif.why_not import Obstacle, WhyNot

SILENT = {
    NO_SOURCE: "no label says that it brings in {category}",
    NO_LEAK: "no label says that it lets {category} out",
    THROUGH: "its label names other channels for {category}",
}


def lines(answers: Iterable[WhyNot]) -> Iterator[str]:
    """Return the answers in sentences."""
    for answer in answers:
        ends = f"{answer.category} from {shown(answer.source.full_name)} to {shown(answer.leak.full_name)}"
        if answer.finding:
            yield f"{ends}: it gets there, finding {answer.finding.id}"
        elif not answer.path:
            yield f"{ends}: no chain of policy lines or stated flows leads there"
        else:
            fewest = f"of all paths this one has the fewest obstacles ({len(answer.obstacles)})"
            yield f"{ends}: it does not get there; {fewest}"
        if answer.path:
            yield f"   {' -> '.join(shown(element.full_name) for element in answer.path)}"
        for obstacle in answer.obstacles:
            yield f"   {_obstacle(obstacle)}"
        if not answer.finding:
            yield f"   as things are, {answer.category} gets to {answer.reached:,} elements"


def _obstacle(obstacle: Obstacle) -> str:
    ends = " -> ".join(shown(end.full_name) for end in (obstacle.element, obstacle.to) if end)
    if obstacle.by in SILENT:
        return f"at {ends}: {SILENT[obstacle.by].format(category=obstacle.category)}"
    where = ", ".join(f"{shown(place.file)}:{place.line}" for place in obstacle.places)
    says = "its type cannot carry" if obstacle.by == CANNOT else f"{obstacle.by} for"
    return f"at {ends}: {says} {obstacle.category}, {where}"
