"""Along which path data gets somewhere, step by step with the policy lines that allow it; and what lies on all such
ways.

In: a ``Net`` and a path as ``kernel/search.py`` reads it back; or an ``Analysis``, an element and a category, which is
what a person wants to see of an open element before judging it (rules S10, S11). Out: a ``Witness``; ``Ways`` of each
kind of data to each place where it leaves or is kept, and of the kind as a whole: whose data get there, what protects
them before (rules S8, S9). A record of processing states of a row what lies on the ways of that row, and of nothing
else.
"""

from __future__ import annotations

from collections import defaultdict
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import Step
from rosprivacy.analysis.findings.sanitizing import recognised
from rosprivacy.analysis.kernel.backward import backward
from rosprivacy.analysis.kernel.search import from_sources, path_to, present, search
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.kernel.vertices import by_shown
from rosprivacy.analysis.model import Method

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Category, Element


class Witness(NamedTuple):
    """One path that proves that data gets somewhere.

    Attributes
    ----------
    elements
        Source first; one alone where data begins at the place that is asked about.
    steps
        The flows, one fewer than the elements.
    """

    elements: tuple[Element, ...]
    steps: tuple[Step, ...]


def witness_of(net: Net, path: Iterable[tuple[int, int, int]]) -> Witness:
    """Return elements and steps of a path; the two sides of one wildcard are one element to the reader (rule S4).

    Parameters
    ----------
    path
        (flow, vertex, bit with which data is there), as ``path_to`` returns it.

    Examples
    --------
    >>> from rosprivacy.analysis.example import FACES, factory
    >>> from rosprivacy.analysis.kernel.search import from_sources, path_to
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> net, reach = from_sources(spread(*factory()))
    >>> templates = net.spread.bits.plain(net.spread.categories.index("FaceTemplate"))
    >>> witness = witness_of(net, path_to(net, reach, FACES, templates))
    >>> [(step.source.name, step.role, step.category) for step in witness.steps]
    [('/camera', 'publish', 'Video'), ('/video', 'subscribe', 'Video'), ('/face_id', 'publish', 'FaceTemplate')]
    """
    graph, categories, bits = net.spread.graph, net.spread.categories, net.spread.bits
    (_, first, _), *more = path
    elements = [graph.elements[first]]
    steps: list[Step] = []
    for index, vertex, bit in more:
        flow, element = graph.flows[index], graph.elements[vertex]
        if element.shown_as == elements[-1].shown_as:
            continue
        form = categories[bits.category(bit)], bits.is_pseudonymised(bit)
        steps.append(Step(elements[-1], element, flow.role, *form, flow.grants))
        elements.append(element)
    return Witness(tuple(elements), tuple(steps))


class WhyCarried:
    """Shortest paths from the sources to elements; one search serves all that is asked.

    Parameters
    ----------
    analysis
        Its findings may be restricted to some categories; the paths are not.

    Attributes
    ----------
    net
        The flows that data can leave along, for who walks further.

    Notes
    -----
    O(flows · levels at which bits are new to their source) once for an analysis, then O(steps) for each path. Of paths
    of one length the same one is taken as for a finding, so that the same input gives the same path (rule S14).
    """

    def __init__(self, analysis: Analysis) -> None:
        spread = analysis.spread
        self.net, self._search = from_sources(spread)
        self._vertices = by_shown(spread)

    def path(self, element: Element, category: str) -> Witness | None:
        """Return one shortest path from a source to an element, along which a category gets there.

        Parameters
        ----------
        element
            Of the graph; of a service or action one leg; of a wildcard any side stands for both.
        category
            The name of an emitted category. What is made of other data on the path is that other data before.

        Returns
        -------
        Witness or None
            None if data of just this category does not get there, in whichever form. Of data as it is and
            pseudonymised data the nearer one is shown, the former where both are as near.
        """
        spread = self.net.spread
        if category not in spread.categories:
            return None
        forms = spread.bits.forms(spread.categories.index(category))
        ways = [
            (level, bit, vertex)
            for vertex in self._vertices.get(element.shown_as, ())
            for bit in forms
            if spread.present(vertex) >> bit & 1 and (level := self._search.level(vertex, 1 << bit)) is not None
        ]
        if not ways:
            return None
        _, bit, vertex = min(ways)
        return witness_of(self.net, path_to(self.net, self._search, vertex, bit))


def why_carried(analysis: Analysis, element: Element, category: str) -> Witness | None:
    """Return why one element carries a category; for several elements ask one ``WhyCarried``.

    >>> from rosprivacy.analysis.example import DISK, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> analysis = analyse(*factory())
    >>> path = why_carried(analysis, analysis.graph.elements[DISK], "Video")
    >>> [(step.source.name, step.role, *(str(grant.place) for grant in step.grants)) for step in path.steps][:2]
    [('/camera', 'publish', 'policy.xml:2'), ('/video', 'subscribe', 'policy.xml:8')]
    >>> path.elements[-1].name, path.steps[-1].pseudonymised
    ('disk', True)
    """
    return WhyCarried(analysis).path(element, category)


Identity = tuple[str, str, str]


