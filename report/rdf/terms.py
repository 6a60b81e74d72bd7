"""The words of linked data: namespaces, the DPV 2.3 terms that are used, names made into IRIs and texts into literals.

In: what people wrote. Out: IRIs and literals that any RDF parser takes, whatever a name holds.
"""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING
from urllib.parse import quote

from rdflib import RDF, XSD, BNode, Literal, Namespace, URIRef
from rdflib.namespace import ClosedNamespace

from rosprivacy.analysis.text import utf8

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rdflib.term import Node

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Grant

Triple = tuple["Node", "Node", "Node"]

OWN = "urn:x-rosprivacy:"
RP = Namespace(OWN)

DPV_CLASSES = (
    "Country",
    "CrossBorderTransfer",
    "DataController",
    "DataProcessor",
    "DataSource",
    "DataSubject",
    "Derive",
    "Disclose",
    "JointDataControllers",
    "Process",
    "Pseudonymisation",
    "PseudonymisedData",
    "Recipient",
    "Store",
    "StorageDuration",
    "ThirdCountry",
    "ThirdParty",
    "Transfer",
)
DPV_PROPERTIES = (
    "hasCountry",
    "hasDataSource",
    "hasDataSubject",
    "hasDuration",
    "hasLegalBasis",
    "hasPersonalData",
    "hasProcessing",
    "hasRecipient",
    "hasRisk",
    "hasStorageCondition",
    "hasTechnicalMeasure",
)
# Legal bases as the extension for the GDPR has them: Articles 6(1), 9(2), 45, 46(2) and 49(1).
BASES = (
    *(f"A6-1-{letter}" for letter in "abcdef"),
    *(f"A9-2-{letter}" for letter in "abcdefghij"),
    "A45-3",
    *(f"A46-2-{letter}" for letter in "abcdef"),
    *(f"A49-1-{letter}" for letter in "abcdefg"),
)
RISKS = ("DataRisk", "Reidentification", "UnwantedDisclosureData")
# Closed: a term that is not listed is an AttributeError, and a test holds the lists against the files of DPV 2.3.
DPV = ClosedNamespace("https://w3id.org/dpv#", [*DPV_CLASSES, *DPV_PROPERTIES])
EU_GDPR = ClosedNamespace("https://w3id.org/dpv/legal/eu/gdpr#", list(BASES))
RISK = ClosedNamespace("https://w3id.org/dpv/risk#", list(RISKS))

LONGEST = 500  # characters of a name in an IRI; a longer one stands there as its hash; `=` is never left in a name
_DURATION = re.compile(r"-?P(?=.)(\d+Y)?(\d+M)?(\d+D)?(T(?=.)(\d+H)?(\d+M)?(\d+(\.\d+)?S)?)?", re.ASCII)
_NOT_IN_IRIS = re.compile(r'[\x00-\x20<>"{}|\\^`\x7f-\x9f]')


def named(kind: str, *parts: object) -> URIRef:
    """Return the IRI of a thing of ours: percent-encoded, so that no name can leave it, the same for no two.

    >>> named("element", "", "node", "/a> . <b")
    rdflib.term.URIRef('urn:x-rosprivacy:element::node:/a%3E%20.%20%3Cb')
    """
    return URIRef(OWN + ":".join([kind, *(_encoded(str(part)) for part in parts)]))


def below(parent: URIRef, *parts: object) -> URIRef:
    """Return the IRI of a part of a thing of ours."""
    return URIRef(":".join([str(parent), *(_encoded(str(part)) for part in parts)]))


def foreign(iri: str) -> URIRef:
    """Return an IRI that an ontology names; what may not stand in one is percent-encoded."""
    return URIRef(_NOT_IN_IRIS.sub(lambda match: quote(match[0]), iri))


def text(value: str, language: str | None = None) -> Literal:
    """Return a literal; what UTF-8 cannot say (a file name that is none) is escaped."""
    return Literal(utf8(value), lang=language)


def element_iri(element: Element) -> URIRef:
    """Return the IRI of an element as a reader sees it: the two sides of a wildcard are one."""
    return named("element", *element.identity, *([element.leg] if element.leg else []))


def finding_iri(finding: Finding) -> URIRef:
    """Return the IRI of a finding, made from its stable id (rule S10)."""
    return named("finding", finding.id)


def line_iri(grant: Grant) -> URIRef:
    """Return the IRI of a policy line as it applies to a profile."""
    return named("line", grant.place.file, grant.place.line, grant.enclave, grant.node)


def file_iri(file: str, sha256: str) -> URIRef:
    """Return the IRI of a file that was read; another content is another file."""
    return named("file", sha256, file)


def legal_basis(article: str) -> list[URIRef]:
    """Return the term for a legal basis as decisions state it, none where DPV has none.

    >>> legal_basis("46(2)(c)"), legal_basis("10")
    ([rdflib.term.URIRef('https://w3id.org/dpv/legal/eu/gdpr#A46-2-c')], [])
    """
    name = "A45-3" if article == "45" else "A" + article.replace(")(", "-").replace("(", "-").replace(")", "")
    return [EU_GDPR[name]] if name in BASES else []


def duration(value: str) -> Literal:
    """Return how long data is kept: typed where XML Schema knows the form (it has no weeks), else as it was written."""
    return Literal(value, datatype=XSD.duration, normalize=False) if _DURATION.fullmatch(value) else text(value)


def about(subject: Node, *said: tuple[Node, Iterable[Node]]) -> list[Triple]:
    """Return what is said of a subject: one triple for each value of each predicate."""
    return [(subject, predicate, value) for predicate, values in said for value in values]


def listed(items: Sequence[Node]) -> tuple[Node, list[Triple]]:
    """Return an RDF list and its triples; its cells have no names, and are written as ``( … )`` or ``@list``."""
    cells: list[Node] = [*(BNode() for _ in items), RDF.nil]
    triples: list[Triple] = []
    for cell, item, rest in zip(cells, items, cells[1:], strict=False):
        triples += [(cell, RDF.first, item), (cell, RDF.rest, rest)]
    return cells[0], triples


def _encoded(name: str) -> str:
    data = name.encode("utf-8", "surrogatepass")
    encoded = quote(data, safe="/")
    return encoded if len(encoded) <= LONGEST else f"sha256={hashlib.sha256(data).hexdigest()}"
