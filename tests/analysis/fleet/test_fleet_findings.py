"""Fleets against brute force (rules S1, S9, S10): all robots in one graph, against one robot for all that are alike."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import given

from rosprivacy.analysis.findings.derived_from import origins, pairs_at_most
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.fleet.patterns import FleetView
from rosprivacy.analysis.fleet.patterns_of_pairs import Groups
from rosprivacy.analysis.model import Method, NonRosFacts
from tests.helpers.random_fleets import HERE, Case, fleets, found_in
from tests.helpers.systems import HIERARCHY, System, statement

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.findings.derived_from import Origin
    from rosprivacy.analysis.model import Element, Statement

Vertex = tuple[str, str]  # robot (or the fleet), name


@given(fleets())
def test_patterns_are_those_of_all_robots_in_one_graph(case: Case) -> None:
    """Which findings, how many, on which robots, in which form; one robot stands for all that are alike."""
    result = found_in(case)
    if result is None:
        return
    analysis, placed = result
    view = FleetView.of(analysis, placed.likeness)
    brute, elements = case.brute()
    expected: dict[tuple[object, ...], list[tuple[bool, bool, str]]] = defaultdict(list)
    for (kind, category, source, leak, beside), (hidden, dismissed, _) in brute.findings().items():
        a, b = elements[source], elements[leak]
        across = a.robot != b.robot and {a.robot, b.robot} <= set(case.robots)
        where = a.robot if a.robot in case.robots else b.robot
        key = (kind, category, _alike(a, case), _alike(b, case), across, beside)
        expected[key].append((dismissed, hidden, where if where in case.robots else ""))
    got = {}
    for pattern in view.patterns:
        f, robots = pattern.finding, placed.likeness
        key = (f.kind, f.category, robots.alike(f.source), robots.alike(f.leak), pattern.across, f.plain_also)
        got[key] = (pattern.count, pattern.dismissed, pattern.pseudonymised, pattern.robots)
        assert pattern.id == pattern_id(f, robots)
    assert got == {
        key: (
            len(found),
            sum(dismissed for dismissed, _, _ in found),
            sum(hidden for _, hidden, _ in found),
            tuple(sorted({robot for *_, robot in found if robot})),
        )
        for key, found in expected.items()
    }
    assert len({pattern.id for pattern in view.patterns}) == len(view.patterns)


def _alike(element: Element, case: Case) -> Element:
    return replace(element, robot="") if element.robot in case.robots else element


@given(fleets())
def test_patterns_made_of_pairs_are_those_made_of_findings(case: Case) -> None:
    """Counted in arrays before any way is looked for: the same patterns, deviants and verdict."""
    result = found_in(case)
    if result is None:
        return
    analysis, placed = result
    groups = Groups(placed.likeness)
    chosen = analyse(placed.graph, placed.bound, HIERARCHY, Options(choose=groups))
    expected, got = FleetView.of(analysis, placed.likeness), groups.view(chosen)
    assert got.patterns == expected.patterns
    assert got.deviants == expected.deviants
    assert chosen.verdict == analysis.verdict
    assert set(chosen.findings) == {pattern.finding for pattern in expected.patterns}


@given(fleets())
def test_each_finding_is_one_of_all_robots_in_one_graph(case: Case) -> None:
    """Also how short the way is: no way between two robots is longer because a third is not placed."""
    result = found_in(case)
    if result is None:
        return
    analysis, _ = result
    brute, elements = case.brute()
    expected = brute.findings()
    number = {element: vertex for vertex, element in elements.items()}
    for f in analysis.findings:
        key = (f.kind, f.category, number[f.source], number[f.leak], f.plain_also)
        assert (f.pseudonymised, f.dismissed, len(f.witness) - 1) == expected[key]


@given(fleets())
def test_open_elements_are_those_of_all_robots_in_one_graph(case: Case) -> None:
    result = found_in(case)
    if result is None:
        return
    analysis, placed = result
    likeness = placed.likeness
    brute, elements = case.brute()
    stands_for = {robot: first for first, robots in likeness.members.items() for robot in robots}
    got = {q.element: (set(q.categories), q.distance, q.frontier) for q in analysis.open}
    for vertex, expected in brute.open().items():
        element = elements[vertex]
        assert got[replace(element, robot=stands_for.get(element.robot, element.robot))] == expected
    shown = FleetView.of(analysis, likeness).shown(analysis)
    assert len(brute.open()) == sum(likeness.weight(question.element.robot) for question in shown.open)


@given(fleets())
def test_names_of_robots_change_nothing_but_names(case: Case) -> None:
    moved = {old: old[0] + str(9 - int(old[1:])) for old in case.robots}  # the order is turned round
    flows = [(_moved(source, moved), _moved(target, moved), never) for source, target, never in case.flows]
    other = Case({moved[robot]: system for robot, system in case.robots.items()}, case.shared, flows)
    ours, theirs = found_in(case), found_in(other)
    assert (ours is None) == (theirs is None)
    if ours is None or theirs is None:
        return
    views = [FleetView.of(analysis, placed.likeness) for analysis, placed in (ours, theirs)]
    rows = [
        {(p.id, p.count, p.dismissed, p.pseudonymised, p.across, len(p.robots)) for p in view.patterns}
        for view in views
    ]
    assert rows[0] == rows[1]
    listed = [{p.id: p.robots for p in view.patterns} for view in views]
    assert {key: tuple(sorted(moved[r] for r in robots)) for key, robots in listed[0].items()} == listed[1]
    assert ours[0].verdict == theirs[0].verdict


def _moved(end: str, moved: dict[str, str]) -> str:
    robots, colon, name = end.partition(":")
    return f"{moved.get(robots, robots)}:{name}" if colon else end


@given(fleets())
def test_of_many_pairs_of_robots_each_robot_has_one_at_either_end(case: Case) -> None:
    """What is loaded of a large fleet (S10): every finding but those between robots, and of these none is made up."""
    result = found_in(case)
    if result is None:
        return
    analysis, placed = result
    likeness, groups = placed.likeness, Groups(placed.likeness, most_across=1)
    some = analyse(placed.graph, placed.bound, HIERARCHY, Options(choose=groups))
    assert groups.view(some).patterns == FleetView.of(analysis, likeness).patterns
    assert {one.id for one in some.findings} <= {one.id for one in analysis.findings}

    def ends(findings: Iterable[Finding]) -> dict[tuple[object, ...], bool]:
        """Robots and patterns: at least one that is not dismissed."""
        found: dict[tuple[object, ...], bool] = defaultdict(bool)
        for one in findings:
            first = likeness.second.get(one.leak.robot, one.leak.robot)
            for end in (("from", one.source.robot), ("to", first)) if likeness.count(one) else ():
                finding = (pattern_id(one, likeness), *end)
                found[finding] |= one.stands
            if likeness.count(one) and not likeness.across(one):
                found[one.id, one.disjoint_paths] = one.stands
        return found

    assert ends(some.findings) == ends(analysis.findings)


@given(fleets())
def test_searches_that_look_at_some_robots_only_find_ways_as_short(case: Case) -> None:
    as_short(case)


@pytest.mark.parametrize(
    "said",
    [
        [],
        [statement("derivation", "Bio", to="Loc")],
        [statement("derivation", "Bio", to="Loc"), statement("sanitizer", "Bio", method=Method.DROP)],
        [statement("sanitizer", "Bio", method=Method.PSEUDONYMISE)],
        [statement("leak", "Bio")],
    ],
)
def test_the_way_from_one_shared_element_to_another_is_through_a_third_robot(said: list[Statement]) -> None:
    """a brings in what b alone takes from the first storage to the second, which c reads."""
    robots = {
        "a0": System(1, 0, [], {0: [statement("source", "Bio")]}, {}),
        "b0": System(1, 0, [], {0: said}, {}),
        "c0": System(1, 0, [], {0: [statement("leak", "Any")]}, {}),
    }
    storage: tuple[str, NonRosFacts, list[Statement]] = ("storage", NonRosFacts(place=HERE), [])
    flows = [(a, b, frozenset[str]()) for a, b in (("a0:/n0", "s0"), ("s0", "b0:/n0"), ("b0:/n0", "s1"))]
    case = Case(robots, {"s0": storage, "s1": storage}, [*flows, ("s1", "c0:/n0", frozenset())])
    assert any(leak == "/n0" and robot == "c0" for robot, leak in as_short(case))


def as_short(case: Case) -> set[tuple[str, str]]:
    """Every finding stands as it does in one graph (S10); fewer paths that share no flow may be counted."""
    result = found_in(case)
    if result is None:
        return set()
    analysis, placed = result
    likeness = placed.likeness
    numbers = {element: vertex for vertex, element in enumerate(placed.graph.elements)}
    chosen: dict[int, set[tuple[str, int, int, bool]]] = defaultdict(set)
    for one in analysis.findings:
        category = analysis.spread.categories.index(one.category)
        chosen[numbers[one.source]].add((one.kind, numbers[one.leak], category, one.plain_also))
    shared = frozenset(element.robot for element in placed.graph.elements if not likeness.is_robot(element.robot))
    options = Options(choose=lambda *_: chosen, shared=shared, uncounted=likeness.apart)
    some = analyse(placed.graph, placed.bound, HIERARCHY, options)

    def facts(finding: Finding) -> tuple[object, ...]:
        return finding.id, finding.dismissed, finding.pseudonymised, len(finding.witness)

    assert list(map(facts, some.findings)) == list(map(facts, analysis.findings))
    for near, whole in zip(some.findings, analysis.findings, strict=True):
        if near.number_of_paths is not None:
            assert 1 <= near.number_of_paths <= (whole.number_of_paths or 1)
    return {(one.leak.robot, one.leak.name) for one in some.findings}


@given(fleets())
def test_what_is_made_near_its_source_is_what_is_made_there_in_the_whole_fleet(case: Case) -> None:
    result = found_in(case)
    if result is None:
        return
    analysis, placed = result
    elements = placed.graph.elements
    shared = {element.robot for element in elements if not placed.likeness.is_robot(element.robot)}

    def facts(some: Iterable[Origin]) -> list[tuple[object, ...]]:
        return [
            (one.maker, one.source, one.category, len(one.path), one.past_leak)
            for one in some
            if elements[one.maker].robot in {elements[one.source].robot, *shared}
        ]

    near = origins(analysis.spread, shared)
    assert facts(near) == facts(origins(analysis.spread))
    assert len(facts(near)) == len(near)
    assert pairs_at_most(analysis.spread) >= max(
        Counter(one.category for one in origins(analysis.spread)).values(), default=0
    )
