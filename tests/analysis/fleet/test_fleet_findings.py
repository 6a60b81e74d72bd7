"""Fleets against brute force (rules S1, S9, S10): all robots in one graph, against one robot for all that are alike."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.fleet.patterns import FleetView, pattern_id
from rosprivacy.analysis.fleet.patterns_of_pairs import Groups
from rosprivacy.analysis.model import Element, Place
from rosprivacy.ingest.fleet.alike_robots import alike, chosen
from rosprivacy.ingest.fleet.dds_domains import Member
from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot
from rosprivacy.ingest.fleet.fleet_graph import place
from rosprivacy.ingest.fleet.mergeable_graph import Part
from rosprivacy.ingest.labels.entries import Entry, FlowEntry
from rosprivacy.ingest.labels.non_ros_reader import Stated
from tests.analysis.findings.test_findings import HIERARCHY, PARENTS, System, facts, statement, systems
from tests.helpers.brute import Brute

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Analysis, Statement
    from rosprivacy.analysis.non_ros import NonRosFacts
    from rosprivacy.ingest.fleet.fleet_graph import Placed

HERE = Place("fleet.yaml", 1)
Vertex = tuple[str, str]  # robot (or the fleet), name


@dataclass
class Case:
    """A small fleet.

    Attributes
    ----------
    robots
        Id -> its system; robots of one system are of one model.
    shared
        Name -> kind, facts and statements.
    flows
        Ends as in fleet files, with what never goes along.
    """

    robots: dict[str, System]
    shared: dict[str, tuple[str, NonRosFacts, list[Statement]]]
    flows: list[tuple[str, str, frozenset[str]]]

    def model(self, robot: str) -> str:
        return f"model{[id(system) for system in self.systems].index(id(self.robots[robot]))}"

    @property
    def systems(self) -> list[System]:
        return list({id(system): system for system in self.robots.values()}.values())

    def fleet(self) -> Fleet:
        robots = [Robot(name, HERE, self.model(name), (self.model(name),)) for name in sorted(self.robots)]
        elements = [Stated(kind, name, replace(facts, place=HERE)) for name, (kind, facts, _) in self.shared.items()]
        entries = [Entry((kind,), name, HERE, tuple(said)) for name, (kind, _, said) in self.shared.items()]
        flows = [
            FlowEntry(source, target, HERE, (statement("never", *sorted(never)),) if never else ())
            for source, target, never in self.flows
        ]
        return Fleet("the fleet", (), tuple(robots), (), tuple(elements), tuple(entries), (), tuple(flows))

    def placed(self) -> Placed:
        fleet = self.fleet()
        groups = alike(fleet)
        members = {}
        for group in groups:
            members[group.robots[0].id] = self.member(group.robots[0])
        return place(fleet, groups, members, "declared")

    def member(self, robot: Robot) -> Member:
        system = self.robots[robot.id]
        graph = system.graph()
        return Member(robot, (), Part.of(graph, system.bound()), {e: e for e in graph.elements})

    def analyse(self) -> tuple[Analysis, Placed]:
        placed = self.placed()
        return analyse(placed.graph, placed.bound, HIERARCHY), placed

    def brute(self) -> tuple[Brute, dict[int, Element]]:
        """Every robot, one after the other, in one graph."""
        found = Brute(set(), [], {}, HIERARCHY)
        elements: dict[int, Element] = {}
        number: dict[tuple[str, str], int] = {}
        for robot, system in sorted(self.robots.items()):
            start = len(elements)
            for vertex, element in enumerate(system.graph().elements):
                elements[start + vertex] = replace(element, robot=robot)
                number[robot, element.name] = start + vertex
            part = system.brute()
            found.nodes = {*found.nodes, *(start + vertex for vertex in part.nodes)}
            found.edges += [(start + a, start + b) for a, b in part.edges]
            found.said |= {start + vertex: said for vertex, said in part.said.items()}
            found.never |= {(start + a, start + b): set(names) for (a, b), names in part.never.items()}
            found.outside |= {start + vertex: facts for vertex, facts in part.outside.items()}
        for name, (kind, stated, said) in self.shared.items():
            vertex = number["", name] = len(elements)
            elements[vertex] = Element(kind, name, "the fleet")
            found.nodes = {*found.nodes, vertex}
            found.said[vertex], found.outside[vertex] = said, (kind, stated)
        for source, target, never in self.flows:
            for a in self._ends(source, number):
                for b in self._ends(target, number):
                    found.edges.append((a, b))
                    found.never[a, b] = {*found.never.get((a, b), ()), *never}
        found.edges = list(dict.fromkeys(found.edges))
        return found, elements

    def _ends(self, end: str, number: dict[tuple[str, str], int]) -> list[int]:
        robots, colon, name = end.partition(":")
        if not colon:
            return [number["", end]]
        return [number[r, name] for r in chosen(end, sorted(self.robots)) if (r, name) in number] if robots else []


@st.composite
def fleets(draw: st.DrawFn) -> Case:
    names = tuple(PARENTS)
    models = draw(st.lists(systems(most=3, outside=1), min_size=1, max_size=2))
    robots = {f"{'ab'[i]}{k}": system for i, system in enumerate(models) for k in range(draw(st.integers(1, 3)))}
    kinds = draw(st.lists(facts(names), min_size=1, max_size=2))
    label = st.builds(statement, st.sampled_from(["source", "leak", "conduit"]), st.sampled_from(names))
    shared = {f"s{i}": (*one, draw(st.lists(label, max_size=1))) for i, one in enumerate(kinds)}
    nodes = [name for system in models for name in _nodes(system)]
    on_robots = st.builds("{}:{}".format, st.sampled_from(["*", "a*", "b*", *robots]), st.sampled_from(nodes))
    ends = [on_robots.filter(lambda end: _there(end, robots)), st.sampled_from(sorted(shared))]
    never = st.frozensets(st.sampled_from(names), max_size=1)
    some = st.one_of(
        st.tuples(ends[0], ends[1], never), st.tuples(ends[1], ends[0], never), st.tuples(*ends[:1] * 2, never)
    )
    return Case(robots, shared, draw(st.lists(some, min_size=1, max_size=5)))


def _nodes(system: System) -> list[str]:
    return [element.name for element in system.graph().elements if not element.is_channel and element.is_node]


def _there(end: str, robots: dict[str, System]) -> bool:
    name = end.partition(":")[2]
    return any(name in _nodes(robots[robot]) for robot in chosen(end, robots))


def found_in(case: Case) -> tuple[Analysis, Placed] | None:
    try:
        return case.analyse()
    except InputErrors:  # labels contradict each other
        return None


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
        key = (f.kind, f.category, robots.alike(f.source), robots.alike(f.leak), pattern.across, f.beside)
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
    assert {pattern.id: pattern for pattern in got.patterns} == {pattern.id: pattern for pattern in expected.patterns}
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
        key = (f.kind, f.category, number[f.source], number[f.leak], f.beside)
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
