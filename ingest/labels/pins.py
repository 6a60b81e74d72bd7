"""The pins of a label file: the elements that globs of it decided, with the kinds of data there when a person looked.

In: the section ``pins`` of a label file, or pins. Out: pins, or the section; what a glob says under them; and which of
them speak of nothing any more. ``labels --pin`` writes the section, nobody else.

Source: rule S11: what a glob takes away or calls reviewed holds for what a person has seen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.analysis.written_names import bare_name, is_glob, literal
from rosprivacy.ingest.labels.entries import END_KINDS, is_non_ros

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Element, Statement
    from rosprivacy.ingest.labels.name_reader import NameReader
    from rosprivacy.ingest.reading.yaml_values import Value

PINS = "pins"
FLOWS, FLOW_KEYS = "flows", ("from", "to", "kinds")
SECTION_OF = {kind: f"{kind}s" for kind in END_KINDS}
PIN_OF_NOTHING = "pin-of-nothing"
Spot = tuple[str, str]  # kind and name of an element; outside ROS the name alone is known


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
    for section, line, content in reader.entries_of(value, (*SECTION_OF.values(), FLOWS)):
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

    def __init__(self, pins: tuple[Pin, ...] | None) -> None:
        self._pins = None if pins is None else {pin.ends: pin.categories for pin in pins}
        self._pinned_kinds: dict[tuple[int, tuple[str, ...]], tuple[Statement, ...]] = {}

    def at(self, statements: tuple[Statement, ...], *elements: Element) -> tuple[Statement, ...]:
        """Return what is said of an element or a flow: what has to be seen is held to the kinds that are pinned."""
        if self._pins is None or not any(statement.to_be_seen for statement in statements):
            return statements
        kinds = self._pins.get(tuple(map(spot, elements)), ())
        key = id(statements), kinds
        if key not in self._pinned_kinds:  # what is said of elements alike stays one and the same
            self._pinned_kinds[key] = tuple(s._replace(pinned=kinds) if s.to_be_seen else s for s in statements)
        return self._pinned_kinds[key]


def of_nothing(pins: Iterable[Pin], decided: Iterable[tuple[Spot, ...]]) -> Iterator[Diagnostic]:
    """Yield a notice for each pin of an element or a flow that no glob of the file speaks of any more.

    Parameters
    ----------
    decided
        Elements and flows of which a glob of the file says what has to be seen.
    """
    there = set(decided)
    for pin in pins:
        if pin.ends not in there:
            name = " -> ".join(shown(name) for _, name in pin.ends)
            what = f"the pin of {name} matches nothing that a glob of this file speaks of"
            yield Diagnostic(pin.place, Severity.NOTICE, f"{what}; labels --pin drops it", PIN_OF_NOTHING)
