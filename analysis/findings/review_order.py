"""In which order open elements are worth a person's time: where data comes from, what stands behind each (rule S11).

In: an ``Analysis``. Out: ``Behind`` facts. What only one element lets data get to is what a label there can close, by
immediate dominators of the flows that carry data. A channel past which data gets to no open element and no leak can
wait.
"""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.dominators import immediate_dominators
from rosprivacy.analysis.kernel.states import Net

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Element

START = -1  # before all sources
BOUND = 200_000  # flows with data; of more it is not worked out what stands behind an element
Shown = tuple[str, str, str, str]


class Behind(NamedTuple):
    """What a person wants to know of an open element before looking at it.

    Attributes
    ----------
    through
        The element that the data comes from: most kinds of it, and of several such the nearest to a source; None where
        it begins.
    closes, leaks
        How many other open elements, and how many leaks, data gets to past this one only, at least.
    waits
        Whether it is a channel from which data gets to no other open element but channels, to no leak, and to nothing
        else that a finding ends at.
    """

    through: Element | None = None
    closes: int = 0
    leaks: int = 0
    waits: bool = False


def review_order(analysis: Analysis) -> dict[Shown, Behind]:
    """Return what stands behind each open element, by what a reader sees of it.

    Notes
    -----
    Immediate dominators, on the flows that carry data.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> {name: (behind.closes, behind.leaks) for (_, _, name, _), behind in review_order(analyse(*factory())).items()}
    {'/video': (1, 1), '/filtered': (0, 0)}
    """
    if not analysis.open:
        return {}
    spread = analysis.spread
    elements = spread.graph.elements
    kinds = {q.categories: spread.bits.merged(sum(map(spread.forms_of, q.categories))) for q in analysis.open}
    asked = {q.element.shown_as: kinds[q.categories] for q in analysis.open}
    following = spread.course.memoised("following", None, lambda: _Following.of(Net.cached(spread)))
    reached = spread.course.memoised("reached", None, following.reached)
    shown = spread.course.memoised("shown", None, lambda: {vertex: elements[vertex].shown_as for vertex in reached})
    open_at = {vertex: one for vertex, one in shown.items() if one in asked}
    through = _through(following, {vertex: asked[one] for vertex, one in open_at.items()}, reached)
    leaks = {vertex for vertex, bits in spread.leaks.items() if bits & spread.present(vertex)}
    ends = {finding.leak for finding in analysis.findings}  # storages and third countries too (rule S10)
    wanted = leaks.union(v for v in reached if (v in open_at and not elements[v].is_channel) or elements[v] in ends)
    going_on = following.reaching(wanted)
    below = _below(following, {open_at[v]: v for v in reversed(open_at)}.values(), leaks)
    result: dict[Shown, Behind] = {}
    for vertex, as_shown in open_at.items():
        closes, leaking = below.get(vertex, (0, 0))
        comes_from = elements[through[vertex]] if vertex in through else None
        one = Behind(comes_from, closes, leaking, waits=elements[vertex].is_channel and vertex not in going_on)
        other = result.get(as_shown)  # the other side of a wildcard
        result[as_shown] = one if other is None else _merged(one, other)
    return result


def _merged(behind: Behind, other: Behind) -> Behind:
    first = max(behind, other, key=lambda side: (side.leaks, side.closes))
    return Behind(behind.through or other.through, first.closes, first.leaks, waits=behind.waits and other.waits)


