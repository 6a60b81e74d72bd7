"""One fleet file: what it says of models, robots and groups, before these are put together (``fleet_file.py``).

In: values that know their line. Out: ``Spec``. The sections ``elements``, ``limits`` and ``flows`` are read as in label
files.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Place, Surroundings
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.labels.label_reader import SURROUNDINGS, LabelReader
from rosprivacy.ingest.labels.non_ros_reader import is_non_ros
from rosprivacy.ingest.reading.confined import unusable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model.recording import Bag
    from rosprivacy.ingest.reading.yaml_values import Value

ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,199}")
ID_HINT = "use letters, digits and _ . -, at most 200"
NAMESPACE = re.compile(r"(/[A-Za-z_*][A-Za-z0-9_*]*)+")
SPEC = ("policies", "labels", "types", "domain", "namespace", *SURROUNDINGS)
ROBOT_KEYS, GROUP_KEYS = ("model", *SPEC, "note"), ("robots", "id", "model", *SPEC, "note")
SECTIONS = (
    "name",
    "include",
    "models",
    "infrastructure",
    "robots",
    "groups",
    "elements",
    "limits",
    "flows",
    *SURROUNDINGS,
    "note",
)


@dataclass
class Spec:
    """What is said of a model, a robot or a group, before these are put together."""

    place: Place
    model: str = ""
    policies: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    domain: str = ""
    strip: str = ""
    add: str = ""
    surroundings: Surroundings = field(default_factory=Surroundings)
    lines: dict[str, int] = field(default_factory=dict)


class FleetReader(LabelReader):
    """One fleet file: the sections that label files have too are read as there."""

    def bags_at(self, value: Value) -> tuple[Bag, ...]:
        """Return none, and a problem: nobody could say from which robots the topics of a bag are."""
        hint = "state the storage in a label file of the robot that it was recorded on"
        self.problem(value.line, "a bag in a fleet file", hint)
        return ()

    def states(self, ends: Iterable[str]) -> bool:  # noqa: ARG002 - whatever they are
        """Return True: no policy knows of a flow between robots."""
        return True

    def name_on_flow(self, value: Value) -> str:
        """Return the name at the end of a flow, with the robots that it is on."""
        robots, colon, name = value.text.partition(":")
        if value.kind == "text" and colon and robots and not is_non_ros(name):
            return value.text
        return super().name_on_flow(value)

    def text_of(self, value: Value, what: str, form: re.Pattern[str] = ID, hint: str = ID_HINT) -> str:
        """Return a text of some form."""
        text = value.text if value.kind == "text" or value.text.isdigit() else ""
        if form.fullmatch(text):
            return text
        self.problem(value.line, f"{shown(text or value.kind)!r} cannot be {what}", hint)
        return ""

    def spec(self, name: str, line: int, value: Value, keys: tuple[str, ...]) -> Spec:
        """Read the keys that models, robots and groups have in common."""
        spec = Spec(Place(self.file, line))
        if value.kind not in ("map", "empty"):
            self.problem(line, f"{name} is a map, not a {value.kind}", "write {policies: [robot.policy.xml]}")
        for key, at, said in self.entries_of(value, keys):
            spec.lines[key] = at
            if key == "model":
                spec.model = self.text_of(said, "a model")
            elif key in ("policies", "labels", "types"):
                setattr(spec, key, tuple(self._files(key, said)))
            elif key == "domain":
                spec.domain = self.text_of(said, "a domain")
            elif key == "namespace":
                self._namespace(spec, said)
            elif key in SURROUNDINGS:
                spec.surroundings = self.surrounded(spec.surroundings, key, said)
        return spec

    def _files(self, key: str, value: Value) -> Iterator[str]:
        for item in value.items if value.kind == "list" else (value,):
            if key != "types" and item.kind == "text" and item.text.startswith(OURS):
                yield item.text
            elif file := self.file_of(item, key):
                yield file

    def file_of(self, item: Value, key: str) -> str:
        """Return the file that an item names, relative to this one; empty if it can name none."""
        named = item.kind == "text" and item.text and item.text.isprintable()
        file = str(Path(self.file).parent / item.text) if named else ""
        what = f"a {item.kind}" if not named else f"{shown(item.text)}: {why}" if (why := unusable(file)) else ""
        if what:
            self.problem(item.line, f"{key}: {what}", "name files, relative to this one")
        return "" if what else file

    def _namespace(self, spec: Spec, value: Value) -> None:
        entries = value.entries if value.kind == "map" else ()
        if [key for key, *_ in entries] not in (["strip"], ["add"]):
            self.problem(value.line, "namespace takes strip or add", "write {strip: /robot} or {add: /robot}")
            return
        ((key, _, said),) = entries
        setattr(spec, key, self.text_of(said, "a namespace", NAMESPACE, "write one such as /robot or /*"))
