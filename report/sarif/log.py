"""Analysis -> SARIF 2.1.0, for code scanning and editors: each finding at the line that allows it, with the path there.

In: a ``Document``. Out: plain dicts and lists, sorted, with no time in them
(rule S14). Nothing is suppressed by itself: only what a person accepted, and that stays in the file.

Limits are those of the viewers (GitHub: 25,000 results in a run, 10,000 locations of paths and 1,000 others in a
result; other viewers show the first path only). What is cut is counted in a notification.
"""

from __future__ import annotations

from itertools import chain, islice
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.legal import strongest_first
from rosprivacy.analysis.model import NO_LEAK_NAMED, Place, Rank, Severity
from rosprivacy.analysis.policy_lines import in_a_file
from rosprivacy.analysis.text import counted, utf8
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.analysis import verdict_facts
from rosprivacy.report.document.contents import required
from rosprivacy.report.naming import ElementCount, count_elements
from rosprivacy.report.places import to_review
from rosprivacy.report.robots import note, on_robots
from rosprivacy.report.sarif.locations import further_paths, prose, text
from rosprivacy.report.sarif.results import FINDING, LAW, ROOT, Files, Results, added_results
from rosprivacy.report.sarif.rules import (
    BEYOND_PROFILE,
    NO_LEAK,
    NO_VERDICT,
    NOTHING_FOLLOWED,
    RULES,
    UNREVIEWED,
    descriptors,
    rule_of,
    rule_of_doubt,
)
from rosprivacy.report.verdict import phrase, verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern
    from rosprivacy.analysis.model import Diagnostic, Legal, Pointer
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.sarif.rules import SarifRule

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
MAX_RESULTS = 25_000
MAX_LOCATIONS = 200_000  # of paths in the whole file, some 120 MB
MAX_NOTIFICATIONS = 1_000
LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTICE: "note"}


def sarif(document: Document, root: Path) -> dict[str, Any]:
    """Return the analysis as a SARIF log of one run; of a fleet with the robots of each finding.

    Parameters
    ----------
    root
        Absolute folder that files are shown relative to: the root of the repository.
    """
    log = _log(document, root)
    return _with_robots(log, document.fleet, document.counts) if document.fleet and document.counts else log


def _log(document: Document, root: Path) -> dict[str, Any]:
    analysis, categories, assumptions = document.analysis, document.vocabulary.categories, document.assumptions
    files, diagnostics = Files(root), document.diagnostics
    law = {name: strongest_first(categories[name].law) for name in analysis.emitted}
    contexts, pointed = document.contexts, document.vocabulary.pointed
    positions = required(document.positions)
    said: list[Legal | Pointer] = [legal for several in law.values() for legal in several]
    for finding in analysis.findings:
        said += (*contexts.revealed(finding), *pointed.of_finding(finding.kind))
    taxa = sorted({legal.iri: legal for legal in said}.values(), key=lambda legal: legal.name)
    found = (rule_of(finding.kind) for finding in analysis.findings)
    facts = verdict_facts(analysis, document.doubts, assumptions)
    rows = zip(document.doubts, facts["doubts"], strict=True)
    in_doubt = tuple((doubt, doubt.message or phrase([row], IN_ENGLISH)) for doubt, row in rows)
    of_doubts = [rule_of_doubt(doubt.name, breaks=doubt.rank is Rank.BREAKS) for doubt in document.doubts]
    not_named = [NO_LEAK] if analysis.lacking == NO_LEAK_NAMED else []
    beyond = [BEYOND_PROFILE] if document.enforced else []
    told = (*RULES, *found, UNREVIEWED, NOTHING_FOLLOWED, *not_named, *of_doubts, *beyond)
    rules = {rule.id: rule for rule in told}
    made = Results(
        analysis,
        positions.places,
        files,
        categories,
        law,
        taxa={legal.iri: number for number, legal in enumerate(taxa)},
        rules={name: number for number, name in enumerate(rules)},
        between=positions.flows,
        accepted=document.accepted,
        contexts=contexts,
        pointed=pointed,
        doubts=in_doubt,
    )
    all_results = made.all()
    if document.enforced:
        all_results = chain(all_results, added_results(document.enforced, made.rules[BEYOND_PROFILE.id], files))
    results = list(_within(islice(all_results, MAX_RESULTS)))
    notices = [
        *_about(document, results, verdict_sentence(facts)),
        *_reading_notes((*diagnostics, *analysis.diagnostics), files),
    ]
    run = {
        "tool": {"driver": _driver(str(assumptions.get("rosprivacy", "")), rules.values(), taxonomy=bool(taxa))},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {ROOT: {"description": {"text": "The root of the repository."}}},
        "invocations": [{"executionSuccessful": True, "toolExecutionNotifications": notices}],
        "artifacts": list(_artifacts(assumptions, files)),
        **({"taxonomies": [_taxonomy(taxa)]} if taxa else {}),
        "results": results,
        "properties": {
            "verdict": str(analysis.verdict),
            "sentence": verdict_sentence(facts),
            "view": analysis.graph.view,
            "unreviewedElements": _unreviewed(analysis).elements,
            "standardChannels": analysis.standard_channels,
            "assumptions": _without_half_characters(assumptions),
        },
    }
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _driver(version: str, rules: Iterable[SarifRule], *, taxonomy: bool) -> dict[str, Any]:
    """The program, with the rules that results name."""
    return {
        "name": "rosprivacy",
        "version": version,
        "shortDescription": {"text": "Where personal data can go in a ROS 2 system, by its SROS 2 policies."},
        "fullDescription": {"text": NO_VERDICT},
        "rules": descriptors(rules),
        **({"supportedTaxonomies": [{"name": LAW, "index": 0}]} if taxonomy else {}),
    }


