"""A fleet in parts against the same in one graph: whatever travels between parts, the answer is the same.

Here the parts are in a list; ``test_spark.py`` has them on Spark.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from hypothesis import given, settings

from rosprivacy.analysis.counts import counted
from rosprivacy.analysis.findings import Options, analyse
from rosprivacy.analysis.groups import Groups
from rosprivacy.distributed import Question, analyse_in_parts
from rosprivacy.ingest.alike import alike
from rosprivacy.shown import shown
from rosprivacy.workers import filled
from tests.test_findings import HIERARCHY
from tests.test_fleet_findings import Case, fleets, found_in

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rosprivacy.distributed import Found
    from rosprivacy.ingest.domains import Member
    from rosprivacy.ingest.fleet import Robot
    from rosprivacy.ingest.split import Unit
    from rosprivacy.shown import Shown


@dataclass(frozen=True)
class Listed:
    """Parts in a list."""

    values: tuple[Any, ...]

    def map(self, function: Callable[[Any], Any], *, keep: bool = False) -> Listed:
        del keep
        return Listed(tuple(map(function, self.values)))

    def collect(self) -> list[Any]:
        return list(self.values)


def scattered(units: Sequence[Unit], size: int = 1) -> Listed:
    return Listed(tuple(tuple(units[i : i + size]) for i in range(0, len(units), size)))


def given_members(members: dict[str, Member]) -> Callable[[Robot], Member]:
    return lambda robot: members[robot.id]


def question(case: Case) -> Question:
    fleet = case.fleet()
    members = {robot.id: case.member(robot) for robot in fleet.robots}
    return Question(fleet, alike(fleet), "declared", partial(given_members, members), HIERARCHY)


def rows(found: Found, told: Shown) -> Any:
    """Verdict, patterns, deviants; and what each pattern shows."""
    patterns = {
        (p.id, p.count, p.robots, p.across, p.dismissed, p.pseudonymised, p.finding.source, p.finding.leak,
         p.finding.pseudonymised, p.finding.dismissed)
        for p in told.view.patterns
    }  # fmt: skip
    return found.verdict, patterns, set(found.deviants), found.emitted


def same(case: Case, scatter: Callable[[Sequence[Unit]], Any]) -> None:
    """The same verdict, patterns, deviants, counts, open elements, and sets at every element."""
    result = found_in(case)
    if result is None:
        return
    _, placed = result
    groups = Groups(placed.likeness)
    analysis = analyse(placed.graph, placed.bound, HIERARCHY, Options(choose=groups))
    view = groups.view(analysis)
    asked = question(case)
    found = analyse_in_parts(asked, scatter)
    told = shown(asked, found, "witness", 100)
    expected = {
        (p.id, p.count, p.robots, p.across, p.dismissed, p.pseudonymised, p.finding.source, p.finding.leak,
         p.finding.pseudonymised, p.finding.dismissed)
        for p in view.patterns
    }  # fmt: skip
    assert rows(found, told) == (analysis.verdict, expected, set(view.deviants), analysis.emitted)
    assert found.counts == counted(placed.graph, analysis.spread, placed.likeness)
    assert found.open == sum(placed.likeness.weight(q.element.robot) for q in analysis.open)
    assert carried(found) == {e: bits for e, bits in everywhere(analysis.spread).items() if bits}
    known = {carried.element: carried for carried in analysis.carried}
    assert all(known[carried.element] == carried for carried in told.analysis.carried)


def everywhere(spread: Any) -> dict[Any, int]:
    return {element: spread.present(vertex) for vertex, element in enumerate(spread.graph.elements)}


def carried(found: Found) -> dict[Any, int]:
    """What is at each element of the parts and of the core."""
    sets: dict[Any, int] = {}
    for spread in [*found.parts.map(partial(filled, leaving=found.leaving)).collect(), found.core[1]]:
        mine = spread is found.core[1]
        border = set(found.border.elements)
        for element, bits in everywhere(spread).items():
            if bits and not element.robot.startswith("\0") and (mine or element not in border):
                assert element not in sets
                sets[element] = bits
    return sets


@given(fleets())
def test_in_parts_it_is_the_same(case: Case) -> None:
    same(case, scattered)


@given(fleets())
@settings(max_examples=30)
def test_several_units_are_one_part(case: Case) -> None:
    same(case, partial(scattered, size=2))
    same(case, partial(scattered, size=100))
