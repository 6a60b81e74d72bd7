"""A fleet in parts: what each part says is put together here, and what leaves the border is handed out again.

In: a fleet, and a cluster that does the same with each of its parts. Out: the answer of ``fleet_in_parts.py``. Only
what is at the border travels between parts: sets of categories first; then, for each category, sets of classes of
sources, from which pairs are counted. Ways are looked for in the end, among the robots that are shown.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.errors import FleetError, InputError, InputErrors
from rosprivacy.analysis.findings.open_questions import grounds
from rosprivacy.analysis.fleet.counts import Counts, counted
from rosprivacy.analysis.fleet.patterns import different
from rosprivacy.analysis.fleet.source_leak_pairs import forms
from rosprivacy.analysis.kernel.arrays import GraphArrays, of_elements
from rosprivacy.analysis.kernel.spreading import emitted, fill, meaning
from rosprivacy.analysis.model import Rank, unread
from rosprivacy.analysis.non_ros import on_day
from rosprivacy.ingest.fleet.alike_robots import COLON, chosen, known_to_flows
from rosprivacy.ingest.fleet.fleet_graph import likeness, no_robot, nowhere, place_some
from rosprivacy.ingest.fleet.joins import joins_nothing
from rosprivacy.parts import workers
from rosprivacy.parts.border import Core
from rosprivacy.parts.classes import Classes, first_of
from rosprivacy.parts.crossings import crossings_of
from rosprivacy.parts.fleet_reliance import fleet_reliances
from rosprivacy.parts.part_patterns import Crossed
from rosprivacy.parts.units import (
    GATE,
    HUB,
    border,
    core_piece,
    crossing_lines,
    joined_to,
    split,
    unit_of,
    with_limits,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.answer import ClosedByShipped
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.patterns import CountedPattern, DeviantRobots
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, NonRosFacts
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.ingest.fleet.fleet_graph import Some
    from rosprivacy.parts.fleet_reliance import FleetRows
    from rosprivacy.parts.units import Border, Lines, Piece
    from rosprivacy.parts.workers import Parts, Read, Report

    Bits = NDArray[np.uint64]
    Indices = NDArray[np.int64]


MOST_WHOLE = 1_000  # robots that differ: of so many all are shown, so that the answer is that in memory
MOST_SHOWN = (
    200  # robots of a larger fleet, for what is open on them: all are counted, and of a large fleet nobody reads all
)


@dataclass(frozen=True, slots=True)
class Task:
    """What is analysed, and what is asked.

    Attributes
    ----------
    reader
        Makes what reads a robot, wherever it is called.
    categories
        Names of categories; None for all.
    today
        As of ``Options``.
    written
        Whether the rows of every robot are written, too, which are made of few.
    hangs_on
        Whether it is asked what the answer hangs on.
    """

    fleet: Fleet
    groups: tuple[Alike, ...]
    view: str
    reader: Callable[[], Read]
    hierarchy: Hierarchy
    categories: Collection[str] | None = None
    today: str = ""
    written: bool = False
    hangs_on: bool = False

    @property
    def whole(self) -> bool:
        """Whether all robots are shown: then the answer is that in memory, row by row."""
        return not self.written and sum(len(group.placed) for group in self.groups) <= MOST_WHOLE


@dataclass(frozen=True, slots=True)
class Found:
    """What was found out.

    Attributes
    ----------
    lacking
        What 'no leak found' needs and is missing in the whole fleet.
    groups
        Patterns, without ways.
    units
        Names of the units that are shown: all; of a large fleet those in which ways of these lie, one for each kind of
        open element, and of those joined to these.
    examples
        Names of units: with these, data of every source gets to one leak of each name that it gets to.
    leaking
        Robots of the graph from which data gets to a leak or the like, or at which it does.
    report
        What the parts rest on, put together.
    leaving
        What leaves each element of the border: bits of the categories.
    parts
        With their graphs.
    core
        The core with its spread at the fixpoint.
    open
        How many elements of the fleet are.
    closed
        What shipped files alone close, where that is a doubt: one robot for each kind.
    broken
        Robots at which this breaks the verdict.
    hangs_on
        Of a large fleet what the answer hangs on; None where that is not asked, and where all robots are shown.
    """

    emitted: tuple[str, ...]
    verdict: Verdict
    lacking: str
    groups: tuple[CountedPattern, ...]
    deviants: tuple[DeviantRobots, ...]
    units: frozenset[str]
    examples: frozenset[str]
    leaking: frozenset[str]
    counts: Counts
    report: Report
    likeness: Likeness
    leaving: Bits
    parts: Parts[workers.Ready]
    core: tuple[Piece, Spread]
    border: Border
    open: int
    closed: tuple[ClosedByShipped, ...]
    broken: frozenset[str]
    hangs_on: FleetRows | None = None

    @property
    def shared(self) -> dict[Element, NonRosFacts]:
        """What is stated about the elements of the core, with the limits that hold there."""
        piece = self.core[0]
        return {piece.graph.elements[vertex]: facts for vertex, facts in piece.bound.outside.items()}


def analyse_in_parts(task: Task, scatter: Callable[[Sequence[Any]], Parts[Any]]) -> Found:
    """Analyse a fleet.

    Parameters
    ----------
    scatter
        Puts units to parts.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    return _Run(task, scatter).answer()


