"""Questions about a robot, and what becomes of the answers: labels and refusals in the label file (issue 21).

In: policies and label files. Out: the questions that are asked now; a file with what was said of one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.next_questions import questions
from rosprivacy.analysis.suggesting.question_rows import LISTED
from rosprivacy.analysis.suggesting.traffic import traffic
from rosprivacy.ingest.suggestions.accepting import NewLabel, with_labels
from rosprivacy.ingest.suggestions.refusals import refusal, with_refusals
from rosprivacy.labelling.answer_keys import NO
from rosprivacy.labelling.closing_lists import without_closing
from rosprivacy.labelling.label_lines import Written
from rosprivacy.labelling.refused import refused_in
from rosprivacy.labelling.suggested_lines import check_room, text_of
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.suggesting.question_rows import Question
    from rosprivacy.analysis.suggesting.written import WrittenLabel
    from rosprivacy.labelling.suggested_labels import Suggested
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


def asked_now(told: Suggested) -> tuple[Question, ...]:
    """Return what a person is asked under the labels that there are; no list of channels would close a finding."""
    result = told.result
    graph = result.analysis.graph
    hierarchy = result.vocabulary.hierarchy
    read = traffic(graph, result.bound)
    made = questions(told.proposals, result.analysis, result.bound, read, hierarchy, refused_in(result).says)
    return tuple(without_closing(one, result) for one in made)


def with_answer(file: str, question: Question, key: str, who: str, day: str, settings: Settings) -> Written:
    """Return a label file with what a person has said of all rows of a question.

    Raises
    ------
    InputErrors
        If the file is no label file, or cannot be changed without losing something.
    """
    text, vocabulary = _begun(file, settings)
    if key == NO:
        lines = [refusal(label, who, day) for row in question.rows for label in row.refused]
        new = with_refusals(text, lines)
        check_room(file, text, new, vocabulary)
        return Written(file, new, len(lines))
    done = with_labels(
        file, text, list(_labels(question, key, f"answered by {who} on {day}{_in_list(question)}")), vocabulary
    )
    return Written(file, done.text, done.count, done.remarks)


def with_label(file: str, label: WrittenLabel, who: str, day: str, settings: Settings) -> Written:
    """Return a label file with a label that a person has typed.

    Raises
    ------
    InputErrors
        If the file is no label file, or cannot be changed without losing something.
    """
    text, vocabulary = _begun(file, settings)
    done = with_labels(file, text, [NewLabel(*label, f"typed by {who} on {day}")], vocabulary)
    return Written(file, done.text, done.count, done.remarks)


def _begun(file: str, settings: Settings) -> tuple[str, Vocabulary]:
    """The text of a label file that has room for answers, and in whose words it is written."""
    text = text_of(file)
    vocabulary = load(ontologies=settings.ontologies)
    check_room(file, text, with_refusals(text, ()), vocabulary)
    return text, vocabulary


def _labels(question: Question, key: str, note: str) -> Iterator[NewLabel]:
    for row in question.rows:
        reply = row.reply(key)
        if reply:
            why = f": {'; '.join(reply.reasons)}" if reply.reasons else ""
            yield NewLabel(*reply.label, f"{note}{why}")


def _in_list(question: Question) -> str:
    """Who reads the label later sees that it was not looked at by itself."""
    return f" in a list of {len(question.rows)}" if question.about == LISTED else ""
