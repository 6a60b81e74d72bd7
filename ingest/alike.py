"""Robots -> groups of robots that are alike, so that each is read and analysed once (rule S10).

In: a fleet. Out: its robots by what they run and how they take part. Two robots are alike if they can change places and
nothing changes but their names: equal policies and label files, no namespace of their own in a shared domain, and
every line about flows means both or neither.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.ingest.domains import pseudo_robot
from rosprivacy.ingest.names import is_pattern, matcher
from rosprivacy.ingest.regular import contents

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rosprivacy.ingest.fleet import Fleet, Robot

COLON = ":"  # between robots and name, at the end of a flow


@dataclass(frozen=True, slots=True)
class Alike:
    """Robots that are alike.

    Attributes
    ----------
    robots
        By id, sorted.
    joined
        Whether anything is between them and others: a flow, or a domain that they share.
    fixed
        Whether it is infrastructure, which is not counted as a robot.
    """

    robots: tuple[Robot, ...]
    joined: bool
    fixed: bool = False

    @property
    def placed(self) -> tuple[Robot, ...]:
        """Those that stand for all: two where data can go from one to another, else one.

        A way between two robots, or from one back to itself, that passes others can take the second of these
        instead, step by step.
        """
        return self.robots[: 2 if self.joined else 1]


def alike(fleet: Fleet, told_apart: Callable[[str], object] = lambda _: None) -> tuple[Alike, ...]:
    """Group the robots of a fleet; infrastructure stands alone.

    Parameters
    ----------
    told_apart
        Robots of which this is not the same are not alike, such as those that a decision names.

    Notes
    -----
    Linear in robots times ends of flows.
    """
    ends = sorted({end for flow in fleet.flows for end in (flow.source, flow.target) if COLON in end})
    tests = [_test(end.partition(COLON)[0]) for end in ends]
    domains: dict[str, int] = defaultdict(int)
    for robot in (*fleet.robots, *fleet.infrastructure):
        domains[robot.domain] += 1
    content = cache(_content)  # as long as this call: a file may change between two
    groups: dict[object, list[Robot]] = defaultdict(list)
    joined: dict[object, bool] = {}
    for robot in fleet.robots:
        means = tuple(i for i, test in enumerate(tests) if test(robot.id))
        several = bool(robot.domain) and domains[robot.domain] > 1
        alone = robot.id if several and (robot.strip or robot.add) else ""
        runs = tuple(tuple(map(content, files)) for files in (robot.policies, robot.labels, robot.own))
        key = (robot.model, runs, robot.domain, robot.strip, alone, means, told_apart(robot.id))
        groups[key].append(robot)
        joined[key] = bool(means) or several
    found = [Alike(tuple(robots), joined[key]) for key, robots in groups.items()]
    found += [Alike((robot,), joined=True, fixed=True) for robot in fleet.infrastructure]
    return tuple(sorted(found, key=lambda group: group.robots[0].id))


def _test(robots: str) -> Callable[[str], bool]:
    return matcher(robots) if is_pattern(robots) else lambda name: name == robots


def chosen(end: str, robots: Iterable[str]) -> list[str]:
    """Return the robots that the end of a flow means, before its colon."""
    test = _test(end.partition(COLON)[0])
    return [robot for robot in robots if test(robot)]


def known_to_flows(fleet: Fleet) -> list[str]:
    """Return every name that can stand before the colon of a flow's end."""
    everyone = (*fleet.robots, *fleet.infrastructure)
    return [*(robot.id for robot in everyone), *sorted({pseudo_robot(r.domain) for r in everyone if r.domain})]


def _content(file: str) -> str:
    """What stands for a file: its content, or its path where others may be read with it."""
    path = Path(file)
    if not path.is_file():
        return file
    data = contents(path)
    return file if b"include" in data else hashlib.sha256(data).hexdigest()
