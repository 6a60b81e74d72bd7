"""A cell of the register states what lies on a path of its row, all of it, and nothing else (properties).

Random systems, and every path of a row followed on sets, from the rules' own text in ``brute``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from hypothesis import given, settings

from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.findings.register import Statements, register
from rosprivacy.analysis.legal import recognises
from rosprivacy.analysis.model.register_row import Cell, RowState
from rosprivacy.analysis.non_ros import RESTING
from tests.helpers.concerned import VOCABULARY, Case, cases
from tests.helpers.systems import analysed

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model.register_row import RegisterRow
    from tests.helpers.brute import Brute, Data

Arrival = tuple[int, "Data"]  # data at an element


class Behind(NamedTuple):
    """What a path has behind it where data is."""

    source: int
    made: frozenset[tuple[int, str, str]] = frozenset()  # who makes what of what
    met: frozenset[tuple[int, str]] = frozenset()  # sanitizers, each with the kind that it cleans
    begun: bool = False


class Paths:
    """All paths of a system; one ends wherever data begins, arrives or is made.

    Of paths that arrive alike with the same behind them, one is followed on.
    """

    def __init__(self, brute: Brute) -> None:
        self.brute = brute
        self.ends: dict[Arrival, set[Behind]] = {}
        self._seen: set[tuple[Arrival, Behind]] = set()
        for source in sorted(brute.sources()):
            emitted = brute.emitted(source)
            for data, only in emitted.items():
                made_of = {kind for kind, _ in emitted if data in brute.made(source, (kind, False))}
                made = frozenset((source, kind, data[0]) for kind in made_of)
                for behind in (Behind(source, begun=True), Behind(source, made, begun=True)):
                    self._end(source, data, behind)
                    self._go(source, data, behind, only)

    def _end(self, vertex: int, data: Data, behind: Behind) -> None:
        if not self.brute.gone(vertex, data[0]):
            self.ends.setdefault((vertex, data), set()).add(behind)

    def _go(self, vertex: int, data: Data, behind: Behind, only: Collection[int] | None = None) -> None:
        brute, (kind, hidden) = self.brute, data
        for a, b in brute.edges:
            if a != vertex or (only is not None and b not in only) or (b not in brute.nodes and brute.kills(b, kind)):
                continue
            if any(named in brute.hierarchy.ancestors[kind] for named in brute.never.get((a, b), ())):
                continue
            cleaned = {(b, kind)} if brute.cleans(b, kind) else set()
            here = Behind(behind.source, behind.made, behind.met | cleaned)
            if ((b, data), here) in self._seen:
                continue
            self._seen.add(((b, data), here))
            self._end(b, data, here)
            if not brute.kills(b, kind) or (hidden and brute.only_hides(b, kind)):
                self._go(b, data, here)
            for one in sorted(brute.made(b, data)):
                made = here.made | ({(b, kind, one[0])} if one[0] != kind else set())
                self._end(b, one, here._replace(made=made))
                self._go(b, one, here._replace(made=made))

    def of(self, row: RegisterRow, vertices: Mapping[str, int]) -> Iterator[Behind]:
        """What the paths of a row have behind them; of one without a place these end at all nodes."""
        places = {vertices[element.full_name] for element in row.places}
        sources = {vertices[element.full_name] for element in row.sources}
        for (vertex, (kind, _)), behind in self.ends.items():
            if kind == row.category and vertex in (places or self.brute.nodes):
                yield from (one for one in behind if places or one.source in sources)


@given(cases())
@settings(deadline=None)
def test_each_cell_holds_what_lies_on_the_paths_of_its_row_and_all_of_it(case: Case) -> None:
    analysis = analysed(case.system)
    if analysis is None:
        return
    paths = Paths(case.system.brute())
    check(case, analysis, rows_of(case, analysis), paths)


def rows_of(case: Case, analysis: Analysis) -> tuple[RegisterRow, ...]:
    return register(
        analysis, Statements(case.bound(), (), Contexts({}, VOCABULARY.categories), VOCABULARY.hierarchy, lambda *_: ())
    )


def check(case: Case, analysis: Analysis, rows: Collection[RegisterRow], paths: Paths) -> None:
    brute = paths.brute
    elements = case.system.graph().elements
    vertices = {element.full_name: vertex for vertex, element in enumerate(elements)}
    all_of_kind: dict[str, set[int]] = {}
    for row in rows:
        found = list(paths.of(row, vertices))
        sources = {behind.source for behind in found}
        all_of_kind.setdefault(row.category, set()).update(sources)
        assert {vertices[element.full_name] for element in row.sources} == sources
        persons = [case.persons.get(source, ()) for source in sources]
        assert set(row.subjects) == {one for groups in persons for one in groups}
        assert (Cell.SUBJECTS in row.to_complete) == (() in persons)
        made = {one for behind in found for one in behind.made}
        assert {(vertices[one.element.full_name], one.made_of, one.target) for one in row.derivations} == made
        check_measures(row, found, brute, vertices)
        check_place(row, brute, vertices)
    processed: dict[str, set[int]] = {}
    for (_, (kind, _)), behind in paths.ends.items():
        processed.setdefault(kind, set()).update(one.source for one in behind)
    assert all_of_kind == processed  # none is left out
    ends = {(e.full_name, row.category) for row in rows for e in row.places}
    resting = {v for v, (kind, _) in brute.outside.items() if kind in RESTING}
    rest = {(elements[v].full_name, kind) for v, (kind, _) in paths.ends if v in resting}
    assert ends == rest | {(finding.leak.full_name, finding.category) for finding in analysis.findings}


def check_measures(row: RegisterRow, found: Collection[Behind], brute: Brute, vertices: Mapping[str, int]) -> None:
    places = {vertices[element.full_name] for element in row.places}
    ways = [behind.met for behind in found if row.places or not behind.begun]
    lying = {
        (vertex, kind)
        for met in ways
        for vertex, kind in met
        if vertex not in places and not any(map(recognised, makes(brute, vertex)))
    }
    assert {(vertices[one.element.full_name], one.category) for one in row.measures} == lying
    for one in row.measures:
        assert one.everywhere == all((vertices[one.element.full_name], one.category) in met for met in ways)


def makes(brute: Brute, vertex: int) -> set[str]:
    return {s.to for s in brute.said.get(vertex, ()) if s.role == "derivation"}


def recognised(kind: str) -> bool:
    return recognises(VOCABULARY.categories[kind])


def check_place(row: RegisterRow, brute: Brute, vertices: Mapping[str, int]) -> None:
    """A time limit is that of the row's own place: of another it says nothing (Article 30(1)(f))."""
    facts = [brute.outside.get(vertices[element.full_name], ("", None))[1] for element in row.places]
    kept = [brute.nearest(one.retention, row.category) if one else [] for one in facts] or [[]]
    assert [sorted(map(str, row.retention))] == [sorted(some) for some in kept]
    endless = any(one and one.backups is True for one in facts)
    assert (Cell.RETENTION in row.to_complete) == (not all(kept) or endless)
    assert {row.country} == {one.country if one else "" for one in facts} or not facts
    assert (row.state is RowState.NO_FINDING) == (not row.findings)
