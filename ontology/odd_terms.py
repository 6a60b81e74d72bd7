"""IRIs and values in a user's ontology that are none: refused with their line, since rdflib only logs them.

In: the graph of a file. Out: problems, one for each. An IRI may not have some signs (RFC 3987; Turtle's IRIREF), and a
value must be one of its type (RDF 1.1 Concepts, 3.3: else it is ill-typed).
"""

from __future__ import annotations

import logging
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rdflib import Literal, URIRef

from rosprivacy.analysis.errors import shown
from rosprivacy.ontology.known import Problem
from rosprivacy.ontology.turtle import local_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rdflib import Graph
    from rdflib.term import Node

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
