"""The fixpoint: which categories arrive where, all of them in one pass (rule S8). Arrays in, arrays out.

In: edges between numbered vertices, and per vertex one bit per category and plane: what it emits, what it keeps of
what arrives, what it derives. Out: per vertex the bits that arrive and the bits that leave. Nothing here knows what
a bit means.

Most channels have one writer and pass on everything: what arrives there and what leaves is what leaves the writer.
Such a channel is folded into its writer, so that data goes from node to node in one step and a fraction of the
vertices is left. While few of these changed, they are pushed along their out-edges; while many did, every vertex pulls
from its in-edges. Vertices are numbered anew, in slots, by their number of in-edges, since numpy works on whole rows:
measured, two to three times as fast as ``ufunc.reduceat`` over short runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]
    Flags = NDArray[np.bool_]

WORD = 64
LONGEST_ROW = 12  # in-edges per vertex that are pulled row by row
DENSE = 0.02  # share of the slots, or of the edges, from which on pulling beats pushing


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
    rows
        The in-edges, grouped for pulling; sources are vertices here.
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
    rows: tuple[Rows, ...]
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
        rows: list[Rows] = []
        order = [np.empty(0, np.int64)]
        end = 0
        for length, vertices in (*_by_length(incoming, 0, split), *_by_length(incoming, split, count)):
            order.append(vertices)
            start, end = end, end + len(vertices)
            if length > LONGEST_ROW:
                lengths = incoming[vertices]
                rows.append(Rows(start, end, before[_ranges(starts[vertices], lengths)], np.cumsum(lengths) - lengths))
            elif length:
                rows.append(Rows(start, end, before[starts[vertices] + np.arange(length)[:, None]]))
        by_slot = np.concatenate(order)
        slot = np.empty(count, np.int64)
        slot[by_slot] = np.arange(end)
        slot[single] = slot[before[starts[single]]]
        return cls(count, pointers, targets[by_source], tuple(rows), by_slot, single, slot)


def _running(lengths: Indices) -> Indices:
    """Where each of some ranges begins, one after the other, and where the last ends."""
    return np.concatenate(([0], np.cumsum(lengths))).astype(np.int64)


def _by_length(incoming: Indices, low: int, high: int) -> Iterator[tuple[int, Indices]]:
    """(number of in-edges, vertices that have so many); those above ``LONGEST_ROW`` together."""
    part = np.minimum(incoming[low:high], LONGEST_ROW + 1)
    for length in range(LONGEST_ROW + 2):
        vertices = np.flatnonzero(part == length) + low
        if len(vertices):
            yield length, vertices


def _ranges(starts: Indices, lengths: Indices) -> Indices:
    """The numbers start … start + length - 1 of each range, one after the other."""
    ends = np.cumsum(lengths)
    numbers = np.repeat(starts - ends + lengths, lengths)
    numbers += np.arange(len(numbers))
    return numbers


@dataclass(frozen=True, slots=True)
class _Folded:
    """A graph with the channels folded that pass on everything; sources of rows are slots here.

    Attributes
    ----------
    order, slot
        As in ``Edges``, but a single channel that is not folded has a slot of its own.
    gone
        Whether a vertex is folded.
    """

    edges: Edges
    rows: tuple[Rows, ...]
    order: Indices
    slot: Indices
    gone: Flags

    @classmethod
    def of(cls, edges: Edges, busy: Flags) -> _Folded:
        """Fold the single channels that are not busy."""
        gone = np.zeros(edges.count, bool)
        gone[edges.single] = True
        gone &= ~busy
        own = edges.single[busy[edges.single]]
        order, slot, rows = edges.order, edges.slot, []
        if len(own):
            start, end = len(order), len(order) + len(own)
            rows.append(Rows(start, end, slot[own][None]))
            order, slot = np.concatenate((order, own)), slot.copy()
            slot[own] = np.arange(start, end)
        renamed = (Rows(row.start, row.end, slot.take(row.sources), row.cuts) for row in edges.rows)
        return cls(edges, (*renamed, *rows), order, slot, gone)

    def many(self, slots: Indices) -> bool:
        """Whether so much leaves these slots that all should pull."""
        if len(slots) > DENSE * len(self.order):
            return True
        vertices, pointers = self.order[slots], self.edges.pointers
        return int((pointers[vertices + 1] - pointers[vertices]).sum()) > DENSE * len(self.edges.targets)

    def following(self, slots: Indices, bits: Bits) -> tuple[Indices, Bits]:
        """The slots that follow, once per edge, with the bits that get there; folded channels are passed through."""
        targets, arriving = self._out(self.order[slots], bits)
        through = self.gone[targets]
        further, passing = self._out(targets[through], arriving[through])
        targets = np.concatenate((targets[~through], further))
        return self.slot[targets], np.concatenate((arriving[~through], passing))

    def _out(self, vertices: Indices, bits: Bits) -> tuple[Indices, Bits]:
        starts = self.edges.pointers[vertices]
        lengths = self.edges.pointers[vertices + 1] - starts
        return self.edges.targets[_ranges(starts, lengths)], np.repeat(bits, lengths)


@dataclass(slots=True)
class _Word:
    """One word of bits per slot, on its way to the fixpoint; what changed has not been followed yet."""

    leaves: Bits
    arrives: Bits
    keep: Bits
    changed: Indices


def fixpoint(edges: Edges, emitted: Bits, keep: Bits, derivations: Indices) -> tuple[Bits, Bits]:
    """Return what arrives at and what leaves each vertex: the least solution of rule S8.

    ``leaves = emitted ∪ (arrives ∩ keep) ∪ derived(arrives)``, and along each edge what leaves its source arrives at
    its target.

    Parameters
    ----------
    edges
        The graph.
    emitted, keep
        Shape (count, words) of ``WORD`` bits each; left as they are.
    derivations
        Shape (m, 3): vertex, bit that arrives, bit that leaves for it.

    Returns
    -------
    arrives, leaves
        Shape (count, words).

    Notes
    -----
    A word takes O(levels · slots + edges visited), an edge being visited once per change of its source.
    """
    vertices, incoming, outgoing = derivations.reshape(-1, 3).T
    graph = _Folded.of(edges, _busy(emitted, keep, vertices, outgoing))
    words = []
    for number in range(emitted.shape[1]):
        begun = emitted[:, number].take(graph.order)
        kept = keep[:, number].take(graph.order)
        words.append(_Word(begun, np.zeros_like(begun), kept, np.flatnonzero(begun)))
    derive = list(_between_words(graph.slot[vertices], incoming, outgoing, len(words)))
    while any(len(word.changed) for word in words):
        for word in words:
            if len(word.changed):
                _step(graph, word)
        for before, after, slots, taken, made in derive:
            fired = (words[before].arrives[slots] & taken != 0) & (words[after].leaves[slots] & made == 0)
            if fired.any():
                np.bitwise_or.at(words[after].leaves, slots[fired], made[fired])
                words[after].changed = np.concatenate((words[after].changed, slots[fired]))
    arrives, leaves = np.empty((2, len(words), edges.count), np.uint64)
    for number, word in enumerate(words):
        word.leaves.take(graph.slot, out=leaves[number], mode="clip")
        word.arrives.take(graph.slot, out=arrives[number], mode="clip")
        np.copyto(arrives[number], leaves[number], where=graph.gone)
    return arrives.T, leaves.T


def _busy(emitted: Bits, keep: Bits, vertices: Indices, outgoing: Indices) -> Flags:
    """Whether a vertex does more than to pass on everything that there is."""
    busy = np.zeros(len(emitted), bool)
    busy[vertices] = True
    for number in range(emitted.shape[1]):
        made = _one(outgoing[outgoing // WORD == number])
        used = np.bitwise_or.reduce(emitted[:, number]) | np.bitwise_or.reduce(made, initial=np.uint64(0))
        busy |= keep[:, number] & used != used
        busy |= emitted[:, number] != 0
    return busy


def _between_words(
    slots: Indices, incoming: Indices, outgoing: Indices, words: int
) -> Iterator[tuple[int, int, Indices, Bits, Bits]]:
    """Derivations by (word of the bit that arrives, word of the bit that leaves): these two, slots, both bits."""
    for before in range(words):
        for after in range(words):
            here = np.flatnonzero((incoming // WORD == before) & (outgoing // WORD == after))
            if len(here):
                yield before, after, slots[here], _one(incoming[here]), _one(outgoing[here])


def _one(bits: Indices) -> Bits:
    return np.left_shift(np.uint64(1), (bits % WORD).astype(np.uint64))


def _step(graph: _Folded, word: _Word) -> None:
    """Follow what changed by one step, in place."""
    if graph.many(word.changed):
        word.changed = np.concatenate([word.changed[:0], *(_pull(row, word) for row in graph.rows)])
        return
    slots, bits = graph.following(word.changed, word.leaves[word.changed])
    np.bitwise_or.at(word.arrives, slots, bits)
    slots = np.unique(slots)
    old = word.leaves[slots]
    new = old | (word.arrives[slots] & word.keep[slots])
    different = new != old
    word.changed = slots[different]
    word.leaves[word.changed] = new[different]


def _pull(row: Rows, word: _Word) -> Indices:
    """Take in what leaves the sources of some slots; return those that changed."""
    here = slice(row.start, row.end)
    if row.cuts is None:
        bits = word.leaves.take(row.sources[0], mode="clip")
        for sources in row.sources[1:]:
            bits |= word.leaves.take(sources, mode="clip")
    else:
        bits = np.bitwise_or.reduceat(word.leaves.take(row.sources, mode="clip"), row.cuts)
    word.arrives[here] = bits
    bits &= word.keep[here]
    bits |= word.leaves[here]
    changed = np.flatnonzero(bits != word.leaves[here])
    word.leaves[here] = bits
    return changed + row.start
