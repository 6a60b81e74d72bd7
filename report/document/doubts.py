"""The list of doubts in the JSON document, and the verdict's sentence that names them (rules S11, S12).

In: doubts, and a document with their rows. Out: rows; the document with ``sentence`` and a diagnostic for each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.element_entry import element_dict
from rosprivacy.report.verdict import doubts_of, phrase, verdict_sentence

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Doubt
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.analysis import AnalysisDocument
    from rosprivacy.report.contract.records import DiagnosticEntry, DoubtEntry


def verdict_facts(answer: Answer) -> dict[str, Any]:
    """Return what the verdict's sentence is made of, without the rest of the document."""
    analysis = answer.shown
    return {
        "verdict": str(analysis.verdict),
        "categories": analysis.emitted,
        "open": analysis.open,
        "findings": [{"accepted": finding.accepted} for finding in analysis.findings],
        "diagnostics": [{"code": diagnostic.code} for diagnostic in analysis.diagnostics],
        "doubts": [doubt_entry(doubt) for doubt in answer.doubts],
        "assumptions": answer.assumptions,
    }


def doubt_entry(doubt: Doubt) -> DoubtEntry:
    """Return a row of ``doubts``."""
    row: DoubtEntry = {
        "id": doubt.id,
        "doubt": doubt.name,
        "rank": str(doubt.rank),
        "element": element_dict(doubt.element) if doubt.element else None,
        "categories": list(doubt.categories),
        "count": doubt.count,
        "file": doubt.place.file,
        "line": doubt.place.line,
        "message": doubt.message,
        "accepted": None,
    }
    if doubt.accepted:
        by = doubt.accepted
        row["accepted"] = {
            "reason": by.reason,
            "owner": by.owner,
            "expires": by.expires,
            "ticket": by.ticket,
            "file": by.place.file,
            "line": by.place.line,
        }
    return row


def with_sentence(document: AnalysisDocument) -> AnalysisDocument:
    """Return a document with the verdict's sentence; what no reader reported as a diagnostic becomes one, too."""
    more: list[DiagnosticEntry] = [
        {
            "file": doubt["file"],
            "line": doubt["line"],
            "severity": "warning",
            "message": phrase([doubt], IN_ENGLISH),
            "code": doubt["doubt"],
        }
        for doubt in doubts_of(document)
        if not doubt["message"]
    ]
    return {**document, "diagnostics": [*document["diagnostics"], *more], "sentence": verdict_sentence(document)}
