"""How many elements, flows and standard channels a fleet has, when one robot of the graph stands for many."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import FlowGraph


@dataclass(frozen=True, slots=True)
class Counts:
    """Of the fleet, not of its graph."""

    elements: int = 0
    flows: int = 0
    denied_flows: int = 0
    standard_channels: int = 0

    def __add__(self, other: Counts) -> Counts:
        return Counts(*(getattr(self, f.name) + getattr(other, f.name) for f in fields(self)))


def counted(
    graph: FlowGraph, spread: Spread, likeness: Likeness, elsewhere: Collection[int] = (), unreal: Collection[int] = ()
) -> Counts:
    """Return the counts of a graph.

    Parameters
    ----------
    elsewhere
        Vertices that are counted elsewhere; flows to or from them are counted here.
    unreal
        Vertices that are none of the fleet; flows to or from them are not counted.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory("amr-1")
    >>> counted(graph, spread(graph, bound, hierarchy), Likeness({"amr-1": ("amr-1", "amr-2")}))
    Counts(elements=18, flows=18, denied_flows=2, standard_channels=2)
    """
    elements = graph.elements

    def weight(source: int, target: int) -> int:
        a, b = elements[source].robot, elements[target].robot
        if a == b or not likeness.is_robot(a) or not likeness.is_robot(b):
            return likeness.weight(a) * likeness.weight(b) if a != b else likeness.weight(a)
        if likeness.second.get(b) == a:
            return likeness.weight(a) * (likeness.weight(a) - 1)
        return likeness.weight(a) * likeness.weight(b)

    identities = {
        element.identity for vertex, element in enumerate(elements) if vertex not in elsewhere and vertex not in unreal
    }
    taken = {elements[vertex].identity for vertex in spread.standard}
    return Counts(
        sum(likeness.weight(robot) for robot, *_ in identities),
        sum(weight(f.source, f.target) for f in graph.flows if f.source not in unreal and f.target not in unreal),
        sum(weight(flow.source, flow.target) for flow in graph.denied),
        sum(likeness.weight(robot) for robot, *_ in taken),
    )
