"""The ledger -> the JSON document: what was taken away on the data's side, and on whose word.

In: ``TakenAway`` rows. Out: plain dicts, in their order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.ledger import BY

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from rosprivacy.analysis.findings.ledger import TakenAway
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.contract.records import ElementEntry, LedgerRow

    Shown = Callable[[Element], ElementEntry]


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


def counts(taken: Collection[TakenAway]) -> dict[str, int]:
    """Return how many there are of each kind, those that there are."""
    numbers = {by: sum(row.by == by for row in taken) for by in BY}
    return {by: number for by, number in numbers.items() if number}
