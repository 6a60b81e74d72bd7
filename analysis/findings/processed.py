"""What data are processed for where they begin and end, on which legal basis and by whom, as people state it.

In: an analysis and statements. Out: ``Processed`` of each source and exit; what a stated basis lacks (Article 30(1)).

What is stated of the end itself comes first, then of the node that makes the kind, then of the source that it
comes from, then of the robot of the source or the whole system. Articles 6, 9, 10 and chapter V are looked up each by
itself.
None of it changes a finding: a stated basis is no acceptance.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.search import Search, present, search
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.legal import GROUPS, gaps, group_of
from rosprivacy.analysis.model import (
    LEGAL_BASIS,
    NOWHERE,
    STATED,
    THIRD_COUNTRY,
    UNSTATED,
    Diagnostic,
    Severity,
)
from rosprivacy.analysis.non_ros import nearest, transferred

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.legal import Verdicts
    from rosprivacy.analysis.model import Bound, ByCategory, Element, Place, Processing

PURPOSE, BASIS = "purpose", "legal_basis"  # what can be missing


class Processed(NamedTuple):
    """What is stated of data of a kind at the element where they begin or end.

    Attributes
    ----------
    controllers, officers
        Of the robots that the data come from and end at.
    missing
        Of ``PURPOSE`` and ``BASIS`` what is not stated of all that gets there.
    place
        The line that states the basis.
    abroad
        Whether data there have left the EEA without a stated basis (rule S10).
    """

    element: Element
    category: str
    controllers: tuple[str, ...] = ()
    officers: tuple[str, ...] = ()
    purposes: tuple[str, ...] = ()
    bases: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    place: Place = NOWHERE
    abroad: bool = False

    def __bool__(self) -> bool:
        """Whether anything is stated."""
        return bool(self.controllers or self.officers or self.purposes or self.bases)


def processed(analysis: Analysis, bound: Bound, hierarchy: Hierarchy) -> tuple[Processed, ...]:
    """Return what is stated of each source and each exit of each kind of data; of those of which nothing is, none.

    Notes
    -----
    One search for all sources of which the same is stated, and one for each node that states why it makes a kind of
    another: O(flows) each. What reaches an end on a fleet is so told of all its robots, not of those in findings alone.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.model import Processing
    >>> graph, bound, hierarchy = factory()
    >>> bound = replace(bound, processing={CAMERA: Processing(purposes=(("", ("safety",)),))})
    >>> rows = processed(analyse(graph, bound, hierarchy), bound, hierarchy)
    >>> [(row.element.name, row.category, row.purposes) for row in rows][:2]
    [('/archive', 'FaceTemplate', ('safety',)), ('/archive', 'Video', ('safety',))]
    """
    if not bound.processing and not bound.of_robots:
        return ()
    rows = _Rows(analysis, bound, hierarchy)
    found = [rows.row(vertex, category) for vertex, category in sorted(rows.ends())]
    return tuple(row for row in found if row)


def lacks(rows: Iterable[Processed], law: Mapping[str, Verdicts]) -> tuple[Diagnostic, ...]:
    """Return what stated legal bases lack, by the checks of decisions; each once, at the line that states it.

    >>> from rosprivacy.analysis.model import Element, Place
    >>> row = Processed(Element("node", "/cam"), "Face", bases=("6(1)(f)",), place=Place("care.yaml", 3))
    >>> [str(said.place) for said in lacks([row], {"Face": (("GDPR Art. 9(1)", "always"),)})]
    ['care.yaml:3']
    """
    found: dict[Diagnostic, None] = {}
    for row in rows:
        if row.bases:
            case = (THIRD_COUNTRY if row.abroad else STATED, row.category)
            for gap in gaps(row.bases, [case], law):
                what = f"the legal basis stated here {gap}"
                found.setdefault(Diagnostic(row.place, Severity.WARNING, what, LEGAL_BASIS))
    return tuple(sorted(found, key=lambda said: (said.place.file, said.place.line, said.message)))


Way = tuple["Processing", ...]  # what is stated on the way to an end, the nearest first


class _Rows:
    """Looks up what is stated, from the end to the whole system."""

    def __init__(self, analysis: Analysis, bound: Bound, hierarchy: Hierarchy) -> None:
        self._analysis = analysis
        self._bound = bound
        self._hierarchy = hierarchy
        self._spread = analysis.spread
        self._reached = self._ways()

    def ends(self) -> Iterator[tuple[int, str]]:
        """Sources, nodes that make a kind of another, leaks and elements outside ROS, with the kinds of data there."""
        spread, elements = self._spread, self._analysis.graph.elements
        outside = set(self._analysis.outside)
        for vertex, element in enumerate(elements):
            made = sum({1 << after for before, after in spread.derives.get(vertex, ()) if self._differ(before, after)})
            bits = spread.begins(vertex) | (made | spread.leaks.get(vertex, 0)) & spread.present(vertex)
            here = spread.names(spread.present(vertex) if element in outside else bits)
            yield from ((vertex, category) for category in here if category in self._analysis.emitted)

    def row(self, vertex: int, category: str) -> Processed:
        """What is stated of a kind of data at one end."""
        element, both = self._analysis.graph.elements[vertex], self._spread.forms_of(category)
        ways = [way for reach, way in self._reached if present(reach, vertex) & both]
        ways = list(dict.fromkeys(ways)) or [(self._of_robot(vertex),)]
        own = (self._of(vertex),)
        here, *there = [self._first(way, category, "purposes") for way in (own, *ways)]
        purposes = here or [text for some in there for text in some]
        missing = [] if here or all(there) else [PURPOSE]
        bases: list[str] = []
        for group in GROUPS:
            here, *there = [self._first(way, category, "bases", group) for way in (own, *ways)]
            bases += here or [basis for some in there for basis in some]
            if group == GROUPS[0] and not here and not all(there):
                missing.append(BASIS)
        who = [self._of_robot(vertex), *(said for way in ways for said in way)]
        facts = self._analysis.outside.get(element)
        return Processed(
            element,
            category,
            _distinct(said.controller for said in who),
            _distinct(said.dpo for said in who),
            _distinct(sorted(purposes)),
            _distinct(sorted(bases)),
            tuple(missing),
            next((said.place for way in (own, *ways) for said in way if said.bases), NOWHERE),
            bool(facts and transferred(facts)),
        )

    def _ways(self) -> list[tuple[Search, Way]]:
        """How far data get of which the same is stated: from sources, and from nodes that state why they make others.

        What such a node makes is no longer followed from the source: the node's word is nearer.
        """
        spread = self._spread
        makers = {v: pairs for v, pairs in spread.derives.items() if v in self._bound.processing}
        makes = {v: [(a, b) for a, b in pairs if self._differ(a, b)] for v, pairs in makers.items()}
        kept = {v: tuple(pair for pair in pairs if pair not in makes.get(v, ())) for v, pairs in spread.derives.items()}
        plain = replace(spread, derives=kept)
        groups: dict[Way, list[int]] = defaultdict(list)
        for vertex in spread.facts:
            if spread.begins(vertex):
                groups[self._of(vertex), self._of_robot(vertex)].append(vertex)
        net = Net.of(plain)
        found = [(search(net, sources, spread.all_bits, {}), way) for way, sources in groups.items()]
        for maker, pairs in makes.items():
            made = sum(1 << after for _, after in dict(pairs).items()) & spread.present(maker)
            if made:
                before = sum({1 << of for of, _ in pairs})
                ways = [way for reach, way in found if present(reach, maker) & before] or [(self._of_robot(maker),)]
                of_it = replace(plain, emits={maker: made}, flow_emits={}, flow_begins={})
                reach = search(Net.of(of_it), [maker], spread.all_bits, {})
                found += [(reach, (self._of(maker), *way)) for way in ways]
        return found

    def _differ(self, before: int, after: int) -> bool:
        """Whether two bits are of two kinds, not of one as it is and pseudonymised."""
        return self._spread.names(1 << before) != self._spread.names(1 << after)

    def _of(self, vertex: int) -> Processing:
        return self._bound.processing.get(vertex, UNSTATED)

    def _of_robot(self, vertex: int) -> Processing:
        return self._bound.of_robots.get(self._analysis.graph.elements[vertex].robot, UNSTATED)

    def _first(self, way: Way, category: str, attribute: str, group: tuple[str, ...] | None = None) -> list[str]:
        """What the first of several states of a kind of data; of one group of articles, where one is named."""
        for said in way:
            stated: ByCategory = getattr(said, attribute)
            found = [one for some in nearest(stated, category, self._hierarchy) for one in some]
            if some := [one for one in found if group is None or group_of(one) == group]:
                return some
        return []


def _distinct(texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(filter(None, texts)))
