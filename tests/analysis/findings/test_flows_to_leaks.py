"""Which flows lie on a way to a leak, against brute force: every way without a circle is in, detours are not."""

from __future__ import annotations

from itertools import islice, pairwise
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.findings.flows_to_leaks import flows_to_leaks
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.model import DISCLOSURE, Method
from tests.helpers.systems import System, analysed, index, statement, systems

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.helpers.brute import Brute, Data

MOST_STEPS = 500  # per finding
State = tuple[int, "Data"]


class Walks:
    """Rules S8 and S10 on sets: from state to state, for one category that arrives at leaks."""

    def __init__(self, brute: Brute, category: str, leak: int | None, *, past_leaks: bool) -> None:
        self.brute, self.category, self.leak, self.past_leaks = brute, category, leak, past_leaks

    def stops(self, vertex: int, category: str) -> bool:
        leaks = category == self.category and self.brute.has(vertex, "leak", category)
        return leaks and not self.past_leaks

    def arrives(self, vertex: int, data: Data) -> bool:
        """Whether this is an end: data is at a leak as the category, or is made into it there."""
        here = {data, *self.brute.made(vertex, data)}
        ends = self.leak in (None, vertex) and self.brute.has(vertex, "leak", self.category)
        return ends and any(category == self.category for category, _ in here)

    def leaving(self, vertex: int, data: Data) -> set[Data]:
        brute = self.brute
        if self.stops(vertex, data[0]):
            return set()
        kept = {data} if not brute.kills(vertex, data[0]) or (data[1] and brute.only_hides(vertex, data[0])) else set()
        return {d for d in kept | brute.made(vertex, data) if not self.stops(vertex, d[0])}

    def flows(self, vertex: int, data: Data) -> Iterator[int]:
        brute = self.brute
        for a, b in brute.edges:
            never = any(named in brute.hierarchy.ancestors[data[0]] for named in brute.never.get((a, b), ()))
            if a == vertex and not never and (b in brute.nodes or not brute.kills(b, data[0])):
                yield b

    def simple(self, source: int) -> Iterator[list[int]]:
        """Ways that meet no state twice, as vertices; empty ones for steps that come to no leak."""
        for data in self.brute.emitted(source):
            yield from self._on([source], {data}, {(source, data)})

    def _on(self, way: list[int], leaving: set[Data], met: set[State]) -> Iterator[list[int]]:
        for data in leaving:
            for target in self.flows(way[-1], data):
                if (target, data) not in met:
                    yield [*way, target] if self.arrives(target, data) else []
                    yield from self._on([*way, target], self.leaving(target, data), {*met, (target, data)})


@given(systems())
def test_every_way_without_a_circle_is_in(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    net, brute, number = Net.of(found.spread), system.brute(), index(system)
    hides = any(label.method is Method.PSEUDONYMISE for said in system.said.values() for label in said)
    for finding in found.findings:
        source, leak = number[finding.source], number[finding.leak]
        other = finding.kind != DISCLOSURE  # such a finding ends where data are kept or leave, at no leak
        ends = {leak: found.spread.forms_of(finding.category)} if other else None
        past = finding.dismissed or other
        got = flows_to_leaks(net, finding.category, sources=[source], leaks=[leak], past_leaks=past, ends=ends)
        flows = {system.edges[flow] for flow in got.flows}
        walks = Walks(brute, finding.category, leak, past_leaks=finding.dismissed)
        for way in islice(walks.simple(source), MOST_STEPS) if not other else ():
            assert set(pairwise(way)) <= flows
        assert set(pairwise(number[element] for element in finding.witness)) <= flows
        shortest = min(got.flows.values(), default=0)
        may_be_longer = hides and not finding.pseudonymised  # data as they are is shown (rule S10)
        assert not finding.steps or shortest == len(finding.steps) or (may_be_longer and shortest < len(finding.steps))


@given(systems())
def test_every_flow_that_is_in_leads_from_a_source_to_a_leak(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    net, brute = Net.of(found.spread), system.brute()
    for category in {finding.category for finding in found.findings}:
        walks = Walks(brute, category, None, past_leaks=False)
        edges, seen = set(), set()
        waiting = [(s, d, True) for s in brute.sources() for d in brute.emitted(s)]
        while waiting:
            vertex, data, starts = waiting.pop()
            for leaves in {data} if starts else walks.leaving(vertex, data):
                for target in walks.flows(vertex, leaves):
                    edges.add((vertex, data, starts, target, leaves))
                    if (target, leaves) not in seen:
                        seen.add((target, leaves))
                        waiting.append((target, leaves, False))
        good = {(v, d) for _, _, _, v, d in edges if walks.arrives(v, d)}
        while True:
            more = {(v, d) for v, d, starts, t, e in edges if (t, e) in good and not starts} - good
            if not more:
                break
            good |= more
        expected = {(v, t) for v, _, _, t, d in edges if (t, d) in good}
        assert {system.edges[flow] for flow in flows_to_leaks(net, category).flows} <= expected


def test_detours_that_must_come_back_are_left_out() -> None:
    """0 sends to 1 through topic 4; what 0 and 2 say to each other through topics 5 and 6 leads nowhere else."""
    edges = [(0, 4), (4, 1), (0, 5), (5, 2), (2, 6), (6, 0)]
    labels = {0: [statement("source", "Face")], 1: [statement("leak", "Face")]}
    system = System(4, 3, sorted(edges), labels, {})
    found = system.analyse()
    got = flows_to_leaks(Net.of(found.spread), "Face")
    assert {system.edges[flow]: length for flow, length in got.flows.items()} == {(0, 4): 2, (4, 1): 2}


def test_longer_ways_are_in_with_their_length() -> None:
    edges = [(0, 4), (4, 1), (4, 2), (2, 5), (5, 1)]
    labels = {0: [statement("source", "Face")], 1: [statement("leak", "Face")]}
    system = System(4, 2, sorted(edges), labels, {})
    found = system.analyse()
    got = flows_to_leaks(Net.of(found.spread), "Face")
    assert {system.edges[flow]: n for flow, n in got.flows.items()} == {
        (0, 4): 2,
        (4, 1): 2,
        (4, 2): 4,
        (2, 5): 4,
        (5, 1): 4,
    }


@given(systems(), st.integers(1, 12))
def test_the_shorter_ways_are_all_those_up_to_a_length(system: System, about: int) -> None:
    found = analysed(system)
    if found is None:
        return
    net, number = Net.of(found.spread), index(system)
    for finding in [one for one in found.findings if one.kind == DISCLOSURE]:
        source, leak = number[finding.source], number[finding.leak]
        whole = flows_to_leaks(net, finding.category, sources=[source], leaks=[leak], past_leaks=finding.dismissed)
        part = flows_to_leaks(
            net, finding.category, sources=[source], leaks=[leak], past_leaks=finding.dismissed, about=about
        )
        assert part.complete or len(part.flows) < len(whole.flows) or part.flows == whole.flows
        assert set(part.flows) <= set(whole.flows)
        longest = max(part.flows.values(), default=0)
        walks = Walks(system.brute(), finding.category, leak, past_leaks=finding.dismissed)
        for way in islice(walks.simple(source), MOST_STEPS):
            if len(way) - 1 <= longest:
                assert set(pairwise(way)) <= {system.edges[flow] for flow in part.flows}
        assert len(part.flows) <= max(about, sum(length == longest for length in part.flows.values()))
