"""Robots -> groups of robots that are alike, so that each is read and analysed once (rule S10).

In: a fleet. Out: its robots by what they run and how they take part. Two robots are alike if they can change places and
nothing changes but their names: policies, label files and types that are read alike, no namespace of their own in a
shared domain or in their own absolute names, and every line about flows means both or neither. Whether a policy is read
alike elsewhere is seen by what the parser finds in it: one that includes nothing is its content, any other the file
itself.
"""

from __future__ import annotations

import hashlib
from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.written_names import bare_name, is_glob
from rosprivacy.ingest.fleet.dds_domains import pseudo_robot
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.policies.names import matcher
from rosprivacy.ingest.policies.namespaces import depends
from rosprivacy.ingest.policies.policy_files import read_policies
from rosprivacy.ingest.policies.xinclude import stands_alone
from rosprivacy.ingest.reading.bounded_file import contents
from rosprivacy.ingest.reading.path_kinds import is_file

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable

    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot

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

    def apart(self, files: Collection[str]) -> list[Alike]:
        """Return them in parts: together are those that read the same ones of some files."""
        parts: dict[object, list[Robot]] = defaultdict(list)
        for robot in self.robots:
            parts[tuple(file for file in robot.files if file in files)].append(robot)
        return [replace(self, robots=tuple(robots)) for robots in parts.values()]

    def parted(self, robots: Collection[str]) -> list[Alike]:
        """Return those that are among some robots, and those that are not."""
        parts = [[one for one in self.robots if (one.id in robots) == inside] for inside in (True, False)]
        return [replace(self, robots=tuple(part)) for part in parts if part]


def alike(fleet: Fleet, told_apart: Callable[[str], object] = lambda _: None) -> tuple[Alike, ...]:
    """Group the robots of a fleet; infrastructure stands alone.

    Parameters
    ----------
    told_apart
        Robots for which this function returns different values are kept apart, such as those that a decision names.

    Notes
    -----
    Linear in robots times ends of flows.
    """
    ends = sorted({end for flow in fleet.flows for end in (flow.source, flow.target) if COLON in end})
    tests = [_test(end.partition(COLON)[0]) for end in ends]
    domains: dict[str, int] = defaultdict(int)
    for robot in (*fleet.robots, *fleet.infrastructure):
        domains[robot.domain] += 1
    groups: dict[object, list[Robot]] = defaultdict(list)
    joined: dict[object, bool] = {}
    runs = _Contents(file for robot in fleet.robots for file in robot.policies)
    for robot in fleet.robots:
        means = tuple(i for i, test in enumerate(tests) if test(robot.id))
        several = bool(robot.domain) and domains[robot.domain] > 1
        alone = robot.id if several and (robot.strip or robot.add) else runs.namespace(robot)
        key = (
            robot.model, runs.of(robot), robot.domain, robot.strip, alone, means, told_apart(robot.id),
            robot.surroundings,
        )  # fmt: skip
        groups[key].append(robot)
        joined[key] = bool(means) or several
    found = [Alike(tuple(robots), joined[key]) for key, robots in groups.items()]
    found += [Alike((robot,), joined=True, fixed=True) for robot in fleet.infrastructure]
    return tuple(sorted(found, key=lambda group: group.robots[0].id))


def _test(robots: str) -> Callable[[str], bool]:
    return matcher(robots) if is_glob(robots) else lambda name: name == bare_name(robots)


def chosen(end: str, robots: Iterable[str]) -> list[str]:
    """Return the robots that the end of a flow means, before its colon."""
    test = _test(end.partition(COLON)[0])
    return [robot for robot in robots if test(robot)]


def known_to_flows(fleet: Fleet) -> list[str]:
    """Return every name that can stand before the colon of a flow's end."""
    everyone = (*fleet.robots, *fleet.infrastructure)
    return [*(robot.id for robot in everyone), *sorted({pseudo_robot(r.domain) for r in everyone if r.domain})]


class _Contents:
    """What stands for files when robots are compared; each is read once, and parsed only if another has its content."""

    def __init__(self, policies: Iterable[str]) -> None:
        self._digests = {file: digest(file) for file in dict.fromkeys(policies)}
        self._shared = {digest for digest, files in Counter(self._digests.values()).items() if files > 1}
        self._labels: dict[str, str] = {}
        self._alone: dict[str, bool] = {}
        self._parsed: dict[tuple[str, ...], tuple[Policy, ...] | None] = {}

    def of(self, robot: Robot) -> tuple[tuple[str, ...], ...]:
        """Return what stands for all that is read for a robot."""
        labels = (tuple(map(self._label_file, files)) for files in (robot.labels, robot.own))
        return (tuple(map(self._policy, robot.policies)), *labels, tuple(map(self._label_file, robot.types)))

    def namespace(self, robot: Robot) -> str:
        """Return the namespace that is pushed on a robot, where it matters which it is (rule S1)."""
        if not robot.add:
            return ""
        key = tuple(map(self._policy, robot.policies))
        if key not in self._parsed:
            try:
                self._parsed[key] = read_policies(robot.policies)[0]
            except InputErrors:  # whoever reads them with the options of the user says what is wrong
                self._parsed[key] = None
        policies = self._parsed[key]
        return robot.add if policies is None or depends(policies, robot.add) else ""

    def _policy(self, file: str) -> str:
        """The content, or the path of a folder or glob, and of a policy with which others may be read (rule S10)."""
        content = self._digests[file]
        if content not in self._shared:
            return file  # nothing else is like it
        if content not in self._alone:
            data = _bytes(file)
            self._alone[content] = data is not None and stands_alone(data)
        return content if self._alone[content] else file

    def _label_file(self, file: str) -> str:
        """The content; the name of one that comes with the program."""
        if file not in self._labels:
            self._labels[file] = file if file.startswith(OURS) else digest(file) or file
        return self._labels[file]


def digest(file: str) -> str:
    """Return the SHA-256 of what is in a file; empty where there is none to be read."""
    data = _bytes(file)
    return "" if data is None else hashlib.sha256(data).hexdigest()


def _bytes(file: str) -> bytes | None:
    """What is in a file; None where there is none to be read, which its reader will tell."""
    path = Path(file)
    try:
        return contents(path) if is_file(path) else None
    except OSError:
        return None
