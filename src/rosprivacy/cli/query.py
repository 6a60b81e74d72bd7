"""``rosprivacy query``: questions to the database."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.analysis.errors import QueryError, reason, shown
from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.exit_code import UNDETERMINED
from rosprivacy.cli.inputs import refuse, takes_groups
from rosprivacy.cli.options import Output, Server
from rosprivacy.cli.output import emit, not_for_a_terminal
from rosprivacy.cli.query_answer import RowFormat, answer, listing, not_drawn

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.queries.library import Query


def complete_query(incomplete: str) -> list[str]:
    """Return the queries that begin so, for shell completion."""
    from rosprivacy.queries.library import pack

    return [name for name in pack() if name.startswith(incomplete)]


class QuestionOptions(NamedTuple):
    """What is asked."""

    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            autocompletion=complete_query,
            show_default=False,
            help="Question to ask; without it the questions are listed.",
        ),
    ] = None
    values: Annotated[
        list[str] | None,
        typer.Argument(metavar="KEY=VALUE", show_default=False, help="Parameters of the question."),
    ] = None
    cypher: Annotated[str | None, typer.Option(metavar="TEXT", show_default=False, help="Ask this instead.")] = None
    file: Annotated[
        Path | None, typer.Option("--file", metavar="FILE", show_default=False, help="Ask what stands in this file.")
    ] = None
    show: Annotated[bool, typer.Option("--show", help="Print the question's Cypher instead of asking it.")] = False
    schema: Annotated[
        bool, typer.Option("--schema", help="Print the labels, relationship types and properties of the graph instead.")
    ] = False


class RowOptions(NamedTuple):
    """How rows are written."""

    format: Annotated[
        RowFormat,
        typer.Option(
            "--format",
            "-f",
            help="Of the rows; a table that is too wide becomes records. SVG draws nodes, relationships and paths.",
        ),
    ] = RowFormat.table
    output: Output = None
    limit: Annotated[
        int | None,
        typer.Option(
            min=1,
            show_default=False,
            help="Most rows to print; without it 1000 in a table or a picture, and all in JSON and CSV. JSON or CSV "
            "that a limit cuts ends with exit code 4.",
        ),
    ] = None
    timeout: Annotated[float, typer.Option(min=0.1, help="Seconds that the server may take.")] = 60.0


@takes_groups
def query(
    question: QuestionOptions,
    written: RowOptions,
    neo4j: Server = None,
) -> None:
    """Ask the database: one of the questions that come with the program, or Cypher of your own, which only reads."""
    from rosprivacy.queries.library import find, pack
    from rosprivacy.queries.run import LIMIT
    from rosprivacy.systems.stored_system import rows_of

    name, cypher, file, output = question.name, question.cypher, question.file, written.output
    given = list(question.values or ())
    if (cypher is not None) + (file is not None) + (name is not None and "=" not in name) > 1:
        raise typer.BadParameter("name a question, or give --cypher, or --file")
    if question.schema:
        others = (("NAME", name), ("--cypher", cypher), ("--file", file))
        refuse("--schema", "no question", [what for what, value in others if value is not None])
        emit(listing(), output)
        return
    asked = None
    if cypher is None and file is None:
        asked = find(name) if name is not None else None
        if asked is None or question.show:
            emit(asked.text if asked else _listed(pack().values()), output)
            return
        text, parameters = asked.text, asked.values(_pairs(given))
    else:
        text = cypher if cypher is not None else _read(file)
        parameters = dict(_pairs([*([name] if name else []), *given]))
    if written.format is RowFormat.svg:
        _check_drawing(asked, output)
    read_by_programs = written.format in (RowFormat.json, RowFormat.csv)
    most = written.limit or (None if read_by_programs else LIMIT)
    with driver_of(neo4j) as driver:
        rows, warning = rows_of(driver, text, parameters, limit=most, timeout=written.timeout, query=asked)
    emit(answer(rows, written.format, _title(asked, given, file, text), wide=output is not None), output)
    if rows.truncated:
        print(f"only the first {most:,} rows are shown; --limit shows more", file=sys.stderr)
    if warning:
        print(f"warning: {warning}", file=sys.stderr)
    if rows.truncated and read_by_programs:
        raise typer.Exit(UNDETERMINED)


def _listed(queries: Iterable[Query]) -> str:
    lines = []
    for query in queries:
        parameters = " ".join(
            f"{p.name}=…" if p.default is None else f"[{p.name}={json.dumps(p.default)}]" for p in query.parameters
        )
        drawn = " Can be drawn: -f svg." if query.drawable else ""
        lines += [f"{query.name} {parameters}".rstrip(), f"    {query.description}{drawn}"]
    return "\n".join([*lines, ""])


def _check_drawing(query: Query | None, output: Path | None) -> None:
    """Refuse, before anything is asked, what nobody could see or what cannot be drawn."""
    not_for_a_terminal("SVG", output)
    if query and not query.drawable:
        raise QueryError(not_drawn(query.name, (column.name for column in query.columns)))


def _title(query: Query | None, parameters: list[str], file: Path | None, text: str) -> str:
    """What a picture is of: the question with its parameters, the file's name, or the Cypher."""
    said = " ".join([query.name, *parameters]) if query else file.name if file else " ".join(text.split())
    return shown(said)


def _pairs(parameters: list[str]) -> dict[str, str]:
    pairs: dict[str, str] = {}
    for text in parameters:
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
