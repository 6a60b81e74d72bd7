"""The fixpoint: which categories arrive where, all of them in one pass (rule S8). Arrays in, arrays out.

In: edges between numbered vertices, and per vertex one bit per category and plane: what it emits, what it keeps of
what arrives, what it derives. Out: per vertex the bits that arrive and the bits that leave. Nothing here knows what
a bit means.

A vertex is visited again only if its bits changed. While few changed, they are pushed along their out-edges; while
many did, every vertex pulls from its in-edges, nodes and channels in turn, so that one sweep goes two steps. Vertices
are grouped by their number of in-edges, since numpy works on whole rows: measured, two to three times as fast as
``ufunc.reduceat`` over short runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]

WORD = 64
LONGEST_ROW = 8  # in-edges per vertex that are pulled row by row
DENSE = 0.05  # share of the edges from which on pulling beats pushing


@dataclass(frozen=True, slots=True)
class Rows:
    """Vertices with equally many in-edges (or, with ``starts``, with many), and where these come from.

    Attributes
    ----------
    vertices
        Shape (k,).
    sources
        Shape (d, k); or (number of in-edges,) cut at ``starts``, shape (k,).
    """

    vertices: Indices
    sources: Indices
    starts: Indices | None = None


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
        The in-edges, grouped for pulling.
    """

    count: int
    pointers: Indices
    targets: Indices
    rows: tuple[Rows, ...]

    @classmethod
    def of(cls, count: int, sources: Indices, targets: Indices, split: int = 0) -> Edges:
        """Group edges by both their ends; O(edges · log edges).

        Parameters
        ----------
        sources, targets
            Shape (edges,), in any order.
        split
            Vertices before it and from it on are pulled in turn: best where edges go between the two parts.
        """
        order = np.argsort(sources, kind="stable")
        pointers = np.concatenate(([0], np.cumsum(np.bincount(sources, minlength=count)))).astype(np.int64)
        back = np.argsort(targets, kind="stable")
        incoming = np.bincount(targets, minlength=count).astype(np.int64)
        starts = np.concatenate(([0], np.cumsum(incoming))).astype(np.int64)
        rows = _rows(starts, incoming, sources[back], 0, split) + _rows(starts, incoming, sources[back], split, count)
        return cls(count, pointers, targets[order], tuple(rows))


def _rows(starts: Indices, incoming: Indices, sources: Indices, low: int, high: int) -> list[Rows]:
    rows = []
    part = incoming[low:high]
    for length in range(1, LONGEST_ROW + 1):
        vertices = np.flatnonzero(part == length) + low
        if len(vertices):
            rows.append(Rows(vertices, sources[starts[vertices] + np.arange(length)[:, None]]))
    vertices = np.flatnonzero(part > LONGEST_ROW) + low
    if len(vertices):
        lengths = incoming[vertices]
        rows.append(Rows(vertices, sources[_ranges(starts[vertices], lengths)], np.cumsum(lengths) - lengths))
    return rows


def _ranges(starts: Indices, lengths: Indices) -> Indices:
    """The numbers start … start + length - 1 of each range, one after the other."""
    ends = np.cumsum(lengths)
    numbers = np.repeat(starts - ends + lengths, lengths)
    numbers += np.arange(len(numbers))
    return numbers


def fixpoint(edges: Edges, emitted: Bits, keep: Bits, derivations: Indices) -> tuple[Bits, Bits]:
    """Return what arrives at and what leaves each vertex: the least solution of rule S8.

    ``leaves = emitted ∪ (arrives ∩ keep) ∪ derived(arrives)``, and along each edge what leaves its source arrives at
    its target.

    Parameters
    ----------
    edges
        The graph.
    emitted, keep
        Shape (count, words) of ``WORD`` bits each.
    derivations
        Shape (m, 3): vertex, bit that arrives, bit that leaves for it.

    Returns
    -------
    arrives, leaves
        Shape (count, words).

    Notes
    -----
    Each round of derivations goes on from the last; there are at most as many as a chain of derivations is long. In
    between, a word takes O(levels · vertices + edges visited), an edge being visited once per change of its source.
    """
    words = emitted.shape[1]
    leaves = [np.ascontiguousarray(emitted[:, word]) for word in range(words)]
    arrives = [np.zeros(edges.count, np.uint64) for _ in range(words)]
    kept = [np.ascontiguousarray(keep[:, word]) for word in range(words)]
    changed = [np.flatnonzero(word) for word in leaves]
    vertices, incoming, outgoing = derivations.reshape(-1, 3).T
    while any(len(word) for word in changed):
        for word in range(words):
            _propagate(edges, leaves[word], arrives[word], kept[word], changed[word])
        fired = _bit(arrives, vertices, incoming) & ~_bit(leaves, vertices, outgoing)
        changed = [np.empty(0, np.int64)] * words
        for word in range(words):
            here = fired & (outgoing // WORD == word)
            np.bitwise_or.at(leaves[word], vertices[here], _one(outgoing[here]))
            changed[word] = np.unique(vertices[here])
    return np.stack(arrives, axis=1), np.stack(leaves, axis=1)


def _one(bits: Indices) -> Bits:
    return np.left_shift(np.uint64(1), (bits % WORD).astype(np.uint64))


def _bit(words: list[Bits], vertices: Indices, bits: Indices) -> NDArray[np.bool_]:
    """Whether each vertex has its bit."""
    has = np.zeros(len(vertices), bool)
    for number, word in enumerate(words):
        here = bits // WORD == number
        has[here] = word[vertices[here]] & _one(bits[here]) != 0
    return has


def _propagate(edges: Edges, leaves: Bits, arrives: Bits, keep: Bits, changed: Indices) -> None:
    """Carry one word to its fixpoint, in place, from the vertices whose leaving bits changed."""
    degrees = np.diff(edges.pointers)
    before = np.empty_like(leaves)
    marked = np.zeros(edges.count, bool)
    dense = DENSE * len(edges.targets)
    while len(changed):
        if int(degrees[changed].sum()) > dense:
            np.copyto(before, leaves)
            for row in edges.rows:
                _pull(row, leaves, arrives, keep)
            changed = np.flatnonzero(before != leaves)
        else:
            changed = _push(edges, degrees, leaves, arrives, keep, changed, marked)


def _pull(row: Rows, leaves: Bits, arrives: Bits, keep: Bits) -> None:
    if row.starts is None:
        bits = leaves.take(row.sources[0], mode="clip")
        for sources in row.sources[1:]:
            bits |= leaves.take(sources, mode="clip")
    else:
        bits = np.bitwise_or.reduceat(leaves[row.sources], row.starts)
    arrives[row.vertices] = bits
    bits &= keep[row.vertices]
    bits |= leaves[row.vertices]
    leaves[row.vertices] = bits


def _push(
    edges: Edges, degrees: Indices, leaves: Bits, arrives: Bits, keep: Bits, changed: Indices,
    marked: NDArray[np.bool_],
) -> Indices:  # fmt: skip
    lengths = degrees[changed]
    targets = edges.targets[_ranges(edges.pointers[changed], lengths)]
    np.bitwise_or.at(arrives, targets, np.repeat(leaves[changed], lengths))
    marked[targets] = True
    touched = np.flatnonzero(marked)
    marked[touched] = False
    old = leaves[touched]
    new = old | (arrives[touched] & keep[touched])
    different = new != old
    leaves[touched[different]] = new[different]
    risen: Indices = touched[different]
    return risen
