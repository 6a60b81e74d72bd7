"""How data goes on: which states follow which, what starts and where it stops (rules S8 and S10), once and plainly.

A state is (vertex, bit): data of a category, in one of its forms, has arrived at an element. In: a ``Spread``. Out:
``Net``, the flows, and ``States``, the relation. All that walks uses it; the fast forms, ``fixpoint.py`` and
``search.py``, are held against it by a test.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import number, one_by_one, parted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Flow

Move = tuple[int, int, int]  # flow, its target, bits that go along it and are taken up there


class Net(NamedTuple):
    """The flows of a spread, by the vertex that they leave: (index, target, bits that pass it).

    Attributes
    ----------
    flows
        All but those of meetings.
    meetings
        Of wildcards that are written, and of nodes and channels that share rights, if they have data.
    inner
        Those from what is written to a wildcard to what is read from it: one element to the reader, and so no step.
    """

    spread: Spread
    flows: Mapping[int, list[Move]]
    inner: Mapping[int, list[Move]]
    meetings: Mapping[int, list[Meeting]]

    @classmethod
    def of(cls, spread: Spread) -> Net:
        """Index the flows that anything leaves along."""
        graph = spread.graph
        flows: dict[int, list[Move]] = defaultdict(list)
        inner: dict[int, list[Move]] = defaultdict(list)
        by_source, meetings = spread.shape.memoised(
            "flows by source", spread.told_apart, lambda: _by_source(graph.flows, spread.told_apart)
        )
        taken = {vertex: spread.absorbed(vertex) for vertex in spread.keeps}
        keeps, everything = spread.flow_keeps, spread.all_bits
        for source, ways in by_source.items():
            if spread.leaves.get(source):
                moves = [(index, target, taken.get(target, everything)) for index, target in ways]
                if keeps:
                    moves = [(index, target, bits & keeps.get(index, everything)) for index, target, bits in moves]
                flows[source] = moves
                if graph.elements[source].pattern:
                    shown = graph.elements[source].shown_as
                    inner[source] += [move for move in moves if graph.elements[move[1]].shown_as == shown]
        met: dict[int, list[Meeting]] = defaultdict(list)
        for meeting in meetings:
            sides: dict[tuple[str, str, str, str], list[int]] = defaultdict(list)
            for target in meeting.read if meeting.of_wildcards else ():
                sides[graph.elements[target].shown_as].append(target)
            for source in filter(spread.leaves.get, meeting.written):
                met[source].append(meeting)
                for target in sides.get(graph.elements[source].shown_as, ()) if sides else ():
                    inner[source].append(_move(spread, source, target))
        return cls(spread, flows, {source: sorted(moves) for source, moves in inner.items()}, met)

    @classmethod
    def cached(cls, spread: Spread) -> Net:
        """Do the same of a spread that is whole; the flows are indexed once for all answers of one course."""
        return spread.course.memoised("net", None, lambda: cls.of(spread))._replace(spread=spread)

    def leaving(self, vertex: int) -> list[Move]:
        """Return all flows of an element, with the pairs of its meetings."""
        moves, meetings = self.flows.get(vertex, []), self.meetings.get(vertex, ())
        if not meetings:
            return moves
        one_by_one(self.spread.graph.flows)
        return sorted([*moves, *(_move(self.spread, vertex, t) for meeting in meetings for t in meeting.read)])


def _by_source(
    flows: Sequence[Flow], told_apart: Collection[int]
) -> tuple[Mapping[int, Sequence[tuple[int, int]]], tuple[Meeting, ...]]:
    """Source -> (index, target) of its flows, and the meetings."""
    own, meetings = parted(flows, told_apart)
    found: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for index, flow in own:
        found[flow.source].append((index, flow.target))
    return dict(found), meetings


def _move(spread: Spread, source: int, target: int) -> Move:
    """One flow of a meeting."""
    return number(spread.graph.flows, source, target), target, spread.absorbed(target)


class States(NamedTuple):
    """The states of a net, and how they follow each other.

    Attributes
    ----------
    allowed
        Bits to follow.
    stop
        Vertex -> bits that are not followed on from there; what a source emits is.
    """

    net: Net
    allowed: int
    stop: Mapping[int, int]

    def emitted(self, vertex: int) -> int:
        """Return the bits that leave a source along all of its flows."""
        return self.net.spread.emits.get(vertex, 0) & self.allowed

    def single(self, vertex: int) -> Iterator[Move]:
        """Yield what a source emits along single flows only."""
        for index, target, passing in self.net.flows.get(vertex, ()):
            if bits := self.net.spread.flow_emits.get(index, 0) & self.allowed & passing:
                yield index, target, bits

    def leaving(self, vertex: int, bits: int) -> int:
        """Return the bits that leave an element when some arrive."""
        stop = self.stop.get(vertex, 0)
        return onward(self.net.spread, vertex, bits & ~stop) & self.allowed & ~stop

    def after_alone(self, vertex: int, leaving: int) -> Iterator[Move]:
        """Yield where bits arrive that leave an element, but for its meetings."""
        for index, target, passing in self.net.flows.get(vertex, ()) if leaving else ():
            if bits := leaving & passing:
                yield index, target, bits

    def after(self, vertex: int, leaving: int) -> Iterator[Move]:
        """Yield where bits arrive that leave an element."""
        for index, target, passing in self.net.leaving(vertex) if leaving else ():
            if bits := leaving & passing:
                yield index, target, bits


def derived_bits(spread: Spread, vertex: int, bits: int) -> int:
    """Return the bits that an element makes of some that arrive.

    >>> from rosprivacy.analysis.example import FACE_ID, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> carried.names(derived_bits(carried, FACE_ID, carried.forms_of("Video")))
    ('FaceTemplate',)
    """
    result = 0
    for before, after in spread.derives.get(vertex, ()):
        result |= (bits >> before & 1) << after
    return result


def onward(spread: Spread, vertex: int, bits: int, opened: int = 0) -> int:
    """Return the bits that leave an element when some arrive: as they are, or as what is made of them.

    Parameters
    ----------
    opened
        Bits that pass although labels close the element for them.

    Examples
    --------
    >>> from rosprivacy.analysis.example import FILTER, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> carried.planes(onward(carried, FILTER, carried.forms_of("Video")))  # as it is, pseudonymised
    ((), ('Video',))
    """
    return bits & (spread.keeps.get(vertex, spread.all_bits) | opened) | derived_bits(spread, vertex, bits)


def back(spread: Spread, vertex: int, bits: int, opened: int = 0) -> int:
    """Return the bits that have to arrive at an element for some to leave it: ``onward``, turned around.

    >>> from rosprivacy.analysis.example import FACE_ID, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> carried.names(back(carried, FACE_ID, carried.forms_of("FaceTemplate")))
    ('FaceTemplate', 'Video')
    """
    result = bits & (spread.keeps.get(vertex, spread.all_bits) | opened)
    for before, after in spread.derives.get(vertex, ()):
        result |= (bits >> after & 1) << before
    return result


def back_from(spread: Spread, vertex: int, bits: int, opened: int = 0) -> int:
    """Return the bits that have to arrive for some to be there: a node has what arrives, a channel what it carries.

    >>> from rosprivacy.analysis.example import FACES, FILTER, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> [carried.planes(back_from(carried, vertex, carried.forms_of("Video"))) for vertex in (FACES, FILTER)]
    [((), ()), (('Video',), ('Video',))]
    """
    return back(spread, vertex, bits, opened) | (0 if spread.graph.elements[vertex].is_channel else bits)
