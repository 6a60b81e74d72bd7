"""What a fleet file joins to nothing: infrastructure and domains, told by name (rules S1, S11).

In: a fleet, its groups, on which robots its flows begin and end, and which of them let data out. Out: warnings; a
notice on the robots of which nobody says in which domain they are. Data that gets to what joins nothing goes no
further, and a domain that is misspelt looks like one that is meant.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import JOINS_NOTHING, LEAK_JOINS_NOTHING, NO_ROBOT, OWN_DOMAINS, Diagnostic, Severity
from rosprivacy.analysis.written_names import did_you_mean, listed, nearest

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Element, Place, Statement
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot

Met = tuple[int, int, str]  # number of a flow of the fleet file; 0 where it begins, 1 where it ends; robot of the graph
OF_FLEET = (JOINS_NOTHING, LEAK_JOINS_NOTHING, NO_ROBOT, OWN_DOMAINS)
ALONE = "leave the domain out if it is meant to be alone"


def let_out(elements: Iterable[tuple[Element, Iterable[Statement]]]) -> frozenset[str]:
    """Return the robots at which data is let out or kept, if it gets there: at a leak or a storage."""
    return frozenset(
        element.robot
        for element, said in elements
        if element.kind == "storage" or any(statement.role == "leak" for statement in said)
    )


def joins_nothing(
    fleet: Fleet, groups: Sequence[Alike], met: Iterable[Met], letting_out: Collection[str]
) -> tuple[Diagnostic, ...]:
    """Return what is to be said of the file, and a warning for each domain and infrastructure that joins nothing.

    Parameters
    ----------
    letting_out
        Robots, as of ``let_out``: if nothing joins one of them, that breaks the verdict.

    Notes
    -----
    Linear in the robots, and in the flows times the groups of robots that are alike.
    """
    return (*fleet.diagnostics, *_Joins(fleet, groups, met, letting_out).diagnostics())


class _Joins:
    """Who is joined to whom."""

    def __init__(self, fleet: Fleet, groups: Sequence[Alike], met: Iterable[Met], letting_out: Collection[str]) -> None:
        self._groups = groups
        self._first = {group.robots[0].id: group for group in groups}
        self._letting_out = letting_out
        self._everyone = [*fleet.robots, *fleet.infrastructure]
        self._domains: dict[str, list[Robot]] = defaultdict(list)
        for robot in self._everyone:
            if robot.domain:
                self._domains[robot.domain].append(robot)
        self._ends: dict[int, tuple[set[str], set[str]]] = defaultdict(lambda: (set(), set()))
        for number, side, name in met:
            self._ends[number][side].add(name)

    def diagnostics(self) -> Iterator[Diagnostic]:
        """Yield what is to be said."""
        for name, members in sorted(self._domains.items()):
            if len(members) == 1 and len(self._everyone) > 1:
                yield self._domain(name, members[0])
        for group in self._groups:
            if group.fixed and not group.robots[0].domain and not self._joined(group):
                yield self._infrastructure(group.robots[0])
        robots = [robot for group in self._groups if not group.fixed for robot in group.robots if not robot.domain]
        if robots and len(self._everyone) > 1:
            several = f"{len(robots):,} robots are taken to be in domains of their own"
            who = "1 robot is taken to be in a domain of its own" if len(robots) == 1 else several
            what = f"{who}; ROS 2 puts all into domain 0: {listed(sorted(robot.id for robot in robots))}"
            yield Diagnostic(min((r.place for r in robots), key=_line), Severity.NOTICE, what, OWN_DOMAINS)

    def _joined(self, group: Alike) -> bool:
        """Whether a flow leads from these robots to something else, or from there to them."""
        return any(
            robot.id in ends[side] and ends[1 - side] - {robot.id}
            for ends in self._ends.values()
            for side in (0, 1)
            for robot in group.placed
        )

    def _domain(self, name: str, robot: Robot) -> Diagnostic:
        what = f"domain {shown(name)} joins nothing: {shown(robot.id)} is alone in it"
        hint = did_you_mean(nearest(name, [other for other in sorted(self._domains) if other != name]), ALONE)
        return self._nothing(robot, f"{what}; {hint}", joined=self._joined(self._first[robot.id]))

    def _infrastructure(self, robot: Robot) -> Diagnostic:
        what = f"infrastructure {shown(robot.id)} joins nothing: it names no domain, so it has one of its own"
        known = f"; domains here: {listed(sorted(self._domains))}" if self._domains else ""
        return self._nothing(robot, f"{what}, and no flow of the fleet file leads to it or from it{known}")

    def _nothing(self, robot: Robot, message: str, *, joined: bool = False) -> Diagnostic:
        if joined or robot.id not in self._letting_out:
            return Diagnostic(robot.place, Severity.WARNING, message, JOINS_NOTHING)
        message += f"; data of others that got to {shown(robot.id)} would be let out or kept there"
        return Diagnostic(robot.place, Severity.WARNING, message, LEAK_JOINS_NOTHING)


def _line(place: Place) -> tuple[str, int]:
    return (place.file, place.line)
