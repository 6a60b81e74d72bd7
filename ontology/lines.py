"""Where a Turtle text says something: the line of a subject, or of one property of it.

In: the text and its graph, which knows the prefixes. Out: line numbers; 0 where none can be told.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.ontology.turtle import local_name

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

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
