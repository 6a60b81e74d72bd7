"""An MCAP file -> what its summary says; of one without a summary, the topics as far as its records can be followed.

In: a path. Out: ``Recorded``. Records of messages are passed over. The library ``mcap`` reads the records; it comes
with the extra 'bags', so this module is imported where there is such a file.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from io import BytesIO
from typing import IO, TYPE_CHECKING, Any, cast

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Channel, Chunk, Schema

from rosprivacy.analysis.errors import BagError, shown
from rosprivacy.analysis.model.recording import BagTopic
from rosprivacy.ingest.running.recorded_file import EndedError, Recorded, TooMuchError, bounded_stream, moment, united

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mcap.summary import Summary

    from rosprivacy.ingest.running.recorded_file import BoundedStream

MAGIC = b"\x89MCAP0\r\n"
HEAD = struct.Struct("<BQ")  # of a record: its code, how long it is
MOST_RECORDS = 500_000
MOST_UNPACKED = 64 * 2**20  # bytes of all chunks that are looked into
CONTENT = {"rosbag2"}  # metadata records of the recorder itself
ROS_DISTRO = "ROS_DISTRO"
CUT = "no summary: the recording broke off, or the file is cut"


def read_mcap(file: str) -> Recorded:
    """Read what an MCAP file says of itself; ``BagError`` if it is none."""
    with bounded_stream(file) as stream:
        if stream.size < len(MAGIC) or stream.read(len(MAGIC)) != MAGIC:
            raise BagError(file, 0, "not an MCAP file", "name a bag: .mcap, .db3, or the folder of a recording")
        try:
            summary = _summary(stream)
        except (McapError, struct.error, ValueError, OverflowError, OSError):
            summary = None
        if summary is not None and (recorded := _summary_topics(summary)):
            return recorded
        return _followed(stream)


def _summary(stream: BoundedStream) -> Summary | None:
    stream.seek(max(0, stream.size - len(MAGIC)))
    if stream.read(len(MAGIC)) != MAGIC:
        return None
    stream.seek(0)
    return SeekingReader(cast("IO[bytes]", stream), record_size_limit=stream.remaining).get_summary()


def _summary_topics(summary: Summary) -> Recorded | None:
    """What a summary says; None where it does not say how many channels there are, or lacks some of them."""
    statistics = summary.statistics
    named = {number for chunk in summary.chunk_indexes for number in chunk.message_index_offsets}
    if statistics is None or statistics.channel_count != len(summary.channels) or named - summary.channels.keys():
        return None
    counts = statistics.channel_message_counts
    counted = sum(counts.values()) == statistics.message_count
    topics = [
        _topic(channel, summary.schemas, counts.get(channel.id, 0) if counted else None)
        for channel in summary.channels.values()
    ]
    beside = [f"attachment {shown(one.name)!r}" for one in summary.attachment_indexes]
    beside += [f"metadata {shown(one.name)!r}" for one in summary.metadata_indexes if one.name not in CONTENT]
    for what, count, known in (
        ("attachment", statistics.attachment_count, summary.attachment_indexes),
        ("metadata record", statistics.metadata_count, summary.metadata_indexes),
    ):
        if count > len(known):
            beside.append(f"{count - len(known)} more of the kind: {what}")
    packed = sorted({chunk.compression for chunk in summary.chunk_indexes if chunk.compression})
    span = (statistics.message_start_time, statistics.message_end_time) if statistics.message_count else (0, 0)
    compression = f"{', '.join(map(shown, packed))} (chunks)" if packed else ""
    start, end = map(moment, span)
    found = tuple(sorted(set(beside)))
    return Recorded("mcap", united(topics), start, end, compression=compression, extras=found)


def _topic(channel: Channel, schemas: dict[int, Schema], count: int | None) -> BagTopic:
    schema = schemas.get(channel.schema_id)
    digest = channel.metadata.get("topic_type_hash", "")
    return BagTopic(channel.topic, (schema.name,) if schema else (), (digest,) if digest else (), count)


@dataclass
class _Found:
    """What is found on the way through the records."""

    channels: dict[int, Channel] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    compression: set[str] = field(default_factory=set)
    extras: set[str] = field(default_factory=set)
    times: list[int] = field(default_factory=list)
    records: int = 0
    unpacked: int = 0
    ended: bool = False
    unread: set[str] = field(default_factory=set)

    def count(self) -> None:
        """Count a record."""
        self.records += 1
        if self.records > MOST_RECORDS:
            raise TooMuchError("more records than are followed")


def _followed(stream: BoundedStream) -> Recorded:
    """Follow the records from the start, from head to head."""
    stream.seek(len(MAGIC))
    found = _Found()
    gaps = []
    try:
        _follow(stream, found)
    except TooMuchError:
        gaps.append("no summary, and more records than are followed; topics that come later are missing")
    except (EndedError, McapError, struct.error, ValueError, OverflowError):
        pass
    if not found.ended and not gaps:
        gaps.append(CUT)
    gaps += [f"{what}: topics in it are missing" for what in sorted(found.unread)]
    topics = united(_topic(channel, found.schemas, None) for channel in found.channels.values())
    span = (min(found.times), max(found.times)) if found.times and found.ended else (0, 0)
    packed = f"{', '.join(sorted(found.compression))} (chunks)" if found.compression else ""
    start, end = map(moment, span)
    beside = tuple(sorted(found.extras))
    return Recorded("mcap", topics, start, end, compression=packed, gaps=tuple(gaps), extras=beside)


def _follow(stream: BoundedStream, content: _Found) -> None:
    while not content.ended:
        code, length = HEAD.unpack(stream.read(HEAD.size))
        start = stream.tell()
        content.count()
        if code == 0:
            raise EndedError("no record begins with 0")
        if code in (Opcode.CHANNEL, Opcode.SCHEMA):
            _keep(code, stream.read(length), content)
        elif code == Opcode.CHUNK:
            _chunk(stream, length, content)
        elif code == Opcode.ATTACHMENT:
            content.extras.add("an attachment")
        elif code == Opcode.METADATA and _string(stream.read(length)) not in CONTENT:
            content.extras.add("a metadata record")
        stream.skip(length - (stream.tell() - start))
        content.ended = code == Opcode.FOOTER and stream.read(len(MAGIC)) == MAGIC


def _keep(code: int, data: bytes, content: _Found) -> None:
    if code == Opcode.CHANNEL:
        channel = Channel.read(ReadDataStream(BytesIO(data)))
        content.channels[channel.id] = channel
    elif code == Opcode.SCHEMA:
        schema = Schema.read(ReadDataStream(BytesIO(data)))
        content.schemas[schema.id] = schema


def _string(data: bytes) -> str:
    size = int.from_bytes(data[:4], "little")
    return data[4 : 4 + size].decode("utf-8", "replace")


def _chunk(stream: BoundedStream, length: int, content: _Found) -> None:
    """Unpack a chunk, and look for the topics in it; messages are passed over."""
    if length > stream.size - stream.tell():
        raise EndedError("the file ends within a chunk")
    chunk = Chunk.read(ReadDataStream(cast("IO[bytes]", stream)))
    content.times += [chunk.message_start_time, chunk.message_end_time]
    if chunk.compression:
        content.compression.add(shown(chunk.compression))
    try:
        data = unpacked(chunk.compression, chunk.data, MOST_UNPACKED - content.unpacked)
        content.unpacked += len(data)
        for code, record in _records(data, content):
            _keep(code, record, content)
    except TooMuchError:
        raise
    except ImportError:
        content.unread.add(
            f"a chunk with the compression {shown(chunk.compression)!r}, for which no library is installed"
        )
    except Exception as error:  # noqa: BLE001 - the libraries raise their own kinds for what is damaged
        content.unread.add(f"a chunk that cannot be unpacked ({shown(type(error).__name__)})")


def _records(data: bytes, content: _Found) -> Iterator[tuple[int, bytes]]:
    """The records of a chunk that name topics and types."""
    at = 0
    while at < len(data):
        content.count()
        code, length = HEAD.unpack_from(data, at)
        at += HEAD.size
        if length > len(data) - at:
            raise EndedError("a chunk ends within a record")
        if code in (Opcode.CHANNEL, Opcode.SCHEMA):
            yield code, data[at : at + length]
        at += length


def unpacked(compression: str, data: bytes, limit: int) -> bytes:
    """Return a chunk's records, no more than so many bytes whatever the chunk says of itself."""
    content: Any
    if not compression:
        content = data
    elif compression == "zstd":
        import zstandard  # noqa: PLC0415 - an extra

        content = zstandard.ZstdDecompressor().stream_reader(data).read(limit + 1)
    elif compression == "lz4":
        import lz4.frame  # noqa: PLC0415 - an extra

        content = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=limit + 1)
    else:
        raise ImportError(compression)
    if len(content) > limit:
        raise TooMuchError("a chunk that is too large")
    return bytes(content)
