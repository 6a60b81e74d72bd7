"""The provisions of the Turtle files by themselves: what they are called, when we last looked, where they stand.

In: a language. Out: ``Provision`` facts. rdflib reads them, which is heavy: import this where it is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from rdflib import DCTERMS, RDF, RDFS, SKOS, URIRef

from rosprivacy.ontology.turtle import ENGLISH, RP, first_texts, read

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rdflib import Graph
    from rdflib.term import Node

FILES = ("law.ttl", "other_law.ttl")
MONTHS = 6  # after which a person has to look whether the law is still as it was read


@dataclass(frozen=True, slots=True)
class Provision:
    """One provision, recital, guideline or judgment.

    Attributes
    ----------
    identifier
        As findings cite it, in English.
    name
        As findings cite it in the language.
    meaning
        In one sentence of our own.
    as_of
        The day on which the entry was last looked at, ``YYYY-MM-DD``; no word that the law was read in force then.
    address
        Where EUR-Lex has it; empty where nothing is known.
    confirmed, adopted
        Whether we found it published; if not, the day on which an amendment was adopted, or nothing where all that we
        know of it is what others write.
    """

    identifier: str
    name: str
    title: str
    meaning: str
    as_of: str
    address: str
    confirmed: bool = True
    adopted: str = ""


@cache
def law() -> Graph:
    """Return what the shipped files of the law say; they are read once."""
    text = "\n".join((files(__package__) / file).read_text("utf-8") for file in FILES)
    return read(text, "the shipped law")


def grounds(language: str = ENGLISH) -> dict[str, Provision]:
    """Return what processing can rest on: each point of Articles 6(1) and 9(2) of the GDPR.

    >>> grounds("de")["6(1)(f)"].title, len(grounds())
    ('berechtigte Interessen', 16)
    """
    graph = law()
    found = {
        f"{article}({subject.removeprefix(str(above))[1:]})": subject
        for article, above in (("6(1)", RP["GDPR-6-1"]), ("9(2)", RP["GDPR-9-2"]))
        for subject in sorted(map(str, graph.subjects(RP.partOf, above)))
    }
    return {article: _provision(graph, URIRef(subject), language) for article, subject in found.items()}


def provisions(language: str = ENGLISH) -> tuple[Provision, ...]:
    """Return all of them, in the order of their identifiers.

    >>> [one.title for one in provisions("de") if one.name == "Art. 32 DSGVO"]
    ['Sicherheit der Verarbeitung']
    """
    graph = law()
    subjects = set(graph.subjects(RDF.type, RP.LegalProvision))
    return tuple(
        _provision(graph, subject, language)
        for subject in sorted(subjects, key=lambda subject: str(graph.value(subject, RP.identifier)))
    )


def provisions_named(provisions: Iterable[Provision], words: str) -> tuple[Provision, ...]:
    """Return those that have all words in what they are called; signs at the ends of words do not count.

    >>> [one.name for one in provisions_named(provisions("de"), "art. 32 dsgvo (sicherheit)")]
    ['Art. 32 DSGVO']
    """
    wanted = _bare_words(words)

    def name_words(provision: Provision) -> set[str]:
        return _bare_words(f"{provision.identifier} {provision.name} {provision.title}")

    return tuple(provision for provision in provisions if wanted <= name_words(provision))


def _bare_words(text: str) -> set[str]:
    signs = "".join({sign for sign in text if not sign.isalnum()})
    return {word.strip(signs) for word in text.casefold().split()} - {""}


def is_old(as_of: str, today: str) -> bool:
    """Whether a day lies more than six months before another; both ``YYYY-MM-DD``.

    >>> is_old("2026-11-21", "2027-05-21"), is_old("2026-11-21", "2027-05-22")
    (False, True)
    """
    year, month, day = map(int, as_of.split("-"))
    years, months = divmod(month - 1 + MONTHS, 12)
    return today > f"{year + years}-{months + 1:02}-{day:02}"


def _provision(graph: Graph, subject: Node, language: str) -> Provision:
    return Provision(
        str(graph.value(subject, RP.identifier)),
        _text(graph, subject, DCTERMS.bibliographicCitation, language),
        _text(graph, subject, DCTERMS.title, language),
        _text(graph, subject, SKOS.definition, language),
        str(graph.value(subject, RP.asOf)),
        str(graph.value(subject, RDFS.seeAlso) or ""),
        graph.value(subject, RP.confirmed) is None,
        str(graph.value(subject, RP.adopted) or ""),
    )


def _text(graph: Graph, subject: Node, predicate: Node, language: str) -> str:
    texts = first_texts(graph, subject, predicate)
    return texts.get(language) or texts.get(ENGLISH, "")
