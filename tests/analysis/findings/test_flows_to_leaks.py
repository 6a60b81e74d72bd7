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
Step = tuple[tuple[int, "Data", bool], tuple[int, "Data", bool]]  # whether it arrives, or only starts
BEGIN, END = (-1, ("", False), False), (-2, ("", False), False)


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

    def steps(self) -> set[Step]:
        """From ``BEGIN`` to ``END``; what starts where the same would go on, or end, if it came back is one state."""
        edges: set[Step] = set()
        for vertex in self.brute.sources():
            for data in self.brute.emitted(vertex):
                ends = self.stops(vertex, data[0]) and self.leak in (None, vertex)
                one = ends or data in self.leaving(vertex, data)
                edges.add((BEGIN, (vertex, data, one)))
                edges |= {((vertex, data, one), (target, data, True)) for target in self.flows(vertex, data)}
        waiting = [state for _, state in edges]
        seen = set(waiting)
        while waiting:
            state = waiting.pop()
            vertex, data, arrived = state
            new = {(t, d, True) for d in self.leaving(vertex, data) if arrived for t in self.flows(vertex, d)}
            edges |= {(state, after) for after in new}
            if arrived and self.arrives(vertex, data):
                edges.add((state, END))
            waiting += [after for after in new if after not in seen]
            seen |= new
        return edges


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


def without_detours(steps: set[Step]) -> set[Step]:
    """Rounds: what leads to the end, but not u -> v where all ways to u, or on from v, are by the other."""
    back = {(b, a) for a, b in steps}
    while True:
        ahead, behind = reached(steps, BEGIN), reached(back, END)
        between = {(a, b) for a, b in steps if a in ahead and b in behind}
        back = {(b, a) for a, b in between}
        kept = {
            (a, b) for a, b in between if a in reached(between, BEGIN, without=b) and b in reached(back, END, without=a)
        }
        if kept == steps:
            return kept
        steps, back = kept, {(b, a) for a, b in kept}


def reached(steps: set[Step], start: object, without: object = None) -> set[object]:
    seen, waiting = {start}, [start]
    while waiting:
        here = waiting.pop()
        new = {b for a, b in steps if a == here and b != without} - seen
        seen |= new
        waiting += new
    return seen - {without}


@given(systems(most=4), st.booleans())
def test_detours_that_come_back_are_left_out_in_rounds(system: System, one: bool) -> None:  # noqa: FBT001 - drawn
    found = analysed(system)
    if found is None:
        return
    net, brute = Net.of(found.spread), system.brute()
    for category in {finding.category for finding in found.findings}:
        for leak in [v for v in brute.nodes if brute.has(v, "leak", category)] if one else [None]:
            walks = Walks(brute, category, leak, past_leaks=False)
            expected = {(a[0], b[0]) for a, b in without_detours(walks.steps()) if a != BEGIN and b != END}
            got = flows_to_leaks(net, category, leaks=None if leak is None else [leak])
            assert {system.edges[flow] for flow in got.flows} == expected


def test_detours_that_must_come_back_are_left_out() -> None:
    """0 sends to 1 through topic 4; what 0 and 2 say to each other through topics 5 and 6 leads nowhere else."""
    edges = [(0, 4), (4, 1), (0, 5), (5, 2), (2, 6), (6, 0)]
    labels = {0: [statement("source", "Any"), statement("source", "Face")], 1: [statement("leak", "Face")]}
    system = System(4, 3, sorted(edges), labels, {})
    found = system.analyse()
    got = flows_to_leaks(Net.of(found.spread), "Face")
    assert {system.edges[flow]: length for flow, length in got.flows.items()} == {(0, 4): 2, (4, 1): 2}


def test_what_comes_to_a_source_goes_on_no_way_of_its_own_data() -> None:
    """1 -> 0 -> 2, where 0 emits faces too, and is a leak of what comes that nobody asks about."""
    edges = [(0, 4), (1, 3), (3, 0), (4, 2)]
    source, leak = statement("source", "Face"), statement("leak", "Face")
    net = Net.of(System(3, 2, edges, {0: [source, leak], 1: [source], 2: [leak]}, {}).analyse().spread)
    assert {edges[flow] for flow in flows_to_leaks(net, "Face", leaks=[2]).flows} == {(0, 4), (4, 2)}


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


def test_the_longest_that_leave_no_more_flows_than_asked_for_are_in() -> None:
    """From 0 to 1 along ways of two, four and six flows; where two are too many, the shortest are in all the same."""
    edges = [(0, 5), (5, 1), (5, 2), (2, 6), (6, 1), (6, 3), (3, 7), (7, 1)]
    labels = {0: [statement("source", "Face")], 1: [statement("leak", "Face")]}
    net = Net.of(System(5, 3, edges, labels, {}).analyse().spread)
    for about in range(10):
        got = flows_to_leaks(net, "Face", about=about)
        up_to = 2 if about < 5 else 5 if about < 8 else 8
        assert (len(got.flows), got.complete) == (up_to, up_to == 8)


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
        assert part.flows == whole.flows or not part.complete
        assert set(part.flows) <= set(whole.flows)
        longest = max(part.flows.values(), default=0)
        walks = Walks(system.brute(), finding.category, leak, past_leaks=finding.dismissed)
        for way in islice(walks.simple(source), MOST_STEPS):
            if len(way) - 1 <= longest:
                assert set(pairwise(way)) <= {system.edges[flow] for flow in part.flows}
        assert len(part.flows) <= max(about, sum(length == longest for length in part.flows.values()))
