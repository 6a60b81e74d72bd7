"""What is where, told apart by where it comes from: one lane of bits for each source, all followed at once (rule S8).

In: a ``Spread``, before or after its fixpoint. Out: a ``Flood``. A flood can be taken further where some elements or
flows let more pass: only what is new is followed, so a small change costs what it adds, not the whole graph again.
"""

from __future__ import annotations

from collections import OrderedDict, defaultdict
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import parted

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.many_flows import Meeting


NOTHING: Mapping[int, int] = MappingProxyType({})


class Lanes(NamedTuple):
    """How the bits of several sources stand side by side in one number.

    Attributes
    ----------
    number
        Vertex of a source -> number of its lane.
    width
        Bits of a lane.
    unit
        The lowest bit of each lane: times some bits, these are in every lane.

    Examples
    --------
    >>> lanes = Lanes.of([7, 9], 4)
    >>> bin(lanes.every(0b11)), bin(lanes.lane_of(9, 0b1)), lanes.merged(0b0001_0100)
    ('0b110011', '0b10000', 5)
    >>> list(lanes.apart(0b0001_0101))
    [(7, 5), (9, 1)]
    """

    number: Mapping[int, int]
    width: int
    unit: int

    @classmethod
    def of(cls, sources: Sequence[int], width: int) -> Lanes:
        """Number the lanes."""
        return cls({v: i for i, v in enumerate(sources)}, width, sum(1 << width * i for i in range(len(sources))))

    def every(self, bits: int) -> int:
        """Return some bits in every lane."""
        return self.unit * bits

    def lane_of(self, source: int, bits: int) -> int:
        """Return some bits in the lane of a source, if it has one here."""
        return bits << self.width * self.number[source] if source in self.number else 0

    def merged(self, laned: int) -> int:
        """Return the bits that are in any lane."""
        bits, mask = 0, (1 << self.width) - 1
        while laned:
            bits |= laned & mask
            laned >>= self.width
        return bits

    def apart(self, laned: int) -> Iterator[tuple[int, int]]:
        """Yield (source, bits of its lane) where there are any."""
        for source, number in self.number.items():
            if bits := laned >> self.width * number & (1 << self.width) - 1:
                yield source, bits


