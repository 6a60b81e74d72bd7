"""Findings and register -> RDF: each finding with its path, its law and the possible process that it is about.

In: a ``Document``. Out: an rdflib graph without time or chance in it (rule S14),
which ``serialise.py`` writes. Nothing here is a legal verdict: a provision is one that a person has to look at.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, XSD, Graph, Literal
from rdflib.namespace import PROV

from rosprivacy.analysis.errors import shown
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.document.contents import required
from rosprivacy.report.naming import count_elements
from rosprivacy.report.rdf.individuals import Individuals
from rosprivacy.report.rdf.process import Processes, changes, kinds_along, label_of, legal_of
from rosprivacy.report.rdf.register import register_triples
from rosprivacy.report.rdf.terms import (
    DPV,
    RISK,
    RP,
    Triple,
    about,
    below,
    entries_of,
    files_read,
    listed,
    names_of,
    text,
)
from rosprivacy.report.rdf.things import Things, texts

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from datetime import datetime

    from rdflib import URIRef

    from rosprivacy.analysis.answer import Analysis, ClosedByTypes, Finding, OpenQuestion
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.rdf.terms import IndividualNames

    Files = Mapping[str, Sequence[URIRef]]  # path -> what was read there


PREFIXES: dict[str, object] = {
    "dpv": DPV, "risk": RISK, "pd": "https://w3id.org/dpv/pd#", "eu-gdpr": "https://w3id.org/dpv/legal/eu/gdpr#",
    "rp": RP, "owl": OWL, "dcterms": DCTERMS, "prov": PROV, "rdf": RDF, "rdfs": RDFS, "skos": SKOS, "xsd": XSD,
}  # fmt: skip
ROLES = {
    "source": RP.sourceOf, "leak": RP.leakOf, "sanitizer": RP.sanitizerOf, "conduit": RP.conduitOf,
    "derivation": RP.derivationOf,
}  # fmt: skip


def rdf_graph(document: Document, when: datetime | None = None, base: str | None = None) -> Graph:
    """Return the findings of an analysis, its register and verdict, and where they come from, as RDF.

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
    Takes time linear in the hops of all witnesses and paths, and the cells of the register.
    """
    analysis, entries = document.analysis, json_document(document)
    names = names_of(entries, base)
    files = by_path(entries["assumptions"], names)
    things = Things(document, names, files)
    individuals = Individuals(document, names, things)
    findings, answer = _Findings.of(individuals), names.of("analysis", digest_of(entries))
    graph = Graph(bind_namespaces="none")
    for prefix, namespace in PREFIXES.items():
        graph.bind(prefix, str(namespace))
    for triple in provenance(analysis, entries, names, things, when):
        graph.add(triple)
    for finding in analysis.findings:
        for triple in findings.triples(finding):
            graph.add(triple)
    for triple in register_triples(answer, individuals):
        graph.add(triple)
    for triple in type_triples(document, answer, files, things):
        graph.add(triple)
    for triple in things.descriptions():
        graph.add(triple)
    for triple in _robots(document.fleet, names) if document.fleet else ():
        graph.add(triple)
    return graph


def _robots(view: FleetView, names: IndividualNames) -> Iterator[Triple]:
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
    unreviewed
        (element as shown, category) where no label covers what arrives.
    processes
        What a finding is about.
    """

    document: Document
    names: IndividualNames
    things: Things
    unreviewed: frozenset[tuple[object, str]]
    processes: Processes

    @classmethod
    def of(cls, individuals: Individuals) -> _Findings:
        document, names, things = individuals.document, individuals.names, individuals.things
        analysis = document.analysis
        unstated = frozenset((element.shown_as, category) for element, category in analysis.unstated)
        unreviewed = frozenset((q.element.shown_as, category) for q in analysis.open for category in q.categories)
        processed = {(row.element, row.category): row for row in required(document.processing).by_kind}
        processes = Processes(individuals, unstated, processed)
        return cls(document, names, things, unreviewed, processes)

    def triples(self, finding: Finding) -> Iterator[Triple]:
        """Everything about a finding."""
        iri, things, accepted = self.names.finding(finding), self.things, self.document.accepted
        source, leak = things.element(finding.source), things.element(finding.leak)
        changed = changes(finding, self.document.brought_in.get(finding.source, ()))
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
            (RP.accepted, [text(accepted[finding.id])] if finding.id in accepted else []),
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
        for number, (legal, names) in enumerate(legal_of(finding, self.document.vocabulary), 1):
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
        for number, legal in enumerate(self.document.contexts.revealed(finding), 1):
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
            yield from self._label_notes(hop, element, here)

    def _label_notes(self, hop: URIRef, element: Element, categories: set[str]) -> Iterator[Triple]:
        """What labels say of an element about the data that is there, or that they say nothing."""
        said = self.document.analysis.roles.get(element, {})
        for name in categories:
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


NO_VERDICT = "Labels are a person's word, and a path can be lawful. This is no legal verdict."


def by_path(assumptions: Mapping[str, Any], names: IndividualNames) -> dict[str, tuple[URIRef, ...]]:
    """Return path -> IRIs of what was read there; several where robots were loaded at different times."""
    found: dict[str, dict[URIRef, None]] = {}
    for _, file, sha256 in files_read(assumptions):
        found.setdefault(file, {})[names.file(file, sha256)] = None
    return {file: tuple(iris) for file, iris in found.items()}


