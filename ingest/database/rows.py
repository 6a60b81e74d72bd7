"""Analysis -> the rows that Neo4j takes: one robot's elements, flows, roles and findings, as plain values.

In: the analysis of one robot and the statements that it rests on. Out: ``RobotRows``, whose digest says whether
anything differs from what was loaded before. The properties are those of ``schema.py``; a test holds this.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.model import CANNOT, UNSTATED
from rosprivacy.analysis.non_ros import BY_KIND
from rosprivacy.ingest.database.beyond_rows import NOTHING, Beyond, BeyondRows, add_beyond
from rosprivacy.ingest.database.carrying import Carrying
from rosprivacy.ingest.database.element_properties import (
    Names,
    Roles,
    element_results,
    finding_row,
    finding_rows,
    flow_results,
    origin_rows,
)
from rosprivacy.ingest.database.flow_statements import as_properties
from rosprivacy.ingest.database.ids import category_labels, element_id, enclave_id, intake_id
from rosprivacy.ingest.database.non_ros_properties import properties_of
from rosprivacy.ingest.database.processing_properties import processing_properties
from rosprivacy.ingest.database.schema import INTAKE, KIND_LABELS, LEG, SCHEMA, WILDCARD

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Bound, Element, Flow, Grant, NonRosFacts, Statement
    from rosprivacy.ontology.vocabulary import Vocabulary

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class RobotRows:
    """What is written of one robot.

    Attributes
    ----------
    robot
        Its name.
    properties
        Of the ``Robot``, its digest and counts among them.
    elements
        ``id``, ``labels``, ``properties``.
    enclaves
        ``id``, ``properties``.
    intakes
        As elements: what stands for one where what comes to it goes on another way than what begins there.
    memberships, flows, derived
        ``source``, ``target`` (ids), ``properties``.
    carried
        ``source``, ``target`` (ids), ``types``: along which kinds of relationships data goes.
    roles
        By role: ``source`` (id), ``target`` (IRI), ``properties``.
    findings
        ``id``, ``source``, ``target`` (ids), ``category`` (IRI), ``properties``.
    across
        ``source`` (id of the finding), ``target`` (id of the element), ``properties``.
    foreign
        Elements of other robots at which flows and findings of this one end: as ``elements``, without what is said
        of them.
    beyond
        What the enforced view adds; nothing where nobody asked for both views.
    """

    robot: str
    properties: Row
    elements: list[Row]
    intakes: list[Row]
    enclaves: list[Row]
    memberships: list[Row]
    flows: list[Row]
    roles: dict[str, list[Row]]
    derived: list[Row]
    carried: list[Row]
    findings: list[Row]
    across: list[Row]
    foreign: list[Row] = field(default_factory=list)
    beyond: BeyondRows = NOTHING

    @property
    def digest(self) -> str:
        """SHA-256 of everything else."""
        return str(self.properties["digest"])

    @property
    def size(self) -> int:
        """Number of rows, for batches and progress."""
        lists = (self.elements, self.memberships, self.flows, self.derived, self.carried, self.findings, self.across)
        return sum(map(len, (*lists, *self.roles.values())))


def robot_rows(
    robot: str,
    analysis: Analysis,
    bound: Bound,
    vocabulary: Vocabulary,
    more: Mapping[str, Any] | None = None,
    beyond: Beyond | None = None,
) -> RobotRows:
    """Return the rows of one robot.

    Parameters
    ----------
    robot
        Name in the database.
    analysis
        Of all categories, not of a choice.
    bound
        The statements that it rests on.
    more
        Further properties of the ``Robot``.
    beyond
        What the enforced view adds; None where nobody asked for both views.

    Raises
    ------
    InputErrors
        If a category's label cannot be one.
    """
    graph = analysis.graph
    labels = category_labels(vocabulary)
    names, roles = Names(analysis.spread, vocabulary, labels), Roles(vocabulary, labels)
    ids = [element_id(robot, element) for element in graph.elements]
    by_element = dict(zip(graph.elements, ids, strict=True))
    enclaves = sorted({profile.enclave for profile in graph.profiles})
    found, across = finding_rows(analysis, bound, vocabulary, by_element, dict.fromkeys(graph.elements, robot))
    results = list(element_results(analysis, bound, names, roles))
    carrying = Carrying(analysis, [said for _, said in results], labels)
    elements = graph.elements
    parts: dict[str, Any] = {
        "elements": list(_elements(robot, ids, results, analysis)),
        "intakes": [intake_row(robot, ids[v], elements[v], carrying.labels(v)) for v in carrying.intakes],
        "enclaves": [{"id": enclave_id(robot, e), "properties": {"path": e, "robot": robot}} for e in enclaves],
        "memberships": list(_memberships(robot, analysis)),
        "flows": list(_flows(robot, analysis, bound, names, ids)),
        "roles": _roles(robot, bound, vocabulary, ids),
        "derived": list(origin_rows(analysis, ids, [robot] * len(ids))),
        "carried": [
            {"source": end_id(ids[a], part), "target": end_id(ids[b], to), "types": types}
            for (a, part), (b, to), types in carrying.steps
        ],
        "findings": found,
        "across": across,
    }
    properties: Row = {
        "verdict": str(analysis.verdict),
        "view": graph.view,
        **stated_of_robot(bound, ""),
        **(more or {}),
    }
    if beyond:
        parts["beyond"] = _beyond(robot, beyond, analysis, bound, vocabulary)
        properties["beyond"] = len(parts["beyond"].findings)
    return rows_of(robot, properties, parts)


def _beyond(robot: str, beyond: Beyond, analysis: Analysis, bound: Bound, vocabulary: Vocabulary) -> BeyondRows:
    rows = BeyondRows([], [], [], [])
    contexts = Contexts.of(analysis.graph, bound, vocabulary.categories)
    for one in beyond.added:
        ids = {element: element_id(robot, element) for element in (*one.finding.witness, one.finding.source)}
        robots = dict.fromkeys(ids, robot)
        row, _ = finding_row(one.finding, one.finding.id, vocabulary, ids, robots, contexts, across=False)
        add_beyond(rows, row, one, one.finding, ids, robots, beyond.declared)
    return rows


def stated_of_robot(bound: Bound, robot: str) -> Row:
    """Return who is responsible for a robot, what for and on which basis, as far as it is stated."""
    said = processing_properties(bound.of_robots.get(robot, UNSTATED))
    return {key: value for key, value in said.items() if value is not None}


def rows_of(robot: str, properties: Row, parts: Mapping[str, Any]) -> RobotRows:
    """Return the rows of a robot with their digest and counts."""
    counts = {
        "elements": len(parts["elements"]),
        "flows": len(parts["flows"]),
        "roles": sum(map(len, parts["roles"].values())),
        "carried": sum(len(row["types"]) for row in parts["carried"]),
    }
    known = {"schema": SCHEMA, **counts, **properties}
    text = json.dumps([robot, known, parts], sort_keys=True)
    return RobotRows(robot, {**known, "digest": hashlib.sha256(text.encode()).hexdigest()}, **parts)


def kind_labels(element: Element) -> list[str]:
    """Return the labels that say what an element is.

    >>> from rosprivacy.analysis.model import Element
    >>> kind_labels(Element("service", "/add", leg="request"))
    ['Service', 'Leg']
    """
    return [KIND_LABELS[element.kind], *([LEG] if element.leg else ()), *([WILDCARD] if element.pattern else ())]


def _elements(
    robot: str, ids: Sequence[str], results: Iterable[tuple[Row, list[str]]], analysis: Analysis
) -> Iterator[Row]:
    for element, key, (properties, labels) in zip(analysis.graph.elements, ids, results, strict=True):
        yield element_row(robot, key, element, properties, labels, analysis.outside.get(element))


def element_row(
    robot: str, key: str, element: Element, properties: Row, labels: Iterable[str], facts: NonRosFacts | None
) -> Row:
    """Return the row of an element with what the analysis says of it."""
    known = {
        "name": element.name,
        "robot": robot,
        "kind": element.kind,
        "leg": element.leg or None,
        "side": element.side or None,
        "without": list(element.without) or None,
        **(properties_of(facts) if facts else {}),
    }
    return {"id": key, "labels": [*kind_labels(element), *labels], "properties": {**known, **properties}}


def intake_row(robot: str, key: str, element: Element, labels: Iterable[str] = ()) -> Row:
    """Return the row of the intake of an element, whose id is given."""
    known = {"name": element.name, "robot": robot or None, "kind": element.kind}
    return {"id": intake_id(key), "labels": [INTAKE, *labels], "properties": known}


def end_id(key: str, intake: bool) -> str:  # noqa: FBT001 - one of two ids
    """Return the id of an element or of its intake."""
    return intake_id(key) if intake else key


def _memberships(robot: str, analysis: Analysis) -> Iterator[Row]:
    """A node in an enclave, once; the first of its profiles there is named."""
    seen = set()
    nodes = {element.name: element_id(robot, element) for element in analysis.graph.elements if element.is_node}
    for profile in analysis.graph.profiles:
        if (profile.enclave, profile.node) not in seen:
            seen.add((profile.enclave, profile.node))
            place = {"file": profile.place.file, "line": profile.place.line, "robot": robot}
            yield {"source": nodes[profile.node], "target": enclave_id(robot, profile.enclave), "properties": place}


def _flows(robot: str, analysis: Analysis, bound: Bound, names: Names, ids: Sequence[str]) -> Iterator[Row]:
    results = flow_results(analysis, names)
    for index, (flow, result) in enumerate(zip(analysis.graph.flows, results, strict=True)):
        said = bound.flows.get(index, ())
        yield flow_row(robot, flow, ids[flow.source], ids[flow.target], allowed(result, said, names.vocabulary))
    for flow in analysis.graph.taken_back:
        yield flow_row(robot, flow, ids[flow.source], ids[flow.target], denied(flow))


def allowed(result: Row, said: Sequence[Statement], vocabulary: Vocabulary) -> Row:
    """Return the properties of an allowed flow."""
    return {"decision": "allow", **result, **as_properties(said, vocabulary.hierarchy)}


def denied(flow: Flow) -> Row:
    """Return the properties of a denied flow."""
    lines = [json.dumps(_grant(grant), sort_keys=True) for grant in flow.denials]
    by = [str(grant.place) for grant in flow.denials]
    return {"decision": "deny", "carries": [], "denied_by": by, "denials": lines}


def flow_row(robot: str, flow: Flow, source: str, target: str, properties: Row) -> Row:
    """Return the row of a flow between two ids."""
    known: Row = {"role": flow.role, "robot": robot}
    if flow.grants:
        known |= _grant(flow.grants[0])
        further = [json.dumps(_grant(grant), sort_keys=True) for grant in flow.grants[1:]]
        known["further"] = further or None
    return {"source": source, "target": target, "properties": known | properties}


def _grant(grant: Grant) -> Row:
    place = grant.place
    row: Row = {"file": place.file, "line": place.line, "enclave": grant.enclave, "profile": grant.node}
    if grant.seen:
        row |= {"seen_by": list(grant.seen.by), "first_seen": grant.seen.first, "last_seen": grant.seen.last}
    return row


def _roles(robot: str, bound: Bound, vocabulary: Vocabulary, ids: Sequence[str]) -> dict[str, list[Row]]:
    rows: dict[str, list[Row]] = {}
    for vertex, said in bound.elements.items():
        add_roles(rows, robot, ids[vertex], said, vocabulary)
    return rows


def add_roles(
    rows: dict[str, list[Row]], robot: str, key: str, said: Iterable[Statement], vocabulary: Vocabulary
) -> None:
    """Add one relationship per category that a statement names; one about every category goes to those at the top."""
    for statement in said:
        if statement.rank == BY_KIND or statement.role == CANNOT:  # nobody said it; who reads the graph takes it so too
            continue
        properties: Row = {
            "file": statement.place.file,
            "line": statement.place.line,
            "tier": statement.rank[0],
            "specificity": statement.rank[1],
            "naming": statement.naming,
            "every": None if statement.categories else True,
            "robot": robot,
            "why": statement.why or None,
            "author": statement.author or None,
            "pinned": None if statement.pinned is None else list(statement.pinned),
            **_particulars(statement),
        }
        top = [category.name for category in vocabulary.categories.values() if not category.broader]
        named = [statement.to] if statement.role == "derivation" else statement.categories or top
        for name in named:
            iri = vocabulary.categories[name].iri
            rows.setdefault(statement.role, []).append({"source": key, "target": iri, "properties": properties})


def _particulars(statement: Statement) -> Row:
    if statement.role == "source":
        return {"through": list(statement.through) or None}
    if statement.role == "sanitizer":
        method = str(statement.method) if statement.method else None
        return {"method": method, "stated": statement.stated}
    return {"of": statement.categories[0]} if statement.role == "derivation" else {}
