"""The maximum flow and the cut beside it, against networkx."""

from __future__ import annotations

import networkx as nx
from hypothesis import assume, given
from hypothesis import strategies as st

from rosprivacy.analysis.mitigation.min_cut import maximum_flow

VERTICES = st.integers(0, 7)
ARCS = st.tuples(VERTICES, VERTICES).filter(lambda arc: arc[0] != arc[1])
CAPACITIES = st.none() | st.integers(0, 9)


@given(st.dictionaries(ARCS, CAPACITIES, max_size=25))
def test_the_flow_and_the_cut_nearest_to_the_end_are_those_of_networkx(
    capacities: dict[tuple[int, int], int | None],
) -> None:
    graph: nx.DiGraph[int] = nx.DiGraph()
    graph.add_nodes_from(range(8))
    for (tail, head), capacity in capacities.items():
        graph.add_edge(tail, head, **({} if capacity is None else {"capacity": capacity}))
    endless = [arc for arc, capacity in capacities.items() if capacity is None]
    assume(not nx.has_path(nx.DiGraph([*endless, (0, 0), (1, 1)]), 0, 1))
    value, (_, far) = nx.minimum_cut(graph, 0, 1)
    assert maximum_flow(capacities, 0, 1) == (value, far)