class _Following(NamedTuple):
    """Where data goes on, beginning at ``START``.

    Attributes
    ----------
    along
        Vertex -> (target, what goes there and is taken up) of each flow with data.
    single
        Vertex -> where flows with data lead.
    meetings
        Of wildcards, and of nodes and channels that share rights.
    """

    spread: Spread
    along: dict[int, list[tuple[int, int]]]
    single: dict[int, list[int]]
    meetings: tuple[Meeting, ...]

    @classmethod
    def of(cls, net: Net) -> _Following:
        spread = net.spread
        sent, emits = spread.sent, spread.flow_emits
        along: dict[int, list[tuple[int, int]]] = {}
        for source, moves in net.flows.items():
            here = sent.get(source, 0)
            if ways := [(to, bits) for i, to, takes in moves if (bits := (here | emits.get(i, 0)) & takes)]:
                along[source] = ways
        single = {source: [target for target, _ in ways] for source, ways in along.items()}
        single[START] = sorted(vertex for vertex in spread.facts if spread.begins(vertex))
        return cls(spread, along, single, tuple({id(m): m for met in net.meetings.values() for m in met}.values()))

    def sent(self, source: int) -> int:
        """What is sent in a meeting."""
        return self.spread.sent.get(source, 0)

    def absorbed(self, target: int) -> int:
        """What is taken up of it."""
        return self.spread.absorbed(target)

    def number(self) -> int:
        """How many flows have data, with the steps to where it begins."""
        number = sum(map(len, self.single.values()))
        for meeting in self.meetings:
            sent, taken = Counter(map(self.sent, meeting.written)), Counter(map(self.absorbed, meeting.read))
            number += sum(n * m for bits, n in sent.items() for others, m in taken.items() if bits & others)
        return number

    def with_hubs(self) -> dict[int, list[int]]:
        """Return all flows; what of a meeting is sent alike goes through one vertex more: dominators stay."""
        if not self.meetings:
            return self.single
        flows: dict[int, list[int]] = {vertex: list(targets) for vertex, targets in self.single.items()}
        hub = len(self.spread.graph.elements)
        for meeting in self.meetings:
            for bits in {self.sent(source) for source in meeting.written} - {0}:
                flows[hub] = [target for target in meeting.read if bits & self.absorbed(target)]
                for source in meeting.written:
                    if self.sent(source) == bits:
                        flows.setdefault(source, []).append(hub)
                hub += 1
        return flows

    def dominators(self) -> dict[int, int]:
        """Return the last vertex that all data to each vertex goes through; nothing of too many flows."""
        return immediate_dominators(self.with_hubs(), START) if 0 < self.number() <= BOUND else {}

    def reached(self) -> list[int]:
        """Every vertex that data gets to, the nearest to a source first."""
        written = _by_member((meeting.written, meeting) for meeting in self.meetings)
        met: dict[int, int] = defaultdict(int)  # bits that have come to all that a meeting reads
        reached = dict.fromkeys(sorted(self.single[START]))
        waiting = deque(reached)
        while waiting:
            here = waiting.popleft()
            nexts = list(self.single.get(here, ()))
            for meeting in written.get(here, ()):
                new = self.sent(here) & ~met[id(meeting)]
                met[id(meeting)] |= new
                nexts += (there for there in meeting.read if new & self.absorbed(there)) if new else ()
            found = {there for there in nexts if there not in reached}
            for there in sorted(found):
                reached[there] = None
                waiting.append(there)
        return list(reached)

    def entering(self) -> dict[int, list[int]]:
        """Vertex -> where flows with data to it begin."""
        entering: dict[int, list[int]] = defaultdict(list)
        for here, targets in self.single.items():
            for there in targets:
                entering[there].append(here)
        return entering

    def reaching(self, targets: Iterable[int]) -> set[int]:
        """The vertices from which data gets to one of some."""
        entering = self.spread.course.memoised("entering", None, self.entering)
        read = _by_member((meeting.read, meeting) for meeting in self.meetings)
        met: dict[int, int] = defaultdict(int)  # bits of which all that write them to a meeting are found
        seen = set(targets)
        waiting = deque(seen)
        while waiting:
            there = waiting.popleft()
            nexts = list(entering.get(there, ()))
            for meeting in read.get(there, ()):
                new = self.absorbed(there) & ~met[id(meeting)]
                met[id(meeting)] |= new
                nexts += (here for here in meeting.written if new & self.sent(here)) if new else ()
            for here in nexts:
                if here not in seen:
                    seen.add(here)
                    waiting.append(here)
        return seen


def _by_member(rows: Iterable[tuple[Iterable[int], Meeting]]) -> dict[int, list[Meeting]]:
    meetings: dict[int, list[Meeting]] = defaultdict(list)
    for members, meeting in rows:
        for member in members:
            meetings[member].append(meeting)
    return meetings


def _through(following: _Following, open_at: Mapping[int, int], reached: Iterable[int]) -> dict[int, int]:
    """Open vertex -> the vertex from which most of the kinds that are open there come along a flow."""
    known: dict[tuple[int, int], int | None] = following.spread.course.memoised("through", None, dict)
    if left := {vertex: bits for vertex, bits in open_at.items() if (vertex, bits) not in known}:
        found = _found_through(following, left, reached)
        known.update(((vertex, bits), found.get(vertex)) for vertex, bits in left.items())
    through = ((vertex, known[vertex, bits]) for vertex, bits in open_at.items())
    return {vertex: source for vertex, source in through if source is not None}


def _found_through(following: _Following, open_at: Mapping[int, int], reached: Iterable[int]) -> dict[int, int]:
    spread = following.spread
    order = {vertex: place for place, vertex in enumerate(reached)}
    best: dict[int, tuple[int, int, int]] = {}
    merged = cache(spread.bits.merged)

    def comes(source: int, target: int, bits: int) -> None:
        if own := merged(bits) & open_at[target]:
            one = (-own.bit_count(), order[source], source)
            if target not in best or one < best[target]:
                best[target] = one

    for source, ways in following.along.items():
        for target, bits in ways:
            if target in open_at:
                comes(source, target, bits)
    for meeting in following.meetings:
        first: dict[int, int] = {}  # what is sent -> the first that sends it
        for source in sorted(set(meeting.written) & order.keys(), key=lambda one: -order[one]):
            first[following.sent(source)] = source
        for target in open_at.keys() & meeting.read:
            for bits, source in first.items():
                comes(source, target, bits & following.absorbed(target))
    return {vertex: source for vertex, (_, _, source) in best.items()}


def _below(following: _Following, questions: Iterable[int], leaks: Iterable[int]) -> Mapping[int, tuple[int, int]]:
    """Vertex -> how many of the questions, and of the leaks, data gets to past it only; without itself."""
    parents = following.spread.course.memoised("dominators", None, following.dominators)
    asked, leaking = set(questions), set(leaks)
    below: dict[int, tuple[int, int]] = defaultdict(lambda: (0, 0))
    for vertex in asked | leaking:
        above = parents.get(vertex, START)
        while above != START:
            closes, ends = below[above]
            below[above] = (closes + (vertex in asked), ends + (vertex in leaking))
            above = parents[above]
    return below
