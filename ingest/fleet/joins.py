"""What a fleet file joins to nothing: robots, infrastructure and domains, told by name (rules S1, S11).

In: a fleet, its groups, and on which robots its flows begin and end. Out: notices. Data that gets to what joins nothing
goes no further, and a domain that is misspelt looks like one that is meant.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.written_names import did_you_mean, nearest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot

Met = tuple[int, int, str]  # number of a flow of the fleet file; 0 where it begins, 1 where it ends; robot of the graph
JOINS_NOTHING = "joins-nothing"
LISTED = 10  # names in a message


def joins_nothing(fleet: Fleet, groups: Sequence[Alike], met: Iterable[Met]) -> tuple[Diagnostic, ...]:
    """Return a notice for each domain of one robot, for each infrastructure and for the robots that nothing joins.

    Notes
    -----
    Linear in the robots, and in the flows times the groups of robots that are alike.
    """
    return tuple(_Joins(fleet, groups, met).told())


class _Joins:
    """Who is joined to whom."""

    def __init__(self, fleet: Fleet, groups: Sequence[Alike], met: Iterable[Met]) -> None:
        self._groups = groups
        self._everyone = [*fleet.robots, *fleet.infrastructure]
        self._domains: dict[str, list[Robot]] = defaultdict(list)
        for robot in self._everyone:
            if robot.domain:
                self._domains[robot.domain].append(robot)
        self._ends: dict[int, tuple[set[str], set[str]]] = defaultdict(lambda: (set(), set()))
        for number, side, name in met:
            self._ends[number][side].add(name)

    def told(self) -> Iterator[Diagnostic]:
        """Yield the notices."""
        for name, members in sorted(self._domains.items()):
            if len(members) == 1 and len(self._everyone) > 1:
                yield self._domain(name, members[0])
        alone = [group for group in self._groups if not group.robots[0].domain and not self._joined(group)]
        for group in alone:
            if group.fixed:
                yield self._infrastructure(group.robots[0])
        robots = sorted(robot.id for group in alone if not group.fixed for robot in group.robots)
        if robots and len(self._everyone) > 1:
            yield self._robots(robots, min((r.place for g in alone if not g.fixed for r in g.robots), key=_line))

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
        others = {other.lower(): other for other in sorted(self._domains) if other != name}
        hint = did_you_mean([others[close] for close in nearest(name.lower(), others)])
        return _notice(robot.place, f"{what}; {hint}" if hint else what)

    def _infrastructure(self, robot: Robot) -> Diagnostic:
        what = f"infrastructure {shown(robot.id)} joins nothing: it names no domain, so it has one of its own"
        known = f"; domains here: {_listed(sorted(self._domains))}" if self._domains else ""
        return _notice(robot.place, f"{what}, and no flow of the fleet file leads to it or from it{known}")

    def _robots(self, names: Sequence[str], place: Place) -> Diagnostic:
        who = "1 robot joins nothing: it has" if len(names) == 1 else f"{len(names)} robots join nothing: each has"
        what = f"{who} a DDS domain of its own, and no flow of the fleet file names it together with anything else"
        return _notice(place, f"{what}: {_listed(names)}")


def _notice(place: Place, message: str) -> Diagnostic:
    return Diagnostic(place, Severity.NOTICE, message, JOINS_NOTHING)


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - LISTED:,} more" if len(names) > LISTED else ""
    return ", ".join(map(shown, names[:LISTED])) + more


def _line(place: Place) -> tuple[str, int]:
    return (place.file, place.line)
