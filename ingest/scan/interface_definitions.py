"""Definitions of messages, services and actions in a checkout -> the known types that their fields are (rule S15).

In: ``.msg``, ``.srv`` and ``.action`` files of its ROS 2 packages, one line a field. Out: ``TypeDefinition`` by name of
a type: a message of a few numbers and known types cannot carry what none of these can, as if they were sent one by one.
Text, bytes, lists without end, many numbers and what is defined elsewhere, or in a circle, limit nothing: then a leg
names no type.
"""

from __future__ import annotations

import posixpath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.scan.packages import text_in
from rosprivacy.ingest.scan.scan_facts import CodePlace, Gap

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.ingest.scan.packages import Packages

PRIMITIVES = {
    "bool": "Bool", "byte": "Byte", "char": "Char", "float32": "Float32", "float64": "Float64", "int8": "Int8",
    "int16": "Int16", "int32": "Int32", "int64": "Int64", "uint8": "UInt8", "uint16": "UInt16", "uint32": "UInt32",
    "uint64": "UInt64",
}  # fmt: skip
NUMBERS = {primitive: f"std_msgs/msg/{name}" for primitive, name in PRIMITIVES.items()}
BYTES = ("byte", "char", "int8", "uint8")  # rows of them hold text, pictures and sound
STAMP, HEADER, EMPTY = "builtin_interfaces/msg/Time", "std_msgs/msg/Header", "std_msgs/msg/Empty"
SEVERAL = "geometry_msgs/msg/PoseArray"  # several numbers can be places, and these the shape of a person
LISTS = {
    "geometry_msgs/msg/Pose": SEVERAL,
    "geometry_msgs/msg/PoseStamped": "nav_msgs/msg/Path",
    "geometry_msgs/msg/TransformStamped": "tf2_msgs/msg/TFMessage",
}
FEW = 7  # numbers of a pose; small thermal cameras send rows of eight
LEGS = {"msg": 1, "srv": 2, "action": 3}  # parts of a file
DEEPEST = 20  # types in types
LONGEST_COUNT = 6  # digits


class TypeDefinition(NamedTuple):
    """Where a type is defined, and the known types that its fields are: of a message, or of request and response."""

    file: str
    fields: tuple[tuple[str, ...], ...]


class DefinedField(NamedTuple):
    """A field.

    Attributes
    ----------
    bound
        How many values there can be at most; 0 for any number.
    """

    type: str
    listed: bool = False
    bound: int = 1


Leg = tuple[DefinedField, ...]


class _Content(NamedTuple):
    """The known types that fields are, and how many values there are, without headers."""

    types: frozenset[str]
    values: int


def read_definitions(root: str, packages: Packages) -> tuple[dict[str, TypeDefinition], tuple[Gap, ...]]:
    """Read the definitions of a checkout's packages; of two that differ for one name, neither limits anything."""
    files: dict[str, str] = {}
    legs: dict[str, tuple[Leg, ...]] = {}
    gaps = []
    for name, file in _definition_files(packages):
        try:
            parsed = _parsed(text_in(root, file), LEGS[name.split("/")[1]])
        except _DefinitionError as error:
            gaps.append(Gap(CodePlace(file, error.line), "file", f"a definition that cannot be read: {error}"))
            parsed = ()
        if legs.setdefault(name, parsed) != parsed:
            legs[name] = ()
        files.setdefault(name, file)
    known = _KnownTypes(legs, {package.name for package in packages.packages})
    return {name: TypeDefinition(files[name], known.fields(name)) for name in sorted(files)}, tuple(gaps)


def _definition_files(packages: Packages) -> Iterator[tuple[str, str]]:
    """(name of the type, file) of what stands where the packages of ROS have their definitions."""
    folders = {package.folder: package.name for package in packages.packages}
    for file in packages.files:
        above, base = posixpath.split(file)
        folder, kind = posixpath.split(above)
        name, ending = posixpath.splitext(base)
        if kind in LEGS and ending == f".{kind}" and folder in folders and name.isidentifier():
            yield f"{folders[folder]}/{kind}/{name}", file


class _DefinitionError(ValueError):
    """What is wrong, and in which line; 0 where the whole file cannot be read."""

    def __init__(self, line: int, problem: str) -> None:
        super().__init__(problem)
        self.line = line


