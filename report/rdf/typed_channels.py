"""Message types of channels as RDF, and what they alone close (rule S15).

In: an ``Answer``. Out: triples. What only a type closes is no finding: whoever asks for findings does not get it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import RDF, Literal

from rosprivacy.report.document.stated import typed_channels
from rosprivacy.report.rdf.individuals import below
from rosprivacy.report.rdf.terms import RP, Triple, about, text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rdflib import URIRef

    from rosprivacy.analysis.answer import ClosedByTypes
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.rdf.things import Things

    Files = Mapping[str, Sequence[URIRef]]  # path -> what was read there


def type_triples(answer: Answer, iri: URIRef, files: Files, things: Things) -> Iterator[Triple]:
    """Return the types of each channel, from where each is known; the limits that closed something, and what.

    Parameters
    ----------
    iri
        Of the answer.
    """
    for number, (channel, types) in enumerate(typed_channels(answer), 1):
        for position, one in enumerate(types, 1):
            link = below(iri, "type", number, position)
            yield things.element(channel), RP.hasType, link
            yield from about(
                link,
                (RDF.type, [RP.ChannelType]),
                (RP.messageType, [text(one.name)]),
                (RP.stated, [Literal(one.stated)]),
                (RP.file, [text(one.place.file)]),
                (RP.line, [Literal(one.place.line)]),
                (RP.inFile, files.get(one.place.file, ())),
            )
    if answer.shown.closed:
        yield from _closed(answer.shown.closed, iri, things)


def _closed(closed: ClosedByTypes, iri: URIRef, things: Things) -> Iterator[Triple]:
    for number, (channel, kinds) in enumerate(closed.channels, 1):
        link = below(iri, "limit", number)
        yield iri, RP.limitedBy, link
        yield from about(
            link,
            (RDF.type, [RP.TypeLimit]),
            (RP.element, [things.element(channel)]),
            (RP.cannotCarry, things.categories(kinds)),
        )
    for number, finding in enumerate(closed.findings, 1):
        link = below(iri, "closed", number)
        yield iri, RP.closedByTypes, link
        yield from about(
            link,
            (RDF.type, [RP.ClosedFinding]),
            (RP.id, [Literal(finding.id)]),
            (RP.kind, [Literal(finding.kind)]),
            (RP.category, things.categories([finding.category])),
            (RP.dataSource, [things.element(finding.source)]),
            (RP.leak, [things.element(finding.leak)]),
            (RP.dismissed, [Literal(finding.dismissed)]),
        )
