"""A whole system in few boxes: nodes that stand together are one, by enclave and namespace, of a fleet by robot.

In: a ``Joined``, what stays by itself, the data that is shown. Out: boxes of groups, and lines of data between boxes; a
channel between groups is in the lines. Places have levels: as many count as give no more groups than asked for.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.pictures.flow_lines import Lines
from rosprivacy.report.pictures.looks import DATA, LEAK, OPEN, REVIEWED, SOURCE, UNTOUCHED
from rosprivacy.report.pictures.picture import GROUP, Box, Line

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.model import Element
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.explorer.joined import Joined
    from rosprivacy.report.pictures.picture import Key

TOLD = {
    UNTOUCHED: "pic.explore.element",
    LEAK: "pic.exit",
    SOURCE: "pic.source",
    OPEN: "pic.explore.open",
}  # role -> how its number is told; all are in the first
Place = tuple[str, ...]  # names of levels, the widest first


@dataclass(frozen=True, slots=True)
class Folded:
    """A system in groups.

    Attributes
    ----------
    boxes
        One for each group of several.
    single
        Elements that stand by themselves where they are.
    lines
        Where data goes between groups and what stays by itself.
    channels
        How many channels are drawn as lines, or not at all.
    """

    boxes: tuple[Box, ...]
    single: frozenset[Key]
    lines: tuple[Line, ...]
    channels: int


def folded_by_place(joined: Joined, alone: Collection[Key], bits: int, most: int, words: Words) -> Folded:
    """Return the groups of all elements but some.

    Parameters
    ----------
    alone
        Elements that stay by themselves.
    bits
        The data that lines are drawn for.
    most
        Groups; one at least.

    Notes
    -----
    O(flows + for each writer of a channel the groups that its data gets to from there).
    """
    places = _places(joined, alone)
    every = [place for place in places.values() if place]
    deepest = max(map(len, every), default=0)
    fitting = (depth for depth in range(deepest, -1, -1) if len({place[:depth] for place in every}) <= most)
    depth = next(fitting, 0)
    members: dict[Key, list[Key]] = defaultdict(list)
    for key, place in places.items():
        if place:
            members["", GROUP, "/" + "/".join(place[:depth])].append(key)
    single = frozenset(some[0] for some in members.values() if len(some) == 1)
    groups = {group: some for group, some in sorted(members.items()) if len(some) > 1}
    box_of = {key: group for group, some in groups.items() for key in some}
    box_of |= {key: key for key in (*single, *alone)}
    unjudged = joined.unjudged(bits)
    boxes = tuple(_box(joined, group, some, bits, unjudged.intersection(some), words) for group, some in groups.items())
    return Folded(boxes, single, tuple(_lines(joined, box_of, bits)), sum(not place for place in places.values()))


def _places(joined: Joined, alone: Collection[Key]) -> Mapping[Key, Place]:
    """Where each element stands; channels nowhere. Of several enclaves of a node the first one counts."""
    graph = joined.analysis.graph
    robots = {element.robot for element in graph.elements if element.robot}
    enclaves: dict[str, str] = {}
    for profile in sorted(graph.profiles):
        enclaves.setdefault(profile.node, profile.enclave)
    elements = {e.identity: e for v, e in enumerate(graph.elements) if v not in joined.analysis.spread.standard}
    return {
        key: () if element.is_channel else _place(element, enclaves.get(element.name, ""), fleet=len(robots) > 1)
        for key, element in elements.items()
        if key not in alone
    }


def _place(element: Element, enclave: str, *, fleet: bool) -> Place:
    if fleet:
        return (element.robot or element.kind,)
    if not element.is_node:
        return (element.kind,)
    space = element.name.rpartition("/")[0]
    return tuple(part for part in f"{enclave}/{space}".split("/") if part) or ("",)


def _box(joined: Joined, key: Key, members: Collection[Key], bits: int, unjudged: Collection[Key], words: Words) -> Box:
    """A group, with what counts most of its members as its look, and how many there are of what."""
    spread = joined.analysis.spread
    every = [joined.vertices(member) for member in members]
    counts = {
        LEAK: sum(any(spread.leaks.get(v, 0) & spread.present(v) & bits for v in vertices) for vertices in every),
        SOURCE: sum(any(spread.begins(v) & bits for v in vertices) for vertices in every),
        OPEN: len(unjudged),
        REVIEWED: sum(any(spread.present(v) & bits for v in vertices) for vertices in every),
        UNTOUCHED: len(members),
    }
    look = next(role for role, number in counts.items() if number)
    said = [words.count(counts[role], told) for role, told in TOLD.items() if counts[role]]
    return Box(key, (key[2],), look, tuple(map(plain, said)), open=bool(unjudged))


def _lines(joined: Joined, box_of: Mapping[Key, Key], bits: int) -> Iterator[Line]:
    """Where data goes between boxes, through channels that have none."""
    lines = Lines(set(box_of.values()))
    readers = _Readers(joined, box_of, bits)
    for key, box in box_of.items():
        for there in joined.after(key, bits):
            for end in (box_of[there],) if there in box_of else readers.of(there):
                lines.add(box, end, DATA, "", ())
    yield from lines.made()


class _Readers:
    """The boxes that data of a channel without a box gets to, through others of that kind too."""

    def __init__(self, joined: Joined, box_of: Mapping[Key, Key], bits: int) -> None:
        self._joined, self._box_of, self._bits = joined, box_of, bits
        self._known: dict[Key, frozenset[Key]] = {}

    def of(self, channel: Key) -> frozenset[Key]:
        if channel not in self._known:
            found: set[Key] = set()
            seen, waiting = {channel}, [channel]
            while waiting:
                for there in self._joined.after(waiting.pop(), self._bits):
                    if there in self._box_of:
                        found.add(self._box_of[there])
                    elif there not in seen:
                        seen.add(there)
                        waiting.append(there)
            self._known[channel] = frozenset(found)
        return self._known[channel]
