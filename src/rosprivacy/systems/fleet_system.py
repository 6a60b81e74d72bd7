"""A fleet: fleet file -> each kind of robot once -> one graph -> ``System``.

In: a fleet file. Out: ``FleetSystem``. Robots that are alike are read once.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.answering import answer
from rosprivacy.assumptions import assumptions_of, files_read, remembered, types_read
from rosprivacy.ingest.fleet.alike_robots import Alike, alike
from rosprivacy.ingest.fleet.fleet_file import Fleet, read_fleet
from rosprivacy.ingest.fleet.fleet_graph import Placed, place
from rosprivacy.ingest.fleet.joins import joins_nothing, let_out
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from rosprivacy.ingest.neo4j_graph.fleet_rows import FleetRows
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, PolicyChange
from rosprivacy.question import question_of
from rosprivacy.robot_doubts import breaking, doubt_lines, doubts_by_robot
from rosprivacy.system import System
from rosprivacy.systems.robot_reader import RobotReader, Tried
from rosprivacy.systems.robot_system import beyond_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from rosprivacy.analysis.model import Diagnostic
    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetSystem(System):
    """A system of many robots.

    Attributes
    ----------
    members
        By id of the first robot of each group.
    joins
        Those of the diagnostics that say what joins nothing.
    """

    fleet: Fleet
    groups: tuple[Alike, ...]
    members: dict[str, Member]
    placed: Placed
    joins: tuple[Diagnostic, ...]


def answer_fleet(file: str, settings: Settings) -> Result:
    """Read a fleet file and what it names, and analyse it.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    question = question_of(settings)
    return answer(fleet_system(file, question), question)


def fleet_system(file: str, question: Question) -> FleetSystem:
    """Read a fleet file and what it names, each kind of robot once; see ``fleet_reader``."""
    return fleet_reader(file, question)(NO_CHANGE)


def fleet_reader(file: str, question: Question) -> Callable[[PolicyChange], FleetSystem]:
    """Read a fleet file and what it names, each kind of robot once; return what makes a system of it with a change.

    Parameters and errors as of ``read_once``.
    """
    return read_once(file, question).system


