"""Open elements, in the order of review, and ends of which nothing is known (rule S11).

In: an ``Index``. Out: groups of rows; elements that differ only in the robot are one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import key
from rosprivacy.report.page.entries_of_robots import grouped
from rosprivacy.report.review_groups import review_groups, sources_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class ReviewQuestion:
    """An element that data gets to and that no label covers.

    Attributes
    ----------
    through
        The element that data comes from.
    closes
        What data gets to past this one only.
    brings
        The kinds of data that it brings in itself: it is asked about the others.
    """

    name: str
    kind: str
    data: str
    distance: str
    missing: str
    through: str = ""
    closes: str = ""
    brings: str = ""


@dataclass(frozen=True, slots=True)
class FoldedReview:
    """Questions that are one line: what they have in common, and their names."""

    text: str
    names: str


@dataclass(frozen=True, slots=True)
class Group:
    """Questions of one urgency; ``key`` is that of its heading."""

    key: str
    number: str
    questions: tuple[ReviewQuestion, ...]
    folded: tuple[FoldedReview, ...] = ()


def review(index: Index) -> tuple[Group, ...]:
    """Return the groups that are not empty."""
    return tuple(
        Group(
            f"question.{group.key}",
            _number(group.questions, index),
            tuple(_questions(group.now, index)),
            tuple(
                FoldedReview(
                    index.words(said, elements=index.words.count(count_rows(rows).elements, "element")),
                    _names(rows, index),
                )
                for said, rows in (("question.waits", group.waiting), ("question.proposed", group.proposed))
                if rows
            ),
        )
        for group in review_groups(index.document)
        if group.questions
    )


def _number(rows: Iterable[Mapping[str, Any]], index: Index) -> str:
    count = count_rows(rows)
    number = index.words.number(count.elements)
    return number if count.elements == count.legs else index.words("question.legs", elements=number, legs=count.legs)


def _names(rows: Iterable[Mapping[str, Any]], index: Index) -> str:
    return index.words.row(index.names([row["element"] for row in rows]))


def _questions(rows: Sequence[Mapping[str, Any]], index: Index) -> list[ReviewQuestion]:
    words, brings = index.words, sources_of(index.document)

    def merge_key(row: Mapping[str, Any]) -> Any:
        e, before = row["element"], row.get("through") or {"kind": "", "name": ""}
        facts = (tuple(row["categories"]), row["distance"], tuple(row.get("missing", ())))
        behind = (before["kind"], before["name"], row.get("closes"), row.get("leaks"))
        return e["kind"], e["name"], e.get("leg", ""), facts, behind, tuple(brings.get(key(e), ()))

    return [
        ReviewQuestion(
            name=_names(group, index),
            kind=words.kind(group[0]["element"]),
            data=index.all_data(group[0]["categories"]),
            distance=words.count(group[0]["distance"], "step") if group[0]["distance"] is not None else "–",
            missing=words.row(words(f"missing.{what}") for what in group[0].get("missing", ())),
            through=words.row(index.names([row["through"] for row in group if row.get("through")])),
            closes=words.row(
                words.count(group[0][what], thing)
                for what, thing in (("closes", "open_element"), ("leaks", "leak"))
                if group[0].get(what)
            ),
            brings=index.all_data(brings.get(key(group[0]["element"]), ())),
        )
        for group in grouped(rows, merge_key)
    ]
