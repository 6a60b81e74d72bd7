"""Suggestions in a label file: written there as comments, and made labels when a person accepts them (issue 21).

In: policies and label files, or the label file alone. Out: its new text, and what to tell about it.
"""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, LabelError
from rosprivacy.analysis.suggesting.next_questions import one_line
from rosprivacy.clock import today
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import NEW, facts_of
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.suggestions.accepting import accept
from rosprivacy.ingest.suggestions.comments import comment_of, taken_apart, with_comments
from rosprivacy.labelling.label_lines import Written, own_file
from rosprivacy.labelling.limits_on_the_way import brings, limits_on_the_way, limits_said
from rosprivacy.ontology.vocabulary import load
from rosprivacy.reading.robot_system import answer_robot, read_label_files

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.suggested_labels import Suggested
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


def with_suggestions(file: str, told: Suggested) -> Written:
    """Return a label file with what is suggested, in place of what was suggested before.

    Raises
    ------
    InputErrors
        With every problem of the input.
    LabelError
        If the file has no room for comments, as JSON has none.
    """
    vocabulary = told.result.vocabulary
    text = text_of(file)
    comments = [comment_of(one) for one in told.proposals if one.label not in told.by_hand]
    new = with_comments(taken_apart(file, text)[0], comments)
    check_room(file, text, new, vocabulary)
    return Written(file, new, len(comments))


def check_room(file: str, text: str, new: str, vocabulary: Vocabulary) -> None:
    """Hold a text with comments at its end against that without.

    Raises
    ------
    InputErrors
        If it is no label file.
    LabelError
        If the file has no room for comments, as JSON has none.
    """
    before = facts_of(parse_labels(text, vocabulary, name=file).entries)
    if text.lstrip().startswith("{") or facts_of(parse_labels(new, vocabulary, name=file).entries) != before:
        raise LabelError(file, 0, "has no room for comments at its end", "name a file in YAML, a line for each section")


def with_accepted(
    labels: tuple[str, ...],
    named: Sequence[str],
    by: str | None,
    settings: Settings,
    policies: tuple[str, ...] = (),
) -> Written:
    """Return the label file that people edit, with the suggestions in it that are accepted as labels.

    Parameters
    ----------
    policies
        Without them no findings are known, and so nothing is accepted that takes data away.
    named
        Confidences and names of elements.
    by
        Who accepts them; by default the author of the file.

    Raises
    ------
    InputErrors
        With every problem of the file.
    LabelError
        If it is not there: then there is nothing to accept.
    """
    file = own_file(labels)
    text = _read(file)
    who = who_says(file, by)
    vocabulary = load(ontologies=settings.ontologies)

    def read(new: str) -> tuple[str | Labels, ...]:
        """The label files, with that text of the one that is written."""
        own = parse_labels(new, vocabulary, name=file, category=settings.category, bounds=settings.bounds)
        return tuple(own if one == file else one for one in labels)

    def result(new: str) -> Result:
        return answer_robot(policies, read(new), settings)

    def known(new: str) -> list[tuple[str, str]]:
        return [(one.category, one_line(one)) for one in result(new).analysis.findings]

    done = accept(file, text, named, who, today(os.environ), vocabulary, known if policies else None)
    new_data = brings(done.labels)
    told: Iterable[str] = ()
    if new_data and policies:
        told = limits_on_the_way(result(text), result(done.text))
    elif new_data:
        told = limits_said(new_data, _own_labels(read(done.text), vocabulary, settings), vocabulary)
    return Written(file, done.text, done.count, (*done.remarks, *told))


def _own_labels(labels: tuple[str | Labels, ...], vocabulary: Vocabulary, settings: Settings) -> tuple[Labels, ...]:
    """What people have said, without what comes with the program."""
    return tuple(one for one in read_label_files(labels, vocabulary, settings) if not one.shipped)


def who_says(file: str, by: str | None, does: str = "accepts") -> str:
    """Return who accepts or answers: the one who is named, else the author of the file.

    Raises
    ------
    InputError
        If nobody is.
    """
    who = (by or _author(file, text_of(file))).strip()
    if not who:
        raise InputError(file, 0, f"nobody says who {does}", "add --by NAME, or 'author: NAME' to the file")
    return who


def text_of(file: str) -> str:
    """Return the text of a label file; of one that is not there the beginning of one.

    Raises
    ------
    LabelError
        If it cannot be read.
    """
    return _read(file) if Path(file).exists() else NEW


def _read(file: str) -> str:
    return read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))[0]


def _author(file: str, text: str) -> str:
    value = yaml_values.parse(text, partial(LabelError, file)).get("author")
    return value.text if value else ""
