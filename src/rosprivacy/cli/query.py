"""``rosprivacy query``: questions to the database."""

from __future__ import annotations

import csv
import io
import json
import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import QueryError, reason, shown
from rosprivacy.analysis.text import printable
from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.inputs import refuse
from rosprivacy.cli.options import (
    Output,
    Server,
)
from rosprivacy.cli.output import emit
from rosprivacy.cli.row_records import natural_width, records

if TYPE_CHECKING:
    from collections.abc import Iterable

    from neo4j import Driver

    from rosprivacy.queries.library import Query
    from rosprivacy.queries.run import Rows


WIDEST_TABLE = 400  # in a file or a pipe


class RowFormat(StrEnum):
    """Of the rows of a query."""

    table = "table"
    json = "json"
    csv = "csv"


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
    schema: Annotated[
        bool, typer.Option("--schema", help="Print the labels, relationship types and properties of the graph instead.")
    ] = False,
    format: Annotated[  # noqa: A002 - the option's name
        RowFormat, typer.Option("--format", "-f", help="Of the rows; a table that is too wide becomes records.")
    ] = RowFormat.table,
    output: Output = None,
    limit: Annotated[int, typer.Option(min=1, help="Most rows to print.")] = 1000,
    timeout: Annotated[float, typer.Option(min=0.1, help="Seconds that the server may take.")] = 60.0,
    neo4j: Server = None,
) -> None:
    """Ask the database: one of the questions that come with the program, or Cypher of your own, which only reads."""
    from rosprivacy.ingest.database.other_schemas import HINT, ROBOTS, of_other_schemas
    from rosprivacy.queries.library import find, pack
    from rosprivacy.queries.run import check_names, run

    given = list(values or ())
    if (cypher is not None) + (file is not None) + (name is not None and "=" not in name) > 1:
        raise typer.BadParameter("name a question, or give --cypher, or --file")
    if schema:
        from rosprivacy.cli.schema_listing import listing

        beside = (("NAME", name), ("--cypher", cypher), ("--file", file))
        refuse("--schema", "no question", [what for what, value in beside if value is not None])
        emit(listing(), output)
        return
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
        rows = run(driver, text, parameters, limit=limit, timeout=timeout, known=_known_names(driver))
        robots = run(driver, ROBOTS, limit=None, timeout=timeout)
    emit(_text(rows, format, wide=output is not None), output)
    if rows.more:
        print(f"only the first {limit:,} rows are shown; --limit shows more", file=sys.stderr)
    if others := of_other_schemas(dict(zip(robots.columns, row, strict=True)) for row in robots.rows):
        print(f"warning: {others}, so rows can be missing or differ; {HINT}", file=sys.stderr)


def _known_names(driver: Driver) -> dict[str, frozenset[str]]:
    """The names that a query can ask for: those of the schema, and of all kinds of data, loaded or not."""
    from rosprivacy.ingest.database.schema_names import LABELS_OF_CATEGORIES, schema_names
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.queries.run import run

    stored = {str(label) for (label,) in run(driver, LABELS_OF_CATEGORIES, limit=None).rows}
    return schema_names(stored | {category.label for category in load().categories.values()})


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
        raise QueryError(f"{shown(str(file))}: cannot be read: {reason(error)}; name a file of Cypher") from None


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
    cells = [[printable(cell) for cell in row] for row in cells]
    terminal = Console()
    on_screen = terminal.is_terminal and not wide
    if natural_width(columns, cells) > (width := terminal.width if on_screen else WIDEST_TABLE):
        return records(columns, cells, width if on_screen else sys.maxsize)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for column in columns:
        table.add_column(Text(column), overflow="fold")
    for row in cells:
        table.add_row(*map(Text, row))
    text = io.StringIO()
    Console(file=text, width=width, highlight=False).print(table)
    return "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines()).lstrip("\n")
