"""Lines in the making: flows of a graph -> the lines of a picture, one for all flows of one look between two boxes.

In: flows, and what goes along them. Out: sorted ``PictureLine`` facts.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rosprivacy.report.pictures.looks import CLEANED, DATA, SHORTEST, WAY
from rosprivacy.report.pictures.picture import PictureLine, sorted_lines

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Flow, Grant, Place
    from rosprivacy.report.pictures.picture import Key
    from rosprivacy.report.pictures.privacy import Reached


def ends_of_flow(analysis: Analysis, flow: Flow) -> tuple[Key, Key]:
    """Return the elements that a flow goes between."""
    elements = analysis.graph.elements
    return elements[flow.source].identity, elements[flow.target].identity


@dataclass
class FlowLines:
    """Lines in the making: flows with the same ends and the same look become one."""

    boxes: Collection[Key]
    lines: dict[tuple[Key, Key, str], PictureLine] = field(default_factory=dict)

    def add(
        self,
        source: Key,
        target: Key,
        look: str,
        role: str,
        grants: Iterable[Grant],
        carries: Collection[str] = (),
        *,
        pseudonymised: bool = False,
        length: int = 0,
    ) -> None:
        """Add a flow; the two sides of a wildcard are one element, and between them nothing is drawn."""
        if source == target or source not in self.boxes or target not in self.boxes:
            return
        places = {grant.place for grant in grants}
        old = self.lines.get((source, target, look))
        roles: tuple[str, ...] = (role,)
        kinds, hidden = tuple(carries), pseudonymised
        if old:
            places |= set(old.places)
            roles, kinds = tuple(sorted({role, *old.roles})), tuple(sorted({*carries, *old.carries}))
            length = min((n for n in (length, old.length) if n), default=0)
            hidden = pseudonymised and old.pseudonymised
        told = tuple(sorted(places, key=_place))
        self.lines[source, target, look] = PictureLine(source, target, look, roles, kinds, hidden, told, length)

    def drawn_lines(self) -> tuple[PictureLine, ...]:
        """The lines; data that goes to a leak hides data that goes the same line to none, and this what ends there."""
        ranks = {CLEANED: 0, DATA: 1, WAY: 2, SHORTEST: 3}
        best: dict[tuple[Key, Key, str], PictureLine] = {}
        for (source, target, look), line in sorted(self.lines.items()):
            slot = (source, target, look if look not in ranks else "")
            old = best.get(slot)
            if old:
                upper, lower = (line, old) if ranks[look] > ranks[old.look] else (old, line)
                line = upper if lower.look == CLEANED else _with(upper, lower)  # noqa: PLW2901 - the same line
            best[slot] = line
        return sorted_lines(best.values())


def _with(line: PictureLine, addition: PictureLine) -> PictureLine:
    """A line with what else goes along it."""
    return replace(
        line,
        roles=tuple(sorted({*line.roles, *addition.roles})),
        carries=tuple(sorted({*line.carries, *addition.carries})),
        places=tuple(sorted({*line.places, *addition.places}, key=_place)),
    )


def _place(place: Place) -> tuple[str, int]:
    return place.file, place.line


def flow_lines(
    reached: Reached,
    boxes: Collection[Key],
    flows: Iterable[int],
    lengths: Mapping[int, int],
    shortest: Collection[tuple[Key, Key]],
) -> FlowLines:
    """Return what goes along some flows.

    Parameters
    ----------
    lengths
        Flow on a path to a leak -> steps of the shortest one through it.
    shortest
        Ends of the steps of the shortest paths.
    """
    lines = FlowLines(boxes)
    for index in flows:
        carries, pseudonymised = reached.along(index)
        if not carries and index not in lengths:
            continue
        flow = reached.graph.flows[index]
        ends = ends_of_flow(reached.analysis, flow)
        look = DATA if index not in lengths else SHORTEST if ends in shortest else WAY
        length = lengths.get(index, 0)
        lines.add(*ends, look, flow.role, flow.grants, carries, pseudonymised=pseudonymised, length=length)
    return lines


def add_cleaned(lines: FlowLines, reached: Reached, cleaned: Mapping[int, Collection[str]]) -> None:
    """Add the flows along which data gets to where a label says that it is cleaned."""
    for index, kinds in cleaned.items():
        flow = reached.graph.flows[index]
        lines.add(*ends_of_flow(reached.analysis, flow), CLEANED, flow.role, flow.grants, kinds)


def data_lines(
    reached: Reached,
    boxes: Collection[Key],
    flows: Iterable[int],
    lengths: Mapping[int, int],
    shortest: Collection[tuple[Key, Key]],
) -> FlowLines:
    """Return what goes along some flows, and between the boxes what ends where it gets, as a label says.

    See ``flow_lines``; beside it O(flows), once for each ``reached``.
    """
    lines = flow_lines(reached, boxes, flows, lengths, shortest)
    add_cleaned(lines, reached, reached.cleaned)
    return lines
