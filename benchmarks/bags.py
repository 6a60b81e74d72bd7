"""Bags: bytes that are read against the size of the file, and time against the bare library that reads the summary.

A bag is read by what it says of itself; what its messages hold is passed over. Bytes are those that the process asks
the system for, cached or not (``/proc/self/io``).
"""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from measure import Measured, NotMeasured, Row, timed

from rosprivacy.ingest.running.bag_folders import read_bag, read_bags

if TYPE_CHECKING:
    from collections.abc import Iterator

COUNTS = Path("/proc/self/io")
MESSAGE = os.urandom(2**16)
START = 10**18
FILES = 1_000


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: a large bag of each storage, and a folder of small ones."""
    if not COUNTS.is_file():
        raise NotMeasured("the bytes that a process reads are counted on Linux only")
    size = 2**26 if quick else 2**29
    with TemporaryDirectory() as folder:
        file = _mcap(Path(folder, "large.mcap"), size)
        yield Row("bytes read of a large MCAP file", "the file", lambda: _bytes(file), 0.001, counts=True)
        rounds = 5 if quick else 15
        yield Row(
            "reading it",
            "the library's summary",
            lambda: timed(rounds, lambda: read_bag(str(file)), lambda: _bare(file)),
        )
        file.unlink()
        database = _sqlite(Path(folder, "large.db3"), size // 8)
        yield Row("bytes read of a large sqlite file", "the file", lambda: _bytes(database), 0.01, counts=True)
        database.unlink()
        bags = [_mcap(Path(folder, f"{number:04}.mcap"), 2**16) for number in range(FILES // (10 if quick else 1))]
        yield Row(
            f"{len(bags):,} MCAP files of a folder",
            "the library's summaries",
            lambda: timed(3, lambda: read_bags([folder]), lambda: [_bare(bag) for bag in bags]),
            bound=5,
        )


def _bytes(file: Path) -> Measured:
    before = _read()
    bag = read_bag(str(file))
    read, size = _read() - before, file.stat().st_size
    return Measured(f"{read:,} B", f"{size:,} B", read / size, f"{len(bag.topics)} topics")


def _read() -> int:
    return int(COUNTS.read_text("ascii").split()[1])  # rchar


def _bare(file: Path) -> object:
    with file.open("rb") as stream:
        return make_reader(stream).get_summary()


def _mcap(file: Path, size: int) -> Path:
    """An MCAP file in chunks of a megabyte, as recorders write them."""
    with file.open("wb") as stream:
        writer = Writer(stream, compression=CompressionType.NONE)
        writer.start()
        channels = [writer.register_channel(name, "cdr", 0) for name in ("/camera", "/odom")]
        for number in range(size // len(MESSAGE)):
            writer.add_message(channels[number % 2], START + number, MESSAGE, START + number)
        writer.finish()  # type: ignore[no-untyped-call] # it has no types
    return file


def _sqlite(file: Path, size: int) -> Path:
    with closing(sqlite3.connect(file)) as database:
        database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
        database.execute(
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)"
        )
        database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        database.execute("INSERT INTO topics VALUES (1, '/camera', 'sensor_msgs/msg/Image')")
        messages = ((number, 1, START + number, MESSAGE) for number in range(size // len(MESSAGE)))
        database.executemany("INSERT INTO messages VALUES (?, ?, ?, ?)", messages)
        database.commit()
    return file
