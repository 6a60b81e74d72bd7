"""Linked data as tests read it: by a strict parser, and against the shapes of exported files."""

from __future__ import annotations

from functools import cache

import pyoxigraph
import pyshacl
from rdflib import Graph

from tests.helpers.paths import ROOT

SYNTAX = {"turtle": pyoxigraph.RdfFormat.TURTLE, "json-ld": pyoxigraph.RdfFormat.JSON_LD}


@cache
def shapes() -> Graph:
    return Graph().parse(ROOT / "report" / "rdf" / "findings.shapes.ttl")


def problems(graph: Graph) -> str:
    """What does not keep to the shapes, in words; empty if all does."""
    conforms, _, text = pyshacl.validate(graph, shacl_graph=shapes())
    return "" if conforms else str(text)


def strict(text: str | bytes, form: str) -> Graph:
    """Read by a parser that allows nothing that the standard does not."""
    triples = pyoxigraph.parse(text.encode() if isinstance(text, str) else text, SYNTAX[form])
    lines = "".join(f"{quad.triple} .\n" for quad in triples)
    return Graph().parse(data=lines, format="nt")
