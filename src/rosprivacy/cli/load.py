"""``rosprivacy load``: a robot, or all robots of a fleet, into the database."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.settings import Settings


@reads_system("all that is read, as nobody has decided about it", without=("from_database", "categories", "decisions"))
def load(
    inputs: Inputs,
    robot: Annotated[str, typer.Option(metavar="NAME", help="What the robot is called in the database.")] = "robot",
    results: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="Write what analyze --results has written there.", show_default=False),
    ] = None,
) -> None:
    """Analyse policies and write the robot into Neo4j, or all robots of a fleet, in place of what was there before."""
    from rosprivacy.ingest.database import loading as database

    settings = inputs.settings
    if results:
        refuse("--results", "what is in the folder", inputs.given("policies", "labels", "fleet", "add"))
        _load_results(results, settings.ontologies, inputs.neo4j)
        return
    if inputs.fleet:
        _load_fleet(inputs.fleet, settings, inputs.neo4j)
        return
    from rosprivacy.robot_system import robot_of

    name = database.check_robot_name(robot)
    result = inputs.result(settings)
    rows = robot_of(name, result)
    with driver_of(inputs.neo4j) as driver, _bar(rows.size) as advance:
        done = database.load(driver, [rows], result.vocabulary, advance)
    how = "is there already, nothing to change" if done.unchanged else "is written"
    count = f"{len(rows.elements):,} elements, {len(rows.flows):,} flows, {len(rows.findings):,} findings"
    emit(f"robot {shown(name)} {how}: {count}; verdict {result.analysis.verdict}\n", None)


def _load_fleet(file: str, settings: Settings, neo4j: str | None) -> None:
    from dataclasses import replace

    from rosprivacy.answering import answer
    from rosprivacy.fleet_system import fleet_system, rows_of_fleet
    from rosprivacy.ingest.database import loading as database
    from rosprivacy.ingest.database.fleet_rows import MOST_ACROSS
    from rosprivacy.question import question_of

    question = replace(question_of(settings), every=True)
    system = fleet_system(file, question)
    result = answer(system, question)
    rows = rows_of_fleet(system, question, result)
    with driver_of(neo4j) as driver, _bar(None) as advance:
        done = database.load(driver, rows, system.vocabulary, advance)
    robots = len(system.fleet.robots)
    what = f"fleet {shown(file)}: {robots:,} robots and what they share"
    emit(
        f"{what}: {done.written:,} written, {done.unchanged:,} as they were; verdict {result.analysis.verdict}\n", None
    )
    if rows.left_out:
        message = f"{rows.left_out:,} findings from one robot to another are not written one by one: of each pattern"
        print(f"{message} with more than {MOST_ACROSS:,} only one for each robot that data comes from", file=sys.stderr)


def _load_results(folder: str, ontologies: tuple[str, ...], neo4j: str | None) -> None:
    from rosprivacy.ingest.database import loading as database
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.spark.parquet import read

    vocabulary = load(ontologies=ontologies)
    document, rows = read(folder)
    with driver_of(neo4j) as driver, _bar(None) as advance:
        done = database.load(driver, rows, vocabulary, advance)
    what = f"results {shown(folder)}: {document['fleet']['robots']:,} robots and what they share"
    emit(f"{what}: {done.written:,} written, {done.unchanged:,} as they were; verdict {document['verdict']}\n", None)
    if any(pattern["across"] for pattern in document["fleet"]["patterns"]):
        message = "findings from one robot to another are not written one by one: of each pattern only one for each"
        print(f"{message} robot that data comes from", file=sys.stderr)


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
