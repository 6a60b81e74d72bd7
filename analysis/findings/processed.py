"""What data are processed for where they begin and end, on which legal basis and by whom, as people state it.

In: an analysis and statements. Out: ``Processed`` of each source and exit; what a stated basis lacks (Article 30(1)).

What is stated of the end itself comes first, then of the node that makes the kind, then of the source that it
comes from, then of the robot of the source or the whole system. Articles 6, 9, 10 and chapter V are looked up each by
itself.
None of it changes a finding: a stated basis is no acceptance.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.backward import backward
from rosprivacy.analysis.legal_bases import GROUPS, gaps, group_of
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
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.legal_bases import Verdicts
    from rosprivacy.analysis.model import Bound, ByCategory, Element, Place, Processing

PURPOSE, BASIS = "purpose", "legal_basis"  # what can be missing


@dataclass(frozen=True, slots=True)
class Processed:
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
    Linear in the findings; for an element outside ROS without a finding one search backward for each kind.

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
    found = [rows.row(vertex, category, origins) for (vertex, category), origins in sorted(rows.ends.items())]
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


Origin = tuple[int, int]  # vertex of the source; of the node that makes the kind, or of the source again


class _Rows:
    """Looks up what is stated, from the end to the whole system."""

    def __init__(self, analysis: Analysis, bound: Bound, hierarchy: Hierarchy) -> None:
        self._analysis = analysis
        self._bound = bound
        self._hierarchy = hierarchy
        self._spread = analysis.spread
        self._number = {element: i for i, element in enumerate(analysis.graph.elements)}

    @cached_property
    def ends(self) -> dict[tuple[int, str], set[Origin]]:
        """(vertex, kind) of sources and exits -> where the data come from."""
        found: dict[tuple[int, str], set[Origin]] = defaultdict(set)
        spread, emitted = self._spread, set(self._analysis.emitted)
        for vertex in spread.facts:
            for category in emitted.intersection(spread.names(spread.begins(vertex))):
                found[vertex, category].add((vertex, vertex))
        for finding in self._analysis.findings:
            end = self._number[finding.leak], finding.category
            found[end].add((self._number[finding.source], self._number[_maker(finding)]))
        for element in self._analysis.outside:
            vertex = self._number[element]
            for category in emitted.intersection(spread.names(spread.present(vertex))):
                if (vertex, category) not in found:
                    found[vertex, category] = self._coming_to(vertex, category)
        return dict(found)

    def _coming_to(self, vertex: int, category: str) -> set[Origin]:
        """Where data that no finding is about come from."""
        spread = self._spread
        leading = backward(spread, {vertex: spread.both(category)})
        sources = {v for v in spread.facts if spread.emits.get(v, 0) & leading.leaving.get(v, 0)}
        for index, bits in spread.flow_emits.items():
            flow = spread.graph.flows[index]
            if bits & leading.entering.get(flow.target, 0):
                sources.add(flow.source)
        own = spread.both(category)
        makers = [
            v
            for v, pairs in spread.derives.items()
            if v in self._bound.processing
            and any(own >> after & 1 and not own >> before & 1 for before, after in pairs)
            and leading.leaving.get(v, 0) & own
            and spread.present(v)
        ]
        emitting = {v for v in sources if spread.begins(v) & own}
        return {(v, v) for v in emitting} | {(v, m) for v in sources - emitting for m in makers or [v]}

    def row(self, vertex: int, category: str, origins: set[Origin]) -> Processed:
        """What is stated of a kind of data at one end."""
        elements, robots = self._analysis.graph.elements, self._bound.of_robots
        element = elements[vertex]
        own = [self._of(vertex)]
        ways = [[self._of(maker), self._of(source), self._of_robot(source)] for source, maker in sorted(origins)]
        ways = ways or [[self._of_robot(vertex)]]
        purposes = [self._first(way, category, "purposes") for way in (own, *ways)]
        stated: list[str] = []
        missing = [] if purposes[0] or all(purposes[1:]) else [PURPOSE]
        for group in GROUPS:
            here, *there = [self._first(way, category, "bases", group) for way in (own, *ways)]
            stated += here or [basis for some in there for basis in some]
            if group == GROUPS[0] and not here and not all(there):
                missing.append(BASIS)
        everywhere = [element.robot, *(elements[source].robot for source, _ in sorted(origins))]
        who = [robots[robot] for robot in everywhere if robot in robots]
        facts = self._analysis.outside.get(element)
        return Processed(
            element,
            category,
            _distinct(said.controller for said in who),
            _distinct(said.dpo for said in who),
            _distinct(sorted(purposes[0] or (text for some in purposes[1:] for text in some))),
            _distinct(sorted(stated)),
            tuple(missing),
            next((said.place for way in (own, *ways) for said in way if said.bases), NOWHERE),
            bool(facts and transferred(facts)),
        )

    def _of(self, vertex: int) -> Processing:
        return self._bound.processing.get(vertex, UNSTATED)

    def _of_robot(self, vertex: int) -> Processing:
        return self._bound.of_robots.get(self._analysis.graph.elements[vertex].robot, UNSTATED)

    def _first(
        self, way: Sequence[Processing], category: str, what: str, group: tuple[str, ...] | None = None
    ) -> list[str]:
        """What the first of several states of a kind of data; of one group of articles, where one is named."""
        for said in way:
            stated: ByCategory = getattr(said, what)
            found = [one for some in nearest(stated, category, self._hierarchy) for one in some]
            if some := [one for one in found if group is None or group_of(one) == group]:
                return some
        return []


def _maker(finding: Finding) -> Element:
    """The element that makes the kind on the witness; its source, where that brings it in."""
    for step in reversed(finding.steps):
        if step.category != finding.category:
            return step.target
    return finding.source


def _distinct(texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(filter(None, texts)))


def of_end(rows: Iterable[Processed]) -> dict[tuple[Element, str], Processed]:
    """Return rows by element and kind of data.

    >>> of_end([])
    {}
    """
    return {(row.element, row.category): row for row in rows}
