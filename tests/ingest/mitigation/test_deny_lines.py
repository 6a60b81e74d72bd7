"""Grants set to DENY against brute force: policies built anew with every set of lines denied (rules S3 to S6)."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.mitigation.limits import DENY, Limits, Weights
from rosprivacy.analysis.mitigation.propose import MitigatedSystem, mitigate, open_findings
from rosprivacy.analysis.model import Bound, Element, Grant, Method, Place, Policy, Profile, Statement
from rosprivacy.ingest.mitigation.deny_lines import Denials, open_ended, with_denied
from rosprivacy.ingest.policies.flow_graph import build
from tests.helpers.systems import HIERARCHY, statement

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.analysis.model import FlowGraph

ENCLAVES = ("/e1", "/e2")
NODES = ("/n0", "/n1", "/n2", "/n3")
ROLES = {"topic": ("publish", "subscribe"), "service": ("request", "reply"), "action": ("call", "execute")}
NAMES = ("/a", "/b", "/a*", "/*", "/a/_action/feedback")

Said = dict[str, list[Statement]]


@st.composite
def policies(draw: st.DrawFn, kinds: tuple[str, ...] = ("topic", "topic", "service", "action")) -> Policy:
    """Few names, so that lines cover each other; nodes stand in one or two enclaves."""
    homes = {node: draw(st.sets(st.sampled_from(ENCLAVES), min_size=1)) for node in NODES}
    profiles = [Profile(e, node, Place("p", 0)) for node, some in homes.items() for e in sorted(some)]
    grants = []
    for line in range(1, draw(st.integers(3, 9)) + 1):
        profile, kind = draw(st.sampled_from(profiles)), draw(st.sampled_from(kinds))
        role, name = draw(st.sampled_from(ROLES[kind])), draw(st.sampled_from(NAMES if kind == "topic" else NAMES[:3]))
        allow = draw(st.integers(0, 9)) > 0
        grants.append(Grant(allow, role, kind, name, profile.enclave, profile.node, Place("p", line)))
    return Policy("p", (), tuple(profiles), tuple(grants))


SAID = st.fixed_dictionaries(
    {
        "/n0": st.just([statement("source", "Face")]),
        "/n1": st.just([statement("leak", "Bio")]),
        "/n2": st.sampled_from([[], [statement("source", "Loc")], [statement("derivation", "Face", to="Loc")]]),
        "/n3": st.sampled_from([[], [statement("leak", "Loc")], [statement("sanitizer", "Face", method=Method.DROP)]]),
    }
)


def system_of(some: Collection[Policy], said: Said, view: str) -> MitigatedSystem:
    def made(changed: Iterable[Policy]) -> tuple[FlowGraph, Bound]:
        graph = build(changed, view)
        elements = {v: tuple(said[e.name]) for v, e in enumerate(graph.elements) if e.is_node and said.get(e.name)}
        return graph, Bound(elements)

    graph, bound = made(some)
    return MitigatedSystem(
        graph, bound, HIERARCHY, Options(), Denials(some, graph).of,
        lambda grants: made(with_denied(some, grants)), open_ended,
    )  # fmt: skip


def analysed(system: MitigatedSystem) -> Analysis:
    return analyse(system.graph, system.bound, system.hierarchy, system.options)


def left(analysis: Analysis, names: Collection[str]) -> set[str]:
    return {finding.id for finding in open_findings(analysis) if finding.category in names}


def keys(graph: FlowGraph) -> set[tuple[object, ...]]:
    """Flows by what a reader sees, with the part of a wildcard that is not denied."""
    return {
        (*((e.shown_as, e.side, e.without) for e in (graph.elements[f.source], graph.elements[f.target])), f.role)
        for f in graph.flows
    }


@given(policies(), st.sampled_from(["declared", "enforced"]), st.data())
def test_what_is_said_to_go_goes_and_nothing_that_is_not_named(policy: Policy, view: str, data: st.DataObject) -> None:
    graph = build([policy], view)
    if not graph.flows:
        return
    some = data.draw(st.sets(st.integers(0, len(graph.flows) - 1), min_size=1))
    found = Denials([policy], graph).of(some)
    granted = {f for f in some if graph.flows[f].grants}
    used = {v for flow in graph.flows if flow.grants for v in (flow.source, flow.target)}
    assert granted <= {f for denial in found for f in denial.flows}  # for each there is a way to cut it
    for denial in found:
        after = keys(build(with_denied([policy], denial.grants), view))
        for f, flow in enumerate(graph.flows):
            ends = (graph.elements[flow.source], graph.elements[flow.target])
            key = (*((e.shown_as, e.side, e.without) for e in ends), flow.role)
            if f in denial.flows:
                assert key not in after
            elif f not in denial.touched and {flow.source, flow.target} <= used:  # a wildcard that nobody has is dead
                assert key in after


def sets_of_lines(policy: Policy, most: int) -> Iterator[tuple[Grant, ...]]:
    lines = [grant for grant in dict.fromkeys(policy.grants) if grant.allow]
    for size in range(most + 1):
        yield from combinations(lines, size)


@given(policies(), SAID, st.sampled_from(["declared", "enforced"]))
def test_no_fewer_lines_remove_what_a_proposal_removes(policy: Policy, said: Said, view: str) -> None:
    system = system_of([policy], said, view)
    found = analysed(system)
    limits = Limits(Weights(node=0, deny=1), frozenset({DENY}))
    for proposal in mitigate(system, found, limits):
        assert proposal.proven
        grants = [grant for step in proposal.steps for grant in step.grants]
        after = analysed(system_of(with_denied([policy], grants), said, view))
        kept = {one.finding.id for one in proposal.remaining}
        assert left(after, proposal.categories) == kept
        for fewer in sets_of_lines(policy, proposal.lower - 1):
            other = analysed(system_of(with_denied([policy], fewer), said, view))
            assert not left(other, proposal.categories) <= kept


@given(policies(), SAID, st.sampled_from(["declared", "enforced"]))
def test_the_cheapest_of_filters_and_lines_together_is_proven(policy: Policy, said: Said, view: str) -> None:
    system = system_of([policy], said, view)
    for proposal in mitigate(system, analysed(system), Limits(Weights(2, 2, 1, 2))):
        assert proposal.proven
        assert proposal.lower <= proposal.cost


@given(policies(kinds=("topic",)), SAID, st.sampled_from(["declared", "enforced"]))
def test_a_filter_that_is_really_built_removes_what_its_proposal_says(policy: Policy, said: Said, view: str) -> None:
    """Rule S6: in its own enclave, with the right to the raw data taken from whoever gets the filtered data."""
    system = system_of([policy], said, view)
    for proposal in mitigate(system, analysed(system), Limits(kinds=frozenset({"filter"}))):
        assert proposal.proven
        built, roles = policy, dict(said)
        for number, step in enumerate(proposal.steps):
            built = install(built, step, number)
            roles[f"/filter_{number}"] = [statement("sanitizer", c, method=Method.ANONYMISE) for c in step.categories]
        after = analysed(system_of([built], roles, view))
        assert left(after, proposal.categories) == {one.finding.id for one in proposal.remaining}


def install(policy: Policy, step: ProposedStep, number: int) -> Policy:
    """Build a filter into a policy as an engineer would: a new node in a new enclave, and a new topic."""
    filter_, other, place = f"/filter_{number}", f"/unfiltered_data/{number}", Place("p", 1000 + number)
    moved = [g._replace(name=other, place=place) if g in step.grants else g for g in policy.grants]
    mine = [(g.role, g.name) for g in step.grants]
    mine += [("subscribe" if role == "publish" else "publish", other) for role, _ in mine]
    enclave = f"/of{filter_}"
    own = (Grant(True, role, "topic", name, enclave, filter_, place) for role, name in dict.fromkeys(mine))
    profiles = (*policy.profiles, Profile(enclave, filter_, place))
    return replace(policy, grants=(*moved, *own), profiles=profiles)


@pytest.mark.parametrize("view", ["declared", "enforced"])
def test_a_line_with_a_wildcard_cuts_all_that_it_grants(view: str) -> None:
    profiles = tuple(Profile(f"/e{n}", n, Place("p", 0)) for n in ("/camera", "/cloud"))
    names = ("/a", "/b", "/c")
    grants = (
        *(Grant(True, "publish", "topic", n, "/e/camera", "/camera", Place("p", i)) for i, n in enumerate(names, 1)),
        Grant(True, "subscribe", "topic", "/*", "/e/cloud", "/cloud", Place("p", 9)),
    )
    said = {"/camera": [statement("source", "Face")], "/cloud": [statement("leak", "Face")]}
    system = system_of([Policy("p", (), profiles, grants)], said, view)
    limits = Limits(kinds=frozenset({DENY}))
    (proposal,) = mitigate(system, analysed(system), limits)
    (step,) = proposal.steps
    assert [grant.place.line for grant in step.grants] == [9]
    assert step.readers == (Element("node", "/cloud"),)
    assert proposal.cost == proposal.lower == limits.weights.deny
    (less,) = proposal.affected
    assert less.unread == (("", "topic", "/*", ""),)
