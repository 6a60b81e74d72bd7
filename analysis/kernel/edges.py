"""A directed graph as arrays, made for the fixpoint: out-edges to push along, in-edges by rows to pull from.

In: the two ends of every edge. Out: ``Edges``. Vertices are numbered anew, in slots, by their number of in-edges, since
numpy works on whole rows: measured, two to three times as fast as ``ufunc.reduceat`` over short runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Indices = NDArray[np.int64]

LONGEST_ROW = 12  # in-edges per vertex that are pulled row by row
BLOCK = 2**17  # vertices that are pulled several times in a row, while what they need is in the processor's cache


@dataclass(frozen=True, slots=True)
class Rows:
    """Slots ``start`` to ``end`` with equally many in-edges (or, with ``cuts``, with many), and where these come from.

    Attributes
    ----------
    sources
        Shape (d, end - start); or (number of in-edges,) cut at ``cuts``, shape (end - start,).
    """

    start: int
    end: int
    sources: Indices
    cuts: Indices | None = None


@dataclass(frozen=True, slots=True)
class Edges:
    """A directed graph as arrays.

    Attributes
    ----------
    count
        Number of vertices.
    pointers
        Shape (count + 1,): the out-edges of v are ``targets[pointers[v]:pointers[v + 1]]``.
    blocks
        The in-edges, grouped for pulling; sources are vertices here. Of a large graph several blocks, each of vertices
        that follow each other, before the split and from it on: in a fleet those of some robots.
    order
        The vertices by slot, without ``single``.
    single
        Channels with one in-edge, which does not come from another such channel.
    slot
        Shape (count,): the slot of a vertex; of a single channel that of its source.
    """

    count: int
    pointers: Indices
    targets: Indices
    blocks: tuple[tuple[Rows, ...], ...]
    order: Indices
    single: Indices
    slot: Indices

    @classmethod
    def of(cls, count: int, sources: Indices, targets: Indices, split: int = 0) -> Edges:
        """Group edges by both their ends; O(edges · log edges).

        Parameters
        ----------
        sources, targets
            Shape (edges,), in any order.
        split
            Vertices before it and from it on are pulled in turn: best where edges go between the two parts. Only
            those from it on are ever folded.
        """
        by_source, by_target = np.argsort(sources, kind="stable"), np.argsort(targets, kind="stable")
        incoming = np.bincount(targets, minlength=count)
        pointers, starts = _running(np.bincount(sources, minlength=count)), _running(incoming)
        before = sources[by_target]
        one = (incoming == 1) & (np.arange(count) >= split)
        single = np.flatnonzero(one)
        single = single[~one[before[starts[single]]]]
        incoming[single] = -1  # they stand in no row
        blocks: list[tuple[Rows, ...]] = []
        order = [np.empty(0, np.int64)]
        end = 0
        for low, high in _blocks(count, split):
            rows: list[Rows] = []
            for length, vertices in (*_by_length(incoming, *low), *_by_length(incoming, *high)):
                order.append(vertices)
                start, end = end, end + len(vertices)
                if length > LONGEST_ROW:
                    lengths = incoming[vertices]
                    first = np.cumsum(lengths) - lengths
                    rows.append(Rows(start, end, before[ranges(starts[vertices], lengths)], first))
                elif length:
                    rows.append(Rows(start, end, before[starts[vertices] + np.arange(length)[:, None]]))
            blocks.append(tuple(rows))
        by_slot = np.concatenate(order)
        slot = np.empty(count, np.int64)
        slot[by_slot] = np.arange(end)
        slot[single] = slot[before[starts[single]]]
        return cls(count, pointers, targets[by_source], tuple(blocks), by_slot, single, slot)


def _running(lengths: Indices) -> Indices:
    """Where each of some ranges begins, one after the other, and where the last ends."""
    return np.concatenate(([0], np.cumsum(lengths))).astype(np.int64)


def _blocks(count: int, split: int) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Ranges of vertices before the split, and those from it on that are about as far along."""
    number = max(1, count // BLOCK)
    for i in range(number):
        low, high = ([part * k // number for k in (i, i + 1)] for part in (split, count - split))
        yield (low[0], low[1]), (split + high[0], split + high[1])


def _by_length(incoming: Indices, low: int, high: int) -> Iterator[tuple[int, Indices]]:
    """(number of in-edges, vertices that have so many); those above ``LONGEST_ROW`` together."""
    part = np.minimum(incoming[low:high], LONGEST_ROW + 1)
    for length in range(LONGEST_ROW + 2):
        vertices = np.flatnonzero(part == length) + low
        if len(vertices):
            yield length, vertices


def ranges(starts: Indices, lengths: Indices) -> Indices:
    """The numbers start … start + length - 1 of each range, one after the other.

    >>> ranges(np.array([3, 10]), np.array([2, 3])).tolist()
    [3, 4, 10, 11, 12]
    """
    ends = np.cumsum(lengths)
    numbers = np.repeat(starts - ends + lengths, lengths)
    numbers += np.arange(len(numbers))
    return numbers
