"""The hierarchy that a user's ontology states: parents that are there, and statements that are not followed (rule S7).

In: the triples of a file, and what was there before. Out: problems. Only ``skos:broader`` of the file's own kinds is
followed; what else speaks of the hierarchy is refused, for a kind that is narrower than it seems loses leaks.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import OWL, RDFS, SKOS, URIRef

from rosprivacy.analysis.errors import shown
from rosprivacy.ontology.known import Problem
from rosprivacy.ontology.turtle import RP

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rdflib import Graph
    from rdflib.term import Node

    from rosprivacy.ontology.known import Known

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


def unfollowed(graph: Graph, subjects: list[Node], known: Known) -> Iterator[Problem]:
    """Yield statements about kinds that are not this file's own, and those of the hierarchy that are not followed.

    Matches with other vocabularies are no statements of the hierarchy of kinds.
    """
    shipped = {s for s in known.graph.subjects() if isinstance(s, URIRef) and s in RP}
    earlier = {URIRef(iri) for iri in known.places}
    kinds = {*subjects, *(URIRef(category.iri) for category in known.categories)}
    for subject, predicate, other in graph:
        told = f"says {_written(predicate)} <{shown(str(other))}>, which is not followed"
        if subject in subjects and subject in shipped | earlier:
            continue  # it is there already, which is said elsewhere
        if subject in earlier:
            what, hint = f"is defined by another file{known.whence(str(subject))}", "say it there"
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


def parent_problems(graph: Graph, both: Graph, subjects: list[Node], known: Known) -> Iterator[Problem]:
    """Yield kinds whose parents are not there, lead nowhere, or to themselves."""
    ours = {URIRef(iri) for c in known.categories for iri in (c.iri, *c.same_as)}
    there = ours | set(subjects)
    for subject in subjects:
        parents = set(graph.objects(subject, SKOS.broader))
        unknown = sorted(str(up) for up in parents - there if (up, RP.inVersion, None) not in both)
        for iri in unknown:
            hint = "name a category of rosprivacy categories, or your own"
            yield Problem(subject, f"has the unknown parent <{shown(iri)}>", hint)
        if not parents & there and not unknown:
            yield Problem(subject, "has no parent among the categories", BELOW)
        if _climbs_to_itself(graph, subject):
            yield Problem(subject, "is broader than itself", "take one skos:broader of the circle away")
        elif not unknown and not any(up in ours for up in both.transitive_objects(subject, SKOS.broader)):
            yield Problem(subject, "leads to none of the shipped categories", BELOW)


def _climbs_to_itself(graph: Graph, subject: Node) -> bool:
    return any(subject in graph.transitive_objects(up, SKOS.broader) for up in graph.objects(subject, SKOS.broader))