def read_once(file: str, question: Question) -> FleetRead:
    """Read a fleet file; what it names is read when a system is made, once.

    Parameters
    ----------
    question
        Robots about which somebody decided by name are alike to no other.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    settings = question.settings
    fleet = read_fleet(file, question.vocabulary, include_root=settings.include_root, bounds=settings.bounds)
    reader = RobotReader(question.vocabulary, settings, fleet.root)
    return FleetRead(fleet, _groups(fleet, question), reader, question)


def _groups(fleet: Fleet, question: Question) -> tuple[Alike, ...]:
    return alike(fleet, question.decisions.told_apart) if question.decisions else alike(fleet)


@dataclass(frozen=True, slots=True)
class FleetRead:
    """A fleet file that was read: systems are made of it, with a change of policies or under other labels."""

    fleet: Fleet
    groups: tuple[Alike, ...]
    reader: RobotReader
    question: Question

    def system(self, change: PolicyChange = NO_CHANGE) -> FleetSystem:
        """Return the fleet, if its policies had a change."""
        return _system(self.fleet, self.groups, self.reader, change, self.question)

    def under(self, labels: Mapping[tuple[str, bool], Labels], edited: Collection[str]) -> FleetSystem:
        """Return the fleet with labels in the place of what files say; of the others what was read stays.

        Parameters
        ----------
        labels
            By name of the file, and whether it is read as that of a robot, which outranks its model's.
        edited
            Files that say something else than on the disk: robots that do not read the same ones of them are no longer
            alike.

        Raises
        ------
        InputErrors
            If labels name what is not there, or contradict others.
        """
        self.reader.relabel(labels)
        groups = tuple(part for group in self.groups for part in group.apart(edited))
        return _system(self.fleet, groups, self.reader, NO_CHANGE, self.question)

    def tried(
        self, labels: Mapping[tuple[str, bool], Labels], edited: Collection[str], robots: Collection[str], tried: Tried
    ) -> tuple[FleetSystem, list[InputError]]:
        """Return the fleet under labels if something were otherwise on some robots, and labels of what is gone then.

        Parameters
        ----------
        labels, edited
            As of ``under``.
        robots
            By id: they are no longer alike to others.

        Raises
        ------
        InputErrors
            If what is tried, or a flow of the fleet file, names what is not there.
        """
        self.reader.relabel(labels)
        other = self.reader.trying(tried)
        parts = [part for group in self.groups for part in group.apart(edited)]
        groups = tuple(part for some in parts for part in some.parted(robots))
        system = _system(self.fleet, groups, self.reader, NO_CHANGE, self.question, dict.fromkeys(robots, other))
        return system, other.missing

    def read_again(self) -> FleetRead:
        """Return the same with robots compared anew, by what their files hold now.

        What a file holds that somebody else changed is not what was read: who reads it is like nobody else.
        """
        groups = _groups(self.fleet, self.question)
        other = self.reader.changed()
        return replace(self, groups=tuple(part for group in groups for part in group.apart(other)))


def _system(
    fleet: Fleet, groups: tuple[Alike, ...], reader: RobotReader, change: PolicyChange, question: Question,
    readers: Mapping[str, RobotReader] = {},
) -> FleetSystem:  # fmt: skip
    """Make the system; some robots, by id, have a reader of their own."""
    settings, members = question.settings, {}
    problems: list[InputError] = []
    for group in groups:
        try:
            one = readers.get(group.robots[0].id, reader)
            members[group.robots[0].id] = one.member(group.robots[0], change)
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    placed = place(fleet, groups, members, settings.view)
    there = {key: reader.labels[key] for group in groups for key in reader.label_files(group.robots[0])}
    labels = tuple(sorted(there.values(), key=lambda labels: (labels.file, labels.own)))
    elements = placed.graph.elements
    letting_out = let_out((one, placed.bound.elements.get(vertex, ())) for vertex, one in enumerate(elements))
    joins = joins_nothing(fleet, groups, placed.met, letting_out)
    told = Counter(d for member in members.values() for d in member.diagnostics)
    read = Counter(file.file for member in members.values() for file in member.files)
    said = (d for d, count in told.items() if d.code != PIN_OF_NOTHING or count == read[d.place.file])
    diagnostics = dict.fromkeys((*said, *joins))
    policies = [policy for member in members.values() for policy in member.policies]
    files = [{"file": name, "sha256": digest} for name, digest in fleet.sources]
    seen = {one.file: one for member in members.values() for one in member.types}
    types = tuple(one for _, one in sorted(seen.items()))
    files_by_robot = {robot.id: (*robot.labels, *robot.own) for group in groups for robot in group.robots}
    return FleetSystem(
        placed.graph, placed.bound, question.vocabulary, tuple(diagnostics),
        {**files_read(policies, labels, settings), **types_read(types), "fleet": files},
        tuple({policy.file: policy for policy in policies}.values()), labels, placed.likeness, is_fleet=True,
        fleet=fleet, groups=groups, members=members, placed=placed, joins=joins, label_files=files_by_robot,
    )  # fmt: skip


def rows_of_fleet(
    system: FleetSystem, question: Question, result: Result, *, without_standard: bool = False
) -> FleetRows:
    """Return the rows of all robots for the database; with each goes what its part of the answer rests on.

    Parameters
    ----------
    result
        With every finding, or those of ``most_across``, about all categories.
    without_standard
        Whether the channels that only the standard file speaks of are left out.
    """
    elements, first = system.graph.elements, system.likeness.second
    files_of: dict[str, tuple[Diagnostic, ...]] = {element.robot: () for element in elements}
    files_of |= {name: member.diagnostics for name, member in system.members.items()}
    told = doubts_by_robot(
        result.doubts, files_of, system.graph, system.likeness, lambda one: first.get(one.robot, one.robot)
    )
    more: dict[str, dict[str, str | list[str]]] = {
        name: {"doubts": doubt_lines(doubts)} for name, doubts in told.items()
    }
    for name, member in system.members.items():
        files = files_read(member.policies, member.files, question.settings)
        said = assumptions_of({**files, **types_read(member.types)}, result.analysis, question)
        more[name] = remembered(said, (*member.diagnostics, *system.joins), doubt_lines(told[name]))
    everything = {**result.assumptions, "policies": [], "labels": [], "types": []}
    more[system.fleet.name] = remembered(everything, system.joins, doubt_lines(told.get(system.fleet.name, ())))
    assert result.fleet is not None, "the answer about a fleet"
    across = {pattern.id: pattern.count for pattern in result.fleet.patterns if pattern.across}
    return FleetRows(
        system.placed,
        result.analysis,
        system.vocabulary,
        more,
        not_read=breaking(told),
        beyond=beyond_of(result),
        most_across=question.most_across,
        counts=None if question.most_across is None else across,
        without_standard=without_standard,
    )
