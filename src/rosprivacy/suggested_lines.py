"""Suggestions in a label file: written there as comments, and made labels when a person accepts them (issue 21).

In: policies and label files, or the label file alone. Out: its new text, and what to tell about it.
"""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, LabelError
from rosprivacy.clock import today
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import NEW, facts_of
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.suggestions.accepting import accept
from rosprivacy.ingest.suggestions.comments import comment_of, taken_apart, with_comments
from rosprivacy.label_lines import Written, own_file
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.settings import Settings
    from rosprivacy.suggesting import Suggested


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
    text = _text(file)
    comments = [comment_of(one) for one in told.proposals if one.label not in told.by_hand]
    new = with_comments(taken_apart(file, text)[0], comments)
    before = facts_of(parse_labels(text, vocabulary, name=file).entries)
    if text.lstrip().startswith("{") or facts_of(parse_labels(new, vocabulary, name=file).entries) != before:
        raise LabelError(file, 0, "has no room for comments at its end", "name a file in YAML, a line for each section")
    return Written(file, new, len(comments))


def with_accepted(labels: tuple[str, ...], named: Sequence[str], by: str | None, settings: Settings) -> Written:
    """Return the label file that people edit, with the suggestions in it that are accepted as labels.

    Parameters
    ----------
    named
        Confidences and names of elements.
    by
        Who accepts them; by default the author of the file.

    Raises
    ------
    InputErrors
        With every problem of the file.
    """
    file = own_file(labels)
    text = _text(file)
    who = (by or _author(file, text)).strip()
    if not who:
        raise InputError(file, 0, "nobody says who accepts", "add --by NAME, or 'author: NAME' to the file")
    vocabulary = load(ontologies=settings.ontologies)
    done = accept(file, text, named, who, today(os.environ), vocabulary)
    return Written(file, done.text, done.count, done.remarks)


def _text(file: str) -> str:
    if not Path(file).exists():
        return NEW
    return read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))[0]


def _author(file: str, text: str) -> str:
    value = yaml_values.parse(text, partial(LabelError, file)).get("author")
    return value.text if value else ""
