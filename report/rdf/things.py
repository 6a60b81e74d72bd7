"""Elements, policy lines, categories and provisions as RDF: each is named where it is needed, and described once.

In: facts of the model and of the vocabulary; of provisions what ``law.ttl`` says of them besides. Out: their IRIs at
once, their descriptions at the end: what they are called and mean in each language, and where they stand.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, XSD, Literal, URIRef
from rdflib.namespace import PROV

from rosprivacy.analysis.model import Pointer
from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.provisions import law
from rosprivacy.ontology.turtle import RP as INSIDE
from rosprivacy.report.rdf.terms import DPV, RP, Triple, about, foreign, text
from rosprivacy.report.schemas.notation import terms_of
from rosprivacy.report.schemas.stated import NonRosStated, SubjectsEntry, SurroundingsEntry

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Category, Element, Grant, Legal, NonRosFacts
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.rdf.terms import IndividualNames

ALWAYS = "always"
AS_THEY_ARE = (DCTERMS.title, DCTERMS.bibliographicCitation, SKOS.definition, RDFS.seeAlso)


def texts(english: str, translations: Mapping[str, Mapping[str, str]], field: str) -> list[Literal]:
    """Return a text in each language that has it; none where there is no English one."""
    others = [text(said[field], language) for language, said in sorted(translations.items()) if said.get(field)]
    return [text(english, "en"), *others] if english else []


def category_triples(category: Category, broader: Iterable[URIRef]) -> list[Triple]:
    """Say what a category is; its kinds of DPV are those that DPV itself gives its terms."""
    special = [DPV.SpecialCategoryPersonalData] if category.article9 == ALWAYS else []
    return about(
        foreign(category.iri),
        (RDF.type, [SKOS.Concept, *special]),
        (SKOS.prefLabel, texts(category.title, category.translations, "title")),
        (SKOS.definition, texts(category.definition, category.translations, "definition")),
        (RP.identityFactor, map(text, category.identity_factors)),
        (SKOS.broader, broader),
        (SKOS.broadMatch, map(foreign, category.within)),
        (SKOS.exactMatch, map(foreign, category.same_as)),
        (OWL.sameAs, _stored(category.iri)),
    )


def provision_triples(provisions: Iterable[Legal | Pointer]) -> Iterator[Triple]:
    """Say what provisions are called and mean, where EUR-Lex has them (ELI), and what they are part of."""
    shipped = law()
    named: set[URIRef] = set()
    for legal in provisions:
        subject = URIRef(legal.iri)
        if isinstance(legal, Pointer):
            applies = [Literal(legal.applies, datatype=XSD.date)] if legal.applies else []
            country = [text(legal.country)] if legal.country else []
            yield from about(foreign(legal.iri), (RP.appliesFrom, applies), (RP.country, country))
            if not legal.confirmed:
                adopted = [Literal(legal.adopted, datatype=XSD.date)] if legal.adopted else []
                yield from about(foreign(legal.iri), (RP.confirmed, [Literal(False)]), (RP.adopted, adopted))
        if (subject, RDF.type, INSIDE.LegalProvision) in shipped:
            named |= {URIRef(str(up)) for up in shipped.transitive_objects(subject, INSIDE.partOf)}
        else:  # of a vocabulary that is not the shipped one
            yield from _text(legal)
    for subject in named:
        iri, parts = foreign(subject), [foreign(str(up)) for up in shipped.objects(subject, INSIDE.partOf)]
        yield from about(
            iri,
            (RDF.type, [RP.LegalProvision]),
            (RP.identifier, shipped.objects(subject, INSIDE.identifier)),
            (RP.asOf, shipped.objects(subject, INSIDE.asOf)),
            (RP.partOf, parts),
            (DCTERMS.isPartOf, parts),
            (OWL.sameAs, _stored(str(subject))),
            *((predicate, shipped.objects(subject, predicate)) for predicate in AS_THEY_ARE),
        )


def _text(legal: Legal | Pointer) -> list[Triple]:
    return about(
        foreign(legal.iri),
        (RDF.type, [RP.LegalProvision]),
        (RP.identifier, [text(legal.name)]),
        (SKOS.definition, texts(legal.meaning, legal.translations, "meaning")),
        (RP.asOf, [Literal(legal.as_of, datatype=XSD.date)]),
        (OWL.sameAs, _stored(legal.iri)),
    )


def _stored(iri: str) -> list[URIRef]:
    """What a term of ours is called in documents and databases; nothing of what is not ours."""
    return [URIRef(iri)] if iri.startswith(STORED) else []


CLASSES = {
    "node": RP.RosNode, "topic": RP.Topic, "service": RP.Service, "action": RP.Action, "storage": RP.Storage,
    "external-system": RP.ExternalSystem, "shared-memory": RP.SharedMemory, "side-channel": RP.SideChannel,
    "device": RP.Device, "display": RP.Display, "participant": RP.Participant, "person": RP.Person,
}  # fmt: skip


class Things:
    """What was named so far.

    Parameters
    ----------
    names
        Of the individuals.
    files
        Path -> IRIs of the files that were read there.
    """

    def __init__(self, document: Document, names: IndividualNames, files: Mapping[str, tuple[URIRef, ...]]) -> None:
        vocabulary = document.vocabulary
        self._categories = vocabulary.categories
        self._ancestors = vocabulary.hierarchy.ancestors
        self._names = names
        self._files = files
        self._outside = document.outside
        self._subjects = {element.identity: groups for element, groups in document.subjects}
        self._surroundings = {element.identity: where for element, where in document.surroundings}
        self._pointed = {one.name: one for one in vocabulary.pointed.provisions}
        self._elements: dict[URIRef, Element] = {}
        self._lines: dict[URIRef, Grant] = {}
        self._provisions: dict[URIRef, Legal | Pointer] = {}
        self._kinds: set[str] = set()

    def element(self, element: Element) -> URIRef:
        """Return the IRI of an element."""
        iri = self._names.element(element)
        self._elements.setdefault(iri, element)
        return iri

    def subjects(self, element: Element) -> tuple[str, ...]:
        """Return whom the data of a source are about, as labels say."""
        return self._subjects.get(element.identity, ())

    def line(self, grant: Grant) -> URIRef:
        """Return the IRI of the policy line of a grant."""
        iri = self._names.line(grant)
        self._lines.setdefault(iri, grant)
        return iri

    def provision(self, legal: Legal | Pointer) -> URIRef:
        """Return the IRI of a provision."""
        iri = foreign(legal.iri)
        self._provisions.setdefault(iri, legal)
        return iri

    def pointed(self, names: Iterable[str]) -> list[URIRef]:
        """Return the IRIs of provisions to look at; a day from which one applies, and its country, are described."""
        found = [self._pointed[name] for name in names if name in self._pointed]
        self._provisions |= {foreign(one.iri): one for one in found}
        return [foreign(one.iri) for one in found]

    def categories(self, names: Iterable[str]) -> list[URIRef]:
        """Return the IRIs of categories, in order of their names."""
        wanted = sorted(names)
        self._kinds.update(wanted)
        return [foreign(self._categories[name].iri) for name in wanted]

    def descriptions(self) -> Iterator[Triple]:
        """Describe all that was named, and the categories that are broader."""
        for iri, element in self._elements.items():
            yield from _element(iri, element)
            if facts := self._outside.get(element):
                yield from _facts(iri, NonRosStated, _outside(facts))
            yield from _facts(iri, SubjectsEntry, {"subjects": self.subjects(element)})
            if where := self._surroundings.get(element.identity):
                yield from _facts(iri, SurroundingsEntry, {"contexts": where.contexts, "country": (where.country,)})
        for iri, grant in self._lines.items():
            yield from _line(iri, grant, self._files.get(grant.place.file, ()))
        for name in {up for category in self._kinds for up in self._ancestors[category]}:
            category = self._categories[name]
            broader = [foreign(self._categories[up].iri) for up in category.broader if up in self._categories]
            yield from category_triples(category, broader)
            yield from about(foreign(category.iri), (RP.lookAt, self.pointed(category.look_at)))
        yield from provision_triples(self._provisions.values())


def _facts(iri: URIRef, entry: type, values: Mapping[str, Iterable[str]]) -> list[Triple]:
    """What an entry of the document states of an element, in the terms that its fields have."""
    terms = terms_of(entry).items()
    return about(iri, *((RP[term], map(text, filter(None, values[field]))) for field, term in terms))


def _outside(facts: NonRosFacts) -> dict[str, Iterable[str]]:
    written: dict[str, Iterable[str]] = {
        "retention": (_retention(facts),),
        "encrypted": () if facts.encrypted is None else ("yes" if facts.encrypted else "no",),
        "transfer": (facts.basis,),
    }
    return {field: written.get(field, (getattr(facts, field),)) for field in terms_of(NonRosStated)}


def _retention(facts: NonRosFacts) -> str:
    """How long it keeps which kind, and its backups after that; empty where nothing is stated (rule S9)."""
    durations = [f"{category}: {duration}" if category else str(duration) for category, duration in facts.retention]
    known = facts.backups is not True
    backups = f"in backups {facts.backups} more" if known else "in backups, nobody says for how long"
    return ", ".join([*durations, *([backups] if facts.backups else [])])


def _element(iri: URIRef, element: Element) -> list[Triple]:
    return about(
        iri,
        (RDF.type, [RP.Element, CLASSES[element.kind]]),
        (RP.name, [text(element.name)]),
        (RP.kind, [Literal(element.kind)]),
        (RP.robot, [text(element.robot)] if element.robot else []),
        (RP.leg, [Literal(element.leg)] if element.leg else []),
        (RP.pattern, [Literal(element.pattern)]),
    )


def _line(iri: URIRef, grant: Grant, files: Iterable[URIRef]) -> list[Triple]:
    return about(
        iri,
        (RDF.type, [RP.PolicyLine, PROV.Entity]),
        (RP.file, [text(grant.place.file)]),
        (RP.line, [Literal(grant.place.line)]),
        (RP.enclave, [text(grant.enclave)]),
        (RP.profile, [text(grant.node)]),
        (RP.inFile, files),
    )
