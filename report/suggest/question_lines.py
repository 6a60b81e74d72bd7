"""A question -> lines for the terminal: what is asked, of what, why, and which keys answer it; without colours."""

from __future__ import annotations

from string import ascii_uppercase
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.question_rows import (
    BRINGS_IN,
    ENDS,
    GOES_ON,
    GOES_THROUGH,
    LETS_OUT,
    MAKES,
    NOTHING,
    NOTHING_THROUGH,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.suggesting.question_rows import Question, Reply, Row

ASKED = {
    BRINGS_IN: ("Does it bring such data in?", "Which of these bring such data in?"),
    LETS_OUT: ("Does it let such data out: keep, show or send them elsewhere?", "Which of these let such data out?"),
    MAKES: ("Does it make such data?", "Which of these make such data?"),
    GOES_ON: ("What does it do with {kinds}?", "What do these do with {kinds}?"),
    ENDS: (
        "{kinds} gets there, and no policy lets it go on. What happens to it?",
        "{kinds} gets there, and no policy lets it go on. What happens to it in these?",
    ),
    GOES_THROUGH: ("Can {kinds} go through?", "Can {kinds} go through these?"),
    NOTHING_THROUGH: (
        "",
        "Is it so that no {kinds} goes through any of these? Read each row: a wrong one hides a leak.",
    ),
}
OF_KEYS = {"x": "yes, and no to the others", "n": "no", "o": "one by one", "s": "later", "q": "stop"}
SHOWN = 3  # reasons of an element


def question_lines(question: Question) -> Iterator[str]:
    """Yield what is asked, each row with its reasons, and the findings that may hang on the answer."""
    rows = question.rows
    yield ""
    yield ASKED[question.about][len(rows) > 1].format(kinds=" and ".join(rows[0].kinds))
    for letter, row in zip(ascii_uppercase, rows, strict=False):
        at = f"{letter}  " if len(rows) > 1 else ""
        yield f"  {at}{row.element.kind} {shown(row.element.name)}{_of_row(question, row)}"
        whole = question.about == NOTHING_THROUGH
        yield from (f"       {shown(reason)}" for reason in row.reasons[: None if whole else SHOWN])
        if len(row.reasons) > SHOWN and not whole:
            yield f"       and {len(row.reasons) - SHOWN} more reasons"
    if question.about == NOTHING_THROUGH:
        return  # none of it would close one
    closes = dict.fromkeys(told for row in rows for told in row.closes)
    if closes and any(one.takes_away for one in rows[0].replies):
        yield f"  known findings, which may hang on this: {shown('; '.join(closes))}"


def keys_line(question: Question, picked: Collection[int], keys: Collection[str]) -> str:
    """Return which keys say what of the rows that are picked, or of all.

    Parameters
    ----------
    keys
        Those that answer the question as it is picked.
    """
    if question.about == NOTHING_THROUGH:
        return _list_line(len(question.rows), picked)
    of = f"{' '.join(ascii_uppercase[at] for at in sorted(picked))}: " if picked else ""
    of = of or ("all: " if len(question.rows) > 1 else "")
    several = len(picked) > 1
    said = [
        f"{one.key} {_words(one)}{' (as a list)' if several and one.key == NOTHING else ''}"
        for one in question.rows[0].replies
        if one.key in keys
    ]
    more = [f"{key} {word}" for key, word in OF_KEYS.items() if key in (*keys, "q")]
    letters = ["A-Z pick some"] if len(question.rows) > 1 else []
    return f"  {of}{', '.join([*said, *more, *letters])}"


def _list_line(rows: int, out: Collection[int]) -> str:
    """How a list is confirmed.

    >>> _list_line(3, {1})
    '  without B: 2 and Enter for none of it in all 2, A-Z take out or put back, o not as a list, s later, q stop'
    """
    left = rows - len(out)
    without = f"without {' '.join(ascii_uppercase[at] for at in sorted(out))}: " if out else ""
    confirm = f"{left} and Enter for none of it in all {left}, " if left > 1 else ""
    return f"  {without}{confirm}A-Z take out or put back, o not as a list, s later, q stop"


def _of_row(question: Question, row: Row) -> str:
    """What a row is about, where rows differ in it."""
    if question.about == MAKES:
        (made,) = row.replies[0].label.said["derives"]
        return f": {made['to']} from {made['from']}"
    return f": {', '.join(row.kinds)}" if question.about in (BRINGS_IN, LETS_OUT) else ""


def _words(reply: Reply) -> str:
    """What a key says.

    >>> from rosprivacy.analysis.suggesting.question_rows import Reply
    >>> from rosprivacy.analysis.suggesting.written import WrittenLabel
    >>> _words(Reply("1", WrittenLabel("topics", "/t", {"only": ["Video"]}), True))
    'Video at most'
    """
    ((role, value),) = reply.label.said.items()
    if role == "sanitizer":
        return f"ends them ({', '.join(map(str, value.values()))})"
    if role == "only":
        return f"{', '.join(value)} at most"
    if reply.key == NOTHING:
        return "none of it"
    return {"conduit": "only passes on or drops", "leak": "lets out"}.get(role, "yes")
