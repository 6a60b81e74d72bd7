"""The way of a fleet through the house: fleet file -> each kind of robot once -> one graph -> analysis.

In: a fleet file. Out: a ``Result`` with ``fleet``. Robots that are alike are read and analysed once.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.fleet.patterns import FleetView
from rosprivacy.analysis.fleet.patterns_of_pairs import Groups
from rosprivacy.analysis.model import unread
from rosprivacy.asked import asked_for
from rosprivacy.assumptions import assumed_decisions, remembered, sources_of, what_it_rests_on
from rosprivacy.clock import judged_on
from rosprivacy.decided import accepts, decisions_of, joined_to
from rosprivacy.ingest.database.fleet_rows import FleetRows
from rosprivacy.ingest.fleet.alike_robots import Alike, alike
from rosprivacy.ingest.fleet.dds_domains import Member, stripped, with_grants
from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot, read_fleet
from rosprivacy.ingest.fleet.fleet_graph import Placed, place
from rosprivacy.ingest.fleet.joins import joins_nothing
from rosprivacy.ingest.fleet.mergeable_graph import Part
from rosprivacy.ingest.labels.add_non_ros import extend
from rosprivacy.ingest.labels.binding import bind, unused
from rosprivacy.ingest.labels.label_file import Labels, read_labels
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.joint_policies import joint_warnings
from rosprivacy.ingest.policies.namespaces import as_written, pushed, told
from rosprivacy.ingest.policies.policy_files import read_policies
from rosprivacy.ontology.vocabulary import load
from rosprivacy.result import Result

if TYPE_CHECKING:
    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.analysis.model import Diagnostic, Policy
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


@dataclass(frozen=True, slots=True)
class Read:
    """A fleet that was read, before it is analysed.

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
    labels: tuple[Labels, ...]
    diagnostics: tuple[Diagnostic, ...]
    joins: tuple[Diagnostic, ...] = ()
    decisions: Decisions | None = None


def run_fleet(file: str, settings: Settings) -> Result:
    """Read a fleet, analyse it, and keep what the answer rests on.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    vocabulary = load(ontologies=settings.ontologies)
    return analysed(read_all(file, vocabulary, settings), vocabulary, settings)


def analysed(read: Read, vocabulary: Vocabulary, settings: Settings, *, every: bool = False) -> Result:
    """Analyse a fleet that was read.

    Parameters
    ----------
    every
        Make every finding of the graph, not one of each pattern.

    Raises
    ------
    InputErrors
        If labels contradict each other, or a category that is asked for is not known.
    """
    asked = asked_for(vocabulary, settings)
    placed = read.placed
    decisions = read.decisions
    groups = None if every or decisions else Groups(placed.likeness)
    accepted, not_read = accepts(decisions, placed.likeness), unread(read.diagnostics)
    day = settings.today or judged_on(os.environ)
    options = Options(asked, settings.paths, settings.max_paths, accepted, groups, today=day, unread=not_read)
    analysis = analyse(placed.graph, placed.bound, vocabulary.hierarchy, options)
    policies = [policy for member in read.members.values() for policy in member.policies]
    assumptions = what_it_rests_on(placed.graph, sources_of(policies), read.labels, analysis, settings, vocabulary)
    assumptions |= assumed_decisions(decisions)
    assumptions["fleet"] = [{"file": name, "sha256": digest} for name, digest in read.fleet.sources]
    system = tuple({policy.file: policy for policy in policies}.values())
    view = groups.view(analysis) if groups else FleetView.of(analysis, placed.likeness)
    joined = joined_to(decisions, analysis, vocabulary, asked, placed.likeness)
    said = read.diagnostics + (joined.diagnostics if joined else ())
    return Result(
        analysis, placed.bound, vocabulary, said, assumptions, joined, view,
        policies=system, labels=read.labels, options=options,
    )  # fmt: skip


def rows_of_fleet(read: Read, result: Result, settings: Settings) -> FleetRows:
    """Return the rows of all robots for the database; with each goes what its part of the answer rests on.

    Parameters
    ----------
    result
        With every finding, about all categories.
    """
    more = {}
    for group in read.groups:
        member = read.members[group.robots[0].id]
        said = what_it_rests_on(
            result.analysis.graph,
            sources_of(member.policies),
            member.files,
            result.analysis,
            settings,
            result.vocabulary,
        )
        more[group.robots[0].id] = remembered(said, member.diagnostics)
    everything = {**result.assumptions, "policies": [], "labels": []}
    more[read.fleet.name] = remembered(everything, read.joins)
    not_read = [name for name, member in read.members.items() if unread(member.diagnostics)]
    return FleetRows(read.placed, result.analysis, result.vocabulary, more, not_read=not_read)


def read_all(file: str, vocabulary: Vocabulary, settings: Settings) -> Read:
    """Read a fleet file and what it names, each kind of robot once.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    fleet = read_fleet(file, vocabulary)
    decisions = decisions_of(settings, vocabulary)
    groups = alike(fleet, decisions.told_apart) if decisions else alike(fleet)
    reader = Reader(vocabulary, settings)
    members = {}
    problems: list[InputError] = []
    for group in groups:
        try:
            members[group.robots[0].id] = reader.member(group.robots[0])
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    placed = place(fleet, groups, members, settings.view)
    labels = tuple(sorted(reader.labels.values(), key=lambda labels: (labels.file, labels.own)))
    joins = joins_nothing(fleet, groups, placed.met)
    diagnostics = dict.fromkeys((*(d for member in members.values() for d in member.diagnostics), *joins))
    return Read(fleet, groups, members, placed, labels, tuple(diagnostics), joins, decisions)


