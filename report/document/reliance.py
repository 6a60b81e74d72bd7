"""What the answer hangs on -> the JSON document: what there would be if one statement of a label file were wrong.

In: ``Reliance`` rows. Out: plain dicts: a user's statements before shipped ones, those on which most hangs first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import STANDARD

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.whatif.reliance import Reliance
    from rosprivacy.report.contract.records import ElementEntry, RelianceEntry


def rows(hanging: Iterable[Reliance], element_dict: Callable[[Element], ElementEntry]) -> list[RelianceEntry]:
    """Return the rows as the contract has them."""
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
        for row in sorted(hanging, key=_order)
    ]


def _shipped(row: Reliance) -> bool:
    """Whether it stands in a file that is not the user's, such as that of standard channels."""
    return row.statement.rank[0] <= STANDARD


def _order(row: Reliance) -> tuple[object, ...]:
    standing = sum(not opening.dismissed for opening in row.findings)
    return (_shipped(row), -standing, -len(row.findings), not (row.refused or row.perhaps), -len(row.questions))
