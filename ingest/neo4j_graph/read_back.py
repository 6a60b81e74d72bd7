"""Neo4j -> ``FlowGraph`` and ``Bound``: what is in the database, with what people added to it. Takes a driver.

In: elements, flows and roles of the graph, ours or written by hand. Out: ``Stored``, to be analysed like what comes
from files, and what is needed to write the answer back (``write_back.py``). What a person adds needs little: a label
that says the kind, a name, a ``FLOWS_TO``. A role without ``tier`` is a person's later word and outranks every file.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import GraphError, InputErrors, shown
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS, Likeness
from rosprivacy.analysis.model import NON_ROS, Bound, Element, FlowGraph, Place, Profile, Statement
from rosprivacy.analysis.non_ros import by_kind
from rosprivacy.ingest.labels.stated_facts import in_order
from rosprivacy.ingest.neo4j_graph.by_hand import Sealed, meaningless_relationships
from rosprivacy.ingest.neo4j_graph.element_facts import ELEMENT_FACTS, outside_facts, processing_of
from rosprivacy.ingest.neo4j_graph.relationship_facts import (
    ADDED,
    MATCHES,
    FlowRow,
    flow_of,
    flows_through,
    grants_of,
    names_of,
    role_of,
    role_statements,
    statements_of,
)
from rosprivacy.ingest.neo4j_graph.robot_facts import HINT, of_other_schemas, unreadable
from rosprivacy.ingest.neo4j_graph.schema import DATABASE, KIND_LABELS, ROLES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from neo4j import Driver, ManagedTransaction, Record

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import NonRosFacts, Processing
    from rosprivacy.ontology.vocabulary import Vocabulary

_FLOW_ROLES = {"publish", "subscribe", "request", "reply", "call", "execute", MATCHES}
_KIND_OF = {label: kind for kind, label in KIND_LABELS.items()}
_ROLE_OF = {kind.type: role for role, kind in ROLES.items()}

ROBOTS = "MATCH (r:Robot) RETURN properties(r) AS robot ORDER BY r.name"
ELEMENTS = (
    "MATCH (n) WHERE (n:Element AND NOT n:Intake) OR EXISTS { (n)-[:FLOWS_TO]-() } "
    "RETURN elementId(n) AS key, labels(n) AS labels, properties(n) AS properties"
)
FLOWS = (
    "MATCH (a)-[f:FLOWS_TO]->(b) "
    "RETURN elementId(f) AS key, elementId(a) AS source, elementId(b) AS target, properties(f) AS properties"
)
OF_ROLES = (
    f"MATCH (n)-[r:{'|'.join(sorted(_ROLE_OF))}]->(c:DataCategory) WHERE n:Element OR EXISTS {{ (n)-[:FLOWS_TO]-() }} "
    "RETURN elementId(n) AS key, type(r) AS type, c.name AS category, properties(r) AS properties"
)
PROFILES = (
    "MATCH (n:Element)-[i:IN_ENCLAVE]->(e:Enclave) "
    "RETURN n.robot AS robot, n.name AS node, e.path AS enclave, i.file AS file, i.line AS line"
)


@dataclass(frozen=True, slots=True)
class Stored:
    """A graph with the database's own keys.

    Attributes
    ----------
    robots
        Properties of each ``Robot``, by name. With one robot only, elements carry no robot's name, as when its files
        are analysed.
    keys
        By vertex: the database's key of the element.
    labels, properties
        By vertex, as they are stored.
    flow_keys, flow_properties
        By index of an allowed flow.
    """

    graph: FlowGraph
    bound: Bound
    robots: Mapping[str, Mapping[str, Any]]
    keys: tuple[str, ...]
    labels: tuple[frozenset[str], ...]
    properties: tuple[Mapping[str, Any], ...]
    flow_keys: tuple[str, ...]
    flow_properties: tuple[Mapping[str, Any], ...]

    def robot_of(self, vertex: int) -> str:
        """Name of an element's robot in the database; empty for what belongs to none."""
        return str(self.properties[vertex].get("robot") or "")

    @property
    def likeness(self) -> Likeness:
        """Which names are those of robots: all but what is shared; none where there is only one."""
        if len(self.robots) == 1:
            return NO_ROBOTS
        robots = {name: said for name, said in self.robots.items() if not said.get("shared")}
        models = {name: str(said.get("model") or "") for name, said in robots.items()}
        return Likeness({name: (name,) for name in robots}, {}, models)


def read_stored(driver: Driver, vocabulary: Vocabulary) -> Stored:
    """Read everything; all elements, flows and roles that cannot be understood are one ``InputErrors``."""
    with driver.session() as session:
        return session.execute_read(_read, vocabulary)


