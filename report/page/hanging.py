"""What the answer hangs on: single statements that take data or a question away, and what there would be without.

In: an ``Index``. Out: ``Hanging``, in plain texts, in the order of the document (rule S11).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import shown_of
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import key, opening_text
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
    itself, only_of
        Whether all that would be is that the elements themselves would not be reviewed; and of which kinds of data, if
        not of all that get there.
    """

    where: str
    line: str
    statement: str
    by: str
    why: str
    findings: tuple[str, ...]
    questions: tuple[str, ...]
    shipped: bool
    itself: bool = False
    only_of: str = ""


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
        questions=tuple(_questions(rows, index)),
        shipped=row["shipped"],
        itself=_about_itself(rows, index),
        only_of=_only_of(rows, index),
    )


def _about_itself(rows: Sequence[Mapping[str, Any]], index: Index) -> bool:
    """Whether nothing but a review of the elements themselves would be missing."""
    asked = [question["element"] for row in rows for question in row["questions"]]
    stated = [element for row in rows for element in row["elements"]]
    more = any(row[what] for row in rows for what in ("findings", "refused", "perhaps", "to"))
    return not more and set(index.names_by_node(asked)) == set(index.names_by_node(stated))


def _only_of(rows: Iterable[Mapping[str, Any]], index: Index) -> str:
    """The kinds of data of the questions, if others get to one of the elements, or would get to a standard channel."""
    there = {key(row["element"]): {*row["categories"], *row["pseudonymised"]} for row in index.document["carries"]}
    for row in index.document["assumptions"].get("standard_channels_reached", ()):
        there[key(row["element"])] = set(row["categories"])
    asked = [question for row in rows for question in row["questions"]]
    if all(there.get(key(question["element"])) == set(question["categories"]) for question in asked):
        return ""
    return index.all_data(dict.fromkeys(of for question in asked for of in question["categories"]))


def _statement(row: Mapping[str, Any], index: Index) -> str:
    words = index.words
    role = "absent" if row["method"] == "absent" else row["role"]
    said = words(f"reliance.{role}")
    if row["role"] == "sanitizer" and role != "absent":
        method = words(f"method.{row['method']}")
        said = f"{said} ({method})"
    if row["categories"]:
        names = [
            index.data(category) for category in sorted(row["categories"], key=lambda one: one not in index.categories)
        ]
        said = words.pair(said, words.row(words.first(names, FEW)))
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
    """Elements that would not be reviewed, the first of them; those of which it is the same data together."""
    questions = [question for row in rows for question in row["questions"]]
    named: dict[str, list[str]] = {}
    for some in grouped(questions, lambda question: tuple(question["categories"])):
        names = named.setdefault(index.all_data(some[0]["categories"]), [])
        names += dict.fromkeys(index.names_by_node([question["element"] for question in some]))
    left = shown_of(sum(map(len, named.values())), FEW)
    for data, names in named.items():
        if shown := names[: max(left, 0)]:
            yield f"{index.words.row(shown)} ({data})"
        left -= len(names)
    if left < 0:
        yield index.words("more", n=-left)


def _names_shown(texts: Sequence[str], index: Index) -> tuple[str, ...]:
    distinct = tuple(dict.fromkeys(texts))  # the legs of a service have one name
    return index.words.first(distinct, FEW)
