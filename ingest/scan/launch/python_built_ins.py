"""What Python's own functions and the methods of texts, maps and paths make of values that may be open.

In: a call with its arguments. Out: a value; one that is too long, or that hangs on what is open, is open.
"""

from __future__ import annotations

import posixpath
import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.scan.launch.launch_values import LONGEST, PACKAGE, Open, Perhaps, Substitution, choice

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

MOST_ITEMS = 2000  # of a list or map
MOST_PARTS = 100  # of a text or a path
BUILTINS = frozenset(
    [
        "bool",
        "dict",
        "enumerate",
        "float",
        "int",
        "len",
        "list",
        "open",
        "print",
        "range",
        "reversed",
        "set",
        "sorted",
        "str",
        "tuple",
        "zip",
    ]
)
TEXT_METHODS = frozenset(
    [
        "capitalize",
        "endswith",
        "lower",
        "lstrip",
        "removeprefix",
        "removesuffix",
        "replace",
        "rsplit",
        "rstrip",
        "split",
        "startswith",
        "strip",
        "title",
        "upper",
    ]
)
NO_TEXTS = frozenset(["endswith", "rsplit", "split", "startswith"])  # methods of texts that give none
PATHS = ("find", "joinpath", "with_name")
PLACES = re.compile(r"\{(?P<name>\w*)(?:[^\w{}][^{}]*)?\}|%[-+ 0-9.]*[sdfir]", re.ASCII)
KEEPING = frozenset(["perform", "read", "__str__", "as_posix", "resolve", "absolute", "expanduser", "copy"])


class Call(NamedTuple):
    """A call of what is imported, with its arguments."""

    name: str
    file: str
    line: int
    positional: list[object]
    keywords: dict[str, object]


def of_map(owner: dict[object, object], name: str, call: Call) -> object:  # noqa: PLR0911 - one for each method
    """Return what a method of a map gives."""
    arguments = call.positional
    first = arguments[0] if arguments else None
    if name in ("get", "pop", "setdefault") and arguments:
        if not is_plain(first):
            return choice([*owner.values(), *arguments[1:]], f"{call.file}:{call.line}") if owner else Open(name)
        if first not in owner and not is_whole(owner):
            return Open(name)
        if name == "setdefault":
            owner.setdefault(first, arguments[1] if len(arguments) > 1 else None)
        return owner.get(first, arguments[1] if len(arguments) > 1 else None)
    if name == "update":
        owner.update(first if isinstance(first, dict) else {} if first is None else {Open(name): None})
        owner.update(call.keywords)
        return None
    if name == "items":
        return [[key, value] for key, value in owner.items()]
    if name in ("keys", "values"):
        return list(owner if name == "keys" else owner.values())
    return dict(owner) if name == "copy" else Open(name)


def of_text(owner: str, name: str, call: Call) -> object:  # noqa: PLR0911 - one for each method
    """Return what a method of a text gives."""
    arguments = call.positional
    if name == "format":
        return formatted(owner, arguments, call.keywords)
    if name == "join" and arguments and isinstance(arguments[0], list):
        parts: list[object] = []
        for item in arguments[0]:
            parts += [item] if not parts else [owner, item]
        return text_of(parts)
    if name in TEXT_METHODS and all(isinstance(one, str | int) for one in arguments):
        if name == "replace" and len(owner) > LONGEST // 4:
            return Open(name)
        try:
            return getattr(owner, name)(*arguments)
        except (TypeError, ValueError):
            return Open(name)
    if name in PATHS or (name == "find" and owner.startswith(PACKAGE)):
        return path_by(name, owner, arguments)
    return owner if name in KEEPING else Open(name)