def _read(transaction: ManagedTransaction, vocabulary: Vocabulary) -> Stored:
    robots = {record["robot"]["name"]: record["robot"] for record in transaction.run(ROBOTS)}
    reader = _StoredReader(vocabulary, alone=len(robots) == 1)
    if not robots:
        reader.problem("there is no robot in it", "load one with rosprivacy load")
    elif others := of_other_schemas(robots.values()):
        reader.problem(others, HINT)
    if reader.problems:
        raise InputErrors(reader.problems)
    reader.elements(transaction.run(ELEMENTS))
    reader.flows(transaction.run(FLOWS))
    reader.roles(transaction.run(OF_ROLES))
    reader.profiles(transaction.run(PROFILES))
    reader.robots(robots)
    reader.by_hand(meaningless_relationships(transaction))
    for name, robot in sorted(robots.items()):
        if damaged := unreadable(robot):
            reader.problem(f"{damaged} of robot {shown(name)!r} cannot be understood", "load it again")
    views = sorted({str(robot.get("view", "declared")) for robot in robots.values()})
    if len(views) > 1:
        what = f"robots were loaded in the views {' and '.join(views)}"
        reader.problem(what, "load all robots with the same --view")
    if reader.problems:
        raise InputErrors(reader.problems)
    return reader.stored(robots, views[0])


@dataclass(frozen=True, slots=True)
class _Vertex:
    key: str
    labels: frozenset[str]
    properties: Mapping[str, Any]


