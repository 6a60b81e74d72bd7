"""Proposals against brute force: nothing is left by them, and no cheaper set of changes leaves nothing (S8, S10)."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, islice, pairwise
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.mitigation.limits import FILTER, REVIEW, Limits, Weights
from rosprivacy.analysis.mitigation.proposals import NOT_ALLOWED
from rosprivacy.analysis.mitigation.propose import MitigatedSystem, mitigate, open_findings
from tests.helpers.systems import HIERARCHY, PARENTS, statement, systems
from tests.helpers.systems import System as Random

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.case import Case
    from rosprivacy.analysis.mitigation.proposals import Proposal, ProposedStep
    from rosprivacy.analysis.model import Bound, Element, FlowGraph


def no_denial(_: object) -> tuple[()]:
    return ()


def never_called(_: object) -> tuple[FlowGraph, Bound]:
    raise AssertionError


def system_of(random: Random, options: Options | None = None) -> MitigatedSystem:
    return MitigatedSystem(random.graph(), random.bound(), HIERARCHY, options or Options(), no_denial, never_called)


def analysed(system: MitigatedSystem) -> Analysis | None:
    """None where the labels contradict each other."""
    try:
        return analyse(system.graph, system.bound, system.hierarchy, system.options)
    except InputErrors:
        return None


def with_changes(random: Random, filters: Iterable[int], reviews: dict[int, set[str]]) -> Random:
    """The system after filters of everything in some flows, and reviews that find some channels to carry none."""
    said = {v: list(labels) for v, labels in random.said.items()}
    for channel, names in reviews.items():
        said[channel] = [*said.get(channel, []), statement("never", *sorted(names))]
    never = {i: set(names) for i, names in random.never.items()}
    for flow in filters:
        never[flow] = {*never.get(flow, set()), "Any"}
    return replace(random, said=said, never=never)


Key = tuple[str, str, int, int]  # kind, category, source, leak


def left(random: Random, accepted: set[Key] | None = None) -> set[Key]:
    """The open findings by brute force."""
    taken = accepted or set()
    found = random.brute().findings(lambda c, s, leak, _: ("disclosure", c, s, leak) in taken)
    return {key[:4] for key, (_, dismissed, _) in found.items() if not dismissed} - taken


def key_of(finding: Finding, number: dict[Element, int]) -> Key:
    return (finding.kind, finding.category, number[finding.source], number[finding.leak])


def cheaper(random: Random, weights: Weights, than: int) -> Iterator[Random]:
    """The system after each set of changes that costs less: filters in any flows, reviews of any open channels."""
    questions = {v: names for v, (names, _, _) in random.brute().open().items() if v >= random.nodes}
    units = [(FILTER, i, weights.filter) for i in range(len(random.edges))]
    units += [(REVIEW, v, weights.review) for v in questions]
    for size in range(len(units) + 1):
        if size * min(weights.filter, weights.review) >= than:
            return
        for some in combinations(units, size):
            if sum(cost for _, _, cost in some) < than:
                reviews = {v: questions[v] for kind, v, _ in some if kind == REVIEW}
                yield with_changes(random, [i for kind, i, _ in some if kind == FILTER], reviews)


def applied(random: Random, proposal: Proposal) -> Random:
    """The system with a proposal applied, by the names that it prints."""
    graph = random.graph()
    number = {element: v for v, element in enumerate(graph.elements)}
    said = {v: list(labels) for v, labels in random.said.items()}
    never = {i: set(names) for i, names in random.never.items()}
    for step in proposal.steps:
        if step.channel:
            said.setdefault(number[step.channel], []).append(statement("never", *step.categories))
        for source, target in step.between:
            i = random.edges.index((number[source], number[target]))
            never[i] = {*never.get(i, set()), *step.categories}
    return replace(governed(random, proposal), said=said, never=never)


def governed(random: Random, proposal: Proposal) -> Random:
    """The system with the one line of its governance changed, if the proposal says so."""
    return replace(random, exposed=frozenset()) if proposal.protect else random


WEIGHTS = st.builds(Weights, review=st.integers(1, 3), filter=st.integers(1, 3), node=st.just(0))
SMALL = systems(most=4, degree=2)
MOST = 500  # cheaper sets that are tried, the smallest first; most systems have fewer


@given(SMALL, WEIGHTS)
def test_a_proposal_leaves_nothing_and_no_cheaper_one_does(random: Random, weights: Weights) -> None:
    system = system_of(random)
    found = analysed(system)
    if found is None:
        return
    proposals = mitigate(system, found, Limits(weights))
    number = {element: v for v, element in enumerate(found.graph.elements)}
    for proposal in proposals:
        assert proposal.proven
        kept = {key_of(k.finding, number) for k in proposal.remaining}
        assert all(source == leak for _, _, source, leak in kept)  # with nothing forbidden, all else can be cut
        after = {key for key in left(applied(random, proposal)) if key[1] in proposal.categories}
        assert after == kept
        assert proposal.lower <= proposal.cost
        for other in islice(cheaper(governed(random, proposal), weights, proposal.lower), MOST):
            assert not {key for key in left(other) if key[1] in proposal.categories} <= kept
    names = {finding.category for finding in open_findings(found)}
    assert {p.categories for p in proposals if len(p.categories) == 1} == {(name,) for name in names}
    assert len(names) < 2 or set(proposals[-1].categories) == names


@given(SMALL, WEIGHTS)
def test_on_small_systems_the_cheapest_is_found(random: Random, weights: Weights) -> None:
    system = system_of(random)
    found = analysed(system)
    if found is not None:
        assert all(proposal.cost == proposal.lower for proposal in mitigate(system, found, Limits(weights)))


@pytest.mark.slow
@given(systems(), st.integers(0, 3))
def test_what_is_said_to_be_the_bound_is_one(random: Random, budget: int) -> None:
    """Without a search the cost lies between the bound and what is the cheapest with one."""
    system = system_of(random)
    found = analysed(system)
    if found is None:
        return
    for quick, thorough in zip(mitigate(system, found, budget=budget), mitigate(system, found), strict=True):
        assert quick.proven
        assert quick.lower <= thorough.lower == thorough.cost <= quick.cost


@given(systems(), st.data())
def test_an_accepted_finding_is_left_and_what_lies_behind_it_is_removed(random: Random, data: st.DataObject) -> None:
    system = system_of(random)
    plain = analysed(system)
    if plain is None or not plain.findings:
        return
    number = {element: v for v, element in enumerate(plain.graph.elements)}
    keys = sorted({key_of(finding, number) for finding in plain.findings})
    taken = set(data.draw(st.lists(st.sampled_from(keys))))

    def accepts(case: Case) -> bool:
        return (case.kind, case.category, number[case.source], number[case.leak]) in taken

    system = replace(system, options=Options(accepts=accepts))
    found = analysed(system)
    assert found is not None
    for proposal in mitigate(system, found):
        assert proposal.proven
        after = {key for key in left(applied(random, proposal), taken) if key[1] in proposal.categories}
        assert after == {key_of(kept.finding, number) for kept in proposal.remaining}


def flows_between(random: Random, number: dict[Element, int], step: ProposedStep) -> set[int]:
    ends = {(number[source], number[target]) for source, target in step.between}
    return {i for i, edge in enumerate(random.edges) if edge in ends}


def goes_on(random: Random, flow: tuple[int, int], category: str) -> set[int]:
    """Where data of a category that goes along a flow gets, leaks being ends; none if it does not go there."""
    brute = random.brute()
    brute.spread(brute.sources())
    along = {(a, b, data[0]) for a, b, data in brute.along}
    if (*flow, category) not in along:
        return set()
    reached, waiting = {(flow[1], category)}, [(flow[1], category)]
    while waiting:
        vertex, here = waiting.pop()
        if brute.has(vertex, "leak", here):
            continue
        leaving = {made for made, _ in brute.made(vertex, (here, False))}
        leaving |= {here} if not brute.kills(vertex, here) or brute.only_hides(vertex, here) else set()
        leaving -= {c for c in leaving if brute.has(vertex, "leak", c)}
        new = {(b, c) for a, b, c in along if a == vertex and c in leaving} - reached
        reached |= new
        waiting += new
    return {vertex for vertex, _ in reached}


@given(systems(), st.data())
def test_nothing_on_the_way_to_a_time_critical_node_is_filtered(random: Random, data: st.DataObject) -> None:
    system = system_of(random)
    found = analysed(system)
    if found is None:
        return
    critical = frozenset(data.draw(st.sets(st.integers(0, random.nodes - 1), min_size=1, max_size=2)))
    number = {element: v for v, element in enumerate(found.graph.elements)}
    for proposal in mitigate(system, found, Limits(critical=critical)):
        assert proposal.proven
        assert not {number[element] for step in proposal.steps for element in step.readers} & critical
        touched = {f for step in proposal.steps for f in flows_between(random, number, step)}
        assert not any(goes_on(random, random.edges[f], c) & critical for f in touched for c in PARENTS)
        for kept in proposal.remaining:
            if kept.reason == NOT_ALLOWED:
                way = [number[element] for element in kept.path]
                assert (way[0], way[-1]) == (number[kept.finding.source], number[kept.finding.leak])
                assert set(pairwise(way)) <= set(random.edges)
