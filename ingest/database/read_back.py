"""Neo4j -> ``FlowGraph`` and ``Bound``: what is in the database, with what people added to it. Takes a driver.

In: elements, flows and roles of the graph, ours or written by hand. Out: ``Stored``, to be analysed like what comes
from files, and what is needed to write the answer back (``write_back.py``). What a person adds needs little: a label
that says the kind, a name, a ``FLOWS_TO``. A role without ``tier`` is a person's later word and outranks every file.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import GraphError, InputError, InputErrors, shown
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS, Likeness
from rosprivacy.analysis.model import (
    CHANNELS,
    NON_ROS,
    STANDARD,
    Bound,
    Element,
    FlowGraph,
    Place,
    Profile,
    Statement,
)
from rosprivacy.analysis.non_ros import by_kind
from rosprivacy.ingest.database.by_hand import Sealed, meaningless_relationships
from rosprivacy.ingest.database.exposure_properties import exposures_of
from rosprivacy.ingest.database.flow_statements import DATABASE, names_of, statements_of
from rosprivacy.ingest.database.non_ros_properties import facts_of
from rosprivacy.ingest.database.other_schemas import HINT, of_other_schemas
from rosprivacy.ingest.database.processing_properties import processing_of
from rosprivacy.ingest.database.robot_notices import unreadable
from rosprivacy.ingest.database.row_facts import (
    ADDED,
    MATCHES,
    denied_flow_of,
    flow_of,
    flows_through,
    grants_of,
    role_facts_of,
    subjects_of,
)
from rosprivacy.ingest.database.schema import KIND_LABELS, ROLES
from rosprivacy.ingest.database.type_properties import types_of
from rosprivacy.ingest.labels.entries import is_log, without_text
from rosprivacy.ingest.labels.stated_facts import in_order, surroundings_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from neo4j import Driver, ManagedTransaction, Record

    from rosprivacy.analysis.model import Exposure, MessageType, NonRosFacts, Processing
    from rosprivacy.ontology.vocabulary import Vocabulary

_FLOW_ROLES = {"publish", "subscribe", "request", "reply", "call", "execute", MATCHES}
_KIND_OF = {label: kind for kind, label in KIND_LABELS.items()}
_ROLE_OF = {kind.type: role for role, kind in ROLES.items()}
FACTS = 12  # of a role, as ``role_facts_of`` returns them

ROBOTS = "MATCH (r:Robot) RETURN properties(r) AS robot ORDER BY r.name"
ELEMENTS = (
    "MATCH (n) WHERE (n:Element AND NOT n:Intake) OR EXISTS { (n)-[:FLOWS_TO]-() } "
    "RETURN elementId(n) AS key, labels(n) AS labels, properties(n) AS properties"
)
FLOWS = (
    "MATCH (a)-[f:FLOWS_TO]->(b) "
    "RETURN elementId(f) AS key, elementId(a) AS source, elementId(b) AS target, properties(f) AS properties"
)
SAID = (
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
    """Read everything.

    Raises
    ------
    InputErrors
        With every element, flow or role that cannot be understood.
    """
    with driver.session() as session:
        return session.execute_read(_read, vocabulary)


def _read(transaction: ManagedTransaction, vocabulary: Vocabulary) -> Stored:
    robots = {record["robot"]["name"]: record["robot"] for record in transaction.run(ROBOTS)}
    if not robots:
        raise InputErrors([_problem("there is no robot in it", "load one with rosprivacy load")])
    if others := of_other_schemas(robots.values()):
        raise InputErrors([_problem(others, HINT)])
    reader = _Reader(vocabulary, alone=len(robots) == 1)
    reader.elements(transaction.run(ELEMENTS))
    reader.flows(transaction.run(FLOWS))
    reader.said(transaction.run(SAID))
    reader.profiles(transaction.run(PROFILES))
    reader.robots(robots)
    reader.by_hand(meaningless_relationships(transaction))
    for name, robot in sorted(robots.items()):
        if damaged := unreadable(robot):
            reader.problems.append(
                _problem(f"{damaged} of robot {shown(name)!r} cannot be understood", "load it again")
            )
    views = sorted({str(robot.get("view", "declared")) for robot in robots.values()})
    if len(views) > 1:
        hint = "load all robots with the same --view"
        reader.problems.append(_problem(f"robots were loaded in the views {' and '.join(views)}", hint))
    if reader.problems:
        raise InputErrors(reader.problems)
    return reader.stored(robots, views[0])


def _problem(problem: str, hint: str) -> InputError:
    return GraphError(DATABASE, 0, problem, hint)


@dataclass(frozen=True, slots=True)
class _Vertex:
    key: str
    labels: frozenset[str]
    properties: Mapping[str, Any]


class _Reader:
    """Rows -> facts; problems are gathered."""

    def __init__(self, vocabulary: Vocabulary, *, alone: bool) -> None:
        self.problems: list[InputError] = []
        self._vocabulary = vocabulary
        self._alone = alone
        self._vertices: dict[Element, _Vertex] = {}
        self._by_key: dict[str, Element] = {}
        self._flows: list[tuple[Element, Element, str, str, Mapping[str, Any]]] = []
        self._said: dict[str, list[tuple[str, tuple[Any, ...], bool]]] = defaultdict(list)
        self._foreign_kinds = False
        self._profiles: list[Profile] = []
        self._outside: dict[Element, NonRosFacts] = {}
        self._processing: dict[str, Processing] = {}
        self._of_robots: dict[str, Processing] = {}
        self._types: dict[str, tuple[MessageType, ...]] = {}
        self._exposed: dict[str, tuple[Exposure, ...]] = {}

    def elements(self, records: Iterable[Record]) -> None:
        for record in records:
            labels, properties = frozenset(record["labels"]), record["properties"]
            name, robot = properties.get("name"), properties.get("robot") or ""
            kinds = {properties.get("kind")} & set(KIND_LABELS) or {_KIND_OF[label] for label in labels & set(_KIND_OF)}
            if not isinstance(name, str) or not name or not isinstance(robot, str):
                what = f"an element with the labels {', '.join(sorted(labels))} has no name"
                self.problems.append(_problem(shown(what), "SET n.name = '…' (and n.robot, if it has one, to text)"))
                continue
            if len(kinds) != 1:
                hint = f"give it one of the labels {', '.join(KIND_LABELS.values())}"
                self.problems.append(_problem(f"what is {shown(name)!r}? its labels do not say its kind", hint))
                continue
            try:
                subjects_of(properties)
            except TypeError as error:
                self.problems.append(_problem(f"{shown(name)!r}: {error}", "SET n.subjects = ['residents', 'staff']"))
                continue
            try:
                surroundings_of(properties, ros="node" in kinds)
            except TypeError as error:
                hint = "SET n.context = ['care'], n.country = 'DE'"
                self.problems.append(_problem(f"{shown(name)!r}: {error}", hint))
                continue
            try:
                if "node" not in kinds and (types := types_of(properties, "" if self._alone else robot)):
                    self._types[record["key"]] = types
                if kinds <= {*CHANNELS} and (exposed := exposures_of(properties)):
                    self._exposed[record["key"]] = exposed
                self._processing[record["key"]] = processing_of(properties, self._vocabulary.categories)
            except ValueError as error:
                what = f"{shown(name)!r} cannot be understood: {shown(str(error))}"
                self.problems.append(_problem(what, "see docs/database.md for what it has"))
                continue
            parts = {key: str(properties.get(key) or "") for key in ("leg", "side")}
            shown_robot = "" if self._alone and robot else robot
            element = Element(
                str(kinds.pop()), name, shown_robot, parts["leg"], parts["side"], tuple(properties.get("without") or ())
            )
            if element in self._vertices:
                hint = "rename one, or remove it"
                self.problems.append(_problem(f"there are two elements {element.kind} {shown(name)!r}", hint))
            if element.kind in NON_ROS:
                self._take_facts(element, properties)
            self._vertices[element] = _Vertex(record["key"], labels, properties)
            self._by_key[record["key"]] = element

    def _take_facts(self, element: Element, properties: Mapping[str, Any]) -> None:
        """What is stated about an element outside ROS; where nothing is, the facts are empty (rule S9)."""
        try:
            self._outside[element] = facts_of(properties, self._vocabulary.categories)
        except ValueError as error:
            what = f"{element.kind} {shown(element.name)!r} cannot be understood: {shown(str(error))}"
            self.problems.append(_problem(what, "see docs/database.md for what it has"))

    def flows(self, records: Iterable[Record]) -> None:
        for record in records:
            ends = self._by_key.get(record["source"]), self._by_key.get(record["target"])
            if not ends[0] or not ends[1]:  # one of them is a problem of its own
                continue
            said = record["properties"]
            try:
                grants_of(said, ADDED, ends[0])
                unknown = names_of(said) - set(self._vocabulary.categories)
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                which = f"{shown(ends[0].name)} -> {shown(ends[1].name)}"
                what = f"a flow cannot be understood: {which}: {shown(str(error))}"
                self.problems.append(_problem(what, "see docs/database.md for what a flow has"))
                continue
            for name in sorted(unknown):
                self.problems.append(_problem(f"a flow names the unknown category {shown(name)!r}", "correct it"))
            role = said.get("role")
            self._flows.append((ends[0], ends[1], role if role in _FLOW_ROLES else ADDED, record["key"], said))

    def said(self, records: Iterable[Record]) -> None:
        for record in records:
            if record["category"] not in self._vocabulary.categories:
                self._foreign_kinds = True
                hint = "use one that rosprivacy load wrote"
                self.problems.append(_problem(f"unknown category {shown(str(record['category']))!r}", hint))
                continue
            role, category, said = _ROLE_OF[record["type"]], record["category"], record["properties"]
            if not (element := self._by_key.get(record["key"])):  # a problem of its own
                continue
            try:
                facts = role_facts_of(role, category, said)
            except (TypeError, ValueError) as error:
                what = f"{ROLES[role].type} of {shown(element.name)!r} cannot be understood: {shown(str(error))}"
                self.problems.append(_problem(what, "see docs/database.md for what a role has"))
                continue
            self._said[record["key"]].append((category, facts, bool(said.get("every"))))

    def profiles(self, records: Iterable[Record]) -> None:
        for record in records:
            place = Place(str(record["file"] or DATABASE), int(record["line"] or 0))
            self._profiles.append(Profile(str(record["enclave"]), str(record["node"]), place))

    def robots(self, robots: Mapping[str, Mapping[str, Any]]) -> None:
        """Read who is responsible for each robot, what for and on which basis."""
        for name, robot in sorted(robots.items()):
            try:
                said = processing_of(robot, self._vocabulary.categories)
            except ValueError as error:
                what = f"robot {shown(name)!r} cannot be understood: {shown(str(error))}"
                self.problems.append(_problem(what, "see docs/database.md for what it has"))
                continue
            if said:
                self._of_robots["" if self._alone else name] = said

    def by_hand(self, meaningless: Iterable[InputError]) -> None:
        """See that what people wrote means something; where kinds are unknown, what is made of them is, too."""
        self.problems += meaningless
        if self._foreign_kinds:
            return
        sealed = Sealed(self._vocabulary)
        for vertex in self._vertices.values():
            made = [category for category, facts, _ in self._said.get(vertex.key, ()) if facts[0] == "derivation"]
            name = str(vertex.properties["name"])
            self.problems += sealed.problems(name, vertex.labels, vertex.properties, made)

    def stored(self, robots: Mapping[str, Mapping[str, Any]], view: str) -> Stored:
        """Number everything, sorted (rule S14)."""
        elements = tuple(sorted(self._vertices, key=Element.sort_key))
        number = {element: i for i, element in enumerate(elements)}
        vertices = [self._vertices[element] for element in elements]
        rows = [(number[a], number[b], role, key, said) for a, b, role, key, said in self._flows]
        rows.sort(key=lambda row: (*row[:3], str(row[4].get("file")), str(row[4].get("line")), row[3]))
        allowed = [row for row in rows if row[4].get("decision") != "deny"]
        refused = [(denied_flow_of(row, elements), row[2]) for row in rows if row[4].get("decision") == "deny"]
        graph = FlowGraph(
            elements,
            tuple(flow_of(row, elements) for row in allowed),
            tuple(flow for flow, role in refused if role != MATCHES),
            tuple(sorted(set(self._profiles), key=lambda p: (p.enclave, p.node, p.place.file, p.place.line))),
            view,
            tuple(flow for flow, role in refused if role == MATCHES),
        )
        statements = {v: tuple(self._statements(vertices[v].key)) for v in range(len(elements))}
        statements = {v: said for v, said in statements.items() if said}
        outside = {v: facts for v, e in enumerate(elements) if (facts := self._outside.get(e)) is not None}
        for vertex in outside:
            statements[vertex] = (*statements.get(vertex, ()), *by_kind(elements[vertex]))
        statements = dict(sorted(statements.items()))
        restrictions = {i: statements_of(row[4], self._vocabulary.hierarchy) for i, row in enumerate(allowed)}
        return Stored(
            graph,
            Bound(
                {v: said for v, said in statements.items() if said},
                {i: said for i, said in restrictions.items() if said},
                flows_through(graph, statements),
                outside,
                surroundings={
                    v: where
                    for v, vertex in enumerate(vertices)
                    if (where := surroundings_of(vertex.properties, ros=elements[v].is_node))
                },
                subjects={v: groups for v, vertex in enumerate(vertices) if (groups := subjects_of(vertex.properties))},
                processing={v: one for v, vertex in enumerate(vertices) if (one := self._processing[vertex.key])},
                of_robots=self._of_robots,
                types=in_order({v: self._types.get(vertex.key, ()) for v, vertex in enumerate(vertices)}),
                exposed={v: some for v, vertex in enumerate(vertices) if (some := self._exposed.get(vertex.key))},
            ),
            robots,
            tuple(vertex.key for vertex in vertices),
            tuple(vertex.labels for vertex in vertices),
            tuple(vertex.properties for vertex in vertices),
            tuple(row[3] for row in allowed),
            tuple(row[4] for row in allowed),
        )

    def _statements(self, key: str) -> Iterator[Statement]:
        """What is said of an element; the categories that one label of a channel names stand together again."""
        together: dict[tuple[Any, ...], list[str]] = defaultdict(list)
        for category, facts, every in self._said.get(key, ()):
            alone = () if facts[0] in ("only", "never", "mundane") or every else (category,)
            together[(*facts, *alone)].append(category)
        for facts, categories in sorted(together.items(), key=lambda item: str(item[0])):
            role, rank, place, method, stated, to, through, every, naming, why, author, pinned = facts[:FACTS]
            names = () if every else tuple(sorted(categories))
            if role == "derivation":
                names = (to,)
                to = categories[0]  # it is stored the other way round: the target is what is made
            shipped = role == "mundane" and rank[0] <= STANDARD
            if shipped and rank[0] == STANDARD and is_log(self._by_key[key].name):  # earlier versions: of every kind
                names = without_text(self._vocabulary)
            yield Statement(role, names, rank, place, method, stated, to, through, shipped, naming, why, author, pinned)
