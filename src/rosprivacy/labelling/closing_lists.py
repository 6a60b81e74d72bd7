"""Lists of channels that are alike, held against the analysis: none that a person can confirm closes a known finding.

In: a question about open channels, and the answer that it belongs to. Out: the question, of which the channels that
would close a finding are asked by themselves. That is no estimate: the labels are put on, and the analysis runs again.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.suggesting.question_rows import NOTHING
from rosprivacy.ingest.labels.label_file import parse_labels

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.suggesting.alike_channels import Alike
    from rosprivacy.analysis.suggesting.question_rows import Question, Row
    from rosprivacy.result import Result


def without_closing(question: Question, result: Result) -> Question:
    """Return a question whose rows are alike only where all of them together close no finding.

    Fewer labels close no more, so that rows can be taken out. One run of the analysis for each likeness; where it loses
    a finding, one for each row.
    """
    parts: dict[Alike, list[Row]] = defaultdict(list)
    for row in question.rows:
        parts[row.alike].append(row)
    apart: list[Row] = []
    for likeness, rows in parts.items():
        if likeness and len(rows) > 1:
            apart += closing(rows, result)
    if not apart:
        return question
    return question._replace(
        rows=tuple(row._replace(alike=frozenset()) if row in apart else row for row in question.rows)
    )


def closing(rows: Sequence[Row], result: Result) -> Sequence[Row]:
    """Return the channels of a list that would close a finding: those that do alone, or all if only several do."""
    if not _closes(rows, result):
        return ()
    alone = [row for row in rows if _closes([row], result)]
    return alone if alone and not _closes([row for row in rows if row not in alone], result) else rows


def _closes(rows: Sequence[Row], result: Result) -> bool:
    """Whether a finding is lost if nothing goes through channels; where nobody can tell, it is."""
    if result.again is None:
        return True
    sections: dict[str, dict[str, object]] = defaultdict(dict)
    for row in rows:
        reply = row.reply(NOTHING)
        if reply is None:
            return True
        sections[reply.label.section][reply.label.name] = reply.label.said
    text = json.dumps({"labels": 1, **sections})
    try:
        said = parse_labels(text, result.vocabulary, name="a list of channels")
        after = result.again((*result.labels, said))
    except InputErrors:  # they go against what a label says
        return True
    return not {one.id for one in result.analysis.findings} <= {one.id for one in after.analysis.findings}
