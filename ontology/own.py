"""Users' own ontologies: read, checked against the shapes and against ours, each problem named with its subject.

In: a Turtle file and what is known. Out: what is known with its categories. Heavy: rdflib and pyshacl (an extra).
"""

from __future__ import annotations

import logging
import re
import warnings
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import TYPE_CHECKING

from rdflib import OWL, RDF, RDFS, SH, SKOS, Graph, Literal, URIRef

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.ontology.iris import as_published, as_stored
from rosprivacy.ontology.known import Known, Problem
from rosprivacy.ontology.turtle import RP, categories_of, local_name, read

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rdflib.term import Node

    from rosprivacy.analysis.model import Category


_NOT_IN_IRIS = frozenset('<>" {}|\\^`')


@contextmanager
def silence() -> Iterator[None]:
    """Keep off standard error what rdflib logs and warns of: ``odd_terms`` finds the same, and says where."""
    logger, silent = logging.getLogger("rdflib.term"), logging.Filter("none")
    logger.addFilter(silent)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logger.removeFilter(silent)


def odd_terms(graph: Graph) -> Iterator[Problem]:
    """Yield what is wrong with the terms of a graph, by subject."""
    for _, namespace in graph.namespaces():
        if _is_odd(namespace):
            yield Problem(namespace, "is a prefix with a sign that no IRI has", "correct the IRI")
    for subject, predicate, value in sorted(graph, key=lambda triple: tuple(map(str, triple))):
        if _is_odd(subject):
            yield Problem(subject, "has a sign that no IRI has", "correct the IRI")
        for term in (predicate, value, getattr(value, "datatype", None)):
            if _is_odd(term):
                what = f"names <{shown(str(term))}>, which has a sign that no IRI has"
                yield Problem(subject, what, "correct the IRI", predicate)
        if isinstance(value, Literal) and value.ill_typed:
            kind = local_name(str(value.datatype))
            yield Problem(subject, f"says {shown(str(value))!r}, which is no {shown(kind)}", "correct it", predicate)


def _is_odd(term: Node | None) -> bool:
    if not isinstance(term, URIRef):
        return False
    return any(sign in _NOT_IN_IRIS or not sign.isprintable() for sign in term)


SHAPES = "shapes.ttl"


@silence()
def with_own(present: Known, data: bytes, file: str) -> Known:
    """Return what is known once a user's ontology is read too.

    Parameters
    ----------
    present
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
    both = present.graph + graph
    there = {URIRef(category.iri) for category in present.categories}
    fresh = [subject for subject in subjects if isinstance(subject, URIRef) and subject not in there]
    categories = categories_of(both, fresh)
    places = {**present.places, **{str(subject): f"{shown(file)}:{lines.of(subject)}" for subject in fresh}}
    problems = [
        *_unfit(subjects, there),
        *taken_names(categories, replace(present, places=places)),
        *parent_problems(graph, both, subjects, present),
        *unfollowed(graph, subjects, present),
        *_shape_problems(graph, present.graph, set(subjects)),
    ]
    if problems:
        raise InputErrors([_error(problem, file, lines) for problem in problems])
    return Known(both, (*present.categories, *categories), places)


def _decoded(data: bytes, file: str) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputErrors([OntologyError(file, line, "not UTF-8", "save it as UTF-8")]) from None


def _error(problem: Problem, file: str, lines: Lines) -> OntologyError:
    subject = problem.subject
    who = f"<{shown(str(subject))}>" if isinstance(subject, URIRef) else "[]"  # the name of a blank node is by chance
    what = as_published(f"{who} {problem.fault}")
    return OntologyError(file, lines.of(subject, problem.predicate), what, problem.hint)


def _unfit(subjects: list[Node], present: set[URIRef]) -> Iterator[Problem]:
    """Subjects that are no kind of this file's own."""
    for subject in subjects:
        if not isinstance(subject, URIRef):
            yield Problem(subject, "has no IRI of its own", "name it, such as <urn:example:Badge>")
        elif subject in present:
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


_END = re.compile(r"\.[ \t]*(?:#.*)?$", re.MULTILINE)  # of a statement


@dataclass(frozen=True, slots=True)
class Lines:
    """The lines of a Turtle text."""

    text: str
    graph: Graph

    def of(self, subject: Node, predicate: Node | None = None) -> int:
        """Return the line of a property of a subject; that of the subject where the property is not seen."""
        blocks = [match.end() for match in self._at_start(subject).finditer(self.text)]
        if predicate is not None:
            written = re.compile(rf"(?<![\w:.-])(?:{self._written(predicate)})(?=[\s<:]|$)", re.MULTILINE)
            for block in blocks:
                end = _END.search(self.text, block)
                if said := written.search(self.text, block, end.end() if end else len(self.text)):
                    return self._line(said.start())
        return self._line(blocks[0]) if blocks else 0

    def _at_start(self, subject: Node) -> re.Pattern[str]:
        return re.compile(rf"^[ \t]*(?:{self._written(subject)})(?=[\s;,.]|$)", re.MULTILINE)

    def _written(self, node: Node) -> str:
        """How an IRI may be written: whole, with a prefix, or relative to a base."""
        iri = str(node)
        prefixed = [f"{prefix}:{iri[len(ns) :]}" for prefix, ns in self.graph.namespaces() if iri.startswith(ns)]
        whole = [re.escape(name) for name in (f"<{iri}>", *prefixed)]
        return "|".join([*whole, rf"<[^<>\s:]*{re.escape(local_name(iri))}>"])

    def _line(self, position: int) -> int:
        return self.text.count("\n", 0, position) + 1


