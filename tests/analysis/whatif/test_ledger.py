"""The ledger (rules S5, S7, S8, S11): nothing that is taken away changes an answer in silence.

The property: whatever single line is removed that takes data's way, or a question, away, either the answer by brute
force gains nothing, or the line stood in the ledger before.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.example import DISK, factory
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import STANDARD, Method, Place, Statement
from rosprivacy.analysis.whatif.ledger import ledger
from tests.helpers.lined_systems import ADDS, stated
from tests.helpers.random_fleets import Case, fleets, found_in
from tests.helpers.systems import HIERARCHY, System

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.whatif.ledger import TakenAway
    from tests.helpers.brute import Brute
    from tests.helpers.lined_systems import Stated


def answer(brute: Brute) -> tuple[dict[tuple[str, str, int, int], tuple[bool, bool]], set[tuple[int, str]]]:
    """Finding -> (not dismissed, plain), each also if only what stands beside it is so; (vertex, category) open."""
    findings: dict[tuple[str, str, int, int], tuple[bool, bool]] = {}
    for key, (hidden, dismissed, _) in brute.findings().items():
        counts, plain = findings.get(key[:4], (False, False))
        findings[key[:4]] = (counts or not dismissed, plain or not hidden)
    return findings, {(v, c) for v, (categories, *_) in brute.open().items() for c in categories}


def worse(before: Brute, after: Brute) -> tuple[bool, bool]:
    """Whether findings (or worse ones), and whether questions, come about between two systems."""
    findings, questions = answer(before)
    later, asked = answer(after)
    more = any(
        key not in findings or any(now and not then for now, then in zip(state, findings[key], strict=True))
        for key, state in later.items()
    )
    return more, bool(asked - questions)


def rows_of(rows: tuple[TakenAway, ...], line: int) -> Iterator[TakenAway]:
    return (row for row in rows if any(place.line == line for place in row.places))


@given(stated())
def test_what_is_taken_away_stands_in_the_ledger(system: Stated) -> None:
    """Rules S5, S7, S8, S11, on sets: a line without a row of its own changes nothing."""
    try:
        rows = system.ledger()
    except InputErrors:
        return
    for line in sorted(system.lines()):
        try:
            analyse(system.without(line).graph(), system.without(line).bound(), system.system.hierarchy)
        except InputErrors:
            continue  # what is left contradicts itself
        found, asked = worse(system.brute(), system.without(line).brute())
        own = list(rows_of(rows, line))
        assert not found or any(row.leak or row.perhaps for row in own), (line, own)
        assert not asked or any(row.open or row.itself or row.perhaps for row in own), (line, own)


def test_an_absent_storage_of_which_there_would_be_a_finding_has_it_behind() -> None:
    """S10: without the line of ``absent``, data of which no retention is stated would be kept there."""
    graph, bound, hierarchy = factory()
    absent = Statement("sanitizer", (), (STANDARD + 1, 1), Place("labels.yaml", 6), method=Method.ABSENT)
    bound = replace(bound, elements={**bound.elements, DISK: (*bound.elements[DISK], absent)})
    rows = ledger(analyse(graph, bound, hierarchy), bound, hierarchy)
    (row,) = (row for row in rows if row.places == (Place("labels.yaml", 6),))
    assert row.leak == graph.elements[DISK]


@st.composite
def stated_fleets(draw: st.DrawFn) -> Case:
    """A fleet in which every line of a model's labels, and of what is shared, has a place of its own."""
    case = draw(fleets())
    new: dict[int, System] = {}
    for number, system in enumerate(case.systems):
        lines = count(1)
        said = {
            vertex: [one._replace(place=Place(f"model{number}.yaml", next(lines))) for one in statements]
            for vertex, statements in system.said.items()
        }
        new[id(system)] = replace(system, said=said)
    lines = count(1)
    shared = {
        name: (kind, stated, [one._replace(place=Place("fleet.yaml", next(lines))) for one in said])
        for name, (kind, stated, said) in case.shared.items()
    }
    return replace(case, robots={robot: new[id(system)] for robot, system in case.robots.items()}, shared=shared)


def lines_of(case: Case) -> set[Place]:
    said = [one for system in case.systems for statements in system.said.values() for one in statements]
    said += [one for _, _, statements in case.shared.values() for one in statements]
    return {one.place for one in said if one.role not in ADDS}


def fleet_without(case: Case, place: Place) -> Case:
    new = {
        id(system): replace(system, said={v: [s for s in said if s.place != place] for v, said in system.said.items()})
        for system in case.systems
    }
    shared = {
        name: (kind, stated, [s for s in said if s.place != place])
        for name, (kind, stated, said) in case.shared.items()
    }
    return replace(case, robots={robot: new[id(system)] for robot, system in case.robots.items()}, shared=shared)


@pytest.mark.slow
@given(stated_fleets())
def test_what_is_taken_away_on_a_fleet_stands_in_the_ledger(case: Case) -> None:
    """The same of robots that are read once for all that are alike, and of what they share."""
    result = found_in(case)
    if result is None:
        return
    analysis, placed = result
    rows = ledger(analysis, placed.bound, HIERARCHY)
    for place in sorted(lines_of(case), key=lambda place: (place.file, place.line)):
        other = fleet_without(case, place)
        if found_in(other) is None:
            continue
        found, asked = worse(case.brute()[0], other.brute()[0])
        own = [row for row in rows if place in row.places]
        assert not found or any(row.leak or row.perhaps for row in own), (place, own)
        assert not asked or any(row.open or row.itself or row.perhaps for row in own), (place, own)
