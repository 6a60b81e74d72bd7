"""What people state of purposes, legal bases and who is responsible, for the JSON document: as stated, and by kind.

In: an ``Answer``. Out: plain dicts and lists, sorted; the keys are left out where nobody states anything.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.document.element_entry import element_dict

if TYPE_CHECKING:
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.model import ByCategory, Processing
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.analysis import AnalysisDocument
    from rosprivacy.report.contract.stated import ProcessedEntry, ProcessingEntry


def with_processing(made: AnalysisDocument, answer: Answer) -> AnalysisDocument:
    """Return a document with what is stated of processing; of robots that are alike of one."""
    beside = answer.fleet.likeness.second if answer.fleet else ()
    stated: list[ProcessingEntry] = []
    for robot, said in answer.bound.of_robots.items():
        if robot not in beside:
            stated.append(_stated(said))
            stated[-1]["robot"] = robot
    for vertex, said in sorted(answer.bound.processing.items()):
        element = answer.analysis.graph.elements[vertex]
        if element.robot not in beside:
            stated.append(_stated(said))
            stated[-1]["element"] = element_dict(element)
    if stated:
        made["processing"] = stated
    if by_kind := [_processed(row) for row in answer.processed]:
        made["processed_for"] = by_kind
    return made


def _stated(said: Processing) -> ProcessingEntry:
    found: ProcessingEntry = {"file": said.place.file, "line": said.place.line}
    if said.controller:
        found["controller"] = said.controller
    if said.dpo:
        found["dpo"] = said.dpo
    if said.purposes:
        found["purposes"] = _by_category(said.purposes)
    if said.bases:
        found["legal_bases"] = _by_category(said.bases)
    return found


def _by_category(stated: ByCategory) -> dict[str, list[str]]:
    return {category or "every": list(some) for category, some in stated}


def _processed(row: Processed) -> ProcessedEntry:
    return {
        "element": element_dict(row.element),
        "category": row.category,
        "controllers": list(row.controllers),
        "officers": list(row.officers),
        "purposes": list(row.purposes),
        "legal_bases": list(row.bases),
        "missing": list(row.missing),
    }
