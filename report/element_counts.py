"""How many elements some rows are about, for every report: a service or an action is one, whatever its legs.

In: rows of a JSON document, or elements. Out: ``ElementCount``. One place counts, so that all outputs agree.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import counted
from rosprivacy.report.naming import without_leg

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import Element


class ElementCount(NamedTuple):
    """How many elements, and how many where the legs of services and actions are counted by themselves."""

    elements: int
    legs: int

    def __str__(self) -> str:
        """Return both, in words.

        >>> str(ElementCount(4, 6)), str(ElementCount(1, 1))
        ('4 elements (6 counting the legs of services and actions)', '1 element')
        """
        return f"{counted(self.elements, 'element')}{self.remark}"

    @property
    def remark(self) -> str:
        """What is said beside the number of elements; empty where no leg makes a difference."""
        return f" ({self.legs:,} counting the legs of services and actions)" if self.legs != self.elements else ""


def count_rows(rows: Iterable[Mapping[str, Any]]) -> ElementCount:
    """Count the elements of rows of a document."""
    keys = [without_leg(row["element"]) for row in rows]
    return ElementCount(len(set(keys)), len(keys))


def count_elements(elements: Iterable[Element]) -> ElementCount:
    """Count elements of an analysis."""
    keys = [element.identity for element in elements]
    return ElementCount(len(set(keys)), len(keys))