class MetProtection(NamedTuple):
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
        On the ways to all such places of this kind and name, told at the first; of the kind as a whole none.
    """

    element: Element | None
    category: str
    persons: tuple[str, ...]
    unnamed: bool
    protections: tuple[MetProtection, ...] = ()


def ways(analysis: Analysis, bound: Bound, categories: Mapping[str, Category]) -> tuple[Ways, ...]:
    """Return what lies on the ways of each emitted kind of data: to where its findings end and to elements outside ROS.

    Then the same of each kind as a whole. Where labels name no persons and nothing protects, there is no row.

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
    passed = tuple(_passed(spread, categories))
    if not passed and not bound.subjects:
        return ()
    persons = _Persons.of(spread, bound)
    rows = []
    for (_, _, category), places in _places(analysis).items():
        both, protections = spread.forms_of(category), _protections(spread, passed, places, category)
        for vertices in places.values():
            rows.append(Ways(spread.graph.elements[vertices[0]], category, *persons.at(vertices, both), protections))
            protections = ()
    rows += [Ways(None, category, *persons.anywhere(spread.forms_of(category))) for category in analysis.emitted]
    return tuple(row for row in rows if row.persons or row.protections)


def _places(analysis: Analysis) -> dict[tuple[str, str, str], dict[Identity, list[int]]]:
    """(Kind and name of an element, kind of data) -> the elements of that name that such data get to and leave at."""
    spread = analysis.spread
    outside = {element.identity for element in analysis.outside}
    ends = {(finding.leak.identity, finding.category) for finding in analysis.findings}
    wanted = outside | {identity for identity, _ in ends}
    found: dict[tuple[str, str, str], dict[Identity, list[int]]] = defaultdict(lambda: defaultdict(list))
    for vertex, element in enumerate(spread.graph.elements):
        for category in spread.names(spread.present(vertex)) if element.identity in wanted else ():
            if category in analysis.emitted and (element.identity in outside or (element.identity, category) in ends):
                found[element.kind, element.name, category][element.identity].append(vertex)
    return found


class _Persons(NamedTuple):
    """How far the data of each group of sources get of which the same persons are stated."""

    reached: tuple[tuple[tuple[str, ...], Search], ...]

    @classmethod
    def of(cls, spread: Spread, bound: Bound) -> _Persons:
        groups: dict[tuple[str, ...], list[int]] = defaultdict(list)
        for vertex in spread.facts if bound.subjects else ():
            if spread.begins(vertex):
                groups[bound.subjects.get(vertex, ())].append(vertex)
        net = Net.cached(spread) if groups else None
        return cls(tuple((named, search(net, some, spread.all_bits, {})) for named, some in groups.items() if net))

    def at(self, vertices: Iterable[int], bits: int) -> tuple[tuple[str, ...], bool]:
        """Return the persons whose data get to one of some vertices, and whether there are more that nobody names."""
        found = [named for named, reach in self.reached if any(present(reach, v) & bits for v in vertices)]
        return _grouped(found)

    def anywhere(self, bits: int) -> tuple[tuple[str, ...], bool]:
        """Return the same of all vertices."""
        return _grouped(named for named, reach in self.reached if _anywhere(reach) & bits)


def _grouped(name_groups: Iterable[tuple[str, ...]]) -> tuple[tuple[str, ...], bool]:
    groups = list(name_groups)
    return tuple(sorted({one for named in groups for one in named})), () in groups or not groups


def _anywhere(reach: Search) -> int:
    there = reduce(or_, (*reach.arrived_bits.values(), *reach.begun.values()), 0)
    return there | reduce(or_, (bits for vertex in reach.making for bits, _ in reach.leaving[vertex]), 0)


def _protections(
    spread: Spread, passed: Iterable[tuple[int, str]], places: Mapping[Identity, list[int]], category: str
) -> tuple[MetProtection, ...]:
    """Return the sanitizers that data of a kind pass on the ways to some places."""
    vertices = [vertex for some in places.values() for vertex in some]
    number = spread.categories.index(category)
    plain, hidden = spread.bits.forms(number)
    there = reduce(or_, map(spread.present, vertices), 0)
    if not passed or not (there >> hidden & 1 or number in spread.made_categories):
        return ()
    leading = backward(spread, dict.fromkeys(vertices, there & spread.forms_of(category))).entering
    found = []
    for vertex, cleaned in passed:
        arriving = spread.arrives.get(vertex, 0) & leading.get(vertex, 0) & spread.forms_of(cleaned)
        if arriving and vertex not in vertices:
            facts = spread.facts[vertex][cleaned]
            everywhere = facts.method != Method.PSEUDONYMISE or not there >> plain & 1
            found.append(
                MetProtection(spread.graph.elements[vertex], cleaned, facts.method, not facts.unstated, everywhere)
            )
    return tuple(found)


def _passed(spread: Spread, categories: Mapping[str, Category]) -> Iterator[tuple[int, str]]:
    """(Vertex, kind that it cleans) of the sanitizers that something of that kind leaves; none that recognises."""
    recognising = recognised(spread, categories)
    for vertex, decided in sorted(spread.facts.items()):
        for category, facts in sorted(decided.items()) if vertex not in recognising else ():
            if "sanitizer" in facts.roles and (facts.pseudonymises or facts.derives):
                yield vertex, category