class Doing(NamedTuple):
    """What elements and flows do with what comes, in lanes; made for elements without a word of their own too.

    Attributes
    ----------
    ahead
        Vertex -> the targets of its flows, but for those below.
    moves
        Vertex -> (flow, its target), of flows that emit or keep something of their own.
    meetings
        Written wildcard -> its meetings, which are flows too.
    labelled
        Vertices of which anything is said: all others pass on what comes.
    keeps, flow_keeps
        Vertex or flow -> what passes as it is; all where absent.
    derives
        Vertex -> (bit that arrives, bit that leaves for it).
    emits, flow_emits
        Vertex or flow -> what begins there, each in the lane of its source.
    stop
        Vertex -> what is not followed on from there.
    allowed
        What is followed at all.
    now, flows_now
        Vertex or flow -> what is done there in place of all that: (what it keeps, what it derives), what it keeps.
    """

    lanes: Lanes
    ahead: Mapping[int, list[int]]
    moves: Mapping[int, list[tuple[int, int]]]
    meetings: Mapping[int, list[Meeting]]
    labelled: Container[int]
    keeps: Mapping[int, int]
    derives: Mapping[int, tuple[tuple[int, int], ...]]
    flow_keeps: Mapping[int, int]
    emits: Mapping[int, int]
    flow_emits: Mapping[int, int]
    allowed: int
    stop: Mapping[int, int] = {}
    now: Mapping[int, tuple[int, tuple[tuple[int, int], ...]]] = {}
    flows_now: Mapping[int, int] = {}

    @classmethod
    def of(cls, spread: Spread, sources: Sequence[int]) -> Doing:
        """Return what a spread says, with a lane for each of some sources."""
        lanes = Lanes.of(sources, spread.all_bits.bit_length())
        ahead: dict[int, list[int]] = defaultdict(list)
        moves: dict[int, list[tuple[int, int]]] = defaultdict(list)
        flows, told_apart = spread.graph.flows, spread.told_apart
        own, meetings = parted(flows, told_apart)
        for index, flow in own:
            if index in told_apart:
                moves[flow.source].append((index, flow.target))
            else:
                ahead[flow.source].append(flow.target)
        met: dict[int, list[Meeting]] = defaultdict(list)
        for meeting in meetings:
            for source in meeting.written:
                met[source].append(meeting)
        begun = {index: lanes.lane_of(flows[index].source, bits) for index, bits in spread.flow_emits.items()}
        return cls(
            lanes,
            ahead,
            moves,
            met,
            spread.keeps,
            {v: lanes.every(bits) for v, bits in spread.keeps.items() if bits != spread.all_bits},
            {v: pairs for v, pairs in spread.derives.items() if pairs},
            {index: lanes.every(bits) for index, bits in spread.flow_keeps.items()},
            {v: lanes.lane_of(v, spread.emits.get(v, 0)) for v in sources},
            {index: bits for index, bits in begun.items() if bits},
            lanes.every(spread.all_bits),
        )

    def stopped(self, stop: Mapping[int, int], allowed: int) -> Doing:
        """Return the same for some bits, some of which are not followed on from some elements; both in lanes."""
        return self._replace(stop={v: bits & allowed for v, bits in stop.items() if bits & allowed}, allowed=allowed)

    def changed(self, spread: Spread) -> Doing:
        """Return the same with what another spread says of the elements and flows that it is about."""
        every = self.lanes.every
        now = {v: (every(bits), spread.derives[v]) for v, bits in spread.keeps.items()}
        return self._replace(now=now, flows_now={i: every(bits) for i, bits in spread.flow_keeps.items()})

    def results(self, vertex: int, bits: int) -> int:
        """Return what an element makes of what arrives, in the same lanes."""
        derives = self.now[vertex][1] if vertex in self.now else self.derives.get(vertex)
        return self._results(derives, bits) if derives else 0

    def _results(self, derives: Iterable[tuple[int, int]], bits: int) -> int:
        result, unit = 0, self.lanes.unit
        for before, after in derives:
            result |= (bits >> before & unit) << after
        return result & self.allowed

    def onward(self, vertex: int, bits: int) -> int:
        """Return what leaves an element when something arrives."""
        stop = self.stop.get(vertex, 0)
        bits &= ~stop
        kept, derives = self.now.get(vertex) or (self.keeps.get(vertex, self.allowed), self.derives.get(vertex))
        made = self._results(derives, bits) if derives else 0
        return (bits & kept | made) & self.allowed & ~stop

    def along(self, flow: int, bits: int) -> int:
        """Return what of some bits goes along a flow."""
        keeps = self.flows_now.get(flow)
        return bits & (self.flow_keeps.get(flow, bits) if keeps is None else keeps) & self.allowed


