"""Analysis -> ``RobotRows`` of a robot, or of every robot of a fleet, also of those for which another one stands.

In: the analysis of the graph in which a robot stands for all that are alike. Out: the rows of every robot, and of what
is shared, which is filed under names of its own. Each robot's rows name the elements of others at which its flows and
findings end.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cached_property
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import robot_verdicts
from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.findings.derived_from import origins, pairs_at_most
from rosprivacy.analysis.fleet.likeness import Likeness, pattern_id
from rosprivacy.analysis.model import STANDARD, UNSTATED
from rosprivacy.ingest.fleet.dds_domains import is_domain
from rosprivacy.ingest.fleet.fleet_graph import Placed
from rosprivacy.ingest.neo4j_graph.carrying import Carrying
from rosprivacy.ingest.neo4j_graph.element_facts import processing_properties
from rosprivacy.ingest.neo4j_graph.ids import category_labels, element_id, enclave_id
from rosprivacy.ingest.neo4j_graph.relationship_facts import add_roles, allowed, denied, flow_row
from rosprivacy.ingest.neo4j_graph.rows import (
    BeyondRows,
    Names,
    Roles,
    add_beyond,
    element_results,
    element_row,
    end_id,
    finding_row,
    flow_results,
    intake_row,
    origin_properties,
    rows_of,
)
from rosprivacy.ingest.neo4j_graph.schema import DOMAIN, FLEET, INFRASTRUCTURE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding, Verdict
    from rosprivacy.analysis.model import Bound, Element, Flow, Profile
    from rosprivacy.ingest.neo4j_graph.carrying import End
    from rosprivacy.ingest.neo4j_graph.rows import Beyond, RobotRows, Row
    from rosprivacy.ontology.vocabulary import Vocabulary

MOST_ACROSS = 10_000  # findings of one pattern that go from robot to robot and are written one by one


def robot_rows(
    robot: str,
    analysis: Analysis,
    bound: Bound,
    vocabulary: Vocabulary,
    extra: Mapping[str, Any] | None = None,
    beyond: Beyond | None = None,
    *,
    without_standard: bool = False,
) -> RobotRows:
    """Return the rows of one robot.

    Parameters
    ----------
    robot
        Name in the database.
    analysis, more, beyond, without_standard
        As of ``FleetRows``.
    bound
        The statements that it rests on.
    """
    placed = Placed(analysis.graph, bound, Likeness({"": (robot,)}), {"": analysis.graph.profiles})
    known = {"verdict": str(analysis.verdict), **(extra or {})}
    fleet = FleetRows(placed, analysis, vocabulary, {"": known}, beyond=beyond, without_standard=without_standard)
    properties, parts = fleet.parts("", robot)
    del parts["foreign"]  # there is no other robot
    return rows_of(robot, properties, parts)


class FleetRows:
    """Makes the rows of robots.

    Parameters
    ----------
    analysis
        Of all categories, not of a choice.
    more
        Further properties of each ``Robot``, by the robot of the graph.
    most_across
        See ``left_out``.
    counts
        How many findings each pattern has that goes from robot to robot, by id, where not all of them are given: those
        that are, as ``Groups`` chooses them, are written for robots at either end.
    not_read
        Robots of the graph of which a doubt breaks the verdict, such as a file that was not read (rule S11).
    beyond
        What the enforced view adds; None where nobody asked for both views.
    without_standard
        Whether ``standard_only`` channels are left out.

    Attributes
    ----------
    left_out
        How many findings from one robot to another are not written: of a pattern with more than ``most_across`` one
        is written for each robot from which data comes; with ``counts`` also for each to which it gets.
    derived_nearby
        Whether ``DERIVES_FROM`` is written within robots and to what is shared only, as there may be more of it than
        ``most_across`` from robot to robot.
    """

    def __init__(
        self,
        placed: Placed,
        analysis: Analysis,
        vocabulary: Vocabulary,
        extra: Mapping[str, Mapping[str, Any]],
        most_across: int | None = None,
        not_read: Iterable[str] = (),
        beyond: Beyond | None = None,
        counts: Mapping[str, int] | None = None,
        *,
        without_standard: bool = False,
    ) -> None:
        self._hidden = standard_only(analysis, placed.bound) if without_standard else frozenset()
        self._without_standard = {"without_standard": True} if without_standard else {}
        most_across = MOST_ACROSS if most_across is None else most_across
        self._extra, self._beyond = extra, beyond
        self._not_read = frozenset(not_read)
        self._placed = placed
        self._analysis = analysis
        self._vocabulary = vocabulary
        self._likeness = placed.likeness
        self._graph = analysis.graph
        self._labels = category_labels(vocabulary)
        self._names = Names(analysis.spread, vocabulary, self._labels)
        many = self._likeness.robots > 1 and most_across and pairs_at_most(analysis.spread) > most_across
        shared = self._likeness.shared(self._graph.elements) if many else None
        self.derived_nearby = shared is not None
        self._origins = origins(analysis.spread, shared)
        across = [one for one in analysis.findings if self._likeness.across(one) and self._likeness.count(one)]
        self._at_either_end = counts is not None
        if counts is None:
            counts = defaultdict(int)
            for finding in across:
                counts[pattern_id(finding, self._likeness)] += self._likeness.count(finding)
        self._too_many = {pattern for pattern, count in counts.items() if count > most_across}
        placed_on = self._likeness.placed
        self.left_out = sum(counts[pattern] for pattern in self._too_many) - sum(
            max(len(placed_on(end.robot)) for end in ((one.source, one.leak) if self._at_either_end else (one.source,)))
            for one in across
            if self._across_too_often(one)
        )

    def __iter__(self) -> Iterator[RobotRows]:
        """Return the rows of every robot and of what is shared."""
        for owner in sorted(self._owned):
            yield from self.of(owner)

    def of(self, owner: str) -> Iterator[RobotRows]:
        """Return the rows of all robots for which one of the graph stands."""
        if owner in self._owned and owner not in self._likeness.second:
            for name in self._likeness.members.get(owner, (owner,)):
                yield rows_of(name, *self.parts(owner, name))

    def parts(self, owner: str, name: str) -> tuple[Row, dict[str, Any]]:
        """Return the properties of a robot, for which one of the graph stands, and its rows by part."""
        ids = _Ids(owner, name, self._likeness)
        own = self._owned.get(owner, [])
        elements, results = self._graph.elements, self._results
        profiles = self._placed.profiles.get(owner, ())
        roles: dict[str, list[Row]] = {}
        for vertex in own:
            statements = self._placed.bound.elements.get(vertex, ())
            add_roles(roles, name, ids.of(elements[vertex], name), statements, self._vocabulary)
        findings, across = self._findings(owner, name, ids)
        parts: dict[str, Any] = {
            "elements": [
                element_row(
                    name, ids.of(elements[v], name), elements[v], *results[v], self._analysis.outside.get(elements[v])
                )
                for v in own
            ],
            "intakes": [
                intake_row(name, ids.of(elements[v], name), elements[v], self._carrying.labels(v))
                for v in own
                if v in self._carrying.intakes
            ],
            "enclaves": [
                {"id": enclave_id(name, path), "properties": {"path": path, "robot": name}}
                for path in sorted({profile.enclave for profile in profiles})
            ],
            "memberships": list(self._memberships(owner, name, ids)),
            "flows": list(self._flows(owner, name, ids)),
            "roles": roles,
            "derived": list(self._derived(owner, name, ids)),
            "carried": list(self._carried(owner, name, ids)),
            "findings": findings,
            "across": across,
            "foreign": [],
        }
        if self._beyond:
            parts["beyond"] = self._added(owner, name, ids, self._beyond)
        parts["foreign"] = [
            element_row(robot, key, element, {}, (), None) for key, (element, robot) in sorted(ids.foreign.items())
        ]
        parts["foreign"] += [
            intake_row(robot, key, element) for key, (element, robot) in sorted(ids.foreign_intakes.items())
        ]
        part, stated = self._part(owner), self._placed.bound.of_robots.get(owner, UNSTATED)
        properties = {
            "view": self._graph.view,
            "model": self._likeness.models.get(owner) or None,
            "shared": True if part else None,
            "part": part,
            **processing_properties(stated),
            **self._extra.get(owner, {}),
            **({"beyond": len(parts["beyond"].findings)} if self._beyond else {}),
            **self._without_standard,
        }
        if "verdict" not in properties and part != DOMAIN:
            properties["verdict"] = str(self._verdicts[owner])
        return {key: value for key, value in properties.items() if value is not None}, parts

    @cached_property
    def _owned(self) -> dict[str, list[int]]:
        """Vertices by robot."""
        owned: dict[str, list[int]] = defaultdict(list)
        for vertex, element in enumerate(self._graph.elements):
            owned[element.robot] += [vertex] if self._shows(vertex) else []
        return dict(owned)

    @cached_property
    def _results(self) -> list[tuple[Row, list[str]]]:
        roles = Roles(self._vocabulary, self._labels)
        return list(element_results(self._analysis, self._placed.bound, self._names, roles))

    @cached_property
    def _carrying(self) -> Carrying:
        return Carrying(self._analysis, [labels for _, labels in self._results], self._labels)

    @cached_property
    def _steps(self) -> dict[str, list[tuple[End, End, list[str]]]]:
        """Where kinds of data go, by the robot that they leave."""
        leaving: dict[str, list[tuple[End, End, list[str]]]] = defaultdict(list)
        for step in self._carrying.steps:
            if self._shows(step[0][0], step[1][0]):
                leaving[self._graph.elements[step[0][0]].robot].append(step)
        return dict(leaving)

    @cached_property
    def _leaving(self) -> dict[str, list[tuple[Flow, Row]]]:
        """Flows by the robot that they leave, with their properties."""
        leaving: dict[str, list[tuple[Flow, Row]]] = defaultdict(list)
        results = flow_results(self._analysis, self._names)
        for index, (flow, result) in enumerate(zip(self._graph.flows, results, strict=True)):
            if self._shows(flow.source, flow.target):
                properties = allowed(result, self._placed.bound.flows.get(index, ()), self._vocabulary.hierarchy)
                leaving[self._graph.elements[flow.source].robot].append((flow, properties))
        for flow in self._graph.taken_back:
            if self._shows(flow.source, flow.target):
                leaving[self._graph.elements[flow.source].robot].append((flow, denied(flow)))
        return dict(leaving)

    def _shows(self, *vertices: int) -> bool:
        """Whether none of some elements is left out."""
        return self._hidden.isdisjoint(vertices)

    def _flows(self, owner: str, name: str, ids: _Ids) -> Iterator[Row]:
        elements = self._graph.elements
        for flow, properties in self._leaving.get(owner, ()):
            source, target = elements[flow.source], elements[flow.target]
            for robot in ids.expanded(target.robot):
                yield flow_row(name, flow, ids.of(source, name), ids.of(target, robot), properties)

    def _carried(self, owner: str, name: str, ids: _Ids) -> Iterator[Row]:
        elements = self._graph.elements
        for (start, own), (end, taken), types in self._steps.get(owner, ()):
            source = end_id(ids.of(elements[start], name), own)
            for robot in ids.expanded(elements[end].robot):
                yield {"source": source, "target": ids.end(elements[end], robot, taken), "types": types}

    def _memberships(self, owner: str, name: str, ids: _Ids) -> Iterator[Row]:
        """A node in an enclave, once; the first of its profiles there is named."""
        own = [self._graph.elements[vertex] for vertex in self._owned.get(owner, ())]
        nodes = {element.name: element for element in own if element.is_node}
        first: dict[tuple[str, str], Profile] = {}
        for profile in self._placed.profiles.get(owner, ()):
            first.setdefault((profile.enclave, profile.node), profile)
        for profile in first.values():
            place = {"file": profile.place.file, "line": profile.place.line, "robot": name}
            key = ids.of(nodes[profile.node], name)
            yield {"source": key, "target": enclave_id(name, profile.enclave), "properties": place}

    def _derived(self, owner: str, name: str, ids: _Ids) -> Iterator[Row]:
        elements = self._graph.elements
        for origin in self._origins:
            maker, source = elements[origin.maker], elements[origin.source]
            if maker.robot == owner:
                properties = origin_properties(self._analysis, origin, name)
                for robot in ids.expanded(source.robot):
                    yield {"source": ids.of(maker, name), "target": ids.of(source, robot), "properties": properties}

    def _findings(self, owner: str, name: str, ids: _Ids) -> tuple[list[Row], list[Row]]:
        rows: list[Row] = []
        across: list[Row] = []
        for finding in self._analysis.findings:
            if finding.source.robot != owner or not self._likeness.count(finding):
                continue
            leaks = ids.expanded(finding.leak.robot)
            for robot in self._sample(owner, name, leaks) if self._across_too_often(finding) else leaks:
                row, steps = self._finding_row(finding, ids, _Moved(finding, name, robot, self._likeness))
                rows.append(row)
                across += steps
        return rows, across

    def _added(self, owner: str, name: str, ids: _Ids, beyond: Beyond) -> BeyondRows:
        """What the enforced view adds on one robot; of findings from robot to robot one for each source."""
        rows = BeyondRows([], [], [], [])
        for added, finding in [(each, finding) for each in beyond.added for finding in each.findings]:
            if finding.source.robot != owner:
                continue
            leaks = ids.expanded(finding.leak.robot)
            for robot in leaks[:1] if self._likeness.across(finding) else leaks:
                moved = _Moved(finding, name, robot, self._likeness)
                row, _ = self._finding_row(finding, ids, moved)
                add_beyond(rows, row, added, finding, moved.ids(ids), moved.robots, beyond.declared)
        return rows

    def _finding_row(self, finding: Finding, ids: _Ids, moved: _Moved) -> tuple[Row, list[Row]]:
        pattern, across = pattern_id(finding, self._likeness), self._likeness.across(finding)
        return finding_row(
            finding, pattern, self._vocabulary, moved.ids(ids), moved.robots, self._contexts, across=across
        )

    @cached_property
    def _contexts(self) -> Contexts:
        return Contexts.of(self._graph, self._placed.bound, self._vocabulary.categories)

    def _sample(self, owner: str, name: str, leaks: list[str]) -> list[str]:
        """Some of the robots where data of one robot ends: one, or so that each of them has data of some robot."""
        if not self._at_either_end:
            return leaks[:1]
        alike = self._likeness.members[owner]
        return leaks[alike.index(name) :: len(alike)] or [leaks[alike.index(name) % len(leaks)]]

    def _part(self, owner: str) -> str | None:
        """What of a fleet it is that is no robot."""
        if self._likeness.is_robot(owner):
            return None
        return DOMAIN if is_domain(owner) else INFRASTRUCTURE if owner in self._placed.profiles else FLEET

    def _across_too_often(self, finding: Finding) -> bool:
        return bool(self._too_many) and pattern_id(finding, self._likeness) in self._too_many

    @cached_property
    def _verdicts(self) -> dict[str, Verdict]:
        first = self._likeness.second
        return robot_verdicts(
            self._analysis, self._owned, lambda element: first.get(element.robot, element.robot), self._not_read
        )


def standard_only(analysis: Analysis, bound: Bound) -> frozenset[int]:
    """Return the channels that the standard file closes and of which nobody else says anything (rule S13).

    Nothing comes out of them, so an answer without them is the same. Those of which it is in doubt whether they are
    what their name says stay.
    """
    spread = analysis.spread
    elements = spread.graph.elements
    doubtful = {row.channel.identity for row in analysis.closed_by_shipped}
    doubtful |= {finding.leak.identity for finding in analysis.findings}
    doubtful |= {
        elements[vertex].identity
        for vertex, statements in bound.elements.items()
        if any(statement.rank[0] != STANDARD for statement in statements)
    }
    return frozenset(vertex for vertex in spread.standard if elements[vertex].identity not in doubtful)


class _Ids:
    """Ids of elements for one robot of the fleet, for which ``owner`` stands in the graph."""

    def __init__(self, owner: str, name: str, likeness: Likeness) -> None:
        self.foreign: dict[str, tuple[Element, str]] = {}
        self.foreign_intakes: dict[str, tuple[Element, str]] = {}
        self._owner = owner
        self._name = name
        self._likeness = likeness

    def of(self, element: Element, robot: str) -> str:
        """The id of an element on a robot of the fleet."""
        key = element_id(robot, element)
        if robot != self._name:
            self.foreign[key] = (element, robot)
        return key

    def end(self, element: Element, robot: str, intake: bool) -> str:  # noqa: FBT001 - one of two ids
        """The id of an element on a robot of the fleet, or of its intake."""
        key = self.of(element, robot)
        if intake and robot != self._name:
            self.foreign_intakes[key] = (element, robot)
        return end_id(key, intake)

    def expanded(self, robot: str) -> list[str]:
        """The robots of the fleet for which a robot of the graph stands, at the end of what begins here."""
        likeness = self._likeness
        if robot == self._owner:
            return [self._name]
        if robot in likeness.second:
            first = likeness.second[robot]
            return [other for other in likeness.members[first] if other != self._name] if first == self._owner else []
        return list(likeness.members.get(robot, (robot,)))


class _Moved:
    """A finding of the graph on robots of the fleet: those of its ends, and on the way any that there are."""

    def __init__(self, finding: Finding, source: str, leak: str, likeness: Likeness) -> None:
        names = {finding.source.robot: source, finding.leak.robot: leak}
        for element in finding.witness:
            if element.robot not in names:
                alike = likeness.members.get(likeness.second.get(element.robot, element.robot), (element.robot,))
                taken = set(names.values())
                names[element.robot] = next((name for name in alike if name not in taken), element.robot)
        elements = (*finding.witness, finding.source, finding.leak)
        self.robots = {element: names[element.robot] for element in elements}

    def ids(self, ids: _Ids) -> dict[Element, str]:
        """The id of each of its elements."""
        return {element: ids.of(element, robot) for element, robot in self.robots.items()}
