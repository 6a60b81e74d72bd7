"""A part of a graph that is cut at its border: what leaves the border goes in, what gets there goes out (rule S8).

In: a spread without its fixpoint, and which of its elements are the border. Out: arrays for the kernel, which carries
what leaves the border through the part and says what arrives there. Transfer is monotone and takes unions apart, so
parts that meet only at borders reach the fixpoint of the whole by handing each other such sets until none grows.

The core, where the parts meet, is the other side: a part whose border are gates before its elements.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.kernel.arrays import GraphArrays
from rosprivacy.analysis.kernel.fixpoint import WORD, fixpoint

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.kernel.spread import Spread

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]

Bringer = dict[tuple[int, int], int]  # number in the border, bit -> unit


@dataclass(frozen=True, slots=True)
class PartNetwork:
    """A part for the kernel.

    Attributes
    ----------
    network
        Nothing passes its border.
    border
        Vertices, in the order that all parts agree on.
    unit
        By element: the number of the unit that it belongs to, -1 on the border. Nothing gets from one unit to another
        but through the border.
    exits
        Shape (n, 3), by unit: vertex that hands data to the border, number in the border, unit.
    """

    network: GraphArrays
    border: Indices
    unit: Indices
    exits: Indices

    @classmethod
    def of(cls, spread: Spread, border: Sequence[int], unit: Sequence[int]) -> PartNetwork:
        """Make the arrays; O(flows · log flows)."""
        network = GraphArrays.of(spread)
        number = {vertex: i for i, vertex in enumerate(border)}
        special = {index: network.count + i for i, index in enumerate(network.special)}
        exits = [
            (special.get(index, flow.source), number[flow.target], unit[flow.source])
            for index, flow in enumerate(spread.graph.flows)
            if flow.target in number
        ]
        at = np.array(border, np.int64)
        rows = np.array(exits, np.int64).reshape(-1, 3)
        order = np.argsort(rows[:, 2], kind="stable")
        return cls(network.closed(at), at, np.array(unit, np.int64), rows[order])

    def carried(self, leaving: Bits) -> tuple[Bits, Bits]:
        """Return what arrives at and what leaves each vertex.

        Parameters
        ----------
        leaving
            Shape (border, words): what leaves each element of the border.
        """
        return _carried(self.network, self.border, leaving)

    def bringers(self, leaves: Bits, new: Bits) -> Bringer:
        """Return, for each bit that is new at the border, the first unit that brings it there.

        Parameters
        ----------
        leaves
            What leaves each vertex.
        new
            Shape (border, words).
        """
        brought_by: Bringer = {}
        for at in np.flatnonzero(new.any(axis=1)).tolist():
            exits = self.exits[self.exits[:, 1] == at]
            for word, bits in enumerate(new[at].tolist()):
                brought = leaves[exits[:, 0], word] & np.uint64(bits)
                for bit in range(WORD) if bits else ():
                    if bits >> bit & 1:
                        has = brought >> np.uint64(bit) & np.uint64(1)
                        if has.any():
                            brought_by[at, word * WORD + bit] = int(exits[np.argmax(has), 2])
        return brought_by


@dataclass(frozen=True, slots=True)
class Core:
    """Where the parts meet, for the kernel: elements that are in no part, and gates through which parts hand data in.

    Attributes
    ----------
    gates, border
        Vertices, in the order that all parts agree on: a gate, and the element that it leads to.
    """

    network: GraphArrays
    gates: Indices
    border: Indices

    def carried(self, arrived: Bits) -> tuple[Bits, Bits]:
        """Return what arrives at and what leaves each vertex, when this much arrived at the border: (border, words)."""
        return _carried(self.network, self.gates, arrived)


def _carried(network: GraphArrays, at: Indices, begun: Bits) -> tuple[Bits, Bits]:
    """The fixpoint, when some vertices emit what is given."""
    emitted = network.emitted.copy()
    emitted[at] = begun
    return fixpoint(network.edges, emitted, network.keep, network.derivations)