class _Run:
    """One analysis, step by step."""

    def __init__(self, task: Task, scatter: Callable[[Sequence[Any]], Parts[Any]]) -> None:
        self._task = task
        self._fleet = task.fleet
        self._likeness = likeness(task.groups)
        self._scatter = scatter
        self._units: set[str] = set()

    def answer(self) -> Found:
        task, fleet = self._task, self._fleet
        fixed, units = split(task.groups)
        alone = replace(fleet, robots=(), infrastructure=())  # what every part needs of it
        read = task.reader()
        members = [replace(read(group.robots[0]), robot=robot) for group in fixed for robot in group.placed]
        core = place_some(fleet, members, task.view, own=True)
        built = self._scatter(units).map(
            partial(workers.built, fleet=alone, view=task.view, reader=task.reader),
            keep=True,
        )
        report = workers.joined([workers.report_of(core, members), *built.map(workers.report).collect()])
        self._check(report, core, built)
        joins = joins_nothing(fleet, task.groups, report.met, report.letting_out)
        report = replace(report, diagnostics=(*report.diagnostics, *joins))
        at = border(core, {lines for lines, side, *_ in report.naming if side == 0})
        categories = sorted(report.emitted | emitted(core.part.elements.values()))
        piece, gates = core_piece(core, at, task.view)
        piece = with_limits(piece, fleet, report.limits)
        piece = replace(piece, bound=replace(piece.bound, outside=on_day(piece.bound.outside, task.today)))
        ours = meaning(piece.graph, piece.bound, task.hierarchy, categories)
        network = GraphArrays.of(ours)
        middle = Core(network, np.array(gates, np.int64), np.array(piece.border, np.int64))
        ready = built.map(
            partial(
                workers.ready, fleet=alone, at=at, view=task.view, categories=categories,
                hierarchy=task.hierarchy, today=task.today,
            ),
            keep=True,
        )  # fmt: skip
        steps = self._steps(ours, ready)
        wanted = [c for c in categories if task.categories is None or c in task.categories]
        mask = sum(ours.forms_of(category) for category in wanted)
        numbers = [i for i, name in enumerate(categories) if name in wanted]
        ways = {i: forms(i, ours.bits, steps) for i in numbers}
        kernels = ready.map(partial(workers.kernel, forms=ways, hierarchy=task.hierarchy), keep=True)

        leaving = self._carry(middle, kernels, ours)
        classes = Classes(ours, piece, middle, ways, task.hierarchy)
        classes.number(kernels.map(workers.classes).collect())
        classes.carry(kernels)
        asked = workers.PartQuestion(leaving, classes.leaving, classes.numbers, classes.counts, mask, task.hierarchy)
        answers = ready.map(partial(workers.answered, forms=ways, question=asked)).collect()
        found = self._put_together(answers, classes, report, at, piece, ours, wanted, mask, leaving, ready)
        if task.whole or not (task.hangs_on or self._likeness.robots <= 1):
            return found
        width = ours.all_bits.bit_length()
        rows = fleet_reliances(
            built, alone, at, task.view, task.today, piece, gates, task.hierarchy, categories, mask,
            crossings_of(leaving, width), width,
        )  # fmt: skip
        return replace(found, hangs_on=rows)

    def _check(self, report: Report, core: Some, built: Parts[workers.Built]) -> None:
        """Raise what is wrong with the input."""
        if report.problems:
            raise InputErrors(report.problems)
        problems: list[InputError] = []
        for number, flow in enumerate(self._fleet.flows):
            for side, end in enumerate(flow.ends):
                problem = no_robot(self._fleet, flow, end.name)
                if problem is None and not ((number, side) in report.ends or core.ends[number][side]):
                    problem = nowhere(flow, end, self._names(end.name, core, built))
                problems += [problem] if problem else []
        for place in report.restated if crossing_lines(self._fleet) else ():
            what = "a flow within a robot, of which a label file says more"
            problems.append(
                FleetError(place.file, place.line, what, "for a fleet in parts, say all of it in one of both")
            )
        if problems:
            raise InputErrors(problems)

    def _names(self, end: str, core: Some, built: Parts[workers.Built]) -> list[str]:
        """The names that the end of a flow could mean."""
        if COLON not in end:
            return sorted(element.name for element in core.part.elements if element.robot == self._fleet.name)
        robots = frozenset(chosen(end, known_to_flows(self._fleet)))
        there = {element.name for element in core.part.elements if element.robot in robots}
        return sorted(there.union(*built.map(partial(workers.names_on, robots=robots)).collect()))

    def _steps(self, ours: Spread, ready: Parts[workers.Ready]) -> set[tuple[int, int]]:
        """What data is made into other data anywhere."""
        found = {step for some in ours.derives.values() for step in some}
        problems: list[InputError] = []
        for wrong, some in ready.map(workers.steps).collect():
            problems += wrong
            found |= some
        if problems:
            raise InputErrors(problems)
        return found

    def _carry(self, middle: Core, kernels: Parts[workers.Kernel], ours: Spread) -> Bits:
        """Iterate the sets at the border to the fixpoint; return what leaves it."""
        arrived = np.zeros((len(middle.border), middle.network.emitted.shape[1]), np.uint64)
        while True:
            arrives, leaves = middle.carried(arrived)
            leaving = leaves[middle.border]
            answers = list(kernels.map(partial(workers.carried, leaving=leaving, before=arrived)).collect())
            before = arrived.copy()
            for bits, _ in answers:
                arrived |= bits
            self._units |= set(first_of(brought for _, brought in answers).values())
            if np.array_equal(before, arrived):
                fill(ours, of_elements(ours, arrives), of_elements(ours, leaves))
                return leaving

    def _put_together(
        self, answers: Iterable[workers.PartAnswer], classes: Classes, report: Report, at: Border, piece: Piece,
        ours: Spread, categories: Sequence[str], mask: int, leaving: Bits, ready: Parts[workers.Ready],
    ) -> Found:  # fmt: skip
        sources, ends = classes.own_sources(), classes.own_ends()
        crossed, opened = Crossed(self._likeness), _Opened(self._likeness)
        closed: list[ClosedByShipped] = []
        reasons, counts = grounds(ours, mask), Counts()
        for answer in answers:  # one at a time: together they can be more than memory holds
            crossed.within(answer.within)
            opened.add(answer)
            sources += answer.sources
            ends += answer.ends
            closed += answer.closed
            reasons |= answer.grounds
            counts += answer.counts
        crossed.between(sources, ends)
        groups, shares = crossed.tallies.groups(), crossed.tallies.shares
        mine = {v: e for v, e in enumerate(piece.graph.elements) if e.robot in (HUB, GATE)}
        core_open = workers.open_elements(replace(piece, border=tuple(mine)), ours, mask)
        closed += workers.doubtful(ours, mask, self._beyond(piece, at))
        shown = _one_of_each(closed, self._likeness)
        robots = {element.robot for group in groups for element in (group.pair.source, group.pair.leak)}
        robots |= {*opened.robots, *(row.channel.robot for row in shown)}
        unit = unit_of(split(self._task.groups)[1])
        needed = self._units | classes.bringers(groups, sources) | {unit[robot] for robot in robots if robot in unit}
        needed |= joined_to(needed, report.met, at, unit)
        lacking = reasons.lacking
        verdict = Verdict.of(
            leak=any(group.count.all > group.count.dismissed for group in groups),
            is_open=bool(opened.count or core_open),
            grounded=not lacking and not unread(report.diagnostics),
        )
        counts += counted(piece.graph, ours, self._likeness, (), mine)
        return Found(
            emitted=tuple(categories),
            verdict=verdict,
            lacking=lacking,
            groups=groups,
            deviants=different(shares, opened.at, self._likeness),
            units=frozenset(unit.values() if self._task.whole else needed),
            examples=frozenset(needed | crossed.examples | classes.all_bringers()),
            leaking=frozenset(r for r, some in shares.items() if not all(share.dismissed for share in some)),
            counts=replace(counts, flows=counts.flows + _flows_between(report)),
            report=report,
            likeness=self._likeness,
            leaving=leaving,
            parts=ready,
            core=(piece, ours),
            border=at,
            open=opened.count + len(core_open),
            closed=shown,
            broken=frozenset(e.robot for row in closed if row.rank is Rank.BREAKS for e in row.at),
        )

    def _beyond(self, piece: Piece, at: Border) -> list[int]:
        """The vertices of the core from which data goes on to other units."""
        onward = {
            element
            for flow, (from_core, _) in zip(self._fleet.flows, at.ends, strict=True)
            for element in (from_core if COLON in flow.target else ())
        }
        return [v for v, element in enumerate(piece.graph.elements) if element in onward or element.robot == HUB]


