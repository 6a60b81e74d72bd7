"""From where data would get to some places: the fixpoint of rule S8, run against the flows.

In: a ``Spread`` and, per vertex, the bits that count there. Out: ``Backward``: per vertex the bits that, if they
arrived there or left from there, would get to such a place. One run of the kernel, whatever the number of places.
Which place is the nearest is told by ``findings/closures.py``.

A part of what labels close can be opened for one run: then it says what that part keeps shut.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph, ends, nodes_of
from rosprivacy.analysis.kernel.least_solution import least_solution, propagated
from rosprivacy.analysis.kernel.states import back_from

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.kernel.spread import Spread


class Opened(NamedTuple):
    """What is opened for one run.

    Attributes
    ----------
    elements, flows
        Vertex, or index of a flow -> bits that pass it although labels close it for them.
    added_flows
        (source, target) of flows that are not in the graph, such as denied ones.
    """

    elements: Mapping[int, int] = {}
    flows: Mapping[int, int] = {}
    added_flows: Collection[tuple[int, int]] = ()

    @classmethod
    def of(cls, parts: Iterable[Opened]) -> Opened:
        """Return all that some open, together."""
        elements: dict[int, int] = defaultdict(int)
        flows: dict[int, int] = defaultdict(int)
        more: set[tuple[int, int]] = set()
        for part in parts:
            for opened, bits in part.elements.items():
                elements[opened] |= bits
            for opened, bits in part.flows.items():
                flows[opened] |= bits
            more.update(part.added_flows)
        return cls(elements, flows, tuple(sorted(more)))

    @property
    def size(self) -> int:
        """How many elements and flows it is about."""
        return len(self.elements) + len(self.flows) + len(self.added_flows)


NOTHING_OPENED = Opened()


class Backward(NamedTuple):
    """What leads to the places that count.

    Attributes
    ----------
    entering
        Vertex -> bits that get to one if they arrive there; of a channel, if it takes them up.
    leaving
        Vertex -> bits that get to one if they leave there along all of its flows.
    """

    entering: Mapping[int, int]
    leaving: Mapping[int, int]


def backward(spread: Spread, places: Mapping[int, int], opened: Opened = NOTHING_OPENED) -> Backward:
    """Return from where data would get to some places.

    Parameters
    ----------
    places
        Vertex -> bits that count there: when they arrive, are made there, or are carried by a channel.

    Notes
    -----
    O(levels · vertices + flows visited), like the fixpoint itself.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, FACE_ID, FACES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> entering = backward(carried, {ARCHIVE: carried.forms_of("FaceTemplate")}).entering
    >>> carried.names(entering[FACE_ID]), carried.names(entering[FACES])
    (('FaceTemplate', 'Video'), ('FaceTemplate',))
    """
    graph, count = spread.graph, len(spread.graph.elements)
    keeps = {v: bits | opened.elements.get(v, 0) for v, bits in spread.keeps.items()}
    restricted = sorted(spread.flow_keeps)
    sources, targets, meetings = spread.shape.memoised("ends", restricted, lambda: ends(graph, restricted))
    sources = [*sources, *(source for source, _ in opened.added_flows)]
    targets = [*targets, *(target for _, target in opened.added_flows)]
    passing = {n: spread.flow_keeps[i] | opened.flows.get(i, 0) for n, i in enumerate(restricted, count)}
    turned = LabelledGraph(
        count,
        nodes_of(spread),
        targets,
        sources,
        tuple(restricted),
        spread.all_bits,
        {v: back_from(spread, v, bits, opened.elements.get(v, 0)) for v, bits in places.items()},
        keeps | passing,
        [(vertex, after, before) for vertex, pairs in spread.derives.items() for before, after in pairs],
        meetings,
    )
    leaving, entering = least_solution(turned)
    return Backward(entering, leaving)


class Turned(NamedTuple):
    """The flows of a spread, turned around once for many questions about a few places each.

    Attributes
    ----------
    ahead
        Vertex -> those from which data comes to it; flows that not all passes, and meetings, are vertices, too.
    derived, keep
        Vertex -> what it makes, turned around, and what passes it.
    """

    spread: Spread
    ahead: Mapping[int, list[int]]
    derived: Mapping[int, list[tuple[int, int]]]
    keep: Mapping[int, int]

    @classmethod
    def of(cls, spread: Spread) -> Turned:
        """Turn the flows of a spread around; O(flows)."""
        graph, count, restricted = spread.graph, len(spread.graph.elements), sorted(spread.flow_keeps)
        sources, targets, _ = spread.shape.memoised("ends", restricted, lambda: ends(graph, restricted))
        ahead: dict[int, list[int]] = defaultdict(list)
        for source, target in zip(sources, targets, strict=True):
            ahead[target].append(source)
        derived = {v: [(after, before) for before, after in pairs] for v, pairs in spread.derives.items()}
        return cls(
            spread, ahead, derived, spread.keeps | {n: spread.flow_keeps[i] for n, i in enumerate(restricted, count)}
        )

    def backward(self, places: Mapping[int, int], closed: Mapping[int, int] | None = None) -> Backward:
        """Return from where data would get to some places; O(flows that lead there).

        Parameters
        ----------
        closed
            Vertex -> bits that, if they arrive there, get no further and count for nothing.

        Examples
        --------
        >>> from rosprivacy.analysis.example import ARCHIVE, factory
        >>> from rosprivacy.analysis.kernel.spreading import spread
        >>> carried = spread(*factory())
        >>> places = {ARCHIVE: carried.forms_of("FaceTemplate")}
        >>> Turned.of(carried).backward(places) == backward(carried, places)
        True
        """
        spread, count = self.spread, len(self.spread.graph.elements)
        begun = {vertex: back_from(spread, vertex, bits) for vertex, bits in places.items()}
        found = propagated(self.ahead, self.derived, self.keep, begun, spread.all_bits, closed or {})
        leaving, entering = ({v: bits for v, bits in some.items() if v < count} for some in found)
        return Backward(entering, leaving)
