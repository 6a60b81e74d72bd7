"""What lies on the ways of a kind of data to one place: whose data get there, what protects them before (rules S8, S9).

In: an analysis and statements. Out: ``Ways`` of each kind of data to each place where it leaves or is kept, and of the
kind as a whole. A record of processing states of a row what lies on the ways of that row, and of nothing else.
"""

from __future__ import annotations

from collections import defaultdict
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.sanitizing import recognised
from rosprivacy.analysis.kernel.backward import backward
from rosprivacy.analysis.kernel.search import present, search
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.model import Method

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Category, Element

Identity = tuple[str, str, str]


class Protection(NamedTuple):
    """That an element on the way cleans data, of this kind or of one that this kind is made of.

    Attributes
    ----------
    method, stated
        As of the sanitizer.
    everywhere
        Whether the data get to the place in no other form; else some ways lead past it.
    """

    element: Element
    category: str
    method: str
    stated: bool
    everywhere: bool


class Ways(NamedTuple):
    """What lies on the ways of a kind of data to a place.

    Attributes
    ----------
    element
        The place; None for wherever the kind is.
    persons
        Groups of persons that labels name of the sources whose data get there as this kind, sorted.
    unnamed
        Whether data of a source get there of which no label names the persons.
    protections
        On the ways to all places of this kind and name; of the kind as a whole none.
    """

    element: Element | None
    category: str
    persons: tuple[str, ...]
    unnamed: bool
    protections: tuple[Protection, ...] = ()


def ways(analysis: Analysis, bound: Bound, categories: Mapping[str, Category]) -> tuple[Ways, ...]:
    """Return what lies on the ways of each emitted kind of data: to each leak and element outside ROS, then as a whole.

    Where labels name no persons and nothing protects, there is no row.

    Notes
    -----
    One search for all sources of which the same persons are stated, and a backward run for the places of one name that
    a kind gets to pseudonymised, or made of another: O(flows) each.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CATEGORIES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> (row, _) = ways(analyse(graph, bound, hierarchy), bound, CATEGORIES)  # archive and disk
    >>> row.element.name, row.category, [protection.element.name for protection in row.protections]
    ('/archive', 'Video', ['/filter'])
    """
    spread = analysis.spread
    persons = _Persons.of(spread, bound)
    places = _places(analysis)
    protections = _Protections(spread, categories, places)
    rows = []
    for vertices in places.values():
        there = reduce(or_, map(spread.present, vertices), 0)
        element = spread.graph.elements[vertices[0]]
        for category in (name for name in spread.names(there) if name in analysis.emitted):
            groups, unnamed = persons.at(vertices, spread.both(category))
            rows.append(Ways(element, category, groups, unnamed, protections.to(element, category)))
    rows += [Ways(None, category, *persons.anywhere(spread.both(category))) for category in analysis.emitted]
    return tuple(row for row in rows if row.persons or row.protections)


def _places(analysis: Analysis) -> dict[Identity, list[int]]:
    """The vertices of leaks, of where findings end, and of what lies outside ROS."""
    spread = analysis.spread
    wanted = {element.identity for element in analysis.outside}
    wanted |= {finding.leak.identity for finding in analysis.findings}
    places: dict[Identity, list[int]] = defaultdict(list)
    for vertex, element in enumerate(spread.graph.elements):
        if element.identity in wanted or spread.leaks.get(vertex):
            places[element.identity].append(vertex)
    return dict(places)


class _Persons(NamedTuple):
    """How far the data of each group of sources get of which the same persons are stated."""

    reached: tuple[tuple[tuple[str, ...], Search], ...]

    @classmethod
    def of(cls, spread: Spread, bound: Bound) -> _Persons:
        groups: dict[tuple[str, ...], list[int]] = defaultdict(list)
        for vertex in spread.facts if bound.subjects else ():
            if spread.begins(vertex):
                groups[bound.subjects.get(vertex, ())].append(vertex)
        net = Net.kept(spread) if groups else None
        return cls(tuple((named, search(net, some, spread.all_bits, {})) for named, some in groups.items() if net))

    def at(self, vertices: Iterable[int], bits: int) -> tuple[tuple[str, ...], bool]:
        """Return the persons whose data get to one of some vertices, and whether there are more that nobody names."""
        found = [named for named, reach in self.reached if any(present(reach, v) & bits for v in vertices)]
        return _named(found)

    def anywhere(self, bits: int) -> tuple[tuple[str, ...], bool]:
        """Return the same of all vertices."""
        return _named(named for named, reach in self.reached if _anywhere(reach) & bits)


def _named(found: Iterable[tuple[str, ...]]) -> tuple[tuple[str, ...], bool]:
    groups = list(found)
    return tuple(sorted({one for named in groups for one in named})), () in groups or not groups


def _anywhere(reach: Search) -> int:
    there = reduce(or_, (*reach.seen.values(), *reach.begun.values()), 0)
    return there | reduce(or_, (bits for vertex in reach.making for bits, _ in reach.left[vertex]), 0)


class _Protections:
    """The sanitizers that data pass on, looked up once for the places of one kind and name, whatever their robots."""

    def __init__(
        self, spread: Spread, categories: Mapping[str, Category], places: Mapping[Identity, Collection[int]]
    ) -> None:
        self._spread = spread
        self._passed = list(_passed(spread, categories))
        self._vertices: dict[tuple[str, str], list[int]] = defaultdict(list)
        for (_, kind, name), vertices in places.items():
            self._vertices[kind, name] += vertices
        self._known: dict[tuple[str, str, str], tuple[Protection, ...]] = {}

    def to(self, element: Element, category: str) -> tuple[Protection, ...]:
        """Return what protects a kind of data on the ways to an element and those of its name."""
        key = element.kind, element.name, category
        if key not in self._known:
            self._known[key] = tuple(self._find(self._vertices[element.kind, element.name], category))
        return self._known[key]

    def _find(self, vertices: Collection[int], category: str) -> Iterator[Protection]:
        spread = self._spread
        plain, hidden = spread.bits.forms(spread.categories.index(category))
        there = reduce(or_, map(spread.present, vertices), 0)
        if not self._passed or not (there >> hidden & 1 or spread.categories.index(category) in spread.made):
            return
        leading = backward(spread, dict.fromkeys(vertices, there & spread.both(category))).entering
        for vertex, cleaned in self._passed:
            arriving = spread.arrives.get(vertex, 0) & leading.get(vertex, 0) & spread.both(cleaned)
            if arriving and vertex not in vertices:
                facts = spread.facts[vertex][cleaned]
                everywhere = facts.method != Method.PSEUDONYMISE or not there >> plain & 1
                yield Protection(spread.graph.elements[vertex], cleaned, facts.method, not facts.unstated, everywhere)


def _passed(spread: Spread, categories: Mapping[str, Category]) -> Iterator[tuple[int, str]]:
    """(Vertex, kind that it cleans) of the sanitizers that something of that kind leaves; none that recognises."""
    recognising = recognised(spread, categories)
    for vertex, decided in sorted(spread.facts.items()):
        for category, facts in sorted(decided.items()) if vertex not in recognising else ():
            if "sanitizer" in facts.roles and (facts.pseudonymises or facts.derives):
                yield vertex, category