def _one_of_each(closed: Iterable[ClosedByShipped], likeness: Likeness) -> tuple[ClosedByShipped, ...]:
    """What shipped files close, of the first robot where they close the same before the same."""
    first: dict[object, ClosedByShipped] = {}
    for row in sorted(
        (row for row in closed if likeness.weight(row.channel.robot)), key=lambda row: row.channel.identity
    ):
        end = likeness.alike(row.end) if row.end else None
        first.setdefault((likeness.alike(row.channel), row.categories, end, row.rank), row)
    return tuple(first.values())


class _Opened:
    """What is open in the parts, put together one after the other.

    Attributes
    ----------
    count
        How many elements of the fleet.
    at
        Robot -> its open elements, without it; of robots that others of their model are compared with.
    robots
        Those that are shown for it: in order, each that has a kind of open element which none before has.
    """

    def __init__(self, likeness: Likeness) -> None:
        self.count = 0
        self.at: dict[str, frozenset[Element]] = {}
        self.robots: set[str] = set()
        self._likeness = likeness
        self._of_model = Counter(likeness.models.values())
        self._kinds: set[tuple[Element, tuple[str, ...]]] = set()

    def add(self, answer: workers.PartAnswer) -> None:
        sets = [frozenset(element for element, _ in some) for some in answer.sets]
        for robot, number in answer.open.items():
            weight = self._likeness.weight(robot)
            self.count += weight * len(sets[number])
            if self._of_model[self._likeness.models.get(robot, "")] > 1:
                self.at[robot] = sets[number]
            if weight and len(self.robots) < MOST_SHOWN and not answer.sets[number] <= self._kinds:
                self._kinds |= answer.sets[number]
                self.robots.add(robot)


def _flows_between(report: Report) -> int:
    """How many flows of the fleet file lead from one unit to another."""
    ends: tuple[dict[Lines, Counter[str]], ...] = (defaultdict(Counter), defaultdict(Counter))
    for lines, side, unit, weight in report.naming:
        ends[side][lines][unit] += weight
    pairs = [(many, others) for a, many in ends[0].items() for b, others in ends[1].items() if a & b]
    return sum(
        many.total() * others.total() - sum(weight * others[unit] for unit, weight in many.items())
        for many, others in pairs
    )
