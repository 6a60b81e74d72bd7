"""One file of a bag: opened so that only so much of it is read, and what it says, put together with what others say.

In: a path; parts. Out: ``BoundedStream``, which no length in a stranger's file gets past; topics with all that is said
of each; ``RecordedMessage``, for the copy of a bag. What a reader skips is not read: a bag of a terabyte costs what its
summary costs.
"""

from __future__ import annotations

import os
from collections import defaultdict
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from rosprivacy.analysis.errors import BagError, reason
from rosprivacy.analysis.files_read import noted
from rosprivacy.analysis.model.recording import BagTopic
from rosprivacy.ingest.reading.bounded_file import nearest_file
from rosprivacy.ingest.reading.path_kinds import exists, is_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from typing import BinaryIO

LAST_TIME = 253_402_300_799 * 10**9  # of the year 9999, in nanoseconds
LARGEST = 256 * 2**20  # bytes of one chunk or message that is copied
T = TypeVar("T")
MOST_READ = 32 * 2**20  # bytes of one bag: the summary of an MCAP file of about 300 GB


class TooMuchError(ValueError):
    """More would have to be read than the bound."""


class EndedError(ValueError):
    """The file ends within what is read."""


class BoundedStream:
    """A file that is open.

    Attributes
    ----------
    size
        Bytes of the file.
    left
        Bytes that may still be read.
    """

    def __init__(self, file: BinaryIO, limit: int) -> None:
        self._file = file
        self.size = os.fstat(file.fileno()).st_size
        self.remaining = limit

    def read(self, size: int = -1) -> bytes:
        """Read exactly so many bytes.

        Raises
        ------
        TooMuchError, EndedError
            Before anything is read.
        """
        if size < 0 or size > self.size - self._file.tell():
            raise EndedError("the file ends within a record")
        if size > self.remaining:
            raise TooMuchError("more than is read of a bag")
        self.remaining -= size
        return self._file.read(size)

    def skip(self, size: int) -> None:
        """Pass over bytes without reading them."""
        if not 0 <= size <= self.size - self._file.tell():
            raise EndedError("the file ends within a record, or a record within itself")
        self._file.seek(size, os.SEEK_CUR)

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Go to a place of the file."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Return the place in the file."""
        return self._file.tell()


@contextmanager
def bounded_stream(file: str, limit: int = MOST_READ) -> Iterator[BoundedStream]:
    """Open a regular file, and note that it is read; ``BagError`` if it is none, or the system refuses it."""
    path = Path(file)
    try:
        if not exists(path):
            raise BagError(file, 0, "file not found", nearest_file(path))
        if not is_file(path):
            raise BagError(file, 0, "not a regular file", "name a regular file")
        with path.open("rb") as opened:
            yield BoundedStream(noted(opened, file), limit)
    except OSError as error:
        raise BagError(file, 0, f"cannot be read: {reason(error)}", "check the path and its permissions") from None


class RecordedSchema(NamedTuple):
    """What the messages of a channel look like, as the recorder wrote it down."""

    name: str
    encoding: str = ""
    data: bytes = b""


class RecordedChannel(NamedTuple):
    """A channel of a bag: its topic, its type, and what the recorder noted of it, such as its QoS."""

    topic: str
    encoding: str
    schema: RecordedSchema | None
    metadata: tuple[tuple[str, str], ...] = ()


class RecordedMessage(NamedTuple):
    """A message as it lies in a bag, with times in nanoseconds."""

    channel: RecordedChannel
    sequence: int
    log_time: int
    publish_time: int
    data: bytes


def state(stated: dict[int, T], number: int, content: T) -> None:
    """Note what a number of a file stands for; a second meaning would let one channel pass for another.

    >>> channels = {1: "/odom"}
    >>> state(channels, 1, "/camera")
    Traceback (most recent call last):
    rosprivacy.ingest.running.recorded_file.EndedError: a channel or a schema is stated twice, and differently
    """
    if stated.setdefault(number, content) != content:
        raise EndedError("a channel or a schema is stated twice, and differently")


@dataclass(frozen=True, slots=True)
class Recorded:
    """What a file, or the ``metadata.yaml`` of a folder, says; see ``Bag``."""

    storage: str
    topics: tuple[BagTopic, ...] = ()
    start: int | None = None
    end: int | None = None
    distro: str = ""
    compression: str = ""
    gaps: tuple[str, ...] = ()
    extras: tuple[str, ...] = ()


def united(topics: Iterable[BagTopic]) -> tuple[BagTopic, ...]:
    """Return topics by name, each once; a count that one of them does not say is not known.

    >>> [topic.messages for topic in united([BagTopic("/a", messages=1), BagTopic("/a", messages=2)])]
    [3]
    """
    by_name: dict[str, list[BagTopic]] = defaultdict(list)
    for topic in topics:
        by_name[topic.name].append(topic)
    return tuple(_merged_topic(name, same) for name, same in sorted(by_name.items()))


def _merged_topic(name: str, topics: list[BagTopic]) -> BagTopic:
    types = tuple(sorted({kind for topic in topics for kind in topic.types}))
    hashes = tuple(sorted({digest for topic in topics for digest in topic.hashes}))
    counts = [topic.messages for topic in topics if topic.messages is not None]
    return BagTopic(name, types, hashes, sum(counts) if len(counts) == len(topics) else None)


def moment(nanoseconds: int) -> int | None:
    """Return a time; None for one that nothing can have been recorded at.

    >>> moment(5), moment(-1), moment(10**21)
    (5, None, None)
    """
    return nanoseconds if 0 < nanoseconds <= LAST_TIME else None
