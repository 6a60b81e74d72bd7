"""Names in label and fleet files: of categories, of elements, of bags (rules S7, S11).

In: one value with its line. Out: the category that it means, the name that it is, or the bags that are there; a problem
for what is none.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.ingest.labels.entries import END_KINDS, End, is_non_ros
from rosprivacy.ingest.reading.bounded_file import WIDEN, leaves, unusable, what_leaves
from rosprivacy.ingest.reading.format_reader import FileReader

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model.recording import Bag
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary


@dataclass(eq=False, repr=False)
class NameReader(FileReader):
    """Reads what label files name, and fleet files in the sections that both have.

    Attributes
    ----------
    of_fleet
        Whether it is a fleet file: there the end of a flow may name robots (``carrier_*:/uplink``), every flow is
        stated by its line, and no bag is read.
    root
        Folder that the bags which it names may not leave, links followed; empty for that of the file.
    """

    vocabulary: Vocabulary
    of_fleet: bool = field(default=False, kw_only=True)
    root: str = field(default="", kw_only=True)
    diagnostics: list[Diagnostic] = field(default_factory=list, kw_only=True)
    error: type[InputError] = field(default=LabelError, kw_only=True)

    def entries_of(self, value: Value, keys: tuple[str, ...]) -> Iterable[tuple[str, int, Value]]:
        """Return the entries of a map but for notes and authors, those with unknown keys reported."""
        for key, line, child in super().entries_of(value, keys):
            if key not in ("note", "author"):
                yield key, line, child
            elif key == "note" and child.kind != "text":
                self.problem(line, f"note takes text, not a {child.kind}", "write it, or remove it")

    def not_empty(self, value: Value, key: str) -> None:
        """Report a map that names nothing."""
        if not value.entries:
            self.problem(value.line, f"{key} names no category", "name one, such as {Video: …}, or remove it")

    def categories_of(self, value: Value, key: str) -> Iterable[str]:
        """Return the categories of a list, or of one text, that are known; the others are problems."""
        if value.kind == "empty" or (value.kind == "list" and not value.items):
            self.problem(value.line, f"{key} names no category", "name one, such as [Video], or remove it")
        for item in self.list_of(value, key):
            name = self.category_of(item)
            if name:
                yield name

    def category_of(self, value: Value) -> str:
        """Return the name of the category; empty where there is none, which is a problem."""
        if value.kind != "text":
            self.problem(value.line, f"a {value.kind} where a category is named", "write its name, such as Video")
            return ""
        return self.kind_of_data(value.text, value.line)

    def kind_of_data(self, written: str, line: int) -> str:
        """Return the category's name; rule S11: one that is not there is an error with the nearest."""
        name = self.category_of_name(self.vocabulary, written, line)
        if name and (new := self.vocabulary.respelt_as(written)):
            message = f"{shown(written)} is a former spelling; DPV spells it {new}"
            self.diagnostics.append(Diagnostic(Place(self.file, line), Severity.NOTICE, message))
        return name

    def end(self, value: Value) -> End:
        """Return an end of a flow: a name or glob of ROS, with its kind where that is said, or a name outside ROS."""
        if value.kind == "map":
            return self._end_of_kind(value)
        if value.kind == "text" and value.text and is_non_ros(value.text):
            return End(value.text)
        return End(self.absolute_name(value))

    def _end_of_kind(self, value: Value) -> End:
        entries = list(self.entries_of(value, END_KINDS))
        if len(entries) != 1:
            self.problem(value.line, "the end of a flow names one element", "write {topic: /map}, or {node: /map}, …")
            return End("")
        ((kind, _, name),) = entries
        return End(self.name_on_flow(name), kind)

    def name_on_flow(self, value: Value) -> str:
        """Return the name or glob of ROS at the end of a flow, in a fleet file with the robots that it is on."""
        robots, colon, name = value.text.partition(":")
        if self.of_fleet and value.kind == "text" and colon and robots and not is_non_ros(name):
            return value.text
        return self.absolute_name(value)

    def absolute_name(self, value: Value) -> str:
        """Return a name or glob of ROS as it is written; one that does not begin with ``/`` is a problem."""
        if value.kind != "text" or is_non_ros(value.text):
            self.problem(value.line, f"{shown(value.text or value.kind)!r} is not an absolute name", "begin it with /")
        elif len(value.text) > self.bounds.name:
            self.problem(value.line, *self.bounds.refusal("name", len(value.text)))
            return ""
        return value.text

    def bags_at(self, value: Value) -> tuple[Bag, ...]:
        """Return the bags that a storage names, relative to this file; none, and a problem, if they cannot be read."""
        if self.of_fleet:
            hint = "state the storage in a label file of the robot that it was recorded on"
            self.problem(value.line, "a bag in a fleet file", hint)
            return ()
        is_name = value.kind == "text" and value.text.isprintable()
        name = value.text if is_name else ""
        path = str(Path(self.file).parent / name)
        top = os.path.realpath(self.root or Path(self.file).parent)
        if not name or (why := unusable(path)):
            what = f"bag: {why}" if name else f"bag takes a path, not {shown(value.text) or f'a {value.kind}'!r}"
            self.problem(value.line, what, "write the bag's path, relative to this file")
        elif leaves(path, top):
            self.problem(value.line, what_leaves(name, top), WIDEN)
        else:
            from rosprivacy.ingest.running.bag_folders import read_bags  # noqa: PLC0415 - light start: few name a bag

            try:
                return read_bags([path])
            except InputErrors as error:
                first = error.errors[0]
                self.problem(value.line, f"bag {shown(first.file)}: {first.problem}", first.hint)
        return ()