def provenance(
    analysis: Analysis, document: Mapping[str, Any], names: IndividualNames, things: Things, when: datetime | None
) -> Iterator[Triple]:
    """Say what the run was, what it rests on and what it concluded.

    Parameters
    ----------
    document
        The JSON document of the analysis.
    when
        The time to tell, or None.
    """
    digest = digest_of(document)
    run, answer, assumptions = names.of("run", digest), names.of("analysis", digest), document["assumptions"]
    read = files_read(assumptions)
    moment = [Literal(when)] if when else []
    yield from about(
        answer,
        (RDF.type, [RP.Analysis, PROV.Entity]),
        (RDFS.comment, [text(NO_VERDICT, "en")]),
        (RP.outcome, [text(document["verdict"])]),
        (RP.view, [text(document["view"])]),
        (RP.followed, things.categories(analysis.emitted)),
        (RP.found, [names.finding(finding) for finding in analysis.findings]),
        (RP.lookAt, things.pointed(one["provision"] for one in document["look_at"] if not one["categories"])),
        (RP.openElements, [Literal(count_elements(q.element for q in analysis.open).elements)]),
        (PROV.wasGeneratedBy, [run]),
        (PROV.generatedAtTime, moment),
    )
    yield from about(
        run,
        (RDF.type, [PROV.Activity]),
        (PROV.used, {names.file(file, sha256) for _, file, sha256 in read}),
        (PROV.endedAtTime, moment),
    )
    yield from _tool(run, assumptions, names)
    for kind, file, sha256 in read:
        yield from about(
            names.file(file, sha256),
            (RDF.type, [PROV.Entity, RP.SourceFile]),
            (RP.file, [text(file)]),
            (RP.sha256, [Literal(sha256)]),
            (RP.readAs, [Literal(kind)]),
        )
    for finding in analysis.findings:
        yield names.finding(finding), PROV.wasGeneratedBy, run
    yield from _assumptions(answer, assumptions)
    for number, diagnostic in enumerate(document["diagnostics"], 1):
        yield from _diagnostic(answer, number, diagnostic)
    for number, question in enumerate(analysis.open, 1):
        yield from _open(answer, number, question, things)


def digest_of(document: Mapping[str, Any]) -> str:
    """Return what names the run and its answer."""
    return hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()[:16]


def _tool(run: URIRef, assumptions: Mapping[str, Any], names: IndividualNames) -> Iterator[Triple]:
    version = assumptions["rosprivacy"]
    tool = names.of("tool", version)
    yield from about(run, (PROV.wasAssociatedWith, [tool]))
    yield from about(
        tool,
        (RDF.type, [PROV.SoftwareAgent]),
        (RDFS.label, [text(f"rosprivacy {version}")]),
        (RP.version, [text(version)]),
    )


def _assumptions(answer: URIRef, assumptions: Mapping[str, Any]) -> Iterator[Triple]:
    """Every assumption of the document but lists of files; what is not text stands there as JSON."""
    for name, value in sorted(assumptions.items()):
        if isinstance(value, list) and any(entries_of(value)):
            continue
        iri = below(answer, "assumption", name)
        shown = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, sort_keys=True)
        yield from about(answer, (RP.assumes, [iri]))
        yield from about(iri, (RDF.type, [RP.Assumption]), (RP.name, [text(name)]), (RP.value, [text(shown)]))


def _diagnostic(answer: URIRef, number: int, diagnostic: Mapping[str, Any]) -> Iterator[Triple]:
    iri = below(answer, "diagnostic", number)
    yield from about(answer, (RP.diagnostic, [iri]))
    yield from about(
        iri,
        (RDF.type, [RP.Diagnostic]),
        (RP.severity, [text(diagnostic["severity"])]),
        (RP.message, [text(diagnostic["message"])]),
        (RP.file, [text(diagnostic["file"])]),
        (RP.line, [Literal(diagnostic["line"])]),
    )


def _open(answer: URIRef, number: int, question: OpenQuestion, things: Things) -> Iterator[Triple]:
    """An element that no label covers for what gets to it (rule S11), in the order of review."""
    iri = below(answer, "open", number)
    yield from about(answer, (RP.open, [iri]))
    yield from about(
        iri,
        (RDF.type, [RP.OpenQuestion]),
        (RP.position, [Literal(number)]),
        (RP.element, [things.element(question.element)]),
        (RP.openFor, things.categories(question.categories)),
        (RP.distance, [Literal(question.distance)]),
        (RP.frontier, [Literal(question.frontier)]),
        (RP.notStated, map(text, question.missing)),
    )


def type_triples(document: Document, iri: URIRef, files: Files, things: Things) -> Iterator[Triple]:
    """Return the types of each channel, from where each is known; the limits that closed something, and what.

    Parameters
    ----------
    iri
        Of the answer.
    """
    for number, (channel, types) in enumerate(document.types, 1):
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
    if document.analysis.closed:
        yield from _closed(document.analysis.closed, iri, things)


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
