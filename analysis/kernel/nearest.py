"""The nearest of some places that data would get to: one search back from all of them, then a walk down its levels.

In: a ``Spread`` and the places, as for ``backward``. Out: ``Nearest``, which is asked for as many starts as one likes.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.backward import NOTHING_OPENED, Opened
from rosprivacy.analysis.kernel.states import back, back_from, onward
from rosprivacy.analysis.many_flows import parted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.meeting import Meeting
    from rosprivacy.analysis.model import Flow

FAR = 1 << 60  # further than any path is long


@dataclass(frozen=True, slots=True)
class Nearest:
    """How far each bit that arrives somewhere is from the nearest place.

    Attributes
    ----------
    levels
        Vertex -> (number of flows to a place, bits that are so far from it), the nearest first.
    leaving
        Vertex -> (target, bits that pass the flow), but for meetings.
    meetings
        Vertex -> its meetings, of which it is written.
    walked
        Vertex, bits that arrive there -> the nearest place, as walked so far: many walks go on along the same way.
    """

    spread: Spread
    opened: Opened
    levels: Mapping[int, list[tuple[int, int]]]
    leaving: Mapping[int, list[tuple[int, int]]]
    meetings: Mapping[int, list[Meeting]]
    walked: dict[tuple[int, int], int] = field(default_factory=dict)

    @classmethod
    def of(cls, spread: Spread, places: Mapping[int, int], opened: Opened = NOTHING_OPENED) -> Nearest:
        """Search back from all places at once; O(flows · levels at which bits are new)."""
        leaving: dict[int, list[tuple[int, int]]] = defaultdict(list)
        entering: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for source, target, passing in _flows(spread, opened):
            leaving[source].append((target, passing))
            entering[target].append((source, passing))
        written: dict[int, list[Meeting]] = defaultdict(list)
        read: dict[int, list[Meeting]] = defaultdict(list)
        for meeting in _parted(spread, opened)[1]:
            for ends, of in ((meeting.written, written), (meeting.read, read)):
                for vertex in ends:
                    of[vertex].append(meeting)
        result = cls(spread, opened, defaultdict(list), leaving, written)
        met: dict[int, int] = defaultdict(int)  # what all that is written of a meeting was told
        seen: dict[int, int] = defaultdict(int)
        more = opened.elements
        new = {v: back_from(spread, v, bits, more.get(v, 0)) for v, bits in places.items() if bits}
        level = 0
        while new:
            further: dict[int, int] = defaultdict(int)
            for vertex, bits in sorted(new.items()):
                fresh = bits & ~seen[vertex]
                if fresh:
                    seen[vertex] |= fresh
                    result.levels[vertex].append((level, fresh))
                    for source, passing in entering.get(vertex, ()):
                        further[source] |= fresh & passing
                    for meeting in read.get(vertex, ()):
                        told = fresh & ~met[id(meeting)]
                        met[id(meeting)] |= told
                        for source in meeting.written if told else ():
                            further[source] |= told
            new = {v: before for v, bits in further.items() if (before := back(spread, v, bits, more.get(v, 0)))}
            level += 1
        return result

    def after(self, vertex: int, bits: int) -> int:
        """The nearest place for bits that leave an element; -1 if there is none."""
        return self._walk(self._after(vertex, bits))

    def at(self, vertex: int, bits: int) -> int:
        """The nearest place for bits that arrive at an element, itself included; -1 if there is none."""
        return self._walk([(vertex, bits)])

    def _walk(self, arriving: list[tuple[int, int]]) -> int:
        passed: list[tuple[int, int]] = []
        while True:
            level, vertex, bits = min((self._level(v, bits) for v, bits in arriving), default=(FAR, -1, 0))
            if level in (0, FAR) or (vertex, bits) in self.walked:
                place = self.walked.get((vertex, bits), vertex if level == 0 else -1)
                self.walked.update(dict.fromkeys(passed, place))
                return place
            passed.append((vertex, bits))
            leaving = onward(self.spread, vertex, bits, self.opened.elements.get(vertex, 0))
            arriving = self._after(vertex, leaving)

    def _after(self, vertex: int, bits: int) -> list[tuple[int, int]]:
        """What arrives where of bits that leave an element."""
        met = [(target, bits) for meeting in self.meetings.get(vertex, ()) for target in meeting.read]
        return [*((target, bits & passing) for target, passing in self.leaving.get(vertex, ())), *met]

    def _level(self, vertex: int, bits: int) -> tuple[int, int, int]:
        """How far some bits are from a place: the nearest of them; vertex; these bits."""
        for level, near in self.levels.get(vertex, ()):
            if near & bits:
                return level, vertex, near & bits
        return FAR, vertex, 0


def _flows(spread: Spread, opened: Opened) -> Iterator[tuple[int, int, int]]:
    """Source, target, bits that pass the flow; of flows that are not of meetings."""
    everything = spread.all_bits
    for index, flow in _parted(spread, opened)[0]:
        yield flow.source, flow.target, spread.flow_keeps.get(index, everything) | opened.flows.get(index, 0)
    more: Iterable[tuple[int, int]] = opened.added_flows
    yield from ((source, target, everything) for source, target in more)


def _parted(spread: Spread, opened: Opened) -> tuple[Iterable[tuple[int, Flow]], tuple[Meeting, ...]]:
    return parted(spread.graph.flows, {*spread.told_apart, *opened.flows})
