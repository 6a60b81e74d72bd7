"""The pins of a label file: the elements that globs of it decided, with the kinds of data there when a person looked.

In: the section ``pins`` of a label file, or pins. Out: pins, or the section; what a glob says under them; and which of
them speak of nothing any more. ``labels --pin`` writes the section, nobody else.

``labels --pin-code`` writes its part ``code``: of which version of the code labels of nodes speak.

Source: rule S11: what a glob takes away or calls reviewed holds for what a person has seen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import HASH, TYPE, TYPE_LINE, WRITERS, Diagnostic, Place, Severity
from rosprivacy.analysis.written_names import bare_name, is_glob, literal
from rosprivacy.ingest.labels.entries import END_KINDS, is_non_ros

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Element, Statement
    from rosprivacy.ingest.labels.name_reader import NameReader
    from rosprivacy.ingest.reading.yaml_values import Value

PINS = "pins"
FLOWS, FLOW_KEYS = "flows", ("from", "to", "kinds")
CHANNEL_KINDS = ("topic", "service", "action")
SECTION_OF = {kind: f"{kind}s" for kind in END_KINDS}
LINES = "by-type"  # the part of the section that is about lines of this name
CODE = "code"  # the part that is about code
VERSION_DIGITS = 16
OF_OTHERS = (LINES, CODE)  # parts that are not about globs
KEYS = {"types": TYPE, "hashes": HASH, "writers": "writer", "clients": "client", "servers": "server"}
PIN_OF_NOTHING = "pin-of-nothing"
Spot = tuple[str, str]  # kind and name of an element; outside ROS the name alone is known


class TypePin(NamedTuple):
    """With what a person took the line ``only: by-type`` of a channel.

    Attributes
    ----------
    ends
        The channel.
    texts
        Its types and who writes it, or both legs of it, as ``taken_with`` writes them.
    """

    ends: tuple[Spot, ...]
    texts: tuple[str, ...]
    place: Place


class CodeVersion(NamedTuple):
    """Which version of a file or class is there."""

    hash: str
    place: Place


class CodePin(NamedTuple):
    """Which code a person has seen when a label of a node was written.

    Attributes
    ----------
    ends
        The node.
    versions
        (unit of the code, hash of its version), as ``code_versions.py`` has them, sorted.
    """

    ends: tuple[Spot, ...]
    versions: tuple[tuple[str, str], ...]
    place: Place


class Pin(NamedTuple):
    """What was seen at an element or along a flow.

    Attributes
    ----------
    ends
        The element; or the two ends of the flow.
    categories
        Kinds as they are emitted: neither broader nor narrower ones are meant.
    """

    ends: tuple[Spot, ...]
    categories: tuple[str, ...]
    place: Place


def spot(element: Element) -> Spot:
    """Return by what a pin knows an element."""
    return (element.kind if element.kind in END_KINDS else "", element.name)


def read_pins(reader: NameReader, value: Value) -> tuple[Pin, ...]:
    """Read the section, with every problem."""
    pins: list[Pin] = []
    if value.kind not in ("map", "empty"):
        reader.problem(value.line, f"pins is a map, not a {value.kind}", "let 'rosprivacy labels --pin' write it")
        return ()
    for section, line, content in reader.entries_of(value, (*SECTION_OF.values(), FLOWS, *OF_OTHERS)):
        if section in OF_OTHERS:
            continue
        if section == FLOWS:
            pins += (pin for item in reader.list_of(content, "flows of pins") if (pin := _flow(reader, item)))
            continue
        if content.kind not in ("map", "empty"):
            reader.problem(line, f"{section} of pins is a map, not a {content.kind}", "write '/name: [Video]'")
        for name, at, kinds in content.entries if content.kind == "map" else ():
            _full(reader, name, at, ros=True)
            pins.append(Pin(((section[:-1], bare_name(name)),), _kinds(reader, kinds), Place(reader.file, at)))
    return tuple(pins)


def _flow(reader: NameReader, item: Value) -> Pin | None:
    said = {key: one for key, _, one in reader.entries_of(item, FLOW_KEYS)} if item.kind == "map" else {}
    if len(said) < len(FLOW_KEYS):
        reader.problem(item.line, "a pinned flow needs from, to and kinds", "let 'rosprivacy labels --pin' write it")
        return None
    ends = [reader.end(said[key]) for key in FLOW_KEYS[:2]]
    for end in ends:
        _full(reader, end.name, item.line, ros=bool(end.kind))
    kinds = _kinds(reader, said["kinds"])
    return Pin(tuple((end.kind, bare_name(end.name)) for end in ends), kinds, Place(reader.file, item.line))


def _full(reader: NameReader, name: str, line: int, *, ros: bool) -> None:
    if is_glob(name) or is_non_ros(name) == ros:
        hint = 'write a full name, with = before it if it has glob signs: "=/*"'
        reader.problem(line, f"{shown(name)!r} where an element is pinned", hint)
    elif len(name) > reader.bounds.name:
        reader.problem(line, *reader.bounds.refusal("name", len(name)))


def _kinds(reader: NameReader, value: Value) -> tuple[str, ...]:
    return tuple(sorted({*reader.categories_of(value, "a pin")}))


def read_type_pins(reader: NameReader, value: Value) -> tuple[TypePin, ...]:
    """Read the part of the section about lines ``only: by-type``, with every problem."""
    hint = "let 'rosprivacy labels --pin' write it"
    if value.kind not in ("map", "empty"):
        reader.problem(value.line, f"{LINES} of pins is a map, not a {value.kind}", hint)
        return ()
    pins: list[TypePin] = []
    for section, line, content in reader.entries_of(value, tuple(SECTION_OF[kind] for kind in CHANNEL_KINDS)):
        if content.kind not in ("map", "empty"):
            reader.problem(line, f"{section} of pins is a map, not a {content.kind}", hint)
        for name, at, facts in content.entries if content.kind == "map" else ():
            _full(reader, name, at, ros=True)
            if facts.kind != "map":
                reader.problem(at, f"the pin of {shown(name)} is a map, not a {facts.kind}", hint)
                continue
            parts = reader.entries_of(facts, tuple(KEYS))
            texts = {f"{KEYS[key]} {one.text}" for key, _, some in parts for one in reader.list_of(some, key)}
            pins.append(TypePin(((section[:-1], bare_name(name)),), tuple(sorted(texts)), Place(reader.file, at)))
    return tuple(pins)


def read_code_pins(reader: NameReader, value: Value) -> tuple[CodePin, ...]:
    """Read the part of the section about code, with every problem."""
    hint = "let 'rosprivacy labels --pin-code' write it"
    if value.kind not in ("map", "empty"):
        reader.problem(value.line, f"{CODE} of pins is a map, not a {value.kind}", hint)
        return ()
    pins: list[CodePin] = []
    for name, at, units in value.entries if value.kind == "map" else ():
        _full(reader, name, at, ros=True)
        if units.kind != "map" or not units.entries:
            reader.problem(at, f"the code of {shown(name)!r} is a map from a file or class to a hash", hint)
            continue
        for unit, line, version in units.entries:
            if not is_version(version.text):
                what = f"{shown(version.text or version.kind)!r} is no hash of {shown(unit)!r}"
                reader.problem(line, f"{what}: it has {VERSION_DIGITS} hexadecimal digits", hint)
        versions = tuple(sorted((unit, version.text) for unit, _, version in units.entries))
        pins.append(CodePin((("node", bare_name(name)),), versions, Place(reader.file, at)))
    return tuple(pins)


def is_version(text: str) -> bool:
    """Return whether a text is the hash of a version of code.

    >>> is_version("93fe1c2a77d0b1e4"), is_version("93fe")
    (True, False)
    """
    return len(text) == VERSION_DIGITS and set(text) <= {*"0123456789abcdef"}


def code_section(pins: Iterable[CodePin]) -> dict[str, dict[str, str]]:
    """Return the part of the section that says of which code labels speak, sorted.

    >>> code_section([CodePin((("node", "/blur"),), (("blur/blur.py:Blur", "93fe1c2a77d0b1e4"),), Place("", 0))])
    {'/blur': {'blur/blur.py:Blur': '93fe1c2a77d0b1e4'}}
    """
    return {literal(name): dict(pin.versions) for pin in sorted(pins) for _, name in pin.ends}


def types_section(pins: Iterable[TypePin]) -> dict[str, Any]:
    """Return the part of the section that says some pins of lines ``only: by-type``, sorted.

    >>> pin = TypePin((("topic", "/scan"),), ("type a/msg/Scan", "writer /lidar"), Place("", 0))
    >>> types_section([pin])
    {'topics': {'/scan': {'types': ['a/msg/Scan'], 'writers': ['/lidar']}}}
    """
    section: dict[str, Any] = {}
    for pin in sorted(pins):
        ((kind, name),) = pin.ends
        said = {key: [t.partition(" ")[2] for t in pin.texts if t.startswith(f"{word} ")] for key, word in KEYS.items()}
        section.setdefault(SECTION_OF[kind], {})[literal(name)] = {key: some for key, some in said.items() if some}
    return {SECTION_OF[kind]: section[SECTION_OF[kind]] for kind in CHANNEL_KINDS if SECTION_OF[kind] in section}


def as_section(pins: Iterable[Pin]) -> dict[str, Any]:
    """Return the section that says some pins, sorted.

    >>> nowhere = Place("", 0)
    >>> as_section([Pin((("topic", "/b"),), ("Video",), nowhere), Pin((("node", "/*"),), ("Voice",), nowhere)])
    {'nodes': {'=/*': ['Voice']}, 'topics': {'/b': ['Video']}}
    """
    section: dict[str, Any] = {}
    for pin in sorted(
        pins, key=lambda pin: (len(pin.ends), *((END_KINDS.index(k) if k else -1, n) for k, n in pin.ends))
    ):
        kinds = list(pin.categories)
        if len(pin.ends) == 1:
            ((kind, name),) = pin.ends
            section.setdefault(SECTION_OF[kind], {})[literal(name)] = kinds
        else:
            ends = ({kind: literal(name)} if kind else name for kind, name in pin.ends)
            section.setdefault(FLOWS, []).append(dict(zip(FLOW_KEYS, (*ends, kinds), strict=True)))
    return section


class Pinned:
    """What the statements of a file with pins are at each element and flow."""

    def __init__(self, pins: tuple[Pin, ...] | None, type_pins: tuple[TypePin, ...] | None = None) -> None:
        self._texts = None if type_pins is None else {pin.ends: pin.texts for pin in type_pins}
        self._pins = None if pins is None else {pin.ends: pin.categories for pin in pins}
        self._pinned_kinds: dict[tuple[int, tuple[str, ...]], tuple[Statement, ...]] = {}

    def at(self, statements: tuple[Statement, ...], *elements: Element) -> tuple[Statement, ...]:
        """Return what is said of an element or a flow: what has to be seen is held to the kinds that are pinned."""
        if self._texts is not None and any(statement.role == TYPE_LINE for statement in statements):
            statements = tuple(self._with_types(one, elements[0]) for one in statements)
        if self._pins is None or not any(statement.to_be_seen for statement in statements):
            return statements
        kinds = self._pins.get(tuple(map(spot, elements)), ())
        key = id(statements), kinds
        if key not in self._pinned_kinds:  # what is said of elements alike stays one and the same
            self._pinned_kinds[key] = tuple(s._replace(pinned=kinds) if s.to_be_seen else s for s in statements)
        return self._pinned_kinds[key]

    def _with_types(self, statement: Statement, element: Element) -> Statement:
        """A line ``only: by-type`` with what is kept of it there; another statement as it is."""
        if self._texts is None or statement.role != TYPE_LINE:
            return statement
        others = {word for leg, word in WRITERS.items() if leg != element.leg}
        taken = self._texts.get((spot(element),), ())
        return statement._replace(pinned=tuple(text for text in taken if text.partition(" ")[0] not in others))


def of_nothing(
    pins: Iterable[Pin | TypePin | CodePin],
    decided: Iterable[tuple[Spot, ...]],
    line: str = "a glob",
    option: str = "--pin",
) -> Iterator[Diagnostic]:
    """Yield a notice for each pin of an element or a flow that no such line of the file speaks of any more.

    Parameters
    ----------
    decided
        Elements and flows of which a glob of the file says what has to be seen.
    line
        What speaks of them there.
    option
        Of ``labels``, which drops such pins.
    """
    there = set(decided)
    for pin in pins:
        if pin.ends not in there:
            name = " -> ".join(shown(name) for _, name in pin.ends)
            what = f"the pin of {name} matches nothing that {line} of this file speaks of"
            yield Diagnostic(pin.place, Severity.NOTICE, f"{what}; labels {option} drops it", PIN_OF_NOTHING)
