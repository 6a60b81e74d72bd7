"""A question -> lines for the terminal: what is asked, of what, why, and which keys answer it; without colours."""

from __future__ import annotations

from string import ascii_uppercase
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.label_questions import (
    BRINGS_IN,
    GOES_ON,
    GOES_THROUGH,
    LETS_OUT,
    LISTED,
    MAKES,
    TYPED_AS,
)
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion, Reply, Row

QUESTIONS = {
    BRINGS_IN: ("Does it bring such data in?", "Which of these bring such data in?"),
    LETS_OUT: ("Does it let such data out: keep, show or send them elsewhere?", "Which of these let such data out?"),
    MAKES: ("Does it make such data?", "Which of these make such data?"),
    GOES_ON: ("What does it do with {kinds}?", "What do these do with {kinds}?"),
    GOES_THROUGH: ("Can {kinds} go through?", "Can {kinds} go through these?"),
}
LISTS = {
    "never": "Is it so that no {kinds} goes through any of these? Read each row: a wrong one hides a leak.",
    "only": "Is it so that of {kinds} only {left} goes through each of these? Read each row: a wrong one hides a leak.",
}
SUCH_DATA = "such data as stand beside it"  # where rows are about different kinds
KEYS = {  # a word, and what it means
    "x": ("yes, and no to the others", "yes to the rows that are picked, and no to all others"),
    "n": ("no", "no to all that stands there; it is remembered, and not asked again"),
    "o": ("one by one", "asks about each row by itself"),
    "k": ("kind by kind", "asks about each kind of data by itself"),
    "/": ("another label", TYPED_AS),
    "s": ("later", "not in this conversation any more; what you have written into the file meanwhile is read"),
    "u": ("undo", "takes the last answer back, and asks it anew"),
    "q": ("stop", "ends it; the same command goes on from there"),
    "?": ("help", "shows this"),
}
ALWAYS = ("/", "u", "q", "?")
PICK = "picks a row, or puts it back; other keys speak of the picked rows, or of all if none is picked"
ONE_FIRST = ": pick a row of which this can be said"
NEITHER = "neither", "none of these; it is remembered, and not asked again, and the node stays open"
PICKED_FIRST = ": pick the rows of which this can be said"
LISTED_FIRST = ": pick one row; or several, which are then shown and confirmed as a list"
OUT = "takes a row out of the list, or puts it back"
CLOSES_NONE, MAY_HANG = "of which this list closes none", "which may hang on this"
SHOWN = 3  # reasons of an element, findings of a question, kinds of a key


def question_lines(question: LabelQuestion) -> Iterator[str]:
    """Yield what is asked, each row with its reasons, and the findings that may hang on the answer."""
    rows = question.rows
    yield ""
    yield _question_text(question)
    for letter, row in zip(ascii_uppercase, rows, strict=False):
        at = f"{letter}  " if len(rows) > 1 else ""
        yield f"  {at}{row.element.kind} {shown(row.element.name)}{_of_row(question, row)}"
        several = 1 if len(rows) > 1 else SHOWN  # many rows fit on a screen; one by one they tell more
        most = several if question.about != LISTED and not row.doubtful else len(row.reasons)
        yield from (f"       {shown(reason)}" for reason in row.reasons[:most])
        if len(row.reasons) > most:
            yield f"       and {counted(len(row.reasons) - most, 'more reason')}"
    closes = dict.fromkeys(told for row in rows for told in row.closes)
    if closes and any(one.takes_away for row in rows for one in row.replies):
        yield f"  known findings, {CLOSES_NONE if question.about == LISTED else MAY_HANG}:"
        most = SHOWN if len(rows) > 1 else len(closes)
        yield from (f"       {shown(told)}" for told in list(closes)[:most])
        if len(closes) > most:
            yield f"       and {len(closes) - most} more findings"


def _question_text(question: LabelQuestion) -> str:
    rows = question.rows
    kinds = " and ".join(rows[0].kinds) if _same_kinds(rows) else SUCH_DATA
    if question.about != LISTED:
        return QUESTIONS[question.about][len(rows) > 1].format(kinds=kinds)
    ((role, left),) = rows[0].replies[0].label.roles.items()
    return LISTS[role].format(kinds=kinds, left=", ".join(left))


