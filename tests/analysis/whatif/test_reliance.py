"""What the answer hangs on (rules S7, S8, S10, S11): each row is what the analysis says without that statement."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.example import ARCHIVE, CAMERA, DISK, FACES, FILTER, FILTERED, ROSOUT, factory
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.model import GLOB, Place, Statement
from rosprivacy.analysis.whatif import reliance
from rosprivacy.analysis.whatif.reliance import Opening, Reliance, reliances
from rosprivacy.analysis.whatif.spots import BRINGS_IN
from tests.helpers.brute_reliance import StatementKey, reliance_by_brute_force
from tests.helpers.lined_systems import stated
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.systems import systems

if TYPE_CHECKING:
    from rosprivacy.analysis.case import Case


def named(row: Reliance) -> StatementKey:
    """The same of a row; the sides of a wildcard have one name."""
    if row.statement.glob:
        return (row.statement,)
    return (row.statement, row.elements[0].name, *(element.name for element in row.to))


def compared(system: Any, options: Options) -> int:
    """Compare both; return how many statements anything hangs on."""
    graph, bound, hierarchy = system.graph(), system.bound(), getattr(system, "system", system).hierarchy
    try:
        analysis = analyse(graph, bound, hierarchy, options)
    except InputErrors:
        return 0
    rows = {named(row): row for row in reliances(analysis, bound, hierarchy, options.accepts)}
    for statement, expected in reliance_by_brute_force(graph, bound, hierarchy, options).items():
        row = rows.get(statement)
        if expected is None:
            assert row is None or row.refused, statement  # where no data is, nobody is told
            continue
        found = {
            (f.kind, f.category, f.source, f.leak): (not f.dismissed, not f.pseudonymised)
            for f in (row.findings if row else ())
        }
        asked = {(e.shown_as, c) for e, names in (row.questions if row else ()) for c in names}
        assert (found, asked) == expected, statement
        assert row is None or not (row.refused or row.perhaps)
    return len(rows)


def test_where_no_statement_takes_anything_away_no_data_is_followed() -> None:
    """On a fleet that would be most of all that is done."""
    graph, bound, hierarchy = factory()
    brings_in = {v: tuple(s for s in said if s.role in BRINGS_IN) for v, said in bound.elements.items()}
    only = replace(bound, elements=brings_in, flows={})
    analysis = analyse(graph, only, hierarchy)
    assert analysis.findings
    with patch.object(reliance, "Reach", side_effect=AssertionError):
        assert reliances(analysis, only, hierarchy) == ()


@given(st.one_of(systems(), ranked(), wildcards(), stated()), st.integers(1, 3))
def test_equals_the_analysis_without_the_statement(system: Any, together: int) -> None:
    """However many sources are followed at once."""
    with patch.object(reliance, "TOGETHER", together):
        compared(system, Options())


def test_of_the_example() -> None:
    """Without the filter, raw video gets to the archive; without the limit, video gets past the filter."""
    graph, bound, hierarchy = factory()
    rows = reliances(analyse(graph, bound, hierarchy), bound, hierarchy)
    cleaning, limit, standard = ((row.findings, row.questions) for row in rows)
    archive, disk = (graph.elements[v] for v in (ARCHIVE, DISK))
    as_it_is = [
        Opening(kind, "Video", graph.elements[CAMERA], end, dismissed=False, pseudonymised=False, new=False)
        for kind, end in (("disclosure", archive), ("storage-limitation", disk))
    ]
    assert cleaning == (tuple(as_it_is), ((graph.elements[FILTER], ("Video",)),))
    assert limit == (tuple(as_it_is), ((graph.elements[FACES], ("FaceTemplate", "Video")),))
    assert standard == ((), ((graph.elements[ROSOUT], ("Video",)),))


def test_what_was_not_worked_out_is_said() -> None:
    """A name above a glob that says mundane: more is lost than won without it, so the whole is analysed again."""
    graph, bound, hierarchy = factory()
    name, glob = ((1, 9), (1, 1))
    said = Statement("sensitive", (), name, Place("labels.yaml", 9))
    below = Statement("mundane", (), glob, Place("labels.yaml", 8), naming=GLOB)
    bound = replace(bound, elements={**bound.elements, FILTERED: (said, below)})
    analysis = analyse(graph, bound, hierarchy)
    assert said not in {row.statement for row in reliances(analysis, bound, hierarchy)}  # nothing hangs on it
    with patch.object(reliance, "ROUNDS", 0):
        (row,) = (row for row in reliances(analysis, bound, hierarchy) if row.statement == said)
    assert (row.perhaps, row.findings, row.questions) == (True, (), ())


@given(systems(), st.integers(0, 7))
def test_with_decisions(system: Any, number: int) -> None:
    """S10: what is accepted hides nothing behind it, and does not open."""

    def accepts(case: Case) -> bool:
        return sum(map(ord, case.leak.name + case.category + case.source.name)) % 8 <= number - case.pseudonymised * 3

    compared(system, Options(accepts=accepts))


@given(systems(), st.sets(st.sampled_from(["Bio", "Loc", "Face"])))
def test_of_some_categories(system: Any, asked: set[str]) -> None:
    compared(system, Options(categories=asked))
