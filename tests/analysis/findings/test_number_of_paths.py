"""Paths that share no flow are counted as networkx finds them, without the list."""

from __future__ import annotations

from itertools import product

import networkx as nx
from hypothesis import example, given
from hypothesis import strategies as st

from rosprivacy.analysis.bounds import BOUNDS, Tally
from rosprivacy.analysis.findings.disjoint_in_groups import number_in_groups
from rosprivacy.analysis.findings.further_paths import number_disjoint
from rosprivacy.analysis.findings.paths_of_source import NumberOfPaths
from rosprivacy.analysis.kernel.search import search
from rosprivacy.analysis.kernel.states import Net
from tests.helpers.systems import System, statement

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
    a, b, c, d = range(1, 5)
    edges = sorted([(START, a), (a, b), (b, END), (START, c), (c, b), (a, d), (d, 5), (5, END)])
    assert number_disjoint(edges, START, END, Tally(BOUNDS, "path_steps")) == 2


def test_the_work_is_counted_and_is_that_of_a_path_each() -> None:
    wide = sorted(edge for i in range(11, 511) for edge in ((START, i), (i, END)))
    work = Tally(BOUNDS, "path_steps")
    assert number_disjoint(wide, START, END, work) == 500
    assert len(wide) <= work.count <= 500 * len(wide)


def test_of_a_path_each_step_counts_where_it_is_looked_at() -> None:
    """The bound cuts at the same place on every machine (S14): what is counted is told here to the last step."""
    looked_at = 2 * 2  # from each of two states: the state, and the one step on
    work = Tally(BOUNDS, "path_steps")
    assert number_disjoint([(START, 1), (1, END)], START, END, work) == 1
    assert work.count == looked_at
    work = Tally(BOUNDS, "path_steps")
    assert number_in_groups([(START, 1), (1, END)], [], START, END, work) == 1
    assert work.count == 2 * looked_at + 2  # for the layers, for the path, and its steps once more
    work = Tally(BOUNDS, "path_steps")
    assert number_in_groups([(1, END)], [([START], [1])], START, END, work) == 1
    assert work.count == 2 * looked_at + 3  # a member of a group is as a step, and seen again after the path took it


def test_of_a_source_each_step_counts_once_and_again_for_each_leak() -> None:
    """/n0 -> /t4 -> /n2 -> /t6 -> /n1, and the same by /t5, /n3 and /t7: eight steps."""
    edges = [(0, 4), (0, 5), (2, 6), (3, 7), (4, 2), (5, 3), (6, 1), (7, 1)]
    said = {0: [statement("source", "Face")], 1: [statement("leak", "Face")]}
    spread = System(4, 4, edges, said, {}).analyse().spread
    net, work, longer = Net.of(spread), Tally(BOUNDS, "path_steps"), Tally(BOUNDS, "path_steps")
    paths = NumberOfPaths(net, search(net, [0], spread.all_bits, {}), 0, {}, work)
    assert work.count == len(edges)
    assert paths.to(1, 0) == number_disjoint(edges, 0, 1, longer) == 2
    assert work.count == len(edges) + (2 + 2) + 2 * len(edges) + longer.count  # ends; what leads there; a search
    assert paths.to(1, 0) == 2
    assert work.count == len(edges) + 2 * (2 + 2) + 2 * len(edges) + longer.count  # it is remembered


MEMBERS = st.lists(STATES, min_size=1, max_size=4, unique=True).map(sorted)


@given(EDGES, st.lists(st.tuples(MEMBERS, MEMBERS), max_size=3))
def test_groups_are_worth_as_many_paths_as_their_pairs(
    edges: list[tuple[int, int]],
    groups: list[tuple[list[int], list[int]]],
) -> None:
    """A step is there once: what an earlier group has is no pair of a later one, nor a step of its own."""
    kept: list[tuple[list[int], list[int]]] = []
    pairs: set[tuple[int, int]] = set()
    for befores, afters in groups:
        new = set(product(befores, afters))
        if not new & pairs and all(b not in (a, START) and a != END for a, b in new):
            pairs |= new
            kept.append((befores, afters))
    single = [edge for edge in edges if edge not in pairs]
    found = number_in_groups(single, kept, START, END, Tally(BOUNDS, "path_steps"))
    assert found == len(list(nx.edge_disjoint_paths(nx.DiGraph([*single, *pairs]), START, END)))


def test_a_thousand_times_a_thousand_pairs_take_as_much_work_as_their_members() -> None:
    written, read = list(range(11, 1_011)), list(range(2_001, 3_001))
    ends = [*((START, state) for state in written), *((state, 4_000) for state in read)]
    work = Tally(BOUNDS, "path_steps")
    assert number_in_groups(ends, [(written, read)], START, 4_000, work) == 1_000
    assert work.count < 20 * len(ends)
