"""The way of a fleet through its parts: fleet file -> units, handed out to processes or to Apache Spark -> the answer.

In: a fleet file. Out: a ``Result`` like that of ``answer_fleet``, in whose graph are the robots that are shown.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import FleetError, InputError, InputErrors, reason
from rosprivacy.analysis.files_read import note
from rosprivacy.analysis.findings.findings import Options
from rosprivacy.analysis.model import HANGS_ON_CUT, IN_PARTS, Diagnostic, Place, Severity
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.answering import answer, concluded
from rosprivacy.assumptions import named_files, types_read
from rosprivacy.clock import judged_on
from rosprivacy.ingest.fleet.alike_robots import alike
from rosprivacy.ingest.fleet.fleet_file import read_fleet
from rosprivacy.ingest.fleet.joins import OF_FLEET
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ingest.reading.path_kinds import is_file
from rosprivacy.ontology.vocabulary import load
from rosprivacy.parts.distributed import MOST_WHOLE, Task, analyse_in_parts
from rosprivacy.parts.kept_parts import kept_parts
from rosprivacy.parts.parquet import check_new, write
from rosprivacy.parts.processes import processes
from rosprivacy.parts.session import scatter, session
from rosprivacy.parts.shown_robots import place_shown, shown
from rosprivacy.parts.unit_rows import Plan
from rosprivacy.parts.units import crossing_lines, split
from rosprivacy.question import in_contexts, question_of
from rosprivacy.system import System
from rosprivacy.systems.robot_reader import RobotReader

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot
    from rosprivacy.parts.distributed import Found
    from rosprivacy.parts.units import Unit
    from rosprivacy.parts.workers import Read
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


SPARK, PROCESSES = "spark", "parts"  # as ``--engine`` names them


def run_on_spark(file: str, settings: Settings, master: str | None = None, results: str | None = None) -> Result:
    """Read a fleet and analyse it on Spark; the workers read the policies, from where they are.

    Parameters
    ----------
    master
        Of a cluster; None for this machine.
    results
        Folder, to be made, for the answer about every robot as Parquet; for the answer about all categories only.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    ClusterError
        If there is no Spark, or something fails there.
    """
    task, question = task_of(file, settings, SPARK)
    if results:
        task = replace(task, written=True)
        check_new(results)
        _check_whole(task)
    with session(master) as spark:
        whole = analyse_in_parts(task, partial(scatter, spark))
        answer = result(task, whole, question, SPARK)
        if results:
            plan, units = plan_of(task, whole, answer, question.settings)
            write(spark, results, units, plan, answer.document())
        return answer


def run_in_processes(file: str, settings: Settings, resume: str | None = None) -> Result:
    """Read a fleet and analyse it part by part on the processors of this machine.

    Parameters
    ----------
    resume
        Folder in which parts are kept that were read, for a run that goes on where this one is killed.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    ClusterError
        If a process ends before its part is done.
    """
    task, question = task_of(file, settings, PROCESSES)
    resumed = kept_parts(resume, question.settings, task.fleet.sources) if resume else None
    with processes(settings.progress, resumed) as scatter_here:
        return result(task, analyse_in_parts(task, scatter_here), question, PROCESSES)


def task_of(file: str, settings: Settings, engine: str) -> tuple[Task, Question]:
    """Read a fleet file, and return what is analysed and what is asked."""
    plain = replace(settings, progress=unchanged, today=settings.today or judged_on(os.environ))
    question = question_of(plain)
    fleet = read_fleet(file, question.vocabulary, include_root=settings.include_root, bounds=settings.bounds)
    question = in_contexts(question, contexts_of(fleet, question))
    task = Task(
        fleet, alike(fleet), settings.view, partial(file_reader, plain, str(Path.cwd()), fleet.root),
        question.vocabulary.hierarchy, question.categories_asked, question.today, hangs_on=settings.hangs_on,
    )  # fmt: skip
    if settings.decisions and not task.whole:
        what = f"--engine {engine} takes no decisions about more than {MOST_WHOLE:,} robots that differ"
        raise InputError("--decisions", 0, what, "leave them out, or analyse in memory")
    return task, question


def contexts_of(fleet: Fleet, question: Question) -> frozenset[str]:
    """Return the contexts that a filter for Article 9 has to know before anything is followed.

    Label files that cannot be read say nothing here: the workers say what is wrong with them.
    """
    if question.categories_asked is None or not question.settings.article9:
        return frozenset()
    robots = (*fleet.robots, *fleet.infrastructure)
    found = {name for robot in robots for name in robot.surroundings.contexts}
    found |= {name for entry in fleet.entries for name in entry.contexts}
    for file in sorted({file for robot in robots for file in (*robot.labels, *robot.own)}):
        with suppress(InputErrors):
            labels = read_labels(file, question.vocabulary, bounds=question.settings.bounds)
            found |= {*labels.surroundings.contexts, *(name for entry in labels.entries for name in entry.contexts)}
    return frozenset(found.union(fleet.surroundings.contexts))


def _note_what_workers_read(whole: Found) -> None:
    """Workers are processes of their own, whose notes nobody sees here: what they have read is no output either."""
    for name in (*(file for file, _ in whole.report.sources), *(file for file, *_ in whole.report.labels)):
        if is_file(name):
            note(name, Path(name).stat())


def plan_of(task: Task, whole: Found, answer: Result, settings: Settings) -> tuple[Plan, tuple[Unit, ...]]:
    """Return what the rows of units are made with, and the units."""
    fixed, units = split(task.groups)
    examples = tuple(unit for unit in units if unit.name in whole.examples)
    fleet = replace(task.fleet, robots=(), infrastructure=())
    assumptions = answer.assumptions
    joins = tuple(said for said in whole.report.diagnostics if said.code in OF_FLEET)
    likeness = whole.likeness
    core = (one for one in answer.doubts if one.element and not likeness.is_robot(one.element.robot))
    doubts = (*core, *(one for one in answer.doubts if one.name == IN_PARTS))
    plan = Plan(
        fleet, fixed, examples, whole.shared, whole.leaking, whole.lacking, assumptions, settings, task.reader, joins,
        whole.broken, doubts,
    )  # fmt: skip
    return plan, units


def _check_whole(task: Task) -> None:
    """Refuse results that would not say everything, or have a flow for each pair of robots."""
    problems: list[InputError] = []
    if task.categories is not None:
        what = "results are about all categories"
        hint = "leave out --categories, --article9, --data-type and --identity-factor, or --results"
        problems.append(FleetError("--results", 0, what, hint))
    for line in sorted(crossing_lines(task.fleet)):
        place = task.fleet.flows[line].place
        what = "results have no flows from robots to robots, one for each pair"
        problems.append(FleetError(place.file, place.line, what, "let them meet at an element of the fleet file"))
    if problems:
        raise InputErrors(problems)


def result(task: Task, whole: Found, question: Question, engine: str) -> Result:
    """Look for the ways of what is shown, and put together what a report says.

    Of a fleet that is shown as a whole, types and decisions count as in memory.
    """
    _note_what_workers_read(whole)
    placed, members = place_shown(task, whole)
    report = whole.report
    policies = {policy.file: policy for member in members.values() for policy in member.policies}
    labels = {file.file: file for member in members.values() for file in member.files}
    system = System(
        placed.graph, placed.bound, question.vocabulary,
        report.diagnostics if task.whole else (*report.diagnostics, *_left_out(whole, engine, question)),
        _rests_on(task, whole, question.settings, engine),
        tuple(policies.values()), tuple(labels.values()), whole.likeness, is_fleet=True,
    )  # fmt: skip
    limited = bool(report.by_type) or (report.typed and question.type_limits is not None)
    if task.whole and (limited or question.decisions):
        return answer(system, question)
    sample = shown(task, whole, placed, question.settings.paths, question.settings.max_paths)
    counts = None if task.whole else whole.counts  # counts say that there are robots beside those of the graph
    told = concluded(system, question, sample.analysis, sample.view, Options(), counts)
    if task.whole:
        return told
    rows = whole.hangs_on.rows if whole.hangs_on else None
    return replace(told, beyond=placed.feeding, of_whole_fleet=rows, hangs_on_asked=rows is not None)


def _rests_on(task: Task, whole: Found, settings: Settings, engine: str) -> dict[str, Any]:
    """The files that an answer rests on, and what computed it."""
    report = whole.report
    return {
        **({"countries_as_of": countries().as_of} if report.countries else {}),
        **named_files(sorted(report.sources), sorted(report.labels), settings),
        **types_read(sorted(report.types, key=lambda file: file.file)),
        "fleet": [{"file": name, "sha256": digest} for name, digest in task.fleet.sources],
        "engine": engine,
        **({"type_limits": None} if report.typed and not task.whole else {}),
    }


def _left_out(whole: Found, engine: str, question: Question) -> Iterator[Diagnostic]:
    """What the answer about a large fleet does not say, or does not take into account."""
    place = Place(f"--engine {engine}", 0)
    yield from whole.report.by_type
    if whole.hangs_on:
        limit = whole.hangs_on.limit
        cut = f"more findings or questions hang on this line than are listed, {limit:,}: first what would stand"
        yield from (Diagnostic(line.place, Severity.WARNING, cut, HANGS_ON_CUT) for line in whole.hangs_on.cut)
    if whole.report.typed and question.type_limits:
        unlimited = "message types limit nothing in parts: in memory there can be fewer findings"
        yield Diagnostic(place, Severity.NOTICE, unlimited)
    bounds = (
        f"analysed in parts, {whole.open:,} open elements in the whole fleet: ways and distances are the shortest "
        "among the robots that are shown, and what is told element by element is told of these: enclaves, open "
        "elements, unknown ends, what is denied, sanitized, derived, taken away, decided by globs, behind standard "
        "channels, stated of purposes and bases, or not stated"
    )
    yield Diagnostic(place, Severity.WARNING, bounds, IN_PARTS)


def file_reader(settings: Settings, folder: str, root: str) -> Read:
    """Return what reads robots from files below a root, on a worker; names are relative to a folder there."""
    reader = RobotReader(load(ontologies=settings.ontologies), settings, root)

    def read(robot: Robot) -> Member:
        if folder == os.getcwd():  # noqa: PTH109 - as it is compared
            return reader.member(robot)
        try:
            with chdir(folder):
                return reader.member(robot)
        except OSError as error:
            why = f"a worker cannot open the folder: {reason(error)}"
            hint = "work in a folder that all machines of the cluster share"
            raise InputErrors([FleetError(folder, 0, why, hint)]) from None

    return read


def unchanged(files: Sequence[str]) -> Iterable[str]:
    """Return the files: a worker has no terminal to show progress on."""
    return files
