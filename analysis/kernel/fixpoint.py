"""The fixpoint: which categories arrive where, all of them in one pass (rule S8). Arrays in, arrays out.

In: edges between numbered vertices, and per vertex one bit per category and plane: what it emits, what it keeps of
what arrives, what it derives. Out: per vertex the bits that arrive and the bits that leave. Nothing here knows what
a bit means.

Most channels have one writer and pass on everything: what arrives there and what leaves is what leaves the writer.
Such a channel is folded into its writer, so that data goes from node to node in one step and a fraction of the
vertices is left. While few of these changed, they are pushed along their out-edges; while many did, every vertex pulls
from its in-edges.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.kernel.edges import Rows, ranges

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rosprivacy.analysis.kernel.edges import Edges

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]
    Flags = NDArray[np.bool_]

WORD = 64
DENSE = 0.02  # share of the slots, or of the edges, from which on pulling beats pushing


@dataclass(frozen=True, slots=True)
class _Folded:
    """A graph with the channels folded that pass on everything; sources of rows are slots here.

    Attributes
    ----------
    order, slot
        As in ``Edges``, but a single channel that is not folded has a slot of its own.
    passing
        Whether a vertex is folded.
    """

    edges: Edges
    blocks: tuple[tuple[Rows, ...], ...]
    order: Indices
    slot: Indices
    passing: Flags

    @classmethod
    def of(cls, edges: Edges, busy: Flags) -> _Folded:
        """Fold the single channels that are not busy."""
        gone = np.zeros(edges.count, bool)
        gone[edges.single] = True
        gone &= ~busy
        own = edges.single[busy[edges.single]]
        order, slot, more = edges.order, edges.slot, []
        if len(own):
            start, end = len(order), len(order) + len(own)
            more.append((Rows(start, end, slot[own][None]),))
            order, slot = np.concatenate((order, own)), slot.copy()
            slot[own] = np.arange(start, end)
        renamed = (
            tuple(Rows(row.start, row.end, slot.take(row.sources), row.cuts) for row in rows) for rows in edges.blocks
        )
        return cls(edges, (*renamed, *more), order, slot, gone)

    def many(self, slots: Indices) -> bool:
        """Whether so much leaves these slots that all should pull."""
        if len(slots) > DENSE * len(self.order):
            return True
        vertices, pointers = self.order[slots], self.edges.pointers
        return int((pointers[vertices + 1] - pointers[vertices]).sum()) > DENSE * len(self.edges.targets)

    def following(self, slots: Indices, bits: Bits) -> tuple[Indices, Bits]:
        """The slots that follow, once per edge, with the bits that get there; folded channels are passed through."""
        targets, arriving = self._out(self.order[slots], bits)
        through = self.passing[targets]
        further, passing = self._out(targets[through], arriving[through])
        targets = np.concatenate((targets[~through], further))
        return self.slot[targets], np.concatenate((arriving[~through], passing))

    def _out(self, vertices: Indices, bits: Bits) -> tuple[Indices, Bits]:
        starts = self.edges.pointers[vertices]
        lengths = self.edges.pointers[vertices + 1] - starts
        return self.edges.targets[ranges(starts, lengths)], np.repeat(bits, lengths)


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

    Examples
    --------
    >>> from rosprivacy.analysis.kernel.edges import Edges
    >>> line = Edges.of(3, np.array([0, 1]), np.array([1, 2]))  # 0 -> 1 -> 2
    >>> emitted, keep = np.array([[1], [0], [0]], np.uint64), np.array([[0], [0], [0]], np.uint64)
    >>> arrives, leaves = fixpoint(line, emitted, keep, np.array([[1, 0, 1]]))  # vertex 1 makes bit 1 of bit 0
    >>> arrives.ravel().tolist(), leaves.ravel().tolist()
    ([0, 1, 2], [1, 2, 0])
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
        np.copyto(arrives[number], leaves[number], where=graph.passing)
    return arrives.T, leaves.T


def _busy(emitted: Bits, keep: Bits, vertices: Indices, outgoing: Indices) -> Flags:
    """Whether a vertex does more than to pass on everything that there is."""
    busy = np.zeros(len(emitted), bool)
    busy[vertices] = True
    for number in range(emitted.shape[1]):
        made = _bit(outgoing[outgoing // WORD == number])
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
                yield before, after, slots[here], _bit(incoming[here]), _bit(outgoing[here])


def _bit(bits: Indices) -> Bits:
    shifted: Bits = np.left_shift(np.uint64(1), (bits % WORD).astype(np.uint64))
    return shifted


def _step(graph: _Folded, word: _Word) -> None:
    """Follow what changed by one step, in place."""
    if graph.many(word.changed):
        word.changed = np.concatenate([word.changed[:0], *(_sweep(rows, word) for rows in graph.blocks)])
        return
    slots, bits = graph.following(word.changed, word.leaves[word.changed])
    np.bitwise_or.at(word.arrives, slots, bits)
    slots = np.unique(slots)
    old = word.leaves[slots]
    new = old | (word.arrives[slots] & word.keep[slots])
    different = new != old
    word.changed = slots[different]
    word.leaves[word.changed] = new[different]


def _sweep(rows: tuple[Rows, ...], word: _Word) -> Indices:
    """Pull a block until little changes there: what it needs is in the processor's cache. Return what changed."""
    if not rows:
        return word.changed[:0]
    start, end = rows[0].start, rows[-1].end
    before = word.leaves[start:end].copy()
    while sum(_pull(row, word) for row in rows) > DENSE * (end - start):
        pass
    return np.flatnonzero(word.leaves[start:end] != before) + start


def _pull(row: Rows, word: _Word) -> int:
    """Take in what leaves the sources of some slots; return how many changed."""
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
    changed = np.count_nonzero(bits != word.leaves[here])
    word.leaves[here] = bits
    return int(changed)
