"""A system seen from one element, or a whole one in few boxes, as a picture; what is not drawn is counted (rule S11).

In: an ``Analysis``; for each picture the element in hand and the kinds of data that are shown. Out: a ``Scene``. In a
whole system nodes that stand together are one box, by enclave and namespace, of a fleet by robot; a channel between
such groups is in the lines. Places have levels: as many count as give no more groups than asked for.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import shortened
from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.pictures.joined import Joined, choose
from rosprivacy.report.pictures.looks import (
    ALLOWED,
    CLEANED,
    DATA,
    LEAK,
    MATCHES,
    OPEN,
    QUESTIONED,
    REVIEWED,
    SOURCE,
    UNTOUCHED,
)
from rosprivacy.report.pictures.narrow import folded
from rosprivacy.report.pictures.phrases import Phrases, listed
from rosprivacy.report.pictures.picture import GROUP, PRIVACY, Box, Picture, PictureLine, sorted_boxes, sorted_lines
from rosprivacy.report.pictures.privacy import FlowLines, ReachedElements, add_cleaned, ends_of_flow, flow_lines
from rosprivacy.report.pictures.views import in_words, pairs

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.witness import WhyCarried, Witness
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.pictures.joined import JoinedChoice
    from rosprivacy.report.pictures.picture import Key, PictureLine

LOOKS_OF_ROLES = {
    UNTOUCHED: "picture.explore.element",
    LEAK: "exit",
    SOURCE: "picture.source",
    OPEN: "picture.explore.open",
}  # role -> how its number is told; all are in the first
Place = tuple[str, ...]  # names of levels, the widest first


@dataclass(frozen=True, slots=True)
class FoldedScene:
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
    lines: tuple[PictureLine, ...]
    channels: int


def folded_by_place(joined: Joined, alone: Collection[Key], bits: int, limit: int, words: Words) -> FoldedScene:
    """Return the groups of all elements but some.

    Parameters
    ----------
    alone
        Elements that stay by themselves.
    bits
        The data that lines are drawn for.
    limit
        Groups; one at least.

    Notes
    -----
    O(flows + for each writer of a channel the groups that its data gets to from there).
    """
    places = _places(joined, alone)
    every = [place for place in places.values() if place]
    deepest = max(map(len, every), default=0)
    fitting = (depth for depth in range(deepest, -1, -1) if len({place[:depth] for place in every}) <= limit)
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
    return FoldedScene(boxes, single, tuple(_lines(joined, box_of, bits)), sum(not place for place in places.values()))


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
    said = [words.count(counts[role], told) for role, told in LOOKS_OF_ROLES.items() if counts[role]]
    return Box(key, (key[2],), look, tuple(map(plain, said)), open=bool(unjudged))


def _lines(joined: Joined, box_of: Mapping[Key, Key], bits: int) -> Iterator[PictureLine]:
    """Where data goes between boxes, through channels that have none."""
    lines = FlowLines(set(box_of.values()))
    readers = _Readers(joined, box_of, bits)
    for key, box in box_of.items():
        onward = {there for vertex in joined.vertices(key) for there in joined.onward(vertex, bits)}
        for end in sorted({end for there in onward for end in readers.of(there)}):
            lines.add(box, end, DATA, "", ())
    yield from lines.drawn_lines()


class _Readers:
    """The boxes that data at a vertex is in or gets to, through channels without a box."""

    def __init__(self, joined: Joined, box_of: Mapping[Key, Key], bits: int) -> None:
        self._joined, self._box_of, self._bits = joined, box_of, bits
        self._elements = joined.analysis.graph.elements
        self._readers: dict[int, frozenset[Key]] = {}

    def of(self, vertex: int) -> frozenset[Key]:
        if vertex not in self._readers:
            boxes: set[Key] = set()
            seen, waiting = {vertex}, [vertex]
            while waiting:
                here = waiting.pop()
                if box := self._box_of.get(self._elements[here].identity):
                    boxes.add(box)
                    continue
                new = set(self._joined.onward(here, self._bits)) - seen
                seen |= new
                waiting += new
            self._readers[vertex] = frozenset(boxes)
        return self._readers[vertex]


BOUND = 30  # boxes
WHOLE_BOUND = 150  # boxes of a whole system


@dataclass(frozen=True, slots=True)
class Scene:
    """A picture that is seen from somewhere.

    Attributes
    ----------
    picture
        On the lines of the shortest path to what is in hand stand the numbers of its steps, from 1 on.
    focus
        The element in hand; None for none.
    """

    picture: Picture
    focus: Key | None = None


class Scenes:
    """An analysis, to be looked at from one element after the other; what the pictures share is made once.

    Parameters
    ----------
    say
        The words on the boxes and of the notes.
    why
        As of ``Joined``.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> scene = Scenes(analyse(*factory())).of(("", "topic", "/filtered"), {"Video"})
    >>> scene.picture.title
    'How Video gets to /filtered, and where it can go from there'
    >>> [line.words for line in scene.picture.lines if line.words]
    ['1', '3', '2']
    """

    def __init__(self, analysis: Analysis, say: Phrases | None = None, why: WhyCarried | None = None) -> None:
        self.analysis, self._say = analysis, say or Phrases()
        self._joined = Joined(analysis, why)
        self._reached: dict[tuple[str, ...], ReachedElements] = {}

    def of(
        self,
        focus: Key | None = None,
        kinds: Collection[str] | None = None,
        limit: int = BOUND,
        way: Witness | None = None,
    ) -> Scene:
        """Return what matters of the system, seen from an element.

        Parameters
        ----------
        focus
            The element in hand, by its identity; one that is not there is taken as None. None for the paths to leaks.
        kinds
            Names of emitted categories that are shown; None for all.
        limit
            Boxes. There are more only if the paths to the element and the first path to a leak need them.
        way
            A path to the element that is in hand itself; None for the shortest ones.

        Notes
        -----
        O(flows) for the first picture of an analysis; then what the flows of the chosen elements take.
        """
        wanted = tuple(name for name in self.analysis.emitted if kinds is None or name in kinds)
        choice = choose(self._joined, focus if focus and focus in self._joined else None, wanted, limit, way)
        reached = self._reached_by(wanted)
        boxes = {box.key: box for box in reached.every_box(sorted({*choice.core, *choice.near}))}
        picture = Picture(
            PRIVACY,
            self._title(choice, wanted) if boxes else plain(self._say.words("picture.nothing")),
            sorted_boxes(boxes.values()),
            self._lines(reached, boxes, choice),
            ways=self._ways(choice),
            core=frozenset(choice.core),
            words=self._say.words,
        )
        return Scene(self._bounded(picture, choice, limit), choice.focus)

    def whole_system(
        self,
        focus: Key | None = None,
        kinds: Collection[str] | None = None,
        limit: int = WHOLE_BOUND,
        way: Witness | None = None,
    ) -> Scene:
        """Return the whole system; where that is more than some boxes, nodes that stand together are one.

        Paths to leaks and to the element in hand stay as they are.

        Parameters
        ----------
        focus, kinds, most, way
            As of ``of``.
        """
        wanted = tuple(name for name in self.analysis.emitted if kinds is None or name in kinds)
        choice = choose(self._joined, focus if focus and focus in self._joined else None, wanted, limit, way)
        reached, words = self._reached_by(wanted), self._say.words
        every, standard = self._joined.elements()
        alone, notes = every | choice.core, list[str]()
        groups: tuple[Box, ...] = ()
        between: tuple[PictureLine, ...] = ()
        if len(every) > limit:
            bits = sum(map(self.analysis.spread.forms_of, wanted))
            folded = folded_by_place(self._joined, choice.core, bits, max(1, limit - len(choice.core)), words)
            alone, groups, between = choice.core | folded.single, folded.boxes, folded.lines
            notes.append(words.count(folded.channels, "picture.explore.lines"))
        boxes = {box.key: box for box in (*groups, *reached.every_box(sorted(alone)))}
        lines = self._lines(reached, boxes.keys() & alone, choice)
        there = {(line.source, line.target) for line in lines}
        lines = sorted_lines([*lines, *(one for one in between if (one.source, one.target) not in there)])
        notes += [words.count(len(standard), "picture.standard")] if standard else []
        title = words("picture.explore.whole", what=self._listed(wanted))
        picture = Picture(
            PRIVACY, plain(title), sorted_boxes(boxes.values()), lines, tuple(map(plain, notes)), words=words
        )
        return Scene(replace(picture, ways=self._ways(choice), core=frozenset(choice.core)), choice.focus)

    def _listed(self, kinds: Iterable[str]) -> str:
        words = self._say.words
        return listed(map(self._say.title, kinds), limit=4, words=words) or words("picture.empty")

    def _ways(self, choice: JoinedChoice) -> tuple[str, ...]:
        return tuple(in_words(finding, self._say) for finding in choice.findings)

    def _reached_by(self, categories: tuple[str, ...]) -> ReachedElements:
        if categories not in self._reached:
            self._reached[categories] = ReachedElements(
                self.analysis, None if categories == self.analysis.emitted else categories, self._say
            )
        return self._reached[categories]

    def _lines(self, reached: ReachedElements, boxes: Collection[Key], choice: JoinedChoice) -> tuple[PictureLine, ...]:
        """What goes between the boxes; the steps to the element in hand are numbered."""
        graph, shortest = self.analysis.graph, pairs(choice.findings)
        flows = self._joined.flows(boxes)
        lengths = {index: 1 for index in flows if ends_of_flow(self.analysis, graph.flows[index]) in shortest}
        lines = flow_lines(reached, boxes, flows, lengths, shortest)
        add_cleaned(lines, reached, reached.cleaned_among(flows))
        if choice.focus and not choice.paths:
            for flow in self._joined.granted(choice.focus):
                ends = ends_of_flow(self.analysis, flow)
                lines.add(*ends, ALLOWED, flow.role, flow.grants)
        return sorted_lines(_stepwise(lines.drawn_lines(), choice.steps()))

    def _title(self, choice: JoinedChoice, categories: Iterable[str]) -> str:
        arriving = sorted({(path.steps[-1].category if path.steps else "") for path in choice.paths} - {""})
        what = self._listed(arriving or categories)
        key = "leaks" if choice.findings else "data"
        if choice.focus:
            begins = bool(choice.paths) and not choice.paths[0].steps
            key = "begins" if begins else "asked" if choice.paths else "untouched"
        name = shortened(choice.focus[2], 60) if choice.focus else ""
        return plain(self._say.words(f"picture.explore.{key}", what=what, name=name))

    def _bounded(self, picture: Picture, choice: JoinedChoice, limit: int) -> Picture:
        """The picture with no more boxes than asked for, and with what is not drawn of the system."""
        small, inside = folded(picture, choice.core), choice.core
        place = {key: number for number, key in enumerate(choice.near)}
        near = sorted((box for box in small.boxes if box.key not in inside), key=lambda box: place[box.key])
        room = max(0, limit - len(inside))
        small = replace(small, lines=sorted_lines(_dotted(small.lines)))
        small = small.part(inside | {box.key for box in near[:room]})
        drawn = {(box.robot, box.kind, name) for box in small.boxes for name in box.names}
        undrawn, standard = (len(some - drawn) for some in self._joined.elements())
        joined = sum(len(box.names) for box in near[room:])
        rest = picture.count(undrawn, "picture.explore.rest") if undrawn else ""
        if joined and choice.focus:
            name = shortened(choice.focus[2], 60)
            rest = picture.say("picture.explore.near", elements=picture.count(undrawn, "element"), n=joined, name=name)
        left = picture.count(choice.undrawn, "picture.explore.paths") if choice.undrawn else ""
        quiet = picture.count(standard, "picture.standard") if standard else ""
        return replace(small, notes=tuple(note for note in (left, rest, quiet) if note))


def _stepwise(lines: Iterable[PictureLine], steps: Mapping[tuple[Key, Key], int]) -> Iterator[PictureLine]:
    """Lines with the steps to the element in hand."""
    for line in lines:
        number = steps.get((line.source, line.target))
        if number is None or line.look == ALLOWED:
            yield line
        else:
            look = QUESTIONED if line.look in (DATA, CLEANED) else line.look
            yield replace(line, look=look, words=str(number) if number else "")


def _dotted(lines: Iterable[PictureLine]) -> Iterator[PictureLine]:
    """Lines of data as they are, but for those that only say that a wildcard covers a name."""
    for line in lines:
        yield replace(line, look=MATCHES) if line.look == DATA and line.roles == (MATCHES,) else line
