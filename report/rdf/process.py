"""The process that a finding is about, in the words of DPV 2.3: whose data, from where, to whom, kept for how long.

In: a finding, the vocabulary, and what people stated. Out: where data change on the path and under which law, as plain
values; triples of a ``dpv:Process`` that is possible. Nobody says that it takes place, so that a file put beside a
record of processing activities does not record what never happens.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rdflib import RDF, RDFS, Literal

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.findings.processed import Processed
from rosprivacy.analysis.non_ros import EVERY, retention_of
from rosprivacy.report.rdf.terms import DPV, RISK, RP, Triple, about, below, duration, legal_basis, text

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rdflib import URIRef

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Legal, NonRosFacts
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.rdf.individuals import Individuals


@dataclass(frozen=True, slots=True)
class ChangeFact:
    """What an element of a witness makes of the data.

    Attributes
    ----------
    before, after
        (category, pseudonymised). Before has no category at a source that makes what it sends of what it brings in.
    """

    element: Element
    before: tuple[str, bool]
    after: tuple[str, bool]

    @property
    def derives(self) -> bool:
        """Whether the category that leaves is another than the one that comes in."""
        return self.before[0] != self.after[0]

    @property
    def pseudonymises(self) -> bool:
        """Whether it is here that the data become pseudonymised."""
        return self.after[1] and not self.before[1]


def label_of(finding: Finding) -> str:
    """Return what a finding is called: kind of data, from where, to where."""
    return shown(f"{finding.category}: {finding.source.name} -> {finding.leak.name}")


def kinds_along(finding: Finding) -> list[tuple[str, bool]]:
    """Return (category, pseudonymised) of what leaves each element of the witness; at the leak, of what gets out."""
    return [*((step.category, step.pseudonymised) for step in finding.steps), (finding.category, finding.pseudonymised)]


def changes(finding: Finding, emitted: Collection[str]) -> list[ChangeFact]:
    """Return where on the witness the data become another category or pseudonymised, source first.

    Parameters
    ----------
    emitted
        Categories that the source brings in; what else it sends it made of these.
    """
    kinds = kinds_along(finding)
    first = (kinds[0][0] if kinds[0][0] in emitted else "", False)
    rows = zip(finding.witness, [first, *kinds[:-1]], kinds, strict=True)
    found = [ChangeFact(element, before, after) for element, before, after in rows]
    return [change for change in found if change.derives or change.pseudonymises]


def legal_of(finding: Finding, vocabulary: Vocabulary) -> tuple[tuple[Legal, tuple[str, ...]], ...]:
    """Return the provisions of a finding's category, each with the categories that the ontology states it of."""
    return tuple((legal, tuple(legal.stated_of.split(", "))) for legal in vocabulary.categories[finding.category].law)


STORED = "storage-limitation"
OPEN = "unprotected-channel"
OF_KIND = {
    "disclosure": DPV.Disclose, STORED: DPV.Store, "third-country-transfer": DPV.CrossBorderTransfer,
    OPEN: DPV.Disclose,
}  # fmt: skip
AT_LEAK = {"storage": DPV.Store, "external-system": DPV.Transfer}


