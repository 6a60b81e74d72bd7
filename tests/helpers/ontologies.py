"""The files of the ontology as a graph, for tests that look at them without ``ontology/vocabulary.py``."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from rdflib import RDF, SH, SKOS, Graph, Literal, Namespace, URIRef

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rdflib.term import Node

FOLDER = ROOT / "ontology"
SHIPPED = ("categories", "law", "other_law", "contexts", "persons", "elements", "dpv")
RP = Namespace("https://w3id.org/rosprivacy#")


@cache
def ontology() -> Graph:
    graph = Graph()
    for name in SHIPPED:
        graph.parse(FOLDER / f"{name}.ttl")
    return graph


@cache
def shapes(*, strict: bool = False) -> Graph:
    """The shapes; strict as for the files that come with the program."""
    graph = Graph().parse(FOLDER / "shapes.ttl")
    if strict:
        graph.add((RP.ShippedCategoryShape, SH.targetClass, SKOS.Concept))
        graph.add((RP.ShippedProvisionShape, SH.targetClass, RP.LegalProvision))
    return graph


def categories() -> list[Node]:
    """Ours, sorted."""
    return sorted(ontology().subjects(RDF.type, SKOS.Concept), key=str)


def provisions() -> list[Node]:
    """Of the law, sorted."""
    return sorted(ontology().subjects(RDF.type, RP.LegalProvision), key=str)


def described(graph: Graph, subject: Node) -> Iterator[tuple[Node, Node, Node]]:
    """All that is said of a subject, with the blank nodes below it."""
    for triple in graph.triples((subject, None, None)):
        yield triple
        if not isinstance(triple[2], (URIRef, Literal)):
            yield from described(graph, triple[2])
