"""What parts found out -> what a report shows: the ways of one pair of each pattern, on the graph of a few robots.

In: patterns without ways, and the units in which they lie. Out: an ``Analysis`` of these units and of what all share,
and the view of the whole fleet. Units that bring data to the border are among them, so what is at their elements is
what is there in the whole fleet.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.findings.open_questions import lacking
from rosprivacy.analysis.fleet.patterns import FleetView, patterns_of
from rosprivacy.ingest.fleet.fleet_graph import place_chosen
from rosprivacy.parts.units import split

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, NonRosFacts
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.ingest.fleet.fleet_graph import Placed
    from rosprivacy.parts.distributed import Found, Task
    from rosprivacy.parts.workers import Read, Report

Choice = dict[int, set[tuple[str, int, int, bool]]]


@dataclass(frozen=True, slots=True)
class ShownRobots:
    """What a report tells of the robots that are shown, beside their graph."""

    analysis: Analysis
    view: FleetView


def place_shown(task: Task, whole: Found) -> tuple[Placed, dict[str, Member]]:
    """Place the robots that are shown; return them also by id of the first robot of each group."""
    fixed, units = split(task.groups)
    needed = whole.units or {unit.name for unit in units[:1]}
    groups = [*fixed, *(group for unit in units if unit.name in needed for group in unit.groups)]
    placed, members = place_groups(task.fleet, groups, task.reader(), task.view, whole.shared)
    return replace(placed, bound=surrounded(placed, whole.report)), members


def shown(task: Task, whole: Found, placed: Placed, paths: str, max_paths: int) -> ShownRobots:
    """Look for the ways of what is shown.

    Parameters
    ----------
    placed
        The robots that are shown.

    Notes
    -----
    A way is a shortest one among these: those at its ends, those that bring data to what is shared, and what is shared.
    """

    def choose(spread: Spread, kinds: Sequence[Concern], mask: int) -> Choice:
        del kinds, mask
        vertex = {element: number for number, element in enumerate(spread.graph.elements)}
        wanted: Choice = defaultdict(set)
        for group in whole.groups:
            kind, category, source, leak, beside = group.pair
            wanted[vertex[source]].add((kind, vertex[leak], spread.categories.index(category), beside))
        return dict(wanted)

    options = Options(task.categories, paths, max_paths, choose=choose, today=task.today, bounds=task.fleet.bounds)
    analysis = analyse(placed.graph, placed.bound, task.hierarchy, options)
    view = FleetView(whole.likeness, patterns_of(whole.groups, analysis.findings), whole.deviants)
    told = tuple(said for said in analysis.diagnostics if said.code != analysis.lacking or not said.code)
    if whole.verdict is Verdict.UNDETERMINED and not whole.open:
        told += lacking(whole.lacking, restricted=task.categories is not None)
    analysis = replace(analysis, verdict=whole.verdict, emitted=whole.emitted, lacking=whole.lacking, diagnostics=told)
    known = {row.channel.identity: row for row in (*whole.closed, *analysis.closed_by_shipped)}
    analysis = replace(analysis, closed_by_shipped=tuple(known[key] for key in sorted(known)))
    return ShownRobots(analysis, view)


def place_groups(
    fleet: Fleet, groups: Sequence[Alike], read: Read, view: str, shared: Mapping[Element, NonRosFacts]
) -> tuple[Placed, dict[str, Member]]:
    """Place some robots; for what is shared the limits of every robot hold, also of those that are not placed."""
    members = {group.robots[0].id: read(group.robots[0]) for group in groups}
    placed = place_chosen(fleet, groups, members, view)
    elements = placed.graph.elements
    outside = {vertex: shared.get(elements[vertex], facts) for vertex, facts in placed.bound.outside.items()}
    return replace(placed, bound=replace(placed.bound, outside=outside)), members


def surrounded(placed: Placed, report: Report) -> Bound:
    """Return what is said, with the surroundings of robots that are not placed: a finding stands for these too."""
    return replace(placed.bound, elsewhere=by_name(report.contexts), scopes=by_name(report.scopes))


def by_name(rows: Iterable[tuple[str, str, str]]) -> dict[tuple[str, str], frozenset[str]]:
    """Return what is said of elements of one kind and name together."""
    said: dict[tuple[str, str], set[str]] = defaultdict(set)
    for kind, name, fact in sorted(rows):
        said[kind, name].add(fact)
    return {key: frozenset(facts) for key, facts in said.items()}
