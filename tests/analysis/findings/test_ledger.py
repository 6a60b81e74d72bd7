"""The ledger (rules S5, S7, S8, S11): nothing that is taken away changes an answer in silence.

The property: whatever single line is removed that takes data's way, or a question, away, either the answer by brute
force gains nothing, or the line stood in the ledger before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import count
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.ledger import ledger
from rosprivacy.analysis.model import GLOB, Bound, Flow, FlowGraph, Grant, Place, Statement
from tests.helpers.random_fleets import Case, fleets, found_in
from tests.helpers.systems import HIERARCHY, System, statement, systems

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.findings.ledger import TakenAway
    from tests.helpers.brute import Brute

ADDS = {"source", "leak"}
NEVER = 1000  # the line of what is said of the first flow


@dataclass
class Stated:
    """A system in which every line has a place of its own, and some flows are denied.

    Attributes
    ----------
    denied
        Flow -> the lines of the DENYs that take it away.
    """

    system: System
    denied: dict[tuple[int, int], set[int]]

    @property
    def edges(self) -> list[tuple[int, int]]:
        return [edge for edge in self.system.edges if not self.denied.get(edge)]

    def graph(self) -> FlowGraph:
        whole = self.system.graph()
        denied = [Flow(a, b, "publish", (), tuple(map(deny, sorted(lines)))) for (a, b), lines in self.denied.items()]
        return replace(
            whole,
            flows=tuple(Flow(a, b, "publish") for a, b in self.edges),
            denied=tuple(f for f in denied if f.denials),
        )

    def bound(self) -> Bound:
        whole = self.system.bound()
        numbers = {edge: number for number, edge in enumerate(self.edges)}
        never = {i: self.system.edges[i] for i in whole.flows}
        lines = {
            i: tuple(replace(s, place=Place("labels.yaml", NEVER + i)) for s in said) for i, said in whole.flows.items()
        }
        flows = {numbers[edge]: lines[i] for i, edge in never.items() if edge in numbers}
        return replace(whole, flows=flows)

    def ledger(self) -> tuple[TakenAway, ...]:
        graph, bound, hierarchy = self.graph(), self.bound(), self.system.hierarchy
        return ledger(analyse(graph, bound, hierarchy), bound, hierarchy)

    def brute(self) -> Brute:
        brute = self.system.brute()
        return replace(brute, edges=self.edges)

    def lines(self) -> set[int]:
        """The lines that take something away."""
        said = {s.place.line for said in self.system.said.values() for s in said if s.role not in ADDS}
        return said.union(*self.denied.values(), {NEVER + i for i in self.system.never})

    def without(self, line: int) -> Stated:
        said = {v: [s for s in said if s.place.line != line] for v, said in self.system.said.items()}
        denied = {edge: lines - {line} for edge, lines in self.denied.items()}
        never = {i: names for i, names in self.system.never.items() if NEVER + i != line}
        return Stated(replace(self.system, said=said, never=never), denied)


def deny(line: int) -> Grant:
    return Grant(False, "publish", "topic", "/t", "/e", "/n", Place("policy.xml", line))


@st.composite
def stated(draw: st.DrawFn) -> Stated:
    """Some lines are about several elements, as a glob is; some flows are denied, by one line or two."""
    system = draw(systems())
    said: dict[int, list[Statement]] = {}
    line = 0
    for vertex, statements in system.said.items():
        said[vertex] = []
        for one in statements:
            line += 1
            said[vertex].append(replace(one, place=Place("labels.yaml", line)))
    for _ in range(draw(st.integers(0, 2))):
        line += 1
        glob = draw(st.sampled_from(GLOBS))
        among = range(system.nodes) if glob.role == "sanitizer" else range(system.nodes, system.nodes + system.channels)
        for vertex in draw(st.sets(st.sampled_from(among), min_size=2)) if len(among) > 1 else ():
            said[vertex] = [replace(glob, place=Place("labels.yaml", line), naming=GLOB)]
    denied = {}
    for edge in draw(st.sets(st.sampled_from(system.edges), max_size=3)):
        if system.edges.index(edge) not in system.never:
            denied[edge] = {line + 1 + n for n in draw(st.sets(st.integers(0, 2), min_size=1, max_size=2))}
    return Stated(replace(system, said=said), denied)


GLOBS = [statement("mundane"), statement("never", "Any"), statement("only", "Loc"), statement("never", "Face")]


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


@st.composite
def stated_fleets(draw: st.DrawFn) -> Case:
    """A fleet in which every line of a model's labels, and of what is shared, has a place of its own."""
    case = draw(fleets())
    new: dict[int, System] = {}
    for number, system in enumerate(case.systems):
        lines = count(1)
        said = {
            vertex: [replace(one, place=Place(f"model{number}.yaml", next(lines))) for one in statements]
            for vertex, statements in system.said.items()
        }
        new[id(system)] = replace(system, said=said)
    lines = count(1)
    shared = {
        name: (kind, stated, [replace(one, place=Place("fleet.yaml", next(lines))) for one in said])
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
