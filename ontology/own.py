"""Users' own ontologies: read, checked against the shapes and against ours, each problem named with its subject.

In: a Turtle file and what is known. Out: what is known with its categories. Heavy: rdflib and pyshacl.
"""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from typing import TYPE_CHECKING

from rdflib import RDF, SH, SKOS, Graph, URIRef

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.ontology.iris import as_published, as_stored
from rosprivacy.ontology.known import Known, Problem
from rosprivacy.ontology.lines import Lines
from rosprivacy.ontology.odd_terms import odd_terms, silence
from rosprivacy.ontology.own_hierarchy import parent_problems, unfollowed
from rosprivacy.ontology.own_names import taken_names
from rosprivacy.ontology.turtle import RP, categories_of, read

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rdflib.term import Node

SHAPES = "shapes.ttl"


@silence()
def with_own(known: Known, data: bytes, file: str) -> Known:
    """Return what is known once a user's ontology is read too.

    Parameters
    ----------
    known
        What is there before: the shipped ontology, and files before this one.
    data
        What stands in the file.

    Raises
    ------
    InputErrors
        With every problem: Turtle, IRIs and values that are none, a shape that is broken, a parent that is not there, a
        cycle, a name that is taken, a statement of the hierarchy that is not followed.
    """
    text = _decoded(data, file)
    graph = read(text, file)
    subjects = sorted(set(graph.subjects(RDF.type, SKOS.Concept)), key=str)
    if not subjects:
        hint = "write each as: :Name a skos:Concept ; rp:label …"
        raise InputErrors([OntologyError(file, 0, "has no category", hint)])
    lines = Lines(as_stored(text), graph)
    if odd := list(odd_terms(graph)):
        raise InputErrors([_error(problem, file, lines) for problem in odd])
    both = known.graph + graph
    there = {URIRef(category.iri) for category in known.categories}
    fresh = [subject for subject in subjects if isinstance(subject, URIRef) and subject not in there]
    categories = categories_of(both, fresh)
    places = {**known.places, **{str(subject): f"{shown(file)}:{lines.of(subject)}" for subject in fresh}}
    problems = [
        *_unfit(subjects, there),
        *taken_names(categories, replace(known, places=places)),
        *parent_problems(graph, both, subjects, known),
        *unfollowed(graph, subjects, known),
        *_shape_problems(graph, known.graph, set(subjects)),
    ]
    if problems:
        raise InputErrors([_error(problem, file, lines) for problem in problems])
    return Known(both, (*known.categories, *categories), places)


def _decoded(data: bytes, file: str) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputErrors([OntologyError(file, line, "not UTF-8", "save it as UTF-8")]) from None


def _error(problem: Problem, file: str, lines: Lines) -> OntologyError:
    subject = problem.subject
    who = f"<{shown(str(subject))}>" if isinstance(subject, URIRef) else "[]"  # the name of a blank node is by chance
    what = as_published(f"{who} {problem.what}")
    return OntologyError(file, lines.of(subject, problem.predicate), what, problem.hint)


def _unfit(subjects: list[Node], there: set[URIRef]) -> Iterator[Problem]:
    """Subjects that are no kind of this file's own."""
    for subject in subjects:
        if not isinstance(subject, URIRef):
            yield Problem(subject, "has no IRI of its own", "name it, such as <urn:example:Badge>")
        elif subject in there:
            hint = "what is there is not changed: make one of your own below it"
            yield Problem(subject, "is there already", hint)


def _shape_problems(graph: Graph, ours: Graph, subjects: set[Node]) -> Iterator[Problem]:
    """What the shapes refuse, with their own words: 'what is wrong; what to do'.

    Of ours only the provisions, and what contexts reveal, are put beside the user's file: the shapes hold ours in
    tests, and parents and names are checked above.
    """
    import pyshacl  # noqa: PLC0415 - takes longer than all the rest

    shapes = read(files("rosprivacy.ontology").joinpath(SHAPES).read_text("utf-8"), SHAPES)
    provisions = Graph()
    for provision in ours.subjects(RDF.type, RP.LegalProvision):
        for triple in ((provision, RDF.type, RP.LegalProvision), *ours.triples((provision, RP.partOf, None))):
            provisions.add(triple)
    for context in ours.subjects(RDF.type, RP.Context):
        provisions.add((context, RDF.type, RP.Context))
    for sharpening in ours.subjects(RDF.type, RP.Sharpening):
        for predicate in (RP.context, RP.provision, RP.verdict, RP.condition):
            provisions += ours.triples((sharpening, predicate, None))
    _, report, _ = pyshacl.validate(graph + provisions, shacl_graph=shapes, advanced=True, inplace=False)
    found = set()
    for result in report.objects(None, SH.result):
        focus = report.value(result, SH.focusNode)
        if focus in subjects:
            what, _, hint = str(report.value(result, SH.resultMessage)).partition("; ")
            found.add(Problem(focus, what, hint or "see the shapes of the ontology"))
    yield from sorted(found, key=str)
