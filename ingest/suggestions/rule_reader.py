"""What files of rules about names and about libraries have in common: kinds of data, marks that are true, items.

In: YAML values of one file. Out: what they say; what is wrong is noted, with its line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.ingest.reading.format_reader import FileReader

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

Read = TypeVar("Read")


def read_each(files: Iterable[str], read: Callable[[str], Read]) -> list[Read]:
    """Return what is read of each file, in their order; a file that is named twice is read once.

    Raises
    ------
    InputErrors
        With every problem of all of them.
    """
    found: list[Read] = []
    problems: list[InputError] = []
    for file in dict.fromkeys(files):
        try:
            found.append(read(file))
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    return found


@dataclass(eq=False, repr=False)
class RuleReader(FileReader):
    """Reads one file of rules."""

    vocabulary: Vocabulary

    def items(self, said: dict[str, Value], key: str) -> tuple[Value, ...]:
        """Return the items of a list; none where there is none."""
        return self.list_of(said[key], key) if key in said else ()

    def rule(self, item: Value, keys: tuple[str, ...], needed: tuple[str, ...]) -> dict[str, Value]:
        """Return what a rule says, by key; note what it lacks."""
        said = {key: value for key, _, value in self.entries_of(item, keys)}
        for key in needed:
            if key not in said or not (said[key].text or said[key].items):
                self.problem(item.line, f"a rule without {key}", f"write {', '.join(needed)}")
        return said

    def is_true(self, said: dict[str, Value], key: str) -> bool:
        """Return whether a mark is there; note one that says anything but true."""
        if key in said and said[key].text != "true":
            value = said[key]
            self.problem(value.line, f"{key} {shown(value.text or value.kind)!r}", "write true or leave it out")
        return key in said

    def kinds(self, said: dict[str, Value], key: str) -> Iterator[str]:
        """Yield the kinds of data that a list names; note what is none."""
        return (name for item in self.items(said, key) if (name := self.kind(item)))

    def kind(self, item: Value) -> str:
        """Return the kind of data that is named; empty, and noted, if there is none of that name."""
        category = self.vocabulary.find(item.text) if item.kind == "text" else None
        if category is None:
            hint = self.vocabulary.hint(item.text)
            self.problem(item.line, f"unknown category {shown(item.text or item.kind)!r}", hint)
            return ""
        return category.name
