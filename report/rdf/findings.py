"""Findings -> RDF: each with its path and its law, and the possible process that it is about (``process.py``).

In: an ``Answer``. Out: an rdflib graph without time or chance in it (rule S14),
which ``serialise.py`` writes. Nothing here is a legal verdict: a provision is one that a person has to look at.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, XSD, Graph, Literal
from rdflib.namespace import PROV

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.findings.processed import of_end
from rosprivacy.report.document.analysis import document
from rosprivacy.report.rdf.concepts import texts
from rosprivacy.report.rdf.facts import changes, emitted_by, kinds_along, label_of, legal_of
from rosprivacy.report.rdf.individuals import below, names_of
from rosprivacy.report.rdf.process import Processes
from rosprivacy.report.rdf.provenance import by_path, digest_of, provenance
from rosprivacy.report.rdf.terms import (
    DPV,
    RISK,
    RP,
    Triple,
    about,
    listed,
    text,
)
from rosprivacy.report.rdf.things import Things
from rosprivacy.report.rdf.typed_channels import type_triples

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from datetime import datetime

    from rdflib import URIRef

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.rdf.individuals import Names

PREFIXES: dict[str, object] = {
    "dpv": DPV, "risk": RISK, "pd": "https://w3id.org/dpv/pd#", "eu-gdpr": "https://w3id.org/dpv/legal/eu/gdpr#",
    "rp": RP, "owl": OWL, "dcterms": DCTERMS, "prov": PROV, "rdf": RDF, "rdfs": RDFS, "skos": SKOS, "xsd": XSD,
}  # fmt: skip
ROLES = {
    "source": RP.sourceOf, "leak": RP.leakOf, "sanitizer": RP.sanitizerOf, "conduit": RP.conduitOf,
    "derivation": RP.derivationOf,
}  # fmt: skip


def rdf_graph(answer: Answer, when: datetime | None = None, base: str | None = None) -> Graph:
    """Return the findings of an analysis, its verdict and where they come from, as RDF.

    Parameters
    ----------
    when
        The time of the run, if it is to be told; None leaves every time out.
    base
        What the IRIs of elements, findings and files begin with; by default a UUID of the system.

    Raises
    ------
    InputError
        If the base is none.

    Notes
    -----
    Takes time linear in the hops of all witnesses and paths.
    """
    analysis, told = answer.shown, document(answer)
    names = names_of(told, base)
    files = by_path(told["assumptions"], names)
    things = Things(answer.vocabulary, names, files, answer.stated, answer.subjects, answer.surroundings)
    findings = _Findings.of(answer, analysis, names, things)
    graph = Graph(bind_namespaces="none")
    for prefix, namespace in PREFIXES.items():
        graph.bind(prefix, str(namespace))
    for triple in provenance(analysis, told, names, things, when):
        graph.add(triple)
    for finding in analysis.findings:
        for triple in findings.triples(finding):
            graph.add(triple)
    for triple in type_triples(answer, names.of("analysis", digest_of(told)), files, things):
        graph.add(triple)
    for triple in things.descriptions():
        graph.add(triple)
    for triple in _robots(answer.fleet, names) if answer.fleet else ():
        graph.add(triple)
    return graph


def _robots(view: FleetView, names: Names) -> Iterator[Triple]:
    """Which robots each finding stands for."""
    for pattern in view.patterns:
        iri = names.finding(pattern.finding)
        yield iri, RP.findings, Literal(pattern.count)
        yield from ((iri, RP.onRobot, text(shown(robot))) for robot in pattern.robots)


@dataclass(frozen=True, slots=True)
class _Findings:
    """What is needed to write any finding.

    Attributes
    ----------
    analysis
        As it is shown.
    accepted
        Of the answer, worked out once.
    emitted
        Source -> categories that it brings in.
    unreviewed
        (element as shown, category) where no label covers what arrives.
    processes
        What a finding is about.
    """

    answer: Answer
    analysis: Analysis
    names: Names
    things: Things
    accepted: Mapping[str, str]
    emitted: Mapping[Element, set[str]]
    unreviewed: frozenset[tuple[object, str]]
    processes: Processes
    contexts: Contexts

    @classmethod
    def of(cls, answer: Answer, analysis: Analysis, names: Names, things: Things) -> _Findings:
        unstated = frozenset((element.shown_as, category) for element, category in analysis.unstated)
        unreviewed = frozenset((q.element.shown_as, category) for q in analysis.open for category in q.categories)
        processes = Processes(answer, names, things, answer.stated, unstated, of_end(answer.processed))
        rest = emitted_by(analysis), unreviewed, processes, answer.contexts
        return cls(answer, analysis, names, things, answer.accepted, *rest)

    def triples(self, finding: Finding) -> Iterator[Triple]:
        """Everything about a finding."""
        iri, things = self.names.finding(finding), self.things
        source, leak = things.element(finding.source), things.element(finding.leak)
        changed = changes(finding, self.emitted.get(finding.source, ()))
        yield from about(
            iri,
            (RDF.type, [RP.Finding, PROV.Entity]),
            (RDFS.label, [text(label_of(finding))]),
            (RP.id, [Literal(finding.id)]),
            (RP.kind, [Literal(finding.kind)]),
            (RP.category, things.categories([finding.category])),
            (RP.dataSource, [source]),
            (RP.leak, [leak]),
            (RP.pseudonymised, [Literal(finding.pseudonymised)]),
            (RP.dismissed, [Literal(finding.dismissed)]),
            (RP.through, [things.element(element) for element in finding.through]),
            (RP.accepted, [text(self.accepted[finding.id])] if finding.id in self.accepted else []),
            (RP.disjointPaths, [Literal(number)] if (number := finding.number_of_paths) else []),
            (RP.concerns, [self.names.process(finding)]),
            (RP.derivedAt, {things.element(change.element) for change in changed if change.derives}),
            (PROV.wasDerivedFrom, {things.line(grant) for step in finding.steps for grant in step.grants}),
        )
        yield from self.processes.triples(finding, changed)
        yield from self._law(iri, finding)
        yield from self._contexts(iri, finding)
        yield from self._witness(iri, finding)
        yield from self._paths(iri, finding)

    def _law(self, iri: URIRef, finding: Finding) -> Iterator[Triple]:
        for number, (legal, names) in enumerate(legal_of(finding, self.answer.vocabulary), 1):
            link = below(iri, "law", number)
            yield iri, RP.fallsUnder, link
            yield from about(
                link,
                (RP.provision, [self.things.provision(legal)]),
                (RP.verdict, [text(legal.verdict)]),
                (RP.condition, texts(legal.condition, legal.translations, "condition")),
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
                (RP.condition, texts(legal.condition, legal.translations, "condition")),
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
