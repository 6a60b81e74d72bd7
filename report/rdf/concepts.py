"""Categories and provisions as RDF: what they are called and mean in each language, and where they stand.

In: facts of the vocabulary; of provisions what ``law.ttl`` says of them besides. Out: triples.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, XSD, Literal, URIRef

from rosprivacy.analysis.model import Pointer
from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.provisions import law
from rosprivacy.ontology.turtle import RP as INSIDE
from rosprivacy.report.rdf.individuals import foreign
from rosprivacy.report.rdf.terms import DPV, RP, Triple, about, text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Category, Legal

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
                adopted = [Literal(legal.adopted, datatype=XSD.date)]
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
