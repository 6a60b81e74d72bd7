"""The list of doubts in a report for people: each sort with what to do, each doubt with a place (rule S11).

In: an ``Index``. Out: plain texts.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.verdict import doubt_phrases, subject

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class Sort:
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
