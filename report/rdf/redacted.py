"""Linked data that can be shown to others: names replaced as in a redacted report (see ``report/redact.py``).

In: a ``Document``. Out: its graph, where every IRI of the system and every text about it went through a rule that says
what may stay: ids, hashes, lines, kinds of data, the law, countries, roles, periods. A name is replaced by what stands
for it in the report; any other text is left out. What an ontology says stays as it is.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote, unquote

from rdflib import RDFS, Graph, Literal, URIRef
from rdflib.namespace import PROV

from rosprivacy.analysis.errors import shown
from rosprivacy.ontology.turtle import local_name
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.rdf.findings import rdf_graph
from rosprivacy.report.rdf.terms import DPV, RP, names_of, text
from rosprivacy.report.redact import LEFT_OUT, OURS, redacted, replacements

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from datetime import datetime

    from rdflib.term import Node

    from rosprivacy.report.document.contents import Document

    Change = Callable[[str, str], str]

ELEMENT = "element"  # robot, kind and name of an element, as IRIs have them
# Kind of an individual -> what the parts of its IRI are; '' is none of the names.
PARTS = {
    "element": (ELEMENT,), "recipient": (ELEMENT,), "storage-duration": (ELEMENT,),
    "line": ("file", "", "enclave", "node"), "file": ("", "file"),
    "controller": ("controller",), "officer": ("officer",), "subject": ("persons",), "purpose": ("purpose",),
}  # fmt: skip
NAMELESS = ("finding", "process", "row", "run", "analysis", "tool", "country")  # ids, hashes, versions, numbers
SAFE_PREDICATES = {
    RP.id, RP.kind, RP.leg, RP.by, RP.outcome, RP.view, RP.severity, RP.sha256, RP.readAs, RP.version, RP.verdict,
    RP.condition, RP.context, RP.country, RP.operatorRole, RP.transferBasis, RP.encrypted, RP.retention,
    RP.statedLegalBasis, RP.statedSafeguard, RP.notStated, RP.toComplete, RP.state, RP.area, RP.article9, RP.method,
    RP.sourceCountry, RDFS.comment, DPV.hasDuration, PROV.generatedAtTime, PROV.endedAtTime,
}  # fmt: skip
NAME_PREDICATES = {
    RP.robot: "robot", RP.onRobot: "robot", RP.file: "file", RP.enclave: "enclave", RP.profile: "node",
    RP.operator: "operator", RP.aboutPersons: "persons",
}  # fmt: skip


def redacted_graph(document: Document, when: datetime | None = None, base: str | None = None) -> Graph:
    """Return the graph of ``rdf_graph`` without names; the parameters are the same, and so are the ids in it.

    Raises
    ------
    InputError
        If the base is none.
    """
    entries, whole = (
        json_document(document),
        rdf_graph(document, when),
    )  # no term of others begins with the base by default
    (copy,), names = redacted([entries]), replacements([entries])
    bases = names_of(entries).base, names_of(entries, base).base
    seen = _Redaction(whole, *bases, copy["assumptions"], names.see)
    for triple in whole:
        seen.triple(*triple)
    names.settle()
    changed = _Redaction(whole, *bases, copy["assumptions"], names.replaced)
    graph = Graph(bind_namespaces="none")
    for prefix, namespace in whole.namespaces():
        graph.bind(prefix, namespace)
    for triple in whole:
        graph.add(changed.triple(*triple))
    return graph


@dataclass(frozen=True, slots=True)
class _Redaction:
    """How triples are changed.

    Attributes
    ----------
    whole
        The graph with its names.
    base, new_base
        What IRIs of the system begin with: in that graph, and in its copy.
    assumptions
        Of the redacted document.
    change
        (kind, name) -> what stands for it.
    """

    whole: Graph
    base: str
    new_base: str
    assumptions: Mapping[str, Any]
    change: Change

    def triple(self, subject: Node, predicate: Node, value: Node) -> tuple[Node, Node, Node]:
        """Return a triple without names."""
        if isinstance(value, Literal) and isinstance(subject, URIRef) and self._of_the_system(subject):
            return self._iri(subject), predicate, self._literal(subject, predicate, value)
        return self._iri(subject), predicate, self._iri(value)

    def _of_the_system(self, iri: URIRef) -> bool:
        return iri.startswith(self.base)

    def _iri(self, term: Node) -> Node:
        if not isinstance(term, URIRef) or not self._of_the_system(term):
            return term
        name = term.removeprefix(self.base)
        kind, *parts = name.split(":")
        if kind in NAMELESS:
            return URIRef(self.new_base + name)
        given = [unquote(part, errors="surrogatepass") for part in parts]
        return URIRef(self.new_base + ":".join([kind, *(quote(part, safe="/") for part in self._parts(kind, given))]))

    def _parts(self, kind: str, parts: list[str]) -> list[str]:
        if kind not in PARTS:
            return [self.change("thing", part) for part in parts]
        if PARTS[kind] == (ELEMENT,):
            robot, of, name, *more = parts
            return [self._value("robot", robot), of, self._value(of, name), *more]
        return [self._value(what, part) for what, part in zip(PARTS[kind], parts, strict=True)]

    def _value(self, kind: str, name: str) -> str:
        return name if not (kind and name) or (kind == "file" and name.startswith(OURS)) else self.change(kind, name)

    def _literal(self, subject: URIRef, predicate: Node, value: Literal) -> Literal:
        if predicate == RDFS.label:
            return Literal(self._label(subject, value), lang=value.language)
        if predicate in SAFE_PREDICATES or value.datatype is not None:  # a number, a date or a duration names nobody
            return value
        if predicate in NAME_PREDICATES:
            return text(self._value(NAME_PREDICATES[predicate], str(value)))  # type: ignore[index]
        if predicate == RP.name:
            return value if (subject, RP.value, None) in self.whole else text(self._replacement(subject))
        return self._assumed(str(self.whole.value(subject, RP.name))) if predicate == RP.value else text(LEFT_OUT)

    def _replacement(self, element: Node | None) -> str:
        """What stands for the name of an element."""
        kind, name = self.whole.value(element, RP.kind), self.whole.value(element, RP.name)
        return self._value(str(kind), str(name))

    def _assumed(self, name: str) -> Literal:
        value = self.assumptions[name]
        return text(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, sort_keys=True))

    def _label(self, subject: URIRef, label: Literal) -> str:
        """What a thing is called, with other names: findings and processes by their ends, others by where they are."""
        kind, *parts = subject.removeprefix(self.base).split(":")
        at = self.whole.value(subject, RP.at)
        if at is not None:
            return self._label_at(kind, at, str(label))
        if kind == "finding" or (kind == "process" and len(parts) == 1):
            finding = URIRef(f"{self.base}finding:{parts[0]}")
            source, leak = (self._replacement(self.whole.value(finding, end)) for end in (RP.dataSource, RP.leak))
            ends = f"{local_name(str(self.whole.value(finding, RP.category)))}: {source} -> {leak}"
            return ends if kind == "finding" else f"possible: {ends}"
        if kind == "row" and len(parts) == 1:
            places = sorted({self._replacement(place) for place in self.whole.objects(subject, RP.place)})
            return " -> ".join([f"possible: {local_name(str(self.whole.value(subject, RP.category)))}", *places[:1]])
        if kind in ("controller", "officer", "subject"):
            return unquote(str(self._iri(subject)).rpartition(":")[2])
        return str(label) if kind in ("tool", "process", "row") else LEFT_OUT  # its data, how long they are kept

    def _label_at(self, kind: str, at: Node, label: str) -> str:
        name, alias = shown(str(self.whole.value(at, RP.name))), self._replacement(at)
        if kind == "storage-duration":
            return alias + label.removeprefix(name) if label.startswith(f"{name} ") else LEFT_OUT
        if kind in ("process", "row"):
            return f"{label.partition(' ')[0]} at {alias}"  # what is done there
        operator = self.whole.value(at, RP.operator)
        return self._value("operator", str(operator)) if operator else f"whoever receives what {alias} lets out"
