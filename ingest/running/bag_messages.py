"""The files of a bag -> its messages as they lie there, one after the other: bytes, times and channel, never decoded.

In: paths. Out: ``RecordedMessage`` of each message. Of a ``.db3`` file SQLite is told which columns may be read, and
the database is opened read-only; one message is in memory at a time.

Source: rosbag2, ``rosbag2_storage_sqlite3``, schemas 1 to 4.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import BagError, shown
from rosprivacy.ingest.running.recorded_file import (
    LARGEST,
    EndedError,
    RecordedChannel,
    RecordedMessage,
    RecordedSchema,
    bounded_stream,
    state,
)
from rosprivacy.ingest.running.sqlite_file import connection, guard, limit_cells, refuse_computed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

SQLITE = ".db3"
MOST_TABLES = 1_000
LAST_MOMENT = 2**63
READABLE = {
    "sqlite_master": {"name", "type", "sql"},
    "topics": {"id", "name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash"},
    "messages": {"id", "ROWID", "topic_id", "timestamp", "data"},
    "message_definitions": {"topic_type", "encoding", "encoded_message_definition"},
}
NOTES = {
    "offered_qos_profiles": "offered_qos_profiles",
    "type_description_hash": "topic_type_hash",
}  # column -> in MCAP
MESSAGES = "SELECT topic_id, timestamp, data FROM messages ORDER BY rowid"
DEFINITIONS = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"


def messages_of(files: Iterable[str], extras: set[str]) -> Iterator[RecordedMessage]:
    """Yield the messages of some files, in their order; ``BagError`` where a file cannot be read to its end.

    Parameters
    ----------
    extras
        Takes up the names of what lies beside messages: attachments and metadata records.
    """
    for file in files:
        if Path(file.lower()).suffix == SQLITE:
            yield from _sqlite_messages(file)
        else:
            from rosprivacy.ingest.running.mcap_messages import mcap_messages  # noqa: PLC0415 - an extra

            yield from mcap_messages(file, extras)


def _sqlite_messages(file: str) -> Iterator[RecordedMessage]:
    with bounded_stream(file):  # it is noted as one that is read
        pass
    try:
        with closing(connection(file)) as database:
            guard(database, READABLE)
            limit_cells(database, LARGEST)
            channels = _channels(database, _tables(database))
            database.set_progress_handler(None, 0)  # there are as many messages as there are
            for row in database.execute(MESSAGES):
                yield _message(channels, *row)
    except (sqlite3.Error, ValueError, OverflowError) as error:
        what = f"cannot be read to its end: {shown(str(error))}"
        raise BagError(file, 0, what, "repair it first (`sqlite3 FILE .recover`)") from None


def _message(channels: dict[int, RecordedChannel], number: Any, moment: Any, data: Any) -> RecordedMessage:
    if not (number in channels and isinstance(moment, int) and isinstance(data, bytes)):
        raise EndedError("a message without a topic, a time or data")
    if not 0 <= moment < LAST_MOMENT:
        raise EndedError("a message of a time before 1970")
    return RecordedMessage(channels[number], 0, moment, moment, data)


def _tables(database: sqlite3.Connection) -> dict[str, str]:
    """The tables that are read, with how they were made; a view or a virtual table could run what it likes."""
    rows = database.execute("SELECT name, sql FROM sqlite_master WHERE type = 'table'").fetchmany(MOST_TABLES)
    tables = {str(name): str(sql) for name, sql in rows if str(sql).upper().startswith("CREATE TABLE")}
    for name in ("topics", "messages"):
        if name not in tables:
            raise EndedError(f"it has no table {name!r}")
    for name in ("topics", "messages", "message_definitions"):
        refuse_computed(tables.get(name, ""))
    return tables


def _channels(database: sqlite3.Connection, tables: dict[str, str]) -> dict[int, RecordedChannel]:
    """What the numbers of topics stand for."""
    schemas: dict[str, RecordedSchema] = {}
    if "message_definitions" in tables:
        for kind, encoding, text in database.execute(DEFINITIONS):
            schemas[str(kind)] = RecordedSchema(str(kind), str(encoding), str(text).encode("utf-8", "replace"))
    notes = [name for name in NOTES if name in tables["topics"]]
    question = f"SELECT {', '.join(['id', 'name', 'type', 'serialization_format', *notes])} FROM topics"  # noqa: S608 - our names
    channels: dict[int, RecordedChannel] = {}
    for number, name, kind, encoding, *texts in database.execute(question):
        metadata = tuple((NOTES[key], str(text)) for key, text in zip(notes, texts, strict=True) if text)
        schema = schemas.get(str(kind), RecordedSchema(str(kind))) if kind else None
        state(channels, number, RecordedChannel(str(name), str(encoding), schema, metadata))
    return channels
