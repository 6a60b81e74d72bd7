"""Rows of the register on a fleet: on which robots the findings of a row end, as decisions name them (rule S10).

In: patterns of a fleet. Out: the findings that rows are made of, one for each robot of the graph where some end; and
``RowRobots``. A decision names a row by the kind and the place without its robot, as it names a pattern of findings.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.model.register_row import RowRobots, row_id

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.model.register_row import RegisterRow


def row_pattern(category: str, place: Element, likeness: Likeness) -> str:
    """Return the id by which decisions name the row of a kind at a place, on whichever robot; of one robot its own.

    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> from rosprivacy.analysis.model import Element
    >>> likeness = Likeness({"amr-1": ("amr-1",), "amr-2": ("amr-2",)})
    >>> {row_pattern("Video", Element("storage", "disk", robot), likeness) for robot in likeness.members}
    {'d8fe0ef97d4b673d'}
    """
    return row_id(category, [likeness.alike(place)])


def row_ends(view: FleetView, findings: Iterable[Finding] = ()) -> tuple[tuple[Finding, Pattern], ...]:
    """Return the findings that rows are made of, each with its pattern: one for each robot of the graph where some end.

    Parameters
    ----------
    findings
        All of them, where all are made; else what is shown of a pattern stands, on each robot, for what ends there.

    Complexity: O(patterns x robots), or O(findings).

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> from rosprivacy.analysis.fleet.patterns import FleetView
    >>> view = FleetView.of(analyse(*factory("amr-1")), Likeness({"amr-1": ("amr-1", "amr-2")}))
    >>> [(finding.leak.robot, finding.leak.name, pattern.count) for finding, pattern in row_ends(view)][:2]
    [('amr-1', '/archive', 2), ('amr-1', 'disk', 2)]
    """
    if some := [finding for finding in findings if view.likeness.count(finding)]:
        patterns = {pattern.id: pattern for pattern in view.patterns}
        return tuple(
            (_at(finding, view.likeness.second.get(finding.leak.robot, finding.leak.robot)), patterns[key])
            for finding in some
            if (key := pattern_id(finding, view.likeness)) in patterns
        )
    return tuple((finding, pattern) for pattern in view.patterns for finding in _at_each(pattern, view.likeness))


def _at(finding: Finding, robot: str) -> Finding:
    return replace(finding, leak=replace(finding.leak, robot=robot))


def _at_each(pattern: Pattern, likeness: Likeness) -> Iterator[Finding]:
    """What is shown of a pattern, on each robot as what stands most there."""
    if not likeness.is_robot(pattern.finding.leak.robot):
        yield pattern.finding
        return
    for form, robots in pattern.end_forms if pattern.across else pattern.forms:
        for robot in robots:
            if robot in likeness.members:  # it stands for those that are alike
                yield replace(_at(pattern.finding, robot), **form._asdict())


def on_robots(
    rows: Iterable[RegisterRow], view: FleetView, ends: Iterable[tuple[Finding, Pattern]]
) -> tuple[RegisterRow, ...]:
    """Return the rows with their robots, and of findings those that are shown.

    Parameters
    ----------
    ends
        Of ``row_ends``, of which the rows are made.

    Complexity: O(rows x findings of a row x robots).

    >>> from rosprivacy.analysis.contexts import Contexts
    >>> from rosprivacy.analysis.example import CATEGORIES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.findings.register import Statements, register
    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> from rosprivacy.analysis.fleet.patterns import FleetView
    >>> graph, bound, hierarchy = factory("amr-1")
    >>> analysis, stated = analyse(graph, bound, hierarchy), Contexts({}, CATEGORIES)
    >>> rows = register(analysis, Statements(bound, (), stated, hierarchy, lambda kind, *where: ()))
    >>> view = FleetView.of(analysis, Likeness({"amr-1": ("amr-1", "amr-2")}))
    >>> [row.fleet.robots for row in on_robots(rows, view, row_ends(view)) if row.category == "Video"]
    [('amr-1', 'amr-2'), ('amr-1', 'amr-2')]
    """
    of_finding = {finding.id: pattern for finding, pattern in ends}
    place = {pattern.id: number for number, pattern in enumerate(view.patterns)}
    return tuple(_with_robots(row, of_finding, place, view.likeness) if row.findings else row for row in rows)


def _with_robots(
    row: RegisterRow, of_finding: Mapping[str, Pattern], place: Mapping[str, int], likeness: Likeness
) -> RegisterRow:
    patterns = sorted(
        {(pattern := of_finding[one]).id: pattern for one in row.findings}.values(), key=lambda p: place[p.id]
    )
    places = {robot for at in row.places for robot in likeness.placed(at.robot)}
    robots = _robots_of(row_pattern(row.category, row.places[0], likeness), patterns, places)
    return replace(row, findings=tuple(pattern.finding.id for pattern in patterns), fleet=robots)


def row_robots(view: FleetView) -> Mapping[str, RowRobots]:
    """Return the robots of all rows that decisions name alike, by that name.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> from rosprivacy.analysis.fleet.patterns import FleetView
    >>> view = FleetView.of(analyse(*factory("amr-1")), Likeness({"amr-1": ("amr-1", "amr-2")}))
    >>> row_robots(view)["d8fe0ef97d4b673d"].robots  # of videos on the disk of each
    ('amr-1', 'amr-2')
    """
    rows: dict[str, list[Pattern]] = defaultdict(list)
    for pattern in view.patterns:
        rows[row_pattern(pattern.finding.category, pattern.finding.leak, view.likeness)].append(pattern)
    everyone = {robot for robots in view.likeness.members.values() for robot in robots}
    return {key: _robots_of(key, patterns, everyone) for key, patterns in rows.items()}


def _robots_of(name: str, patterns: Iterable[Pattern], places: set[str]) -> RowRobots:
    """Return the robots of a row.

    Parameters
    ----------
    name
        Of ``row_pattern``.
    places
        The robots of its places; none where the place is on no robot.
    """
    robots: set[str] = set()
    begins: set[str] = set()
    across = False
    for pattern in patterns:
        if pattern.across:
            across = True
            robots.update(robot for _, some in pattern.end_forms for robot in some if robot in places)
            begins.update(pattern.robots)
        else:
            some = places.intersection(pattern.robots) if places else set(pattern.robots)
            robots |= some
            begins |= some
    return RowRobots(name, tuple(sorted(robots)), tuple(sorted(begins)) if across else ())
