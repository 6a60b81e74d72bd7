"""What the answer hangs on: what there would be if one statement of a label file were wrong, for the report.

In: an ``Index``. Out: rows, a user's statements before shipped ones, those on which most hangs first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.called_alike import opening_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.report.page.index import Index

FEW = 8  # elements that a row names, of each sort; the document has all


@dataclass(frozen=True, slots=True)
class Hanging:
    """One statement.

    Attributes
    ----------
    where, line
        The elements that it is about; file and line.
    statement, by, why
        What it says, who says so, with which reason; the last two may be empty.
    findings, questions
        What there would be without it.
    shipped
        Whether it is not the user's.
    """

    where: str
    line: str
    statement: str
    by: str
    why: str
    findings: tuple[str, ...]
    questions: tuple[str, ...]
    shipped: bool


def hanging(index: Index) -> tuple[Hanging, ...] | None:
    """Return the statements on which something hangs; None where it was not worked out."""
    rows = index.document.get("hangs_on")
    return None if rows is None else tuple(_hanging(row, index) for row in rows)


def _hanging(row: Mapping[str, Any], index: Index) -> Hanging:
    words = index.words
    ends = (_names_shown(index.names(row[end]), index) for end in ("elements", "to") if row[end])
    return Hanging(
        where=" → ".join(words.row(names) for names in ends),
        line=f"{fit(row['file'])}:{row['line']}",
        statement=_statement(row, index),
        by=fit(row["author"]),
        why=fit(row["why"]),
        findings=_names_shown(list(_findings(row, index)), index),
        questions=_names_shown(list(_questions(row, index)), index),
        shipped=row["shipped"],
    )


def _statement(row: Mapping[str, Any], index: Index) -> str:
    words = index.words
    role = "absent" if row["method"] == "absent" else row["role"]
    said = words(f"reliance.{role}")
    if row["role"] == "sanitizer" and role != "absent":
        method = words(f"method.{row['method']}")
        said = f"{said} ({method})"
    said = words.pair(said, index.all_data(row["categories"])) if row["categories"] else said
    return words("closed.glob", said=said) if row["glob"] else said


def _findings(row: Mapping[str, Any], index: Index) -> Iterator[str]:
    words = index.words
    if row["refused"]:
        yield words("reliance.refused", why=fit(row["refused"]))
    if row["perhaps"]:
        yield words("closed.perhaps")
    for opening in row["findings"]:
        data = index.data(opening["category"], pseudonymised=opening["pseudonymised"])
        ends = [words.row(index.names([opening[end]])) for end in ("source", "leak")]
        yield opening_text(opening, words.pair(data, " → ".join(ends)), words)


def _questions(row: Mapping[str, Any], index: Index) -> Iterator[str]:
    for one in row["questions"]:
        yield f"{index.words.row(index.names([one['element']]))} ({index.all_data(one['categories'])})"


def _names_shown(texts: Sequence[str], index: Index) -> tuple[str, ...]:
    distinct = tuple(dict.fromkeys(texts))  # the legs of a service have one name
    return index.words.first(distinct, FEW)
