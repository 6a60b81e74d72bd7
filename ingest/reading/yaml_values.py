"""YAML or JSON from anybody -> values that know their line.

In: a path. Out: a tree of ``Value``. YAML is PyYAML's, taken as events and not as its composed nodes: the composer
recurses, and ends the process on a deep file. JSON is checked and its strings are read by the standard library, which
knows no lines; these are found here. Anchors, which can make a small file grow without end, are refused.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import yaml

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.file_kinds import ACCESS_LIST, PERMISSIONS, POLICY, FileKind, kind_of_file

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.bounds import Bounds

MAX_BYTES = 64 * 2**20
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_RESOLVER: Any = yaml.resolver.Resolver()
_KINDS = {"tag:yaml.org,2002:str": "text", "tag:yaml.org,2002:null": "empty"}
_JSON_TOKEN = re.compile(r'[{}\[\]]|"(?:[^"\\]|\\.)*"|[^\s{}\[\]",:]+')
_XML = re.compile(r"\s*<[?!A-Za-z]")
OURS = "what is read here"
_EMPTY = ("the file is empty", "write at least 'labels: 1'")


class Value(NamedTuple):
    """One value of the file.

    Attributes
    ----------
    line
        1 for the first.
    kind
        ``text``, ``number`` (also true and false), ``empty``, ``list`` or ``map``.
    text
        Of a scalar, as written.
    items
        Of a list.
    entries
        Of a map, in order: key, line of the key, value.
    """

    line: int
    kind: str
    text: str = ""
    items: tuple[Value, ...] = ()
    entries: tuple[tuple[str, int, Value], ...] = ()

    def get(self, key: str) -> Value | None:
        """Return the value of a map's key."""
        return next((value for name, _, value in self.entries if name == key), None)


