"""Files of observed message types -> ``TypesFile``: which types channels have, and who was seen with them.

In: YAML or JSON as ``rosprivacy observe`` writes it, read only where ``--types`` names it. Out: facts, each with its
line, not yet joined to a graph (``channel_types.py`` does that). All problems of a file are raised at once. What a
type is called is anybody's word: one that is no name of a type is kept as it was seen, since it may be a second type
of the channel (rule S15).
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import TypesError, shown
from rosprivacy.ingest.reading.format_reader import FileReader, read_values

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value

TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)")
LONGEST = 500  # characters of a type, a hash or a door
ENDS = {"topics": ("writers", "readers"), "services": ("servers", "clients"), "actions": ("servers", "clients")}
PARTS = {"topics": ("fields",), "services": ("request", "response"), "actions": ("request", "response")}
KINDS = {"topics": "topic", "services": "service", "actions": "action"}


@dataclass(frozen=True, slots=True)
class SeenType:
    """A type that was seen on a channel.

    Attributes
    ----------
    ends
        Names of nodes: the writers and readers of a topic, the servers and clients of a service or an action.
    line
        Of the file; 0 where there is none.
    definition
        The file that defines it, where one was read.
    fields
        The known types that the fields of that definition are: of a message, or of request and response.
    """

    type: str
    hash: str = ""
    ends: tuple[tuple[str, ...], tuple[str, ...]] = ((), ())
    first: str = ""
    last: str = ""
    line: int = 0
    definition: str = ""
    fields: tuple[tuple[str, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class SeenChannel:
    """A channel, of kind ``topic``, ``service`` or ``action``, with the types that were seen on it."""

    kind: str
    name: str
    types: tuple[SeenType, ...]


@dataclass(frozen=True, slots=True)
class ObservedTypes:
    """From when to when was looked, and by which doors."""

    start: str = ""
    end: str = ""
    by: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class TypesFile:
    """A file of observed types."""

    file: str
    sha256: str
    observed: ObservedTypes
    channels: tuple[SeenChannel, ...]


def read_types(file: str, bounds: Bounds = BOUNDS) -> TypesFile:
    """Read a file of observed types.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``TypesError`` of one line.
    """
    top, data = read_values(file, partial(TypesError, file), bounds)
    reader = _TypesReader(file, error=TypesError, bounds=bounds)
    observed, channels = reader.whole(reader.document(top))
    return TypesFile(file, hashlib.sha256(data).hexdigest(), observed, channels)


def as_dict(types: TypesFile) -> dict[str, Any]:
    """Return a file of types as plain values, with the lines of its types: for a saved graph.

    >>> seen = SeenType("std_msgs/msg/Bool", ends=(("/door",), ()), line=5)
    >>> as_dict(TypesFile("t.yaml", "", ObservedTypes(), (SeenChannel("topic", "/open", (seen,)),)))["topics"]
    {'/open': [{'type': 'std_msgs/msg/Bool', 'line': 5, 'writers': ['/door']}]}
    """
    observed = {"from": types.observed.start, "to": types.observed.end, "by": list(types.observed.by)}
    saved: dict[str, Any] = {"file": types.file, "sha256": types.sha256, "observed": _filled(observed)}
    for section, kind in KINDS.items():
        saved[section] = {c.name: [_span(one, section) for one in c.types] for c in types.channels if c.kind == kind}
    return saved


def from_dict(saved: Mapping[str, Any]) -> TypesFile:
    """Return what ``as_dict`` was made from.

    >>> seen = SeenType("std_msgs/msg/Bool", ends=(("/door",), ()), line=5)
    >>> types = TypesFile("t.yaml", "", ObservedTypes(), (SeenChannel("topic", "/open", (seen,)),))
    >>> from_dict(as_dict(types)) == types
    True
    """
    said = saved["observed"]
    channels = [
        SeenChannel(kind, name, tuple(_of_saved(one, section) for one in some))
        for section, kind in KINDS.items()
        for name, some in sorted(saved[section].items())
    ]
    observed = ObservedTypes(said.get("from", ""), said.get("to", ""), tuple(said.get("by", ())))
    return TypesFile(saved["file"], saved["sha256"], observed, tuple(channels))


def _span(seen_type: SeenType, section: str) -> dict[str, Any]:
    ends = {name: list(nodes) for name, nodes in zip(ENDS[section], seen_type.ends, strict=True)}
    more = _filled({"hash": seen_type.hash, "first": seen_type.first, "last": seen_type.last, **ends})
    more |= written_definition(seen_type, section)
    return {"type": seen_type.type, "line": seen_type.line, **more}


def written_definition(seen_type: SeenType, section: str) -> dict[str, Any]:
    """Return what a file of types says of a definition.

    >>> written_definition(SeenType("a/srv/A", definition="srv/A.srv", fields=(("std_msgs/msg/Bool",), ())), "services")
    {'definition': 'srv/A.srv', 'request': ['std_msgs/msg/Bool']}
    """
    parts = zip(PARTS[section], map(list, seen_type.fields), strict=False)  # no parts where nothing is defined
    return _filled({"definition": seen_type.definition, **dict(parts)})


def _of_saved(saved: Mapping[str, Any], section: str) -> SeenType:
    first, second = (tuple(saved.get(name, ())) for name in ENDS[section])
    texts = (saved.get("hash", ""), (first, second), saved.get("first", ""), saved.get("last", ""))
    fields = tuple(tuple(saved.get(part, ())) for part in PARTS[section]) if "definition" in saved else ()
    return SeenType(saved["type"], *texts, saved["line"], saved.get("definition", ""), fields)


def _filled(values: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value}


@dataclass
class _TypesReader(FileReader):
    """One file of types."""

    channels: list[SeenChannel] = field(default_factory=list)

    def document(self, top: Value) -> tuple[ObservedTypes, tuple[SeenChannel, ...]]:
        if not self.is_format(top, "types", "a file of types"):
            return ObservedTypes(), ()
        observed = ObservedTypes()
        for key, _, value in self.entries_of(top, ("types", "observed", *KINDS)):
            if key == "observed":
                observed = self._observed(value)
            elif key in KINDS:
                self.channels += self._section(key, value)
        order = list(KINDS.values())
        return observed, tuple(sorted(self.channels, key=lambda one: (order.index(one.kind), one.name)))

    def _observed(self, value: Value) -> ObservedTypes:
        if value.kind != "map":
            self.problem(value.line, f"observed is a map, not a {value.kind}", "write {from: …, to: …, by: [dds]}")
            return ObservedTypes()
        said = self.values_of(value, ("from", "to", "by"))
        start, end = (self._time(said[key], key) if key in said else "" for key in ("from", "to"))
        doors = self.list_of(said["by"], "by") if "by" in said else ()
        return ObservedTypes(start, end, tuple(filter(None, (self._text(door, "by") for door in doors))))

    def _section(self, section: str, value: Value) -> Iterator[SeenChannel]:
        if value.kind not in ("map", "empty"):
            self.problem(value.line, f"{section} is a map, not a {value.kind}", "write /name: [{type: …}]")
        for name, line, types in value.entries:
            if not name.startswith("/") or len(name) > self.bounds.name:
                self.problem(line, f"{shown(name)!r} is not the name of a channel", "begin it with /")
                continue
            items = self.list_of(types, shown(name), "write [{type: …}]")
            seen = [one for item in items if (one := self._type(item, section))]
            yield SeenChannel(KINDS[section], name, tuple(seen))

    def _type(self, item: Value, section: str) -> SeenType | None:
        ends = ENDS[section]
        parts = PARTS[section]
        said = self.values_of(item, ("type", "hash", *ends, "first", "last", "definition", *parts))
        if item.kind != "map" or "type" not in said:
            self.problem(item.line, "what was seen needs a type", "write {type: sensor_msgs/msg/Image}")
            return None
        first, second = (self._texts(said[end], end) if end in said else () for end in ends)
        begun, ended = (self._time(said[key], key) if key in said else "" for key in ("first", "last"))
        text = self._text(said["type"], "type")
        definition = self._text(said["definition"], "definition") if "definition" in said else ""
        fields = tuple(self._texts(said[part], part) if part in said else () for part in parts) if definition else ()
        seen = SeenType(text, self._hash(said), (first, second), begun, ended, item.line, definition, fields)
        return seen if text else None

    def _hash(self, entries: Mapping[str, Value]) -> str:
        return self._text(entries["hash"], "hash") if "hash" in entries else ""

    def _texts(self, value: Value, key: str) -> tuple[str, ...]:
        return tuple(sorted({name for item in self.list_of(value, key) if (name := self._text(item, key))}))

    def _text(self, value: Value, key: str) -> str:
        longest = self.bounds.name if key in ("writers", "readers", "servers", "clients", "definition") else LONGEST
        if value.kind != "text" or not value.text or len(value.text) > longest:
            problem = f"{key} takes text of at most {longest} characters, not {shown(value.text[:40]) or value.kind!r}"
            self.problem(value.line, problem, "observe again, or correct it")
            return ""
        return value.text

    def _time(self, value: Value, key: str) -> str:
        if value.kind not in ("text", "number") or not TIME.fullmatch(value.text):
            text = f"{key} takes a time, not {shown(value.text[:40]) or value.kind!r}"
            self.problem(value.line, text, "write it as 2026-11-22T10:00:00Z")
            return ""
        return value.text
