"""Turtle -> categories with what the law says of each; read by rdflib, which is heavy: import this where it is used.

In: text. Out: an rdflib graph, and ``Category`` facts as the files state them; what follows for broader and narrower
ones is for ``analysis/legal.py``.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rdflib import DCTERMS, RDF, RDFS, SKOS, Graph, Namespace, URIRef

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.analysis.model import ARTICLE_10, CONCERNS, Category, Legal, PersonGroup, Pointer, Situation
from rosprivacy.ontology.iris import PUBLISHED, STORED, as_stored
from rosprivacy.ontology.pointed import EVERY_SYSTEM, Pointed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rdflib.term import Node

RP = Namespace(STORED)
ENGLISH = "en"
_LOCAL = re.compile(r"[#/:]")
_QUOTED = re.compile(r" at \^ in: .*")  # rdflib quotes the text, which may be anybody's


def read(turtle: str, file: str) -> Graph:
    """Return the triples of a Turtle text; our terms have the stored form (``iris.py``), whichever it uses.

    Raises
    ------
    InputErrors
        If it is not Turtle.
    """
    graph = Graph(bind_namespaces="none")
    try:
        graph.parse(data=as_stored(turtle), format="turtle")
    except Exception as error:  # noqa: BLE001 - rdflib raises its own and plain exceptions alike
        line = getattr(error, "lines", 0)
        said = shown(_QUOTED.sub("", " ".join(str(getattr(error, "message", error)).split())))
        raise InputErrors(
            [OntologyError(file, line + 1 if line else 0, f"not Turtle: {said}", "correct the syntax")]
        ) from None
    for subject, predicate, value in [triple for triple in graph if any(PUBLISHED in str(term) for term in triple)]:
        graph.remove((subject, predicate, value))  # written with escapes, or relative to a base
        graph.add((_stored(subject), _stored(predicate), _stored(value)))
    return graph


def _stored(term: Node) -> Node:
    return URIRef(as_stored(term)) if isinstance(term, URIRef) else term


def categories_of(graph: Graph, subjects: Iterable[Node] | None = None) -> tuple[Category, ...]:
    """Return the categories of a graph, sorted by IRI: every ``skos:Concept`` of the scheme or with an ``rp:label``.

    Parameters
    ----------
    subjects
        Only these; all by default.
    """
    ours = category_subjects(graph)
    chosen = ours if subjects is None else list(subjects)
    same = _by_match(graph, set(ours))
    return tuple(_category(graph, subject, set(ours), same) for subject in sorted(chosen, key=str))


def category_subjects(graph: Graph) -> list[Node]:
    """Return what is meant as a category."""
    concepts = set(graph.subjects(RDF.type, SKOS.Concept))
    labelled = set(graph.subjects(RP.label, None)) | set(graph.subjects(SKOS.inScheme, RP.Categories))
    return sorted(concepts & labelled, key=str)


def respelt_of(graph: Graph) -> dict[str, str]:
    """Return former spellings of DPV terms -> IRIs of today."""
    return {str(old): str(term) for term, old in graph.subject_objects(RP.formerly)}


def local_name(iri: str) -> str:
    """Return the last part of an IRI.

    >>> local_name("https://w3id.org/dpv/pd#Picture")
    'Picture'
    """
    return _LOCAL.split(iri)[-1]


def _by_match(graph: Graph, ours: set[Node]) -> dict[Node, str]:
    """IRIs of other vocabularies -> names of the categories that are the same, or near enough to stand below."""
    matches = (pair for match in (SKOS.closeMatch, SKOS.exactMatch) for pair in graph.subject_objects(match))
    return {other: local_name(str(subject)) for subject, other in matches if subject in ours and other not in ours}


def _texts(graph: Graph, subject: Node, predicate: Node) -> dict[str, list[str]]:
    """Language -> values, sorted; without a language counts as English."""
    found: dict[str, list[str]] = {}
    for value in sorted(graph.objects(subject, predicate), key=str):
        found.setdefault(getattr(value, "language", None) or ENGLISH, []).append(str(value))
    return found


def first_texts(graph: Graph, subject: Node, predicate: Node) -> dict[str, str]:
    """Return language -> the first text in it; one without a language counts as English."""
    return {language: values[0] for language, values in _texts(graph, subject, predicate).items()}


def _translated(**texts: dict[str, str]) -> dict[str, dict[str, str]]:
    """By language, English left out: it is the fact itself."""
    languages = sorted({language for values in texts.values() for language in values} - {ENGLISH})
    return {
        language: {what: values[language] for what, values in texts.items() if language in values}
        for language in languages
    }


def _category(graph: Graph, subject: Node, ours: set[Node], same_as: dict[Node, str]) -> Category:
    title, definition = first_texts(graph, subject, SKOS.prefLabel), first_texts(graph, subject, SKOS.definition)
    reason = first_texts(graph, subject, RP.reason)
    parents = set(graph.objects(subject, SKOS.broader))
    broader = {local_name(str(up)) for up in parents if up in ours}
    broader |= {same_as[up] for up in parents if up in same_as}
    own = local_name(str(subject))
    names = [*_texts(graph, subject, SKOS.altLabel).values(), [t for lang, t in title.items() if lang != ENGLISH]]
    gdpr = graph.value(subject, RP.gdprCategory)
    return Category(
        name=own,
        iri=str(subject),
        label=first_texts(graph, subject, RP.label).get(ENGLISH, ""),
        title=title.get(ENGLISH, ""),
        definition=definition.get(ENGLISH, ""),
        broader=tuple(sorted(broader - {own})),
        synonyms=tuple(sorted({name for some in names for name in some})),
        law=tuple(sorted(_law(graph, subject, own), key=lambda legal: (legal.name, legal.verdict))),
        reason=reason.get(ENGLISH, ""),
        data_types=tuple(sorted(str(value) for value in graph.objects(subject, RP.dataType))),
        identity_factors=tuple(sorted(str(value) for value in graph.objects(subject, RP.identityFactor))),
        gdpr="" if gdpr is None else _identifier(graph, gdpr),
        same_as=tuple(sorted(str(other) for other in graph.objects(subject, SKOS.exactMatch))),
        within=tuple(sorted({str(up) for up in (parents | set(graph.objects(subject, SKOS.broadMatch))) - ours})),
        note=first_texts(graph, subject, SKOS.note).get(ENGLISH, ""),
        in_context=tuple(sorted(_in_context(graph, subject), key=lambda legal: (legal.context, legal.name))),
        look_at=tuple(sorted(_identifier(graph, at) for at in graph.objects(subject, RP.lookAt))),
        translations=_translated(
            title=title, definition=definition, reason=reason, gdpr={} if gdpr is None else _cited(graph, gdpr)
        ),
    )


def _law(graph: Graph, subject: Node, own: str) -> Iterator[Legal]:
    for link in graph.objects(subject, RP.fallsUnder):
        if legal := _legal(graph, link, own):
            yield legal


def _in_context(graph: Graph, subject: Node) -> Iterator[Legal]:
    """What data of a kind may reveal in a context (rp:inContext); what names no kind of data only concerns them."""
    for link in graph.objects(subject, RP.inContext):
        context = graph.value(link, RP.context)
        legal = _legal(graph, link, "")
        if legal and context is not None:
            about = CONCERNS if not (legal.special or legal.name == ARTICLE_10) else legal.verdict
            yield legal._replace(context=str(graph.value(context, SKOS.notation) or ""), verdict=about)


def _legal(graph: Graph, link: Node, own: str) -> Legal | None:
    """What a link says: which provision, how surely, when, by which sources."""
    provision = graph.value(link, RP.provision)
    if provision is None:
        return None
    meaning, condition = first_texts(graph, provision, SKOS.definition), first_texts(graph, link, RP.condition)
    sources = sorted(graph.objects(link, RP.source), key=lambda source: _identifier(graph, source))
    return Legal(
        iri=str(provision),
        name=_identifier(graph, provision),
        meaning=meaning.get(ENGLISH, ""),
        as_of=str(graph.value(provision, RP.asOf) or ""),
        verdict=str(graph.value(link, RP.verdict) or ""),
        condition=condition.get(ENGLISH, ""),
        sources=tuple(_identifier(graph, source) for source in sources),
        stated_of=own,
        translations=_translated(
            meaning=meaning,
            condition=condition,
            name=_cited(graph, provision),
            sources=_listed([_cited(graph, source) for source in sources]),
        ),
    )


def pointed_of(graph: Graph) -> Pointed:
    """Return the provisions that anything is pointed at (rp:lookAt), and what points at them beside categories."""
    kinds = sorted(set(graph.subjects(RDF.type, RP.FindingKind)), key=str)
    at_stake = {kind: sorted(graph.objects(kind, RP.provision), key=str) for kind in kinds}
    groups = graph.subjects(RDF.type, RP.PersonGroup)
    named = {*graph.objects(None, RP.lookAt), *(one for several in at_stake.values() for one in several)}
    situations = {*graph.subjects(RDF.type, RP.Context), *graph.subjects(RDF.type, RP.Situation)}
    stakes = (
        (str(graph.value(kind, SKOS.notation)), tuple(sorted(_identifier(graph, one) for one in several)))
        for kind, several in at_stake.items()
    )
    return Pointed(
        tuple(_pointer(graph, one) for one in sorted(named, key=lambda one: _identifier(graph, one))),
        tuple(sorted((_situation(graph, one) for one in situations), key=lambda one: one.name)),
        tuple(sorted(stakes)),
        tuple(_group(graph, one) for one in sorted(groups, key=str)),
    )


def _group(graph: Graph, subject: Node) -> PersonGroup:
    title = first_texts(graph, subject, SKOS.prefLabel)
    words = {*graph.objects(subject, SKOS.prefLabel), *graph.objects(subject, SKOS.altLabel)}
    return PersonGroup(
        name=local_name(str(subject)),
        term=str(graph.value(subject, SKOS.exactMatch)),
        title=title.get(ENGLISH, ""),
        words=tuple(sorted({str(word).casefold() for word in words})),
        vulnerable=graph.value(subject, RP.vulnerable) is not None,
        look_at=tuple(sorted(_identifier(graph, at) for at in graph.objects(subject, RP.lookAt))),
        translations=_translated(title=title),
    )


def _pointer(graph: Graph, provision: Node) -> Pointer:
    title, meaning = first_texts(graph, provision, DCTERMS.title), first_texts(graph, provision, SKOS.definition)
    cited = first_texts(graph, provision, DCTERMS.bibliographicCitation)
    return Pointer(
        iri=str(provision),
        name=_identifier(graph, provision),
        title=title.get(ENGLISH, ""),
        meaning=meaning.get(ENGLISH, ""),
        as_of=str(graph.value(provision, RP.asOf) or ""),
        applies=str(graph.value(provision, RP.appliesFrom) or ""),
        country=str(graph.value(provision, RP.country) or ""),
        address=str(graph.value(provision, RDFS.seeAlso) or ""),
        translations=_translated(name=cited, title=title, meaning=meaning),
        confirmed=graph.value(provision, RP.confirmed) is None,
        adopted=str(graph.value(provision, RP.adopted) or ""),
    )


def _situation(graph: Graph, subject: Node) -> Situation:
    title, definition = first_texts(graph, subject, SKOS.prefLabel), first_texts(graph, subject, SKOS.definition)
    return Situation(
        name=str(graph.value(subject, SKOS.notation) or EVERY_SYSTEM),
        title=title.get(ENGLISH, ""),
        definition=definition.get(ENGLISH, ""),
        look_at=tuple(sorted(_identifier(graph, at) for at in graph.objects(subject, RP.lookAt))),
        translations=_translated(title=title, definition=definition),
    )


def _cited(graph: Graph, provision: Node) -> dict[str, str]:
    """How a provision is cited in each language; with what it is about where its identifier says that, too."""
    citations, titles = (
        first_texts(graph, provision, DCTERMS.bibliographicCitation),
        first_texts(graph, provision, DCTERMS.title),
    )
    titled = _identifier(graph, provision).endswith(f" {titles.get(ENGLISH)}")
    return {
        language: f"{cited} ({titles[language]})" if titled and language in titles else cited
        for language, cited in citations.items()
    }


def _listed(texts: list[dict[str, str]]) -> dict[str, str]:
    """Texts of each language in a row, where all of them have one in it."""
    languages = set.intersection(*map(set, texts)) if texts else set()
    return {language: "; ".join(text[language] for text in texts) for language in sorted(languages)}


def _identifier(graph: Graph, provision: Node) -> str:
    return str(graph.value(provision, RP.identifier) or local_name(str(provision)))
