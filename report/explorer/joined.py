"""What the elements of an analysis are joined to by data, and why data gets to each; made once for many pictures.

In: an ``Analysis``. Out: neighbours of an element, flows between elements, shortest paths to them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.witness import WhyCarried
from rosprivacy.analysis.kernel.vertices import by_identity
from rosprivacy.analysis.many_flows import number, parted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.witness import Witness
    from rosprivacy.analysis.model import Flow
    from rosprivacy.report.pictures.picture import Key


class Joined:
    """The elements of an analysis by name, and what goes between them.

    Parameters
    ----------
    why
        Of the analysis, by who has it already.

    Notes
    -----
    O(flows) once; a neighbourhood then costs its own flows.
    """

    def __init__(self, analysis: Analysis, why: WhyCarried | None = None) -> None:
        self.analysis, self.why = analysis, why or WhyCarried(analysis)
        self._spread, self._net = analysis.spread, self.why.net
        self._vertices = by_identity(analysis.spread)

    def __contains__(self, key: Key) -> bool:
        """Whether there is such an element."""
        return key in self._vertices

    def vertices(self, key: Key) -> Sequence[int]:
        """Return the vertices of an element: its legs, its sides."""
        return self._vertices.get(key, ())

    def unjudged(self, bits: int) -> set[Key]:
        """Return the elements that nobody has judged for some kind of some bits."""
        kinds = set(self._spread.names(bits))
        return {one.element.identity for one in self.analysis.open if not kinds.isdisjoint(one.categories)}

    def elements(self) -> tuple[set[Key], set[Key]]:
        """Return every element: those that count, and standard channels of ROS (rule S13)."""
        elements = self.analysis.graph.elements
        standard = {elements[vertex].identity for vertex in self._spread.standard}
        return set(self._vertices) - standard, standard

    def paths(self, key: Key, kinds: Iterable[str]) -> list[Witness]:
        """Return the shortest path of each kind that gets to an element, the shortest first, each path once."""
        elements = {self.analysis.graph.elements[vertex].shown_as: vertex for vertex in self._vertices.get(key, ())}
        every = [
            path
            for kind in kinds
            for vertex in elements.values()
            if (path := self.why.path(self.analysis.graph.elements[vertex], kind))
        ]
        once = {path.elements: path for path in reversed(every)}
        return sorted(once.values(), key=lambda path: (len(path.elements), every.index(path)))

    def after(self, key: Key, bits: int) -> list[Key]:
        """Return the elements that some bits go to from one, sorted."""
        ends = {there for vertex in self._vertices.get(key, ()) for there, along in self._from(vertex) if along & bits}
        return self._others(key, ends)

    def before(self, key: Key, bits: int) -> list[Key]:
        """Return the elements that some bits come from to one, sorted; O(flows)."""
        own, found = set(self._vertices.get(key, ())), set()
        for source, moves in self._net.flows.items():
            if any(target in own for _, target, _ in moves) and any(
                there in own and along & bits for there, along in self._from(source)
            ):
                found.add(source)
        for source, meetings in self._net.meetings.items():
            sent = self._spread.sent.get(source, 0) & bits
            if any(sent & self._spread.taken(there) for one in meetings for there in own.intersection(one.read)):
                found.add(source)
        return self._others(key, found)

    def beside(self, key: Key) -> list[Key]:
        """Return the elements that policies join one to, whether data goes there or not, sorted; O(flows)."""
        elements = self.analysis.graph.elements
        ends = {end for flow in self.granted(key) for end in (flow.source, flow.target)}
        return sorted({elements[vertex].identity for vertex in ends - self._spread.standard} - {key})

    def granted(self, key: Key) -> Iterable[Flow]:
        """Return the flows of an element, whether data goes along them or not; O(flows)."""
        own, flows = set(self._vertices.get(key, ())), self.analysis.graph.flows
        stored, meetings = parted(flows)
        yield from (flow for _, flow in stored if {flow.source, flow.target} & own)
        for meeting in meetings:
            ends = ((a, b) for a, b in meeting.pairs() if {a, b} & own)
            yield from (meeting.flow(*pair) for pair in ends)

    def flows(self, keys: Collection[Key]) -> list[int]:
        """Return the flows between some elements along which anything is sent, by number."""
        inside = {vertex for key in keys for vertex in self._vertices.get(key, ())}
        found = []
        for vertex in sorted(inside):
            found += [index for index, target, _ in self._net.flows.get(vertex, ()) if target in inside]
            for meeting in self._net.meetings.get(vertex, ()):
                flows = self.analysis.graph.flows
                found += [number(flows, vertex, target) for target in meeting.read if target in inside]
        return found

    def _from(self, vertex: int) -> Iterator[tuple[int, int]]:
        """Where data goes from a vertex, and which bits."""
        spread, net = self._spread, self._net
        sent = spread.sent.get(vertex, 0)
        for index, target, passing in net.flows.get(vertex, ()):
            yield target, (sent | spread.flow_emits.get(index, 0)) & passing
        for meeting in net.meetings.get(vertex, ()):
            yield from ((there, sent & spread.taken(there)) for there in meeting.read)

    def _others(self, key: Key, vertices: Iterable[int]) -> list[Key]:
        elements = self.analysis.graph.elements
        return sorted({elements[vertex].identity for vertex in vertices} - {key})
