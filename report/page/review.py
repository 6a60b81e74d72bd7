"""What is not known, for a person to review: open elements in their order, ends of ways, the list of doubts (rule S11).

In: an ``Index``. Out: groups of rows, of which those that differ only in the robot are one; each sort of doubt with
what to do, each doubt with a place.
"""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import count_rows, key
from rosprivacy.report.review_groups import review_groups, sources_of
from rosprivacy.report.verdict import doubt_phrases, subject

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.page.index import Index


class ReviewQuestion(NamedTuple):
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


class FoldedReview(NamedTuple):
    """Questions that are one line: what they have in common, and their names."""

    text: str
    names: str


class QuestionGroup(NamedTuple):
    """Questions of one urgency; ``key`` is that of its heading."""

    key: str
    number: str
    questions: tuple[ReviewQuestion, ...]
    folded: tuple[FoldedReview, ...] = ()


def review(index: Index) -> tuple[QuestionGroup, ...]:
    """Return the groups that are not empty."""
    return tuple(
        QuestionGroup(
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


class Sort(NamedTuple):
    """Doubts of one sort.

    Attributes
    ----------
    rank
        What they do to the verdict, in words.
    remedy
        What to do.
    rows
        (what it is about, the rest: kinds of data, line, message, who accepted it, id).
    """

    title: str
    rank: str
    remedy: str
    rows: tuple[tuple[str, str], ...]


def doubts(index: Index) -> tuple[Sort, ...]:
    """Return all doubts by sort, what breaks the verdict first; accepted ones with who accepted them."""
    words = index.words
    return tuple(
        Sort(
            words(f"doubt.{name}.title"),
            words(f"doubt.{rank}"),
            words("doubt.what.to.do", do=words(f"doubt.{name}.do")),
            tuple((subject(row), "; ".join(_about(row, index))) for row in rows),
        )
        for (name, rank), rows in groupby(index.document.get("doubts", ()), key=lambda row: (row["doubt"], row["rank"]))
    )


def in_doubt(index: Index) -> Iterator[str]:
    """Return the sentence with which a report begins, after its result; nothing where there is no doubt."""
    if phrases := list(doubt_phrases(index.document, index.words)):
        yield index.words("doubt.sentence", doubts="; ".join(phrases))


def _about(row: Mapping[str, Any], index: Index) -> Iterator[str]:
    words = index.words
    if row["element"]:
        yield words.kind(row["element"])
    if row["categories"]:
        yield index.all_data(row["categories"])
    if row["element"] and row["line"]:
        yield fit(f"{row['file']}:{row['line']}")
    if row["message"]:
        yield fit(row["message"])
    if by := row["accepted"]:
        date = words.date(by["expires"])
        yield words("doubt.is.accepted", date=date, owner=fit(by["owner"]), reason=fit(by["reason"]))
    yield row["id"]
