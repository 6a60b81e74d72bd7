"""The words of linked data: namespaces, the DPV 2.3 terms that are used, texts made into literals.

In: what people wrote. Out: terms and literals that any RDF parser takes, whatever a text holds.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rdflib import RDF, XSD, BNode, Literal, Namespace
from rdflib.namespace import ClosedNamespace

from rosprivacy.analysis.text import utf8
from rosprivacy.ontology.iris import PUBLISHED

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rdflib import URIRef
    from rdflib.term import Node

Triple = tuple["Node", "Node", "Node"]

RP = Namespace(PUBLISHED)

DPV_CLASSES = (
    "ActivityStatus",
    "Country",
    "CrossBorderTransfer",
    "DataController",
    "DataProcessor",
    "DataProtectionOfficer",
    "DataSource",
    "DataSubject",
    "Derive",
    "Disclose",
    "JointDataControllers",
    "PersonalData",
    "Process",
    "Pseudonymisation",
    "PseudonymisedData",
    "Purpose",
    "Recipient",
    "Store",
    "SpecialCategoryPersonalData",
    "StorageDuration",
    "ThirdCountry",
    "ThirdParty",
    "Transfer",
)
DPV_PROPERTIES = (
    "hasActivityStatus",
    "hasCountry",
    "hasDataController",
    "hasDataProtectionOfficer",
    "hasDataSource",
    "hasDataSubject",
    "hasDuration",
    "hasLegalBasis",
    "hasPersonalData",
    "hasProcessing",
    "hasPurpose",
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

_DURATION = re.compile(r"-?P(?=.)(\d+Y)?(\d+M)?(\d+D)?(T(?=.)(\d+H)?(\d+M)?(\d+(\.\d+)?S)?)?", re.ASCII)


def text(value: str, language: str | None = None) -> Literal:
    """Return a literal; what UTF-8 cannot say (a file name that is none) is escaped."""
    return Literal(utf8(value), lang=language)


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


def about(subject: Node, *objects: tuple[Node, Iterable[Node]]) -> list[Triple]:
    """Return what is said of a subject: one triple for each value of each predicate."""
    return [(subject, predicate, value) for predicate, values in objects for value in values]


def listed(items: Sequence[Node]) -> tuple[Node, list[Triple]]:
    """Return an RDF list and its triples; its cells have no names, and are written as ``( … )`` or ``@list``."""
    cells: list[Node] = [*(BNode() for _ in items), RDF.nil]
    triples: list[Triple] = []
    for cell, item, rest in zip(cells, items, cells[1:], strict=False):
        triples += [(cell, RDF.first, item), (cell, RDF.rest, rest)]
    return cells[0], triples
