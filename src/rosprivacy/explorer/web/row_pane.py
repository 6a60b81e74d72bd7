"""The row of the register in which a finding ends: what is stated of it, what is asked of it, what it may rest on.

In: a document, a finding, words. Out: ``Pane``s; questions and texts are those of page one of the report. A person
decides about the row, with all that ends there, or about the one path.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import SPECIAL
from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.text import fit
from rosprivacy.explorer.web.panes import Pane
from rosprivacy.report import row_texts
from rosprivacy.report.finding_facts import REVEALS
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.to_confirm import question_key, questions_of
from rosprivacy.report.row_texts import completed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

    Row = Mapping[str, Any]  # of the register

FINDING, ROW = "finding", "row"  # what a person can decide about
GROUND_GROUPS = ("6(1)", "9(2)")
ANSWER = "answer-"  # before the code of a question, as a field


def row_of(document: Mapping[str, Any], finding: str) -> Row | None:
    """Return the row in which a finding ends; None if the register does not list it, as of robots not shown."""
    rows = [row for row in document.get("register", ()) if finding in row["findings"]]
    leak = next((one["leak"] for one in document["findings"] if one["id"] == finding), None)
    return next((row for row in rows if leak in row["places"]), rows[0] if rows else None)


def row_pane(document: Mapping[str, Any], finding: Mapping[str, Any], words: Words) -> Pane | None:
    """Return what the page shows of a finding's row; None where the register does not list the finding."""
    row = row_of(document, finding["id"])
    if row is None:
        return None
    index = Index(document, words)
    data = index.data(row["category"], pseudonymised=row["pseudonymised"])
    place = words.row(index.names(row["places"]))
    kinds = dict.fromkeys(index.by_id[one]["kind"] for one in row["findings"] if one in index.by_id)
    return Pane(
        title=words("explorer.row", data=data, place=place),
        facts=tuple(_facts(row, words)),
        asks=tuple(words(f"ask.{kind}") for kind in kinds),
        questions=tuple(Pane(name=ANSWER + code, text=words(question_key(code))) for code in questions_of(row)),
        grounds=tuple(_grounds(row, words)),
        about=tuple(_about(document, row, finding, words)),
    )


def _facts(row: Row, words: Words) -> Iterator[tuple[str, str]]:
    """What is stated of the row, and what a person has to complete."""
    recipient = row_texts.recipient({**row, "contract": ""}, words)
    encrypted = {True: words("yes"), False: words("no")}.get(row["encrypted"], "")
    cells: tuple[tuple[str, Iterable[str], tuple[Cell, ...]], ...] = (
        ("opening.whose", map(fit, row["subjects"]), (Cell.SUBJECTS,)),
        ("column.purposes", map(fit, row["purposes"]), (Cell.PURPOSES,)),
        ("opening.recipient", recipient, (Cell.OPERATOR, Cell.RECIPIENT)),
        ("opening.contract", [fit(row["contract"])], (Cell.CONTRACT,)),
        ("opening.country", [row_texts.country(row, words)], (Cell.COUNTRY,)),
        ("opening.transfer", row_texts.transfer(row, words), (Cell.SAFEGUARDS,)),
        ("opening.basis", row_texts.bases(row, words), ()),
        ("opening.retention", [row_texts.retention(row, words)], (Cell.RETENTION,)),
        ("column.encrypted", [encrypted], (Cell.ENCRYPTED,)),
    )
    for key, texts, fields in cells:
        if text := completed(filter(None, texts), row, words, *fields):
            yield words(key), text


def _grounds(row: Row, words: Words) -> Iterator[Pane]:
    """The grounds that can be ticked, of Article 9(2) where the data may need one, with what the ontology says."""
    for group in GROUND_GROUPS:
        if group == GROUND_GROUPS[0] or row["article9"] in (*SPECIAL, *REVEALS):
            offered = [
                Pane(article=article, told=words.pair(words.basis(article), title), meaning=meaning)
                for article, title, meaning in _of_law(words.language)
                if article.startswith(group)
            ]
            yield Pane(article=words.basis(group), offered=tuple(offered))


@cache
def _of_law(language: str) -> tuple[tuple[str, str, str], ...]:
    """The grounds of Articles 6(1) and 9(2) as the ontology has them: article, title, meaning."""
    from rosprivacy.ontology.provisions import grounds  # noqa: PLC0415 - rdflib, read when a page first needs it

    return tuple((article, one.title, one.meaning) for article, one in grounds(language).items())


def articles() -> tuple[str, ...]:
    """Return the grounds that can be ticked.

    >>> articles()[0], articles()[-1]
    ('6(1)(a)', '9(2)(j)')
    """
    return tuple(article for article, *_ in _of_law("en"))


def _about(document: Mapping[str, Any], row: Row, finding: Mapping[str, Any], words: Words) -> Iterator[Pane]:
    """The row and the one path, to choose from; of a fleet on the robots that are chosen."""
    if "fleet" in document and "fleet" not in row:
        return
    decisions, name = document.get("decisions", ()), row.get("fleet", {}).get("pattern", row["id"])
    by_row = any(one["target"].get("row") == name for one in decisions)
    if len(row["findings"]) == 1 and not by_row:
        return
    alone = any(finding["id"] in one["findings"] and "row" not in one["target"] for one in decisions)
    for value, told in (
        (ROW, words.count(len(row["findings"]), "explorer.row.all")),
        (FINDING, words("explorer.row.one")),
    ):
        yield Pane(value=value, told=told, chosen=(value == FINDING) == (alone and not by_row))