@dataclass(frozen=True, slots=True)
class Processes:
    """What is needed to write the process of any finding.

    Attributes
    ----------
    unstated
        (element as shown, category) where a method is not stated.
    processed
        (element, category) -> purposes, legal bases and who is responsible, as stated.
    """

    individuals: Individuals
    unstated: frozenset[tuple[object, str]]
    processed: Mapping[tuple[Element, str], Processed]

    def triples(self, finding: Finding, changed: list[ChangeFact]) -> Iterator[Triple]:
        """Everything about the process of a finding."""
        iri = self.individuals.names.process(finding)
        yield from about(
            iri,
            (RDF.type, [DPV.Process]),
            (RDFS.label, [text(f"possible: {label_of(finding)}")]),
            (DPV.hasActivityStatus, [RP.PossibleActivity]),
            (DPV.hasLegalBasis, self._bases(finding)),
        )
        yield from self._why(iri, finding)
        yield RP.PossibleActivity, RDF.type, DPV.ActivityStatus
        yield from self.individuals.sources(iri, [finding.source])
        yield from self.individuals.data(iri, finding.category, pseudonymised=finding.pseudonymised)
        yield from self._doing(iri, finding, derived=any(change.derives for change in changed))
        for number, change in enumerate((change for change in changed if change.pseudonymises), 1):
            yield from self._measure(iri, below(iri, "measure", number), change)
        yield from self.individuals.persons(iri, self.individuals.things.subjects(finding.source))
        yield from self._leak(iri, finding)

    def _bases(self, finding: Finding) -> list[URIRef]:
        """The legal bases that label files state or a valid decision records; no word of whether they fit."""
        decided = self.individuals.document.decided
        decision = decided.valid(finding) if decided and finding.accepted else None
        recorded = decision.legal_basis if decision else ()
        return [term for basis in (*recorded, *self._processed(finding).bases) for term in legal_basis(basis)]

    def _processed(self, finding: Finding) -> Processed:
        """What label files state of the kind of data where it gets to."""
        return self.processed.get((finding.leak, finding.category)) or Processed(finding.leak, finding.category)

    def _why(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """Who is responsible, what for and on which basis, as label files state it (GDPR, Article 30(1)(a) and (b))."""
        known = self._processed(finding)
        yield from self.individuals.responsible(iri, known.controllers, known.officers, known.purposes)
        yield from about(iri, (RP.statedLegalBasis, map(text, known.bases)), (RP.notStated, map(text, known.missing)))

    def _doing(self, iri: URIRef, finding: Finding, *, derived: bool) -> list[Triple]:
        """What is done with the data, and what could come of it."""
        doing = {OF_KIND[finding.kind], AT_LEAK.get(finding.leak.kind, OF_KIND[finding.kind])}
        if DPV.CrossBorderTransfer in doing:
            doing -= {DPV.Transfer}
        risk = RISK.DataRisk if finding.kind == STORED else RISK.UnwantedDisclosureData
        return about(
            iri,
            (DPV.hasProcessing, [*doing, *([DPV.Derive] if derived else [])]),
            (DPV.hasRisk, [risk, *([RISK.Reidentification] if finding.pseudonymised else [])]),
        )

    def _measure(self, iri: URIRef, measure: URIRef, change: ChangeFact) -> Iterator[Triple]:
        names = {name for name, _ in (change.before, change.after) if name}
        unstated = any((change.element.shown_as, name) in self.unstated for name in names)
        yield iri, DPV.hasTechnicalMeasure, measure
        yield from about(
            measure,
            (RDF.type, [DPV.Pseudonymisation]),
            (RDFS.label, [text(f"pseudonymisation at {shown(change.element.name)}", "en")]),
            (RP.at, [self.individuals.things.element(change.element)]),
            (RP.cleans, self.individuals.things.categories(names)),
            (RP.stated, [Literal(not unstated)]),
        )

    def _leak(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """Who receives the data, and how they are kept."""
        if finding.kind != STORED:
            yield from self.individuals.recipient(iri, finding.leak, on_network=finding.kind == OPEN)
        if finding.leak.kind == "storage":
            yield from self._retention(iri, finding)

    def _retention(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """How long a storage keeps the category, and its backups after that: a condition of its own (rule S9)."""
        leak, facts = finding.leak, self.individuals.document.analysis.outside.get(finding.leak)
        of = () if facts is None or _alike_for_all(facts) else (finding.category,)
        name, what = shown(leak.name), shown(finding.category) if of else "data"
        kept = retention_of(facts, finding.category, self.individuals.document.vocabulary.hierarchy) if facts else []
        whole = self.individuals.names.of("storage-duration", *leak.identity, *of)
        yield from self._condition(iri, whole, finding, f"{name} keeps {what}", [str(one) for one in kept])
        if kept and facts and facts.backups:
            more = [] if facts.backups is True else [str(facts.backups)]
            yield from self._condition(
                iri, below(whole, "backups"), finding, f"{name} then keeps {what} in backups", more
            )

    def _condition(
        self, iri: URIRef, condition: URIRef, finding: Finding, sentence: str, durations: list[str]
    ) -> Iterator[Triple]:
        label = (
            f"{sentence} for {shown(', '.join(durations))}" if durations else f"{sentence}; for how long is not stated"
        )
        yield iri, DPV.hasStorageCondition, condition
        yield from about(
            condition,
            (RDF.type, [DPV.StorageDuration]),
            (RDFS.label, [text(label)]),
            (RP.at, [self.individuals.things.element(finding.leak)]),
            (RP.stated, [Literal(bool(durations))]),
            (DPV.hasDuration, [duration(one) for one in durations]),
        )


def _alike_for_all(facts: NonRosFacts) -> bool:
    """Whether one retention, or none, is stated for all categories."""
    return all(category == EVERY for category, _ in facts.retention)
