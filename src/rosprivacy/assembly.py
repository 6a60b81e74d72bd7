"""The way through the house: files -> model -> graph -> analysis. The command line is a thin layer over this.

In: what a user names. Out: a ``Result``.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.fleet.patterns import FleetView
from rosprivacy.analysis.model import unread
from rosprivacy.asked import asked_for
from rosprivacy.assumptions import (
    assumed_decisions,
    own_assumptions,
    put_together,
    remembered,
    sources_of,
    what_it_rests_on,
)
from rosprivacy.clock import judged_on
from rosprivacy.decided import accepts, decisions_of, joined_to
from rosprivacy.ingest.database.robot_notices import diagnostics_of
from rosprivacy.ingest.labels.add_non_ros import extend
from rosprivacy.ingest.labels.binding import bind, unused
from rosprivacy.ingest.labels.label_file import Labels, read_labels, unknown_categories
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.joint_policies import joint_warnings
from rosprivacy.ingest.policies.policy_files import read_policies
from rosprivacy.ingest.policies.saved_graph import read_saved
from rosprivacy.ontology.vocabulary import load
from rosprivacy.result import Result

if TYPE_CHECKING:
    from neo4j import Driver

    from rosprivacy.analysis.model import Diagnostic, FlowGraph, Policy
    from rosprivacy.ingest.database.rows import RobotRows
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


def run(policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings) -> Result:
    """Read everything, analyse it, and keep what the answer rests on.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    vocabulary = load(ontologies=settings.ontologies)
    asked = asked_for(vocabulary, settings)
    system, diagnostics = read_system(policies, settings)
    files = read_label_files(labels, vocabulary, settings)
    graph = extend(build(system, settings.view), files)
    bound = bind(graph, files)
    decisions = decisions_of(settings, vocabulary)
    not_read = unread((*diagnostics, *(d for policy in system for d in policy.diagnostics)))
    day = settings.today or judged_on(os.environ)
    options = Options(asked, settings.paths, settings.max_paths, accepts(decisions), today=day, unread=not_read)
    analysis = analyse(graph, bound, vocabulary.hierarchy, options)
    joined = joined_to(decisions, analysis, vocabulary, asked)
    said = tuple(d for policy in system for d in policy.diagnostics) + diagnostics
    said += tuple(d for file in files for d in file.diagnostics) + tuple(unused(graph, files))
    said += joined.diagnostics if joined else ()
    rests_on = what_it_rests_on(graph, sources_of(system), files, analysis, settings, vocabulary)
    rests_on |= assumed_decisions(decisions)
    return Result(
        analysis, bound, vocabulary, said, rests_on, joined, policies=system, labels=tuple(files), options=options
    )


def run_stored(driver: Driver, settings: Settings) -> Result:
    """Analyse what is in the database, with what people added to it, and write the answer back.

    Raises
    ------
    InputErrors
        With every element, flow and role that cannot be understood.
    DatabaseError
        If the server refuses, or a robot was loaded meanwhile.
    """
    from rosprivacy.ingest.database.read_back import read_stored  # noqa: PLC0415 - only where there is a database
    from rosprivacy.ingest.database.write_back import write_back  # noqa: PLC0415

    vocabulary = load(ontologies=settings.ontologies)
    asked = asked_for(vocabulary, settings)
    stored = read_stored(driver, vocabulary)
    not_read = unread(said for robot in stored.robots.values() for said in diagnostics_of(robot))
    day = settings.today or judged_on(os.environ)
    everything = Options(None, settings.paths, settings.max_paths, today=day, unread=not_read)
    analysis = analyse(stored.graph, stored.bound, vocabulary.hierarchy, everything)
    write_back(driver, stored, analysis, vocabulary)
    decisions = decisions_of(settings, vocabulary)
    chosen = replace(everything, categories=asked, accepts=accepts(decisions, stored.likeness))
    if chosen != everything:
        analysis = analyse(stored.graph, stored.bound, vocabulary.hierarchy, chosen)
    joined = joined_to(decisions, analysis, vocabulary, asked, stored.likeness)
    said, loaded = put_together(stored.robots.values(), analysis)
    said += joined.diagnostics if joined else ()
    assumptions = (
        own_assumptions(stored.graph, settings, vocabulary, analysis.emitted) | loaded | assumed_decisions(decisions)
    )
    view = FleetView.of(analysis, stored.likeness) if len(stored.robots) > 1 else None
    return Result(analysis, stored.bound, vocabulary, said, assumptions, joined, view, options=chosen)


def robot_of(name: str, result: Result) -> RobotRows:
    """Return the rows of a robot for the database; what the answer rests on goes with it."""
    from rosprivacy.ingest.database.rows import robot_rows  # noqa: PLC0415

    more = remembered(result.assumptions, result.diagnostics)
    return robot_rows(name, result.analysis, result.bound, result.vocabulary, more)


def read_system(policies: tuple[str, ...], settings: Settings) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
    """Read policies and the saved graphs that they add to."""
    graphs = [read_saved(file) for file in settings.add]
    saved = [policy for policies_of, _ in graphs for policy in policies_of]
    read: tuple[Policy, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    if policies or not saved:
        read, diagnostics = read_policies(
            policies,
            include_root=settings.include_root,
            max_bytes=settings.max_bytes,
            progress=settings.progress,
        )
    known = {policy.file for policy in read}  # read again is read anew
    sources = {name for policy in read for name, _ in policy.sources}
    diagnostics += tuple(d for _, left in graphs for d in left if d.place.file not in sources and d not in diagnostics)
    system = (*read, *(policy for policy in saved if policy.file not in known))
    return tuple(sorted(system, key=lambda policy: policy.file)), (*diagnostics, *joint_warnings(system))


def standard_channels(graph: FlowGraph, vocabulary: Vocabulary, settings: Settings) -> set[tuple[str, str]]:
    """Return (kind, name) of the channels that the standard file takes as mundane (rule S13)."""
    bound = bind(graph, read_label_files((), vocabulary, settings))
    return {(graph.elements[vertex].kind, graph.elements[vertex].name) for vertex in bound.elements}


def read_label_files(labels: tuple[str | Labels, ...], vocabulary: Vocabulary, settings: Settings) -> list[Labels]:
    """Read the standard channels' file and the user's, if not read before, with the problems of all of them."""
    files: list[Labels] = []
    problems: list[InputError] = []
    standard = [settings.standard_channels] if settings.standard_channels else []
    for file in dict.fromkeys([*standard, *labels]):
        if isinstance(file, Labels):
            files.append(file)
            problems += unknown_categories(file, vocabulary)
            continue
        try:
            shipped = file in standard and file not in labels  # named by the user, it is the user's own
            files.append(read_labels(file, vocabulary, category=settings.category, shipped=shipped))
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    return files
