"""The rules of a table of types that suggest kinds of data -> ``Suggestion`` by type and leg.

In: the list ``suggests``, and what the same table says that types cannot carry. Out: suggestions; a type that was
looked at and suggests no kind has none, one that was not looked at is absent. A rule that suggests what the table
excludes is an error: one of the two lines is wrong.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Confidence, Place, Suggestion, kind_of_type
from rosprivacy.ingest.types.type_entries import LEGS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.kernel.type_limits import TypeLimit
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ingest.types.type_entries import Entry, EntryReader
    from rosprivacy.ontology.vocabulary import Vocabulary

Key = tuple[str, str]  # name of a type, leg
KEYS = ("types", "leg", "kinds", "confidence", "why", "source")
HINT = "write certain, likely or may"


def read_suggestions(
    reader: EntryReader, items: Iterable[Value], vocabulary: Vocabulary, limits: Mapping[Key, TypeLimit]
) -> dict[Key, tuple[Suggestion, ...]]:
    """Read the rules; their problems are noted at the reader."""
    found: dict[Key, tuple[Suggestion, ...]] = {}
    empty: dict[Key, int] = {}  # of those that suggest no kind, the line
    for item in items:
        entry = reader.entry(item, KEYS, vocabulary, both_legs=True)
        if entry is None:
            continue
        confidence = _confidence(reader, entry)
        for name, leg, line in entry.types:
            keys = [(name, leg)] if leg else [(name, one) for one in LEGS[kind_of_type(name)]]
            _contradicted(reader, entry, line, [limits.get(key) for key in keys])
            for key in keys:
                rules = found.setdefault(key, ())
                if twice := _twice(entry, rules, empty.get(key)):
                    reader.problem(line, f"{name} again, first in line {twice}", "say each kind once")
                    break
                if not entry.kinds:
                    empty[key] = entry.line
                elif confidence:
                    place = Place(reader.file, entry.line)
                    said = (confidence, entry.text("why"), entry.text("source"))
                    found[key] = (*rules, Suggestion(name, entry.kinds, *said, place))
    return found


def _confidence(reader: EntryReader, entry: Entry) -> Confidence | None:
    written = entry.text("confidence")
    if written in tuple(Confidence):
        if not entry.kinds:
            reader.problem(entry.said["confidence"].line, "a confidence, and no kind", "remove it, or name a kind")
        return Confidence(written)
    if "confidence" in entry.said:
        reader.problem(entry.said["confidence"].line, f"confidence {shown(written)!r}", HINT)
    elif entry.kinds:
        reader.problem(entry.line, "a suggestion without confidence", HINT)
    return None


def _contradicted(reader: EntryReader, entry: Entry, line: int, limits: list[TypeLimit | None]) -> None:
    """Note what the table excludes of every leg that the rule is about."""
    for kind in entry.kinds:
        against = [one for one in limits if one and kind in one.kinds]
        if len(against) == len(limits):
            what = f"it suggests {kind}, which line {against[0].place.line} says it cannot carry"
            reader.problem(line, what, "correct one of the two")


def _twice(entry: Entry, rules: tuple[Suggestion, ...], empty: int | None) -> int | None:
    """The line that says of a type what the entry says again, or denies."""
    if rules and not entry.kinds:
        return rules[0].place.line
    return empty or next((one.place.line for one in rules if not set(one.kinds).isdisjoint(entry.kinds)), None)
