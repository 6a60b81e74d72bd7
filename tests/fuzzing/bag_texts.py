"""Choices -> a recording: its metadata, an MCAP file and a database, which say the same or not, whole or damaged."""

from __future__ import annotations

import json
import sqlite3
import struct
import sys
from contextlib import closing, suppress
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from mcap.writer import CompressionType, Writer

from rosprivacy.ingest.running.bag_folders import TOP
from tests.fuzzing.words import ODD_TEXT, with_fault

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

LABELS = """labels: 1
nodes: {/n0: {source: [Video]}}
elements: {run: {kind: storage, bag: bag, country: DE, retention: P1D}}
"""
NAMES = ("/a", "/b", "/c/image", "/new", "/spin/_action/feedback", "/s/_service_event", "/a/*", "a", "", *ODD_TEXT[:4])
TYPES = ("sensor_msgs/msg/Image", "std_msgs/msg/String", "", "x")
COUNTS = (0, 1, 7, 2**63, -1, "many", None)
FILES = ("bag_0.mcap", "bag_0.db3", "../base.xml", "away/secret.xml", "gone.mcap", "")
TABLE = "CREATE TABLE {}(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, format TEXT, more TEXT)"
HARMFUL = (
    "CREATE VIEW topics AS WITH RECURSIVE n(x) AS (SELECT 1 UNION SELECT x + 1 FROM n) SELECT x name, x type FROM n",
    "CREATE TABLE topics(name TEXT GENERATED ALWAYS AS (hex(zeroblob(999999))), type TEXT, x)",
    "CREATE TABLE topics(name BLOB, type REAL)",
)
Topics = list[tuple[str, str]]


def bag(choices: Choices) -> dict[str, str | bytes]:
    """The files of a recording, and labels that name it."""
    topics = [(choices.pick(NAMES[:6]), choices.pick(TYPES)) for _ in range(1 + choices.below(4))]
    return {
        "bag/metadata.yaml": _metadata(choices, _changed(choices, topics)),
        "bag/bag_0.mcap": _damaged(choices, _mcap(choices, _changed(choices, topics))),
        "bag/bag_0.db3": _damaged(choices, _sqlite(choices, _changed(choices, topics))),
        "bag.yaml": LABELS,
    }


def _changed(choices: Choices, topics: Topics) -> Topics:
    return [*topics, (choices.pick(NAMES), choices.pick(TYPES))] if choices.once_in(4) else topics


def _metadata(choices: Choices, topics: Topics) -> str:
    rows = [{"topic_metadata": {"name": name, "type": kind}, "message_count": 1} for name, kind in topics]
    for row in rows:
        if choices.once_in(6):
            row["message_count"] = choices.pick(COUNTS)
    said: dict[str, Any] = {
        "version": 9,
        "storage_identifier": choices.pick(("mcap", "sqlite3", "", "other")),
        "duration": {"nanoseconds": choices.pick((0, 5, 2**64))},
        "starting_time": {"nanoseconds_since_epoch": choices.pick((1, 10**18, 2**63, -5))},
        "relative_file_paths": choices.some(FILES, least=1, most=2),
        "topics_with_message_count": rows,
        "custom_data": {choices.pick(ODD_TEXT): "x"} if choices.once_in(6) else None,
    }
    whole: Any = {TOP: said}
    return json.dumps(with_fault(choices, whole) if choices.once_in(5) else whole, indent=1)


def _mcap(choices: Choices, topics: Topics) -> bytes:
    file = BytesIO()
    packed = choices.pick(tuple(CompressionType))
    writer = Writer(file, chunk_size=64, compression=packed, use_chunking=not choices.once_in(4))
    writer.start()
    for name, kind in topics:
        schema = writer.register_schema(kind, "ros2msg", b"")
        channel = writer.register_channel(name.encode("utf-8", "replace").decode(), "cdr", schema)
        writer.add_message(channel, 5, b"message", 5)
    if choices.once_in(8):
        writer.add_attachment(1, 1, choices.pick(("a", "\x1b[2J", "é")), "x", b"data")
    writer.finish()  # type: ignore[no-untyped-call] # it has no types
    return file.getvalue()


def _sqlite(choices: Choices, topics: Topics) -> bytes:
    with closing(sqlite3.connect(":memory:")) as database:
        if choices.once_in(6):
            database.executescript(choices.pick(HARMFUL))
        else:
            database.execute(TABLE.format("topics"))
            rows = [(name.encode("utf-8", "replace").decode(), kind) for name, kind in topics]
            database.executemany("INSERT INTO topics(name, type) VALUES (?, ?)", rows)
        if not choices.once_in(6):
            database.execute("CREATE TABLE messages(timestamp INTEGER, data BLOB)")
            database.execute("INSERT INTO messages VALUES (7, 'message')")
        database.commit()
        if sys.version_info >= (3, 11):
            return bytes(database.serialize())
        with TemporaryDirectory() as folder:
            file = Path(folder, "bag.db3")
            with closing(sqlite3.connect(file)) as copy:
                database.backup(copy)
            return file.read_bytes()


def _damaged(choices: Choices, data: bytes) -> bytes:
    """Half of the files are whole; the others are cut, or hold a length or a byte that is wrong."""
    fault = choices.pick(("", "", "", "cut", "length", "bytes"))
    if not fault:
        return data
    random = choices.random()
    at = random.randrange(len(data))
    if fault == "cut":
        return data[:at]
    changed = bytearray(data)
    if fault == "length":
        length = struct.pack("<Q", choices.pick((0, 1, 2**31, 2**63, 2**64 - 1)))
        changed[at : at + 8] = length
    for _ in range(random.randint(1, 3)) if fault == "bytes" else ():
        with suppress(IndexError):
            changed[random.randrange(len(data))] ^= 1 << random.randrange(8)
    return bytes(changed)