def help_lines(question: LabelQuestion, keys: Collection[str]) -> Iterator[str]:
    """Yield what each key means, one line each.

    Parameters
    ----------
    keys
        Those that answer the question as it is picked.
    """
    if len(question.rows) > 1:
        yield f"  A-Z  {OUT if question.about == LISTED else PICK}"
    if question.about == LISTED:
        yield "  the number of rows that are left, and Enter: it is so of all of these"
    said = {each.key: each for row in question.rows for each in row.replies}
    for key, reply in sorted(said.items(), key=lambda one: (one[0].isdigit(), one[0])):
        first = LISTED_FIRST if question.about == GOES_THROUGH else ONE_FIRST if reply.takes_away else PICKED_FIRST
        if question.about != LISTED:
            yield f"  {key}  {_words(reply, question.rows)}{'' if key in keys else first}"
    yield from (f"  {key}  {means}" for key, (_, means) in _meanings(question).items() if key in (*keys, *ALWAYS))


def _meanings(question: LabelQuestion) -> dict[str, tuple[str, str]]:
    return KEYS | ({"n": NEITHER} if question.about == GOES_ON else {})


def keys_line(question: LabelQuestion, picked: Collection[int], keys: Collection[str]) -> str:
    """Return which keys say what of the rows that are picked, or of all.

    Parameters
    ----------
    keys
        Those that answer the question as it is picked.
    """
    if question.about == LISTED:
        confirmed = _words(question.rows[0].replies[0], [])
        return _list_line(len(question.rows), picked, confirmed)
    of = f"{' '.join(ascii_uppercase[at] for at in sorted(picked))}: " if picked else ""
    of = of or ("all: " if len(question.rows) > 1 else "")
    rows = [row for at, row in enumerate(question.rows) if at in picked or not picked]
    said = [
        f"{one.key} {_words(one, rows)}{' (as a list)' if len(rows) > 1 and one.takes_away else ''}"
        for one in rows[0].replies
        if one.key in keys
    ]
    more = [f"{key} {word}" for key, (word, _) in _meanings(question).items() if key in (*keys, *ALWAYS)]
    letters = ["A-Z pick some"] if len(question.rows) > 1 else []
    return f"  {of}{', '.join([*said, *more, *letters])}"


def _list_line(rows: int, out: Collection[int], key: str) -> str:
    """How a list is confirmed.

    >>> _list_line(3, {1}, "Video at most").partition(", o ")[0]
    '  without B: 2 and Enter for Video at most in all 2, A-Z take out or put back'
    """
    left = rows - len(out)
    without = f"without {' '.join(ascii_uppercase[at] for at in sorted(out))}: " if out else ""
    confirm = f"{left} and Enter for {key} in all {left}, " if left > 1 else ""
    return f"  {without}{confirm}A-Z take out or put back, o not as a list, s later, u undo, q stop, ? help"


def _of_row(question: LabelQuestion, row: Row) -> str:
    """What a row is about, where rows differ in it."""
    if question.about == MAKES:
        (made,) = row.replies[0].label.roles["derives"]
        return f": {made['to']} from {made['from']}"
    differ = question.about in (BRINGS_IN, LETS_OUT) or not _same_kinds(question.rows)
    return f": {', '.join(row.kinds)}" if differ else ""


def _same_kinds(rows: Sequence[Row]) -> bool:
    return len({row.kinds for row in rows}) == 1


def _words(reply: Reply, rows: Sequence[Row]) -> str:
    """What a key says of rows, and of which kinds of data where there are several.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.label_questions import Reply, Row
    >>> from rosprivacy.analysis.suggesting.evidence import WrittenLabel
    >>> one = Reply("1", WrittenLabel("topics", "/t", {"only": ["Video"]}), True)
    >>> all_ = Reply("y", WrittenLabel("topics", "/t", {"sensitive": ["Video", "Voice"]}))
    >>> row = Row(Element("topic", "/t"), ("Video", "Voice"), (one, all_), ())
    >>> _words(one, [row]), _words(all_, [row])
    ('Video at most', 'yes (Video and Voice)')
    """
    ((role, value),) = reply.label.roles.items()
    if role == "sanitizer":
        return " and ".join(f"ends {kind} ({method})" for kind, method in value.items())
    if role == "only":
        return f"{', '.join(value)} at most"
    word = (
        "none of it" if role == "never" else {"conduit": "only passes on or drops", "leak": "lets out"}.get(role, "yes")
    )
    if all(len(row.kinds) == 1 for row in rows):
        return word
    kinds = " and ".join(value) if len(value) <= SHOWN else f"all {len(value)} kinds"
    return f"{word} ({kinds if _same_kinds(rows) else SUCH_DATA})"
