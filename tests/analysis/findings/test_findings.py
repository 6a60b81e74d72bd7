"""The analysis against brute force (``helpers/brute.py``), on random graphs with cycles, derivations and both
planes."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.answer import Analysis, Verdict
from rosprivacy.analysis.case import Case
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.concerns import unprotected
from rosprivacy.analysis.findings.findings import Options
from rosprivacy.analysis.model import (
    DISCLOSURE,
    Exposure,
    Method,
    NonRosFacts,
    Place,
)
from rosprivacy.analysis.modes import Paths
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.systems import (
    HIERARCHY,
    PARENTS,
    WIDE,
    WIDE_HIERARCHY,
    System,
    analysed,
    index,
    sent,
    statement,
    systems,
)

if TYPE_CHECKING:
    from collections.abc import Iterable


@given(st.one_of(systems(), wildcards()))
def test_what_is_carried_is_what_brute_force_reaches(system: System) -> None:
    """Rules S7 and S8, all categories in one pass against sets and a queue."""
    found = analysed(system)
    if found is None:
        return
    number = index(system)
    brute = system.brute()
    expected: dict[int, tuple[set[str], set[str]]] = {}
    for vertex, (category, hidden) in sorted(brute.spread(brute.sources())):
        expected.setdefault(brute.one(vertex, expected), (set(), set()))[hidden].add(category)
    narrowest = {v: tuple(system.hierarchy.narrowest(names) for names in both) for v, both in expected.items()}
    assert {number[c.element]: (c.categories, c.pseudonymised) for c in found.carried} == narrowest


@given(st.one_of(systems(), wildcards()))
def test_what_goes_along_each_flow_is_what_brute_force_sends(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    brute = system.brute()
    brute.spread(brute.sources())
    assert sent(system, found) == brute.along


@given(st.one_of(systems(), wildcards()))
def test_findings_are_those_of_brute_force(system: System) -> None:
    """Rule S10: which (kind, category, source, leak), in which form, dismissed or not, and how short a way."""
    found = analysed(system)
    if found is None:
        return
    number = index(system)
    expected = system.brute().findings()
    assert {
        (f.kind, f.category, number[f.source], number[f.leak], f.plain_also): (
            f.pseudonymised,
            f.dismissed,
            len(f.steps),
        )
        for f in found.findings
    } == expected
    assert len({f.id for f in found.findings}) == len(found.findings)
    assert all(bool(f.reason) == (f.kind != DISCLOSURE) for f in found.findings)


@given(systems())
def test_a_witness_is_a_way_along_flows_and_names_the_leaks_that_dismiss_it(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    number, edges, brute = index(system), set(system.edges), system.brute()
    for finding in found.findings:
        way = [number[element] for element in finding.witness]
        assert way[0] == number[finding.source]
        assert way[-1] == number[finding.leak]
        assert all(step in edges for step in pairwise(way))
        assert [number[s.source] for s in finding.steps] == way[:-1]
        assert bool(finding.through) == finding.dismissed
        assert all(brute.has(number[element], "leak", finding.category) for element in finding.through)


def test_two_sources_on_a_ring_have_paths_of_their_own() -> None:
    """What leads to the storage n3 is the same set of flows for both; the paths are not."""
    source, leak = statement("source", "Any"), statement("leak", "Any")
    edges = [(0, 3), (0, 6), (2, 3), (2, 6), (3, 0), (3, 2), (3, 4), (4, 0), (6, 0)]
    said = {0: [leak], 2: [source], 4: [source], **{v: [] for v in (1, 3, 5, 6)}}
    system = System(6, 1, edges, said, {}, HIERARCHY, [("storage", NonRosFacts())] * 3, wildcard=False)
    analysis = system.analyse(Options(paths=Paths.disjoint))
    assert {f.source.name for f in analysis.findings if f.leak.name == "n3"} == {"/n2", "n4"}
    for finding in analysis.findings:
        assert {(path[0], path[-1]) for path in finding.paths} <= {(finding.source, finding.leak)}


@given(systems(), st.data())
def test_an_accepted_leak_hides_nothing_behind_it(system: System, data: st.DataObject) -> None:
    """Rule S10: a way through a leak is dismissed, unless the finding there is accepted."""
    plain = analysed(system)
    if plain is None:
        return
    number = index(system)
    keys = [(f.category, number[f.source], number[f.leak]) for f in plain.findings]
    hidden_only = data.draw(st.dictionaries(st.sampled_from(keys), st.booleans())) if keys else {}

    def accepts(case: Case) -> bool:
        return accepted(case.category, number[case.source], number[case.leak], case.pseudonymised)

    def accepted(category: str, source: int, leak: int, hidden: bool) -> bool:  # noqa: FBT001
        key = (category, source, leak)
        return key in hidden_only and (hidden or not hidden_only[key])

    found = system.analyse(Options(accepts=accepts))
    assert {
        (f.kind, f.category, number[f.source], number[f.leak], f.plain_also): (
            f.pseudonymised,
            f.dismissed,
            len(f.steps),
        )
        for f in found.findings
    } == system.brute().findings(accepted)
    for finding in found.findings:
        assert finding.accepted == accepts(Case.of(finding))
        assert bool(finding.through) == finding.dismissed
        assert not any(accepted(finding.category, number[finding.source], number[e], False) for e in finding.through)
    left = [f for f in found.findings if not f.dismissed and not f.accepted]
    assert (found.verdict is Verdict.LEAK) == bool(left)
    assert found.carried == plain.carried  # a decision changes no flow


@given(st.one_of(systems(), wildcards()))
def test_open_questions_are_those_of_brute_force(system: System) -> None:
    """Rule S11: which elements, for which categories, how far, and which are on the frontier."""
    found = analysed(system)
    if found is None:
        return
    number = index(system)
    got = {number[q.element]: (set(q.categories), q.distance, q.frontier) for q in found.open}
    assert got == system.brute().open()
    assert list(found.open) == sorted(found.open, key=lambda q: (not q.frontier, q.distance))


@given(st.one_of(systems(), wildcards()))
def test_unknown_ends_are_those_of_brute_force(system: System) -> None:
    """Rule S11: what is not known is said, and changes no verdict."""
    found = analysed(system)
    if found is None:
        return
    number = index(system)
    assert {number[end.element]: set(end.categories) for end in found.unknown_ends} == system.brute().unknown_ends()
    assert all((end.missing == "reader") == end.element.is_channel for end in found.unknown_ends)


@given(systems())
def test_the_verdict_says_no_more_than_is_known(system: System) -> None:
    """Rule S12."""
    found = analysed(system)
    if found is None:
        return
    if any(not finding.dismissed for finding in found.findings):
        assert found.verdict is Verdict.LEAK
    elif found.open or not system.brute().has_grounds():
        assert found.verdict is Verdict.UNDETERMINED
    else:
        assert found.verdict is Verdict.NO_LEAK_FOUND
    assert found.verdict is Verdict.LEAK or not found.findings  # a dismissed finding has another before it


@given(systems())
def test_disjoint_paths_are_as_many_as_a_minimum_cut_has_flows(system: System) -> None:
    """Menger's theorem, on the flows along which the category goes; systems without derivations."""
    system.said = {v: [s for s in said if s.role != "derivation"] for v, said in system.said.items()}
    found = analysed(system)
    if found is None:
        return
    number, brute = index(system), system.brute()
    for finding in found.findings:
        source, leak, category = number[finding.source], number[finding.leak], finding.category
        if source == leak:
            assert finding.disjoint_paths == 1
            continue
        ends = (
            {leak}
            if finding.dismissed or finding.kind != DISCLOSURE
            else {v for v in system.said if brute.has(v, "leak", category)} - {source}
        )
        graph: nx.DiGraph[int] = nx.DiGraph()
        graph.add_nodes_from([source, leak])
        for a, b in system.edges:
            dead = (a in ends) or (b not in brute.nodes and brute.kills(b, category))
            ended = [s for s in brute.holding(a, category) if s.role == "sanitizer"] if a != source else []
            dead = dead or any(s.method is not None and s.method.ends for s in ended)
            names = brute.never.get((a, b), set())
            if not dead and not any(name in HIERARCHY.ancestors[category] for name in names):
                graph.add_edge(a, b)
        assert finding.disjoint_paths == nx.edge_connectivity(graph, source, leak)


