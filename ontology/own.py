"""Users' own ontologies: read, checked against the shapes and against ours, each problem named with its subject.

In: a Turtle file and our graph. Out: its categories, to be put beside ours. Heavy: rdflib and pyshacl.
"""

from __future__ import annotations

import re
from importlib.resources import files
from typing import TYPE_CHECKING

from rdflib import RDF, SH, SKOS, Graph, URIRef

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.ontology.turtle import RP, categories_of, local_name, read

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rdflib.term import Node

    from rosprivacy.analysis.model import Category

SHAPES = "shapes.ttl"
BELOW = "add skos:broader rp:PersonalData or a narrower one"


def own_categories(data: bytes, file: str, ours: Graph, known: Iterable[Category]) -> tuple[Category, ...]:
    """Return the categories of a user's ontology.

    Parameters
    ----------
    data
        What stands in the file.
    ours
        The shipped graph; it is not changed.
    known
        Categories that are there already: the shipped ones, and those of files before.

    Raises
    ------
    InputErrors
        With every problem: Turtle, a shape that is broken, a parent that is not there, a cycle, a name that is taken.
    """
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputErrors([OntologyError(file, line, "not UTF-8", "save it as UTF-8")]) from None
    graph = read(text, file)
    subjects = sorted(set(graph.subjects(RDF.type, SKOS.Concept)), key=str)
    if not subjects:
        hint = "write each as: :Name a skos:Concept ; rp:label …"
        raise InputErrors([OntologyError(file, 0, "has no category", hint)])
    known = list(known)
    both = ours + graph
    where = {subject: _line(text, str(subject)) for subject in subjects}

    def problem(subject: Node, what: str, hint: str) -> OntologyError:
        return OntologyError(file, where.get(subject, 0), f"<{shown(str(subject))}> {what}", hint)

    problems = [problem(s, what, hint) for s, what, hint in _taken(graph, subjects, known)]
    problems += [problem(s, what, hint) for s, what, hint in _parents(graph, both, subjects, known)]
    problems += [problem(s, what, hint) for s, what, hint in _shape_problems(graph, ours, set(subjects))]
    if problems:
        raise InputErrors(problems)
    return categories_of(both, subjects)


Problem = tuple["Node", str, str]


def _taken(graph: Graph, subjects: list[Node], known: list[Category]) -> Iterator[Problem]:
    """Subjects that are ours, and names and labels that are taken: they would stand for two things."""
    iris = {category.iri for category in known}
    used = {spelling: c.iri for c in known for spelling in (c.name, c.label)}
    for subject in subjects:
        if not isinstance(subject, URIRef):
            yield subject, "has no IRI of its own", "name it, such as <urn:example:Badge>"
            continue
        if str(subject) in iris:
            yield subject, "is there already", "what is there is not changed: make one of your own below it"
            continue
        labels = {str(label) for label in graph.objects(subject, RP.label)}
        for name in sorted(labels | {local_name(str(subject))}):
            if used.setdefault(name, str(subject)) != str(subject):
                yield subject, f"and <{used[name]}> have the name or label {shown(name)!r}", "rename one"


def _parents(graph: Graph, both: Graph, subjects: list[Node], known: list[Category]) -> Iterator[Problem]:
    there = {URIRef(c.iri) for c in known} | {URIRef(iri) for c in known for iri in c.same_as} | set(subjects)
    ours = {URIRef(c.iri) for c in known}
    for subject in subjects:
        parents = set(graph.objects(subject, SKOS.broader))
        unknown = sorted(str(up) for up in parents - there if (up, RP.inVersion, None) not in both)
        for iri in unknown:
            yield (
                subject,
                f"has the unknown parent <{shown(iri)}>",
                "name a category of rosprivacy categories, or your own",
            )
        if not parents & there and not unknown:
            yield subject, "has no parent among the categories", BELOW
        if _climbs_to_itself(graph, subject):
            yield subject, "is broader than itself", "take one skos:broader of the circle away"
        elif not unknown and not _climbs_to(both, subject, ours | {URIRef(i) for c in known for i in c.same_as}):
            yield (
                subject,
                "leads to none of the shipped categories",
                "add skos:broader rp:PersonalData or a narrower one",
            )


def _climbs_to_itself(graph: Graph, subject: Node) -> bool:
    return any(subject in graph.transitive_objects(up, SKOS.broader) for up in graph.objects(subject, SKOS.broader))


def _climbs_to(both: Graph, subject: Node, ends: set[URIRef]) -> bool:
    return any(up in ends for up in both.transitive_objects(subject, SKOS.broader))


def _shape_problems(graph: Graph, ours: Graph, subjects: set[Node]) -> Iterator[Problem]:
    """What the shapes refuse, with their own words: 'what is wrong; what to do'.

    Of ours only the provisions are put beside the user's file: the shapes hold ours in tests, and parents and names
    are checked above.
    """
    import pyshacl  # noqa: PLC0415 - takes longer than all the rest

    shapes = Graph().parse(data=files("rosprivacy.ontology").joinpath(SHAPES).read_text("utf-8"), format="turtle")
    provisions = Graph()
    for provision in ours.subjects(RDF.type, RP.LegalProvision):
        for triple in ((provision, RDF.type, RP.LegalProvision), *ours.triples((provision, RP.partOf, None))):
            provisions.add(triple)
    _, report, _ = pyshacl.validate(graph + provisions, shacl_graph=shapes, advanced=True, inplace=False)
    found = set()
    for result in report.objects(None, SH.result):
        focus = report.value(result, SH.focusNode)
        if focus in subjects:
            what, _, hint = str(report.value(result, SH.resultMessage)).partition("; ")
            found.add((focus, what, hint or "see the shapes of the ontology"))
    yield from sorted(found, key=str)


def _line(text: str, iri: str) -> int:
    """The line where a subject is first written at the start of a statement; 0 if it cannot be told."""
    name = re.escape(local_name(iri))
    at_start = re.compile(rf"^\s*(?:[\w.-]*:{name}|<[^>\n]*{name}>)(?=[\s;,.]|$)", re.MULTILINE)
    match = at_start.search(text)
    return text.count("\n", 0, match.end()) + 1 if match else 0
