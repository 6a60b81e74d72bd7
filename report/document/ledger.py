"""The ledger -> the JSON document: what was taken away on the data's side, and on whose word.

In: ``TakenAway`` rows. Out: plain dicts, in their order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.findings.closures import ABSENT
from rosprivacy.analysis.whatif.ledger import BY, REVIEW

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.whatif.ledger import GlobUse, TakenAway
    from rosprivacy.report.contract.records import ElementEntry, GlobEntry, LedgerRow

    Shown = Callable[[Element], ElementEntry]

ANSWERING = (REVIEW, "mundane", "sanitizer")  # what takes the question away whether an element was reviewed
WORD_OF_A_LABEL = ("mundane", "only", "never", "sanitizer", ABSENT)


def rows(taken: Collection[TakenAway], element_dict: Shown) -> list[LedgerRow]:
    """Return the rows as the contract has them."""

    def shown(element: Element | None) -> ElementEntry | None:
        return element_dict(element) if element else None

    return [
        {
            "by": row.by,
            "element": shown(row.element),
            "to": shown(row.to),
            "categories": list(row.categories),
            "places": [{"file": place.file, "line": place.line} for place in row.places],
            "glob": row.glob,
            "leak": shown(row.leak),
            "open": shown(row.open),
            "itself": row.itself,
            "perhaps": row.perhaps,
            "note": row.note,
        }
        for row in taken
    ]


def globs(used: Iterable[GlobUse], element_dict: Shown) -> list[GlobEntry]:
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
            "leak": element_dict(use.leak) if use.leak else None,
            "open": element_dict(use.open) if use.open else None,
            "warning": use.warning,
        }
        for use in used
    ]


def hanging(document: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
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


def counts(taken: Collection[TakenAway]) -> dict[str, int]:
    """Return how many there are of each kind, those that there are."""
    numbers = {by: sum(row.by == by for row in taken) for by in BY}
    return {by: number for by, number in numbers.items() if number}
