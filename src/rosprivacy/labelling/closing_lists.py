"""Lists of channels, held against the analysis: none that a person can confirm closes a known finding.

In: channels of which one thing is said together, and the answer that they belong to. Out: those that would close a
finding; they are asked by themselves. That is no estimate: the labels are put on, and the analysis runs again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.suggesting.question_rows import NOTHING
from rosprivacy.labelling.question_order import by_likeness
from rosprivacy.labelling.tried_labels import with_more

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.suggesting.question_rows import Question, Row
    from rosprivacy.result import Result


def without_closing(question: Question, result: Result) -> Question:
    """Return a question whose rows are alike only where all of them together close no finding.

    Fewer labels close no more, so that rows can be taken out. One run of the analysis for each likeness; where it loses
    a finding, one for each row.
    """
    apart: list[Row] = []
    for rows in by_likeness(question.rows):
        if rows[0].alike and len(rows) > 1 and _closes([row.saying(NOTHING) for row in rows], result):
            apart += _by_themselves(rows, result)
    if not apart:
        return question
    return question._replace(
        rows=tuple(row._replace(alike=frozenset()) if row in apart else row for row in question.rows)
    )


def _by_themselves(rows: Sequence[Row], result: Result) -> Sequence[Row]:
    """The channels of a list that would close a finding: those that do alone, or all if only several do."""
    alone = [row for row in rows if _closes([row.saying(NOTHING)], result)]
    left = [row.saying(NOTHING) for row in rows if row not in alone]
    return alone if alone and not _closes(left, result) else rows


def closing(rows: Sequence[Row], result: Result) -> Sequence[Row]:
    """Return the channels that a list of a person's cannot have: those that would close a finding with those before.

    More labels close no less, so that what is left closes none.

    Parameters
    ----------
    rows
        With the one reply that is said of each.
    """
    if not _closes(rows, result):
        return ()
    left: list[Row] = []
    for row in rows:
        if not _closes([*left, row], result):
            left.append(row)
    return [row for row in rows if row not in left]


def _closes(rows: Sequence[Row], result: Result) -> bool:
    """Whether a finding is lost by what is said of channels; where nobody can tell, it is."""
    try:
        after = with_more(result, (reply.label for row in rows for reply in row.replies), "a list of channels")
    except InputErrors:  # they go against what a label says
        return True
    if after is None:
        return True
    return not {one.id for one in result.analysis.findings} <= {one.id for one in after.analysis.findings}
