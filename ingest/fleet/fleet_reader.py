"""One fleet file: what it says of models, robots and groups, before these are put together (``fleet_file.py``).

In: values that know their line, and the reader of the file. Out: ``Spec``. The sections ``elements``, ``limits`` and
``flows`` are read by the reader of label files.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Place, Surroundings
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.labels.stated_facts import SURROUNDINGS
from rosprivacy.ingest.reading.bounded_file import unusable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.labels.label_reader import LabelReader
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


def text_of(reader: LabelReader, value: Value, use: str, form: re.Pattern[str] = ID, hint: str = ID_HINT) -> str:
    """Return a text of some form."""
    text = value.text if value.kind == "text" or value.text.isdigit() else ""
    if form.fullmatch(text):
        return text
    reader.problem(value.line, f"{shown(text or value.kind)!r} cannot be {use}", hint)
    return ""


def read_spec(reader: LabelReader, name: str, line: int, value: Value, keys: tuple[str, ...]) -> Spec:
    """Read the keys that models, robots and groups have in common."""
    spec = Spec(Place(reader.file, line))
    if value.kind not in ("map", "empty"):
        reader.problem(line, f"{name} is a map, not a {value.kind}", "write {policies: [robot.policy.xml]}")
    for key, at, said in reader.entries_of(value, keys):
        spec.lines[key] = at
        if key == "model":
            spec.model = text_of(reader, said, "a model")
        elif key in ("policies", "labels", "types"):
            setattr(spec, key, tuple(_files(reader, key, said)))
        elif key == "domain":
            spec.domain = text_of(reader, said, "a domain")
        elif key == "namespace":
            _namespace(reader, spec, said)
        elif key in SURROUNDINGS:
            spec.surroundings = reader.surrounded(spec.surroundings, key, said)
    return spec


def _files(reader: LabelReader, key: str, value: Value) -> Iterator[str]:
    for item in value.items if value.kind == "list" else (value,):
        if key != "types" and item.kind == "text" and item.text.startswith(OURS):
            yield item.text
        elif file := file_of(reader, item, key):
            yield file


def file_of(reader: LabelReader, item: Value, key: str) -> str:
    """Return the file that an item names, relative to this one; empty if it can name none."""
    named = item.kind == "text" and item.text and item.text.isprintable()
    file = str(Path(reader.file).parent / item.text) if named else ""
    what = f"a {item.kind}" if not named else f"{shown(item.text)}: {why}" if (why := unusable(file)) else ""
    if what:
        reader.problem(item.line, f"{key}: {what}", "name files, relative to this one")
    return "" if what else file


def _namespace(reader: LabelReader, spec: Spec, value: Value) -> None:
    entries = value.entries if value.kind == "map" else ()
    if [key for key, *_ in entries] not in (["strip"], ["add"]):
        reader.problem(value.line, "namespace takes strip or add", "write {strip: /robot} or {add: /robot}")
        return
    ((key, _, said),) = entries
    setattr(spec, key, text_of(reader, said, "a namespace", NAMESPACE, "write one such as /robot or /*"))
