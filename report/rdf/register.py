"""The register of processing as RDF: a process of DPV 2.3 for each row, whether it is a finding or not.

In: the rows of a ``Document``'s register. Out: triples that say what the row says, cell by cell. A cell that the
register does not know gives no triple, and the row names it as to be completed. Like the processes of findings, these
are possible: policies and labels leave them open to happen (GDPR, Article 30(1)).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import RDF, RDFS, Literal

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.legal import transfer_of
from rosprivacy.analysis.model import Method
from rosprivacy.analysis.non_ros import INSIDE
from rosprivacy.report.rdf.terms import (
    DPV,
    EU_GDPR,
    RP,
    TRANSFERS,
    Triple,
    about,
    below,
    duration,
    legal_basis,
    text,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rdflib import URIRef

    from rosprivacy.analysis.model.register_row import Measure, RegisterRow
    from rosprivacy.report.rdf.individuals import Individuals

DONE_AT = {"storage": DPV.Store, "external-system": DPV.Transfer}  # elsewhere the data are disclosed
MEASURES = {Method.PSEUDONYMISE: DPV.Pseudonymisation, Method.ANONYMISE: DPV.Anonymisation}
WORDS = {
    Method.PSEUDONYMISE: "pseudonymisation", Method.ANONYMISE: "anonymisation", Method.AGGREGATE: "aggregation",
    Method.DROP: "removal",
}  # fmt: skip


def register_triples(answer: URIRef, individuals: Individuals) -> Iterator[Triple]:
    """Return the processes of all rows.

    Parameters
    ----------
    answer
        The IRI of the analysis.

    Notes
    -----
    O(cells).
    """
    for row in individuals.document.register or ():
        iri = individuals.names.row(row)
        yield answer, RP.register, iri
        yield from _row(iri, row, individuals)


def _row(iri: URIRef, row: RegisterRow, individuals: Individuals) -> Iterator[Triple]:
    things, names = individuals.things, individuals.names
    yield from about(
        iri,
        (RDF.type, [DPV.Process, RP.RegisterRow]),
        (RDFS.label, [text(label_of(row))]),
        (DPV.hasActivityStatus, [RP.PossibleActivity]),
        (DPV.hasProcessing, set(_doing(row))),
        (DPV.hasProcess, [names.of("process", finding) for finding in row.findings]),
        (RP.id, [Literal(row.id)]),
        (RP.category, things.categories([row.category])),
        (RP.place, map(things.element, row.places)),
        (RP.pseudonymised, [Literal(row.pseudonymised)]),
        (RP.article9, [text(row.article9)]),
        (RP.context, map(text, row.contexts)),
        (RP.sourceCountry, map(text, row.countries)),
        (RP.lookAt, things.pointed(row.look_at)),
        (RP.found, [names.of("finding", finding) for finding in row.findings]),
        (RP.state, [text(row.state)]),
        (RP.onRobot, [text(shown(robot)) for robot in row.fleet.robots] if row.fleet else []),
        (RP.toComplete, map(text, row.to_complete)),
    )
    yield RP.PossibleActivity, RDF.type, DPV.ActivityStatus
    yield from individuals.data(iri, row.category, pseudonymised=row.pseudonymised)
    yield from individuals.sources(iri, row.sources)
    yield from individuals.responsible(iri, row.controllers, row.officers, row.purposes)
    yield from individuals.persons(iri, row.subjects)
    yield from _way(iri, row, individuals)
    yield from _bases(iri, row)
    yield from _place(iri, row, individuals)
    yield from _retention(iri, row)


def label_of(row: RegisterRow) -> str:
    """Return what a row is called: kind of data, and where it gets to."""
    return shown(f"possible: {row.category} -> {row.places[0].name}" if row.places else f"possible: {row.category}")


def _doing(row: RegisterRow) -> Iterator[URIRef]:
    """What is done with the data: what leaves nowhere is collected."""
    abroad = row.area not in ("", INSIDE)
    done = {DONE_AT.get(place.kind, DPV.Disclose) for place in row.places} or {DPV.Collect}
    yield from done - ({DPV.Transfer} if abroad else set())
    if abroad:
        yield DPV.CrossBorderTransfer
    if row.derivations:
        yield DPV.Derive


def _way(iri: URIRef, row: RegisterRow, individuals: Individuals) -> Iterator[Triple]:
    """Who makes one kind of another on the ways of the row, and who cleans data there (Article 30(1)(g))."""
    things = individuals.things
    for number, made in enumerate(row.derivations, 1):
        derivation = below(iri, "derivation", number)
        yield iri, RP.derivation, derivation
        yield from about(
            derivation,
            (RDF.type, [DPV.Derive]),
            (RP.at, [things.element(made.element)]),
            (RP.arrivesAs, things.categories([made.made_of])),
            (RP.leavesAs, things.categories([made.target])),
        )
    for number, measure in enumerate(row.measures, 1):
        yield from _measure(iri, below(iri, "measure", number), measure, individuals)


def _measure(iri: URIRef, subject: URIRef, measure: Measure, individuals: Individuals) -> Iterator[Triple]:
    method = Method(measure.method)
    yield iri, DPV.hasTechnicalMeasure, subject
    yield from about(
        subject,
        (RDF.type, [MEASURES.get(method, DPV.TechnicalMeasure)]),
        (RDFS.label, [text(f"{WORDS[method]} at {shown(measure.element.name)}", "en")]),
        (RP.at, [individuals.things.element(measure.element)]),
        (RP.cleans, individuals.things.categories([measure.category])),
        (RP.method, [text(measure.method)]),
        (RP.stated, [Literal(measure.stated)]),
        (RP.everywhere, [Literal(measure.everywhere)]),
    )


def _bases(iri: URIRef, row: RegisterRow) -> Iterator[Triple]:
    """The legal bases of the processing and of the transfer, as stated or decided; no word of whether they fit.

    ``standard-clauses`` are of two points of Article 46(2), so they are named as the tool that they are.
    """
    transfers = {row.transfer, *map(transfer_of, row.safeguards)}
    named = (*row.bases, *row.special_bases, *row.criminal_bases)
    terms = [term for basis in (*named, *row.safeguards) for term in legal_basis(basis)]
    yield from about(
        iri,
        (DPV.hasLegalBasis, {*terms, *(EU_GDPR[TRANSFERS[one]] for one in transfers if one in TRANSFERS)}),
        (
            DPV.hasOrganisationalMeasure,
            [EU_GDPR.StandardContractualClauses] if "standard-clauses" in transfers else [],
        ),
        (RP.statedLegalBasis, map(text, named)),
        (RP.statedSafeguard, map(text, row.safeguards)),
        (RP.transferBasis, [text(row.transfer)] if row.transfer else []),
    )


def _place(iri: URIRef, row: RegisterRow, individuals: Individuals) -> Iterator[Triple]:
    """Who receives the data, where, and what is stated of that (Article 30(1)(d) and (e))."""
    if row.operator or row.recipient:
        for place in row.places:
            yield from individuals.recipient(iri, place)
    yield from individuals.country(iri, row.country, row.area)
    encrypted = [] if row.encrypted is None else [text("yes" if row.encrypted else "no")]
    yield from about(
        iri,
        (RP.area, [text(row.area)] if row.area else []),
        (RP.contract, [text(row.contract)] if row.contract else []),
        (RP.encrypted, encrypted),
    )


def _retention(iri: URIRef, row: RegisterRow) -> Iterator[Triple]:
    """How long the place keeps the kind, and its backups after that (Article 30(1)(f), rule S9)."""
    kept = [str(one) for one in row.retention]
    if kept:
        yield from _condition(iri, "retention", kept, backups=False)
    if row.backups is not None:
        yield iri, RP.backups, Literal(row.backups is not False)
    if row.backups:
        yield from _condition(iri, "backups", [] if row.backups is True else [str(row.backups)], backups=True)


def _condition(iri: URIRef, part: str, durations: list[str], *, backups: bool) -> Iterator[Triple]:
    condition = below(iri, part)
    how_long = f"for {', '.join(durations)}" if durations else "nobody states how long"
    yield iri, DPV.hasStorageCondition, condition
    yield from about(
        condition,
        (RDF.type, [DPV.StorageDuration]),
        (RDFS.label, [text(shown(f"then in backups, {how_long}" if backups else f"kept {how_long}"), "en")]),
        (RP.ofBackups, [Literal(backups)]),
        (RP.stated, [Literal(bool(durations))]),
        (DPV.hasDuration, [duration(one) for one in durations]),
    )
