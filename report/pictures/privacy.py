"""What some categories reach: who is drawn in the privacy view, in which role, with which words, and with which lines.

In: an ``Analysis``; flows, and what goes along them. Out: boxes; sorted ``PictureLine`` facts, one for all flows of one
look between two boxes.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from operator import or_
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.vertices import by_identity
from rosprivacy.analysis.many_flows import one_by_one
from rosprivacy.analysis.model import CHANNELS, DISCLOSURE
from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.pictures.looks import (
    CLEANED,
    DATA,
    DERIVATION,
    END,
    LEAK,
    OPEN,
    REVIEWED,
    SANITIZER,
    SHORTEST,
    SOURCE,
    UNTOUCHED,
    WAY,
)
from rosprivacy.report.pictures.phrases import Phrases, listed
from rosprivacy.report.pictures.picture import Box, PictureLine, sorted_lines

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, OpenQuestion
    from rosprivacy.analysis.model import Flow, Grant, Place
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.pictures.picture import Key

BOUND = 4  # categories that are named on a box


def ends_of(analysis: Analysis) -> dict[int, dict[str, int]]:
    """Return where findings end that are no disclosures: vertex -> their kind -> bits of the data."""
    others = [finding for finding in analysis.findings if finding.kind != DISCLOSURE]
    if not others:
        return {}
    number = {element: vertex for vertex, element in enumerate(analysis.graph.elements)}
    ends: dict[int, dict[str, int]] = defaultdict(lambda: defaultdict(int))
    for finding in others:
        ends[number[finding.leak]][finding.kind] |= analysis.spread.forms_of(finding.category)
    return {vertex: dict(sorted(kinds.items())) for vertex, kinds in ends.items()}


def _open_kinds(questions: Iterable[OpenQuestion], shown: frozenset[str]) -> dict[Key, frozenset[str]]:
    """Which kinds are open at each element, of those that are shown; elements share few sets of kinds."""
    kinds: dict[tuple[str, ...], frozenset[str]] = {}
    found: dict[Key, frozenset[str]] = {}
    for question in questions:
        if (own := kinds.get(question.categories)) is None:
            own = kinds[question.categories] = shown.intersection(question.categories)
        key = question.element.identity
        found[key] = found[key] | own if key in found else own
    return found


class ReachedElements:
    """Where the data of an analysis is, for all of its categories or for what one finding is about.

    Parameters
    ----------
    categories
        That arrive; what they are made of on the path is drawn too. None for all.
    say
        The words on the boxes.
    """

    def __init__(
        self, analysis: Analysis, categories: Collection[str] | None = None, say: Phrases | None = None
    ) -> None:
        self.analysis, self.graph, self._results = analysis, analysis.graph, analysis.spread
        self._say = say or Phrases()
        found = self._results
        wanted = analysis.emitted if categories is None else sorted(categories)
        self._mask = sum(found.forms_of(category) for category in wanted)
        if categories is not None and any(
            found.categories.index(category) in found.made_categories for category in wanted
        ):
            self._mask = found.all_bits
        self._several = len(found.names(self._mask)) > 1
        self._of = by_identity(found)
        self._ending = ends_of(analysis)
        self._types = analysis.types
        self._ends = {vertex: reduce(or_, kinds.values()) for vertex, kinds in self._ending.items()}
        self._open = _open_kinds(analysis.open, frozenset(found.names(self._mask)))

    def sources(self) -> bool:
        """Whether any data was followed."""
        return any(self._results.begins(vertex) & self._mask for vertex in self._results.facts)

    def boxes(self, keys: Collection[Key] | None = None) -> Iterator[Box]:
        """What data gets to and does not end at without leaving or getting out; of some elements, or of all."""
        for key in self._of if keys is None else keys:
            vertices = self._of.get(key, ())
            if self._drawn(key, vertices):
                yield self._box(key, vertices)

    def every_box(self, keys: Collection[Key]) -> Iterator[Box]:
        """Some elements, also those that end what comes to them, and those that no data gets to."""
        for key in keys:
            vertices = self._of.get(key, ())
            if self._drawn(key, vertices):
                yield self._box(key, vertices)
            else:
                yield self._quiet(key, vertices)

    def _quiet(self, key: Key, vertices: Sequence[int]) -> Box:
        """What data does not go on from."""
        first, arrives = self.graph.elements[vertices[0]], 0
        for vertex in vertices:
            arrives |= self._results.arrives.get(vertex, 0) & self._mask
        words = self._label_texts(vertices, arrives)[1][:BOUND]
        types = self._types.get(first, ())
        look = END if arrives else UNTOUCHED
        return Box(key, (key[2],), look, tuple(words), pattern=first.pattern, types=types)

    def _drawn(self, key: Key, vertices: Sequence[int]) -> bool:
        """Whether data goes on from there or gets out, or the element is open: a storage that cleans has a country."""
        return bool(self._open.get(key)) or any(self._goes_on(vertex) for vertex in vertices)

    def _goes_on(self, vertex: int) -> int:
        found = self._results
        ends = found.leaks.get(vertex, 0) | self._ends.get(vertex, 0)
        here = found.leaves.get(vertex, 0) | (ends & found.present(vertex))
        return here & self._mask

    def along(self, index: int) -> tuple[tuple[str, ...], bool]:
        """Return what goes along a flow and does not just end there, and whether all of it is pseudonymised."""
        found, target = self._results, self.graph.flows[index].target
        bits = found.along(index) & self._mask
        if bits:
            taken = found.keeps.get(target, found.all_bits) | found.leaks.get(target, 0) | self._ends.get(target, 0)
            for before, _ in found.derives.get(target, ()):
                taken |= 1 << before
            for category in self._open.get(self.graph.elements[target].identity, ()):
                taken |= found.forms_of(category)
            bits &= taken
        plain, hidden = found.planes(bits)
        return found.names(bits), bool(hidden) and not plain

    @cached_property
    def cleaned(self) -> dict[int, tuple[str, ...]]:
        """The flows along which data only gets to where a label says that it is cleaned -> the kinds.

        Complexity: O(flows), once.
        """
        return self.cleaned_among(range(len(one_by_one(self.graph.flows))))

    def cleaned_among(self, flows: Iterable[int]) -> dict[int, tuple[str, ...]]:
        """The same of some flows."""
        found = {index: self._cleaned_along(index) for index in flows}
        return {index: kinds for index, kinds in found.items() if kinds}

    def _cleaned_along(self, index: int) -> tuple[str, ...]:
        facts = self._results.facts.get(self.graph.flows[index].target)
        if not facts or self.along(index)[0]:
            return ()
        arriving = self._results.names(self._results.along(index) & self._mask)
        return tuple(category for category in arriving if category in facts and "sanitizer" in facts[category].roles)

    def left_out(
        self, words: Words, robots_not_shown: Collection[str] = (), drawn: Collection[Key] = ()
    ) -> tuple[str, ...]:
        """Say what is not there: what ends the data, and what it does not get to.

        Parameters
        ----------
        words
            Of the reader's language.
        robots_not_shown
            Robots that do not count, see ``views.privacy_view``.
        drawn
            What is drawn all the same.
        """
        ended, apart = [], 0
        for key, vertices in self._of.items():
            if key[0] in robots_not_shown or key in drawn or self._drawn(key, vertices):
                continue
            if key[1] not in CHANNELS and any(self._results.arrives.get(vertex, 0) & self._mask for vertex in vertices):
                ended.append(key[2])
            else:
                apart += 1
        ended = list(dict.fromkeys(ended))  # the same on several robots
        notes = []
        if ended:
            names = listed(ended, longest=40, words=words)
            notes.append(words.count(len(ended), "picture.ended", names=names))
        if apart:
            notes.append(words.count(apart, "picture.apart"))
        return tuple(map(plain, notes))

    def _box(self, key: Key, vertices: Sequence[int]) -> Box:
        bits = {"present": 0, "begins": 0, "leaks": 0, "arrives": 0, "ends": 0}
        for vertex in vertices:
            present = self._results.present(vertex) & self._mask
            bits["present"] |= present
            bits["begins"] |= self._results.begins(vertex) & self._mask
            bits["leaks"] |= self._results.leaks.get(vertex, 0) & present
            bits["ends"] |= self._ends.get(vertex, 0) & present
            bits["arrives"] |= self._results.arrives.get(vertex, 0) & self._mask
        made, cleaned = self._label_texts(vertices, bits["present"])
        open_for = self._open.get(key, frozenset())
        roles = [
            (LEAK, bits["leaks"] | bits["ends"]),
            (SOURCE, bits["begins"]),
            (DERIVATION, made),
            (SANITIZER, cleaned),
            (OPEN, open_for),
            (REVIEWED, True),
        ]
        look = next(role for role, holds in roles if holds)
        words = self._words(key, bits, made, cleaned, vertices)
        if open_for and set(self._results.names(bits["present"])) != open_for:
            words.append(self._say.of("unreviewed", sorted(open_for), BOUND))
        first = self.graph.elements[vertices[0]]
        types = self._types.get(first, ())
        return Box(key, (key[2],), look, tuple(words), bool(open_for), pattern=first.pattern, types=types)

    def _label_texts(self, vertices: Sequence[int], present: int) -> tuple[list[str], list[str]]:
        """What labels say that is made of what is here, and how it is cleaned, in words."""
        made: dict[str, None] = {}
        cleaned: dict[str, None] = {}
        for vertex in vertices:
            for category in self._results.names(present):
                fact = self._results.facts.get(vertex, {}).get(category)
                if fact is None or self.graph.elements[vertex].is_channel:
                    continue
                made.update(dict.fromkeys(self._makes(category, to) for to in fact.derives if to != category))
                if fact.pseudonymises:
                    cleaned[self._say.of("pseudonymises", [category], BOUND)] = None
                elif not fact.passes:
                    cleaned[self._say.of("cleans", [category], BOUND)] = None
        return list(made), list(cleaned)

    def _makes(self, category: str, to: str) -> str:
        return self._say.of("makes", [category], BOUND, to=self._say.title(to))

    def _words(
        self, key: Key, bits: dict[str, int], results: list[str], cleaned: list[str], vertices: Sequence[int]
    ) -> list[str]:
        found, say = self._results, self._say
        if key[1] in CHANNELS:
            plain, hidden = found.planes(bits["present"])
            names = list(plain if self._several else ())
            names += [say.of("hidden", [c], BOUND) for c in hidden if c not in plain]
            return [say.listed(names, BOUND)] if names else []
        words = []
        own = self._own_sources(vertices, bits["begins"])
        if own:
            words.append(say.of("source", own, BOUND))
        if bits["leaks"]:
            words.append(say.of("leak", found.names(bits["leaks"]), BOUND))
        for kind, ending in self._ending_at(vertices).items():
            words.append(say.of(kind, found.names(ending & bits["present"]), BOUND))
        return [*words, *results[:BOUND], *cleaned[:BOUND]]

    def _ending_at(self, vertices: Sequence[int]) -> dict[str, int]:
        """Of one element: kind of a finding that ends there -> bits."""
        ending: dict[str, int] = defaultdict(int)
        for vertex in vertices:
            for kind, bits in self._ending.get(vertex, {}).items():
                if bits & self._mask:
                    ending[kind] |= bits & self._mask
        return dict(sorted(ending.items()))

    def _own_sources(self, vertices: Sequence[int], begins: int) -> list[str]:
        """What labels call it a source of; what it makes of its own data begins here too."""
        said = [self._results.facts.get(vertex, {}) for vertex in vertices]
        return [c for c in self._results.names(begins) if any(c in facts and facts[c].emits for facts in said)]


def ends_of_flow(analysis: Analysis, flow: Flow) -> tuple[Key, Key]:
    """Return the elements that a flow goes between."""
    elements = analysis.graph.elements
    return elements[flow.source].identity, elements[flow.target].identity


@dataclass
class FlowLines:
    """Lines in the making: flows with the same ends and the same look become one."""

    boxes: Collection[Key]
    lines: dict[tuple[Key, Key, str], PictureLine] = field(default_factory=dict)

    def add(
        self,
        source: Key,
        target: Key,
        look: str,
        role: str,
        grants: Iterable[Grant],
        carries: Collection[str] = (),
        *,
        pseudonymised: bool = False,
        length: int = 0,
    ) -> None:
        """Add a flow; the two sides of a wildcard are one element, and between them nothing is drawn."""
        if source == target or source not in self.boxes or target not in self.boxes:
            return
        places = {grant.place for grant in grants}
        old = self.lines.get((source, target, look))
        roles: tuple[str, ...] = (role,)
        kinds, hidden = tuple(carries), pseudonymised
        if old:
            places |= set(old.places)
            roles, kinds = tuple(sorted({role, *old.roles})), tuple(sorted({*carries, *old.carries}))
            length = min((n for n in (length, old.length) if n), default=0)
            hidden = pseudonymised and old.pseudonymised
        told = tuple(sorted(places, key=_place))
        self.lines[source, target, look] = PictureLine(source, target, look, roles, kinds, hidden, told, length)

    def drawn_lines(self) -> tuple[PictureLine, ...]:
        """The lines; data that goes to a leak hides data that goes the same line to none, and this what ends there."""
        ranks = {CLEANED: 0, DATA: 1, WAY: 2, SHORTEST: 3}
        best: dict[tuple[Key, Key, str], PictureLine] = {}
        for (source, target, look), line in sorted(self.lines.items()):
            slot = (source, target, look if look not in ranks else "")
            old = best.get(slot)
            if old:
                upper, lower = (line, old) if ranks[look] > ranks[old.look] else (old, line)
                line = upper if lower.look == CLEANED else _with(upper, lower)  # noqa: PLW2901 - the same line
            best[slot] = line
        return sorted_lines(best.values())


def _with(line: PictureLine, addition: PictureLine) -> PictureLine:
    """A line with what else goes along it."""
    return replace(
        line,
        roles=tuple(sorted({*line.roles, *addition.roles})),
        carries=tuple(sorted({*line.carries, *addition.carries})),
        places=tuple(sorted({*line.places, *addition.places}, key=_place)),
    )


def _place(place: Place) -> tuple[str, int]:
    return place.file, place.line


def flow_lines(
    reached: ReachedElements,
    boxes: Collection[Key],
    flows: Iterable[int],
    lengths: Mapping[int, int],
    shortest: Collection[tuple[Key, Key]],
) -> FlowLines:
    """Return what goes along some flows.

    Parameters
    ----------
    lengths
        Flow on a path to a leak -> steps of the shortest one through it.
    shortest
        Ends of the steps of the shortest paths.
    """
    lines = FlowLines(boxes)
    for index in flows:
        carries, pseudonymised = reached.along(index)
        if not carries and index not in lengths:
            continue
        flow = reached.graph.flows[index]
        ends = ends_of_flow(reached.analysis, flow)
        look = DATA if index not in lengths else SHORTEST if ends in shortest else WAY
        length = lengths.get(index, 0)
        lines.add(*ends, look, flow.role, flow.grants, carries, pseudonymised=pseudonymised, length=length)
    return lines


def add_cleaned(lines: FlowLines, reached: ReachedElements, cleaned: Mapping[int, Collection[str]]) -> None:
    """Add the flows along which data gets to where a label says that it is cleaned."""
    for index, kinds in cleaned.items():
        flow = reached.graph.flows[index]
        lines.add(*ends_of_flow(reached.analysis, flow), CLEANED, flow.role, flow.grants, kinds)


def data_lines(
    reached: ReachedElements,
    boxes: Collection[Key],
    flows: Iterable[int],
    lengths: Mapping[int, int],
    shortest: Collection[tuple[Key, Key]],
) -> FlowLines:
    """Return what goes along some flows, and between the boxes what ends where it gets, as a label says.

    See ``flow_lines``; beside it O(flows), once for each ``reached``.
    """
    lines = flow_lines(reached, boxes, flows, lengths, shortest)
    add_cleaned(lines, reached, reached.cleaned)
    return lines