@dataclass(slots=True, eq=False, repr=False)
class Flood:
    """What arrives and what leaves, in lanes; of one that was taken further only what is more.

    Attributes
    ----------
    arrives, leaves
        Vertex -> bits. What a source sends along single flows only is not in ``leaves``.
    before
        What it was taken further from, which was not itself.
    """

    doing: Doing
    before: Flood | None = None
    arrives: dict[int, int] = field(default_factory=dict)
    leaves: dict[int, int] = field(default_factory=dict)

    @classmethod
    def of(cls, doing: Doing) -> Flood:
        """Follow what begins to where it gets.

        >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
        >>> from rosprivacy.analysis.kernel.spreading import spread
        >>> carried = spread(*factory())
        >>> flood = Flood.of(Doing.of(carried, [CAMERA]))
        >>> carried.planes(flood.arrived(ARCHIVE))  # as they are, pseudonymised
        (('FaceTemplate',), ('Video',))
        """
        flood = cls(doing)
        pending = {v: bits & doing.allowed for v, bits in doing.emits.items() if bits & doing.allowed}
        flood.leaves.update(pending)
        for moves in doing.moves.values() if doing.flow_emits else ():
            for index, target in moves:
                if bits := doing.along(index, doing.flow_emits.get(index, 0)):
                    flood._arrive((target,), bits, pending)
        flood._follow(pending)
        return flood

    def arrived(self, vertex: int) -> int:
        """Return what arrives at an element."""
        if vertex in self.arrives or self.before is None:
            return self.arrives.get(vertex, 0)
        return self.before.arrives.get(vertex, 0)

    def leaving(self, vertex: int) -> int:
        """Return what leaves an element along all of its flows."""
        if vertex in self.leaves or self.before is None:
            return self.leaves.get(vertex, 0)
        return self.before.leaves.get(vertex, 0)

    def present(self, vertex: int, begun: int) -> int:
        """Return what arrives at an element, begins there or is made there; ``begun`` is what begins, in lanes."""
        arrived = self.arrived(vertex)
        stop = self.doing.stop.get(vertex, 0)
        return (arrived | begun | self.doing.results(vertex, arrived & ~stop)) & self.doing.allowed

    def further(self, doing: Doing, vertices: Iterable[int], flows: Iterable[tuple[int, int, int]]) -> Flood:
        """Take a whole one further where some elements and flows do more than before, and none does less.

        Parameters
        ----------
        doing
            What is done now.
        vertices, flows
            Those that do more; flows as (index, source, target).

        Examples
        --------
        >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, FILTER, factory
        >>> from rosprivacy.analysis.kernel.spreading import meaning, spread
        >>> from rosprivacy.analysis.model import Bound
        >>> graph, bound, hierarchy = factory()
        >>> carried = spread(graph, bound, hierarchy)
        >>> flood = Flood.of(Doing.of(carried, [CAMERA]))
        >>> unlabelled = meaning(graph, Bound({FILTER: ()}), hierarchy, carried.categories)
        >>> more = flood.further(flood.doing.changed(unlabelled), [FILTER], [])
        >>> carried.planes(more.arrived(ARCHIVE))
        (('FaceTemplate', 'Video'), ('Video',))
        """
        more = Flood(doing, self)
        pending: dict[int, int] = {}
        for vertex in vertices:
            if new := doing.onward(vertex, self.arrived(vertex)) & ~self.leaving(vertex):
                more.leaves[vertex] = self.leaving(vertex) | new
                pending[vertex] = new
        for index, source, target in flows:
            bits = self.leaving(source) | doing.flow_emits.get(index, 0)
            more._arrive((target,), doing.along(index, bits), pending)
        more._follow(pending)
        return more

    def _follow(self, pending: dict[int, int]) -> None:
        """First in, first out: what comes to one element along several flows goes on together."""
        ahead, moves, meetings = self.doing.ahead, self.doing.moves, self.doing.meetings
        met: dict[int, int] = defaultdict(int)  # what has come to all that a meeting reads
        pending = OrderedDict(pending)  # the first key of a dict is found past all that were taken out
        while pending:
            vertex, bits = pending.popitem(last=False)
            self._arrive(ahead.get(vertex, ()), bits, pending)
            for index, target in moves.get(vertex, ()):
                self._arrive((target,), self.doing.along(index, bits), pending)
            for meeting in meetings.get(vertex, ()):
                if new := bits & ~met[id(meeting)]:
                    met[id(meeting)] |= new
                    self._arrive(meeting.read, new, pending)

    def _arrive(self, targets: Iterable[int], bits: int, pending: dict[int, int]) -> None:
        doing, arrives, leaves = self.doing, self.arrives, self.leaves
        arrived, left = (self.before.arrives, self.before.leaves) if self.before else (NOTHING, NOTHING)
        for target in targets:
            known = arrives[target] if target in arrives else arrived.get(target, 0)
            if not (new := bits & ~known):
                continue
            arrives[target] = known | new
            onward = doing.onward(target, new) if target in doing.labelled else new
            known = leaves[target] if target in leaves else left.get(target, 0)
            if new := onward & ~known:
                leaves[target] = known | new
                pending[target] = pending.get(target, 0) | new
