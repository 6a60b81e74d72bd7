"""The run as PROV: which program read which files, what it concluded, what it assumed, what it leaves open.

In: an ``Analysis`` and its JSON document, whose hash names the run, so that results of several runs can stand side by
side. Out: triples. There is no time in them but one that the caller gives (rule S14).
"""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING, Any

from rdflib import RDF, RDFS, Literal
from rdflib.namespace import PROV

from rosprivacy.report.element_counts import count_elements
from rosprivacy.report.rdf.individuals import below, entries_of, files_read
from rosprivacy.report.rdf.terms import RP, Triple, about, text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from datetime import datetime

    from rdflib import URIRef

    from rosprivacy.analysis.answer import Analysis, OpenQuestion
    from rosprivacy.report.rdf.individuals import Names
    from rosprivacy.report.rdf.things import Things

NO_VERDICT = "Labels are a person's word, and a path can be lawful. This is no legal verdict."


def by_path(assumptions: Mapping[str, Any], names: Names) -> dict[str, tuple[URIRef, ...]]:
    """Return path -> IRIs of what was read there; several where robots were loaded at different times."""
    found: dict[str, dict[URIRef, None]] = {}
    for _, file, sha256 in files_read(assumptions):
        found.setdefault(file, {})[names.file(file, sha256)] = None
    return {file: tuple(iris) for file, iris in found.items()}


def provenance(
    analysis: Analysis, document: Mapping[str, Any], names: Names, things: Things, when: datetime | None
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


def _tool(run: URIRef, assumptions: Mapping[str, Any], names: Names) -> Iterator[Triple]:
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
