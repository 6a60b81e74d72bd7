"""Decisions about rows on fleets (S10): a finding is accepted only where every row of it is (properties).

Random fleets and entries, against the rule on robots and names by lists, and against the fleet without robots that
stand for others.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.decisions import Choice, Decision, Decisions, decided
from rosprivacy.analysis.errors import DecisionError, InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.findings.register import Statements, register
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.fleet.patterns import FleetView
from rosprivacy.analysis.fleet.robots_of_rows import on_robots, row_ends, row_pattern, row_robots
from rosprivacy.analysis.model import Category, Place
from rosprivacy.analysis.model.register_row import RowState
from rosprivacy.analysis.remembered import About
from rosprivacy.decided import in_fleet
from rosprivacy.ingest.fleet.alike_robots import alike
from rosprivacy.ingest.fleet.fleet_graph import place
from tests.helpers.random_fleets import fleets, found_in
from tests.helpers.systems import HIERARCHY, PARENTS

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model.register_row import RegisterRow
    from rosprivacy.ingest.fleet.fleet_graph import Placed
    from tests.helpers.random_fleets import Case as Fleet

TODAY, OVER = "2026-11-20", "2026-11-19"
KINDS = {name: Category(name, f"urn:{name}", name, name, name, above) for name, above in PARENTS.items()}


class Pair(NamedTuple):
    """One finding of the whole fleet: its pattern, the row, and the robots of both ends; none is empty."""

    pattern: str
    row: str
    begins: str
    ends: str
    hidden: bool
    accepted: bool
    dismissed: bool

    @property
    def at(self) -> str:
        """The robot whose row it is: of the place, or of what begins where the place is on none."""
        return self.ends or self.begins


@dataclass(frozen=True)
class Entry:
    """What a person writes; ``known``: what was there then, and ``begun`` and ``ended``: on which robots."""

    choice: Choice
    id: str = ""
    row: str = ""
    robots: tuple[str, ...] = ()
    expires: str = ""
    known: frozenset[str] = frozenset()
    begun: frozenset[str] = frozenset()
    ended: frozenset[str] = field(default=frozenset())

    def decision(self, line: int) -> Decision:
        about = About(findings=self.known, robots=self.ended, from_robots=self.begun) if self.known else None
        more: dict[str, Any] = {"id": self.id, "row": self.row, "robots": self.robots, "expires": self.expires}
        return Decision(self.choice, Place("d.yaml", line), made_about=about, **more)

    def speaks_of(self, pair: Pair) -> bool:
        across = bool(pair.begins and pair.ends and pair.begins != pair.ends)
        listed = not self.robots or (pair.at in self.robots and not (across and not self.row))
        begun = pair.begins in ("", *(self.begun or self.ended))
        known = not self.known or (pair.pattern in self.known and begun and pair.ends in ("", *self.ended))
        return self.id in ("", pair.pattern) and self.row in ("", pair.row) and listed and known


class ContradictionError(Exception):
    """Two entries about the same thing differ."""


def is_accepted(pair: Pair, entries: Iterable[Entry]) -> bool:
    """The rule: what names the finding and what names its row have to accept it; of lists the shorter one counts."""
    about = [entry for entry in entries if entry.speaks_of(pair)]
    held = [closest(some) for some in ([e for e in about if e.row], [e for e in about if not e.row]) if some]
    if any(len({entry.choice for entry in some}) > 1 for some in held):
        raise ContradictionError
    return bool(held) and all(some[0].choice is Choice.ACCEPT and some[0].expires != OVER for some in held)


def closest(entries: list[Entry]) -> list[Entry]:
    shortest = min(len(entry.robots) or 99 for entry in entries)
    return [entry for entry in entries if (len(entry.robots) or 99) == shortest]


def on_file(written: Iterable[Entry]) -> Decisions:
    return Decisions("d.yaml", "", TODAY, tuple(e.decision(line) for line, e in enumerate(written)), HIERARCHY)


def answer(fleet: Fleet, decisions: Decisions, apart: Callable[[str], object]) -> tuple[Analysis, Likeness]:
    placed = placed_apart(fleet, apart)

    def accepts(case: Case) -> bool:
        return decisions.accepts(in_fleet(case, placed.likeness))

    return analyse(placed.graph, placed.bound, HIERARCHY, Options(accepts=accepts)), placed.likeness


def placed_apart(fleet: Fleet, apart: Callable[[str], object]) -> Placed:
    read = fleet.fleet()
    groups = alike(read, apart)
    members = {group.robots[0].id: fleet.member(group.robots[0]) for group in groups}
    return place(read, groups, members, "declared")


def pairs(findings: Iterable[Finding], likeness: Likeness) -> Iterator[Pair]:
    """Each finding of the fleet, for those that one of the graph stands for."""
    for finding in findings:
        if not likeness.count(finding):
            continue
        begins, ends = (likeness.placed(end.robot) or ("",) for end in (finding.source, finding.leak))
        inside = finding.source.robot == finding.leak.robot and begins != ("",)
        for source in begins:
            for leak in [source] if inside else ends:
                if inside or source != leak or not source:
                    yield Pair(
                        pattern_id(finding, likeness), row_pattern(finding.category, finding.leak, likeness), source,
                        leak, finding.pseudonymised, finding.accepted, finding.dismissed,
                    )  # fmt: skip


@st.composite
def joined(draw: st.DrawFn) -> Fleet:
    """Random fleets in which robots send each other what they let out, more often than not."""
    fleet = draw(fleets())
    hub = min(fleet.shared)
    begin, end = (
        sorted(
            {
                system.graph().elements[vertex].name
                for system in fleet.systems
                for vertex, said in system.brute().said.items()
                if vertex < system.nodes and any(one.role == role for one in said)
            }
        )
        for role in ("source", "leak")
    )
    if begin and end:
        sent, received = draw(st.sampled_from(begin)), draw(st.sampled_from(end))
        fleet.flows += [(f"*:{sent}", hub, frozenset()), (hub, f"*:{received}", frozenset())]
    return fleet


def most_of(names: Collection[str]) -> st.SearchStrategy[frozenset[str]]:
    """All of some names, or all but one."""
    return st.sampled_from(["", *sorted(names)]).map(lambda gone: frozenset(names) - {gone})


@st.composite
def entries(draw: st.DrawFn, there: list[Pair], robots: list[str]) -> list[Entry]:
    across = [pair for pair in there if pair.begins and pair.ends not in ("", pair.begins)]
    some = st.sampled_from(there) | st.sampled_from(across or there)
    lists = st.just(()) | st.lists(st.sampled_from(robots), min_size=1, unique=True).map(sorted).map(tuple)
    more: dict[str, Any] = {
        "choice": st.sampled_from([Choice.ACCEPT, Choice.ACCEPT, Choice.MITIGATE]),
        "expires": st.sampled_from(["", "", "", "", TODAY, OVER]),
        "robots": lists,
    }
    patterns = {pair.pattern for pair in there}
    memory: dict[str, Any] = {
        "known": st.just(frozenset()) | most_of(patterns),
        "begun": st.just(frozenset()) | most_of(robots),
        "ended": most_of(robots).map(lambda known: known or frozenset(robots)),
    }
    written = draw(
        st.lists(
            st.builds(Entry, row=some.map(lambda pair: pair.row), **more, **memory)
            | st.builds(Entry, id=some.map(lambda pair: pair.pattern), **more),
            min_size=1,
            max_size=4,
        )
    )
    return list({(entry.id, entry.row, entry.robots): entry for entry in written}.values())


@given(joined(), st.data())
@settings(deadline=None, max_examples=100)
def test_a_finding_is_accepted_only_where_every_row_of_it_is(fleet: Fleet, data: st.DataObject) -> None:
    before = found_in(fleet)
    there = list(pairs(before[0].findings, before[1].likeness)) if before else []
    if not there:
        return
    written = data.draw(entries(there, sorted(fleet.robots)))
    decisions = on_file(written)
    analysis, likeness = answer(fleet, decisions, decisions.told_apart)
    found = set(pairs(analysis.findings, likeness))
    try:
        expected = {pair: is_accepted(pair, written) for pair in found}
    except ContradictionError:
        expected = None
    try:
        decided(decisions, analysis.findings, {}, everything=True, case_of=lambda one: in_fleet(Case.of(one), likeness))
    except (DecisionError, InputErrors):
        assert expected is None
        return
    assert expected is not None
    assert {pair: pair.accepted for pair in found} == expected
    single, alone = answer(fleet, decisions, str)  # no robot stands for another
    assert set(pairs(single.findings, alone)) == found
    rows = rows_on_robots(fleet, decisions, made=True)
    for row in rows:
        states = {
            pair for pair in found if row.fleet and pair.row == row.fleet.pattern and (
                not placed_on(row, likeness) or pair.at in row.fleet.robots
            )
        }  # fmt: skip
        assert row.state is state_of(states)


def state_of(states: set[Pair]) -> RowState:
    if any(not pair.accepted and not pair.dismissed for pair in states):
        return RowState.OPEN
    if any(pair.accepted for pair in states):
        return RowState.ACCEPTED
    return RowState.DISMISSED if states else RowState.NO_FINDING


def placed_on(row: RegisterRow, likeness: Likeness) -> bool:
    return any(likeness.is_robot(place.robot) for place in row.places)


def rows_on_robots(fleet: Fleet, decisions: Decisions, *, made: bool) -> tuple[RegisterRow, ...]:
    placed = placed_apart(fleet, decisions.told_apart)
    analysis, likeness = answer(fleet, decisions, decisions.told_apart)
    view = FleetView.of(analysis, likeness)
    ends = row_ends(view, analysis.findings if made else ())
    shown = replace(view.shown(analysis), findings=tuple(finding for finding, _ in ends))
    second = likeness.second
    stated = Statements(placed.bound, (), Contexts({}, KINDS), HIERARCHY, lambda *_: (), {}, second)
    return on_robots(register(shown, stated), view, ends)


@given(joined())
@settings(deadline=None, max_examples=40)
def test_rows_stand_on_the_robots_where_their_findings_end(fleet: Fleet) -> None:
    """Whether all findings are made or only those that are shown; each finding in the rows of its place."""
    before = found_in(fleet)
    if before is None:
        return
    analysis, placed = before
    nobody = on_file([])
    rows = rows_on_robots(fleet, nobody, made=True)
    assert rows == rows_on_robots(fleet, nobody, made=False)
    there = set(pairs(analysis.findings, placed.likeness))
    listed = [(row.fleet.pattern, robot) for row in rows if row.fleet for robot in row.fleet.robots]
    assert len(listed) == len(set(listed))
    assert set(listed) == {(pair.row, pair.at) for pair in there if pair.at}
    view = FleetView.of(analysis, placed.likeness)
    shown = {pattern.finding.id: pattern.id for pattern in view.patterns}
    for row in rows:
        if row.fleet and placed_on(row, placed.likeness):
            ends = {pair for pair in there if pair.row == row.fleet.pattern and pair.ends in row.fleet.robots}
            assert {shown[one] for one in row.findings} == {pair.pattern for pair in ends}
            across = any(pair.begins not in ("", pair.ends) for pair in ends)
            begins = {pair.begins for pair in ends if pair.begins}
            assert bool(row.fleet.from_robots) == across
            assert not across or begins <= set(row.fleet.from_robots)
    for name, robots in row_robots(view).items():
        assert {*robots.robots} == {pair.at for pair in there if pair.row == name and pair.at}


@given(joined(), st.data())
@settings(deadline=None, max_examples=40)
def test_a_row_is_accepted_with_what_was_there_and_no_robot_that_joins(fleet: Fleet, data: st.DataObject) -> None:
    """What a program remembers of a row of today covers all findings of it, and none on a robot that was not there."""
    before = found_in(fleet)
    if before is None or not before[0].findings:
        return
    view = FleetView.of(before[0], before[1].likeness)
    there = set(pairs(before[0].findings, before[1].likeness))
    name = data.draw(st.sampled_from(sorted(row_robots(view))))
    robots = row_robots(view)[name]
    gone = data.draw(st.sampled_from(["", *robots.robots]))
    known = frozenset(pair.pattern for pair in there if pair.row == name)
    begun = frozenset(robots.from_robots) - {gone}
    ended = frozenset(robots.robots) - {gone}
    entry = Entry(Choice.ACCEPT, row=name, known=known, begun=begun, ended=ended)
    if gone and not ended:
        return
    decisions = on_file([entry])
    analysis, likeness = answer(fleet, decisions, decisions.told_apart)
    for pair in pairs(analysis.findings, likeness):
        if pair.accepted:
            assert pair.row == name
            assert gone not in (pair.begins, pair.ends) or not gone
        elif pair in there:
            assert pair.row != name or gone in (pair.begins, pair.ends)
