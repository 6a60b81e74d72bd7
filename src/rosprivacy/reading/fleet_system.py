"""A fleet: fleet file -> each kind of robot once -> one graph -> ``System``.

In: a fleet file. Out: ``FleetSystem``. Robots that are alike are read once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.model import unread
from rosprivacy.analysis.suggesting.outdated_reasons import outdated_reasons
from rosprivacy.answering import answer
from rosprivacy.assumptions import assumptions_of, files_read, remembered, types_read
from rosprivacy.ingest.database.fleet_rows import FleetRows
from rosprivacy.ingest.fleet.alike_robots import Alike, alike
from rosprivacy.ingest.fleet.dds_domains import Member, stripped
from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot, read_fleet
from rosprivacy.ingest.fleet.fleet_graph import Placed, place
from rosprivacy.ingest.fleet.joins import joins_nothing
from rosprivacy.ingest.keystore.exposed import with_exposed
from rosprivacy.ingest.labels.add_non_ros import extend
from rosprivacy.ingest.labels.bag_storages import told_of_bags
from rosprivacy.ingest.labels.binding import bind, remarks
from rosprivacy.ingest.labels.label_file import Labels, read_labels
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, Change, changed
from rosprivacy.ingest.policies.comparisons import careful_notices
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.joint_policies import joint_warnings
from rosprivacy.ingest.policies.merged_policies import OF_ONE_ROBOT, merging_notices
from rosprivacy.ingest.policies.namespaces import pushed, told
from rosprivacy.ingest.types.channel_types import matching_nothing
from rosprivacy.question import question_of
from rosprivacy.reading.granted import read_granted
from rosprivacy.reading.robot_system import beyond_of, read_types_files, with_types
from rosprivacy.system import System

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from rosprivacy.analysis.model import Diagnostic, Policy
    from rosprivacy.ontology.vocabulary import Vocabulary
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


def fleet_reader(file: str, question: Question) -> Callable[[Change], FleetSystem]:
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
    reader = Reader(question.vocabulary, settings, fleet.root)
    return FleetRead(fleet, _groups(fleet, question), reader, question)


def _groups(fleet: Fleet, question: Question) -> tuple[Alike, ...]:
    return alike(fleet, question.decisions.told_apart) if question.decisions else alike(fleet)


@dataclass(frozen=True, slots=True)
class FleetRead:
    """A fleet file that was read: systems are made of it, with a change of policies or under other labels."""

    fleet: Fleet
    groups: tuple[Alike, ...]
    reader: Reader
    question: Question

    def system(self, change: Change = NO_CHANGE) -> FleetSystem:
        """Return the fleet, if its policies had a change."""
        return _made(self.fleet, self.groups, self.reader, change, self.question)

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
        return _made(self.fleet, groups, self.reader, NO_CHANGE, self.question)

    def again(self) -> FleetRead:
        """Return the same with robots compared anew, by what their files hold now."""
        return replace(self, groups=_groups(self.fleet, self.question))


def _made(fleet: Fleet, groups: tuple[Alike, ...], reader: Reader, change: Change, question: Question) -> FleetSystem:
    settings, members = question.settings, {}
    problems: list[InputError] = []
    for group in groups:
        try:
            members[group.robots[0].id] = reader.member(group.robots[0], change)
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    placed = place(fleet, groups, members, settings.view)
    there = {key: reader.labels[key] for group in groups for key in reader.wanted(group.robots[0])}
    labels = tuple(sorted(there.values(), key=lambda labels: (labels.file, labels.own)))
    joins = joins_nothing(fleet, groups, placed.met)
    diagnostics = dict.fromkeys((*(d for member in members.values() for d in member.diagnostics), *joins))
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


def rows_of_fleet(system: FleetSystem, question: Question, result: Result) -> FleetRows:
    """Return the rows of all robots for the database; with each goes what its part of the answer rests on.

    Parameters
    ----------
    result
        With every finding, about all categories.
    """
    more = {}
    for name, member in system.members.items():
        files = files_read(member.policies, member.files, question.settings)
        said = assumptions_of({**files, **types_read(member.types)}, result.analysis, question)
        more[name] = remembered(said, member.diagnostics)
    everything = {**result.assumptions, "policies": [], "labels": [], "types": []}
    more[system.fleet.name] = remembered(everything, system.joins)
    not_read = [name for name, member in system.members.items() if unread(member.diagnostics)]
    return FleetRows(
        system.placed, result.analysis, system.vocabulary, more, not_read=not_read, beyond=beyond_of(result)
    )


def files_of(robot: Robot) -> list[tuple[str, bool]]:
    """Return the label files of a robot, and whether each is its own or its model's."""
    return [*((file, False) for file in robot.labels), *((file, True) for file in robot.own)]


