"""Breadth-first search over (vertex, bit): where data goes from some vertices, how far, and along which flows.

In: a ``Spread``. Out: a ``Search``, from which shortest paths are read. All bits are searched together, level by level,
so that a vertex is expanded once per level in which bits are new to it. Ties fall to the lower vertex, and vertices are
sorted: the same input gives the same paths (rule S14). Of searches from one source each, those of the answer before
hold where nothing they met is otherwise now: an edit of a label changes what happens at a few elements.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.spread import differing
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.many_flows import number, parted

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Mapping
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.kernel.spread import Spread

    Key = tuple[int, int, Hashable]

START = -1


@dataclass(slots=True, eq=False, repr=False)
class Search:
    """How far one search gets.

    Attributes
    ----------
    arrived
        Vertex -> (level, bits new at that level, flow that brought them), in order. The two sides of a wildcard are
        at one level. In place of a flow of a meeting stands -2 minus the vertex that it is from.
    leaving
        Vertex -> (bits, the bit that they were made from, or None if they just passed, or ``START``), in order.
    seen, gone
        Vertex -> all bits that arrived, all that left.
    begun
        Start -> all bits that it emits, also those that leave along single flows only.
    making
        Where something was made of what arrived.
    """

    arrived: dict[int, list[tuple[int, int, int]]] = field(default_factory=lambda: defaultdict(list))
    leaving: dict[int, list[tuple[int, int | None]]] = field(default_factory=lambda: defaultdict(list))
    arrived_bits: dict[int, int] = field(default_factory=dict)
    left_bits: dict[int, int] = field(default_factory=dict)
    begun: dict[int, int] = field(default_factory=dict)
    making: set[int] = field(default_factory=set)

    def level(self, vertex: int, bits: int) -> int | None:
        """Flows from a start to the nearest arrival of one of some bits; 0 if they start there."""
        if self.begun.get(vertex, 0) & bits:
            return 0
        arrived = self.arrived.get(vertex, ())
        nearest = _first_level(arrived, bits)
        for made, origin in self.leaving[vertex] if vertex in self.making else ():
            if origin is not None and origin != START and made & bits:
                before = _first_level(arrived, 1 << origin)
                if before is not None and (nearest is None or before < nearest):
                    nearest = before
        return nearest

    def arrives_first(self, vertex: int, bit: int) -> bool:
        """Whether a bit arrives at a vertex no later than it is made there."""
        arrival = _first_level(self.arrived.get(vertex, ()), 1 << bit)
        return arrival is not None and arrival == self.level(vertex, 1 << bit)


def _first_level(arrived: Iterable[tuple[int, int, int]], bits: int) -> int | None:
    for level, new, _ in arrived:
        if new & bits:
            return level
    return None


def search(
    net: Net,
    starts: Iterable[int],
    allowed: int,
    stop: Mapping[int, int],
    leaving_starts: Mapping[int, int] | None = None,
) -> Search:
    """Search from what some vertices emit.

    Parameters
    ----------
    starts
        Vertices.
    allowed
        Bits to follow.
    stop
        Vertex -> bits that are not followed on from there (but from a start they are).
    leaving_starts
        Start -> the bits that leave it, where that is not what it emits.

    Notes
    -----
    O(flows · levels at which bits are new to their source).

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, FACE_ID, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> reach = search(net, [CAMERA], net.spread.all_bits, {})
    >>> past = search(net, [CAMERA], net.spread.all_bits, {FACE_ID: net.spread.all_bits})
    >>> [some.level(ARCHIVE, net.spread.forms_of("FaceTemplate")) for some in (reach, past)]
    [4, None]
    """
    reach, level = Search(), 0
    leaving, single = _begun(net, reach, starts, allowed, leaving_starts)
    met: dict[int, int] = defaultdict(int)  # bits that have come to all that a meeting reads
    while leaving or single:
        level += 1
        arriving = _arrivals(net, reach, leaving, single, met, level)
        leaving, single = _departures(net, reach, arriving, allowed, stop, level), []
    return reach


def _begun(
    net: Net, reach: Search, starts: Iterable[int], allowed: int, leaving_starts: Mapping[int, int] | None
) -> tuple[dict[int, int], list[tuple[int, int, int]]]:
    """What leaves the starts, by vertex; and what they emit through single flows only: flow, its target, bits."""
    spread = net.spread
    emits = spread.emits if leaving_starts is None else leaving_starts
    first = {vertex: emits.get(vertex, 0) & allowed for vertex in sorted(starts)}
    begins = spread.begins if leaving_starts is None else leaving_starts.__getitem__
    reach.begun.update({vertex: begins(vertex) & allowed for vertex in first})
    leaving: dict[int, int] = defaultdict(int)
    for vertex, bits in first.items():
        _leave(reach, vertex, bits, START, leaving)
    return leaving, _through_flows(net, first, allowed) if leaving_starts is None else []


def _arrivals(
    net: Net, reach: Search, leaving: Mapping[int, int], single: Iterable[tuple[int, int, int]], met: dict[int, int],
    level: int,
) -> dict[int, int]:  # fmt: skip
    """What is new where the flows of a level end: vertex -> bits."""
    arrived, seen, flows, meetings = reach.arrived, reach.arrived_bits, net.flows, net.meetings
    arriving: dict[int, int] = defaultdict(int)
    for index, target, bits in single:
        _arrive(reach, target, bits, level, index, arriving)
    for vertex in sorted(leaving):
        bits = leaving[vertex]
        for index, target, passing in flows.get(vertex, ()):
            known = seen.get(target, 0)
            if new := bits & passing & ~known:  # ``_arrive``, written out: most of the time is spent here
                seen[target] = known | new
                arrived[target].append((level, new, index))
                arriving[target] |= new
        for meeting in meetings.get(vertex, ()):
            if new := bits & ~met[id(meeting)]:
                met[id(meeting)] |= new
                _arrive_at_all(net, reach, vertex, meeting.read, new, level, arriving)
    return arriving


def _departures(
    net: Net, reach: Search, arriving: Mapping[int, int], allowed: int, stop: Mapping[int, int], level: int
) -> dict[int, int]:
    """What leaves again of what arrives at a level, on the other side of a wildcard too: vertex -> bits."""
    spread, gone = net.spread, reach.left_bits
    keeps, derives, everything = spread.keeps, spread.derives, spread.all_bits
    leaving: dict[int, int] = defaultdict(int)
    for vertex, bits in sorted(arriving.items()):
        if vertex in stop or vertex in derives:
            _pass_on(spread, reach, vertex, bits, allowed, stop.get(vertex, 0), leaving)
        elif new := bits & keeps.get(vertex, everything) & ~gone.get(vertex, 0):
            _leave(reach, vertex, new, None, leaving)
    read = _across_sides(net, reach, level, leaving)
    for vertex in sorted(read):
        _pass_on(spread, reach, vertex, read[vertex], allowed, stop.get(vertex, 0), leaving)
    return leaving


def from_sources(spread: Spread) -> tuple[Net, Search]:
    """Search from all sources, past every leak; only of a spread that is whole, since the answer is kept.

    What is open, a page and its picture ask the same of one answer.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> _, reach = from_sources(carried)
    >>> reach.level(ARCHIVE, carried.forms_of("FaceTemplate"))
    4
    """
    net = Net.cached(spread)

    def find() -> Search:
        return search(net, [vertex for vertex in spread.facts if spread.begins(vertex)], spread.all_bits, {})

    return net, spread.course.memoised("from sources", None, find)


def _across_sides(net: Net, reach: Search, level: int, leaving: Mapping[int, int]) -> dict[int, int]:
    """What gets from one side of a wildcard to the other within a level."""
    read: dict[int, int] = defaultdict(int)
    for vertex in sorted(leaving.keys() & net.inner.keys()):
        for index, target, passing in net.inner[vertex]:
            if leaving[vertex] & passing:
                _arrive(reach, target, leaving[vertex] & passing, level, index, read)
    return read


def _through_flows(net: Net, first: Mapping[int, int], allowed: int) -> list[tuple[int, int, int]]:
    """What sources emit through single flows only: flow, its target, bits."""
    single = []
    for vertex in first:
        for index, target, passing in net.flows.get(vertex, ()):
            bits = net.spread.flow_emits.get(index, 0) & allowed & passing
            if bits:
                single.append((index, target, bits))
    return single


def _arrive(reach: Search, target: int, bits: int, level: int, flow: int, arriving: dict[int, int]) -> None:
    new = bits & ~reach.arrived_bits.get(target, 0)
    if new:
        reach.arrived_bits[target] = reach.arrived_bits.get(target, 0) | new
        reach.arrived[target].append((level, new, flow))
        arriving[target] |= new


def _arrive_at_all(
    net: Net, reach: Search, vertex: int, targets: Iterable[int], bits: int, level: int, arriving: dict[int, int]
) -> None:
    """What gets from an element to all that its meeting reads."""
    taken, seen, came = net.spread.absorbed, reach.arrived_bits, -2 - vertex
    for target in targets:
        if some := bits & ~seen.get(target, 0) & taken(target):
            _arrive(reach, target, some, level, came, arriving)


def _pass_on(
    spread: Spread, reach: Search, vertex: int, bits: int, allowed: int, stop: int, leaving: dict[int, int]
) -> None:
    """What arrives leaves again: as it is, or as what is made of it; not what stops here."""
    bits &= ~stop
    kept = bits & spread.keeps.get(vertex, spread.all_bits)
    _leave(reach, vertex, kept, None, leaving)
    for before, after in spread.derives.get(vertex, ()):
        if bits >> before & 1:
            reach.making.add(vertex)
            made = 1 << after & allowed
            if made & stop:
                reach.leaving[vertex].append((made, before))  # it gets here, and ends here
            else:
                _leave(reach, vertex, made, before, leaving)


def _leave(reach: Search, vertex: int, bits: int, origin: int | None, leaving: dict[int, int]) -> None:
    new = bits & ~reach.left_bits.get(vertex, 0)
    if new:
        reach.left_bits[vertex] = reach.left_bits.get(vertex, 0) | new
        reach.leaving[vertex].append((new, origin))
        leaving[vertex] |= new


def present(reach: Search, vertex: int) -> int:
    """Bits that arrive at a vertex, start there, or are made there.

    >>> from rosprivacy.analysis.example import CAMERA, FACE_ID, FACES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> reach = search(net, [CAMERA], net.spread.all_bits, {})
    >>> [net.spread.names(present(reach, vertex)) for vertex in (CAMERA, FACE_ID, FACES)]
    [('Video',), ('FaceTemplate', 'Video'), ('FaceTemplate',)]
    """
    made = 0
    for bits, origin in reach.leaving.get(vertex, ()):
        if origin is not None:
            made |= bits
    return reach.arrived_bits.get(vertex, 0) | reach.begun.get(vertex, 0) | made


def path_to(net: Net, reach: Search, vertex: int, bit: int) -> list[tuple[int, int, int]]:
    """Read a shortest path back from a vertex where a bit is.

    Returns
    -------
    steps
        (flow, or ``START`` for the first; vertex; bit with which data is there), source first.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> reach = search(net, [CAMERA], net.spread.all_bits, {})
    >>> templates = net.spread.bits.plain(net.spread.categories.index("FaceTemplate"))
    >>> [(NAMES[v], *net.spread.names(1 << bit)) for _, v, bit in path_to(net, reach, ARCHIVE, templates)][1:4]
    [('/video', 'Video'), ('/face_id', 'Video'), ('/faces', 'FaceTemplate')]
    """
    graph, single = net.spread.graph, net.spread.flow_emits
    steps: list[tuple[int, int, int]] = []
    came = _flow_of(net, reach, vertex, bit) if reach.arrives_first(vertex, bit) else START
    while True:
        if came == START:  # it was made here, or starts here
            origin = next((o for bits, o in reach.leaving.get(vertex, ()) if bits >> bit & 1 and o is not None), START)
            if origin == START:
                return [(START, vertex, bit), *steps[::-1]]
            bit = origin
            came = _flow_of(net, reach, vertex, bit)
        steps.append((came, vertex, bit))
        vertex = graph.flows[came].source
        if vertex in reach.begun and single.get(came, 0) >> bit & 1:
            return [(START, vertex, bit), *steps[::-1]]
        passed = any(bits >> bit & 1 and origin is None for bits, origin in reach.leaving[vertex])
        came = _flow_of(net, reach, vertex, bit) if passed else START


def _flow_of(net: Net, reach: Search, vertex: int, bit: int) -> int:
    """The flow along which a bit first arrived."""
    came = next(flow for _, new, flow in reach.arrived[vertex] if new >> bit & 1)
    return came if came >= 0 else number(net.spread.graph.flows, -2 - came, vertex)


ROOM = 20_000  # vertices to which the searches that are kept came in all: some 20 MB


class Searches:
    """The searches of one answer.

    Parameters
    ----------
    room
        To how many vertices the searches may come in all that are kept; by default none are, since only where one
        answer follows another they are of use.
    made
        Those that hold already.
    """

    def __init__(self, room: int = 0, earlier: Mapping[Key, Search] | None = None) -> None:
        self._earlier = dict(earlier or {})
        self._room = room - sum(len(one.arrived_bits) for one in self._earlier.values())

    def past(self, changed: AbstractSet[int]) -> Searches:
        """Return those that came to none of some vertices, with room for more."""
        return Searches(ROOM, {key: one for key, one in self._earlier.items() if _untouched(key[0], one, changed)})

    def of(self, net: Net, source: int, allowed: int, stop: Mapping[int, int], stop_key: Hashable) -> Search:
        """Return a search as ``search`` makes it, from one source.

        Parameters
        ----------
        stop_key
            What ``stop`` is made of beside ``Spread.leaks``; equal only where it is made alike.
        """
        key = source, allowed, stop_key
        known = self._earlier.get(key)
        if known is not None:
            return known
        made = search(net, [source], allowed, stop)
        if len(made.arrived_bits) <= self._room:
            self._room -= len(made.arrived_bits)
            self._earlier[key] = made
        return made


def searches(spread: Spread, room: int = 0) -> Searches:
    """Return the searches of an answer, with those of the answer before that hold for it.

    Parameters
    ----------
    room
        As of ``Searches``, where there was no answer before.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> carried = spread(*factory())
    >>> made = searches(carried, ROOM).of(Net.of(carried), CAMERA, carried.all_bits, {}, None)
    >>> made.level(ARCHIVE, carried.forms_of("FaceTemplate"))
    4
    """
    return spread.memory.memoised("searches", None, lambda: Searches(room))


def searches_after(before: Spread, now: Spread, changed: AbstractSet[int]) -> None:
    """Let the searches of an answer hold for the next one, where they came to nothing that is otherwise there.

    Parameters
    ----------
    changed
        Of ``Spread.otherwise``.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> first, same = spread(*factory()), factory()
    >>> made = searches(first, ROOM).of(Net.of(first), CAMERA, first.all_bits, {}, None)
    >>> now = spread(first.graph, *same[1:])
    >>> searches_after(first, now, now.otherwise(first))
    >>> searches(now).of(Net.of(now), CAMERA, now.all_bits, {}, None) is made
    True
    """
    left = searches(before).past(_met_otherwise(before, now, changed))
    now.memory.memoised("searches", None, lambda: left)


def _untouched(source: int, earlier: Search, changed: AbstractSet[int]) -> bool:
    return source not in changed and not any(vertex in earlier.arrived_bits for vertex in changed)


def _met_otherwise(before: Spread, now: Spread, changed: AbstractSet[int]) -> set[int]:
    """The vertices where something else happens to data than before, or searches are stopped otherwise.

    Where a channel takes up other data, it is its writers from which data goes on otherwise.
    """
    met = {*changed, *differing(before.leaks, now.leaks, 0)}
    channels = {vertex for vertex in changed if now.graph.elements[vertex].is_channel}
    if channels:
        own, meetings = parted(now.graph.flows, now.told_apart)
        met.update(flow.source for _, flow in own if flow.target in channels)
        met.update(vertex for one in meetings if not channels.isdisjoint(one.read) for vertex in one.written)
    return met
