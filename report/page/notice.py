"""The information of persons (GDPR, Articles 13 and 14) as far as the analysis knows it, as a draft in Markdown.

In: a document and a language. Out: for each kind of data the rows of its register: whose data, what for, on which
basis, who gets them, where, on which safeguard, how long. What is not stated is to be completed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.text import fit
from rosprivacy.report import row_texts
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import text
from rosprivacy.report.page.article30 import not_reviewed
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.markdown import rendered
from rosprivacy.report.row_texts import completed
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.report.row_texts import Row

INTERESTS = "6(1)(f)"
CONSENT = ("6(1)(a)", "9(2)(a)")


class NoticeRow(NamedTuple):
    """What persons are told of data at one place; the fields are the columns, in order."""

    place: str
    persons: str
    purpose: str
    basis: str
    recipient: str
    where: str
    retention: str


class NoticeKind(NamedTuple):
    """What persons are told of one kind of data.

    Attributes
    ----------
    sources
        Where the data come from.
    note
        That there may be more recipients; empty where all is reviewed.
    """

    title: str
    definition: str
    sources: str
    rows: tuple[NoticeRow, ...]
    note: str


def notice(document: Mapping[str, Any], language: str, title: str = "") -> str:
    """Return the draft, for a system of this title."""
    index = Index(document, Words(language))
    rows, words = index.register, index.words
    stated = {basis for row in rows for group in ("bases", "special_bases") for basis in row[group]}
    return rendered(
        "notice.md.j2",
        words,
        system=fit(title),
        controllers="; ".join(row_texts.of_all(rows, "controllers", Cell.CONTROLLERS, words)),
        officers="; ".join(row_texts.of_all(rows, "officers", Cell.OFFICERS, words)),
        columns=[words(f"notice.{column}") for column in NoticeRow._fields],
        kinds=[_kind(same, index) for same in grouped(rows, lambda row: row["category"])],
        interests=INTERESTS in stated,
        consent=not stated.isdisjoint(CONSENT),
        answer=verdict_sentence(document, words),
    )


def _kind(rows: Sequence[Row], index: Index) -> NoticeKind:
    category = rows[0]["category"]
    return NoticeKind(
        title=index.data(category),
        definition=text(index.categories[category], "definition", index.words.language),
        sources=index.words.row(index.names([source for row in rows for source in row["sources"]])),
        rows=tuple(notice_row(row, index) for row in rows),
        note=not_reviewed(category, index),
    )


def notice_row(row: Row, index: Index) -> NoticeRow:
    """Return what persons are told of a row of the register."""
    words = index.words
    place = words.row(index.names(row["places"])) or words("record.norecipient")
    nobody = "" if row["places"] else words("cnil.none.found")
    periods = filter(None, [row_texts.retention(row, words)])
    where = filter(None, [row_texts.where(row, words)])
    return NoticeRow(
        place=words.pair(place, words("record.hidden")) if row["pseudonymised"] else place,
        persons=completed(map(fit, row["subjects"]), row, words, Cell.SUBJECTS),
        purpose=completed(map(fit, row["purposes"]), row, words, Cell.PURPOSES),
        basis="; ".join(row_texts.bases(row, words)),
        recipient=nobody or completed(row_texts.recipient(row, words), row, words, Cell.OPERATOR, Cell.RECIPIENT),
        where=nobody or completed(where, row, words, Cell.COUNTRY, Cell.SAFEGUARDS),
        retention=completed(periods, row, words, Cell.RETENTION),
    )