class Reader:
    """Reads policies and label files, each once, and makes the graph of one robot of them."""

    def __init__(self, vocabulary: Vocabulary, settings: Settings) -> None:
        self.labels: dict[tuple[str, bool], Labels] = {}
        self._vocabulary = vocabulary
        self._settings = settings
        self._policies: dict[tuple[str, ...], tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]] = {}
        self._members: dict[object, Member] = {}

    def member(self, robot: Robot) -> Member:
        """Return a robot with its graph."""
        key = (robot.policies, robot.labels, robot.own, robot.strip, robot.add)
        if key not in self._members:
            self._members[key] = self._made(robot)
        member = self._members[key]
        who = f"model {robot.model}" if robot.model else f"robot {robot.id}"
        said = told(member.policies, who, robot.add)
        return replace(member, robot=robot, diagnostics=(*member.diagnostics, *said))

    def _read_policies(self, robot: Robot) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
        settings = self._settings
        if robot.policies not in self._policies:
            self._policies[robot.policies] = read_policies(
                robot.policies,
                include_root=settings.include_root,
                max_bytes=settings.max_bytes,
                progress=settings.progress,
            )
        return self._policies[robot.policies]

    def _made(self, robot: Robot) -> Member:
        settings = self._settings
        files = self._read_labels(robot)
        policies, said = self._read_policies(robot)
        diagnostics = [*(d for policy in policies for d in policy.diagnostics), *said, *joint_warnings(policies)]
        diagnostics += [d for labels in files for d in labels.diagnostics]
        run = [pushed(policy, robot.add) for policy in policies]
        graph, full = stripped(build(run, settings.view), robot.strip or robot.add)
        extended = extend(graph, files)
        diagnostics += unused(extended, files)
        part = with_grants(Part.of(extended, bind(extended, files)), lambda grant: as_written(grant, robot.add))
        return Member(robot, policies, part, full, graph.profiles, tuple(files), tuple(dict.fromkeys(diagnostics)))

    def _read_labels(self, robot: Robot) -> list[Labels]:
        settings = self._settings
        standard = settings.standard_channels
        wanted = [(file, False) for file in ([standard] if standard else []) + list(robot.labels)]
        wanted += [(file, True) for file in robot.own]
        problems: list[InputError] = []
        for file, own in [key for key in dict.fromkeys(wanted) if key not in self.labels]:
            shipped = file == standard and file not in (*robot.labels, *robot.own)
            try:
                self.labels[file, own] = read_labels(
                    file, self._vocabulary, category=settings.category, shipped=shipped, own=own
                )
            except InputErrors as error:
                problems += error.errors
        if problems:
            raise InputErrors(problems)
        return [self.labels[key] for key in dict.fromkeys(wanted)]
