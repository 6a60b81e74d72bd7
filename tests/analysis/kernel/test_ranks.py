"""Names, globs, two files, standard channels and channels that sources name, against brute force (S7, S8, S13)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import GLOB, NAME, SEGMENT, Place, Statement
from tests.helpers.systems import PARENTS, System, index, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis

EXACT = 1_000_000
NAMINGS = [(EXACT, NAME), (EXACT, NAME), (4, SEGMENT), (4, GLOB), (7, GLOB), (7, SEGMENT)]
SHIPPED = Statement("mundane", (), (0, 6), Place("rosprivacy:standard", 1), shipped=True, naming=SEGMENT)


@st.composite
def ranked(draw: st.DrawFn) -> System:
    """Statements by names and globs of one or two files; sources that name channels; standard channels."""
    system = draw(systems(outside=2))
    names = system.graph().elements
    channels = range(system.nodes, system.nodes + system.channels)
    one_file, two = st.just("a"), st.sampled_from(["a", "b"])
    where = two if draw(st.integers(0, 2)) == 0 else one_file

    def placed(one: Statement, vertex: int) -> Statement:
        rank, naming = draw(st.sampled_from(NAMINGS)) if vertex not in system.facts else NAMINGS[0]
        return replace(one, rank=(1, rank), naming=naming, place=Place(draw(where), vertex + 1))

    category = st.sampled_from(tuple(PARENTS))
    more = st.builds(
        lambda r, c: statement(r, *sorted(c)), st.sampled_from(["only", "never"]), st.sets(category, min_size=1)
    )
    plain = st.sampled_from([statement("mundane"), statement("sensitive")])
    words = st.sampled_from([statement("no-leak"), statement("no-source"), statement("conduit")])
    for vertex, said in system.said.items():
        extra = st.one_of(more, plain) if vertex in channels else words
        some = [*said, *draw(st.lists(extra, max_size=2))]
        system.said[vertex] = [placed(one, vertex) for one in dict.fromkeys(some)]
        if draw(st.booleans()) and vertex in channels:
            system.said[vertex].append(SHIPPED)
        written = [names[b].name for a, b in system.edges if a == vertex and b in channels]
        if draw(st.booleans()) and written:
            through = tuple(sorted(draw(st.sets(st.sampled_from(written), min_size=1))))
            system.said[vertex] = [
                replace(s, through=through) if s.role == "source" else s for s in system.said[vertex]
            ]
    return system


def analysed(system: System) -> Analysis | None:
    try:
        return system.analyse()
    except InputErrors:
        return None


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
    got = {
        (*system.edges[i], (name, bool(plane)))
        for i in range(len(system.edges))
        for plane, names in enumerate(found.spread.planes(found.spread.along(i)))
        for name in names
    }
    assert got == brute.along


@given(ranked())
def test_findings_and_open_questions_are_those_of_brute_force(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    number, brute = index(system), system.brute()
    expected = {(*key[:4], dismissed) for key, (_, dismissed, _) in brute.findings().items()}
    assert {(f.kind, f.category, number[f.source], number[f.leak], f.dismissed) for f in found.findings} == expected
    got = {number[q.element]: (set(q.categories), q.frontier) for q in found.open}
    assert got == {vertex: (names, frontier) for vertex, (names, _, frontier) in brute.open().items()}


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
