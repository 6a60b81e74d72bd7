"""Dominators are what the definition says: without one of them its vertex cannot be reached any more."""

from __future__ import annotations

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.kernel.dominators import immediate_dominators

EDGES = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), max_size=30)


def following(edges: list[tuple[int, int]]) -> dict[int, list[int]]:
    targets: dict[int, list[int]] = {}
    for here, there in edges:
        targets.setdefault(here, []).append(there)
    return targets


def reached(edges: list[tuple[int, int]], without: int) -> set[int]:
    graph = nx.DiGraph([(a, b) for a, b in edges if without not in (a, b)])
    graph.add_node(0)
    return {0} | nx.descendants(graph, 0) if without else set()


@given(EDGES)
def test_they_are_what_every_path_passes(edges: list[tuple[int, int]]) -> None:
    dominators = immediate_dominators(following(edges), 0)
    assert set(dominators) == reached(edges, -1) - {0}
    for vertex in dominators:
        above, strict = vertex, set()
        while above != 0:
            above = dominators[above]
            strict.add(above)
        assert strict == {one for one in range(10) if one != vertex and vertex not in reached(edges, one)}


@given(EDGES)
def test_they_are_those_of_networkx(edges: list[tuple[int, int]]) -> None:
    graph = nx.DiGraph(edges)
    graph.add_node(0)
    theirs = {vertex: above for vertex, above in nx.immediate_dominators(graph, 0).items() if vertex != 0}
    assert immediate_dominators(following(edges), 0) == theirs


def test_circles_that_are_entered_at_several_places_take_several_rounds() -> None:
    """Figure 4 of Cooper, Harvey and Kennedy, A Simple, Fast Dominance Algorithm: all hang on the start alone."""
    following = {0: [5, 4], 5: [1], 4: [2, 3], 1: [2], 2: [1, 3], 3: [2]}
    assert immediate_dominators(following, 0) == dict.fromkeys(range(1, 6), 0)


def test_a_long_chain_is_no_deep_recursion() -> None:
    chain = {at: [at + 1] for at in range(50_000)}
    assert immediate_dominators(chain, 0) == {at + 1: at for at in range(50_000)}
