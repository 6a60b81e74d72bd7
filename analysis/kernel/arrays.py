"""A labelled graph as arrays, for the fixpoint on numpy.

In: a ``LabelledGraph``, or the spread that it is of. Out: edges, and per vertex what it emits, keeps and derives.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.kernel.edges import Edges
from rosprivacy.analysis.kernel.fixpoint import WORD, fixpoint
from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from rosprivacy.analysis.kernel.spread import Spread

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]


@dataclass(frozen=True, slots=True)
class GraphArrays:
    """A labelled graph for the kernel.

    Attributes
    ----------
    count
        Number of elements; vertices from it on are flows.
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
        return cls.made_of(LabelledGraph.of(spread))

    @classmethod
    def made_of(cls, graph: LabelledGraph) -> GraphArrays:
        """Make the arrays of a labelled graph; O(edges · log edges)."""
        vertices, words = graph.vertices, words_of(graph.all_bits)
        edges = Edges.of(vertices, np.array(graph.sources, np.int64), np.array(graph.targets, np.int64), graph.nodes)
        return cls(
            graph.count,
            edges,
            graph.special,
            _rows(vertices, words, graph.emitted, 0),
            _rows(vertices, words, graph.keep, graph.all_bits),
            np.array(graph.derivations, np.int64).reshape(-1, 3),
        )

    def closed(self, vertices: Indices) -> GraphArrays:
        """Return the same where some vertices emit nothing and pass nothing on: there the graph is cut."""
        emitted, keep = self.emitted.copy(), self.keep.copy()
        emitted[vertices] = keep[vertices] = 0
        return replace(
            self, emitted=emitted, keep=keep, derivations=self.derivations[~np.isin(self.derivations[:, 0], vertices)]
        )


def as_bits(spread: Spread, count: int, numbers: Mapping[int, int], otherwise: int) -> Bits:
    """Return sets of bits by vertex as rows of words; those that are not given are all alike.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> as_bits(spread(*factory()), 3, {1: 0b10}, 0b1111).tolist()
    [[15], [2], [15]]
    """
    return _rows(count, words_of(spread.all_bits), numbers, otherwise)


def words_of(all_bits: int) -> int:
    """Return how many words hold so many bits.

    >>> words_of(0b1111), words_of(1 << 64)
    (1, 2)
    """
    return max(1, -(-all_bits.bit_length() // WORD))


def _rows(count: int, words: int, numbers: Mapping[int, int], otherwise: int) -> Bits:
    rows = np.empty((count, words), np.uint64)
    rows[:] = np.array(_words(otherwise, words), np.uint64)
    for vertex, bits in numbers.items():
        rows[vertex] = _words(bits, words)
    return rows


def solved(graph: LabelledGraph) -> tuple[dict[int, int], dict[int, int]]:
    """Return what arrives at and what leaves each vertex where there is any, in order; as ``worklist`` does.

    >>> line = LabelledGraph(3, 3, [0, 1], [1, 2], (), 0b11, {0: 1}, {0: 0, 1: 0, 2: 0}, [(1, 0, 1)])
    >>> solved(line)  # 0 -> 1 -> 2, and vertex 1 makes bit 1 of bit 0
    ({1: 1, 2: 2}, {0: 1, 1: 2})
    """
    network = GraphArrays.made_of(graph)
    arrives, leaves = fixpoint(network.edges, network.emitted, network.keep, network.derivations)
    return as_numbers(arrives), as_numbers(leaves)


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


def of_elements(spread: Spread, rows: Bits) -> dict[int, int]:
    """Return the rows of elements, which are the first, as numbers; those that are not empty.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> rows = as_bits(carried, len(carried.graph.elements) + 1, carried.arrives, 0)
    >>> of_elements(carried, rows) == carried.arrives
    True
    """
    return as_numbers(rows[: len(spread.graph.elements)])


def _words(bits: int, words: int) -> list[int]:
    mask = (1 << WORD) - 1
    return [bits >> WORD * word & mask for word in range(words)]
