"""The register of processing: what people and labels know of each kind of data at each place where it leaves or rests.

In: an analysis, and what is stated of persons, purposes, places and law. Out: ``RegisterRow``s: for each kind of data
one for each place where it leaves or rests, whether that is a finding or not (rules S9, S10), and one for what leaves
nowhere, so that all processing stands there. A cell holds what lies on the ways of its row and nothing else; what
nobody knows is groups in ``to_complete``. Source: GDPR, Articles 5, 6, 9, 10, 26, 28, 30, 44 to 49 and 88.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.contexts import article9_in, revealed
from rosprivacy.analysis.findings.processed import BASIS, PURPOSE
from rosprivacy.analysis.findings.ways import Rest, WaysOf
from rosprivacy.analysis.kernel.search import search
from rosprivacy.analysis.kernel.states import Net, derived_bits
from rosprivacy.analysis.legal import CHAPTER_V, GROUPS, Lack, gaps, group_of
from rosprivacy.analysis.model import NOWHERE, STATED, THIRD_COUNTRY, NonRosFacts
from rosprivacy.analysis.model.register_row import Cell, RegisterRow, RowState, row_id
from rosprivacy.analysis.non_ros import (
    ADEQUATE,
    DEROGATION,
    INSIDE,
    OCCASIONAL,
    RESTING,
    retention_of,
    transferred,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.findings.ways import Ways
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Element, Surroundings

    Law = Callable[[str, tuple[str, ...], tuple[str, ...], tuple[str, ...]], tuple[str, ...]]


class Statements(NamedTuple):
    """What is stated, beside what the analysis has.

    Attributes
    ----------
    bound
        Persons and surroundings of sources.
    processed
        Purposes and legal bases where data begin and end.
    contexts
        Where sources work, and the kinds of data.
    law
        (Kind, contexts, countries, groups of persons) -> names of the provisions to look at.
    decided
        Id of a finding -> legal bases that a valid decision records.
    second
        Of robots that are alike, those for which another one stands -> that one.
    """

    bound: Bound
    processed: tuple[Processed, ...]
    contexts: Contexts
    hierarchy: Hierarchy
    law: Law
    decided: Mapping[str, tuple[str, ...]] = {}
    second: Mapping[str, str] = {}


def register(analysis: Analysis, stated: Statements) -> tuple[RegisterRow, ...]:
    """Return the rows, by kind of data and place; what leaves nowhere stands last of its kind.

    Notes
    -----
    For each row O(flows that lead to its places), and once more for each of its measures.

    Examples
    --------
    >>> from rosprivacy.analysis.contexts import Contexts
    >>> from rosprivacy.analysis.example import CATEGORIES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> stated = Statements(bound, (), Contexts({}, CATEGORIES), hierarchy, lambda kind, *where: ())
    >>> for row in register(analyse(graph, bound, hierarchy), stated):
    ...     print(row.category, row.places[0].name, [measure.element.name for measure in row.measures], row.state)
    FaceTemplate /archive [] open
    FaceTemplate disk [] open
    Video /archive ['/filter'] open
    Video disk ['/filter'] open
    """
    return tuple(_Rows(analysis, stated._replace(law=cache(stated.law))).all())


class _Rows:
    """Makes rows; what several need is looked up once."""

    def __init__(self, analysis: Analysis, stated: Statements) -> None:
        self._analysis = analysis
        self._stated = stated
        self._spread = analysis.spread
        self._elements = analysis.graph.elements
        self._ways = WaysOf(analysis.spread, stated.contexts.categories)
        self._processed = {(row.element.identity, row.category): row for row in stated.processed}
        self._findings: dict[tuple[tuple[str, str, str], str], list[Finding]] = defaultdict(list)
        for finding in analysis.findings:
            self._findings[finding.leak.identity, finding.category].append(finding)
        self._facts = {element.identity: facts for element, facts in analysis.outside.items()}

    def all(self) -> Iterator[RegisterRow]:
        spread = self._spread
        resting = {one for one, facts in self._facts.items() if one[1] in RESTING}
        ends: dict[str, dict[tuple[str, str, str], list[int]]] = {}
        everywhere: dict[str, dict[int, int]] = {}
        for vertex, element in enumerate(self._elements):
            for category in spread.names(spread.present(vertex)):
                if element.identity in resting or (element.identity, category) in self._findings:
                    ends.setdefault(category, {}).setdefault(element.identity, []).append(vertex)
                if not element.is_channel:
                    bits = spread.present(vertex) & spread.forms_of(category)
                    everywhere.setdefault(category, {})[vertex] = bits
        for category in self._analysis.emitted:
            begins = {
                vertex
                for vertex in self._ways.sources(everywhere.get(category, {}))
                if self._elements[vertex].robot not in self._stated.second
            }
            for vertices in self._alike(category, ends.get(category, {})):
                ways = self._ways.to(self._bits(category, vertices))
                begins.difference_update(ways.sources)
                yield self._row(category, vertices, ways)
            if begins:
                yield self._row(category, (), self._to_nowhere(category, begins))

    def _bits(self, category: str, vertices: Iterable[int]) -> dict[int, int]:
        both = self._spread.forms_of(category)
        return {vertex: self._spread.present(vertex) & both for vertex in vertices}

    def _alike(self, category: str, ends: Mapping[tuple[str, str, str], list[int]]) -> list[list[int]]:
        """The places of a kind of data; those that differ only in the robot together."""
        groups: dict[object, list[int]] = defaultdict(list)
        for identity, vertices in ends.items():
            facts = self._facts.get(identity)
            processing = self._processed.get((identity, category))
            groups[
                identity[1:],
                facts and facts._replace(place=NOWHERE, limits=()),
                processing
                and (
                    processing.controllers,
                    processing.officers,
                    processing.purposes,
                    processing.bases,
                    processing.missing,
                ),
                self._pseudonymised(category, vertices),
            ] += vertices
        return sorted(groups.values(), key=lambda some: self._elements[some[0]].identity[1:])

    def _to_nowhere(self, category: str, sources: set[int]) -> Ways:
        """What lies on the ways from sources whose data of a kind get to no place: to each node that gets or makes it.

        A node has it before another one cleans it, so then not all ways pass that.
        """
        spread = self._spread
        arrives = search(Net.cached(spread), sources, spread.all_bits, {}).arrived_bits
        both = spread.forms_of(category)
        there = {v: (bits | derived_bits(spread, v, bits)) & both for v, bits in arrives.items()}
        nodes = {v: bits for v, bits in there.items() if bits and not self._elements[v].is_channel}
        return self._ways.to(nodes, Rest({v: spread.begins(v) & both for v in sources}, sources, arrives))

    def _pseudonymised(self, category: str, vertices: Iterable[int]) -> bool:
        """Whether nothing of a kind, or of a narrower one, is at some places as it is."""
        plain, hidden = (set(names) for names in self._spread.planes(self._present(vertices)))
        above = self._stated.hierarchy.ancestors
        return category in hidden and not any(category in above[kind] for kind in plain)

    def _present(self, vertices: Iterable[int]) -> int:
        there = 0
        for vertex in vertices:
            there |= self._spread.present(vertex)
        return there

    def _row(self, category: str, vertices: Sequence[int], ways: Ways) -> RegisterRow:
        places = tuple({(e := self._elements[v]).shown_as: e for v in vertices}.values())
        sources = tuple(dict.fromkeys(self._first(self._elements[vertex]) for vertex in ways.sources))
        facts = self._facts.get(places[0].identity) if places else None
        here = dict.fromkeys(place.identity for place in places)
        findings = [finding for at in here for finding in self._findings.get((at, category), ())]
        ends = here or dict.fromkeys(e.identity for e in (*sources, *(row.element for row in ways.derivations)))
        processing = [row for end in ends if (row := self._processed.get((end, category)))]
        recorded = (basis for finding in findings for basis in self._stated.decided.get(finding.id, ()))
        bases = tuple(dict.fromkeys([*(basis for row in processing for basis in row.bases), *recorded]))
        articles = {group: tuple(basis for basis in bases if group_of(basis) == group) for group in GROUPS}
        where = [self._where(vertex) for vertex in ways.sources]
        contexts = tuple(sorted({one for some, _ in where for one in some}))
        countries = tuple(sorted({country for _, country in where if country}))
        groups = [self._stated.bound.subjects.get(vertex, ()) for vertex in ways.sources]
        subjects = tuple(sorted({group for groups in groups for group in groups}))
        kind = self._stated.contexts.categories[category]
        law = tuple((one.name, one.verdict) for one in (*kind.law, *revealed(kind, contexts)))
        case = THIRD_COUNTRY if facts and transferred(facts) else STATED
        lacks = {gap.lack for gap in gaps(bases, [(case, category)], {category: law})}
        stated = facts or NonRosFacts()
        kept = tuple(retention_of(stated, category, self._stated.hierarchy))
        open_cells = {
            *_of_persons(processing, groups),
            *(cell for lack, cell in CELLS_OF_LACKS.items() if lack in lacks),
            *(_of_place(places[0], facts, articles[CHAPTER_V]) if places else ()),
            *([Cell.RETENTION] if not kept or stated.backups is True else []),
        }
        return RegisterRow(
            id=row_id(category, places or sources),
            category=category,
            places=places,
            pseudonymised=bool(places) and self._pseudonymised(category, vertices),
            article9=article9_in(kind, contexts),
            sources=sources,
            derivations=tuple(
                dict.fromkeys(one._replace(element=self._first(one.element)) for one in ways.derivations)
            ),
            measures=tuple(dict.fromkeys(one._replace(element=self._first(one.element)) for one in ways.measures)),
            subjects=subjects,
            contexts=contexts,
            countries=countries,
            purposes=_distinct(row.purposes for row in processing),
            controllers=_distinct(row.controllers for row in processing),
            officers=_distinct(row.officers for row in processing),
            bases=articles[GROUPS[0]],
            special_bases=articles[GROUPS[1]],
            criminal_bases=articles[GROUPS[2]],
            safeguards=articles[CHAPTER_V],
            operator=stated.operator,
            recipient=stated.recipient,
            contract=stated.contract,
            country=stated.country,
            area=stated.area,
            transfer=stated.transfer,
            retention=kept,
            backups=stated.backups,
            encrypted=stated.encrypted,
            look_at=self._stated.law(category, contexts, countries, subjects),
            findings=tuple(dict.fromkeys(finding.id for finding in findings)),
            state=_state(findings),
            to_complete=tuple(cell for cell in Cell if cell in open_cells),
        )

    def _first(self, element: Element) -> Element:
        """The same element of the robot that stands for its own."""
        return replace(element, robot=self._stated.second.get(element.robot, element.robot))

    def _where(self, vertex: int) -> tuple[frozenset[str], str]:
        """The contexts and the country of a source."""
        at: Surroundings | None = self._stated.bound.surroundings.get(vertex)
        contexts = self._stated.contexts.by_source.get(self._elements[vertex].identity, frozenset())
        return contexts, at.country if at else ""


CELLS_OF_LACKS = {
    Lack.ARTICLE_6: Cell.BASES,
    Lack.ARTICLE_9: Cell.SPECIAL_BASES,
    Lack.REVEALS: Cell.SPECIAL_BASES,
    Lack.SECRECY: Cell.SPECIAL_BASES,
    Lack.ARTICLE_10: Cell.CRIMINAL_BASES,
}
ON_A_CONTRACT = ("joint-controller", "processor")  # Articles 26 and 28


def _of_persons(processing: Sequence[Processed], groups: Collection[tuple[str, ...]]) -> Iterator[Cell]:
    """What is not stated of all data of a row: who is responsible, what for, whose data."""
    if not processing or not all(row.controllers for row in processing):
        yield Cell.CONTROLLERS
    if not processing or not all(row.officers for row in processing):
        yield Cell.OFFICERS
    for missing, cell in ((PURPOSE, Cell.PURPOSES), (BASIS, Cell.BASES)):
        if not processing or any(missing in row.missing for row in processing):
            yield cell
    if not groups or not all(groups):
        yield Cell.SUBJECTS


def _of_place(place: Element, facts: NonRosFacts | None, articles: Collection[str]) -> Iterator[Cell]:
    """What is not stated of a place; a node is no recipient (Article 4(9)), so of one nothing is."""
    if facts is None or not facts.operator:
        yield Cell.OPERATOR
    if facts is None or not facts.recipient:
        yield Cell.RECIPIENT
    if facts is None or not facts.country:
        yield Cell.COUNTRY
    if facts is None or _unsafe(facts, articles):
        yield Cell.SAFEGUARDS
    if facts and facts.recipient in ON_A_CONTRACT and not facts.contract:
        yield Cell.CONTRACT
    if place.kind == "storage" and facts and facts.encrypted is None:
        yield Cell.ENCRYPTED


def _unsafe(facts: NonRosFacts, articles: Collection[str]) -> bool:
    """Whether a person has to say on which safeguard data leave the EEA, or whether they do (Article 30(1)(e)).

    A derogation has to be groups: of the second subparagraph of Article 49(1) the safeguards are to be documented.
    """
    if not facts.country:
        return not facts.basis
    if facts.area in ("", INSIDE, ADEQUATE):
        return False
    derogation = facts.basis == DEROGATION or (
        facts.basis == OCCASIONAL and not any(article.startswith("49(") for article in articles)
    )
    return derogation or not facts.basis or transferred(facts) is not None


def _state(findings: Collection[Finding]) -> RowState:
    if any(finding.stands for finding in findings):
        return RowState.OPEN
    if any(finding.accepted for finding in findings):
        return RowState.ACCEPTED
    return RowState.DISMISSED if findings else RowState.NO_FINDING


def _distinct(rows: Iterable[Iterable[str]]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(text for texts in rows for text in texts))