class Reader:
    """Reads policies and label files, each once, and makes the graph of one robot of them."""

    def __init__(self, vocabulary: Vocabulary, settings: Settings, root: str) -> None:
        self.labels: dict[tuple[str, bool], Labels] = {}
        self._vocabulary = vocabulary
        self._settings = settings
        self._root = root
        self._policies: dict[tuple[str, ...], tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]] = {}
        self._members: dict[object, Member] = {}
        self._change = NO_CHANGE

    def member(self, robot: Robot, change: Change = NO_CHANGE) -> Member:
        """Return a robot with its graph, if its policies had a change; graphs of the change before are forgotten."""
        if change != self._change:
            self._members, self._change = {}, change
        key = (robot.policies, robot.labels, robot.own, robot.strip, robot.add, robot.surroundings, robot.types)
        if key not in self._members:
            self._members[key] = self._made(robot)
        member = self._members[key]
        who = f"model {robot.model}" if robot.model else f"robot {robot.id}"
        said = told(member.policies, who, robot.add)
        return replace(member, robot=robot, diagnostics=(*member.diagnostics, *said))

    def relabel(self, labels: Mapping[tuple[str, bool], Labels]) -> None:
        """Take labels in the place of what files say; graphs of robots that read these files are made anew."""
        other = {key for key, one in labels.items() if self.labels.get(key) is not one}
        self.labels.update(labels)
        self._members = {
            key: member for key, member in self._members.items() if other.isdisjoint(files_of(member.robot))
        }

    def _read_policies(self, robot: Robot) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
        settings = self._settings
        if robot.policies not in self._policies:
            policies, said = read_granted(robot.policies, settings, self._root)
            said += (*joint_warnings(policies), *merging_notices(policies, OF_ONE_ROBOT))
            self._policies[robot.policies] = policies, said
        return self._policies[robot.policies]

    def _made(self, robot: Robot) -> Member:
        settings = self._settings
        files = self._read_labels(robot)
        policies, said = self._read_policies(robot)
        policies = changed(policies, self._change)
        diagnostics = [*(d for policy in policies for d in policy.diagnostics), *said]
        diagnostics += [d for labels in files for d in labels.diagnostics]
        run = [pushed(policy, robot.add) for policy in policies]
        graph, full = stripped(build(run, settings.view, settings.bounds), robot.strip or robot.add)
        extended = extend(graph, files)
        diagnostics += (
            *remarks(extended, files),
            *careful_notices(extended.careful),
        )
        diagnostics += told_of_bags(extended, (stated for labels in files for stated in labels.elements))
        types = tuple(one for _, one in sorted(read_types_files(robot.types, settings).items()))
        written = full if robot.strip else {}
        diagnostics += matching_nothing(extended, types, written)
        bound = with_types(extended, bind(extended, files, settings.bounds, robot.surroundings), types, written)
        bound = with_exposed(extended, bound, policies)
        diagnostics += outdated_reasons(extended, bound)
        return Member(
            robot, policies, extended, bound, full, graph.profiles, tuple(files), tuple(dict.fromkeys(diagnostics)),
            types, robot.add,
        )  # fmt: skip

    def _read_labels(self, robot: Robot) -> list[Labels]:
        settings = self._settings
        standard, wanted = settings.standard_channels, self.wanted(robot)
        problems: list[InputError] = []
        for file, own in [key for key in wanted if key not in self.labels]:
            shipped = file == standard and file not in (*robot.labels, *robot.own)
            try:
                self.labels[file, own] = read_labels(
                    file,
                    self._vocabulary,
                    category=settings.category,
                    shipped=shipped,
                    own=own,
                    bounds=settings.bounds,
                    include_root=self._root,
                )
            except InputErrors as error:
                problems += error.errors
        if problems:
            raise InputErrors(problems)
        return [self.labels[key] for key in wanted]

    def wanted(self, robot: Robot) -> list[tuple[str, bool]]:
        """Return the label files of a robot, with that of the standard channels."""
        standard = self._settings.standard_channels
        return list(dict.fromkeys([*([(standard, False)] if standard else []), *files_of(robot)]))
