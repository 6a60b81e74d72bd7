"""The words of linked data: namespaces, the DPV 2.3 terms that are used, texts made into literals, IRIs of individuals.

In: what people wrote; a base, or what was read. Out: terms, literals and IRIs that any RDF parser takes, whatever a
text or a name holds. Elements, findings, lines and files of two systems are never the same individual.
"""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote
from uuid import NAMESPACE_URL, uuid5

from rdflib import RDF, XSD, BNode, Literal, Namespace, URIRef
from rdflib.namespace import ClosedNamespace

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.text import utf8
from rosprivacy.ontology.iris import PUBLISHED, as_published

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rdflib.term import Node

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Grant
    from rosprivacy.analysis.model.register_row import RegisterRow

Triple = tuple["Node", "Node", "Node"]

RP = Namespace(PUBLISHED)

DPV_CLASSES = (
    "ActivityStatus",
    "Anonymisation",
    "Collect",
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
    "SpecialCategoryPersonalData",
    "StorageDuration",
    "Store",
    "TechnicalMeasure",
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
    "hasOrganisationalMeasure",
    "hasPersonalData",
    "hasProcess",
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
# Bases of a transfer as labels call them -> the one point that each is; the others are of several, or of none.
TRANSFERS = {
    "adequacy": "A45-3", "public-instrument": "A46-2-a", "binding-corporate-rules": "A46-2-b",
    "code-of-conduct": "A46-2-e", "certification": "A46-2-f",
}  # fmt: skip
TOOLS = ("StandardContractualClauses",)
RISKS = ("DataRisk", "Reidentification", "UnwantedDisclosureData")
# Closed: a term that is not listed is an AttributeError, and a test holds the lists against the files of DPV 2.3.
DPV = ClosedNamespace("https://w3id.org/dpv#", [*DPV_CLASSES, *DPV_PROPERTIES])
EU_GDPR = ClosedNamespace("https://w3id.org/dpv/legal/eu/gdpr#", [*BASES, *TOOLS])
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


LONGEST = 500  # characters of a name in an IRI; a longer one stands there as its hash; `=` is never left in a name
SYSTEMS = uuid5(NAMESPACE_URL, "https://w3id.org/rosprivacy")  # RFC 9562: a name space of our own
OF_THE_SYSTEM = ("policies", "labels", "fleet")  # assumptions that name the files which say what a system is
_BASE = re.compile(r'[A-Za-z][A-Za-z0-9+.-]*:[^\x00-\x20<>"{}|\\^`\x7f-\x9f]*[/#:]')
_NOT_IN_IRIS = re.compile(r'[\x00-\x20<>"{}|\\^`\x7f-\x9f]')


@dataclass(frozen=True, slots=True)
class IndividualNames:
    """What the individuals of a system are called.

    Attributes
    ----------
    base
        An IRI that ends in ``/``, ``#`` or ``:``; all names begin with it.
    """

    base: str

    def of(self, kind: str, *parts: object) -> URIRef:
        """Return the IRI of an individual: percent-encoded, so that no name can leave it, the same for no two.

        >>> IndividualNames("urn:test:").of("element", "", "node", "/a> . <b")
        rdflib.term.URIRef('urn:test:element::node:/a%3E%20.%20%3Cb')
        """
        return URIRef(self.base + ":".join([kind, *(_encoded(str(part)) for part in parts)]))

    def element(self, element: Element) -> URIRef:
        """Return the IRI of an element as a reader sees it: the two sides of a wildcard are one."""
        return self.of("element", *element.identity, *([element.leg] if element.leg else []))

    def finding(self, finding: Finding) -> URIRef:
        """Return the IRI of a finding, made from its stable id (rule S10)."""
        return self.of("finding", finding.id)

    def process(self, finding: Finding) -> URIRef:
        """Return the IRI of the possible process that a finding is about."""
        return self.of("process", finding.id)

    def row(self, row: RegisterRow) -> URIRef:
        """Return the IRI of a row of the register, made from its id."""
        return self.of("row", row.id)

    def line(self, grant: Grant) -> URIRef:
        """Return the IRI of a policy line as it applies to a profile."""
        return self.of("line", grant.place.file, grant.place.line, grant.enclave, grant.node)

    def file(self, file: str, sha256: str) -> URIRef:
        """Return the IRI of a file that was read; another content is another file."""
        return self.of("file", sha256, file)


def names_of(document: Mapping[str, Any], base: str | None = None) -> IndividualNames:
    """Return the names of what a document is about.

    Parameters
    ----------
    document
        The JSON document of an analysis.
    base
        What somebody wants the names to begin with. By default a UUID of the files that say what the system is, by
        their content: the same files give the same names, and another system has others.

    Raises
    ------
    InputError
        If the base is no IRI, or names would run into it.
    """
    if base is not None and not _BASE.fullmatch(base):
        hint = "give an IRI that ends in / or # or :, such as https://example.org/robots/r2/"
        raise InputError("base", 0, f"{shown(base)!r} is not a base of IRIs", hint)
    return IndividualNames(base or f"urn:uuid:{uuid5(SYSTEMS, _seed(document))}#")


def below(parent: URIRef, *parts: object) -> URIRef:
    """Return the IRI of a part of a thing of ours."""
    return URIRef(":".join([str(parent), *(_encoded(str(part)) for part in parts)]))


def foreign(iri: str) -> URIRef:
    """Return an IRI that an ontology names, ours as it is published; what may not stand in one is percent-encoded."""
    return URIRef(_NOT_IN_IRIS.sub(lambda match: quote(match[0]), as_published(iri)))


def files_read(assumptions: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return (assumption, file, SHA-256) of every file that an assumption names, sorted."""
    entries = ((name, entry) for name, value in assumptions.items() for entry in entries_of(value))
    return sorted((name, entry["file"], entry["sha256"]) for name, entry in entries)


def entries_of(value: object) -> Iterator[Mapping[str, Any]]:
    """Yield the files that an assumption names: one, several or none."""
    found = value if isinstance(value, list) else [value]
    yield from (entry for entry in found if isinstance(entry, dict) and {"file", "sha256"} <= entry.keys())


def _seed(document: Mapping[str, Any]) -> str:
    """What tells a system: the content of its files, wherever they lie; all that is told where there are none."""
    read = files_read(document["assumptions"])
    system = sorted({(kind, sha256) for kind, _, sha256 in read if kind in OF_THE_SYSTEM})
    return json.dumps(system or document, sort_keys=True)


def _encoded(name: str) -> str:
    data = name.encode("utf-8", "surrogatepass")
    encoded = quote(data, safe="/")
    return encoded if len(encoded) <= LONGEST else f"sha256={hashlib.sha256(data).hexdigest()}"
