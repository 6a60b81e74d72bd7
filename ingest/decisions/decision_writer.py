"""A decision into the text of a decisions file: what people wrote there, comments and order included, stays.

In: the text, or none, and an entry. Out: the new text. ruamel.yaml changes the one entry and writes the rest back; what
comes out is read anew, and given out only if every other decision and every comment is still there.
"""

from __future__ import annotations

from contextlib import suppress
from copy import deepcopy
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rosprivacy.analysis.errors import DecisionError, InputError, shown
from rosprivacy.analysis.model import Acceptance, Place
from rosprivacy.ingest.decisions.decisions_file import LISTS, OF_DOUBTS, TARGET, parse_decisions
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.kept_yaml import FAILURES, changed, keeps_comments
from rosprivacy.ingest.reading.path_kinds import exists
from rosprivacy.ingest.reading.yaml_values import MAX_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from rosprivacy.analysis.decisions import Decision, Decisions
    from rosprivacy.ontology.vocabulary import Vocabulary

NEW = """\
# What was decided about findings of rosprivacy: accept, mitigate, delegate or avoid.
decisions: 1
findings: []
"""
FINDINGS, DOUBTS = "findings", "doubts"  # sections of the file
_NOWHERE = Place("", 0)


def with_decision(
    file: str, text: str | None, entry: Mapping[str, Any], remark: str, vocabulary: Vocabulary, section: str = FINDINGS
) -> str:
    """Return the text of a decisions file with an entry added, or changed where there is one with the same target.

    Of an entry that is there, only its history and note stay: what it said goes into the history.

    Parameters
    ----------
    text
        Of the file as it is; None if there is none.
    entry
        Key -> value; dates as ``datetime.date``.
    remark
        For people, as a comment beside the id; empty for none.
    section
        What it is about: ``findings`` or ``doubts``.

    Raises
    ------
    InputErrors
        If the file is not a decisions file, or the entry is not a decision.
    DecisionError
        If it cannot be written without losing something.
    """
    old = NEW if text is None else text
    before = _entries_of(parse_decisions(file, old, vocabulary, ""), section)
    try:
        new, place = _written(old, entry, remark, section)
    except FAILURES as error:
        raise _by_hand(file, f"cannot be changed: {shown(str(error).splitlines()[0])}") from None
    after = _entries_of(parse_decisions(file, new, vocabulary, ""), section)
    others = [*before[:place], *before[place + 1 :]]
    if _facts([*after[:place], *after[place + 1 :]]) != _facts(others) or len(after) != max(len(before), place + 1):
        raise _by_hand(file, "cannot be changed without changing another decision")
    if not keeps_comments(old, new):
        raise _by_hand(file, "cannot be changed without losing a comment")
    return new


def text_in(file: Path) -> str | None:
    """Return what is in a decisions file; None if it is not there.

    Raises
    ------
    DecisionError
        If it cannot be read.
    """
    if not exists(file) and not file.is_symlink():
        return None
    fail = partial(DecisionError, str(file))
    try:
        return read_regular(str(file), MAX_BYTES, fail).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise fail(1, "not UTF-8", "save the file as UTF-8") from None


def _by_hand(file: str, problem: str) -> InputError:
    return DecisionError(file, 0, problem, "add the entry by hand")


def _entries_of(decisions: Decisions, section: str) -> tuple[Decision, ...] | tuple[Acceptance, ...]:
    return decisions.entries if section == FINDINGS else decisions.doubts


def _facts(entries: Iterable[Decision | Acceptance]) -> list[Decision | Acceptance]:
    return [e._replace(place=_NOWHERE) if isinstance(e, Acceptance) else replace(e, place=_NOWHERE) for e in entries]


def _written(text: str, entry: Mapping[str, Any], remark: str, section: str) -> tuple[str, int]:
    """The new text, and the number of the entry in it."""
    places: list[int] = []

    entry = {
        key: _on_one_line(value) if key == "made_about" else _in_brackets(value) if key in LISTS else value
        for key, value in entry.items()
    }

    def change(top: Any) -> None:
        entries = _entries(top, section)
        place = next((i for i, there in enumerate(entries) if _target(there) == _target(entry)), len(entries))
        places.append(place)
        if place == len(entries):
            entries.append(CommentedMap(entry))
            if remark and "id" in entry and not (entries.fa.flow_style() or top.fa.flow_style()):
                entries[place].yaml_add_eol_comment(shown(remark), "id")
        else:
            _change(entries[place], entry)

    return changed(text, change), places[0]


def _on_one_line(about: Mapping[str, Any]) -> CommentedMap:
    """Lists of names in [ ], or those of a large fleet would be the most of the file."""
    made = CommentedMap(about)
    for key, value in made.items():
        if isinstance(value, list):
            made[key] = _in_brackets(value)
    return made


def _in_brackets(names: Iterable[str]) -> CommentedSeq:
    made = CommentedSeq(names)
    made.fa.set_flow_style()
    return made


def _change(previous: Any, entry: Mapping[str, Any]) -> None:
    """Say it anew and whole, so that no end is inherited; what it said before goes into ``history``, latest last."""
    same = (*TARGET, *OF_DOUBTS, "history", "note")
    before, after = ({key: each[key] for key in each if key not in same} for each in (previous, entry))
    if {**before, "date": ""} != {**after, "date": ""}:
        previous.setdefault("history", CommentedSeq()).append(CommentedMap(deepcopy(before)))  # no alias
        for key in before.keys() - entry.keys():
            del previous[key]
    previous.update(entry)


def _entries(top: Any, section: str) -> Any:
    """The list of entries; a new one where there is none yet."""
    entries = top.get(section)
    if not entries:
        fresh = CommentedSeq()
        with suppress(KeyError):  # comments that stand after an empty list go with the key
            fresh.ca.comment = entries.ca.comment if entries is not None else None
        top[section] = fresh
    return top[section]


def _target(entry: Mapping[str, Any]) -> dict[str, object]:
    said = {key: entry[key] for key in dict.fromkeys((*TARGET, *OF_DOUBTS)) if key in entry}
    return {key: set(value) if isinstance(value, list) else str(value) for key, value in said.items()}
