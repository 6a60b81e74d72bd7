"""``rosprivacy load``: a robot, or all robots of a fleet, into the database."""

from __future__ import annotations

import os
import re
import sys
from contextlib import contextmanager
from dataclasses import replace
from glob import has_magic
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.text import counted
from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.options import ViewOrBoth, ViewOrBothChosen
from rosprivacy.cli.output import emit
from rosprivacy.report.naming import count_elements
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.ingest.neo4j_graph.loading import Loaded, Run
    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

SHOWN_AT_MOST = 3  # robots in a message
# Of a file, these tell nothing.
NO_NAMES = ("", "policy", "policies", "robot", "ros", "sros", "sros2", "permissions")


@reads_system("all that is read, as nobody has decided about it", without=("from_database", "categories", "decisions"))
def load(
    inputs: Inputs,
    view: ViewOrBothChosen = ViewOrBoth.declared,
    robot: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="What the robot is called in the database; by default as its policy file, if there is only one.",
            show_default=False,
        ),
    ] = None,
    results: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="Write what analyze --results has written there.", show_default=False),
    ] = None,
    without_standard: Annotated[
        bool,
        typer.Option(
            "--without-standard",
            help="Leave out parameter services and other channels that only the standard file speaks of: they are most "
            "of many graphs, and no data goes on from them.",
        ),
    ] = False,
) -> None:
    """Analyse policies and write the robot into Neo4j, or all robots of a fleet, in place of what was there before."""
    from rosprivacy.ingest.neo4j_graph import loading as database

    inputs, both = inputs.viewed(view), view is ViewOrBoth.both
    settings = inputs.settings
    if results:
        other = inputs.given_options("policies", "labels", "fleet", "add")
        more = [*(["--robot"] if robot is not None else []), *(["--view"] if both else [])]
        more += ["--without-standard"] if without_standard else []
        refuse("--results", "what is in the folder", [*other, *more])
        _load_results(results, settings.ontologies, inputs.neo4j)
        return
    if inputs.fleet:
        refuse("--fleet", "the names of the fleet file", ["--robot"] if robot is not None else [])
        _load_fleet(inputs.fleet, settings, inputs.neo4j, both_views=both, without_standard=without_standard)
        return
    from rosprivacy.systems.robot_system import robot_of

    name = database.check_robot_name(name_of(inputs) if robot is None else robot)
    result = inputs.result(settings, both_views=both)
    rows = robot_of(name, result, without_standard=without_standard)
    with driver_of(inputs.neo4j) as driver:
        if robot is None and (others := database.others_there(driver, rows)):
            what = f"the database has a robot {shown(name)} of other policies ({', '.join(map(shown, others))})"
            raise InputError(
                inputs.required_policies[0], 0, what, f"name this one: --robot NAME; --robot {shown(name)} replaces it"
            )
        with _bar(rows.size) as advance:
            done = database.load(driver, [rows], result.vocabulary, advance, _run())
    how = "is there already, nothing to change" if done.unchanged else "is written"
    emit(f"robot {shown(name)} {how}: {_counts(result, rows)}\n{_sentence(result)}\n", None)
    if robot is None:
        print(f"robot {shown(name)} has the name of its policy file; --robot NAME says another", file=sys.stderr)
    _tell_replaced(done)


def _sentence(result: Result) -> str:
    """The verdict in a sentence that names its doubts (rule S11)."""
    return verdict_sentence(result.verdict_facts())


def _counts(result: Result, rows: RobotRows) -> str:
    """What there is, as ``analyze`` counts it, and what that is in the database."""
    graph = result.analysis.graph
    elements, flows = counted(count_elements(graph.elements).elements, "element"), counted(len(graph.flows), "flow")
    stored = f"{len(rows.elements):,} nodes with the legs of services and actions, {len(rows.flows):,} FLOWS_TO with"
    stands = sum(not finding.dismissed for finding in result.analysis.findings)
    dismissed = len(result.analysis.findings) - stands
    more = f", {dismissed:,} more only through another leak" if dismissed else ""
    if result.enforced:
        more += f", {len(result.enforced.added):,} more only in the enforced view"
    return f"{elements} and {flows} ({stored} denied flows), {counted(stands, 'finding')}{more}"


