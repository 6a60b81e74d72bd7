"""A ``Document`` as plain tables: for data frames, CSV files and Parquet.

In: a ``Document``. Out: rows, each a dict of texts, numbers and flags. The verdict stands in a table of its own, and
what is open or in doubt in two others, so that a table without rows is never all that there is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import NO_PLACE
from rosprivacy.report.document.analysis import verdict_facts
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.document.contents import Document

Cell = str | int | bool
Row = dict[str, Cell]
TABLES: Mapping[str, Mapping[str, str]] = {
    "answer": {
        "verdict": "leak, undetermined or no-leak-found",
        "sentence": "What it means, with each sort of doubts.",
        "view": "declared or enforced",
        "findings": "Rows of `findings` that stand: neither dismissed nor accepted.",
        "open": "Rows of `open`.",
        "doubts": "Rows of `doubts`.",
    },
    "findings": {
        "id": "Of the finding; of a fleet one of each pattern.",
        "kind": "disclosure, or another one",
        "category": "Kind of data.",
        "pseudonymised": "Whether it gets there pseudonymised only.",
        "source": "Where it comes in; of a fleet robot:name.",
        "leak": "Where it gets out.",
        "steps": "Rows of `steps` of this finding, counted as hops.",
        "dismissed": "Whether another finding stands for it.",
        "accepted": "Whether a person has accepted it.",
        "reason": "Of other kinds than disclosure: what is wrong there.",
        "robots": "On how many robots; 1 where there is no fleet.",
    },
    "steps": {
        "finding": "Id of the finding.",
        "step": "Number of the hop, from 1.",
        "from": "Element that the data leaves.",
        "to": "Element that it gets to.",
        "role": "publish, subscribe, …",
        "category": "Kind of data on this hop.",
        "file": "Of a policy line that allows it; a row for each line, and one without a file where no line is known.",
        "line": "0 where none is known.",
    },
    "open": {
        "element": "Nobody has reviewed it, and such data gets there.",
        "kind": "node, topic, …",
        "category": "Kind of data; a row for each.",
        "distance": "Hops from the nearest source.",
        "frontier": "Whether nothing else that is open lies before it.",
        "missing": "What has to be known of it and is not stated.",
    },
    "doubts": {
        "name": "Sort of the doubt.",
        "rank": "Whether it breaks the verdict or rides on it.",
        "element": "What it is about; empty of a file or the whole answer.",
        "categories": "Kinds of data that are in doubt; empty for any.",
        "count": "How many elements it stands for.",
        "file": "Where to look; empty where no file speaks of it.",
        "line": "0 where none does.",
        "message": "What is wrong and what to do.",
        "accepted": "Whether a person has accepted it.",
    },
    "carries": {
        "element": "What data gets to.",
        "kind": "node, topic, …",
        "robot": "Of a fleet.",
        "category": "Kind of data; a row for each.",
        "pseudonymised": "Whether it is there pseudonymised only.",
    },
}


def tables(document: Document) -> dict[str, list[Row]]:
    """Return the rows of each table; each has the columns of ``TABLES``, in that order."""
    analysis = document.analysis
    robots = _robots(document)
    rows = {
        "findings": [_finding(finding, robots) for finding in analysis.findings],
        "steps": [row for finding in analysis.findings for row in _steps(finding)],
        "open": list(_open(document)),
        "doubts": list(_doubts(document)),
        "carries": list(_carries(document)),
    }
    answer: Row = {
        "verdict": str(analysis.verdict),
        "sentence": verdict_sentence(verdict_facts(analysis, document.doubts, document.assumptions)),
        "view": str(analysis.graph.view),
        "findings": sum(finding.stands for finding in analysis.findings),
        "open": len(rows["open"]),
        "doubts": len(rows["doubts"]),
    }
    return {"answer": [answer], **rows}


def _robots(document: Document) -> Mapping[str, int]:
    """On how many robots each finding is, of a fleet."""
    return {one.finding.id: len(one.robots) for one in document.fleet.patterns} if document.fleet else {}


def _finding(finding: Finding, robots: Mapping[str, int]) -> Row:
    return {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "pseudonymised": finding.pseudonymised,
        "source": finding.source.full_name,
        "leak": finding.leak.full_name,
        "steps": len(finding.steps),
        "dismissed": finding.dismissed,
        "accepted": finding.accepted,
        "reason": finding.reason,
        "robots": robots.get(finding.id, 1),
    }


def _steps(finding: Finding) -> Iterator[Row]:
    for number, step in enumerate(finding.steps, 1):
        places = [grant.place for grant in step.grants] or [NO_PLACE]
        for place in places:
            yield {
                "finding": finding.id,
                "step": number,
                "from": step.source.full_name,
                "to": step.target.full_name,
                "role": step.role,
                "category": step.category,
                "file": place.file,
                "line": place.line,
            }


def _open(document: Document) -> Iterator[Row]:
    for question in document.analysis.open:
        for category in question.categories:
            yield {
                "element": question.element.full_name,
                "kind": question.element.kind,
                "category": category,
                "distance": question.distance,
                "frontier": question.frontier,
                "missing": ", ".join(question.missing),
            }


def _doubts(document: Document) -> Iterator[Row]:
    for doubt in document.doubts:
        yield {
            "name": doubt.name,
            "rank": str(doubt.rank),
            "element": _name(doubt.element),
            "categories": ", ".join(doubt.categories),
            "count": doubt.count,
            "file": doubt.place.file,
            "line": doubt.place.line,
            "message": doubt.message,
            "accepted": doubt.accepted is not None,
        }


def _carries(document: Document) -> Iterator[Row]:
    for carried in document.analysis.carried:
        for categories, pseudonymised in ((carried.categories, False), (carried.pseudonymised, True)):
            for category in categories:
                yield {
                    "element": carried.element.full_name,
                    "kind": carried.element.kind,
                    "robot": carried.element.robot,
                    "category": category,
                    "pseudonymised": pseudonymised,
                }


def _name(element: Element | None) -> str:
    return element.full_name if element else ""
