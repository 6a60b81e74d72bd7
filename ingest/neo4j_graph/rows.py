"""Analysis -> the rows that Neo4j takes: what it says of elements, flows and findings, as properties and labels.

In: an analysis and the statements that it rests on. Out: plain values for the properties of ``schema.py``; a test holds
this. Used when robots are loaded, and when the answer to what is in the database is written back.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.findings.beyond import beyond
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.legal import turned_special
from rosprivacy.analysis.model import GDPR_APPLIES
from rosprivacy.analysis.non_ros import BY_KIND
from rosprivacy.ingest.neo4j_graph.by_hand import seal_of
from rosprivacy.ingest.neo4j_graph.carrying import moving
from rosprivacy.ingest.neo4j_graph.element_facts import outside_properties, stated_properties
from rosprivacy.ingest.neo4j_graph.ids import enclave_id, intake_id
from rosprivacy.ingest.neo4j_graph.schema import INTAKE, KIND_LABELS, LEG, SCHEMA, WILDCARD

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.findings.beyond import Added, Ends
    from rosprivacy.analysis.findings.derived_from import Origin
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, NonRosFacts, Statement
    from rosprivacy.ontology.vocabulary import Vocabulary

Row = dict[str, Any]


class Beyond(NamedTuple):
    """What the enforced view adds, and the flows that profiles allow."""

    added: tuple[Added, ...] = ()
    declared: frozenset[Ends] = frozenset()


class BeyondRows(NamedTuple):
    """What the enforced view adds on one robot: nothing of it is a ``Finding`` or a ``FLOWS_TO`` (rule S6).

    Attributes
    ----------
    findings
        As those of ``RobotRows``.
    flows
        ``source``, ``target`` (ids), ``properties``: steps that no profile of their node allows.
    possible, split
        ``source`` (id of the finding), ``target`` (id of the enclave), ``properties``.
    """

    findings: list[Row]
    flows: list[Row]
    possible: list[Row]
    split: list[Row]


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
    beyond: BeyondRows = field(default_factory=lambda: BeyondRows([], [], [], []))

    @property
    def digest(self) -> str:
        """SHA-256 of everything else."""
        return str(self.properties["digest"])

    @property
    def size(self) -> int:
        """Number of rows, for batches and progress."""
        lists = (self.elements, self.memberships, self.flows, self.derived, self.carried, self.findings, self.across)
        return sum(map(len, (*lists, *self.roles.values())))


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


class Names:
    """Sets of bits -> names, as lists that are shared by all that have the same.

    Attributes
    ----------
    exact
        The kinds of some bits, planes put together.
    broad
        The same with all broader kinds.
    labels
        (bits, suffix) -> the labels of these, such as ``BiometricLeak``.
    """

    def __init__(self, spread: Spread, vocabulary: Vocabulary, labels: Mapping[str, str]) -> None:
        ancestors = vocabulary.hierarchy.ancestors

        @cache
        def exact(bits: int) -> list[str]:
            return list(spread.names(bits))

        @cache
        def broad(bits: int) -> list[str]:
            return sorted({up for name in exact(bits) for up in ancestors[name]})

        @cache
        def as_labels(bits: int, suffix: str) -> list[str]:
            return [labels[name] + suffix for name in broad(bits)]

        self.exact, self.broad, self.labels = exact, broad, as_labels


class Roles:
    """Statements about an element -> the kinds that it lets out, cleans, and makes of others, if they come (rule S7).

    All kinds of the vocabulary are asked for, not only those that a source brings in. The labels of leaks say less: of
    a display, which lets out whatever comes, those of all kinds would say nothing.
    """

    def __init__(self, vocabulary: Vocabulary, labels: Mapping[str, str]) -> None:
        self._hierarchy = vocabulary.hierarchy
        self._labels = labels
        self._top = [name for name, above in self._hierarchy.ancestors.items() if len(above) == 1]
        self._numbers: dict[tuple[Statement, ...], tuple[list[str], list[str]]] = {}

    def of(self, statements: tuple[Statement, ...]) -> tuple[list[str], list[str]]:
        """(kinds that leak, kinds that are cleaned)."""
        if statements not in self._numbers:
            self._numbers[statements] = self._decided(statements, "leak"), self._decided(statements, "sanitizer")
        return self._numbers[statements]

    def labels(self, statements: tuple[Statement, ...], gets: Iterable[str]) -> list[str]:
        """The labels of what is made, let out and cleaned; leaks of kinds that get there or that somebody names.

        Who says it of every kind names those at the top.
        """
        leaks, cleans = self.of(statements)
        words = [s for s in statements if s.role == "leak" and s.rank != BY_KIND]
        named = {name for s in words for name in s.categories or self._top}
        return [
            *self._as_labels({s.to for s in statements if s.role == "derivation"}, "Source"),
            *self._as_labels(set(leaks) & {*gets, *named}, "Leak"),
            *self._as_labels(cleans, "Sanitizer"),
        ]

    def _decided(self, statements: tuple[Statement, ...], role: str) -> list[str]:
        if not any(statement.role == role for statement in statements):
            return []
        return [category for category in sorted(self._hierarchy.ancestors) if self._holds(statements, role, category)]

    def _holds(self, statements: tuple[Statement, ...], role: str, category: str) -> bool:
        try:
            return role in facts("", statements, category, self._hierarchy).roles
        except LabelError:  # two labels contradict each other about a kind that nobody brings in: the worse one counts
            leaks = tuple(statement for statement in statements if statement.role == "leak")
            return role == "leak" and role in facts("", leaks, category, self._hierarchy).roles

    def _as_labels(self, names: Iterable[str], suffix: str) -> list[str]:
        return sorted({self._labels[up] + suffix for name in names for up in self._hierarchy.ancestors[name]})


def element_results(analysis: Analysis, bound: Bound, names: Names, roles: Roles) -> Iterator[tuple[Row, list[str]]]:
    """Return properties and category labels of each element, in the order of the graph."""
    spread = analysis.spread
    questions = {question.element.shown_as: question for question in analysis.open}
    for vertex, element in enumerate(analysis.graph.elements):
        question = questions.get(element.shown_as)
        present, begins = spread.present(vertex), spread.begins(vertex)
        statements = bound.elements.get(vertex, ())
        leaks, cleans = roles.of(statements)
        labels = [*names.labels(present, ""), *names.labels(begins, "Source")]
        labels = list(dict.fromkeys((*labels, *roles.labels(statements, names.exact(present)))))
        properties = {
            "carries": names.broad(present),
            "pseudonymised": names.broad(spread.bits.planes(present)[1]),
            "begins": names.exact(begins),
            "leaks": leaks,
            "sanitizes": cleans,
            "stops": names.exact(_stopped(spread, spread.keeps.get(vertex, spread.all_bits))),
            **stated_properties(bound, vertex, element),
            "open": list(question.categories) if question else [],
            "frontier": question.frontier if question else None,
            "distance": question.distance if question else None,
        }
        yield {**properties, "seal": seal_of(properties, labels)}, labels


def _stopped(spread: Spread, keeps: int) -> int:
    """Kinds that go on neither as they are nor pseudonymised."""
    return spread.all_bits & ~spread.bits.in_both_forms(keeps)


def flow_results(analysis: Analysis, names: Names) -> Iterator[Row]:
    """Return the properties of each allowed flow, in the order of the graph."""
    spread = analysis.spread
    for index, moved in enumerate(moving(analysis)):
        yield {
            "carries": names.broad(spread.along(index)),
            "passes": names.exact(moved.passed) or None,
            "begins": names.exact(moved.begun) or None,
            "made": names.exact(moved.derived) or None,
            "stops": names.exact(_stopped(spread, spread.passing(index))) or None,
        }


def kind_labels(element: Element) -> list[str]:
    """Return the labels that say what an element is.

    >>> from rosprivacy.analysis.model import Element
    >>> kind_labels(Element("service", "/add", leg="request"))
    ['Service', 'Leg']
    """
    return [KIND_LABELS[element.kind], *([LEG] if element.leg else ()), *([WILDCARD] if element.pattern else ())]


def element_row(
    robot: str, key: str, element: Element, properties: Row, labels: Iterable[str], stated: NonRosFacts | None
) -> Row:
    """Return the row of an element with what the analysis says of it."""
    known = {
        "name": element.name,
        "robot": robot,
        "kind": element.kind,
        "leg": element.leg or None,
        "side": element.side or None,
        "without": list(element.without) or None,
        **(outside_properties(stated) if stated else {}),
    }
    return {"id": key, "labels": [*kind_labels(element), *labels], "properties": {**known, **properties}}


def intake_row(robot: str, key: str, element: Element, labels: Iterable[str] = ()) -> Row:
    """Return the row of the intake of an element, whose id is given."""
    known = {"name": element.name, "robot": robot or None, "kind": element.kind}
    return {"id": intake_id(key), "labels": [INTAKE, *labels], "properties": known}


def end_id(key: str, intake: bool) -> str:  # noqa: FBT001 - one of two ids
    """Return the id of an element or of its intake."""
    return intake_id(key) if intake else key


def origin_properties(analysis: Analysis, origin: Origin, robot: str) -> Row:
    """Return the properties of one ``DERIVES_FROM``."""
    elements, flows = analysis.graph.elements, analysis.graph.flows
    lines = [flows[index].grants[0].place if flows[index].grants else "" for index in origin.flows]
    return {
        "category": origin.category,
        "way": [elements[vertex].name for vertex in origin.path],
        "policy": [str(line) for line in lines],
        "past_leak": origin.past_leak,
        "robot": robot,
    }


def finding_row(
    finding: Finding,
    pattern: str,
    vocabulary: Vocabulary,
    ids: Mapping[Element, str],
    robots: Mapping[Element, str],
    contexts: Contexts,
    *,
    across: bool,
) -> tuple[Row, list[Row]]:
    """Return the row of a finding, and those of the elements that it goes across.

    Parameters
    ----------
    across
        Whether it goes from one robot to another: then no number of paths is written, as it is counted of few.
    """
    robot = robots[finding.source]
    key = f"{robot}|{pattern}" if robots[finding.leak] == robot else f"{robot}|{pattern}|{ids[finding.leak]}"
    row = {
        "id": key,
        "source": ids[finding.source],
        "target": ids[finding.leak],
        "category": vocabulary.categories[finding.category].iri,
        "properties": {
            "pattern": pattern,
            "robot": robot,
            "leak_robot": robots[finding.leak],
            "kind": finding.kind,
            "reason": finding.reason or None,
            "category": finding.category,
            "source": finding.source.name,
            "leak": finding.leak.name,
            "pseudonymised": finding.pseudonymised,
            "dismissed": finding.dismissed,
            "disjoint_paths": None if across else finding.number_of_paths,
            "article9": contexts.article9(finding),
            "in_context": [f"{legal.context}: {legal.name}" for legal in contexts.revealed(finding)] or None,
            "gdpr": None if (scope := contexts.scope(finding)) == GDPR_APPLIES else scope,
            "special_from": turned.name if (turned := turned_special(finding, vocabulary.categories)) else None,
        },
    }
    return row, [{"source": key, "target": ids[element], "properties": step} for element, step in _steps(finding)]


def _steps(finding: Finding) -> Iterator[tuple[Element, Row]]:
    first = finding.steps[0] if finding.steps else finding
    yield finding.witness[0], {"step": 0, "category": first.category, "pseudonymised": first.pseudonymised}
    for number, step in enumerate(finding.steps, 1):
        place = step.grants[0].place if step.grants else None
        line = {"file": place.file, "line": place.line} if place else {}
        yield step.target, {"step": number, "category": step.category, "pseudonymised": step.pseudonymised, **line}


def add_beyond(
    rows: BeyondRows,
    row: Row,
    added: Added,
    finding: Finding,
    ids: Mapping[Element, str],
    robots: Mapping[Element, str],
    declared: frozenset[Ends],
) -> None:
    """Add a finding that only the enforced view has, with its steps and enclaves.

    Parameters
    ----------
    row
        Of the finding, as that of any.
    ids, robots
        Of the elements of its witness.
    """
    robot = row["properties"]["robot"]
    known = {key: value for key, value in row["properties"].items() if key != "dismissed"}
    steps = [finding.steps[number] for number in beyond(finding, declared)]
    rows.findings.append({**row, "properties": {**known, **_added_properties(added, finding), "beyond": [
        f"{step.source.name} {step.role} {step.target.name} ({step.grants[0].place})" for step in steps
    ]}})  # fmt: skip
    taken = {(flow["source"], flow["target"]) for flow in rows.flows}
    for step in steps:
        node, grant = step.target if step.source.is_channel else step.source, step.grants[0]
        line = {"file": grant.place.file, "line": grant.place.line, "enclave": grant.enclave, "profile": grant.node}
        ends = {"source": ids[step.source], "target": ids[step.target]}
        if (ends["source"], ends["target"]) not in taken:
            rows.flows.append({**ends, "properties": {"role": step.role, "robot": robot, **line}})
        for path in sorted({grant.enclave for grant in step.grants} & set(added.enclaves)):
            end = {"source": row["id"], "target": enclave_id(robots[node], path), "properties": {}}
            if end not in rows.possible:
                rows.possible.append(end)
    rows.split.extend(
        {"source": row["id"], "target": enclave_id(robot, path), "properties": {}} for path in added.split
    )


def _added_properties(added: Added, finding: Finding) -> Row:
    return {
        "view": "enforced",
        "way": [element.name for element in finding.witness],
        "enclaves": list(added.enclaves),
        "split": list(added.split),
        "move": f"{added.move[1]} from {added.move[0]}" if added.move else None,
        "deny": [f"{line.role} {line.name} in {line.enclave} ({line.policy})" for line in added.deny],
        "loses": [f"{node[2]} {role} {channel[2]}" for node, role, channel in added.loses],
        "plain": added.plain,
        "opened_by": [str(place) for place in added.opened] or None,
    }
