"""Findings -> RDF: each a ``dpv:Process`` with its data, its path and its law, in the words of DPV 2.3 and our own.

In: an ``Answer``. Out: an rdflib graph without time or chance in it (rule S14),
which ``serialise.py`` writes. Nothing here is a legal verdict: a provision is one that a person has to look at.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rdflib import RDF, RDFS, SKOS, XSD, Graph, Literal
from rdflib.namespace import PROV

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.non_ros import EVERY, INSIDE, retention_of
from rosprivacy.report.document.whole import document
from rosprivacy.report.rdf.facts import changes, emitted_by, foreign_terms, kinds_along, legal_of
from rosprivacy.report.rdf.provenance import by_path, provenance
from rosprivacy.report.rdf.terms import (
    DPV,
    OWN,
    RISK,
    RP,
    Triple,
    about,
    below,
    duration,
    finding_iri,
    foreign,
    legal_basis,
    listed,
    named,
    text,
)
from rosprivacy.report.rdf.things import Things

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from datetime import datetime

    from rdflib import URIRef
    from rdflib.term import Node

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.model import Element, NonRosFacts
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.rdf.facts import Change
    from rosprivacy.report.rdf.things import Stated

PREFIXES: dict[str, object] = {
    "dpv": DPV, "risk": RISK, "pd": "https://w3id.org/dpv/pd#", "eu-gdpr": "https://w3id.org/dpv/legal/eu/gdpr#",
    "rp": OWN, "prov": PROV, "rdf": RDF, "rdfs": RDFS, "skos": SKOS, "xsd": XSD,
}  # fmt: skip
STORED = "storage-limitation"
OF_KIND = {"disclosure": DPV.Disclose, STORED: DPV.Store, "third-country-transfer": DPV.CrossBorderTransfer}
PARTIES = {
    "controller": DPV.DataController, "joint-controller": DPV.JointDataControllers, "processor": DPV.DataProcessor,
    "third-party": DPV.ThirdParty,
}  # fmt: skip
AT_LEAK = {"storage": DPV.Store, "external-system": DPV.Transfer}
ROLES = {
    "source": RP.sourceOf, "leak": RP.leakOf, "sanitizer": RP.sanitizerOf, "conduit": RP.conduitOf,
    "derivation": RP.derivationOf,
}  # fmt: skip


def rdf_graph(answer: Answer, when: datetime | None = None) -> Graph:
    """Return the findings of an analysis, its verdict and where they come from, as RDF.

    Parameters
    ----------
    when
        The time of the run, if it is to be told; None leaves every time out.

    Notes
    -----
    Takes time linear in the hops of all witnesses and paths.
    """
    analysis, told = answer.shown, document(answer)
    things = Things(
        answer.vocabulary, by_path(told["assumptions"]), answer.stated, answer.subjects, answer.surroundings
    )
    findings = _Findings.of(answer, analysis, things)
    graph = Graph(bind_namespaces="none")
    for prefix, namespace in PREFIXES.items():
        graph.bind(prefix, str(namespace))
    for triple in provenance(analysis, told, things, when):
        graph.add(triple)
    for finding in analysis.findings:
        for triple in findings.triples(finding):
            graph.add(triple)
    for triple in things.descriptions():
        graph.add(triple)
    for triple in _robots(answer.fleet) if answer.fleet else ():
        graph.add(triple)
    return graph


def _robots(view: FleetView) -> Iterator[Triple]:
    """Which robots each finding stands for."""
    for pattern in view.patterns:
        iri = finding_iri(pattern.finding)
        yield iri, RP.findings, Literal(pattern.count)
        yield from ((iri, RP.onRobot, text(shown(robot))) for robot in pattern.robots)


@dataclass(frozen=True, slots=True)
class _Findings:
    """What is needed to write any finding.

    Attributes
    ----------
    analysis
        As it is shown.
    stated, accepted
        Those of the answer, worked out once.
    emitted
        Source -> categories that it brings in.
    unstated, unreviewed
        (element as shown, category) where a method is not stated, or no label covers what arrives.
    """

    answer: Answer
    analysis: Analysis
    things: Things
    stated: Stated
    accepted: Mapping[str, str]
    emitted: Mapping[Element, set[str]]
    unstated: frozenset[tuple[object, str]]
    unreviewed: frozenset[tuple[object, str]]
    contexts: Contexts

    @classmethod
    def of(cls, answer: Answer, analysis: Analysis, things: Things) -> _Findings:
        unstated = frozenset((element.shown_as, category) for element, category in analysis.unstated)
        unreviewed = frozenset((q.element.shown_as, category) for q in analysis.open for category in q.categories)
        emitted = emitted_by(analysis)
        return cls(
            answer, analysis, things, answer.stated, answer.accepted, emitted, unstated, unreviewed, answer.contexts
        )

    def triples(self, finding: Finding) -> Iterator[Triple]:
        """Everything about a finding."""
        iri, things = finding_iri(finding), self.things
        source, leak = things.element(finding.source), things.element(finding.leak)
        yield from about(
            iri,
            (RDF.type, [DPV.Process, RP.Finding]),
            (RDFS.label, [text(shown(f"{finding.category}: {finding.source.name} -> {finding.leak.name}"))]),
            (RP.id, [Literal(finding.id)]),
            (RP.kind, [Literal(finding.kind)]),
            (RP.category, things.categories([finding.category])),
            (RP.dataSource, [source]),
            (RP.leak, [leak]),
            (RP.pseudonymised, [Literal(finding.pseudonymised)]),
            (RP.dismissed, [Literal(finding.dismissed)]),
            (RP.through, [things.element(element) for element in finding.through]),
            (RP.accepted, [text(self.accepted[finding.id])] if finding.id in self.accepted else []),
            (RP.disjointPaths, [Literal(finding.disjoint_paths)]),
            (DPV.hasDataSource, [source]),
            (DPV.hasPersonalData, self._data(finding)),
            (DPV.hasLegalBasis, self._bases(finding)),
        )
        yield source, RDF.type, DPV.DataSource
        changed = changes(finding, self.emitted.get(finding.source, ()))
        yield from self._processing(iri, finding, changed)
        for number, change in enumerate((change for change in changed if change.pseudonymises), 1):
            yield from self._measure(iri, below(iri, "measure", number), change)
        yield from self._persons(iri, finding)
        yield from self._leak(iri, finding)
        yield from self._law(iri, finding)
        yield from self._contexts(iri, finding)
        yield from self._witness(iri, finding)
        yield from self._paths(iri, finding)

    def _data(self, finding: Finding) -> list[Node]:
        terms = [foreign(term) for term in foreign_terms(finding.category, self.answer.vocabulary)]
        form = [DPV.PseudonymisedData] if finding.pseudonymised else []
        return [*self.things.categories([finding.category]), *terms, *form]

    def _bases(self, finding: Finding) -> list[URIRef]:
        """The legal bases that a valid decision to accept the finding records; no word of whether they fit."""
        decision = self.answer.decided.valid(finding) if self.answer.decided and finding.accepted else None
        return [term for basis in (decision.legal_basis if decision else ()) for term in legal_basis(basis)]

    def _persons(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """Whose data they are, as labels of the source name them (GDPR, Article 30(1)(c))."""
        for group in self.things.subjects(finding.source):
            persons = named("subject", group)
            yield iri, DPV.hasDataSubject, persons
            yield from about(persons, (RDF.type, [DPV.DataSubject]), (RDFS.label, [text(shown(group))]))

    def _processing(self, iri: URIRef, finding: Finding, changed: list[Change]) -> list[Triple]:
        """What is done with the data, and what could come of it."""
        doing = {OF_KIND[finding.kind], AT_LEAK.get(finding.leak.kind, OF_KIND[finding.kind])}
        if DPV.CrossBorderTransfer in doing:
            doing -= {DPV.Transfer}
        derived = {self.things.element(change.element) for change in changed if change.derives}
        risk = RISK.DataRisk if finding.kind == STORED else RISK.UnwantedDisclosureData
        return about(
            iri,
            (DPV.hasProcessing, [*doing, *([DPV.Derive] if derived else [])]),
            (DPV.hasRisk, [risk, *([RISK.Reidentification] if finding.pseudonymised else [])]),
            (RP.derivedAt, derived),
        )

    def _measure(self, iri: URIRef, measure: URIRef, change: Change) -> Iterator[Triple]:
        names = {name for name, _ in (change.before, change.after) if name}
        unstated = any((change.element.shown_as, name) in self.unstated for name in names)
        yield iri, DPV.hasTechnicalMeasure, measure
        yield from about(
            measure,
            (RDF.type, [DPV.Pseudonymisation]),
            (RDFS.label, [text(f"pseudonymisation at {shown(change.element.name)}", "en")]),
            (RP.at, [self.things.element(change.element)]),
            (RP.cleans, self.things.categories(names)),
            (RP.stated, [Literal(not unstated)]),
        )

    def _leak(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """Who receives the data, and how they are kept: whoever stands behind a leak, as software receives nothing."""
        leak = finding.leak
        known, name, at = self.stated.get(leak.identity, {}), shown(leak.name), self.things.element(leak)
        if finding.kind != STORED:
            recipient = named("recipient", *leak.identity)
            label = shown(known["operator"]) if "operator" in known else f"whoever receives what {name} lets out"
            yield iri, DPV.hasRecipient, recipient
            role = PARTIES.get(known.get("role", ""))
            yield from about(recipient, (RDF.type, [DPV.Recipient, *([role] if role else [])]))
            yield from about(recipient, (RDFS.label, [text(label)]), (RP.at, [at]))
            yield from self._country(recipient, leak)
        if leak.kind == "storage":
            yield from self._kept(iri, finding)

    def _kept(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """How long a storage keeps the category, and its backups after that: a condition of its own (rule S9)."""
        leak, facts = finding.leak, self.analysis.outside.get(finding.leak)
        of = () if facts is None or _alike_for_all(facts) else (finding.category,)
        name, what = shown(leak.name), shown(finding.category) if of else "data"
        kept = retention_of(facts, finding.category, self.answer.vocabulary.hierarchy) if facts else []
        whole = named("storage-duration", *leak.identity, *of)
        yield from self._condition(iri, whole, finding, f"{name} keeps {what}", [str(one) for one in kept])
        if kept and facts and facts.backups:
            more = [] if facts.backups is True else [str(facts.backups)]
            yield from self._condition(
                iri, below(whole, "backups"), finding, f"{name} then keeps {what} in backups", more
            )

    def _condition(
        self, iri: URIRef, condition: URIRef, finding: Finding, what: str, durations: list[str]
    ) -> Iterator[Triple]:
        label = f"{what} for {shown(', '.join(durations))}" if durations else f"{what}; for how long is not stated"
        yield iri, DPV.hasStorageCondition, condition
        yield from about(
            condition,
            (RDF.type, [DPV.StorageDuration]),
            (RDFS.label, [text(label)]),
            (RP.at, [self.things.element(finding.leak)]),
            (RP.stated, [Literal(bool(durations))]),
            (DPV.hasDuration, [duration(one) for one in durations]),
        )

    def _country(self, recipient: URIRef, leak: Element) -> Iterator[Triple]:
        """Where a recipient is, and whether that is a third country (GDPR, chapter V)."""
        facts = self.analysis.outside.get(leak)
        if facts is None or not facts.country:
            return
        country = named("country", facts.country)
        third = [DPV.ThirdCountry] if facts.area != INSIDE else []
        yield recipient, DPV.hasCountry, country
        yield from about(country, (RDF.type, [DPV.Country, *third]), (RP.country, [text(facts.country)]))

    def _law(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        for number, (legal, names) in enumerate(legal_of(finding, self.answer.vocabulary), 1):
            link = below(iri, "law", number)
            yield iri, RP.fallsUnder, link
            yield from about(
                link,
                (RP.provision, [self.things.provision(legal)]),
                (RP.verdict, [text(legal.verdict)]),
                (RP.condition, [text(legal.condition, "en")] if legal.condition else []),
                (RP.statedOf, self.things.categories(names)),
            )

    def _contexts(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """What the data may reveal where their source works: a fact about the place, no verdict."""
        for number, legal in enumerate(self.contexts.revealed(finding), 1):
            link = below(iri, "context", number)
            yield iri, RP.inContext, link
            yield from about(
                link,
                (RP.context, [text(legal.context)]),
                (RP.provision, [self.things.provision(legal)]),
                (RP.verdict, [text(legal.verdict)]),
                (RP.condition, [text(legal.condition, "en")]),
            )

    def _witness(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """The shortest path, element by element, with what arrives and leaves and the lines that allow it."""
        kinds = kinds_along(finding)
        hops = [below(iri, "hop", number) for number in range(1, len(kinds) + 1)]
        first, cells = listed(hops)
        yield iri, RP.witness, first
        yield from cells
        for number, (hop, element, (leaving, form)) in enumerate(zip(hops, finding.witness, kinds, strict=True)):
            yield from about(
                hop,
                (RDF.type, [RP.Hop]),
                (RP.position, [Literal(number + 1)]),
                (RP.element, [self.things.element(element)]),
                (RP.leavesAs, self.things.categories([leaving])),
                (RP.leavesPseudonymised, [Literal(form)]),
            )
            here = {leaving}
            if number:
                step = finding.steps[number - 1]
                here.add(step.category)
                yield from about(
                    hop,
                    (RP.by, [Literal(step.role)]),
                    (RP.arrivesAs, self.things.categories([step.category])),
                    (RP.arrivesPseudonymised, [Literal(step.pseudonymised)]),
                    (RP.allowedBy, [self.things.line(grant) for grant in step.grants]),
                )
            yield from self._said(hop, element, here)

    def _said(self, hop: URIRef, element: Element, here: set[str]) -> Iterator[Triple]:
        """What labels say of an element about the data that is there, or that they say nothing."""
        said = self.analysis.roles.get(element, {})
        for name in here:
            category = self.things.categories([name])
            yield from about(hop, *((ROLES[role], category) for role in said.get(name, ()) if role in ROLES))
            if (element.shown_as, name) in self.unreviewed:
                yield from about(hop, (RP.notReviewedFor, category))

    def _paths(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        """Further paths, if they were asked for."""
        for number, path in enumerate(finding.paths, 1):
            resource = below(iri, "path", number)
            elements, cells = listed([self.things.element(element) for element in path])
            yield iri, RP.path, resource
            yield from cells
            yield from about(
                resource, (RDF.type, [RP.Path]), (RP.position, [Literal(number)]), (RP.elements, [elements])
            )
        if finding.paths:
            yield iri, RP.pathsBounded, Literal(finding.bounded)


def _alike_for_all(facts: NonRosFacts) -> bool:
    """Whether one retention, or none, is stated for all categories."""
    return all(category == EVERY for category, _ in facts.retention)
