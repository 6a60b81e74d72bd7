"""The rows of a question as the page has them: a table of bounded size, and a picture of what of the graph is in them.

In: ``Rows``. Out: facts for the template. What is cut is told (rule S11); the table is there whatever is drawn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import QueryError
from rosprivacy.analysis.text import printable
from rosprivacy.queries.graph_values import graph_values, nodes_in
from rosprivacy.queries.run import as_cell
from rosprivacy.reading.stored_rows import STORED_NAMES
from rosprivacy.report.pictures.query_view import query_view
from rosprivacy.report.text.graph_words import GraphWords

if TYPE_CHECKING:
    from rosprivacy.queries.graph_values import GraphValue
    from rosprivacy.queries.library import Query
    from rosprivacy.queries.run import Rows
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.pictures.phrases import Phrases
    from rosprivacy.report.pictures.picture import Picture

ROWS = 200
LONGEST_CELL = 2_000  # letters
LETTERS = 500_000  # of a table
BOXES = 150  # of a picture, as of a whole system


class Column(NamedTuple):
    """A column; what it means is said by the header of a question of the pack, in English."""

    name: str
    meaning: str


class Table(NamedTuple):
    """Rows to be shown.

    Attributes
    ----------
    more
        Whether there are more rows than these.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[str, ...], ...]
    more: bool


def table_of(rows: Rows, query: Query | None, words: Words) -> Table:
    """Return a table of at most ``ROWS`` rows and ``LETTERS`` letters.

    Raises
    ------
    QueryError
        If a value cannot be told, since it is too deep.
    """
    meanings = {column.name: column.meaning for column in query.columns} if query else {}
    columns = tuple(Column(printable(name), meanings.get(name, "")) for name in rows.columns)
    told: list[tuple[str, ...]] = []
    letters = 0
    try:
        say = GraphWords.for_rows(STORED_NAMES, rows.rows, words).of
        for row in rows.rows[:ROWS]:
            cells = tuple(_cut(as_cell(value, name, say), words) for value, name in zip(row, rows.columns, strict=True))
            letters += sum(map(len, cells))
            if told and letters > LETTERS:
                break
            told.append(cells)
    except RecursionError:
        raise QueryError("the rows hold lists in lists that are too deep to be read; ask for less") from None
    return Table(columns, tuple(told), rows.more or len(told) < len(rows.rows))


def _cut(text: str, words: Words) -> str:
    more = len(text) - LONGEST_CELL
    return printable(text) if more <= 0 else f"{printable(text[:LONGEST_CELL])}… ({words.count(more, 'cy.letters')})"


def picture_of(rows: Rows, title: str, say: Phrases) -> Picture | None:
    """Return a picture of the nodes, relationships and paths of the first rows; None if there are none, or too many.

    Notes
    -----
    It has rows as long as there are no more than ``BOXES`` boxes; the note says how many.
    """
    values: list[GraphValue] = []
    nodes: set[str] = set()
    drawn = 0
    for row in rows.rows[:ROWS]:
        here = list(graph_values(row))
        nodes |= {node.id for value in here for node in nodes_in(value)}
        if len(nodes) > BOXES:
            break
        values += here
        drawn += 1
    if not values:
        return None
    every = drawn == len(rows.rows) and not rows.more
    note = say.words("cy.drawn.all") if every else say.words("cy.drawn.some", n=drawn)
    return query_view(values, STORED_NAMES, title, (note,), say)