def name_of(inputs: Inputs) -> str:
    """Return what a robot is called of which nobody says it: as its policy file, where that says which one it is."""
    file = Path(inputs.required_policies[0])
    name = re.sub(r"(\.policy)?\.xml$", "", file.name, flags=re.IGNORECASE)
    if (
        len(inputs.required_policies) > 1
        or inputs.add
        or file.is_dir()
        or has_magic(str(file))
        or name.casefold() in NO_NAMES
    ):
        what = "nothing says what the robot is called in the database, where it would replace one of that name"
        raise InputError(inputs.required_policies[0], 0, what, "add --robot NAME")
    return name


def _tell_replaced(loaded: Loaded) -> None:
    """Say which robots took the place of others of the same name."""
    names = [f"{shown(name)} ({', '.join(map(shown, files))})" for name, files in sorted(loaded.replaced.items())]
    if names:
        more = f" and {len(names) - SHOWN_AT_MOST:,} more" if len(names) > SHOWN_AT_MOST else ""
        what = f"in place of {counted(len(names), 'robot')} of the same name and other policies"
        print(f"warning: {what}: {', '.join(names[:SHOWN_AT_MOST])}{more}", file=sys.stderr)


def _load_fleet(file: str, settings: Settings, neo4j: str | None, *, both_views: bool, without_standard: bool) -> None:
    from rosprivacy.answering import answer
    from rosprivacy.ingest.neo4j_graph.fleet_rows import MOST_ACROSS
    from rosprivacy.question import question_of
    from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet

    question = question_of(settings)._replace(every=True, most_across=MOST_ACROSS)
    with _waiting(f"Reading the robots of {shown(file)}"):
        system = fleet_system(file, question)
    with _waiting(f"Analysing {len(system.fleet.robots):,} robots"):
        result = answer(system, question)
        if both_views:
            from rosprivacy.both_views import both_views_of_fleet

            result = replace(result, enforced=both_views_of_fleet(file, settings).enforced)
    rows = rows_of_fleet(system, question, result, without_standard=without_standard)
    _load_many(rows, system.vocabulary, neo4j, f"fleet {shown(file)}", len(system.fleet.robots), _sentence(result))
    if rows.left_out:
        message = f"{rows.left_out:,} findings from one robot to another are not written one by one: of each pattern"
        print(
            f"{message} with more than {MOST_ACROSS:,} only one for each robot that data comes from or gets to",
            file=sys.stderr,
        )
    if rows.derived_nearby:
        message = "what nodes make of data (DERIVES_FROM) is written within each robot and to what is shared only"
        print(f"{message}: from robot to robot it could be more than {MOST_ACROSS:,}", file=sys.stderr)


def _load_results(folder: str, ontologies: tuple[str, ...], neo4j: str | None) -> None:
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.parts.parquet import read

    vocabulary = load(ontologies=ontologies)
    document, rows = read(folder)
    robots, sentence = document["fleet"]["robots"], verdict_sentence(document)
    _load_many(rows, vocabulary, neo4j, f"results {shown(folder)}", robots, sentence)
    if any(pattern["across"] for pattern in document["fleet"]["patterns"]):
        message = "findings from one robot to another are not written one by one: of each pattern only one for each"
        print(f"{message} robot that data comes from", file=sys.stderr)


def _load_many(
    rows: Iterable[RobotRows], vocabulary: Vocabulary, neo4j: str | None, origin: str, robots: int, sentence: str
) -> None:
    """Write many robots, and say what was written of what, with the verdict in a sentence."""
    from rosprivacy.ingest.neo4j_graph.loading import load

    with driver_of(neo4j) as driver, _bar(None) as advance:
        done = load(driver, rows, vocabulary, advance, _run())
    _tell_replaced(done)
    shares = f"{origin}: {robots:,} robots and what they share"
    emit(f"{shares}: {done.written:,} written, {done.unchanged:,} as they were\n{sentence}\n", None)


def _run() -> Run:
    """What the database remembers of this run, which begins when the environment says, or now."""
    from rosprivacy.clock import source_date
    from rosprivacy.ingest.neo4j_graph.loading import Run
    from rosprivacy.version import __version__

    return Run.begun(__version__, source_date(os.environ))


@contextmanager
def _waiting(stage: str) -> Iterator[None]:
    """Say on a terminal which stage the work is at, and for how long it has been."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        progress.add_task(stage, total=None)
        yield


@contextmanager
def _bar(total: int | None) -> Iterator[Callable[[int], None]]:
    """A bar with rates on a terminal: rows written, rows per second."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    rate = TextColumn("{task.speed:,.0f} rows/s" if total != 0 else "")
    columns = (TextColumn("Writing"), BarColumn(), MofNCompleteColumn(), rate, TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=total)
        yield lambda rows: progress.advance(task, rows)
