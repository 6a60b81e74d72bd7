"""What elements do to data: who cleans which kind and what passes beside it, who makes one kind of another (rule S8).

In: a spread. Out: ``Cleaning`` and ``Making``, in the order of the graph, for those who report.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import one_by_one
from rosprivacy.analysis.model import Method

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, FlowGraph, Place


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
    beside
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
    beside: tuple[Element, ...]
    cleaning_beside: tuple[Element, ...] = ()
    places: tuple[Place, ...] = ()


class Making(NamedTuple):
    """That an element makes one category of another; ``reached`` says whether the other gets there."""

    element: Element
    made_of: str
    made: str
    reached: bool


def cleanings(spread: Spread, wanted: Collection[str]) -> tuple[Cleaning, ...]:
    """Return what sanitizes any of the categories.

    Complexity: O(flows) once, then the channels around each sanitizer.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> (cleaning,) = cleanings(spread(*factory()), ["Video"])
    >>> cleaning.element.name, cleaning.pseudonymised, [element.name for element in cleaning.beside]
    ('/filter', ('Video',), ['/face_id'])
    """
    around = _Around(spread)
    mask = sum(spread.both(category) for category in wanted)
    rows = []
    for vertex, decided in sorted(spread.facts.items()):
        leaves = spread.planes(spread.leaves.get(vertex, 0) & mask)
        for category in (name for name in spread.categories if name in wanted and "sanitizer" in decided[name].roles):
            both = spread.both(category)
            beside, cleaning = around.beside(vertex, category, both)
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
                    beside=beside,
                    cleaning_beside=cleaning,
                    places=tuple(sorted(places, key=lambda place: (place.file, place.line))),
                )
            )
    return tuple(rows)


def makings(spread: Spread, wanted: Collection[str]) -> tuple[Making, ...]:
    """Return what makes any of the categories of another one; what is that kind already is not made.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> (making,) = makings(spread(*factory()), ["FaceTemplate"])
    >>> making.element.name, making.made_of, making.made, making.reached
    ('/face_id', 'Video', 'FaceTemplate', True)
    """
    return tuple(
        Making(spread.graph.elements[vertex], category, made, bool(spread.present(vertex) & spread.both(category)))
        for vertex, decided in sorted(spread.facts.items())
        for category in spread.categories
        for made in decided[category].derives
        if made in wanted and made != category
    )


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
        self._into: Mapping[int, list[int]] | None = None
        self._out: Mapping[int, list[int]] = {}

    def beside(self, vertex: int, category: str, bits: int) -> tuple[tuple[Element, ...], tuple[Element, ...]]:
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
        spread, graph = self._spread, self._spread.graph
        if self._into is None:
            self._into, self._out = self._flows()
        flows = self._into if back else self._out
        seen: set[int] = set()
        waiting = list(begin)
        while waiting:
            for index in flows.get(waiting.pop(), ()):
                other = graph.flows[index].source if back else graph.flows[index].target
                if other in seen or not spread.along(index) & bits or (back and not graph.elements[other].is_channel):
                    continue
                seen.add(other)
                if graph.elements[other].is_channel:
                    waiting.append(other)
        return seen

    def _flows(self) -> tuple[dict[int, list[int]], dict[int, list[int]]]:
        into, out = defaultdict(list), defaultdict(list)
        for index, flow in enumerate(one_by_one(self._spread.graph.flows)):
            into[flow.target].append(index)
            out[flow.source].append(index)
        return into, out
