"""Paths that share no flow are counted as networkx finds them, without the list."""

from __future__ import annotations

import networkx as nx
from hypothesis import example, given
from hypothesis import strategies as st

from rosprivacy.analysis.bounds import BOUNDS, Tally
from rosprivacy.analysis.findings.further_paths import number_disjoint

START, END = 0, 9
STATES = st.sampled_from([START, *range(1, 7), END])
EDGES = st.lists(st.tuples(STATES, STATES).filter(lambda edge: edge[0] != edge[1]), unique=True).map(
    lambda edges: sorted({*edges, (START, 1), (1, END)})  # there is a path: the leak is reached
)


@given(EDGES)
@example([(START, 1), (START, 2), (1, 2), (1, END), (2, 1), (2, END)])
def test_as_many_as_networkx_finds(edges: list[tuple[int, int]]) -> None:
    found = list(nx.edge_disjoint_paths(nx.DiGraph(edges), START, END))
    assert number_disjoint(edges, START, END, Tally(BOUNDS, "path_steps")) == len(found)


def test_the_first_path_is_taken_back_where_two_others_need_its_steps() -> None:
    """The shortest path lies across the only two that share nothing."""
    a, b, c, d, e = range(1, 6)
    edges = sorted([(START, a), (a, b), (b, END), (START, c), (c, b), (a, d), (d, e), (e, END)])
    assert number_disjoint(edges, START, END, Tally(BOUNDS, "path_steps")) == 2


def test_the_work_is_counted_and_is_that_of_a_path_each() -> None:
    wide = sorted(edge for i in range(1, 501) for edge in ((START, END + i), (END + i, END)))
    work = Tally(BOUNDS, "path_steps")
    assert number_disjoint(wide, START, END, work) == 500
    assert len(wide) <= work.count <= 500 * len(wide)
