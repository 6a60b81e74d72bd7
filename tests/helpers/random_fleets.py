"""Random fleets, and what is found in one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import Element, Place
from rosprivacy.ingest.fleet.alike_robots import alike, chosen
from rosprivacy.ingest.fleet.dds_domains import Member
from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot
from rosprivacy.ingest.fleet.fleet_graph import place
from rosprivacy.ingest.labels.entries import Entry, FlowEntry, Stated
from tests.helpers.brute import Brute
from tests.helpers.systems import HIERARCHY, PARENTS, System, facts, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import NonRosFacts, Statement
    from rosprivacy.ingest.fleet.fleet_graph import Placed


HERE = Place("fleet.yaml", 1)


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
        elements = [Stated(kind, name, facts._replace(place=HERE)) for name, (kind, facts, _) in self.shared.items()]
        entries = [Entry((kind,), name, HERE, tuple(said)) for name, (kind, _, said) in self.shared.items()]
        flows = [
            FlowEntry(source, target, HERE, (statement("never", *sorted(never)),) if never else ())
            for source, target, never in self.flows
        ]
        return Fleet("the fleet", (), tuple(robots), (), tuple(elements), tuple(entries), (), tuple(flows), ".")

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
        return Member(robot, (), graph, system.bound(), {e: e for e in graph.elements})

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
            found.exposed = {*found.exposed, *(start + vertex for vertex in part.exposed)}
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