@given(st.one_of(systems(), ranked(), wildcards()), st.data())
def test_paths_that_are_only_counted_are_as_many_as_those_that_are_listed(system: System, data: st.DataObject) -> None:
    """Counting walks once for all categories, listing once for each; also where leaks are accepted (rule S10)."""
    try:
        case = st.sampled_from(sorted({finding.id for finding in system.analyse().findings}) or [""])
        ids = data.draw(st.sets(case, max_size=2))
        counted, listed = (system.analyse(Options(paths=paths, accepts=lambda c: c.id in ids)) for paths in COUNTED)
    except InputErrors:
        return
    assert [f.disjoint_paths for f in counted.findings] == [f.disjoint_paths for f in listed.findings]


COUNTED = (Paths.witness, Paths.disjoint)


@given(st.one_of(systems(), ranked(), wildcards()), st.data())
def test_without_counting_paths_all_else_is_the_same(system: System, data: st.DataObject) -> None:
    """Also where leaks are accepted; a number that nobody worked out is none."""
    try:
        case = st.sampled_from(sorted({finding.id for finding in system.analyse().findings}) or [""])
        ids = data.draw(st.sets(case, max_size=2))
        both = (Options(count_paths=counts, accepts=lambda c: c.id in ids) for counts in (True, False))
        whole, uncounted = map(system.analyse, both)
    except InputErrors:
        return
    assert [replace(f, number_of_paths=None) for f in whole.findings] == list(uncounted.findings)
    for name in ("verdict", "open", "carried", "roles", "unknown_ends", "lacking", "diagnostics"):
        assert getattr(whole, name) == getattr(uncounted, name), name


