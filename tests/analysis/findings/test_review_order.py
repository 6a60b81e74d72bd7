"""The order of review (S11): what stands behind an open element is what vanishes when a label ends the data there."""

from __future__ import annotations

from dataclasses import replace

import networkx as nx
from hypothesis import assume, given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.review_order import immediate_dominators, review_order
from rosprivacy.analysis.model import Bound, Element, Flow, FlowGraph, Method, NonRosFacts, Place, Statement
from rosprivacy.analysis.non_ros import by_kind
from tests.helpers.systems import HIERARCHY, System, systems

EVERY = Statement("sanitizer", (), (99, 99), Place("more", 1), Method.DROP)
NO_CHANNEL = Statement("mundane", (), (99, 99), Place("more", 1))


@given(systems())
def test_what_is_only_past_an_element_vanishes_with_it_and_data_comes_from_where_it_says(system: System) -> None:
    graph, bound = system.graph(), system.bound()
    try:
        before = analyse(graph, bound, HIERARCHY)
    except InputErrors:
        assume(False)
    order = review_order(before)
    assert set(order) == {question.element.shown_as for question in before.open}
    for question in before.open:
        behind = order[question.element.shown_as]
        brings = {
            graph.elements[flow.source].shown_as
            for index, flow in enumerate(graph.flows)
            if graph.elements[flow.target].shown_as == question.element.shown_as
            and not set(before.spread.names(before.spread.along(index))).isdisjoint(question.categories)
        }
        assert behind.through.shown_as in brings if behind.through else not brings  # what is open there, not anything
        vertices = [v for v, e in enumerate(graph.elements) if e.shown_as == question.element.shown_as]
        said = NO_CHANNEL if question.element.is_channel else EVERY
        if any(s.role in ("source", "derivation") for v in vertices for s in bound.elements.get(v, ())):
            continue  # what begins here does not end with what comes in
        elements = {**bound.elements, **{v: (*bound.elements.get(v, ()), said) for v in vertices}}
        after = analyse(graph, replace_elements(bound, elements), HIERARCHY)
        left = {q.element.shown_as for q in after.open} - {question.element.shown_as}
        gone = {q.element.shown_as for q in before.open} - left - {question.element.shown_as}
        assert behind.closes <= len(gone)  # 'at least'
        if behind.waits:
            assert {q.element.shown_as for q in before.open if not q.element.is_channel} <= left
            assert [f.id for f in after.findings] == [f.id for f in before.findings]


def test_a_channel_before_a_storage_that_keeps_too_long_cannot_wait() -> None:
    """Found by random systems: only leaks were asked for, and a storage without a retention is a finding too (S10)."""
    elements = (Element("node", "/camera"), Element("storage", "disk"), Element("topic", "/video"))
    flows = (Flow(0, 2, "publish"), Flow(2, 1, "flow"))
    said = {0: (Statement("source", ("Any",), (1, 0), Place("labels", 1)),), 1: by_kind(elements[1])}
    bound = Bound(said, outside={1: NonRosFacts(country="DE", area="eea")})
    analysis = analyse(FlowGraph(elements, flows, (), ()), bound, HIERARCHY)
    assert [finding.kind for finding in analysis.findings] == ["storage-limitation"]
    assert not review_order(analysis)[elements[2].shown_as].waits


def replace_elements(bound: Bound, elements: dict[int, tuple[Statement, ...]]) -> Bound:
    return replace(bound, elements=elements)


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
def test_dominators_are_what_every_path_passes(edges: list[tuple[int, int]]) -> None:
    dominators = immediate_dominators(following(edges), 0)
    assert set(dominators) == reached(edges, -1) - {0}
    for vertex in dominators:
        above, strict = vertex, set()
        while above != 0:
            above = dominators[above]
            strict.add(above)
        assert strict == {one for one in range(10) if one != vertex and vertex not in reached(edges, one)}


@given(EDGES)
def test_dominators_are_those_of_networkx(edges: list[tuple[int, int]]) -> None:
    graph = nx.DiGraph(edges)
    graph.add_node(0)
    theirs = {vertex: above for vertex, above in nx.immediate_dominators(graph, 0).items() if vertex != 0}
    assert immediate_dominators(following(edges), 0) == theirs


def test_dominators_of_a_long_chain_are_no_deep_recursion() -> None:
    chain = {at: [at + 1] for at in range(50_000)}
    assert immediate_dominators(chain, 0) == {at + 1: at for at in range(50_000)}
