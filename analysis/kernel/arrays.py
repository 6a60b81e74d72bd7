"""What labels mean for a graph, as arrays for the kernel: a flow that emits or blocks something is a vertex of its own.

In: a spread before its fixpoint. Out: edges, and per vertex what it emits, keeps and derives.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.kernel.edges import Edges
from rosprivacy.analysis.kernel.fixpoint import WORD
from rosprivacy.analysis.model import parted

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import FlowGraph

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]


@dataclass(frozen=True, slots=True)
class GraphArrays:
    """A labelled graph for the kernel.

    Attributes
    ----------
    count
        Number of elements; vertices from it on are flows, then meetings of wildcards.
    edges
        Between elements and such flows.
    special
        Index of the flow of each vertex from ``count`` on.
    emitted, keep
        Shape (vertices, words).
    derivations
        Shape (m, 3): vertex, bit that arrives, bit that leaves for it.
    """

    count: int
    edges: Edges
    special: tuple[int, ...]
    emitted: Bits
    keep: Bits
    derivations: Indices

    @classmethod
    def of(cls, spread: Spread) -> GraphArrays:
        """Make the arrays of a spread; O(flows · log flows)."""
        graph = spread.graph
        count = len(graph.elements)
        special = sorted(spread.told_apart)
        vertices, sources, targets = ends(graph, special)
        emitted = as_bits(spread, vertices, spread.emits, 0)
        keep = as_bits(spread, vertices, spread.keeps, spread.all_bits)
        for number, index in enumerate(special):
            passing = spread.flow_keeps.get(
                index, spread.all_bits
            )  # what never goes along it is not emitted there either
            emitted[count + number] = _words(spread.flow_emits.get(index, 0) & passing, emitted.shape[1])
            keep[count + number] = _words(passing, keep.shape[1])
        derivations = [(vertex, *pair) for vertex, pairs in spread.derives.items() for pair in pairs]
        nodes = bisect_left(graph.elements, True, key=lambda element: element.is_channel)  # these are last
        edges = Edges.of(vertices, np.array(sources, np.int64), np.array(targets, np.int64), nodes)
        return cls(count, edges, tuple(special), emitted, keep, np.array(derivations, np.int64).reshape(-1, 3))

    def closed(self, vertices: Indices) -> GraphArrays:
        """Return the same where some vertices emit nothing and pass nothing on: there the graph is cut."""
        emitted, keep = self.emitted.copy(), self.keep.copy()
        emitted[vertices] = keep[vertices] = 0
        return replace(
            self, emitted=emitted, keep=keep, derivations=self.derivations[~np.isin(self.derivations[:, 0], vertices)]
        )


def ends(graph: FlowGraph, special: Sequence[int]) -> tuple[int, list[int], list[int]]:
    """Return the number of vertices, and the two ends of each edge.

    Parameters
    ----------
    special
        Numbers of flows that are vertices, those after the elements. Behind them is one for each meeting of wildcards:
        what comes from any written one goes to each read one.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> vertices, sources, targets = ends(factory()[0], [2])
    >>> len(sources) - len(factory()[0].flows), (sources[-1], targets[-1])
    (1, (9, 2))
    """
    flows, meetings = parted(graph.flows, special)
    count = len(graph.elements)
    place: dict[int, int] = {}
    sources: list[int] = []
    targets: list[int] = []
    for at, (index, flow) in enumerate(flows):
        place[index] = at
        sources.append(flow.source)
        targets.append(flow.target)
    for number, index in enumerate(special, count):
        sources.append(number)
        targets.append(targets[place[index]])
        targets[place[index]] = number
    for number, meeting in enumerate(meetings, count + len(special)):
        sources += [*meeting.written, *(number for _ in meeting.read)]
        targets += [*(number for _ in meeting.written), *meeting.read]
    return count + len(special) + len(meetings), sources, targets


def as_bits(spread: Spread, count: int, numbers: Mapping[int, int], otherwise: int) -> Bits:
    """Return sets of bits by vertex as rows of words; those that are not given are all alike.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> as_bits(spread(*factory()), 3, {1: 0b10}, 0b1111).tolist()
    [[15], [2], [15]]
    """
    words = max(1, -(-spread.all_bits.bit_length() // WORD))
    rows = np.empty((count, words), np.uint64)
    rows[:] = np.array(_words(otherwise, words), np.uint64)
    for vertex, bits in numbers.items():
        rows[vertex] = _words(bits, words)
    return rows


def as_numbers(bits: Bits) -> dict[int, int]:
    """Return rows that are not empty, as numbers of any length.

    >>> rows = np.array([[0, 0], [1, 2]], np.uint64)
    >>> as_numbers(rows) == {1: 1 + (2 << 64)}
    True
    """
    numbers = {}
    for vertex in np.flatnonzero(bits.any(axis=1)).tolist():
        numbers[vertex] = sum(word << WORD * i for i, word in enumerate(bits[vertex].tolist()))
    return numbers


def _words(bits: int, words: int) -> list[int]:
    mask = (1 << WORD) - 1
    return [bits >> WORD * word & mask for word in range(words)]
