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
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.roles import NOTHING_SAID
from rosprivacy.analysis.kernel.states import made
from rosprivacy.analysis.model import CANNOT

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, Place, Statement

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


State = tuple[int, int]  # vertex, bit with which data is about to leave


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
    spread = analysis.spread
    elements = spread.graph.elements
    first, last = elements[source[0]], elements[leak[0]]
    finding = next(
        (
            f for f in analysis.findings
            if (f.source.identity, f.leak.identity) == (first.identity, last.identity) and category == f.category
        ),
        None,
    )  # fmt: skip
    path, obstacles = ((), ()) if finding else _easiest(spread, source, leak, category)
    return WhyNot(
        category, first, last, finding, finding.witness if finding else path, obstacles,
        sum(bool(spread.present(v) & spread.both(category)) for v in range(len(elements))),
    )  # fmt: skip


def _easiest(
    spread: Spread, source: Sequence[int], leak: Sequence[int], category: str
) -> tuple[tuple[Element, ...], tuple[Obstacle, ...]]:
    """The path with the fewest obstacles, then the shortest; ties fall to the lower vertex (rule S14)."""
    steps = _Steps.of(spread)
    bit = spread.bits.plain(spread.categories.index(category))
    queue: list[tuple[int, int, State]] = []
    best: dict[State, tuple[int, int]] = {}
    came: dict[State, tuple[State | None, tuple[Obstacle, ...]]] = {}

    def reach(state: State, cost: tuple[int, int], before: State | None, obstacles: tuple[Obstacle, ...]) -> None:
        if state not in best or cost < best[state]:
            best[state], came[state] = cost, (before, obstacles)
            heappush(queue, (*cost, state))

    for vertex in source:
        obstacles = steps.begins(vertex, bit)
        reach((vertex, bit), (len(obstacles), 0), None, obstacles)
    ends = set(leak)
    while queue:
        closed, length, state = heappop(queue)
        if (closed, length) != best[state]:
            continue
        if state[0] in ends and (state[0] not in source or length):
            return _read_back(spread, came, state)
        for following, obstacles in steps.after(state, ends):
            reach(following, (closed + len(obstacles), length + 1), state, obstacles)
    return (), ()


def _read_back(
    spread: Spread, came: Mapping[State, tuple[State | None, tuple[Obstacle, ...]]], state: State
) -> tuple[tuple[Element, ...], tuple[Obstacle, ...]]:
    path: list[Element] = []
    obstacles: list[Obstacle] = []
    at: State | None = state
    while at is not None:
        path.append(spread.graph.elements[at[0]])
        before, here = came[at]
        obstacles = [*here, *obstacles]
        at = before
    path.reverse()
    shown = [element for i, element in enumerate(path) if not i or element.shown_as != path[i - 1].shown_as]
    return tuple(shown), tuple(obstacles)


@dataclass(frozen=True, slots=True)
class _Steps:
    """Where data could go from a state, and what stands against it.

    Attributes
    ----------
    flows
        Vertex -> (target, index of the flow or -1, lines of the DENY).
    """

    spread: Spread
    flows: Mapping[int, list[tuple[int, int, tuple[Place, ...]]]]

    @classmethod
    def of(cls, spread: Spread) -> _Steps:
        flows: dict[int, list[tuple[int, int, tuple[Place, ...]]]] = defaultdict(list)
        for index, flow in enumerate(spread.graph.flows):
            flows[flow.source].append((flow.target, index, ()))
        for flow in spread.graph.taken_back:
            flows[flow.source].append((flow.target, -1, _sorted(denial.place for denial in flow.denials)))
        return cls(spread, flows)

    def begins(self, vertex: int, bit: int) -> tuple[Obstacle, ...]:
        """What is missing for an element to be a source."""
        if self.spread.begins(vertex) >> bit & 1:
            return ()
        name = self._name(bit)
        return (Obstacle(NO_SOURCE, self.spread.graph.elements[vertex], None, name),)

    def after(self, state: State, ends: set[int]) -> Iterator[tuple[State, tuple[Obstacle, ...]]]:
        """The states that follow, with the obstacles of the step and of the element where it ends."""
        vertex, bit = state
        elements, name = self.spread.graph.elements, self._name(bit)
        for target, index, denials in self.flows.get(vertex, ()):
            along: tuple[Obstacle, ...] = ()
            if denials:
                along = (Obstacle("deny", elements[vertex], elements[target], name, denials),)
            elif not self.spread.flow_keeps.get(index, -1) >> bit & 1:
                lines = self.spread.flow_facts[index][name].closers
                along = (self._closed(lines, vertex, target, name),)
            elif self._elsewhere(vertex, bit, index):
                along = (Obstacle(THROUGH, elements[vertex], elements[target], name),)
            for onward, here in self._arriving(target, bit, end=target in ends):
                yield (target, onward), (*along, *here)

    def _name(self, bit: int) -> str:
        return self.spread.categories[self.spread.bits.category(bit)]

    def _elsewhere(self, vertex: int, bit: int, index: int) -> bool:
        """Whether a source names other channels than this one for what it emits."""
        spread = self.spread
        single = spread.flow_begins.get(vertex, 0) >> bit & 1
        arrives = spread.arrives.get(vertex, 0) | spread.emits.get(vertex, 0)
        return bool(single) and not arrives >> bit & 1 and not spread.flow_emits.get(index, 0) >> bit & 1

    def _arriving(self, vertex: int, bit: int, *, end: bool) -> Iterator[tuple[int, tuple[Obstacle, ...]]]:
        """What goes on from an element that data arrives at (or ends there): as it is, and as what is made of it."""
        spread = self.spread
        element, name = spread.graph.elements[vertex], self._name(bit)
        if end:
            leaks = spread.leaks.get(vertex, 0) >> bit & 1
            yield bit, () if leaks else (Obstacle(NO_LEAK, element, None, name),)
        elif spread.keeps.get(vertex, -1) >> bit & 1:
            yield bit, ()
        else:
            lines = spread.facts[vertex].get(name, NOTHING_SAID).closers
            yield bit, (self._closed(lines, vertex, -1, name),)
        for after in bits_of(spread.bits.planes(made(spread, vertex, 1 << bit))[0]):
            leaks = not end or spread.leaks.get(vertex, 0) >> after & 1
            yield after, () if leaks else (Obstacle(NO_LEAK, element, None, self._name(after)),)

    def _closed(self, lines: tuple[Statement, ...], vertex: int, target: int, name: str) -> Obstacle:
        elements = self.spread.graph.elements
        to = elements[target] if target >= 0 else None
        role = next((line.role for line in lines if line.role != CANNOT), CANNOT)
        return Obstacle(role, elements[vertex], to, name, _sorted(line.place for line in lines))


def _sorted(places: Iterator[Place]) -> tuple[Place, ...]:
    return tuple(sorted(set(places), key=lambda place: (place.file, place.line)))
