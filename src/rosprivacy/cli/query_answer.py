"""What ``query`` prints: rows as a table or records, JSON, CSV, or one drawing; and the schema of the graph."""

from __future__ import annotations

import io
import sys
import textwrap
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.analysis.text import counted, printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.ingest.neo4j_graph.schema import Property
    from rosprivacy.queries.run import QueryRows

WIDEST_TABLE = 400  # in a file or a pipe
GAP = 2  # between columns
REMEDY = "ask for less, or use a lower --limit"
CATEGORIES = """\
`Biometric` and `CARRIES_BIOMETRIC` stand for every kind of data; rosprivacy categories lists the kinds. Written in
capitals, words are parted: FaceTemplate has the labels FaceTemplate, FaceTemplateSource, FaceTemplateLeak and
FaceTemplateSanitizer, and the type CARRIES_FACE_TEMPLATE.
"""


class RowFormat(StrEnum):
    """Of the rows of a query."""

    table = "table"
    json = "json"
    csv = "csv"
    svg = "svg"


def not_drawn(title: str, columns: Iterable[str]) -> str:
    """Return why there is no drawing, and what to do."""
    names = ", ".join(map(shown, columns))
    hint = "return some with --cypher (RETURN path), or take a query that rosprivacy query lists as one to be drawn"
    return f"{title}: gives no node, relationship or path to draw, only {names}; {hint}"


def answer(rows: QueryRows, form: RowFormat, title: str, *, wide: bool) -> str | bytes:
    """Return rows in a format.

    Parameters
    ----------
    title
        Of a drawing.
    wide
        Whether the text goes to a file, where a line has no end.
    """
    return _drawing(rows, title) if form is RowFormat.svg else _text(rows, form, wide=wide)


def _drawing(rows: QueryRows, title: str) -> bytes:
    """All nodes, relationships and paths of some rows as one SVG; an error if there are none."""
    from rosprivacy.queries.graph_values import graph_values
    from rosprivacy.report.pictures.graphviz import drawn
    from rosprivacy.report.pictures.query_view import query_view
    from rosprivacy.systems.stored_system import STORED_NAMES

    if not rows.rows:
        raise QueryError(f"{title}: no rows, so nothing can be drawn; take --format table to have that as an answer")
    values = list(graph_values(rows.rows))
    if not values:
        raise QueryError(not_drawn(title, rows.columns))
    number = counted(len(rows.rows), "row")
    said = f"Only the first {number}: there are more, --limit draws more" if rows.truncated else number
    picture = query_view(values, STORED_NAMES, title, (said,))
    done = drawn(picture, "svg", direction="", remedy=REMEDY, instead=f"{REMEDY}, or take --format json")
    for note in done.remarks:
        print(note, file=sys.stderr)
    return done.data


def _text(rows: QueryRows, form: RowFormat, *, wide: bool) -> str:
    from rosprivacy.queries.graph_values import plain
    from rosprivacy.queries.run import as_cell
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.spreadsheet import as_csv
    from rosprivacy.report.text.graph_words import GraphWords
    from rosprivacy.systems.stored_system import STORED_NAMES

    if form is RowFormat.json:
        objects = [dict(zip(rows.columns, map(plain, row), strict=True)) for row in rows.rows]
        return as_text(objects)
    words = GraphWords.for_rows(STORED_NAMES, rows.rows).of
    cells = [[as_cell(*cell, words) for cell in zip(row, rows.columns, strict=True)] for row in rows.rows]
    if form is RowFormat.csv:
        both = (zip(*pair, strict=True) for pair in zip(rows.rows, cells, strict=True))
        return as_csv(rows.columns, ([_number_or(*pair) for pair in row] for row in both))
    return _table(rows.columns, cells, wide=wide)


def _number_or(value: object, cell: str) -> str | float:
    """A number as one, since -1 is no formula; else the cell."""
    return value if isinstance(value, int | float) and str(value) == cell else cell


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
    if _natural_width(columns, cells) > (width := terminal.width if on_screen else WIDEST_TABLE):
        return records(columns, cells, width if on_screen else sys.maxsize)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for column in columns:
        table.add_column(Text(column), overflow="fold")
    for row in cells:
        table.add_row(*map(Text, row))
    text = io.StringIO()
    Console(file=text, width=width, highlight=False).print(table)
    return "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines()).lstrip("\n")


def _natural_width(columns: Sequence[str], cells: Sequence[Sequence[str]]) -> int:
    """How wide a table of these cells is when no cell is wrapped."""
    widest = [max(map(len, column)) for column in zip(columns, *cells, strict=True)]
    return sum(widest) + GAP * (len(widest) - 1)


def records(columns: Sequence[str], cells: Sequence[Sequence[str]], width: int) -> str:
    r"""Return rows one below the other, a line for each cell, or several; a word longer than a line stands whole.

    >>> print(records(["robot", "path"], [["r1", "/camera -> /image -> /uplink"]], 24), end="")
    robot  r1
    path   /camera -> /image
           -> /uplink
    """
    names = max(map(len, columns)) + GAP
    return "\n".join(
        "".join(_field(column, cell, names, width) for column, cell in zip(columns, row, strict=True)) for row in cells
    )


def _field(column: str, cell: str, names: int, width: int) -> str:
    lines = textwrap.wrap(
        cell, max(width - names, 1), break_long_words=False, break_on_hyphens=False, replace_whitespace=False
    )
    first, *others = lines or [""]
    return "".join(f"{line}\n" for line in (f"{column:<{names}}{first}".rstrip(), *(" " * names + o for o in others)))


def listing() -> str:
    """Return all labels, relationship types and properties, each with its meaning, as the program loads by them."""
    from rosprivacy.ingest.neo4j_graph.schema import NODES, RELATIONSHIPS

    lines = [CATEGORIES]
    for node in NODES:
        labels = f" Further labels: {node.labels}." if node.labels else ""
        lines += [f"(:{node.label})  {node.meaning}{labels}", *_properties(node.properties)]
    for kind in RELATIONSHIPS:
        lines += [f"(:{kind.source})-[:{kind.type}]->(:{kind.target})  {kind.meaning}", *_properties(kind.properties)]
    return "\n".join(lines).replace("`", "")


def _properties(properties: tuple[Property, ...]) -> Iterator[str]:
    wide = max((len(field.name) for field in properties), default=0)
    for field in properties:
        yield f"    {field.name:<{wide}}  {field.type:<12}  {field.meaning}"
    yield ""
