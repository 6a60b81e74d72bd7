"""Linked data as tests read it: by a strict parser, against the shapes of exported files, by the page's questions."""

from __future__ import annotations

import re
from functools import cache

import pyoxigraph
import pyshacl
from rdflib import Graph

from tests.helpers.paths import ROOT

PAGE, MORE = ROOT / "docs" / "linked-data.md", ROOT / "tests" / "report" / "rdf" / "more_questions.md"
QUESTION = re.compile(r"(```sparql\n(.*?)```\n)\n(?:\|[^\n]*\n)*\n?", re.DOTALL)
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


def questions() -> list[str]:
    """The SPARQL questions of the page and those that stand with its test, in order."""
    return [query for file in (PAGE, MORE) for _, query in QUESTION.findall(file.read_text("utf-8"))]


def answered(graph: Graph, query: str) -> list[tuple[str, ...]]:
    """The rows of an answer as texts; what is not bound is empty."""
    return [tuple("" if value is None else str(value) for value in row) for row in graph.query(query)]  # type: ignore[union-attr]