def _within(results: Iterable[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Results whose paths together have no more locations than the bound: further paths go first, then the witness."""
    room = MAX_LOCATIONS
    for result in results:
        kept = []
        for flow in result.get("codeFlows", ()):
            room -= len(flow["threadFlows"][0]["locations"])
            if room < 0:
                break
            kept.append(flow)
        yield {**result, "codeFlows": kept} if kept else {k: v for k, v in result.items() if k != "codeFlows"}


def _taxonomy(taxa: Sequence[Legal | Pointer]) -> dict[str, Any]:
    """The provisions that results point to, each with its meaning and the date of the law (rule S12)."""
    return {
        "name": LAW,
        "version": max(legal.as_of for legal in taxa),
        "shortDescription": {"text": "Provisions of data protection law that a person has to check."},
        "fullDescription": {"text": f"Their meaning in one sentence of our own. {NO_VERDICT}"},
        "contents": ["localizedData", "nonLocalizedData"],
        "isComprehensive": False,
        "taxa": [
            {
                "id": legal.name,
                "shortDescription": {"text": legal.meaning or legal.name},
                "properties": {"iri": legal.iri, "asOf": legal.as_of},
            }
            for legal in taxa
        ],
    }


def _artifacts(assumptions: Mapping[str, Any], files: Files) -> Iterator[dict[str, Any]]:
    """What was read, with its hash (rule S12)."""
    standard = assumptions.get("standard_channels")
    read = {
        "analysisTarget": assumptions.get("policies") or (),
        "userSpecifiedConfiguration": [
            entry
            for kind in ("project", "fleet", "types", "labels", "ontologies")
            for entry in assumptions.get(kind) or ()
        ],
        "toolSpecifiedConfiguration": [entry for entry in (standard, assumptions.get("type_limits")) if entry],
    }
    for role, entries in read.items():
        for entry in entries:
            own = in_a_file(Place(entry["file"], 1))
            location = files.artifact(entry["file"]) if own else {"description": {"text": text(entry["file"])}}
            yield {"location": location, "roles": [role], "hashes": {"sha-256": entry["sha256"]}}


def _unreviewed(analysis: Analysis) -> ElementCount:
    return count_elements(question.element for question in analysis.open)


def _about(document: Document, results: Sequence[Mapping[str, Any]], sentence: str) -> Iterator[dict[str, Any]]:
    """The verdict with what is open, and what was left out of the file."""
    analysis, added = document.analysis, document.enforced.added if document.enforced else ()
    count = _unreviewed(analysis)
    are = "is" if count.elements == 1 else "are"
    unreviewed = f"{counted(count.elements, 'element')} that data reaches {are} not reviewed{count.remark}"
    yield _notice("note" if not analysis.open else "warning", "verdict", f"{sentence}; {unreviewed}. {NO_VERDICT}")
    findings = [*analysis.findings, *(one.finding for one in added)]
    left_out = len(findings) + len(to_review(analysis)) + len(document.doubts) - len(results)
    if left_out > 0:
        yield _notice("warning", "bound", f"{left_out} results are left out: a viewer takes {MAX_RESULTS} at most.")
    left = sum(1 + further_paths(finding) for finding in findings)
    left -= sum(len(result.get("codeFlows", ())) for result in results)
    if left:
        yield _notice("note", "bound", f"{left} paths of findings are left out; --format json lists them.")
    bounded = sum(finding.bounded for finding in analysis.findings)
    if bounded:
        yield _notice("note", "bound", f"{bounded} findings have more paths than were looked for (--max-paths).")


def _reading_notes(diagnostics: Sequence[Diagnostic], files: Files) -> Iterator[dict[str, Any]]:
    """What the inputs were read with."""
    for diagnostic in diagnostics[:MAX_NOTIFICATIONS]:
        notice = _notice(LEVELS[diagnostic.severity], "input", prose(diagnostic.message))
        if in_a_file(diagnostic.place):
            notice["locations"] = [{"physicalLocation": files.physical(diagnostic.place)}]
        yield notice
    left_out = len(diagnostics) - MAX_NOTIFICATIONS
    if left_out > 0:
        yield _notice("note", "bound", f"{left_out} notes on the inputs are left out; --format json lists them.")


def _notice(level: str, name: str, message: str) -> dict[str, Any]:
    return {"level": level, "descriptor": {"id": name}, "message": {"text": message}}


def _without_half_characters(value: Any) -> Any:
    """Return plain data without half characters (of a file name that is no UTF-8), which some readers refuse."""
    if isinstance(value, str):
        return utf8(value)
    if isinstance(value, dict):
        return {_without_half_characters(key): _without_half_characters(part) for key, part in value.items()}
    return [_without_half_characters(part) for part in value] if isinstance(value, list | tuple) else value


def _with_robots(log: dict[str, Any], view: FleetView, counts: Counts) -> dict[str, Any]:
    """A log in which each result of a finding tells on which robots it is, not only the one that is shown."""
    patterns = {pattern.finding.id: pattern for pattern in view.patterns}
    (run,) = log["runs"]
    results = [_on_its_robots(result, patterns, view) for result in run["results"]]
    invocation = run["invocations"][0]
    notices = [*invocation["toolExecutionNotifications"], _notice("note", "fleet", f"{note(view)}.")]
    invocations = [{**invocation, "toolExecutionNotifications": notices}]
    channels = {"standardChannels": counts.standard_channels}
    properties = {**run["properties"], **channels, "robots": sum(map(len, view.likeness.members.values()))}
    return {**log, "runs": [{**run, "invocations": invocations, "results": results, "properties": properties}]}


def _on_its_robots(result: dict[str, Any], patterns: dict[str, Pattern], view: FleetView) -> dict[str, Any]:
    pattern = patterns.get(result.get("partialFingerprints", {}).get(FINDING, ""))
    if pattern is None:
        return result
    message = {**result["message"], "text": f"{result['message']['text']} {on_robots(pattern, view)}"}
    more = {
        "robots": list(map(shown, pattern.robots)),
        "pattern": pattern.id,
        "findings": pattern.count,
        "findingsDismissed": pattern.dismissed,
        "findingsPseudonymised": pattern.pseudonymised,
    }
    return {**result, "message": message, "properties": {**result["properties"], **more}}
