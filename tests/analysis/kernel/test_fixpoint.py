"""The kernel against plain sweeps: pushing and pulling, one word and several, long chains and dense graphs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.kernel import fixpoint as flow
from rosprivacy.analysis.kernel.edges import Edges
from rosprivacy.analysis.kernel.fixpoint import fixpoint

if TYPE_CHECKING:
    from numpy.typing import NDArray

Bits = Any


def sweeps(edges: NDArray[np.int64], emitted: Bits, keep: Bits, derivations: NDArray[np.int64]) -> tuple[Bits, Bits]:
    """Rule S8 as it stands, over all edges until nothing changes."""
    leaves = emitted.copy()
    while True:
        arrives = np.zeros_like(emitted)
        for a, b in edges:
            arrives[b] |= leaves[a]
        new = emitted | (arrives & keep)
        for vertex, before, after in derivations:
            if int(arrives[vertex, before // 64]) >> int(before % 64) & 1:
                new[vertex, after // 64] |= np.uint64(1 << int(after % 64))
        if (new == leaves).all():
            return arrives, leaves
        leaves = new


def random_case(seed: int, count: int, edges: int, words: int) -> tuple[Any, ...]:
    rng = np.random.default_rng(seed)
    ends = rng.integers(0, count, (edges, 2))
    emitted = np.where(rng.random((count, words)) < 0.2, rng.integers(0, 2**63, (count, words)), 0).astype(np.uint64)
    keep = rng.integers(0, 2**63, (count, words)).astype(np.uint64) << np.uint64(1)
    keep[rng.random(count) < 0.6] = ~np.uint64(0)
    bits = 64 * words
    derivations = np.column_stack([rng.integers(0, count, 6), rng.integers(0, bits, (6, 2))])
    return ends, emitted, keep, derivations


@given(st.integers(0, 2**32), st.integers(1, 40), st.integers(0, 120), st.integers(1, 3), st.integers(0, 40))
def test_the_fixpoint_is_that_of_plain_sweeps(seed: int, count: int, edges: int, words: int, split: int) -> None:
    ends, emitted, keep, derivations = random_case(seed, count, edges, words)
    graph = Edges.of(count, ends[:, 0], ends[:, 1], min(split, count))
    got = fixpoint(graph, emitted, keep, derivations)
    expected = sweeps(ends, emitted, keep, derivations)
    for fast, plain in zip(got, expected, strict=True):
        assert np.array_equal(fast, plain)


@pytest.mark.parametrize("share", [0.0, 2.0])
def test_pulling_and_pushing_give_the_same(share: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(flow, "DENSE", share)  # always pull, always push
    ends, emitted, keep, derivations = random_case(7, 200, 700, 2)
    got = fixpoint(Edges.of(200, ends[:, 0], ends[:, 1], 90), emitted, keep, derivations)
    expected = sweeps(ends, emitted, keep, derivations)
    for fast, plain in zip(got, expected, strict=True):
        assert np.array_equal(fast, plain)


def test_a_long_chain_and_a_hub_are_carried_to_their_ends() -> None:
    count = 3000
    chain = np.arange(count - 1)
    sources = np.concatenate([chain, np.arange(1, count, 3), np.zeros(500, np.int64)])
    targets = np.concatenate([chain + 1, np.zeros(len(range(1, count, 3)), np.int64), np.arange(500)])
    emitted = np.zeros((count, 1), np.uint64)
    emitted[17] = 1
    keep = np.full((count, 1), ~np.uint64(0))
    _, leaves = fixpoint(Edges.of(count, sources, targets), emitted, keep, np.empty((0, 3), np.int64))
    assert leaves.sum() == count


def test_what_is_put_in_is_left_as_it_is() -> None:
    ends, emitted, keep, derivations = random_case(3, 50, 120, 1)
    before = emitted.copy(), keep.copy(), derivations.copy()
    fixpoint(Edges.of(50, ends[:, 0], ends[:, 1]), emitted, keep, derivations)
    assert all(np.array_equal(a, b) for a, b in zip(before, (emitted, keep, derivations), strict=True))


def test_a_graph_without_edges_or_bits() -> None:
    none = np.empty(0, np.int64)
    emitted = np.array([[1], [0]], np.uint64)
    keep = np.full((2, 1), ~np.uint64(0))
    arrives, leaves = fixpoint(Edges.of(2, none, none), emitted, keep, np.empty((0, 3), np.int64))
    assert arrives.tolist() == [[0], [0]]
    assert leaves.tolist() == [[1], [0]]
