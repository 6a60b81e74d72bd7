"""The paths that have to be cut: from sources to open findings, as a network over (element, category) (rules S8, S10).

In: a spread and, per group of sources, at which leaks their data may not arrive. Out: ``CutNetwork``: numbered states
and arcs between them, each arc with the flow that it goes along or the channel that it passes. The two planes of a
category are one state: a sanitizer that pseudonymises lets it pass, one that ends it does not, in both planes alike.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.states import States, derived_bits

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.kernel.states import Net

BEGIN, END = 0, 1  # the two states that every network has
At = tuple[int, int]  # vertex, number of the category


@dataclass(frozen=True, slots=True)
class CutGroup:
    """Sources of which the same is decided.

    Attributes
    ----------
    sources
        Vertices.
    accepted
        Leaks that a person has accepted: data goes on from there (rule S10).
    remaining
        Leaks where paths end that need not, or cannot, be cut.
    other_kinds
        Places with an open finding of another kind: data is not to arrive there, but goes on, also from leaks.
    """

    sources: tuple[int, ...]
    accepted: frozenset[At] = frozenset()
    remaining: frozenset[At] = frozenset()
    other_kinds: frozenset[At] = frozenset()


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
    """A network in which every arc lies on a path from ``BEGIN`` to ``END``.

    Attributes
    ----------
    arcs
        In the order in which they were found.
    at
        State -> where it is; not for ``BEGIN`` and ``END``.
    past
        States of paths that leaks do not end: those to findings of other kinds than disclosure.
    """

    arcs: list[Arc] = field(default_factory=list)
    at: dict[int, At] = field(default_factory=dict)
    past: set[int] = field(default_factory=set)


def cut_network(net: Net, groups: Iterable[CutGroup], categories: Collection[int]) -> CutNetwork:
    """Return the network of all paths from the sources of each group to its open findings.

    Parameters
    ----------
    categories
        Numbers of those whose findings are to be removed.

    Notes
    -----
    O(flows · categories) per group and category. They share no state but the two ends: what ends a path of one category
    does not end one on which it is made into another.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> network = cut_network(net, [CutGroup((CAMERA,))], [net.spread.categories.index("FaceTemplate")])
    >>> flows = [net.spread.graph.flows[arc.flow] for arc in network.arcs if arc.flow >= 0]
    >>> [(NAMES[flow.source], NAMES[flow.target]) for flow in flows]
    [('/camera', '/video'), ('/video', '/face_id'), ('/face_id', '/faces'), ('/faces', '/archive')]
    """
    network = CutNetwork()
    for group in groups:
        for category in sorted(categories):
            _Builder(net, group, category, network, past=False).build()
            if any(i == category for _, i in group.other_kinds):
                _Builder(net, group, category, network, past=True).build()
    return _pruned(network)


class _Builder:
    """Walks forward from what the sources of one group emit, to where one category may not get."""

    def __init__(self, net: Net, group: CutGroup, category: int, network: CutNetwork, *, past: bool) -> None:
        self.spread, self.bits = net.spread, net.spread.bits
        self.group = group
        self.category = category
        self.network = network
        self.past = past
        self.category_bits = self.bits.pair(category)
        ends = (vertex for vertex in self.spread.leaks if not past and (vertex, category) not in group.accepted)
        self.states = States(net, self.spread.all_bits, {v: self.spread.leaks[v] & self.category_bits for v in ends})
        self.numbers: dict[tuple[bool, int, int], int] = {}
        self.waiting: deque[tuple[bool, int, int]] = deque()

    def build(self) -> None:
        for source in self.group.sources:
            for i in bits_of(self.bits.merged(self.states.emitted(source))):
                self._arc(BEGIN, self._state(True, source, i), i)
            for index, target, bits in self.states.single(source):
                for i in bits_of(self.bits.merged(bits)):
                    self._arc(BEGIN, self._state(False, target, i), i, flow=index)
        while self.waiting:
            leaving, vertex, i = self.waiting.popleft()
            (self._leave if leaving else self._arrive)(vertex, i)

    def _state(self, leaving: bool, vertex: int, i: int) -> int:  # noqa: FBT001 - a part of the state's name
        key = (leaving, vertex, i)
        if key not in self.numbers:
            self.numbers[key] = len(self.network.at) + 2
            self.network.at[self.numbers[key]] = (vertex, i)
            if self.past:
                self.network.past.add(self.numbers[key])
            self.waiting.append(key)
        return self.numbers[key]

    def _arc(self, tail: int, head: int, category: int, flow: int = -1, channel: int = -1) -> None:
        self.network.arcs.append(Arc(tail, head, category, flow, channel))

    def _stops(self, vertex: int, i: int) -> int:
        """Whether paths to leaks end here: at a leak of the category that is not accepted."""
        return self.states.stop.get(vertex, 0) & self.bits.pair(i)

    def _open(self, vertex: int, i: int) -> bool:
        """Whether data of the category may not get here."""
        at = (vertex, i)
        if self.past:
            return i == self.category and at in self.group.other_kinds
        return at not in self.group.remaining and bool(self._stops(vertex, i))

    def _arrive(self, vertex: int, i: int) -> None:
        here = self._state(False, vertex, i)
        if self._open(vertex, i):
            self._arc(here, END, i)
        if self._stops(vertex, i):
            return
        arriving = self.bits.pair(i)
        leaving = self.bits.merged(self.states.leaving(vertex, arriving))
        if leaving >> i & 1:
            channel = vertex if self.spread.graph.elements[vertex].is_channel else -1
            self._arc(here, self._state(True, vertex, i), i, channel=channel)
        for j in bits_of(self.bits.merged(derived_bits(self.spread, vertex, arriving) & ~arriving)):
            if self._open(vertex, j):
                self._arc(here, END, j)
            if leaving >> j & 1:
                self._arc(here, self._state(True, vertex, j), j)

    def _leave(self, vertex: int, i: int) -> None:
        here = self._state(True, vertex, i)
        for index, target, _ in self.states.after(vertex, self.bits.pair(i)):
            self._arc(here, self._state(False, target, i), i, flow=index)


def _pruned(network: CutNetwork) -> CutNetwork:
    """The arcs from which the end can be reached; the beginning reaches all of them."""
    back: dict[int, list[int]] = defaultdict(list)
    for arc in network.arcs:
        back[arc.head].append(arc.tail)
    alive, waiting = {END}, [END]
    while waiting:
        for before in back[waiting.pop()]:
            if before not in alive:
                alive.add(before)
                waiting.append(before)
    arcs = [arc for arc in dict.fromkeys(network.arcs) if arc.tail in alive and arc.head in alive]
    return CutNetwork(arcs, network.at, network.past)


def a_path(network: CutNetwork, passable: Callable[[Arc], bool]) -> list[Arc] | None:
    """Return a shortest path from the beginning to the end along arcs that are passable; None if there is none.

    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> network = cut_network(net, [CutGroup((CAMERA,))], [net.spread.categories.index("FaceTemplate")])
    >>> [arc.flow for arc in a_path(network, lambda arc: True) if arc.flow >= 0]
    [2, 7, 3, 5]
    >>> a_path(network, lambda arc: arc.flow != 7) is None
    True
    """
    ahead = _ahead(network.arcs, passable)
    came: dict[int, Arc] = {}
    waiting = deque([BEGIN])
    while waiting and END not in came:
        for arc in ahead.get(waiting.popleft(), ()):
            if arc.head not in came and arc.head != BEGIN:
                came[arc.head] = arc
                waiting.append(arc.head)
    if END not in came:
        return None
    path = [came[END]]
    while path[-1].tail != BEGIN:
        path.append(came[path[-1].tail])
    return path[::-1]


def open_ends(network: CutNetwork, passable: Callable[[Arc], bool]) -> Iterator[tuple[At, bool, list[Arc]]]:
    """Yield every open finding's place that is reached along passable arcs, with a shortest path.

    Yields
    ------
    at
        Vertex, and number of the category.
    past
        Whether it is a finding of another kind than disclosure.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> network = cut_network(net, [CutGroup((CAMERA,))], [net.spread.categories.index("FaceTemplate")])
    >>> [(NAMES[vertex], past, len(path)) for (vertex, _), past, path in open_ends(network, lambda arc: True)]
    [('/archive', False, 9)]
    """
    ahead = _ahead(network.arcs, passable)
    came: dict[int, Arc] = {}
    waiting = deque([BEGIN])
    last: dict[tuple[At, bool], Arc] = {}
    while waiting:
        for arc in ahead.get(waiting.popleft(), ()):
            if arc.head == END:
                end = (network.at[arc.tail][0], arc.category)
                last.setdefault((end, arc.tail in network.past), arc)
            elif arc.head not in came:
                came[arc.head] = arc
                waiting.append(arc.head)
    for (at, past), arc in sorted(last.items(), key=lambda item: item[0]):
        path = [arc]
        while path[-1].tail != BEGIN:
            path.append(came[path[-1].tail])
        yield at, past, path[::-1]


def _ahead(arcs: Sequence[Arc], passable: Callable[[Arc], bool]) -> dict[int, list[Arc]]:
    ahead: dict[int, list[Arc]] = defaultdict(list)
    for arc in arcs:
        if passable(arc):
            ahead[arc.tail].append(arc)
    return ahead
