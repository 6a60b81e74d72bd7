"""RDF -> Turtle or JSON-LD: the same bytes for the same graph, whatever the order in which it was made (rule S14).

In: an rdflib graph whose only nameless nodes are the cells of lists. Out: text that ends with a newline. Characters
that cannot be printed, those that turn the direction of writing among them, are written as escapes.
"""

from __future__ import annotations

import json
import re
from io import BytesIO
from typing import TYPE_CHECKING, Any

from rdflib import RDF, XSD, Literal, URIRef
from rdflib.plugins.serializers.turtle import TurtleSerializer

from rosprivacy.report.json_text import as_text
from rosprivacy.report.rdf.terms import DPV, RP

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

_ODD = re.compile(r"[^\x20-\x7e\n]")
_PLAIN = (XSD.integer, XSD.boolean)


class _Turtle(TurtleSerializer):
    """Writes every text on one line.

    rdflib puts text with a line break between three quotation marks and leaves one at its end as it is after a
    backslash; other parsers refuse that.
    """

    def orderSubjects(self) -> list[Node]:  # noqa: N802 - rdflib's name
        """The answer first, then findings, what they are about, and what they consist of, by IRI."""
        first = [set(self.store.subjects(RDF.type, kind)) for kind in (RP.Analysis, RP.Finding, DPV.Process)]
        named = [subject for subject in self._subjects if isinstance(subject, URIRef)]
        return sorted(named, key=lambda subject: (*(subject not in kind for kind in first), str(subject)))

    def label(self, node: Node, position: int) -> str:
        if not isinstance(node, Literal) or node.datatype in _PLAIN:
            return str(super().label(node, position))
        quoted = json.dumps(str(node), ensure_ascii=False)  # the escapes of JSON are escapes of Turtle
        if node.language:
            return f"{quoted}@{node.language}"
        return f"{quoted}^^{super().label(node.datatype, position)}" if node.datatype else quoted


def as_turtle(graph: Graph) -> str:
    """Return a graph as Turtle."""
    stream = BytesIO()
    _Turtle(graph).serialize(stream, encoding="utf-8")
    return _ODD.sub(_printable, stream.getvalue().decode().strip("\n")) + "\n"


def as_json_ld(graph: Graph) -> str:
    """Return a graph as JSON-LD, with its context inside."""
    context = {prefix: str(namespace) for prefix, namespace in sorted(graph.namespaces())}
    value = _sorted(json.loads(graph.serialize(format="json-ld", context=context)))
    value["@graph"].sort(key=lambda node: node["@id"])
    return as_text(value)


SERIALISERS = {"turtle": as_turtle, "json-ld": as_json_ld}


def _sorted(value: Any) -> Any:
    """Sort keys, and lists but those whose order means something."""
    if isinstance(value, dict):
        return {
            key: [_sorted(item) for item in inner] if key == "@list" else _sorted(inner)
            for key, inner in sorted(value.items())
        }
    if isinstance(value, list):
        return sorted((_sorted(item) for item in value), key=lambda item: json.dumps(item, sort_keys=True))
    return value


def _printable(match: re.Match[str]) -> str:
    number, short = ord(match[0]), 0xFFFF
    if match[0].isprintable():
        return match[0]
    return f"\\u{number:04X}" if number <= short else f"\\U{number:08X}"
