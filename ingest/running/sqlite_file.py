"""A ``.db3`` file -> the topics of its table ``topics``, and from when to when; its messages are not read.

In: a path. Out: ``Recorded``. The database is opened read-only and as one that does not change, so nothing is written,
not even a log beside it. SQLite itself is told which columns may be read: what messages hold is not among them.
"""

from __future__ import annotations

import re
import sqlite3
import sys
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from rosprivacy.analysis.errors import BagError, shown
from rosprivacy.analysis.model.recording import BagTopic
from rosprivacy.ingest.reading.path_kinds import is_file
from rosprivacy.ingest.running.recorded_file import Recorded, bounded_stream, moment, united

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

MAGIC = b"SQLite format 3\0"
HEADER = 100  # bytes
WHOLE = 65_536  # the page size that 1 stands for
STEPS = 2_000_000  # of SQLite's machine, in one question
MOST_TOPICS = 20_000
LONGEST_CELL = 2**20
READABLE = {
    "sqlite_master": {"name", "type", "sql"},
    "topics": {"id", "name", "type", "type_description_hash"},
    "messages": {"timestamp"},
}
_COMPUTED = re.compile(r"\bAS\b", re.IGNORECASE)
DAMAGED = "the database is damaged; topics may be missing"


def read_sqlite(file: str) -> Recorded:
    """Read what a ``.db3`` file says of itself; ``BagError`` if it is no database of rosbag2."""
    gaps = list(_gaps(file))
    topics: tuple[BagTopic, ...] = ()
    span: tuple[int | None, int | None] = (None, None)
    try:
        with closing(connection(file)) as database:
            guard(database)
            columns = _columns(database, file)
            topics = _topics(database, columns)
            span = _span(database)
    except (sqlite3.Error, ValueError, OverflowError):
        gaps.append(DAMAGED)
    if len(topics) >= MOST_TOPICS:
        gaps.append(f"more than {MOST_TOPICS:,} topics")
    return Recorded("sqlite3", united(topics), *span, gaps=tuple(gaps))


def _gaps(file: str) -> Iterable[str]:
    """What the head of the file, and what lies beside it, tell of a recording that is not whole."""
    with bounded_stream(file) as stream:
        head = stream.read(min(HEADER, stream.size))
        size = stream.size
    if not head.startswith(MAGIC):
        raise BagError(file, 0, "not an SQLite database", "name a bag: .mcap, .db3, or the folder of a recording")
    page, pages = int.from_bytes(head[16:18], "big"), int.from_bytes(head[28:32], "big")
    if len(head) < HEADER or (page if page > 1 else WHOLE) * pages > size:
        yield "the file is cut; topics may be missing"
    for ending in ("-wal", "-journal"):
        beside = Path(f"{file}{ending}")
        if is_file(beside) and beside.stat().st_size:
            what = f"{shown(beside.name)!r} beside it is not read: the recording broke off, or goes on"
            yield f"{what}; topics may be missing"


def connection(file: str) -> sqlite3.Connection:
    """Open a database read-only, as one that does not change."""
    return sqlite3.connect(f"file:{quote(str(Path(file).absolute()))}?mode=ro&immutable=1", uri=True)


def guard(database: sqlite3.Connection, readable: Mapping[str, Collection[str]] = READABLE) -> None:
    """Allow to read a few columns, and nothing else; no question without end."""

    def allowed(action: int, table: str | None, column: str | None, *_: object) -> int:
        if action == sqlite3.SQLITE_SELECT:
            return sqlite3.SQLITE_OK
        known = action == sqlite3.SQLITE_READ and column in readable.get(table or "", ())
        return sqlite3.SQLITE_OK if known else sqlite3.SQLITE_DENY

    database.text_factory = lambda data: data.decode("utf-8", "replace")
    limit_cells(database, LONGEST_CELL)
    database.set_progress_handler(lambda: True, STEPS)
    database.set_authorizer(allowed)


def limit_cells(database: sqlite3.Connection, length: int) -> None:
    """Refuse to read a cell of more bytes than ``length``. On Python 3.10 the limit is SQLite's own, 1 GB."""
    if sys.version_info >= (3, 11):
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, length)


def refuse_computed(definition: str) -> None:
    """Raise ``sqlite3.DatabaseError`` for a table with a column that is computed: it is as large as it likes.

    Nobody records such a table; Python 3.10 has no limit for its cells.
    """
    if _COMPUTED.search(definition):
        raise sqlite3.DatabaseError("a column that is computed")


def _columns(database: sqlite3.Connection, file: str) -> list[str]:
    """Which of the columns that are read there are; a view or a virtual table could run what it likes."""
    asked = "SELECT sql FROM sqlite_master WHERE name = 'topics' AND type = 'table'"
    tables = [str(row[0]) for row in database.execute(asked).fetchmany(2)]
    if not tables or not tables[0].upper().startswith("CREATE TABLE"):
        raise BagError(file, 0, "a database without the table 'topics'", "name a .db3 file of rosbag2")
    refuse_computed(tables[0])
    return ["name", "type", *(["type_description_hash"] if "type_description_hash" in tables[0] else [])]


def _topics(database: sqlite3.Connection, columns: list[str]) -> tuple[BagTopic, ...]:
    rows = database.execute(f"SELECT {', '.join(columns)} FROM topics").fetchmany(MOST_TOPICS)  # noqa: S608 - our names
    return tuple(_topic(*row) for row in rows)


def _topic(name: Any, kind: Any, digest: Any = "") -> BagTopic:
    return BagTopic(str(name), (str(kind),) if kind else (), (str(digest),) if digest else ())


def _span(database: sqlite3.Connection) -> tuple[int | None, int | None]:
    """From when to when, by the index of times; not known where that would mean to go through all messages."""
    times = []
    for order in ("ASC", "DESC"):
        asked = f"SELECT timestamp FROM messages ORDER BY timestamp {order} LIMIT 1"  # noqa: S608 - our words
        try:
            row = database.execute(asked).fetchone()
        except sqlite3.Error:
            return None, None
        times.append(moment(row[0]) if row and isinstance(row[0], int) else None)
    return times[0], times[1]
