"""To which label file of a fleet an answer goes, and about how many robots it then is (rule S10).

In: a fleet, and groups of robots that are alike. Out: ``Target``; robots that are not as most of their model.
"""

from __future__ import annotations

import os
from collections import defaultdict
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.explorer.own_file import chosen
from rosprivacy.ingest.fleet.dds_domains import pseudo_robot
from rosprivacy.ingest.labels.label_file import OURS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot


class Target(NamedTuple):
    """A label file that an answer can go to.

    Attributes
    ----------
    file
        As the fleet file leads to it.
    robots
        All that read it, by id.
    models
        Of these robots; none of those without a model.
    alone
        Whether it is a file of the robot itself, and not of its model.
    """

    file: str
    robots: tuple[str, ...]
    models: tuple[str, ...]
    alone: bool


class Entry(NamedTuple):
    """What a label file says of an element or a glob.

    Attributes
    ----------
    target
        The label file of a fleet; None where a session edits one only.
    """

    section: str
    name: str
    value: Any
    target: Target | None = None


class Targets:
    """The label files of a fleet, with the robots that read them.

    Attributes
    ----------
    fleet
        As it was read.
    """

    def __init__(self, fleet: Fleet) -> None:
        self.fleet = fleet
        self._robots = {robot.id: robot for robot in (*fleet.robots, *fleet.infrastructure)}
        self._readers: dict[str, dict[str, Robot]] = defaultdict(dict)
        self._chosen: dict[tuple[str, ...], int | None] = {}
        self._names: dict[str, set[tuple[str, bool]]] = defaultdict(set)
        for robot in self._robots.values():
            for files, alone in ((robot.labels, False), (robot.own, True)):
                for file in (file for file in files if not file.startswith(OURS)):
                    self._readers[os.path.realpath(file)][robot.id] = robot
                    self._names[os.path.realpath(file)].add((file, alone))

    def called(self, file: str) -> tuple[tuple[str, bool], ...]:
        """Return by which names the fleet file leads to a label file, and whether as one of a robot."""
        return tuple(sorted(self._names.get(os.path.realpath(file), ())))

    def readers(self, file: str) -> tuple[str, ...]:
        """Return the robots that read a label file, by id."""
        return tuple(self._readers.get(os.path.realpath(file), ()))

    def of(self, robot: str) -> tuple[Target, ...]:
        """Return the files for an element of a robot: that of its model, and its own; none where neither has one.

        For a domain these are the files of the robots in it; what the fleet file itself states has none.
        """
        found: dict[str, Target] = {}
        for one in self._of(robot):
            for files, alone in ((one.labels, False), (one.own, True)):
                if files not in self._chosen:
                    self._chosen[files] = chosen(files)  # which looks into them
                at = self._chosen[files]
                if at is not None:
                    found.setdefault(os.path.realpath(files[at]), self._target(files[at], alone=alone))
        return tuple(sorted(found.values(), key=lambda target: target.alone))

    def _of(self, robot: str) -> Iterable[Robot]:
        if robot in self._robots:
            return (self._robots[robot],)
        return (one for one in self._robots.values() if one.domain and pseudo_robot(one.domain) == robot)

    def _target(self, file: str, *, alone: bool) -> Target:
        readers = self._readers[os.path.realpath(file)]
        models = dict.fromkeys(robot.model for robot in readers.values() if robot.model)
        return Target(file, tuple(readers), tuple(models), alone)


def outliers(groups: Iterable[Alike]) -> frozenset[str]:
    """Return the robots that are not read as most robots of their model are: other policies, labels, or flows."""
    of_model: Mapping[str, list[Alike]] = defaultdict(list)
    for group in groups:
        if group.robots[0].model and not group.fixed:
            of_model[group.robots[0].model].append(group)
    found: set[str] = set()
    for parts in of_model.values():
        usual = max(parts, key=lambda part: len(part.robots))
        found.update(robot.id for part in parts if part is not usual for robot in part.robots)
    return frozenset(found)
