"""What is known when a user's ontology is read: the shipped kinds, those of files before, and what is wrong with it.

In: graphs and categories. Out: the same, together.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rdflib import Graph
    from rdflib.term import Node

    from rosprivacy.analysis.model import Category


class Problem(NamedTuple):
    """What is wrong with a subject, and what to do; with the property where one is meant."""

    subject: Node
    fault: str
    hint: str
    predicate: Node | None = None


@dataclass(frozen=True, slots=True)
class Known:
    """Kinds that are there.

    Attributes
    ----------
    graph
        All triples of the files.
    categories
        The kinds that these define.
    places
        IRIs of users' kinds -> where they are defined; what is shipped has none.
    """

    graph: Graph
    categories: tuple[Category, ...]
    places: Mapping[str, str] = field(default_factory=dict)

    def whence(self, iri: str) -> str:
        """Return where a kind comes from, to be said after its name."""
        return f" ({self.places[iri]})" if iri in self.places else ", which comes with the program"
