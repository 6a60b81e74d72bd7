"""The ways that have to be cut: from sources to open findings, as a network over (element, category) (rules S8, S10).

In: a spread and, per group of sources, at which leaks their data may not arrive. Out: ``CutNetwork``: numbered states
and arcs between them, each arc with the flow that it goes along or the channel that it passes. The two planes of a
category are one state: a sanitizer that pseudonymises lets it pass, one that ends it does not, in both planes alike.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.kernel.search import Net
    from rosprivacy.analysis.kernel.spread import Spread

BEGIN, END = 0, 1  # the two states that every network has
At = tuple[int, int]  # vertex, number of the category


@dataclass(frozen=True, slots=True)
class Group:
    """Sources of which the same is decided.

    Attributes
    ----------
    sources
        Vertices.
    accepted
        Leaks that a person has accepted: data goes on from there (rule S10).
    kept
        Leaks where ways end that need not, or cannot, be cut.
    others
        Places with an open finding of another kind: data is not to arrive there, but goes on, also from leaks.
    """

    sources: tuple[int, ...]
    accepted: frozenset[At] = frozenset()
    kept: frozenset[At] = frozenset()
    others: frozenset[At] = frozenset()


@dataclass(frozen=True, slots=True)
class Arc:
    """One step between states; along a flow, through a channel, or neither (-1)."""

    tail: int
    head: int
    category: int
    flow: int = -1
    channel: int = -1


@dataclass(slots=True)
class CutNetwork:
    """A network in which every arc lies on a way from ``BEGIN`` to ``END``.

    Attributes
    ----------
    arcs
        In the order in which they were found.
    at
        State -> where it is; not for ``BEGIN`` and ``END``.
    past
        States of ways that leaks do not end: those to findings of other kinds than disclosure.
    """

    arcs: list[Arc] = field(default_factory=list)
    at: dict[int, At] = field(default_factory=dict)
    past: set[int] = field(default_factory=set)


def cut_network(net: Net, groups: Iterable[Group], categories: Collection[int]) -> CutNetwork:
    """Return the network of all ways from the sources of each group to its open findings.

    Parameters
    ----------
    categories
        Numbers of those whose findings are to be removed.

    Notes
    -----
    O(flows · categories) per group and category. They share no state but the two ends: what ends a way of one category
    does not end one on which it is made into another.
    """
    found = CutNetwork()
    for group in groups:
        for category in sorted(categories):
            _Builder(net, group, category, found, past=False).build()
            if any(i == category for _, i in group.others):
                _Builder(net, group, category, found, past=True).build()
    return _pruned(found)


class _Builder:
    """Walks forward from what the sources of one group emit, to where one category may not get."""

    def __init__(self, net: Net, group: Group, category: int, found: CutNetwork, *, past: bool) -> None:
        self.net = net
        self.spread: Spread = net.spread
        self.bits = net.spread.bits
        self.group = group
        self.category = category
        self.found = found
        self.past = past
        self.numbers: dict[tuple[bool, int, int], int] = {}
        self.waiting: deque[tuple[bool, int, int]] = deque()

    def build(self) -> None:
        for source in self.group.sources:
            for i in bits_of(self.bits.merged(self.spread.emits.get(source, 0))):
                self._arc(BEGIN, self._state(True, source, i), i)
            for index, target, passing in self.net.flows.get(source, ()):
                for i in bits_of(self.bits.merged(self.spread.flow_emits.get(index, 0) & passing)):
                    self._arc(BEGIN, self._state(False, target, i), i, flow=index)
        while self.waiting:
            leaving, vertex, i = self.waiting.popleft()
            (self._leave if leaving else self._arrive)(vertex, i)

    def _state(self, leaving: bool, vertex: int, i: int) -> int:  # noqa: FBT001 - a part of the state's name
        key = (leaving, vertex, i)
        if key not in self.numbers:
            self.numbers[key] = len(self.found.at) + 2
            self.found.at[self.numbers[key]] = (vertex, i)
            if self.past:
                self.found.past.add(self.numbers[key])
            self.waiting.append(key)
        return self.numbers[key]

    def _arc(self, tail: int, head: int, category: int, flow: int = -1, channel: int = -1) -> None:
        self.found.arcs.append(Arc(tail, head, category, flow, channel))

    def _stops(self, vertex: int, i: int) -> bool:
        """Whether ways to leaks end here: at a leak of the category that is not accepted."""
        if self.past:
            return False
        leaks = self.spread.leaks.get(vertex, 0) & self.bits.both(i)
        return bool(leaks and i == self.category and (vertex, i) not in self.group.accepted)

    def _open(self, vertex: int, i: int) -> bool:
        """Whether data of the category may not get here."""
        at = (vertex, i)
        if self.past:
            return i == self.category and at in self.group.others
        return at not in self.group.kept and self._stops(vertex, i)

    def _arrive(self, vertex: int, i: int) -> None:
        here = self._state(False, vertex, i)
        if self._open(vertex, i):
            self._arc(here, END, i)
        if self._stops(vertex, i):
            return
        channel = vertex if self.spread.graph.elements[vertex].is_channel else -1
        if self.spread.keeps.get(vertex, self.spread.all_bits) & self.bits.both(i):
            self._arc(here, self._state(True, vertex, i), i, channel=channel)
        for before, after in self.spread.derives.get(vertex, ()):
            j = self.bits.category(after)
            if self.bits.category(before) == i and j != i:
                if self._open(vertex, j):
                    self._arc(here, END, j)
                if not self._stops(vertex, j):
                    self._arc(here, self._state(True, vertex, j), j)

    def _leave(self, vertex: int, i: int) -> None:
        here = self._state(True, vertex, i)
        for index, target, passing in self.net.flows.get(vertex, ()):
            if passing & self.bits.both(i):
                self._arc(here, self._state(False, target, i), i, flow=index)


def _pruned(found: CutNetwork) -> CutNetwork:
    """The arcs from which the end can be reached; the beginning reaches all of them."""
    back: dict[int, list[int]] = defaultdict(list)
    for arc in found.arcs:
        back[arc.head].append(arc.tail)
    alive, waiting = {END}, [END]
    while waiting:
        for before in back[waiting.pop()]:
            if before not in alive:
                alive.add(before)
                waiting.append(before)
    arcs = [arc for arc in dict.fromkeys(found.arcs) if arc.tail in alive and arc.head in alive]
    return CutNetwork(arcs, found.at, found.past)


def a_way(found: CutNetwork, passable: Callable[[Arc], bool]) -> list[Arc] | None:
    """Return a shortest way from the beginning to the end along arcs that are passable; None if there is none."""
    ahead = _ahead(found.arcs, passable)
    came: dict[int, Arc] = {}
    waiting = deque([BEGIN])
    while waiting and END not in came:
        for arc in ahead.get(waiting.popleft(), ()):
            if arc.head not in came and arc.head != BEGIN:
                came[arc.head] = arc
                waiting.append(arc.head)
    if END not in came:
        return None
    way = [came[END]]
    while way[-1].tail != BEGIN:
        way.append(came[way[-1].tail])
    return way[::-1]


def open_ends(found: CutNetwork, passable: Callable[[Arc], bool]) -> Iterator[tuple[At, bool, list[Arc]]]:
    """Yield every open finding's place that is reached along passable arcs, with a shortest way.

    Yields
    ------
    at
        Vertex, and number of the category.
    past
        Whether it is a finding of another kind than disclosure.
    """
    ahead = _ahead(found.arcs, passable)
    came: dict[int, Arc] = {}
    waiting = deque([BEGIN])
    last: dict[tuple[At, bool], Arc] = {}
    while waiting:
        for arc in ahead.get(waiting.popleft(), ()):
            if arc.head == END:
                end = (found.at[arc.tail][0], arc.category)
                last.setdefault((end, arc.tail in found.past), arc)
            elif arc.head not in came:
                came[arc.head] = arc
                waiting.append(arc.head)
    for (at, past), arc in sorted(last.items(), key=lambda item: item[0]):
        way = [arc]
        while way[-1].tail != BEGIN:
            way.append(came[way[-1].tail])
        yield at, past, way[::-1]


def _ahead(arcs: Sequence[Arc], passable: Callable[[Arc], bool]) -> dict[int, list[Arc]]:
    ahead: dict[int, list[Arc]] = defaultdict(list)
    for arc in arcs:
        if passable(arc):
            ahead[arc.tail].append(arc)
    return ahead