class _StoredReader:
    """Rows -> facts; problems are gathered."""

    def __init__(self, vocabulary: Vocabulary, *, alone: bool) -> None:
        self.problems: list[InputError] = []
        self._vocabulary = vocabulary
        self._alone = alone
        self._vertices: dict[Element, _Vertex] = {}
        self._by_key: dict[str, Element] = {}
        self._flows: list[tuple[Element, Element, str, str, Mapping[str, Any]]] = []
        self._roles: dict[str, list[tuple[str, Statement]]] = defaultdict(list)
        self._foreign_kinds = False
        self._profiles: list[Profile] = []
        self._outside: dict[Element, NonRosFacts] = {}
        self._facts: dict[str, dict[Element, Any]] = {fact.field: {} for fact in ELEMENT_FACTS}
        self._of_robots: dict[str, Processing] = {}

    def problem(self, problem: str, hint: str) -> None:
        self.problems.append(GraphError(DATABASE, 0, problem, hint))

    def not_understood(self, place: str, error: Exception, of: str) -> None:
        """Note what properties cannot be read."""
        self.problem(
            f"{place} cannot be understood: {shown(str(error))}", f"see docs/reference/graph.md for what {of} has"
        )

    def elements(self, records: Iterable[Record]) -> None:
        for record in records:
            labels, properties = frozenset(record["labels"]), record["properties"]
            name, robot = properties.get("name"), properties.get("robot") or ""
            kinds = {properties.get("kind")} & set(KIND_LABELS) or {_KIND_OF[label] for label in labels & set(_KIND_OF)}
            if not isinstance(name, str) or not name or not isinstance(robot, str):
                what = f"an element with the labels {', '.join(sorted(labels))} has no name"
                self.problem(shown(what), "SET n.name = '…' (and n.robot, if it has one, to text)")
                continue
            if len(kinds) != 1:
                hint = f"give it one of the labels {', '.join(KIND_LABELS.values())}"
                self.problem(f"what is {shown(name)!r}? its labels do not say its kind", hint)
                continue
            leg, side = (str(properties.get(key) or "") for key in ("leg", "side"))
            without = tuple(properties.get("without") or ())
            element = Element(str(kinds.pop()), name, "" if self._alone else robot, leg, side, without)
            if not self._take_facts(element, properties):
                continue
            if element in self._vertices:
                self.problem(f"there are two elements {element.kind} {shown(name)!r}", "rename one, or remove it")
            if element.kind in NON_ROS:  # where nothing is stated, the facts are empty (rule S9)
                try:
                    self._outside[element] = outside_facts(properties, self._vocabulary.categories)
                except ValueError as error:
                    self.not_understood(f"{element.kind} {shown(name)!r}", error, "it")
            self._vertices[element] = _Vertex(record["key"], labels, properties)
            self._by_key[record["key"]] = element

    def _take_facts(self, element: Element, properties: Mapping[str, Any]) -> bool:
        """Read what is stated about an element; return whether it can be understood."""
        for fact in ELEMENT_FACTS:
            try:
                stated = fact.read(properties, element, self._vocabulary.categories)
            except (TypeError, ValueError) as error:
                if fact.example:
                    self.problem(f"{shown(element.name)!r}: {error}", fact.example)
                else:
                    self.not_understood(repr(shown(element.name)), error, "it")
                return False
            if stated:
                self._facts[fact.field][element] = stated
        return True

    def flows(self, records: Iterable[Record]) -> None:
        for record in records:
            source, target = self._by_key.get(record["source"]), self._by_key.get(record["target"])
            if not source or not target:  # one of them is a problem of its own
                continue
            properties = record["properties"]
            try:
                grants_of(properties, ADDED, source)
                unknown = names_of(properties) - set(self._vocabulary.categories)
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                which = f"{shown(source.name)} -> {shown(target.name)}"
                what = f"a flow cannot be understood: {which}: {shown(str(error))}"
                self.problem(what, "see docs/reference/graph.md for what a flow has")
                continue
            for name in sorted(unknown):
                self.problem(f"a flow names the unknown category {shown(name)!r}", "correct it")
            role = properties.get("role")
            self._flows.append((source, target, role if role in _FLOW_ROLES else ADDED, record["key"], properties))

    def roles(self, records: Iterable[Record]) -> None:
        for record in records:
            role, category = _ROLE_OF[record["type"]], record["category"]
            if category not in self._vocabulary.categories:
                self._foreign_kinds = True
                self.problem(f"unknown category {shown(str(category))!r}", "use one that rosprivacy load wrote")
            elif element := self._by_key.get(record["key"]):  # else a problem of its own
                try:
                    statement = role_of(role, category, record["properties"])
                except (TypeError, ValueError) as error:
                    self.not_understood(f"{ROLES[role].type} of {shown(element.name)!r}", error, "a role")
                else:
                    self._roles[record["key"]].append((category, statement))

    def profiles(self, records: Iterable[Record]) -> None:
        for record in records:
            place = Place(str(record["file"] or DATABASE), int(record["line"] or 0))
            self._profiles.append(Profile(str(record["enclave"]), str(record["node"]), place))

    def robots(self, robots: Mapping[str, Mapping[str, Any]]) -> None:
        """Read who is responsible for each robot, what for and on which basis."""
        for name, robot in sorted(robots.items()):
            try:
                stated = processing_of(robot, self._vocabulary.categories)
            except ValueError as error:
                self.not_understood(f"robot {shown(name)!r}", error, "it")
                continue
            if stated:
                self._of_robots["" if self._alone else name] = stated

    def by_hand(self, meaningless: Iterable[InputError]) -> None:
        """See that what people wrote means something; where kinds are unknown, what is made of them is, too."""
        self.problems += meaningless
        if self._foreign_kinds:
            return
        sealed = Sealed(self._vocabulary)
        for vertex in self._vertices.values():
            made = [
                category for category, statement in self._roles.get(vertex.key, ()) if statement.role == "derivation"
            ]
            name = str(vertex.properties["name"])
            self.problems += sealed.problems(name, vertex.labels, vertex.properties, made)

    def stored(self, robots: Mapping[str, Mapping[str, Any]], view: str) -> Stored:
        """Number everything, sorted (rule S14)."""
        elements = tuple(sorted(self._vertices, key=Element.sort_key))
        number = {element: i for i, element in enumerate(elements)}
        vertices = [self._vertices[element] for element in elements]
        rows = [FlowRow(number[a], number[b], role, key, row) for a, b, role, key, row in self._flows]
        rows.sort(key=lambda row: (*row[:3], str(row.properties.get("file")), str(row.properties.get("line")), row.key))
        allowed = [row for row in rows if row.properties.get("decision") != "deny"]
        refused = [flow_of(row, elements) for row in rows if row.properties.get("decision") == "deny"]
        graph = FlowGraph(
            elements,
            tuple(flow_of(row, elements) for row in allowed),
            tuple(flow for flow in refused if flow.role != MATCHES),
            tuple(sorted(set(self._profiles), key=lambda p: (p.enclave, p.node, p.place.file, p.place.line))),
            view,
            tuple(flow for flow in refused if flow.role == MATCHES),
        )
        statements: dict[int, tuple[Statement, ...]] = {}
        for v, element in enumerate(elements):
            of_element = role_statements(self._roles.get(vertices[v].key, ()), element, self._vocabulary)
            statements[v] = (*of_element, *(by_kind(element) if element in self._outside else ()))
        statements = {v: of_element for v, of_element in statements.items() if of_element}
        restrictions = {i: statements_of(row.properties, self._vocabulary.hierarchy) for i, row in enumerate(allowed)}
        facts: dict[str, Any] = {
            field: {v: stated[element] for v, element in enumerate(elements) if element in stated}
            for field, stated in self._facts.items()
        }
        bound = Bound(
            statements,
            {i: of_flow for i, of_flow in restrictions.items() if of_flow},
            flows_through(graph, statements),
            {v: self._outside[element] for v, element in enumerate(elements) if element in self._outside},
            of_robots=self._of_robots,
            **{**facts, "types": in_order(facts["types"])},
        )
        return Stored(
            graph,
            bound,
            robots,
            tuple(vertex.key for vertex in vertices),
            tuple(vertex.labels for vertex in vertices),
            tuple(vertex.properties for vertex in vertices),
            tuple(row.key for row in allowed),
            tuple(row.properties for row in allowed),
        )
