"""The paths to leaks: along which flows data can come from a source to a leak of a category (rule S10).

In: a spread, or the analysis that has it. Out: flows. A finding shows one shortest path; a picture has to show where
the data can go at all. What is asked of a flow is whether it lies on a walk from a source to a leak, over states
(vertex, bit) as in ``further_paths.py``. Flows on detours that must come back to where they began are left out: no
path without a circle uses them.

Source: the paper, section II-B, which colours the edges of vulnerable paths. To say of a flow exactly whether a path
without circles uses it is NP-hard on directed graphs; dominators say no only where that is certain.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.dominators import immediate_dominators
from rosprivacy.analysis.kernel.states import Net, States, derived_bits
from rosprivacy.analysis.model import DISCLOSURE

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.model import Element

State = tuple[int, int, int]  # what (below), vertex or flow, bit
ARRIVED, STARTED, SENT = 0, 1, 2  # data arrives at a vertex; starts there; starts there along one flow only
BEGIN, END = (-1, 0, 0), (-2, 0, 0)
NO_FLOW = -1
Edge = tuple[State, State, int]  # before, after, flow or ``NO_FLOW``


@dataclass(frozen=True, slots=True)
class FlowsToLeaks:
    """The flows on paths to leaks.

    Attributes
    ----------
    flows
        Flow -> number of flows of the shortest path through it; sorted.
    complete
        Whether these are all; if not, there are longer paths.
    """

    flows: dict[int, int]
    complete: bool = True


@dataclass(frozen=True)
class PathsToLeaks:
    """The paths to leaks of an answer, as pictures show them; each is searched when it is asked for."""

    analysis: Analysis

    @cached_property
    def _net(self) -> Net:
        return Net.cached(self.analysis.spread)

    @cached_property
    def _vertices(self) -> dict[Element, int]:
        return {element: vertex for vertex, element in enumerate(self.analysis.graph.elements)}

    def of(self, finding: Finding, about: int | None = None) -> FlowsToLeaks:
        """Return the flows on paths from the source of a finding to its leak; of a dismissed one through other leaks.

        Parameters
        ----------
        about
            As of ``flows_to_leaks``.
        """
        if not finding.steps:
            return FlowsToLeaks({})
        source, leak = self._vertices[finding.source], self._vertices[finding.leak]
        ends = None if finding.kind == DISCLOSURE else {leak: self.analysis.spread.forms_of(finding.category)}
        past = finding.dismissed or ends is not None
        return flows_to_leaks(
            self._net, finding.category, sources=[source], leaks=[leak], past_leaks=past, ends=ends, about=about
        )

    @cached_property
    def shortest(self) -> dict[int, int]:
        """Flow -> number of flows of the shortest path through it, to any leak of a category that has findings.

        With the paths to where data are kept too long or leave the EEA (rule S10). Dismissed findings do not count.
        """
        findings = [finding for finding in self.analysis.findings if not finding.dismissed]
        ends: dict[str, dict[int, int]] = defaultdict(dict)
        for finding in findings:
            if finding.kind != DISCLOSURE:
                both = self.analysis.spread.forms_of(finding.category)
                ends[finding.category][self._vertices[finding.leak]] = both
        disclosed = sorted({finding.category for finding in findings if finding.kind == DISCLOSURE})
        found = [flows_to_leaks(self._net, category) for category in disclosed]
        found += [
            flows_to_leaks(self._net, category, leaks=where, past_leaks=True, ends=where)
            for category, where in sorted(ends.items())
        ]
        lengths: dict[int, int] = {}
        for each in found:
            for flow, length in each.flows.items():
                lengths[flow] = min(length, lengths.get(flow, length))
        return lengths


def flows_to_leaks(
    net: Net,
    category: str,
    *,
    sources: Collection[int] | None = None,
    leaks: Collection[int] | None = None,
    past_leaks: bool = False,
    ends: Mapping[int, int] | None = None,
    about: int | None = None,
) -> FlowsToLeaks:
    """Return the flows that lie on a path of data from a source to a leak of a category.

    Parameters
    ----------
    net
        Of a spread.
    category
        An emitted one: what arrives at the leaks. It may be made of others on the path.
    sources, leaks
        Vertices to begin and to end at; None for all.
    past_leaks
        Whether paths through other leaks of the category count, as for a dismissed finding.
    ends
        Vertex -> bits that end there; the leaks by default. Findings of other kinds end elsewhere, as at a storage.
    about
        Take only the shorter paths, those up to a length, so that about so many flows are on them; None for all.

    Returns
    -------
    FlowsToLeaks
        They hold every flow of every path (up to the length) that meets no state twice.

    Notes
    -----
    Rounds of O(flows), for a fixed number of categories, with immediate dominators on the part between; two rounds as a
    rule, never more than there are flows.

    Examples
    --------
    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> flows = [net.spread.graph.flows[index] for index in flows_to_leaks(net, "FaceTemplate").flows]
    >>> [(NAMES[flow.source], NAMES[flow.target]) for flow in flows]
    [('/camera', '/video'), ('/face_id', '/faces'), ('/faces', '/archive'), ('/video', '/face_id')]
    """
    walk = _LeakWalk(net, category, ends, past_leaks=past_leaks)
    starts = [v for v in net.spread.facts if net.spread.begins(v)] if sources is None else sources
    edges, before, complete, longest = walk.edges(starts, leaks), -1, True, 0
    while len(edges) != before:  # what only a detour leads to is gone in the next round
        first, before = before < 0, len(edges)
        ahead, back = _distances(edges, BEGIN, forth=True), _distances(edges, END, forth=False)
        edges = [edge for edge in edges if edge[0] in ahead and edge[1] in back]
        if about is not None:  # the length of the first round: later ones know which paths were detours, so longer
            longest = _longest(_lengths(edges, ahead, back), about) if first else longest
            short = [e for e in edges if ahead[e[0]] + (e[2] != NO_FLOW) + back[e[1]] <= longest]
            edges, complete = short, complete and len(short) == len(edges)
        edges = _without_detours(edges)
    return FlowsToLeaks(dict(sorted(_lengths(edges, ahead, back).items())), complete)


def _lengths(edges: list[Edge], ahead: Mapping[State, int], back: Mapping[State, int]) -> dict[int, int]:
    """Flow -> number of flows of the shortest path through it."""
    lengths: dict[int, int] = {}
    for here, there, flow in edges:
        if flow != NO_FLOW:
            length = ahead[here] + 1 + back[there]
            lengths[flow] = min(length, lengths.get(flow, length))
    return lengths


def _longest(lengths: Mapping[int, int], about: int) -> int:
    """The length up to which there are no more flows than asked for; the shortest paths are always in."""
    every = sorted(lengths.values())
    if len(every) <= about:
        return every[-1] if every else 0
    shorter = [length for length in every if length < every[about]]
    return shorter[-1] if shorter else every[0]


class _LeakWalk:
    """How data of a category, or of what it is made of, goes from state to state."""

    def __init__(self, net: Net, category: str, ends: Mapping[int, int] | None, *, past_leaks: bool) -> None:
        self._spread = spread = net.spread
        self._ends = spread.leaks if ends is None else ends
        number, self._two_bits = spread.categories.index(category), spread.forms_of(category)
        relevant = spread.all_bits if number in spread.made_categories else self._two_bits
        stop = (
            {}
            if past_leaks
            else {v: bits & self._two_bits for v, bits in spread.leaks.items() if bits & self._two_bits}
        )
        self._states = States(net, relevant, stop)
        self._starts: set[State] = set()

    def edges(self, starts: Collection[int], leaks: Collection[int] | None) -> list[Edge]:
        """Return what can be reached from some vertices, to END where it comes to a leak."""
        edges: list[Edge] = list(self._begin(starts, leaks))
        waiting = deque(dict.fromkeys(after for _, after, _ in edges))
        seen = set(waiting)
        while waiting:
            state = waiting.popleft()
            if state[0] == ARRIVED and (leaks is None or state[1] in leaks) and self._leaks(*state[1:]):
                edges.append((state, END, NO_FLOW))
            for flow, after in self._onward(state):
                edges.append((state, after, flow))
                if after not in seen:
                    seen.add(after)
                    waiting.append(after)
        return edges

    def _begin(self, starts: Collection[int], leaks: Collection[int] | None) -> Iterator[Edge]:
        """Where what comes back goes on again, or ends, it is one state with what starts: circles are seen as such."""
        states = self._states
        for vertex in sorted(starts):
            # A source keeps what it emits: one that cleans it is refused.
            alike = self._spread.all_bits if leaks is None or vertex in leaks else ~states.stop.get(vertex, 0)
            for bit in bits_of(states.emitted(vertex)):
                state = (ARRIVED if alike >> bit & 1 else STARTED, vertex, bit)
                self._starts.add(state)
                yield BEGIN, state, NO_FLOW
            for flow, _, bits in states.single(vertex):
                yield from ((BEGIN, (SENT, flow, bit), NO_FLOW) for bit in bits_of(bits))

    def _onward(self, state: State) -> Iterator[tuple[int, State]]:
        what, where, bit = state
        if what == SENT:
            yield where, (ARRIVED, self._spread.graph.flows[where].target, bit)
            return
        leaving = self._states.leaving(where, 1 << bit) if what == ARRIVED else 0
        leaving |= 1 << bit if state in self._starts else 0
        for flow, target, bits in self._states.after(where, leaving):
            yield from ((flow, (ARRIVED, target, moved)) for moved in bits_of(bits))

    def _leaks(self, vertex: int, bit: int) -> bool:
        here = self._ends.get(vertex, 0) & self._two_bits
        return bool(here and here & (1 << bit | derived_bits(self._spread, vertex, 1 << bit)))


def _distances(edges: list[Edge], start: State, *, forth: bool) -> dict[State, int]:
    """Flows from BEGIN to a state, or from a state to END."""
    following: dict[State, list[tuple[State, int]]] = defaultdict(list)
    for before, after, flow in edges:
        here, there = (before, after) if forth else (after, before)
        following[here].append((there, int(flow != NO_FLOW)))
    distances = {start: 0}
    waiting = deque([start])
    while waiting:
        here = waiting.popleft()
        for there, step in following[here]:
            if there not in distances:  # the steps of length 0 are the first and the last only: levels stay in order
                distances[there] = distances[here] + step
                waiting.append(there)
    return distances


def _without_detours(edges: list[Edge]) -> list[Edge]:
    """Drop the edges from u to v where all that comes to u came through v, or all that leaves v comes back to u."""
    following: dict[State, list[State]] = defaultdict(list)
    followed: dict[State, list[State]] = defaultdict(list)
    for before, after, _ in edges:
        following[before].append(after)
        followed[after].append(before)
    dominates = _above(immediate_dominators(following, BEGIN), BEGIN)
    all_come_back = _above(immediate_dominators(followed, END), END)
    return [
        (before, after, flow)
        for before, after, flow in edges
        if not dominates(after, before) and not all_come_back(before, after)
    ]


def _above(parents: Mapping[State, State], root: State) -> Callable[[State, State], bool]:
    """Return the test whether one state is another or above it in a tree."""
    children: dict[State, list[State]] = defaultdict(list)
    for state, parent in parents.items():
        children[parent].append(state)
    entered: dict[State, int] = {}
    left: dict[State, int] = {}
    waiting = [(root, False)]
    while waiting:
        state, done = waiting.pop()
        if done:
            left[state] = len(entered)
            continue
        entered[state] = len(entered)
        waiting.append((state, True))
        waiting.extend((child, False) for child in children[state])
    return lambda upper, lower: entered[upper] <= entered[lower] < left[upper]
