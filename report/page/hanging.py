"""What the answer hangs on: single statements that take data or a question away, and what there would be without.

In: an ``Index``. Out: ``Hanging``, in plain texts, in the order of the document (rule S11).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import opening_text
from rosprivacy.report.page.index import node_of_service

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.page.index import Index

FEW = 8  # elements that a row names, of each sort; the document has all


class Hanging(NamedTuple):
    """One statement.

    Attributes
    ----------
    where, line
        The elements that it is about; file and line. Lines of a shipped file that differ only in the parameter service
        of a node are one, with all lines.
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
    return None if rows is None else tuple(_hanging(group, index) for group in grouped(rows, _but_for_services))


def _but_for_services(row: Mapping[str, Any]) -> Hashable:
    """What lines of a shipped file have in common that say the same of another parameter service of the same nodes."""
    nodes = [node_of_service(element) for element in row["elements"]]
    if not row["shipped"] or not all(nodes) or row["findings"] or row["to"]:
        return row["file"], row["line"], row["role"]
    asked = tuple((node_of_service(q["element"]), tuple(q["categories"])) for q in row["questions"])
    return row["file"], row["role"], row["method"], row["refused"], row["perhaps"], tuple(nodes), asked


def _hanging(rows: Sequence[Mapping[str, Any]], index: Index) -> Hanging:
    words, row = index.words, rows[0]
    every = {end: [element for row in rows for element in row[end]] for end in ("elements", "to")}
    ends = (_names_shown(index.names_by_node(some), index) for some in every.values() if some)
    return Hanging(
        where=" → ".join(words.row(names) for names in ends),
        line=words.row(f"{fit(row['file'])}:{row['line']}" for row in rows),
        statement=_statement(row, index),
        by=fit(row["author"]),
        why=fit(row["why"]),
        findings=_names_shown(list(_findings(row, index)), index),
        questions=_names_shown(list(_questions(rows, index)), index),
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


def _questions(rows: Iterable[Mapping[str, Any]], index: Index) -> Iterator[str]:
    questions = [question for row in rows for question in row["questions"]]
    for some in grouped(questions, lambda question: tuple(question["categories"])):
        data = index.all_data(some[0]["categories"])
        for name in index.names_by_node([question["element"] for question in some]):
            yield f"{name} ({data})"


def _names_shown(texts: Sequence[str], index: Index) -> tuple[str, ...]:
    distinct = tuple(dict.fromkeys(texts))  # the legs of a service have one name
    return index.words.first(distinct, FEW)
