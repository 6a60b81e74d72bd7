"""What elements do to data: who cleans which kind and what passes beside it, who makes one kind of another (rule S8).

In: a spread. Out: ``Cleaning`` and ``Making``, in the order of the graph, for those who report.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.legal import recognises
from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import Method

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Bound, Category, Element, FlowGraph, Place


class Cleaning(NamedTuple):
    """That an element cleans a category.

    Attributes
    ----------
    method
        As in ``Method``; ``stated`` says whether a label states it.
    reached
        Whether the category gets there at all.
    leaves, pseudonymised
        What leaves the element all the same, as it is and pseudonymised: sorted names.
    neighbours
        Elements that read the same channels and do not clean it: what the sanitizer takes out, they get.
    cleaning_beside
        Elements that read the same channels and are said to clean it, too.
    places
        The lines of the labels that say so.
    """

    element: Element
    category: str
    method: str
    stated: bool
    reached: bool
    leaves: tuple[str, ...]
    pseudonymised: tuple[str, ...]
    neighbours: tuple[Element, ...]
    cleaning_beside: tuple[Element, ...] = ()
    places: tuple[Place, ...] = ()


class Making(NamedTuple):
    """That an element makes one category of another; ``reached`` says whether the other gets there."""

    element: Element
    made_of: str
    target: str
    reached: bool


def cleanings(spread: Spread, categories: Collection[str]) -> tuple[Cleaning, ...]:
    """Return what sanitizes any of the categories.

    Complexity: O(flows) once, then the channels around each sanitizer.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> (cleaning,) = cleanings(spread(*factory()), ["Video"])
    >>> cleaning.element.name, cleaning.pseudonymised, [element.name for element in cleaning.neighbours]
    ('/filter', ('Video',), ['/face_id'])
    """
    around = _Around(spread)
    mask = sum(spread.forms_of(category) for category in categories)
    rows = []
    for vertex, decided in sorted(spread.facts.items()):
        leaves = spread.planes(spread.leaves.get(vertex, 0) & mask)
        for category in (
            name for name in spread.categories if name in categories and "sanitizer" in decided[name].roles
        ):
            both = spread.forms_of(category)
            beside, cleaning = around.neighbours(vertex, category, both)
            places = {statement.place for statement in decided[category].by_role("sanitizer")}
            rows.append(
                Cleaning(
                    element=spread.graph.elements[vertex],
                    category=category,
                    method=decided[category].method,
                    stated=not decided[category].unstated,
                    reached=bool(spread.arrives.get(vertex, 0) & both),
                    leaves=leaves[0],
                    pseudonymised=leaves[1],
                    neighbours=beside,
                    cleaning_beside=cleaning,
                    places=tuple(sorted(places, key=lambda place: (place.file, place.line))),
                )
            )
    return tuple(rows)


def makings(spread: Spread, categories: Collection[str]) -> tuple[Making, ...]:
    """Return what makes any of the categories of another one; what is that kind already is not made.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> (making,) = makings(spread(*factory()), ["FaceTemplate"])
    >>> making.element.name, making.made_of, making.target, making.reached
    ('/face_id', 'Video', 'FaceTemplate', True)
    """
    return tuple(
        Making(spread.graph.elements[vertex], category, made, bool(spread.present(vertex) & spread.forms_of(category)))
        for vertex, decided in sorted(spread.facts.items())
        for category in spread.categories
        for made in decided[category].derives
        if made in categories and made != category
    )


def recognised(spread: Spread, categories: Mapping[str, Category]) -> dict[int, tuple[str, ...]]:
    """Return the elements that recognise persons or judge them (``recognises``), with the kinds that they make.

    >>> from rosprivacy.analysis.example import CATEGORIES, FACE_ID, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> recognised(spread(*factory()), CATEGORIES) == {FACE_ID: ("FaceTemplate",)}
    True
    """
    made = {v: {one for facts in said.values() for one in facts.derives} for v, said in spread.facts.items()}
    found = {v: tuple(sorted(one for one in some if recognises(categories[one]))) for v, some in made.items()}
    return {vertex: kinds for vertex, kinds in found.items() if kinds}


def absent(bound: Bound, graph: FlowGraph) -> tuple[tuple[Element, str], ...]:
    """Return the nodes of which a label says that they are not on the robot, with a person's reason.

    >>> from rosprivacy.analysis.example import FILTER, factory
    >>> from rosprivacy.analysis.model import Bound, Place, Statement
    >>> said = Statement("sanitizer", (), (1, 1), Place("labels.yaml", 4), Method.ABSENT, why="from spring on")
    >>> [(element.name, why) for element, why in absent(Bound({FILTER: (said,)}), factory()[0])]
    [('/filter', 'from spring on')]
    """
    return tuple(
        (graph.elements[vertex], statement.why)
        for vertex, said in sorted(bound.elements.items())
        for statement in said
        if statement.method is Method.ABSENT
    )


class _Around:
    """The channels that an element reads, and who else reads them."""

    def __init__(self, spread: Spread) -> None:
        self._spread = spread
        self._near: dict[bool, _Near] = {}  # by whether it is asked for what comes before

    def neighbours(self, vertex: int, category: str, bits: int) -> tuple[tuple[Element, ...], tuple[Element, ...]]:
        """Elements that get the category from a channel from which the vertex gets it: those that clean it last."""
        elements = self._spread.graph.elements
        channels = self._walk([vertex], bits, back=True)
        readers = {v for v in self._walk(sorted(channels), bits, back=False) if not elements[v].is_channel} - {vertex}
        named: tuple[dict[object, Element], dict[object, Element]] = ({}, {})
        for reader in sorted(readers):
            fact = self._spread.facts.get(reader, {}).get(category)
            cleans = fact is not None and bool(fact.method)
            named[cleans].setdefault(elements[reader].shown_as, elements[reader])
        return tuple(named[0].values()), tuple(named[1].values())

    def _walk(self, begin: Sequence[int], bits: int, *, back: bool) -> set[int]:
        """Channels before an element, or what comes after channels: only other channels lie between (rule S4)."""
        if not self._near:
            self._near = {way: _Near.of(self._spread, back=way) for way in (False, True)}
        elements, near = self._spread.graph.elements, self._near[back]
        met: dict[int, int] = defaultdict(int)  # bits of which a meeting is done
        seen: set[int] = set()
        waiting = list(begin)
        while waiting:
            for other in near.after(self._spread, waiting.pop(), bits, met):
                if other in seen or (back and not elements[other].is_channel):
                    continue
                seen.add(other)
                if elements[other].is_channel:
                    waiting.append(other)
        return seen


class _Near(NamedTuple):
    """What is one flow away, in one direction.

    Attributes
    ----------
    flows
        Vertex -> (flow, the vertex at its other end).
    meetings
        Vertex -> its meetings, with their members on the other side.
    """

    flows: Mapping[int, list[tuple[int, int]]]
    meetings: Mapping[int, list[tuple[Meeting, Sequence[int]]]]
    back: bool

    @classmethod
    def of(cls, spread: Spread, *, back: bool) -> _Near:
        flows: dict[int, list[tuple[int, int]]] = defaultdict(list)
        near: dict[int, list[tuple[Meeting, Sequence[int]]]] = defaultdict(list)
        own, meetings = parted(spread.graph.flows, spread.told_apart)
        for index, flow in own:
            here, there = (flow.target, flow.source) if back else (flow.source, flow.target)
            flows[here].append((index, there))
        for meeting in meetings:
            begin, end = (meeting.read, meeting.written) if back else (meeting.written, meeting.read)
            for vertex in begin:
                near[vertex].append((meeting, end))
        return cls(flows, near, back)

    def after(self, spread: Spread, state: int, bits: int, met: dict[int, int]) -> Iterator[int]:
        """Yield where some bits go, or come from; of a meeting only what is new."""
        yield from (there for index, there in self.flows.get(state, ()) if spread.along(index) & bits)
        for meeting, end in self.meetings.get(state, ()):
            new = bits & ~met[id(meeting)] & (spread.absorbed(state) if self.back else spread.sent.get(state, 0))
            met[id(meeting)] |= new
            for there in end if new else ():
                if new & (spread.sent.get(there, 0) if self.back else spread.absorbed(there)):
                    yield there
