"""YAML or JSON from anybody -> values that know their line.

In: a path. Out: a tree of ``Value``. Parsing is PyYAML's safe composer; JSON is checked by the standard library and
then composed too, for its lines. Anchors, which can make a small file grow without end, are refused.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.errors import InputError

MAX_BYTES = 64 * 2**20
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True, slots=True)
class Value:
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


def read(file: str, fail: Callable[[int, str, str], InputError]) -> tuple[Value, bytes]:
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
    data = _bytes(file, fail)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise fail(line, "not UTF-8", "save the file as UTF-8") from None
    return parse(text, fail), data


def parse(text: str, fail: Callable[[int, str, str], InputError]) -> Value:
    """Read YAML or JSON text; see ``read``."""
    if not text.strip():
        raise fail(1, "the file is empty", "write at least 'labels: 1'")
    if text.lstrip().startswith("{"):
        text = _json_as_yaml(text)
    try:
        node = yaml.compose(text, Loader=_LOADER)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = error.problem or error.context or "not YAML"
        raise fail(mark.line + 1 if mark else 1, f"not YAML: {shown(problem)}", "correct the syntax") from None
    except (yaml.YAMLError, ValueError) as error:
        raise fail(1, f"not YAML: {shown(str(error).splitlines()[0])}", "correct the syntax") from None
    except RecursionError:
        raise fail(1, "nested too deeply", "write it flatter") from None
    if node is None:
        raise fail(1, "the file is empty", "write at least 'labels: 1'")
    return _value(node, set(), fail)


def _bytes(file: str, fail: Callable[[int, str, str], InputError]) -> bytes:
    path = Path(file)
    try:
        if not path.exists():
            raise fail(0, "file not found", "correct the path")
        if not path.is_file():
            raise fail(0, "not a regular file", "name a YAML or JSON file")
        if path.stat().st_size > MAX_BYTES:
            raise fail(0, f"more than {MAX_BYTES} bytes", "split the file")
        return path.read_bytes()
    except OSError as error:
        raise fail(0, f"cannot be read: {error.strerror}", "check its permissions") from None


def _json_as_yaml(text: str) -> str:
    """JSON is YAML but for tabs between its tokens; inside its strings they cannot stand."""
    try:
        json.loads(text)
    except (ValueError, RecursionError):
        return text  # perhaps YAML's own {…}
    return text.replace("\t", " ")


def _value(node: yaml.Node, seen: set[int], fail: Callable[[int, str, str], InputError]) -> Value:
    line = node.start_mark.line + 1
    if isinstance(node, yaml.ScalarNode):
        return Value(line, _scalar_kind(node.tag), _joined(node.value))
    if id(node) in seen:
        raise fail(line, "anchors and aliases are not read", "write the value out where it is used")
    seen.add(id(node))
    if isinstance(node, yaml.SequenceNode):
        return Value(line, "list", items=tuple(_value(item, seen, fail) for item in node.value))
    entries: dict[str, tuple[int, Value]] = {}
    for key, value in node.value:
        at = key.start_mark.line + 1
        if not isinstance(key, yaml.ScalarNode):
            raise fail(at, "a key that is not a name", "write a plain name before the colon")
        name = _joined(key.value)
        if name in entries:
            raise fail(at, f"{shown(name)!r} again, first in line {entries[name][0]}", "merge the two")
        entries[name] = (at, _value(value, seen, fail))
    return Value(line, "map", entries=tuple((name, at, value) for name, (at, value) in entries.items()))


def _scalar_kind(tag: str) -> str:
    return {"tag:yaml.org,2002:str": "text", "tag:yaml.org,2002:null": "empty"}.get(tag, "number")


def _joined(text: str) -> str:
    """Two halves of a JSON surrogate pair are one character."""
    return text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")
