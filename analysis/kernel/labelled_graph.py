"""What labels mean for a graph, as numbers for the fixpoint: a flow that emits or blocks something is a vertex.

In: a spread before its fixpoint. Out: the ends of all edges, and per vertex what it emits, keeps and derives.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread


@dataclass(frozen=True, slots=True)
class LabelledGraph:
    """A graph and what its vertices do.

    Attributes
    ----------
    count
        Number of elements; vertices from it on are flows.
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

    @classmethod
    def of(cls, spread: Spread) -> LabelledGraph:
        """Return what a spread says; O(flows)."""
        graph = spread.graph
        count = len(graph.elements)
        special = tuple(sorted({*spread.flow_emits, *spread.flow_keeps}))
        sources = [flow.source for flow in graph.flows]
        targets = [flow.target for flow in graph.flows]
        emitted, keep = dict(spread.emits), dict(spread.keeps)
        for vertex, index in enumerate(special, count):
            sources.append(vertex)
            targets.append(targets[index])
            targets[index] = vertex
            keep[vertex] = spread.flow_keeps.get(index, spread.all_bits)
            # what never goes along it is not emitted there either
            emitted[vertex] = spread.flow_emits.get(index, 0) & keep[vertex]
        derivations = [(vertex, *pair) for vertex, pairs in spread.derives.items() for pair in pairs]
        return cls(count, nodes_of(spread), sources, targets, special, spread.all_bits, emitted, keep, derivations)

    @property
    def vertices(self) -> int:
        """How many there are, elements and flows."""
        return self.count + len(self.special)


def nodes_of(spread: Spread) -> int:
    """Return how many elements of a graph are no channels: these are last.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> [element.is_channel for element in carried.graph.elements].count(False) == nodes_of(carried)
    True
    """
    return bisect_left(spread.graph.elements, True, key=lambda element: element.is_channel)