def _parsed(text: str | None, legs: int) -> tuple[Leg, ...]:
    """The fields of each part of a file; constants are no data."""
    if text is None:
        raise _DefinitionError(0, "no text, or too large")
    parts: list[list[DefinedField]] = [[]]
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].split(None, 1)
        if words == ["---"]:
            parts.append([])
        elif words:
            field = _field(words[0], words[1] if len(words) > 1 else "")
            if field is None:
                raise _DefinitionError(number, shown(line))
            parts[-1] += field
    if len(parts) != legs:
        raise _DefinitionError(len(lines), f"{len(parts)} parts, not {legs}")
    return tuple(map(tuple, parts))


def _field(type_: str, rest: str) -> Leg | None:
    """The field of a line; none of a constant; None where it is no field."""
    name = rest.replace("=", " = ", 1).split(None, 2)
    if not name or not name[0].isidentifier():
        return None
    if name[1:2] == ["="]:
        return ()
    type_, bracket, count = type_.partition("[")
    base = type_.partition("<=")[0]
    if not all(part.isidentifier() for part in base.split("/")):
        return None
    if not bracket:
        return (DefinedField(base),)
    digits = count.removesuffix("]").removeprefix("<=")
    if not count.endswith("]") or (digits and not digits.isdecimal()):
        return None
    return (DefinedField(base, True, int(digits) if digits and len(digits) <= LONGEST_COUNT else 0),)


class _KnownTypes:
    """Which known types the fields of definitions are.

    Attributes
    ----------
    legs
        Of each type its parts; none of one that cannot be read.
    """

    def __init__(self, legs: Mapping[str, tuple[Leg, ...]], packages: Collection[str]) -> None:
        self._legs, self._packages = legs, packages
        self._messages: dict[str, _Content | None] = {}

    def fields(self, name: str) -> tuple[tuple[str, ...], ...]:
        """Return the known types that the fields of each leg are, sorted; no type where a field can be anything."""
        package, legs = name.partition("/")[0], self._legs[name]
        if len(legs) == LEGS["action"]:
            legs = (legs[0], (*legs[1], *legs[2]))  # a server answers with the result and with feedback
        return tuple(_names(self._of_fields(leg, package, 0)) for leg in legs)

    def _of_fields(self, leg: Leg, package: str, depth: int) -> _Content | None:
        types, values = set[str](), 0
        for field in leg:
            content = self._of_field(field, package, depth)
            if content is None or values + content.values > FEW:
                return None
            types |= content.types
            values += content.values
        return _Content(frozenset(types), values)

    def _of_field(self, field: DefinedField, package: str, depth: int) -> _Content | None:
        if field.type in NUMBERS:
            content: _Content | None = _Content(frozenset([NUMBERS[field.type]]), 1)
            return None if field.listed and field.type in BYTES else _repeated(content, field.bound)
        parts = field.type.split("/")
        name = "/".join([package, "msg", *parts] if len(parts) == 1 else [parts[0], "msg", parts[-1]])
        if name.partition("/")[0] in self._packages:
            return _repeated(self._message(name, depth), field.bound)
        if field.listed and name in LISTS:
            return _Content(frozenset([LISTS[name]]), 2)
        if name == HEADER:
            return None if field.listed else _Content(frozenset([STAMP]), 0)
        return _repeated(_Content(frozenset([name]), 1), field.bound)

    def _message(self, name: str, depth: int) -> _Content | None:
        if name not in self._messages:
            self._messages[name] = None  # also while it is looked at: a circle
            legs = self._legs.get(name)
            if legs and depth < DEEPEST:
                self._messages[name] = self._of_fields(legs[0], name.partition("/")[0], depth + 1)
        return self._messages[name]


def _repeated(content: _Content | None, count: int) -> _Content | None:
    return content._replace(values=content.values * count) if content and count else None


def _names(content: _Content | None) -> tuple[str, ...]:
    """The types of which a leg can carry what any can: several values can be more than each of them."""
    if content is None:
        return ()
    types = set(content.types)
    if content.values > 1:
        types |= {SEVERAL, *([NUMBERS["uint8"]] if NUMBERS["bool"] in types else [])}  # bits make up a number
    return tuple(sorted(types)) or (EMPTY,)