def read(file: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> tuple[Value, bytes]:
    """Read a file.

    Parameters
    ----------
    fail
        Makes the error of the caller's kind from line, problem and hint.

    Returns
    -------
    value, data
        The tree, and the bytes that it was read from.

    Raises
    ------
    InputError
        Of the caller's kind.
    """
    try:
        text, data = read_utf8(file, MAX_BYTES, fail)
        top = parse(text, fail, bounds)
    except InputError:
        kind = _kind_of_others(file)
        if kind is None:
            raise
        raise fail(1, *kind.refused(OURS, file)) from None
    kind = None if top.kind == "map" else _kind_of_others(file)
    if kind is not None:
        raise fail(1, *kind.refused(OURS, file))
    return top, data


def _kind_of_others(file: str) -> FileKind | None:
    """What a file is that no reader of this program takes as YAML; None of any other."""
    try:
        kind = kind_of_file(file)
    except (OSError, ValueError):
        return None  # who reads it says why not
    return None if kind is None or kind.key or kind in (POLICY, PERMISSIONS, ACCESS_LIST) else kind


@lru_cache(maxsize=256)
def read_shipped(file: str, error: type[InputError], name: str) -> tuple[Value, bytes]:
    """Read a file that ships with the program, once in a process; ``name`` stands for it in errors. See ``read``."""
    return read(file, partial(error, name))


def parse(text: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> Value:
    """Read YAML or JSON text; see ``read``."""
    if not text.strip():
        raise fail(1, *_EMPTY)
    if _XML.match(text):
        raise fail(1, "this is XML, such as a policy, and not YAML or JSON", "name policies without an option")
    builder = Builder(fail, bounds)
    if text.lstrip().startswith("{") and _is_json(text, fail):
        feed_json(text, builder, _JSON_TOKEN, json.loads)
    else:
        _feed_yaml(text, builder, fail)
    if builder.top is None:
        raise fail(1, *_EMPTY)
    return builder.top


@dataclass(slots=True, eq=False, repr=False)
class _Open:
    """A list or map that is not closed yet."""

    line: int
    kind: str
    items: list[Value] = field(default_factory=list)
    entries: dict[str, tuple[int, Value]] = field(default_factory=dict)
    key: tuple[str, int] | None = None


class Builder:
    """Puts values together from what a parser finds, one after the other, without recursion."""

    def __init__(self, fail: Callable[[int, str, str], InputError], bounds: Bounds) -> None:
        self.fail = fail
        self.bounds = bounds
        self.top: Value | None = None
        self.open: list[_Open] = []

    def scalar(self, line: int, kind: str, text: str) -> None:
        """A scalar, or the key of a map."""
        if not text.isascii():
            text = text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")  # half a pair is none
        here = self.open[-1] if self.open else None
        if here and here.kind == "map" and here.key is None:
            if text in here.entries:
                what = f"{shown(text)!r} again, first in line {here.entries[text][0]}"
                raise self.fail(line, what, "merge the two")
            here.key = (text, line)
        else:
            self._add(Value(line, kind, text))

    def begin(self, line: int, kind: str) -> None:
        """A list or map begins."""
        if self.open and self.open[-1].kind == "map" and self.open[-1].key is None:
            raise self.fail(line, "a key that is not a name", "write a plain name before the colon")
        if len(self.open) >= self.bounds.nesting:
            raise self.fail(line, *self.bounds.refusal("nesting"))
        self.open.append(_Open(line, kind))

    def end(self) -> None:
        """The list or map that began last is whole."""
        done = self.open.pop()
        entries = tuple((name, line, value) for name, (line, value) in done.entries.items())
        self._add(Value(done.line, done.kind, items=tuple(done.items), entries=entries))

    def _add(self, value: Value) -> None:
        if not self.open:
            self.top = value
        elif (here := self.open[-1]).key is not None:
            name, line = here.key
            here.entries[name] = (line, value)
            here.key = None
        else:
            here.items.append(value)


def _feed_yaml(text: str, builder: Builder, fail: Callable[[int, str, str], InputError]) -> None:
    unprintable = yaml.reader.Reader.NON_PRINTABLE.search(text)
    if unprintable:
        line = text.count("\n", 0, unprintable.start()) + 1
        raise fail(line, f"not YAML: control character {shown(unprintable[0])}", "remove it")
    try:
        for event in yaml.parse(text, Loader=_LOADER):
            _feed_event(event, builder, fail)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = error.problem or error.context or "not YAML"
        if "nesting depth" in problem:  # a bound of newer versions of libyaml
            raise fail(
                mark.line + 1 if mark else 1, "nested more deeply than can be read", "write it flatter"
            ) from None
        raise fail(mark.line + 1 if mark else 1, f"not YAML: {shown(problem)}", "correct the syntax") from None
    except (yaml.YAMLError, ValueError) as error:
        raise fail(1, f"not YAML: {shown(str(error))}", "correct the syntax") from None
    except RecursionError:
        raise fail(1, "nested more deeply than can be read", "write it flatter") from None


def _feed_event(event: yaml.Event, builder: Builder, fail: Callable[[int, str, str], InputError]) -> None:
    line = event.start_mark.line + 1 if event.start_mark else 1
    if getattr(event, "anchor", None):
        raise fail(line, "anchors and aliases are not read", "write the value out where it is used")
    if isinstance(event, yaml.ScalarEvent):  # most of all events
        builder.scalar(line, _scalar_kind(event), event.value)
    elif isinstance(event, yaml.CollectionEndEvent):
        builder.end()
    elif isinstance(event, yaml.MappingStartEvent):
        builder.begin(line, "map")
    elif isinstance(event, yaml.SequenceStartEvent):
        builder.begin(line, "list")
    elif isinstance(event, yaml.DocumentStartEvent) and builder.top is not None:
        raise fail(line, "not YAML: a second document", "keep one")


def _scalar_kind(event: yaml.ScalarEvent) -> str:
    """What YAML's core rules take a scalar for."""
    tag = event.tag
    if tag in (None, "!"):
        tag = _RESOLVER.resolve(yaml.ScalarNode, event.value, event.implicit)
    return _KINDS.get(tag, "number")


def _is_json(text: str, fail: Callable[[int, str, str], InputError]) -> bool:
    """What begins with a brace may also be YAML's own {…}."""
    try:
        json.loads(text)
    except RecursionError:
        raise fail(1, "nested more deeply than can be read", "write it flatter") from None
    except ValueError:
        return False
    return True


def feed_json(text: str, builder: Builder, tokens: re.Pattern[str], decode: Callable[[str], str]) -> None:
    """Walk over JSON or JSON5 that is known to be right.

    Parameters
    ----------
    tokens
        Matches brackets, texts, other values, and comments where there are some.
    decode
        A text with its quotes -> what it says.
    """
    line, at = 1, 0
    for token in tokens.finditer(text):
        line += text.count("\n", at, token.start())
        at = token.start()
        word = token[0]
        if word in "{[":
            builder.begin(line, "map" if word == "{" else "list")
        elif word in "}]":
            builder.end()
        elif word[0] in "\"'":
            builder.scalar(line, "text", decode(word))
        elif word[0] != "/":  # no comment
            builder.scalar(line, "empty" if word == "null" else "number", word)
