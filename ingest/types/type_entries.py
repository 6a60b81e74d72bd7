"""An entry of a table of types: for which types, or a leg of them, it says something of which kinds, and its reason.

In: a value of the file. Out: ``Entry``, or the problems of the file with their lines.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import kind_of_type
from rosprivacy.ingest.reading.format_reader import FileReader

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

LEGS = {"topic": ("",), "service": ("request", "response"), "action": ("request", "response")}
NEEDED = ("types", "kinds", "why", "source")


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry.

    Attributes
    ----------
    types
        (Name of a type, leg as written, line).
    kinds
        Names of categories.
    said
        All that it says, by key.
    """

    line: int
    types: tuple[tuple[str, str, int], ...]
    kinds: tuple[str, ...]
    said: Mapping[str, Value]

    def text(self, key: str) -> str:
        """Return what it says under a key; empty for nothing."""
        return self.said[key].text if key in self.said else ""


class EntryReader(FileReader):
    """Reads entries of a table."""

    def entry(
        self, item: Value, keys: tuple[str, ...], vocabulary: Vocabulary, *, both_legs: bool = False
    ) -> Entry | None:
        """Read an entry; None if it does not say for which types or of which kinds.

        Parameters
        ----------
        keys
            Those that it may have.
        both_legs
            Whether a type with two legs may stand without one.
        """
        said = {key: value for key, _, value in self.entries_of(item, keys)}
        for key in NEEDED:
            if key not in said:
                self.problem(item.line, f"an entry without {key}", "write {types: […], kinds: […], why: …, source: …}")
        if not {"types", "kinds"} <= said.keys():
            return None
        kinds = tuple(self._kinds(said["kinds"], vocabulary))
        leg = said["leg"].text if "leg" in said else ""
        return Entry(item.line, tuple(self._types(said["types"], leg, both_legs=both_legs)), kinds, said)

    def _types(self, value: Value, leg: str, *, both_legs: bool) -> Iterator[tuple[str, str, int]]:
        for one in self.list_of(value, "types"):
            kind = kind_of_type(one.text)
            if not kind:
                self.problem(
                    one.line, f"{shown(one.text or one.kind)!r} is not the name of a type", "write pkg/msg/Name"
                )
            elif leg not in LEGS[kind] and not (both_legs and not leg):
                legs = " or ".join(LEGS[kind])
                hint = f"write leg: {legs}" if legs else "remove its leg"
                self.problem(one.line, f"{one.text} is the type of a {kind}", hint)
            else:
                yield one.text, leg, one.line

    def _kinds(self, value: Value, vocabulary: Vocabulary) -> Iterator[str]:
        for item in self.list_of(value, "kinds"):
            category = vocabulary.find(item.text) if item.kind == "text" else None
            if category is None:
                self.problem(item.line, f"unknown category {shown(item.text)!r}", vocabulary.hint(item.text))
            else:
                yield category.name