def built_in(call: Call) -> object:  # noqa: PLR0911, PLR0912 - one for each function
    """Return what a function that is built in gives."""
    first = call.positional[0] if call.positional else None
    listed = first if isinstance(first, list) else None
    if call.name == "str":
        return str(first) if isinstance(first, int | float) and not isinstance(first, bool) else first
    if call.name in ("int", "float") and isinstance(first, str | int | float):
        try:
            return int(first) if call.name == "int" else float(first)
        except (ValueError, OverflowError):
            return Open(call.name)
    if call.name == "range" and call.positional and all(isinstance(one, int) for one in call.positional):
        return list(range(*call.positional)[:MOST_ITEMS]) if len(call.positional) < 3 else Open("range")  # type: ignore[call-overload]  # noqa: PLR2004
    if call.name == "dict" and listed is not None:
        pairs = [item for item in listed if isinstance(item, list) and len(item) == 2 and is_key(item[0])]  # noqa: PLR2004 - a pair
        whole = len(pairs) == len(listed)
        return {pair[0]: pair[1] for pair in pairs} | call.keywords if whole else {Open("a list of pairs"): None}
    if call.name == "dict":
        return {**(first if isinstance(first, dict) else {}), **call.keywords}
    if call.name in ("list", "tuple", "set", "sorted", "reversed"):
        if first is None:
            return []
        if isinstance(first, dict):
            return list(first)
        return list(reversed(listed)) if listed is not None and call.name == "reversed" else first
    if call.name == "enumerate" and listed is not None:
        start = call.keywords.get("start", call.positional[1] if len(call.positional) > 1 else 0)
        return [[number, item] for number, item in enumerate(listed, start if isinstance(start, int) else 0)]
    if call.name == "zip" and all(isinstance(one, list) for one in call.positional):
        return [list(row) for row in zip(*call.positional, strict=False)]
    if call.name == "len" and isinstance(first, list | dict | str) and (is_whole(first) or isinstance(first, str)):
        return len(first)
    if call.name == "bool":
        holds = truth(first)
        return Open("bool") if holds is None else holds
    if call.name == "open":
        return Substitution("contents", (first,))
    return Open(f"what {call.name}(…) gives")


def truth(value: object) -> bool | None:
    """Return whether a value counts as true; None where that is open."""
    if isinstance(value, list | dict):
        return bool(value) if is_whole(value) or not value else None
    return bool(value) if is_plain(value) else None


def is_whole(value: object) -> bool:
    """Return whether all items of a list or a map are surely there."""
    return isinstance(value, list | dict) and not any(isinstance(item, Perhaps | Open) for item in value)


def is_plain(value: object) -> bool:
    """Return whether a value is a text, a number, true, false or nothing."""
    return value is None or isinstance(value, str | bool | int | float)


def is_key(value: object) -> bool:
    """Return whether a value is looked up in maps: one that is plain, or a substitution of texts alone."""
    flat = isinstance(value, Substitution) and all(isinstance(part, str) for part in value.parts)
    return flat or (is_plain(value) and value is not None)


def text_of(parts: Sequence[object]) -> object:
    """Return the text that some values make, one after the other."""
    flat: list[object] = []
    for part in parts:
        inner = part.parts if isinstance(part, Substitution) and part.sort == "text" else (part,)
        for one in inner:
            plain = str(one) if isinstance(one, int | float) else one
            if flat and isinstance(flat[-1], str) and isinstance(plain, str):
                flat[-1] += plain
            else:
                flat.append(plain)
    if len(flat) > MOST_PARTS or sum(len(one) for one in flat if isinstance(one, str)) > LONGEST:
        return Open("a text that is too long")
    return flat[0] if len(flat) == 1 else Substitution("text", tuple(flat)) if flat else ""


def joined(parts: Sequence[object]) -> object:
    """Return the path that some values make.

    >>> joined(["a", "b"])
    'a/b'
    """
    if parts and all(isinstance(part, str) for part in parts):
        return posixpath.join(*map(str, parts))
    return Substitution("joined", tuple(parts)) if len(parts) < MOST_PARTS else Open("a path that is too long")


def path_by(name: str, owner: object, arguments: Sequence[object]) -> object:
    """Return what a method of a path makes; ``find`` is that of ``FindPackageShare``."""
    if name == "find":
        return Substitution("share", (arguments[0],)) if arguments else owner
    return joined([owner if name == "joinpath" else Substitution("folder", (owner,)), *arguments])


def formatted(template: str, values: Sequence[object], keywords: dict[str, object] | None = None) -> object:
    """Return a text with values in the places of ``{}``, ``{name}`` or ``%s``.

    >>> formatted("{}/{name}", ["a"], {"name": "b"}), formatted("%s/%d", ["a", 1])
    ('a/b', 'a/1')
    """
    waiting = iter(values)
    parts: list[object] = []
    for text, place in _places(template):
        parts.append(text)
        if place is None:
            continue
        if place.isdecimal():
            parts.append(values[int(place)] if int(place) < len(values) else Open(place))
        elif place:
            parts.append((keywords or {}).get(place, Open(place)))
        else:
            parts.append(next(waiting, Open("a value")))
    return text_of(parts)


def _places(template: str) -> Iterator[tuple[str, str | None]]:
    """(text, name of the place after it; None at the end)."""
    at = 0
    for place in PLACES.finditer(template):
        yield template[at : place.start()], place["name"] or ""
        at = place.end()
    yield template[at:], None
