"""``rosprivacy load``, ``unload`` and ``query``: into the database, out of it, and what people ask it."""

from __future__ import annotations

import csv
import io
import json
import sys
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import QueryError, reason, shown
from rosprivacy.cli.options import (
    FleetFile,
    IncludeRoot,
    LabelFiles,
    MaxBytes,
    NoStandard,
    Ontologies,
    Output,
    Policies,
    Server,
    SixLists,
    Standard,
    View,
    ViewChosen,
)
from rosprivacy.cli.output import emit, progress_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from contextlib import AbstractContextManager

    from neo4j import Driver

    from rosprivacy.queries.library import Query
    from rosprivacy.queries.run import Rows
    from rosprivacy.settings import Settings


class RowFormat(StrEnum):
    """Of the rows of a query."""

    table = "table"
    json = "json"
    csv = "csv"


def driver_of(server: str | None) -> AbstractContextManager[Driver]:
    """Open a driver to the server that is named, or to the private one."""
    from rosprivacy.private_neo4j.connection import connection, open_driver

    return open_driver(connection(server))


def load(
    policies: Policies = None,
    labels: LabelFiles = None,
    robot: Annotated[str, typer.Option(metavar="NAME", help="What the robot is called in the database.")] = "robot",
    fleet: FleetFile = None,
    results: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="Write what analyze --results has written there.", show_default=False),
    ] = None,
    neo4j: Server = None,
    ontology: Ontologies = None,
    category: SixLists = "PersonalData",
    view: ViewChosen = View.declared,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
) -> None:
    """Analyse policies and write the robot into Neo4j, or all robots of a fleet, in place of what was there before."""
    from rosprivacy.assembly import robot_of, run
    from rosprivacy.ingest.database import loading as database
    from rosprivacy.settings import Settings

    if fleet and (policies or labels):
        raise typer.BadParameter("--fleet takes what the fleet file names: no POLICY, --labels")
    if results:
        if policies or labels or fleet:
            raise typer.BadParameter("--results takes what is in the folder: no POLICY, --labels, --fleet")
        _load_results(results, tuple(ontology or ()), neo4j)
        return
    if not policies and not fleet:
        raise typer.BadParameter("name at least one policy: a file, a folder or a glob", param_hint="POLICY")
    settings = Settings(
        view=view.value,
        ontologies=tuple(ontology or ()),
        category=category,
        standard_channels=None if no_standard_channels else standard_channels,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=progress_of,
    )
    if fleet:
        _load_fleet(fleet, settings, neo4j)
        return
    name = database.check_robot_name(robot)
    result = run(tuple(policies or ()), tuple(labels or ()), settings)
    rows = robot_of(name, result)
    with driver_of(neo4j) as driver, _bar(rows.size) as advance:
        done = database.load(driver, [rows], result.vocabulary, advance)
    how = "is there already, nothing to change" if done.unchanged else "is written"
    count = f"{len(rows.elements):,} elements, {len(rows.flows):,} flows, {len(rows.findings):,} findings"
    emit(f"robot {shown(name)} {how}: {count}; verdict {result.analysis.verdict}\n", None)


def _load_fleet(file: str, settings: Settings, neo4j: str | None) -> None:
    from rosprivacy.fleets import analysed, read_all, rows_of_fleet
    from rosprivacy.ingest.database import loading as database
    from rosprivacy.ingest.database.fleet_rows import MOST_ACROSS
    from rosprivacy.ontology.vocabulary import load

    vocabulary = load()
    read = read_all(file, vocabulary, settings)
    result = analysed(read, vocabulary, settings, every=True)
    rows = rows_of_fleet(read, result, settings)
    with driver_of(neo4j) as driver, _bar(None) as advance:
        done = database.load(driver, rows, vocabulary, advance)
    robots = len(read.fleet.robots)
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


def unload(
    robot: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Robot to remove; may be repeated.", show_default=False)
    ] = None,
    fleet: FleetFile = None,
    neo4j: Server = None,
) -> None:
    """Remove a robot from Neo4j, or a fleet; what people added by hand stays, but for what hangs on its elements."""
    from rosprivacy.ingest.database.loading import unload

    if bool(robot) == bool(fleet):
        raise typer.BadParameter("name robots with --robot, or a fleet file with --fleet")
    robot = list(robot or ()) or _names_in(fleet or "")
    with driver_of(neo4j) as driver:
        gone = unload(driver, robot)
    missing = [name for name in robot if name not in gone]
    emit("".join(f"robot {shown(name)} is removed\n" for name in gone), None)
    if missing:
        raise QueryError(f"no robot {', '.join(map(shown, missing))} in the database; see rosprivacy query robots")


def _names_in(fleet: str) -> list[str]:
    """The names under which a fleet is filed in the database."""
    from rosprivacy.ingest.fleet.alike_robots import known_to_flows
    from rosprivacy.ingest.fleet.fleet_file import read_fleet
    from rosprivacy.ontology.vocabulary import load

    read = read_fleet(fleet, load())
    return [*known_to_flows(read), *([read.name] if read.elements else [])]