BELOW = "add skos:broader rp:PersonalData or a narrower one"
NOT_FOLLOWED = {
    SKOS.narrower: "skos:narrower",
    SKOS.narrowerTransitive: "skos:narrowerTransitive",
    SKOS.broaderTransitive: "skos:broaderTransitive",
    RDFS.subClassOf: "rdfs:subClassOf",
}
MATCHES = {
    SKOS.broadMatch: "skos:broadMatch",
    SKOS.narrowMatch: "skos:narrowMatch",
    SKOS.exactMatch: "skos:exactMatch",
    SKOS.closeMatch: "skos:closeMatch",
    OWL.sameAs: "owl:sameAs",
    OWL.equivalentClass: "owl:equivalentClass",
}


def unfollowed(graph: Graph, subjects: list[Node], present: Known) -> Iterator[Problem]:
    """Yield statements about kinds that are not this file's own, and those of the hierarchy that are not followed.

    Matches with other vocabularies are no statements of the hierarchy of kinds.
    """
    shipped = {s for s in present.graph.subjects() if isinstance(s, URIRef) and s in RP}
    earlier = {URIRef(iri) for iri in present.places}
    kinds = {*subjects, *(URIRef(category.iri) for category in present.categories)}
    for subject, predicate, other in graph:
        told = f"says {_written(predicate)} <{shown(str(other))}>, which is not followed"
        if subject in subjects and subject in shipped | earlier:
            continue  # it is there already, which is said elsewhere
        if subject in earlier:
            what, hint = f"is defined by another file{present.whence(str(subject))}", "say it there"
        elif subject in shipped:
            what = "comes with the program and cannot be changed"
            hint = "take the statement away; only a kind of your own can have a skos:broader"
        elif predicate in NOT_FOLLOWED and {subject, other} & kinds:
            what, hint = told, "write skos:broader on the narrower kind"
        elif predicate in MATCHES and other in kinds:
            what, hint = told, "write skos:broader, on the narrower of the two kinds"
        elif predicate == SKOS.broader and subject not in subjects:
            what, hint = told, "write it of a kind of this file, which is a skos:Concept"
        else:
            continue
        yield Problem(subject, what, hint, predicate)


def _written(predicate: Node) -> str:
    return {**NOT_FOLLOWED, **MATCHES}.get(URIRef(str(predicate)), "skos:broader")


def parent_problems(graph: Graph, merged: Graph, subjects: list[Node], present: Known) -> Iterator[Problem]:
    """Yield kinds whose parents are not there, lead nowhere, or to themselves."""
    ours = {URIRef(iri) for c in present.categories for iri in (c.iri, *c.same_as)}
    there = ours | set(subjects)
    for subject in subjects:
        parents = set(graph.objects(subject, SKOS.broader))
        unknown = sorted(str(up) for up in parents - there if (up, RP.inVersion, None) not in merged)
        for iri in unknown:
            hint = "name a category of rosprivacy categories, or your own"
            yield Problem(subject, f"has the unknown parent <{shown(iri)}>", hint)
        if not parents & there and not unknown:
            yield Problem(subject, "has no parent among the categories", BELOW)
        if _climbs_to_itself(graph, subject):
            yield Problem(subject, "is broader than itself", "take one skos:broader of the circle away")
        elif not unknown and not any(up in ours for up in merged.transitive_objects(subject, SKOS.broader)):
            yield Problem(subject, "leads to none of the shipped categories", BELOW)


def _climbs_to_itself(graph: Graph, subject: Node) -> bool:
    return any(subject in graph.transitive_objects(up, SKOS.broader) for up in graph.objects(subject, SKOS.broader))


def taken_names(categories: Iterable[Category], present: Known) -> Iterator[Problem]:
    """Yield each name that another kind has: of any sort and language, in upper or lower case.

    Parameters
    ----------
    categories
        Of the user's file, sorted by IRI.
    present
        What was there before, with the places of these categories too.
    """
    categories = list(categories)
    kinds = {category.iri for category in (*present.categories, *categories)}
    used = {name.casefold(): c.iri for c in present.categories for name in (*c.names, *c.same_as)}
    for category in categories:
        matches = [iri for iri in category.same_as if iri not in kinds]  # a kind is no match: own_hierarchy.py
        for name in {name.casefold(): name for name in (*matches, *reversed(category.names))}.values():
            other = used.setdefault(name.casefold(), category.iri)
            if other != category.iri:
                what, hint = _already_taken(name, is_match=name in matches)
                yield Problem(URIRef(category.iri), f"{what}, and so has <{shown(other)}>{present.whence(other)}", hint)


def _already_taken(name: str, *, is_match: bool) -> tuple[str, str]:
    if is_match:
        return f"has the exact match <{shown(name)}>", "write skos:broader with the other kind, or take it away"
    return f"has the name {shown(name)!r}", "take another name"
