"""Analysis -> what it says of each element and flow, and its findings, as properties and labels of the graph.

In: an analysis. Out: plain values for ``schema.py``'s properties. Used when a robot is loaded, and when the answer to
what is in the database is written back.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.findings.derived_from import origins
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS, pattern_id
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.legal import turned_special
from rosprivacy.analysis.model import UNSTATED
from rosprivacy.analysis.non_ros import BY_KIND
from rosprivacy.ingest.database.by_hand import seal_of
from rosprivacy.ingest.database.carrying import moving
from rosprivacy.ingest.database.exposure_properties import exposure_properties
from rosprivacy.ingest.database.processing_properties import processing_properties
from rosprivacy.ingest.database.type_properties import type_properties

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.derived_from import Origin
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, Processing, Statement, Surroundings
    from rosprivacy.ontology.vocabulary import Vocabulary

Row = dict[str, Any]


class Names:
    """Sets of bits -> names, as lists that are shared by all that have the same.

    Parameters
    ----------
    labels
        Of ``category_labels``.
    """

    def __init__(self, found: Spread, vocabulary: Vocabulary, labels: Mapping[str, str]) -> None:
        self.vocabulary = vocabulary
        self._found = found
        self._hierarchy = vocabulary.hierarchy
        self._labels = labels
        self._exact: dict[int, list[str]] = {}
        self._broad: dict[int, list[str]] = {}
        self._as_labels: dict[tuple[int, str], list[str]] = {}

    def exact(self, bits: int) -> list[str]:
        """The kinds of some bits, planes put together."""
        if bits not in self._exact:
            self._exact[bits] = list(self._found.names(bits))
        return self._exact[bits]

    def broad(self, bits: int) -> list[str]:
        """The same with all broader kinds."""
        if bits not in self._broad:
            self._broad[bits] = sorted({up for name in self.exact(bits) for up in self._hierarchy.ancestors[name]})
        return self._broad[bits]

    def labels(self, bits: int, suffix: str) -> list[str]:
        """The labels of these, such as ``BiometricLeak``."""
        key = bits, suffix
        if key not in self._as_labels:
            self._as_labels[key] = [self._labels[name] + suffix for name in self.broad(bits)]
        return self._as_labels[key]


class Roles:
    """Statements about an element -> the kinds that it lets out, cleans, and makes of others, if they come (rule S7).

    All kinds of the vocabulary are asked for, not only those that a source brings in. The labels of leaks say less: of
    a display, which lets out whatever comes, those of all kinds would say nothing.
    """

    def __init__(self, vocabulary: Vocabulary, labels: Mapping[str, str]) -> None:
        self._hierarchy = vocabulary.hierarchy
        self._labels = labels
        self._top = [name for name, above in self._hierarchy.ancestors.items() if len(above) == 1]
        self._known: dict[tuple[Statement, ...], tuple[list[str], list[str]]] = {}

    def of(self, said: tuple[Statement, ...]) -> tuple[list[str], list[str]]:
        """(kinds that leak, kinds that are cleaned)."""
        if said not in self._known:
            self._known[said] = self._decided(said, "leak"), self._decided(said, "sanitizer")
        return self._known[said]

    def labels(self, said: tuple[Statement, ...], gets: Iterable[str]) -> list[str]:
        """The labels of what is made, let out and cleaned; leaks of kinds that get there or that somebody names.

        Who says it of every kind names those at the top.
        """
        leaks, cleans = self.of(said)
        words = [s for s in said if s.role == "leak" and s.rank != BY_KIND]
        named = {name for s in words for name in s.categories or self._top}
        return [
            *self._as_labels({s.to for s in said if s.role == "derivation"}, "Source"),
            *self._as_labels(set(leaks) & {*gets, *named}, "Leak"),
            *self._as_labels(cleans, "Sanitizer"),
        ]

    def _decided(self, said: tuple[Statement, ...], role: str) -> list[str]:
        if not any(statement.role == role for statement in said):
            return []
        return [category for category in sorted(self._hierarchy.ancestors) if self._holds(said, role, category)]

    def _holds(self, said: tuple[Statement, ...], role: str, category: str) -> bool:
        try:
            return role in facts("", said, category, self._hierarchy).roles
        except LabelError:  # two labels contradict each other about a kind that nobody brings in: the worse one counts
            leaks = tuple(statement for statement in said if statement.role == "leak")
            return role == "leak" and role in facts("", leaks, category, self._hierarchy).roles

    def _as_labels(self, names: Iterable[str], suffix: str) -> list[str]:
        return sorted({self._labels[up] + suffix for name in names for up in self._hierarchy.ancestors[name]})


def element_results(analysis: Analysis, bound: Bound, names: Names, roles: Roles) -> Iterator[tuple[Row, list[str]]]:
    """Return properties and category labels of each element, in the order of the graph."""
    found = analysis.spread
    questions = {question.element.shown_as: question for question in analysis.open}
    for vertex, element in enumerate(analysis.graph.elements):
        question = questions.get(element.shown_as)
        present = found.present(vertex)
        said = bound.elements.get(vertex, ())
        leaks, cleans = roles.of(said)
        labels = [
            *names.labels(present, ""),
            *names.labels(found.begins(vertex), "Source"),
            *roles.labels(said, names.exact(present)),
        ]
        labels = list(dict.fromkeys(labels))
        properties = {
            "carries": names.broad(present),
            "pseudonymised": names.broad(found.bits.planes(present)[1]),
            "begins": names.exact(found.begins(vertex)),
            "leaks": leaks,
            "sanitizes": cleans,
            "stops": names.exact(_stopped(found, found.keeps.get(vertex, found.all_bits))),
            "subjects": list(bound.subjects.get(vertex, ())),
            **type_properties(bound.types.get(vertex, ()), element.robot),
            **exposure_properties(bound.exposed.get(vertex, ())),
            **_surroundings(bound.surroundings.get(vertex), element),
            **_of_element(bound.processing.get(vertex, UNSTATED)),
            "open": list(question.categories) if question else [],
            "frontier": question.frontier if question else None,
            "distance": question.distance if question else None,
        }
        yield {**properties, "seal": seal_of(properties, labels)}, labels


def _surroundings(where: Surroundings | None, element: Element) -> Row:
    """Where it works; the country of an element outside ROS is a fact of its own."""
    of_system = {"country": where.country} if where and where.country and element.is_node else {}
    return {"context": list(where.contexts) or None if where else None, **of_system}


def _of_element(said: Processing) -> Row:
    """Only a robot has a controller and an officer."""
    return {key: value for key, value in processing_properties(said).items() if key not in ("controller", "dpo")}


def _stopped(found: Spread, kept: int) -> int:
    """Kinds that go on neither as they are nor pseudonymised."""
    return found.all_bits & ~found.bits.in_both_forms(kept)


def flow_results(analysis: Analysis, names: Names) -> Iterator[Row]:
    """Return the properties of each allowed flow, in the order of the graph."""
    found = analysis.spread
    for index, some in enumerate(moving(analysis)):
        yield {
            "carries": names.broad(found.along(index)),
            "passes": names.exact(some.passed) or None,
            "begins": names.exact(some.begun) or None,
            "made": names.exact(some.made) or None,
            "stops": names.exact(_stopped(found, found.passing(index))) or None,
        }


def origin_rows(analysis: Analysis, ids: Sequence[str], robots: Sequence[str]) -> Iterator[Row]:
    """Return the rows of ``DERIVES_FROM``.

    Parameters
    ----------
    ids, robots
        By vertex.
    """
    for origin in origins(analysis.spread):
        properties = origin_properties(analysis, origin, robots[origin.maker])
        yield {"source": ids[origin.maker], "target": ids[origin.source], "properties": properties}


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


def finding_rows(
    analysis: Analysis,
    bound: Bound,
    vocabulary: Vocabulary,
    ids: Mapping[Element, str],
    robots: Mapping[Element, str],
    likeness: Likeness = NO_ROBOTS,
) -> tuple[list[Row], list[Row]]:
    """Return the rows of findings, and those of the elements that they go across.

    Parameters
    ----------
    likeness
        Which names are those of robots.
    """
    rows, across = [], []
    contexts = Contexts.of(analysis.graph, bound, vocabulary.categories)
    for finding in analysis.findings:
        pattern, across_robots = pattern_id(finding, likeness), likeness.across(finding)
        row, steps = finding_row(finding, pattern, vocabulary, ids, robots, contexts, across=across_robots)
        rows.append(row)
        across += steps
    return rows, across


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
            "special_from": turned.name if (turned := turned_special(finding, vocabulary.categories)) else None,
        },
    }
    return row, [{"source": key, "target": ids[element], "properties": step} for element, step in _steps(finding)]


def _steps(finding: Finding) -> Iterator[tuple[Element, Row]]:
    first = finding.steps[0] if finding.steps else None
    category = first.category if first else finding.category
    start = {"step": 0, "category": category, "pseudonymised": first.pseudonymised if first else finding.pseudonymised}
    yield finding.witness[0], start
    for number, step in enumerate(finding.steps, 1):
        place = step.grants[0].place if step.grants else None
        properties: Row = {"step": number, "category": step.category, "pseudonymised": step.pseudonymised}
        if place:
            properties |= {"file": place.file, "line": place.line}
        yield step.target, properties
