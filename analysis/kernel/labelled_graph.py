"""What labels mean for a graph, as numbers for the fixpoint: a flow that emits or blocks something is a vertex.

In: a spread before its fixpoint. Out: the ends of all edges, and per vertex what it emits, keeps and derives.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import parted

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import FlowGraph


@dataclass(frozen=True, slots=True)
class LabelledGraph:
    """A graph and what its vertices do.

    Attributes
    ----------
    count
        Number of elements; vertices from it on are flows, then meetings.
    nodes
        How many of the elements are no channels; they stand first.
    sources, targets
        The two ends of every edge, between elements and such flows.
    special
        Index of the flow of each vertex from ``count`` on.
    all_bits
        Every bit that there is.
    emitted
        Vertex -> bits that begin there; none where absent.
    keep
        Vertex -> bits that pass as they are; all where absent.
    derivations
        (vertex, bit that arrives, bit that leaves for it).
    meetings
        How many vertices behind those of flows stand for a meeting of wildcards.
    """

    count: int
    nodes: int
    sources: Sequence[int]
    targets: Sequence[int]
    special: tuple[int, ...]
    all_bits: int
    emitted: Mapping[int, int]
    keep: Mapping[int, int]
    derivations: Sequence[tuple[int, int, int]]
    meetings: int = 0

    @classmethod
    def of(cls, spread: Spread) -> LabelledGraph:
        """Return what a spread says; O(flows)."""
        graph = spread.graph
        count = len(graph.elements)
        special = tuple(sorted(spread.told_apart))
        sources, targets, meetings = ends(graph, special)
        emitted, keep = dict(spread.emits), dict(spread.keeps)
        for vertex, index in enumerate(special, count):
            keep[vertex] = spread.flow_keeps.get(index, spread.all_bits)
            # what never goes along it is not emitted there either
            emitted[vertex] = spread.flow_emits.get(index, 0) & keep[vertex]
        derivations = [(vertex, *pair) for vertex, pairs in spread.derives.items() for pair in pairs]
        nodes = nodes_of(spread)
        return cls(count, nodes, sources, targets, special, spread.all_bits, emitted, keep, derivations, meetings)

    @property
    def vertices(self) -> int:
        """How many there are: elements, flows and meetings."""
        return self.count + len(self.special) + self.meetings


def ends(graph: FlowGraph, special: Sequence[int]) -> tuple[list[int], list[int], int]:
    """Return the two ends of each edge, and the number of meetings.

    Parameters
    ----------
    special
        Numbers of flows that are vertices, those after the elements. Behind them is one for each meeting of wildcards:
        what comes from any written one goes to each read one.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> sources, targets, _ = ends(factory()[0], [2])
    >>> len(sources) - len(factory()[0].flows), (sources[-1], targets[-1]), targets[2]
    (1, (9, 8), 9)
    """
    flows, meetings = parted(graph.flows, special)
    place: dict[int, int] = {}
    sources: list[int] = []
    targets: list[int] = []
    for at, (index, flow) in enumerate(flows):
        place[index] = at
        sources.append(flow.source)
        targets.append(flow.target)
    for vertex, index in enumerate(special, len(graph.elements)):
        sources.append(vertex)
        targets.append(targets[place[index]])
        targets[place[index]] = vertex
    for vertex, meeting in enumerate(meetings, len(graph.elements) + len(special)):
        sources += [*meeting.written, *(vertex for _ in meeting.read)]
        targets += [*(vertex for _ in meeting.written), *meeting.read]
    return sources, targets, len(meetings)


def nodes_of(spread: Spread) -> int:
    """Return how many elements of a graph are no channels: these are last.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> [element.is_channel for element in carried.graph.elements].count(False) == nodes_of(carried)
    True
    """
    return bisect_left(spread.graph.elements, True, key=lambda element: element.is_channel)
