"""Data, persons, parties and countries of a process as individuals, in the words of DPV 2.3: each is made in one place.

In: a process, and what the analysis and people know of it. Out: triples. Findings and rows of the register name the
same recipient, country or group of persons by the same IRI.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rdflib import RDF, RDFS

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import NonRosFacts
from rosprivacy.analysis.non_ros import INSIDE
from rosprivacy.report.rdf.terms import DPV, RP, Triple, about, below, foreign, text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rdflib import URIRef

    from rosprivacy.analysis.model import Element
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.rdf.terms import IndividualNames
    from rosprivacy.report.rdf.things import Things

ALWAYS = "always"
PARTIES = {
    "controller": DPV.DataController, "joint-controller": DPV.JointDataControllers, "processor": DPV.DataProcessor,
    "third-party": DPV.ThirdParty,
}  # fmt: skip


def foreign_terms(category: str, vocabulary: Vocabulary) -> tuple[str, ...]:
    """Return the IRIs of other vocabularies for a category: its own, or those of its nearest broader ones; sorted."""
    for level in _levels(category, vocabulary):
        categories = [vocabulary.categories[name] for name in level]
        found = {iri for known in categories for iri in (*known.same_as, *known.within)}
        if found:
            return tuple(sorted(found))
    return ()


def _levels(category: str, vocabulary: Vocabulary) -> Iterator[list[str]]:
    """A category, then its broader ones by distance."""
    distances = vocabulary.hierarchy.ancestors[category]
    for distance in sorted(set(distances.values())):
        yield sorted(name for name in distances if distances[name] == distance)


@dataclass(frozen=True, slots=True)
class Individuals:
    """Makes what processes have in common."""

    document: Document
    names: IndividualNames
    things: Things

    def data(self, process: URIRef, category: str, *, pseudonymised: bool) -> Iterator[Triple]:
        """The data as one thing that is of our kind, of DPV's, and pseudonymised: not several kinds side by side."""
        data, kind = below(process, "data"), self.document.vocabulary.categories[category]
        form = "pseudonymised: " if pseudonymised else ""
        yield process, DPV.hasPersonalData, data
        yield from about(
            data,
            (RDF.type, [DPV.PersonalData, *self.things.categories([category])]),
            (RDF.type, map(foreign, foreign_terms(category, self.document.vocabulary))),
            (RDF.type, [DPV.PseudonymisedData] if pseudonymised else []),
            (RDF.type, [DPV.SpecialCategoryPersonalData] if kind.article9 == ALWAYS else []),
            (RDFS.label, [text(form + shown(kind.title), "en")]),
        )

    def sources(self, process: URIRef, elements: Iterable[Element]) -> Iterator[Triple]:
        """Where the data come in."""
        for source in map(self.things.element, elements):
            yield process, DPV.hasDataSource, source
            yield source, RDF.type, DPV.DataSource

    def responsible(
        self, process: URIRef, controllers: Iterable[str], officers: Iterable[str], purposes: Iterable[str]
    ) -> Iterator[Triple]:
        """Who is responsible and what for, as label files state it (GDPR, Article 30(1)(a) and (b))."""
        for what, texts, relation, kind in (
            ("controller", controllers, DPV.hasDataController, DPV.DataController),
            ("officer", officers, DPV.hasDataProtectionOfficer, DPV.DataProtectionOfficer),
            ("purpose", purposes, DPV.hasPurpose, DPV.Purpose),
        ):
            for stated in texts:
                thing = self.names.of(what, stated)
                yield process, relation, thing
                yield from about(thing, (RDF.type, [kind]), (RDFS.label, [text(shown(stated))]))

    def persons(self, process: URIRef, groups: Iterable[str]) -> Iterator[Triple]:
        """Whose data they are, as labels name them (GDPR, Article 30(1)(c)); a known group as DPV calls it, too."""
        for stated in groups:
            persons, group = self.names.of("subject", stated), self.document.vocabulary.pointed.group_of(stated)
            yield process, DPV.hasDataSubject, persons
            yield from about(
                persons,
                (RDF.type, [DPV.DataSubject, *([foreign(group.term)] if group else [])]),
                (RDFS.label, [text(shown(stated))]),
            )

    def recipient(self, process: URIRef, place: Element, *, on_network: bool = False) -> Iterator[Triple]:
        """Who receives the data: whoever stands behind a place, as software receives nothing.

        Parameters
        ----------
        on_network
            Whether that is whoever reads an unprotected channel.
        """
        facts, name = self.document.outside.get(place, NonRosFacts()), shown(place.name)
        anybody = f"whoever reads {name} on the network" if on_network else f"whoever receives what {name} lets out"
        recipient, role = self.names.of("recipient", *place.identity), PARTIES.get(facts.recipient)
        yield process, DPV.hasRecipient, recipient
        yield from about(
            recipient,
            (RDF.type, [DPV.Recipient, *([role] if role else [])]),
            (RDFS.label, [text(shown(facts.operator) if facts.operator else anybody)]),
            (RP.at, [self.things.element(place)]),
        )
        if where := self.document.analysis.outside.get(place):
            yield from self.country(recipient, where.country, where.area)

    def country(self, subject: URIRef, country: str, area: str) -> Iterator[Triple]:
        """Where something is, and whether that is a third country (GDPR, chapter V); nothing where nobody states it."""
        if country:
            there = self.names.of("country", country)
            yield subject, DPV.hasCountry, there
            third = [DPV.ThirdCountry] if area not in ("", INSIDE) else []
            yield from about(there, (RDF.type, [DPV.Country, *third]), (RP.country, [text(country)]))
