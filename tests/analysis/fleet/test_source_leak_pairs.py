"""Pairs of source and leak by the kernel against findings by searches: the same, without ways."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.fleet.source_leak_pairs import pairs
from tests.helpers.systems import WIDE, WIDE_HIERARCHY, System, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Bound, Statement

Row = tuple[str, str, int, int, bool, bool]


def same(system: System, bound: Bound) -> None:
    """Each pair is a finding, each finding a pair; sorted."""
    try:
        found = analyse(system.graph(), bound, system.hierarchy)
    except InputErrors:  # labels contradict each other
        return
    number = {element: i for i, element in enumerate(found.graph.elements)}
    got: set[Row] = set()
    for part in pairs(found.spread, tuple(concerns(found.spread, bound, system.hierarchy)), found.spread.all_bits):
        ends = list(zip(part.sources.tolist(), part.leaks.tolist(), strict=True))
        assert ends == sorted(set(ends))
        flags = np.column_stack([part.pseudonymised, part.dismissed, part.plain_also])
        for end, (hidden, dismissed, beside) in zip(ends, flags.tolist(), strict=True):
            pair = part.kind, found.emitted[part.category], *end
            got |= {(*pair, hidden, dismissed), *([(*pair, False, True)] if beside else [])}
    assert got == {
        (f.kind, f.category, number[f.source], number[f.leak], f.pseudonymised, f.dismissed) for f in found.findings
    }


@given(systems())
def test_pairs_are_the_findings_without_their_ways(system: System) -> None:
    same(system, system.bound())


@given(systems())
def test_sources_that_are_such_through_some_channels_only(system: System) -> None:
    bound = system.bound()
    elements = {}
    through: dict[tuple[int, tuple[str, ...]], tuple[int, ...]] = {}
    for vertex, said in bound.elements.items():
        leaving = [i for i, (a, _) in enumerate(system.edges) if a == vertex]
        elements[vertex] = tuple(s._replace(through=("x",)) if s.role == "source" else s for s in said)
        through[vertex, ("x",)] = tuple(leaving[::2])
    same(system, replace(bound, elements=elements, through=through))


@given(systems(names=tuple(WIDE)))
def test_more_categories_than_a_word_has_bits(system: System) -> None:
    system.hierarchy = WIDE_HIERARCHY
    for i, name in enumerate(WIDE):
        system.said.setdefault(i % system.nodes, []).append(statement("source", name))
    same(system, system.bound())


@pytest.mark.slow
def test_more_sources_than_a_word_has_bits() -> None:
    """A ring of 150 nodes that all bring video in and of which ten leak it."""
    count = 150
    edges = [(i, count + i) for i in range(count)] + [(count + i, (i + 1) % count) for i in range(count)]
    said = {
        i: [statement("source", "Face"), *([statement("leak", "Bio")] if i % 15 == 0 else [])] for i in range(count)
    }
    system = System(count, count, sorted(edges), said, {})
    same(system, system.bound())


def through(system: System, flow: int) -> Bound:
    """Sources emit along one flow only."""
    bound = system.bound()
    elements = {
        vertex: tuple(s._replace(through=("x",)) if s.role == "source" else s for s in said)
        for vertex, said in bound.elements.items()
    }
    ways: dict[tuple[int, tuple[str, ...]], tuple[int, ...]] = {
        (vertex, ("x",)): (flow,) for vertex in elements if system.edges[flow][0] == vertex
    }
    return replace(bound, elements=elements, through=ways)


@pytest.mark.parametrize("back", [[], [(1, 0)]])
def test_a_source_that_names_one_channel_is_still_a_leak_by_itself(back: list[tuple[int, int]]) -> None:
    """Rule S10: a node that is source and leak of one category is a finding by itself, also if nothing comes back."""
    said = {0: [statement("source", "Any"), statement("leak", "Any")]}
    system = System(1, 1, [(0, 1), *back], said, {})
    found = analyse(system.graph(), through(system, 0), system.hierarchy)
    assert [len(finding.witness) for finding in found.findings] == [1]
    same(system, through(system, 0))


@pytest.mark.parametrize(("channel", "flow"), [([statement("never", "Any")], {}), ([], {0: {"Any"}})])
def test_what_takes_away_the_channel_that_a_source_names_is_refused(
    channel: list[Statement], flow: dict[int, set[str]]
) -> None:
    """Rule S7: a user's full name that takes it away is an error with both lines."""
    said = {0: [statement("source", "Any")], 1: [statement("leak", "Any")], 2: channel}
    system = System(2, 1, [(0, 2), (2, 1)], said, flow)
    with pytest.raises(InputErrors, match="names it for Any"):
        analyse(system.graph(), through(system, 0), system.hierarchy)
