"""Why data of one element does not get to another: the path with the fewest words in its way, and whose they are.

In: an ``Analysis`` and two elements. Out: ``WhyNot`` per category. Each step that a policy denies, that a label closes,
or that only a label's silence keeps from being a finding is an obstacle on the path; of all paths the one with the
fewest obstacles is shown, then the shortest.

Source: rules S5, S7, S8 and S11; the question is the other half of a finding (S10).
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.roles import NOTHING_SAID
from rosprivacy.analysis.kernel.states import derived_bits
from rosprivacy.analysis.model import CANNOT

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, Place, Statement

    State = tuple[int, int]  # vertex, bit with which data is about to leave

NO_SOURCE, NO_LEAK, THROUGH = "no-source", "no-leak", "other-channels"


@dataclass(frozen=True, slots=True)
class Obstacle:
    """What stands in the way at one element or along one flow.

    Attributes
    ----------
    by
        Role of a statement, ``deny``, or: nobody calls the start a source (``NO_SOURCE``), nobody calls the end a leak
        (``NO_LEAK``), the source names other channels (``THROUGH``).
    element, to
        Where; of a flow its two ends.
    category
        What the data is there.
    places
        The lines that say so, sorted; empty where nobody says anything.
    """

    by: str
    element: Element
    to: Element | None
    category: str
    places: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class WhyNot:
    """What is between two elements for one category.

    Attributes
    ----------
    category
        What the source emits, or is asked about.
    finding
        The finding, if the data does get there.
    path
        Elements, source first; empty if no chain of policy lines leads there at all.
    obstacles
        On the path, in its order.
    reached
        How many elements the data gets to as things are.
    """

    category: str
    source: Element
    leak: Element
    finding: Finding | None
    path: tuple[Element, ...]
    obstacles: tuple[Obstacle, ...]
    reached: int


def why_not(analysis: Analysis, source: Sequence[int], leak: Sequence[int], category: str) -> WhyNot:
    """Return what is between two elements for one category.

    Parameters
    ----------
    source, leak
        Vertices of each (several for the legs of a channel).
    category
        One of ``analysis.spread.categories``.

    Notes
    -----
    O(flows · categories · log), a shortest path by (obstacles, steps).

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, FACE_ID, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> answer = why_not(analyse(*factory()), [FACE_ID], [ARCHIVE], "Video")
    >>> [(obstacle.by, obstacle.element.name, *map(str, obstacle.places)) for obstacle in answer.obstacles]
    [('no-source', '/face_id'), ('only', '/faces', 'labels.yaml:5')]
    """
    spread, elements = analysis.spread, analysis.spread.graph.elements
    first, last = elements[source[0]], elements[leak[0]]
    ends = first.identity, last.identity, category
    between = (f for f in analysis.findings if (f.source.identity, f.leak.identity, f.category) == ends)
    finding = next(between, None)
    path, obstacles = (finding.witness, ()) if finding else _easiest(spread, source, leak, category)
    reached = sum(bool(spread.present(v) & spread.forms_of(category)) for v in range(len(elements)))
    return WhyNot(category, first, last, finding, path, obstacles, reached)


def _easiest(
    spread: Spread, source: Sequence[int], leak: Sequence[int], category: str
) -> tuple[tuple[Element, ...], tuple[Obstacle, ...]]:
    """The path with the fewest obstacles, then the shortest; ties fall to the lower vertex (rule S14)."""
    steps = _Steps(spread, _flows(spread), frozenset(leak))
    bit = spread.bits.plain(spread.categories.index(category))
    queue: list[tuple[int, int, State]] = []
    best: dict[State, tuple[int, int]] = {}
    came: dict[State, tuple[State | None, tuple[Obstacle, ...]]] = {}

    def reach(state: State, cost: tuple[int, int], before: State | None, obstacles: tuple[Obstacle, ...]) -> None:
        if state not in best or cost < best[state]:
            best[state], came[state] = cost, (before, obstacles)
            heappush(queue, (*cost, state))

    for vertex in source:
        missing = () if spread.begins(vertex) >> bit & 1 else (steps.obstacle(NO_SOURCE, bit, vertex),)
        reach((vertex, bit), (len(missing), 0), None, missing)
    while queue:
        closed, length, state = heappop(queue)
        if (closed, length) != best[state]:
            continue
        if state[0] in steps.ends and (state[0] not in source or length):
            return _read_back(spread, came, state)
        for following, obstacles in steps.after(*state):
            reach(following, (closed + len(obstacles), length + 1), state, obstacles)
    return (), ()


def _read_back(
    spread: Spread, came: Mapping[State, tuple[State | None, tuple[Obstacle, ...]]], state: State
) -> tuple[tuple[Element, ...], tuple[Obstacle, ...]]:
    path: list[Element] = []
    obstacles: tuple[Obstacle, ...] = ()
    at: State | None = state
    while at is not None:
        element = spread.graph.elements[at[0]]
        at, here = came[at]
        obstacles = (*here, *obstacles)
        if path and element.shown_as == path[-1].shown_as:  # the sides of a wildcard are one: the first is shown
            path.pop()
        path.append(element)
    return tuple(reversed(path)), obstacles


def _flows(spread: Spread) -> dict[int, list[tuple[int, int, tuple[Place, ...]]]]:
    """Vertex -> (target, index of the flow or -1, lines of the DENY that takes it back)."""
    flows: dict[int, list[tuple[int, int, tuple[Place, ...]]]] = defaultdict(list)
    for index, flow in enumerate(spread.graph.flows):
        flows[flow.source].append((flow.target, index, ()))
    for flow in spread.graph.taken_back:
        flows[flow.source].append((flow.target, -1, tuple(denial.place for denial in flow.denials)))
    return flows


class _Steps(NamedTuple):
    """Where data could go from a state, and what stands against it; ``ends`` are vertices that are asked about."""

    spread: Spread
    flows: Mapping[int, Sequence[tuple[int, int, tuple[Place, ...]]]]
    ends: Collection[int]

    def after(self, vertex: int, bit: int) -> Iterator[tuple[State, tuple[Obstacle, ...]]]:
        """The states that follow, with the obstacles of the step and of the element where it ends."""
        spread = self.spread
        for target, index, denials in self.flows.get(vertex, ()):
            along: tuple[Obstacle, ...] = ()
            if denials:
                along = (self.obstacle("deny", bit, vertex, target, denials),)
            elif not spread.flow_keeps.get(index, -1) >> bit & 1:
                closers = spread.flow_facts[index][self._name(bit)].closers
                along = (self._closed(closers, bit, vertex, target),)
            elif self._elsewhere(vertex, bit, index):
                along = (self.obstacle(THROUGH, bit, vertex, target),)
            for onward, here in self._arriving(target, bit):
                yield (target, onward), (*along, *here)

    def _elsewhere(self, vertex: int, bit: int, index: int) -> bool:
        """Whether a source names other channels than this one for what it emits."""
        spread = self.spread
        single = spread.flow_begins.get(vertex, 0) >> bit & 1
        arrives = spread.arrives.get(vertex, 0) | spread.emits.get(vertex, 0)
        return bool(single) and not arrives >> bit & 1 and not spread.flow_emits.get(index, 0) >> bit & 1

    def _arriving(self, vertex: int, bit: int) -> Iterator[tuple[int, tuple[Obstacle, ...]]]:
        """What goes on from an element that data arrives at (or ends there): as it is, and as what is made of it."""
        spread = self.spread
        if vertex in self.ends:
            yield bit, self._no_leak(vertex, bit)
        elif spread.keeps.get(vertex, -1) >> bit & 1:
            yield bit, ()
        else:
            closers = spread.facts[vertex].get(self._name(bit), NOTHING_SAID).closers
            yield bit, (self._closed(closers, bit, vertex),)
        for after in bits_of(spread.bits.planes(derived_bits(spread, vertex, 1 << bit))[0]):
            yield after, self._no_leak(vertex, after) if vertex in self.ends else ()

    def _no_leak(self, vertex: int, bit: int) -> tuple[Obstacle, ...]:
        return () if self.spread.leaks.get(vertex, 0) >> bit & 1 else (self.obstacle(NO_LEAK, bit, vertex),)

    def _closed(self, lines: tuple[Statement, ...], bit: int, vertex: int, target: int = -1) -> Obstacle:
        role = next((line.role for line in lines if line.role != CANNOT), CANNOT)
        return self.obstacle(role, bit, vertex, target, (line.place for line in lines))

    def obstacle(self, by: str, bit: int, vertex: int, target: int = -1, places: Iterable[Place] = ()) -> Obstacle:
        """Return what is in the way of a bit at an element, or along a flow where a target is named."""
        elements = self.spread.graph.elements
        to = elements[target] if target >= 0 else None
        return Obstacle(by, elements[vertex], to, self._name(bit), tuple(sorted(set(places))))

    def _name(self, bit: int) -> str:
        return self.spread.categories[self.spread.bits.category(bit)]
