"""What the elements of an analysis are joined to by data, and which of them matter, seen from one of them.

In: an ``Analysis``; the element in hand, the kinds of data that are shown. Out: neighbours, flows between elements,
shortest paths, made once for many pictures; and a ``JoinedChoice``, few enough to be read, however large the system is:
the shortest path to that element, paths to leaks, what it is joined to. Where nothing is in hand and nothing leaks, it
is where data goes first.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import islice, pairwise
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.witness import WhyCarried
from rosprivacy.analysis.kernel.vertices import by_identity
from rosprivacy.analysis.many_flows import number, parted
from rosprivacy.report.pictures.views import core

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
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
        ends = {there for vertex in self._vertices.get(key, ()) for there in self.onward(vertex, bits)}
        return self._remaining(key, ends)

    def onward(self, vertex: int, bits: int) -> Iterator[int]:
        """Return the vertices that some bits go to from one: what enters a side or a leg leaves by that one only."""
        return (there for there, along in self._from(vertex) if along & bits)

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
            if any(sent & self._spread.absorbed(there) for one in meetings for there in own.intersection(one.read)):
                found.add(source)
        return self._remaining(key, found)

    def neighbours(self, key: Key) -> list[Key]:
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
            yield from ((there, sent & spread.absorbed(there)) for there in meeting.read)

    def _remaining(self, key: Key, vertices: Iterable[int]) -> list[Key]:
        elements = self.analysis.graph.elements
        return sorted({elements[vertex].identity for vertex in vertices} - {key})


OF_PATHS = 18  # boxes that paths to leaks may take; the first one takes what it needs
OTHER_PATHS = 2  # to the element in hand, beside the shortest: of other kinds of data
LOOKED_AT, BEHIND = 200, 40  # neighbours, and what lies behind them, before channels with the same ends become one


@dataclass(frozen=True, slots=True)
class JoinedChoice:
    """What matters.

    Attributes
    ----------
    focus
        The element in hand; None for none.
    paths
        To the element in hand, the shortest first.
    findings
        Of which the shortest paths are drawn.
    undrawn
        How many findings are not drawn.
    near
        What the element is joined to, what counts more first; nothing of it is on a path.
    """

    focus: Key | None
    paths: Sequence[Witness]
    findings: Sequence[Finding]
    undrawn: int
    near: Sequence[Key]

    @property
    def core(self) -> set[Key]:
        """What is in hand or on a path: none of it is left out."""
        return _on(self.focus, self.paths) | core(self.findings)

    def steps(self) -> dict[tuple[Key, Key], int]:
        """Return the steps of the paths to the element in hand; those of the shortest are numbered, others are 0."""
        steps: dict[tuple[Key, Key], int] = {}
        for path in self.paths:
            for step, ends in enumerate(pairwise(element.identity for element in path.elements), 1):
                steps.setdefault(ends, step if path is self.paths[0] else 0)
        return steps


def choose(
    joined: Joined, focus: Key | None, categories: Sequence[str], limit: int, way: Witness | None = None
) -> JoinedChoice:
    """Return what matters, seen from an element.

    Parameters
    ----------
    categories
        Names of the emitted categories that are shown.
    limit
        Boxes.
    way
        A path to the element that is in hand itself; None for the shortest ones.
    """
    asked = [kind for one in joined.analysis.open if one.element.identity == focus for kind in one.categories]
    kinds = [kind for kind in categories if kind in asked] or categories
    paths = [way] if way else joined.paths(focus, kinds)[: 1 + OTHER_PATHS] if focus else []
    every = [
        finding for finding in joined.analysis.findings if not finding.dismissed and finding.category in categories
    ]
    every.sort(key=lambda finding: (not finding.stands, focus not in core([finding]), len(finding.steps)))
    taken = _on(focus, paths)
    findings: list[Finding] = []
    for finding in every:
        more = taken | core([finding])
        if not findings or len(more) <= min(OF_PATHS, limit):
            findings.append(finding)
            taken = more
    near = _near(joined, focus, categories) if focus else () if findings else _first(joined, categories, limit)
    others = [key for key in dict.fromkeys(near) if key not in taken]
    return JoinedChoice(focus, paths, findings, len(every) - len(findings), others[:LOOKED_AT])


def _on(focus: Key | None, paths: Iterable[Witness]) -> set[Key]:
    return {element.identity for path in paths for element in path.elements} | ({focus} if focus else set())


def _near(joined: Joined, focus: Key, categories: Iterable[str]) -> Iterator[Key]:
    """What an element sends to, what sends to it, and who has that then; where no data gets, all it is joined to."""
    bits = sum(map(joined.analysis.spread.forms_of, categories))
    after, before = joined.after(focus, bits), joined.before(focus, bits)
    if not after and not before:
        yield from joined.neighbours(focus)
    yield from after
    yield from before
    behind = (there for key in after for there in joined.after(key, bits))
    yield from islice(behind, max(0, BEHIND - len(after) - len(before)))


def _first(joined: Joined, categories: Iterable[str], limit: int) -> Collection[Key]:
    """The sources, and where their data goes first."""
    spread, elements = joined.analysis.spread, joined.analysis.graph.elements
    bits = sum(map(spread.forms_of, categories))
    found = dict.fromkeys(elements[v].identity for v in sorted(spread.facts) if spread.begins(v) & bits)
    waiting = deque(found)
    while waiting and len(found) < limit:
        new = [key for key in joined.after(waiting.popleft(), bits) if key not in found]
        found.update(dict.fromkeys(new))
        waiting.extend(new)
    return found
