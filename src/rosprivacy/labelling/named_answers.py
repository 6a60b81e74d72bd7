"""Answers that take data away, as lines of a file of keys: each names its element and says what is written of it.

In: a line, and the question that is asked now. Out: the keys that it comes to. A file of keys may have been made for
other questions. A single sign would then be said of whatever is asked; a line is an answer to the one question that
offers it, word for word.
"""

from __future__ import annotations

from string import ascii_uppercase
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.question_rows import LISTED
from rosprivacy.labelling.answer_keys import FEWEST

if TYPE_CHECKING:
    from collections.abc import Collection

    from rosprivacy.analysis.suggesting.question_rows import Question, Reply, Row

BEGINS, AND = "/", "; "  # a name begins so; between the rows of a list


def line_of(row: Row, reply: Reply) -> str:
    """Return the line that says a reply of a row.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.question_rows import Reply, Row
    >>> from rosprivacy.analysis.suggesting.written import WrittenLabel
    >>> never = Reply("0", WrittenLabel("topics", "/front", {"never": ["Video"]}), True)
    >>> line_of(Row(Element("topic", "/front"), ("Video",), (never,), ()), never)
    '/front topic never Video'
    """
    ((role, value),) = reply.label.said.items()
    kinds = [f"{kind} {method}" for kind, method in value.items()] if isinstance(value, dict) else value
    return " ".join([row.element.name, row.element.kind, role, *kinds])


def takes_away(question: Question, key: str) -> bool:
    """Return whether a key of some row takes data away."""
    replies = [row.reply(key) for row in question.rows]
    return any(reply and reply.takes_away for reply in replies)


def lines_of(question: Question, key: str) -> tuple[str, ...]:
    """Return the lines that say of each row what a key would; of what takes nothing away none.

    Parameters
    ----------
    key
        Of a list any digit.
    """
    whole = question.about == LISTED
    replies = [(row, reply) for row in question.rows for reply in row.replies if whole or reply.key == key]
    return tuple(line_of(row, reply) for row, reply in replies if reply.takes_away)


def keys_of(line: str, question: Question, picked: Collection[int]) -> tuple[str, ...]:
    """Return the keys that a line comes to; none if the question does not offer what it says.

    Parameters
    ----------
    picked
        Rows that are picked; of a list those that are taken out.
    """
    wanted = line.strip().split(AND)
    offered = [
        (line_of(row, reply), at, reply.key)
        for at, row in enumerate(question.rows)
        for reply in row.replies
        if reply.takes_away
    ]
    found = {at: key for said, at, key in offered if said in wanted}
    if len(found) != len(wanted) or len(set(wanted)) != len(wanted):
        return ()
    if question.about == LISTED:
        out = set(range(len(question.rows))) - set(found)
        return (*_letters(out ^ set(picked)), str(len(found))) if len(found) >= FEWEST else ()
    if len(found) != 1:
        return ()
    ((at, key),) = found.items()
    return (*(_letters({at} ^ set(picked)) if len(question.rows) > 1 else ()), key)


def _letters(rows: Collection[int]) -> tuple[str, ...]:
    return tuple(ascii_uppercase[at] for at in sorted(rows))
