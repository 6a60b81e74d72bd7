"""IRIs of what an analysis is about: elements, findings, lines, files; those of two systems are never the same.

In: a base, or what was read. Out: IRIs that any RDF parser takes, whatever a name holds. Terms of ours stand in
``terms.py``; only individuals are named here.
"""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote
from uuid import NAMESPACE_URL, uuid5

from rdflib import URIRef

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.ontology.iris import as_published

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Grant

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
