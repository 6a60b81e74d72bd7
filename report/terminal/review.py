"""What a person reviews next, in the report for the terminal (rule S11).

In: a JSON document of the contract. Out: lines. What can wait, and what a file of the program proposes to take as
mundane, is one line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.report.called_alike import both, kind_in, legs
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import key, label_name, shown_name
from rosprivacy.report.review_groups import SHOWN, review_groups, sources_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.report.review_groups import ReviewGroup

Line = tuple[str, str]  # text, style


def review_lines(report: Mapping[str, Any], words: Words, *, verbose: bool) -> Iterator[Line]:
    """Return open elements: nodes on the frontier, then channels, then what lies behind."""
    brings = sources_of(report)
    for group in review_groups(report):
        if not group.questions:
            continue
        yield "", ""
        count = count_rows(group.questions)
        title = words(f"tty.review.{group.key}")
        yield words.pair(title, f"{count.elements}{legs(count, words)}"), "bold"
        for question in group.questions if verbose else group.now[:SHOWN]:
            steps = words("tty.from.source", steps=words.count(question["distance"], "step"))
            what = "; ".join((kind_in(question["element"], words), steps, review_text(question, brings, words)))
            yield f"   {label_name(question)}  ({what})", ""
        if not verbose:
            yield from _more(group, words)


def review_text(question: Mapping[str, Any], brings: Mapping[Any, Sequence[str]], words: Words = IN_ENGLISH) -> str:
    """Return which data is at an open element, through which element it comes, and what a label there can close."""
    kinds = ", ".join(question["categories"])
    own = brings.get(key(question["element"]), ())
    through = question.get("through")
    parts = [words("tty.comes.through", kinds=kinds, element=shown_name(through)) if through else kinds]
    parts += [words(f"tty.missing.{what}") for what in question.get("missing", ())]
    parts += [words("tty.brings", own=", ".join(own), kinds=kinds)] if own else []
    behind = [words.count(question["closes"], "tty.otheropen")] if question.get("closes") else []
    behind += [words.count(question["leaks"], "tty.exit")] if question.get("leaks") else []
    return "; ".join([*parts, *([words("tty.only.past", behind=both(behind, words))] if behind else [])])


def _more(group: ReviewGroup, words: Words) -> Iterator[Line]:
    left = len(group.now) - SHOWN
    if left > 0:
        yield f"   {words('tty.rest', n=left)}", "dim"
    if waiting := count_rows(group.waiting).elements:
        yield f"   {words('tty.wait', n=waiting)}", "dim"
    if proposed := count_rows(group.proposed).elements:
        yield f"   {words('tty.infrastructure', n=proposed)}", "dim"