def complete_query(incomplete: str) -> list[str]:
    """Return the queries that begin so, for shell completion."""
    from rosprivacy.queries.library import pack

    return [name for name in pack() if name.startswith(incomplete)]


def query(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            autocompletion=complete_query,
            show_default=False,
            help="Question to ask; without it the questions are listed.",
        ),
    ] = None,
    values: Annotated[
        list[str] | None,
        typer.Argument(metavar="KEY=VALUE", show_default=False, help="Parameters of the question."),
    ] = None,
    cypher: Annotated[str | None, typer.Option(metavar="TEXT", show_default=False, help="Ask this instead.")] = None,
    file: Annotated[
        Path | None, typer.Option("--file", metavar="FILE", show_default=False, help="Ask what stands in this file.")
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Print the question's Cypher instead of asking it.")] = False,
    format: Annotated[RowFormat, typer.Option("--format", "-f", help="Of the rows.")] = RowFormat.table,  # noqa: A002 - the option's name
    output: Output = None,
    limit: Annotated[int, typer.Option(min=1, help="Most rows to print.")] = 1000,
    timeout: Annotated[float, typer.Option(min=0.1, help="Seconds that the server may take.")] = 60.0,
    neo4j: Server = None,
) -> None:
    """Ask the database: one of the questions that come with the program, or Cypher of your own, which only reads."""
    from rosprivacy.queries.library import find, pack
    from rosprivacy.queries.run import check_names, run

    given = list(values or ())
    if (cypher is not None) + (file is not None) + (name is not None and "=" not in name) > 1:
        raise typer.BadParameter("name a question, or give --cypher, or --file")
    asked = None
    if cypher is None and file is None:
        if name is None:
            emit(_listed(pack().values()), output)
            return
        asked = find(name)
        if show:
            emit(asked.text, output)
            return
        text, parameters = asked.text, asked.values(_pairs(given))
    else:
        text = cypher if cypher is not None else _read(file)
        parameters = dict(_pairs([*([name] if name else []), *given]))
    with driver_of(neo4j) as driver:
        if asked:
            check_names(driver, asked, parameters)
        rows = run(driver, text, parameters, limit=limit, timeout=timeout)
    emit(_text(rows, format, wide=output is not None), output)
    if rows.more:
        print(f"only the first {limit:,} rows are shown; --limit shows more", file=sys.stderr)


def _listed(queries: Iterable[Query]) -> str:
    lines = []
    for query in queries:
        parameters = " ".join(
            f"{p.name}=…" if p.default is None else f"[{p.name}={json.dumps(p.default)}]" for p in query.parameters
        )
        lines += [f"{query.name} {parameters}".rstrip(), f"    {query.description}"]
    return "\n".join([*lines, ""])


def _pairs(given: list[str]) -> dict[str, str]:
    pairs: dict[str, str] = {}
    for text in given:
        key, equals, value = text.partition("=")
        if not equals:
            raise QueryError(f"{shown(text)!r} is no parameter; write key=value")
        if key in pairs:
            raise QueryError(f"{shown(key)} is given twice; keep one")
        pairs[key] = value
    return pairs


def _read(file: Path | None) -> str:
    from rosprivacy.ingest.reading.bounded_file import contents

    assert file is not None
    try:
        return contents(file).decode("utf-8")
    except (OSError, ValueError) as error:
        raise QueryError(f"{shown(str(file))}:0: cannot be read: {reason(error)}; name a file of Cypher") from None


def _text(rows: Rows, form: RowFormat, *, wide: bool) -> str:
    from rosprivacy.queries.run import as_cell
    from rosprivacy.report.spreadsheet import guarded

    if form is RowFormat.json:
        objects = [dict(zip(rows.columns, row, strict=True)) for row in rows.rows]
        return json.dumps(objects, indent=2, ensure_ascii=False) + "\n"
    cells = [[as_cell(*cell) for cell in zip(row, rows.columns, strict=True)] for row in rows.rows]
    if form is RowFormat.csv:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(guarded, rows.columns))
        for values, row in zip(rows.rows, cells, strict=True):
            numbers = [isinstance(value, int | float) for value in values]  # -1 is no formula
            writer.writerow(c if number else guarded(c) for c, number in zip(row, numbers, strict=True))
        return text.getvalue()
    return _table(rows.columns, cells, wide=wide)


def _table(columns: tuple[str, ...], cells: list[list[str]], *, wide: bool) -> str:
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    if not cells:
        return "no rows\n"
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for column in columns:
        table.add_column(Text(column), overflow="fold")
    for row in cells:
        table.add_row(*(Text(shown(cell)) for cell in row))
    text = io.StringIO()
    terminal = Console()
    width = terminal.width if terminal.is_terminal and not wide else 400
    Console(file=text, width=width, highlight=False).print(table)
    return "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines()).lstrip("\n")


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
