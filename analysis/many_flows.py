"""Flows of which most are alike: where each of many elements sends to each of as many, each pair is a flow, not stored.

In: flows to store, and meetings: some written wildcards, each of which meets each of some read ones (rule S4); or the
nodes of an enclave and the channels that each of them may write, or read, as the enforced view has it (rule S6). Out:
``Flows``, the sequence of all flows, sorted and numbered as if all were stored. Who goes through a meeting as a whole
takes it from ``parted``; who asks for each flow gets each pair, up to the bound of flows.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, NamedTuple, overload

from rosprivacy.analysis.bounds import BOUNDS, Bounds
from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.analysis.model import Flow, Place

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.model import Grant

MATCHES = "matches"


class Right(NamedTuple):
    """What the nodes of an enclave may do with a channel: the role, and the policy lines that allow it."""

    role: str
    grants: tuple[Grant, ...] = ()


class Meeting(NamedTuple):
    """Elements each of which sends to each of some others, by index; both sorted.

    Attributes
    ----------
    written, read
        Wildcards; or nodes and channels, in either direction.
    of_written, of_read
        Of each channel, where the other side is the nodes of an enclave: their right. Empty for wildcards.
    """

    written: tuple[int, ...]
    read: tuple[int, ...]
    of_written: tuple[Right, ...] = ()
    of_read: tuple[Right, ...] = ()

    @property
    def size(self) -> int:
        """How many flows it stands for."""
        return len(self.written) * len(self.read)

    @property
    def of_wildcards(self) -> bool:
        """Whether both sides are channels."""
        return not self.of_written and not self.of_read

    def pairs(self) -> Iterable[tuple[int, int]]:
        """Return the ends of each flow that it stands for."""
        return ((source, target) for source in self.written for target in self.read)

    def flow(self, source: int, target: int) -> Flow:
        """Return one of the flows."""
        if self.of_read:
            return Flow(source, target, *self.of_read[bisect_left(self.read, target)])
        if self.of_written:
            return Flow(source, target, *self.of_written[bisect_left(self.written, source)])
        return Flow(source, target, MATCHES)

    def flows(self) -> Iterable[Flow]:
        """Return each flow that it stands for."""
        return (self.flow(*pair) for pair in self.pairs())

    def parted(self, ends: Iterable[tuple[int, int]]) -> tuple[Meeting, Meeting]:
        """Return it without the elements of one side that some flows are of, and with these only."""
        written, read = set(self.written), set(self.read)
        inside = [(source, target) for source, target in ends if source in written and target in read]
        sources, targets = {source for source, _ in inside}, {target for _, target in inside}
        if len(sources) <= len(targets):
            return self._part(written - sources, read), self._part(sources, read)
        return self._part(written, read - targets), self._part(written, targets)

    def _part(self, written: Collection[int], read: Collection[int]) -> Meeting:
        sides = ((self.written, self.of_written, written), (self.read, self.of_read, read))
        ends = [tuple(vertex for vertex in side if vertex in some) for side, _, some in sides]
        rights = [tuple(of for vertex, of in zip(*pair, strict=False) if vertex in some) for *pair, some in sides]
        return Meeting(ends[0], ends[1], rights[0], rights[1])


def sharing(nodes: tuple[int, ...], channels: tuple[int, ...], rights: tuple[Right, ...], *, writes: bool) -> Meeting:
    """Return what nodes of an enclave share: each writes, or reads, each of some channels.

    Parameters
    ----------
    rights
        Of each channel.

    Examples
    --------
    >>> sharing((0, 1), (5,), (Right("subscribe"),), writes=False).flow(5, 1).role
    'subscribe'
    """
    return Meeting(nodes, channels, of_read=rights) if writes else Meeting(channels, nodes, of_written=rights)


@dataclass(frozen=True)
class Flows(Sequence[Flow]):
    """All flows of a graph; those of meetings are made when somebody asks for them.

    Attributes
    ----------
    stored
        Those of no meeting, sorted by (source, target, role); none has the ends of a pair of a meeting.
    meetings
        No two have a pair in common.
    bounds, place
        Above the bound of flows the pairs are not made one by one; the line that is named then.

    Examples
    --------
    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> flows = Flows((Flow(0, 1, "publish"),), (Meeting((1, 2), (3, 4)),))
    >>> len(flows), [(flow.source, flow.target) for flow in flows], flows.number(2, 3)
    (5, [(0, 1), (1, 3), (1, 4), (2, 3), (2, 4)], 3)
    """

    stored: tuple[Flow, ...]
    meetings: tuple[Meeting, ...]
    bounds: Bounds = field(default=BOUNDS, compare=False)
    place: Place = field(default=Place("", 0), compare=False)

    def __len__(self) -> int:
        """Count the pairs of meetings like others."""
        return self._before[-1]

    @overload
    def __getitem__(self, at: int) -> Flow: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Flow, ...]: ...
    def __getitem__(self, at: int | slice) -> Flow | tuple[Flow, ...]:
        """Return a flow by its number, or some."""
        if isinstance(at, slice):
            return tuple(self[number] for number in range(len(self))[at])
        number = range(len(self))[at]
        if "_all" in self.__dict__:  # somebody has asked for all
            return self._all[number]
        if number in self._stored:
            return self._stored[number]
        source = self._sources[bisect_right(self._before, number) - 1]
        low, high = 0, self._highest
        while low < high:  # the first target up to which there are more flows than before the one asked for
            middle = (low + high) // 2
            low, high = (low, middle) if self.number(source, middle + 1) > number else (middle + 1, high)
        for meeting in self._meets.get(source, ()):
            if _has(meeting.read, low):
                return meeting.flow(source, low)
        raise AssertionError(number)

    def __iter__(self):  # type: ignore[no-untyped-def]  # noqa: ANN204 - as of Sequence
        """Go through all, one by one."""
        return iter(self._all)

    def __eq__(self, other: object) -> bool:
        """Compare as sequences."""
        if isinstance(other, Flows):
            return (self.stored, self.meetings) == (other.stored, other.meetings)
        return isinstance(other, tuple) and len(self) == len(other) and self._all == other

    def __hash__(self) -> int:
        """Of what is stored."""
        return hash((self.stored, self.meetings))

    def number(self, source: int, target: int) -> int:
        """Return the number of a pair of a meeting: so many flows come before it."""
        place = bisect_left(self._sources, source)
        stored = bisect_left(self._ends, (source, target)) - bisect_left(self._ends, (source,))
        return (
            self._before[place]
            + stored
            + sum(bisect_left(meeting.read, target) for meeting in self._meets.get(source, ()))
        )

    def find(self, flow: Flow) -> int | None:
        """Return the number of a flow between the same ends in the same role; None if there is none."""
        for meeting in self._meets.get(flow.source, ()):
            if _has(meeting.read, flow.target):
                same = meeting.flow(flow.source, flow.target).role == flow.role
                return self.number(flow.source, flow.target) if same else None
        place = bisect_left(self._ends, flow[:3])
        there = place < len(self._ends) and self._ends[place] == flow[:3]
        return self._number_of_stored(place) if there else None

    def apart(self, special: Collection[int] = ()) -> tuple[list[tuple[int, Flow]], tuple[Meeting, ...]]:
        """Return flows with their numbers, in order, and the meetings that the others make.

        Parameters
        ----------
        special
            Numbers of flows that are told by themselves, with all others of one of their ends in a meeting.
        """
        ends = [(flow.source, flow.target) for flow in map(self.__getitem__, special)]
        if not ends:
            return list(self._rows), self.meetings
        parts = [meeting.parted(ends) for meeting in self.meetings]
        self.check(sum(told.size for _, told in parts))
        more = [(self.number(flow.source, flow.target), flow) for _, told in parts for flow in told.flows()]
        self._stored.update(more)
        return sorted([*self._rows, *more], key=_first), tuple(left for left, _ in parts if left.size)

    def leaving(self) -> dict[int, range]:
        """Return the numbers of the flows out of each element that has any."""
        return {source: range(*ends) for source, ends in zip(self._sources, pairwise(self._before), strict=True)}

    def check(self, number: int) -> None:
        """Refuse to make more pairs than the bound of flows."""
        if number > self.bounds.flows:
            raise InputErrors([PolicyError(self.place.file, self.place.line, *self.bounds.refusal("flows"))])

    @cached_property
    def _all(self) -> tuple[Flow, ...]:
        self.check(sum(meeting.size for meeting in self.meetings))
        made = (flow for meeting in self.meetings for flow in meeting.flows())
        return tuple(sorted([*self.stored, *made], key=lambda flow: (flow.source, flow.target, flow.role)))

    def _number_of_stored(self, place: int) -> int:
        flow = self.stored[place]
        return self.number(flow.source, flow.target) + place - bisect_left(self._ends, (flow.source, flow.target))

    @cached_property
    def _rows(self) -> Sequence[tuple[int, Flow]]:
        rows: list[tuple[int, Flow]] = []
        place, sources = 0, iter(zip(self._sources, self._before, strict=False))
        source, number = -1, 0
        for flow in self.stored:
            while source != flow.source:
                source, number = next(sources)
                place, reads = 0, [meeting.read for meeting in self._meets.get(source, ())]
            rows.append((number + place + sum(bisect_left(read, flow.target) for read in reads), flow))
            place += 1
        return rows

    @cached_property
    def _stored(self) -> dict[int, Flow]:
        """Flows by their number: those that are stored, and those that were told by themselves."""
        return dict(self._rows)

    @cached_property
    def _meets(self) -> Mapping[int, list[Meeting]]:
        meets: dict[int, list[Meeting]] = defaultdict(list)
        for meeting in self.meetings:
            for source in meeting.written:
                meets[source].append(meeting)
        return dict(meets)

    @cached_property
    def _ends(self) -> Sequence[tuple[int, ...] | tuple[int, int, str]]:
        return [(flow.source, flow.target, flow.role) for flow in self.stored]

    @cached_property
    def _sources(self) -> Sequence[int]:
        return sorted({*self._meets, *(flow.source for flow in self.stored)})

    @cached_property
    def _before(self) -> Sequence[int]:
        """How many flows there are before those of each source, and in all."""
        number: dict[int, int] = defaultdict(int)
        for flow in self.stored:
            number[flow.source] += 1
        for source, meetings in self._meets.items():
            number[source] += sum(len(meeting.read) for meeting in meetings)
        return list(accumulate((number[source] for source in self._sources), initial=0))

    @cached_property
    def _highest(self) -> int:
        return max([flow.target for flow in self.stored] + [meeting.read[-1] for meeting in self.meetings], default=0)


def parted(
    flows: Sequence[Flow], special: Collection[int] = ()
) -> tuple[Iterable[tuple[int, Flow]], tuple[Meeting, ...]]:
    """Return flows with their numbers, in order, and the meetings that all others make.

    Parameters
    ----------
    special
        Numbers of flows that are to be among the first.

    Examples
    --------
    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> own, meetings = parted(Flows((Flow(0, 1, "publish"),), (Meeting((1, 2), (3, 4)),)))
    >>> [number for number, _ in own], len(meetings)
    ([0], 1)
    """
    return flows.apart(special) if isinstance(flows, Flows) else (enumerate(flows), ())


def number(flows: Sequence[Flow], source: int, target: int) -> int:
    """Return the number of a flow of a meeting.

    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> number(Flows((), (Meeting((1, 2), (3, 4)),)), 2, 3)
    2
    """
    assert isinstance(flows, Flows), "no others have meetings"
    return flows.number(source, target)


def find(flows: Sequence[Flow], flow: Flow) -> int | None:
    """Return the number of a flow between the same ends in the same role; None if there is none.

    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> find(Flows((), (Meeting((1, 2), (3, 4)),)), Flow(2, 3, "matches")), find((), Flow(2, 3, "matches"))
    (2, None)
    """
    if isinstance(flows, Flows):
        return flows.find(flow)
    at = bisect_left(flows, flow[:3], key=lambda one: one[:3])
    return at if at < len(flows) and flows[at][:3] == flow[:3] else None


def one_by_one(flows: Sequence[Flow]) -> Sequence[Flow]:
    """Return flows to go through one by one, by number too.

    Raises
    ------
    InputErrors
        Where meetings stand for more than the bound of flows.

    Examples
    --------
    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> len(one_by_one(Flows((), (Meeting((1, 2), (3, 4)),))))
    4
    """
    return tuple(flows) if isinstance(flows, Flows) else flows


def at_most(flows: Sequence[Flow], number: int) -> Sequence[Flow]:
    """Return flows of which so many are asked for; the same, where it is some of them only.

    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> len(at_most(Flows((), (Meeting((1, 2), (3, 4)),)), 2))
    4
    """
    if isinstance(flows, Flows):
        flows.check(number)
    return flows


def leaving(flows: Sequence[Flow]) -> Mapping[int, range]:
    """Return the numbers of the flows out of each element that has any.

    >>> from rosprivacy.analysis.many_flows import Meeting
    >>> leaving(Flows((Flow(0, 1, "publish"),), (Meeting((1, 2), (3, 4)),)))
    {0: range(0, 1), 1: range(1, 3), 2: range(3, 5)}
    """
    if isinstance(flows, Flows):
        return flows.leaving()
    ends = {flow.source: at + 1 for at, flow in enumerate(flows)}
    return {source: range(first, end) for first, (source, end) in zip((0, *ends.values()), ends.items(), strict=False)}


def _has(vertices: Sequence[int], vertex: int) -> bool:
    at = bisect_left(vertices, vertex)
    return at < len(vertices) and vertices[at] == vertex


def _first(row: tuple[int, Flow]) -> int:
    return row[0]
