"""Which questions come first, and which rows are one list.

In: questions. Out: their stage; what has to be known before; rows by what they share.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.question_rows import BRINGS_IN, GOES_ON, GOES_THROUGH, LETS_OUT, LISTED, MAKES

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from rosprivacy.analysis.suggesting.alike_channels import Alike
    from rosprivacy.analysis.suggesting.question_rows import Question, Row

STAGES = {
    BRINGS_IN: 0,
    LETS_OUT: 0,
    MAKES: 0,
    GOES_ON: 1,
    GOES_THROUGH: 2,
    LISTED: 2,
}  # a leak of one is known before the next


def waits(question: Question, answered: Collection[int]) -> bool:
    """Return whether what some stages were answered has to be worked out before a question can be asked."""
    stage = STAGES[question.about]
    return any(one < stage for one in answered) or (bool(answered) and _tells_findings(question))


def _tells_findings(question: Question) -> bool:
    """Whether a question has to tell findings that an answer before it may have made known: a leak among nodes is one.

    No answer about a channel makes a finding known.
    """
    takes_away = any(reply.takes_away for row in question.rows for reply in row.replies)
    return takes_away and question.about != GOES_THROUGH


def by_likeness(rows: Iterable[Row]) -> tuple[tuple[Row, ...], ...]:
    """Return the rows that share what they are alike in, and their kinds, together; in their order."""
    parts: dict[tuple[Alike, tuple[str, ...]], list[Row]] = {}
    for row in rows:
        parts.setdefault((row.alike, row.kinds), []).append(row)
    return tuple(map(tuple, parts.values()))