def test_what_comes_back_to_a_source_takes_no_flow_twice() -> None:
    """It sends to /t0 and /t1 and reads /t1 itself; all that gets to the leak goes along its one flow to /t0."""
    edges = [(0, 4), (0, 5), (5, 0), (4, 1), (4, 2), (1, 6), (2, 7), (6, 3), (7, 3)]
    source = statement("source", "Face")._replace(through=("/t0", "/t1"))
    system = System(4, 4, sorted(edges), {0: [source], 3: [statement("leak", "Face")]}, {})
    for paths in COUNTED:
        assert [f.disjoint_paths for f in system.analyse(Options(paths=paths)).findings] == [1]


@given(systems(), st.data())
def test_more_flows_never_shrink_what_is_carried(system: System, data: st.DataObject) -> None:
    before = analysed(system)
    if before is None:
        return
    node = data.draw(st.integers(0, system.nodes - 1))
    channel = data.draw(st.integers(system.nodes, system.nodes + system.channels - 1))
    edge = (node, channel) if data.draw(st.booleans()) else (channel, node)
    never = {system.edges[i]: names for i, names in system.never.items()}
    edges = sorted({*system.edges, edge})
    more = System(
        system.nodes,
        system.channels,
        edges,
        system.said,
        {edges.index(e): names for e, names in never.items()},
        outside=system.outside,
    )
    after = analysed(more)
    assert after is not None
    assert _covers(after, before)


@given(systems(), st.data())
def test_a_sanitizer_that_anonymises_never_grows_what_is_carried(system: System, data: st.DataObject) -> None:
    node = data.draw(st.integers(0, system.nodes - 1))
    system.said[node] = []
    before = analysed(system)
    category = data.draw(st.sampled_from(tuple(PARENTS)))
    system.said[node] = [statement("sanitizer", category, method=Method.ANONYMISE)]
    after = analysed(system)
    if before is not None:
        assert after is not None
        assert _covers(before, after)


def _covers(more: Analysis, less: Analysis) -> bool:
    """Whether everything that one carries, the other does too; the narrowest names stand for the broader ones."""

    def closed(names: Iterable[str]) -> set[str]:
        return {above for name in names for above in HIERARCHY.ancestors[name]}

    carried = {c.element: c for c in more.carried}
    return all(
        c.element in carried
        and closed(c.categories) <= closed(carried[c.element].categories)
        and closed(c.pseudonymised) <= closed(carried[c.element].pseudonymised)
        for c in less.carried
    )


@given(systems(names=tuple(WIDE)))
def test_more_categories_than_a_word_has_bits(system: System) -> None:
    """70 kinds in two planes are 140 bits; every category is emitted, so the words are full."""
    system.hierarchy = WIDE_HIERARCHY
    for i, name in enumerate(WIDE):
        system.said.setdefault(i % system.nodes, []).append(statement("source", name))
    found = analysed(system)
    if found is None:
        return
    number, brute = index(system), system.brute()
    assert len(found.emitted) == len(WIDE)
    expected: dict[int, tuple[set[str], set[str]]] = {}
    for vertex, (category, hidden) in sorted(brute.spread(brute.sources())):
        expected.setdefault(brute.one(vertex, expected), (set(), set()))[hidden].add(category)
    assert {number[c.element]: (set(c.categories), set(c.pseudonymised)) for c in found.carried} == expected


@given(systems(most=4, degree=2), st.sampled_from(["disjoint", "all"]), st.integers(1, 5))
def test_further_paths_keep_to_their_bound_and_say_so(system: System, asked: str, most: int) -> None:
    try:
        found = system.analyse(Options(paths=asked, max_paths=most))
        unbounded = system.analyse(Options(paths=asked, max_paths=40))
    except InputErrors:
        return
    number, edges = index(system), set(system.edges)
    for finding, whole in zip(found.findings, unbounded.findings, strict=True):
        assert len(finding.paths) <= most
        assert finding.bounded or len(whole.paths) <= most  # a bound that cuts is said
        assert finding.paths == whole.paths[: len(finding.paths)]
        assert finding.bounded or finding.paths == whole.paths
        assert list(map(len, whole.paths)) == sorted(map(len, whole.paths))
        if whole.paths and asked == "all":  # those that share no flow need not have the shortest among them
            assert len(whole.paths[0]) <= len(finding.witness)  # the witness prefers data as it is to pseudonymised
        for path in finding.paths:
            way = [number[element] for element in path]
            assert all(step in edges for step in pairwise(way))


@given(systems(), st.sampled_from(tuple(PARENTS)))
def test_an_answer_about_some_categories_is_a_part_of_the_whole_answer(system: System, name: str) -> None:
    found = analysed(system)
    if found is None:
        return
    part = system.analyse(Options(categories={name}))
    assert part.findings == tuple(f for f in found.findings if f.category == name)
    assert {q.element for q in part.open} == {q.element for q in found.open if name in q.categories}
    frontier = {q.element for q in found.open if q.frontier}
    assert {q.element for q in part.open if q.frontier} <= frontier


def test_of_several_lines_that_open_a_channel_the_first_is_named() -> None:
    lines = [Exposure("not-encrypted", Place("governance.p7s", number)) for number in (24, 5, 30)]
    assert "governance.p7s:5" in str(unprotected(lines))
