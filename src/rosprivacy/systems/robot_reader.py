"""Robots of a fleet, read one by one: policies and label files, each once -> the graph of a robot.

In: robots as a fleet file tells of them. Out: ``Member``. Something may be otherwise than it is read (``Tried``).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.suggesting.outdated_reasons import outdated_reasons
from rosprivacy.ingest.deployed.exposures import with_exposed
from rosprivacy.ingest.fleet.alike_robots import digest
from rosprivacy.ingest.fleet.dds_domains import Member, stripped
from rosprivacy.ingest.labels.add_non_ros import extended, told_of_bags
from rosprivacy.ingest.labels.binding import GraphNames, join, remarks
from rosprivacy.ingest.labels.label_file import OURS, read_labels
from rosprivacy.ingest.labels.strange_file import strange_files
from rosprivacy.ingest.mitigation.deny_lines import with_denied
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, PolicyChange, changed
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.joint_policies import OF_ONE_ROBOT, joint_warnings, merging_notices
from rosprivacy.ingest.policies.namespaces import notices, pushed
from rosprivacy.ingest.policies.wildcards import careful_warnings
from rosprivacy.ingest.scan.reviewed_code import with_reviewed_code
from rosprivacy.ingest.types.channel_types import matching_nothing
from rosprivacy.systems.granted import read_granted
from rosprivacy.systems.robot_system import read_types_files, with_types

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import Diagnostic, Grant, Policy
    from rosprivacy.ingest.fleet.fleet_file import Robot
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


class Tried(NamedTuple):
    """What is otherwise than it is read.

    Attributes
    ----------
    denied
        Lines that are set to DENY. Labels of what is gone with them are then told, and not refused.
    labels
        What is said beside the label files.
    """

    denied: frozenset[Grant] = frozenset()
    labels: Labels | None = None


def files_of(robot: Robot) -> list[tuple[str, bool]]:
    """Return the label files of a robot, and whether each is its own or its model's."""
    return [*((file, False) for file in robot.labels), *((file, True) for file in robot.own)]


class RobotReader:
    """Reads policies and label files, each once, and makes the graph of one robot of them.

    Attributes
    ----------
    labels, policies, types
        That were read.
    missing
        Labels of what is gone with lines that are set to DENY.
    """

    def __init__(self, vocabulary: Vocabulary, settings: Settings, root: str, tried: Tried = Tried()) -> None:  # noqa: B008 - a constant
        self.labels: dict[tuple[str, bool], Labels] = {}
        self.policies: dict[tuple[str, ...], tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]] = {}
        self.types: dict[str, TypesFile] = {}
        self.missing: list[InputError] = []
        self._tried = tried
        self._vocabulary = vocabulary
        self._settings = settings
        self._root = root
        self._members: dict[object, Member] = {}
        self._change = NO_CHANGE

    def member(self, robot: Robot, change: PolicyChange = NO_CHANGE) -> Member:
        """Return a robot with its graph, if its policies had a change; graphs of the change before are forgotten."""
        if change != self._change:
            self._members, self._change = {}, change
        key = (robot.policies, robot.labels, robot.own, robot.strip, robot.add, robot.surroundings, robot.types)
        if key not in self._members:
            self._members[key] = self._system(robot)
        member = self._members[key]
        who = f"model {robot.model}" if robot.model else f"robot {robot.id}"
        said = notices(member.policies, who, robot.add)
        return replace(member, robot=robot, diagnostics=(*member.diagnostics, *said))

    def trying(self, tried: Tried) -> RobotReader:
        """Return a reader of the same files, as they were read, with something otherwise."""
        reader = RobotReader(self._vocabulary, self._settings, self._root, tried)
        reader.labels, reader.policies, reader.types = self.labels, self.policies, self.types
        return reader

    def relabel(self, labels: Mapping[tuple[str, bool], Labels]) -> None:
        """Take labels in the place of what files say; graphs of robots that read these files are made anew."""
        other = {key for key, one in labels.items() if self.labels.get(key) is not one}
        self.labels.update(labels)
        self._members = {
            key: member for key, member in self._members.items() if other.isdisjoint(files_of(member.robot))
        }

    @property
    def read(self) -> frozenset[tuple[str, str]]:
        """The files that were read, with the hashes of what they held; of label files with edits the hash of these."""
        policies = {source for there, _ in self.policies.values() for policy in there for source in policy.sources}
        labels = {(file, one.sha256) for (file, _), one in self.labels.items()}
        return frozenset(policies | labels | {(types.file, types.sha256) for types in self.types.values()})

    def changed(self) -> frozenset[str]:
        """Return the files that hold something else now than what was read."""
        read = [(file, held) for file, held in self.read if not file.startswith(OURS)]
        now = {file: digest(file) for file in {file for file, _ in read}}
        return frozenset(file for file, held in read if now[file] != held)

    def _read_policies(self, robot: Robot) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
        settings = self._settings
        if robot.policies not in self.policies:
            policies, said = read_granted(robot.policies, settings, self._root)
            said += (*joint_warnings(policies), *merging_notices(policies, OF_ONE_ROBOT))
            self.policies[robot.policies] = policies, said
        return self.policies[robot.policies]

    def _system(self, robot: Robot) -> Member:
        settings = self._settings
        tried = self._tried
        files = [*self._read_labels(robot), *([tried.labels] if tried.labels else [])]
        policies, said = self._read_policies(robot)
        policies = with_denied(changed(policies, self._change), tried.denied)
        diagnostics = [*(d for policy in policies for d in policy.diagnostics), *said]
        diagnostics += [d for labels in files for d in labels.diagnostics]
        run = [pushed(policy, robot.add) for policy in policies]
        graph, full = stripped(build(run, settings.view, settings.bounds), robot.strip or robot.add)
        whole, missing = extended(graph, files)
        self._refuse(missing)
        diagnostics += (*remarks(whole, files), *careful_warnings(whole.careful))
        diagnostics += told_of_bags(whole, (stated for labels in files for stated in labels.elements))
        self.types |= read_types_files((name for name in robot.types if name not in self.types), settings)
        types = tuple(self.types[name] for name in sorted(set(robot.types)))
        written = full if robot.strip else {}
        diagnostics += matching_nothing(whole, types, written)
        names = GraphNames(whole)
        bound, missing = join(whole, files, settings.bounds, robot.surroundings, names)
        self._refuse(missing, strange_files(files, names.matching, names.by_kind))
        bound, of_code = with_reviewed_code(whole, bound, files, policies)
        bound = with_exposed(whole, with_types(whole, bound, types, written), policies)
        diagnostics += of_code
        diagnostics += outdated_reasons(whole, bound)
        return Member(
            robot, policies, whole, bound, full, graph.profiles, tuple(files), tuple(dict.fromkeys(diagnostics)),
            types, robot.add,
        )  # fmt: skip

    def _refuse(self, missing: list[InputError], about_files: Iterable[InputError] = ()) -> None:
        """Raise what is missing, and before it what is to be told of whole files, where nothing is tried."""
        if missing and not self._tried.denied:
            raise InputErrors([*about_files, *missing])
        self.missing += missing

    def _read_labels(self, robot: Robot) -> list[Labels]:
        settings = self._settings
        standard, wanted = settings.standard_channels, self.label_files(robot)
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

    def label_files(self, robot: Robot) -> list[tuple[str, bool]]:
        """Return the label files of a robot, with that of the standard channels."""
        standard = self._settings.standard_channels
        return list(dict.fromkeys([*([(standard, False)] if standard else []), *files_of(robot)]))
