"""What keeps data from going on, and on whose word: the ledger, what the answer hangs on, why data does not get there.

In: facts of the analysis. Out: entries, in their order; and which of them a reader has to look at.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.findings.closures import ABSENT
from rosprivacy.analysis.model import BY_TYPE, STANDARD
from rosprivacy.analysis.whatif.ledger import BY, REVIEW
from rosprivacy.report.document.records import element_dict, element_or_none, place_entries

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.whatif.ledger import GlobUse, TakenAway
    from rosprivacy.analysis.whatif.reliance import Reliance
    from rosprivacy.analysis.whatif.why_not import WhyNot
    from rosprivacy.report.schemas.records import GlobEntry, LedgerRow, RelianceEntry


WHY_NOT = "rosprivacy.why-not/1"
ANSWERING = (REVIEW, "mundane", "sanitizer")  # what takes the question away whether an element was reviewed
WORD_OF_A_LABEL = ("mundane", "only", "never", "sanitizer", ABSENT)


def ledger_rows(ledger: Collection[TakenAway]) -> list[LedgerRow]:
    """Return what was taken away on the data's side."""
    return [
        {
            "by": row.by,
            "element": element_or_none(row.element),
            "to": element_or_none(row.to),
            "categories": list(row.categories),
            "places": place_entries(row.places),
            "glob": row.glob,
            "leak": element_or_none(row.leak),
            "open": element_or_none(row.open),
            "itself": row.itself,
            "perhaps": row.perhaps,
            "note": row.note,
        }
        for row in ledger
    ]


def counts_of(ledger: Collection[TakenAway]) -> dict[str, int]:
    """Return how many there are of each kind, those that there are."""
    numbers = {by: sum(row.by == by for row in ledger) for by in BY}
    return {by: number for by, number in numbers.items() if number}


def glob_entries(used: Iterable[GlobUse]) -> list[GlobEntry]:
    """Return what each glob of the label files decides and closes."""
    return [
        {
            "file": use.place.file,
            "line": use.place.line,
            "says": list(use.says),
            "elements": use.elements,
            "closed": use.closed,
            "reviewed": use.reviewed,
            "flows": use.flows,
            "flows_closed": use.flows_closed,
            "leak": element_or_none(use.leak),
            "open": element_or_none(use.open),
            "warning": use.warning,
        }
        for use in used
    ]


def hanging_labels(document: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
    """Return (place, row) of each line of a label file at which data ends, where no leak was found; else nothing.

    A path can end at one of several of them, so no row by itself says that a leak lies behind. Of a line that closes
    much, the row that stands for it is the first that has a leak behind it.
    """
    if document["verdict"] != Verdict.NO_LEAK_FOUND:
        return []
    closing = (row for row in document["taken_away"] if row["by"] in WORD_OF_A_LABEL)
    first: dict[str, Mapping[str, Any]] = {}
    for row in sorted(closing, key=lambda row: not row["leak"]):
        for place in row["places"]:
            first.setdefault(f"{shown(place['file'])}:{place['line']}", row)
    return list(first.items())


def by_globs(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the rows of elements that count as reviewed, for some data, by no name: only globs of labels say so."""
    return [row for row in document["taken_away"] if row["glob"] and row["by"] in ANSWERING and not row["to"]]


def reliance_rows(statements: Iterable[Reliance]) -> list[RelianceEntry]:
    """Return what the answer hangs on: a user's statements first, those on which most hangs before others."""
    return [
        {
            "role": row.statement.role,
            "method": str(row.statement.method or ""),
            "categories": list(row.statement.categories),
            "file": row.statement.place.file,
            "line": row.statement.place.line,
            "glob": row.statement.glob,
            "shipped": _shipped(row),
            "why": row.statement.why,
            "author": row.statement.author,
            "elements": [element_dict(element) for element in row.elements],
            "to": [element_dict(element) for element in row.to],
            "findings": [
                {
                    "kind": opening.kind,
                    "category": opening.category,
                    "source": element_dict(opening.source),
                    "leak": element_dict(opening.leak),
                    "dismissed": opening.dismissed,
                    "pseudonymised": opening.pseudonymised,
                    "new": opening.new,
                }
                for opening in row.findings
            ],
            "questions": [
                {"element": element_dict(element), "categories": list(names)} for element, names in row.questions
            ],
            "refused": row.refused,
            "perhaps": row.perhaps,
        }
        for row in sorted(statements, key=_order)
    ]


def _shipped(row: Reliance) -> bool:
    """Whether it stands in a file that is not the user's, such as that of standard channels."""
    return row.statement.rank[0] <= STANDARD and row.statement.role != BY_TYPE


def _order(row: Reliance) -> tuple[object, ...]:
    standing = sum(not opening.dismissed for opening in row.findings)
    return (_shipped(row), -standing, -len(row.findings), not (row.refused or row.perhaps), -len(row.questions))


def why_not_document(answers: Iterable[WhyNot]) -> dict[str, Any]:
    """Return why data does not get from one element to another, as one JSON object."""
    return {
        "format": WHY_NOT,
        "answers": [
            {
                "category": answer.category,
                "source": element_dict(answer.source),
                "leak": element_dict(answer.leak),
                "finding": answer.finding.id if answer.finding else None,
                "path": [element_dict(element) for element in answer.path],
                "obstacles": [
                    {
                        "by": obstacle.by,
                        "element": element_dict(obstacle.element),
                        "to": element_or_none(obstacle.to),
                        "category": obstacle.category,
                        "places": place_entries(obstacle.places),
                    }
                    for obstacle in answer.obstacles
                ],
                "reached": answer.reached,
            }
            for answer in answers
        ],
    }
