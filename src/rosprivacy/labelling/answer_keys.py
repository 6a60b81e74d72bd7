"""The keys that answer a question: which there are, and what they speak of (issue 21).

A letter from A on picks a row, or puts it back; all others speak of the picked rows, or of all if none is picked. ``x``
says yes to the picked rows and no to the others; ``k`` asks about each kind of data by itself.
"""

from __future__ import annotations

from string import ascii_uppercase
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.question_rows import GOES_THROUGH, PASSES, YES, Question

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from rosprivacy.analysis.suggesting.question_rows import Row

NO, OPEN, SKIP, QUIT, EXACTLY, EACH_KIND = "n", "o", "s", "q", "x", "k"
FEWEST = 2  # rows of a list: one row is asked by itself


def allowed(question: Question, picked: Collection[int] = ()) -> tuple[str, ...]:
    """Return the keys that answer a question about the rows that are picked, or about all.

    What takes data away of several channels asks about them as a list, if they are picked.
    """
    rows = tuple(row for at, row in enumerate(question.rows) if at in picked or not picked)
    keys = Question(question.about, rows).keys()
    if question.about == GOES_THROUGH and len(picked) >= FEWEST:
        keys += tuple(one.key for one in rows[0].replies if takes_away_of_each(rows, one.key))
    if len(rows) > 1 and not picked and any(row.doubtful for row in rows):
        keys = tuple(key for key in keys if key != PASSES)  # it may be a leak: look at each
    refuse = all(row.refused for row in question.rows)
    exactly = refuse and YES in keys and len(rows) < len(question.rows)
    by_kind = any(row.each for row in rows)
    more = ((EXACTLY, exactly), (NO, refuse), (OPEN, len(rows) > 1), (EACH_KIND, by_kind), (SKIP, True))
    return (*keys, *(key for key, there in more if there))


def letter(key: str) -> int:
    """Return which row a key means; -1 if none. Several signs that come at once are no letter."""
    return ascii_uppercase.find(key) if len(key) == 1 else -1


def takes_away_of_each(rows: Sequence[Row], key: str) -> bool:
    """Return whether a key takes data away of each of some rows."""
    replies = [row.reply(key) for row in rows]
    return all(reply and reply.takes_away for reply in replies)
