"""Names, globs, two files, standard channels and channels that sources name, against brute force (S7, S8, S13)."""

from __future__ import annotations

from hypothesis import given

from tests.helpers.more_systems import ranked
from tests.helpers.systems import System, analysed, findings_and_questions, index, sent, those_of_brute_force


@given(ranked())
def test_what_is_refused_is_what_brute_force_refuses(system: System) -> None:
    assert (analysed(system) is None) == system.brute().refused()


@given(ranked())
def test_what_is_carried_is_what_brute_force_reaches(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    number, brute = index(system), system.brute()
    expected: dict[int, tuple[set[str], set[str]]] = {}
    for vertex, (category, hidden) in brute.spread(brute.sources()):
        expected.setdefault(vertex, (set(), set()))[hidden].add(category)
    narrowest = {v: tuple(system.hierarchy.narrowest(names) for names in both) for v, both in expected.items()}
    assert {number[c.element]: (c.categories, c.pseudonymised) for c in found.carried} == narrowest


@given(ranked())
def test_what_goes_along_each_flow_is_what_brute_force_sends(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    brute = system.brute()
    brute.spread(brute.sources())
    assert sent(system, found) == brute.along


@given(ranked())
def test_findings_and_open_questions_are_those_of_brute_force(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    assert findings_and_questions(system, found) == those_of_brute_force(system.brute())


@given(ranked())
def test_what_is_taken_away_is_told(system: System) -> None:
    """S7: each source and leak that a higher rank takes away, by what, and no other."""
    found = analysed(system)
    if found is None:
        return
    told = {
        (number, row.role, name)
        for row in found.spread.overruled
        for number in (index(system)[e] for e in system.graph().elements if e.name in row.names)
        for name in row.categories
    }
    assert told == system.brute().taken_away()
