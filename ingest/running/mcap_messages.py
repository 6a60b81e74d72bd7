"""An MCAP file -> its messages as they lie there, one after the other: bytes, times and channel, never decoded.

In: a file that is open. Out: ``RecordedMessage`` of each message; the names of what lies beside messages. The data
section alone counts: what the summary says is not believed. One chunk is in memory at a time. The library ``mcap``
reads the records; it comes with the extra 'bags', so this module is imported where there is such a file.

Source: the specification of MCAP.
"""

from __future__ import annotations

import struct
import zlib
from io import BytesIO
from typing import TYPE_CHECKING

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Schema

from rosprivacy.analysis.errors import BagError, shown
from rosprivacy.ingest.running.mcap_file import HEAD, MAGIC, unpacked
from rosprivacy.ingest.running.recorded_file import (
    LARGEST,
    EndedError,
    RecordedChannel,
    RecordedMessage,
    RecordedSchema,
    TooMuchError,
    bounded_stream,
    state,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.running.recorded_file import BoundedStream

WHOLE_FILE = 2**63
MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, when it was logged and published
FOLLOWED = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE, Opcode.CHUNK)
LONGEST_NAME = 4_096
NAMES = {Opcode.ATTACHMENT: ("attachment", 16), Opcode.METADATA: ("metadata", 0)}  # and where the name begins


def mcap_messages(file: str, extras: set[str]) -> Iterator[RecordedMessage]:
    """Yield the messages of a file; ``BagError`` if it cannot be read to its end.

    Parameters
    ----------
    extras
        Takes up the names of attachments and metadata records.
    """
    with bounded_stream(file, WHOLE_FILE) as stream:
        try:
            yield from _Records(extras).messages(stream)
        except TooMuchError:
            what = f"a chunk or a message has more than {LARGEST // 2**20} MiB"
            raise BagError(file, 0, what, "write it anew with smaller chunks (`mcap compress`)") from None
        except ImportError as error:
            what = f"a chunk with the compression {shown(str(error))!r}, for which no library is installed"
            raise BagError(file, 0, what, "write it anew with another one (`mcap compress`)") from None
        except (EndedError, McapError, struct.error, ValueError, OverflowError) as error:
            what = f"cannot be read to its end: {shown(str(error) or type(error).__name__)}"
            raise BagError(file, 0, what, "repair it first (`mcap recover`)") from None


class _Records:
    """The records of one file, as far as they were read."""

    def __init__(self, extras: set[str]) -> None:
        self._extras = extras
        self._schemas: dict[int, RecordedSchema] = {}
        self._channels: dict[int, RecordedChannel] = {}

    def messages(self, stream: BoundedStream) -> Iterator[RecordedMessage]:
        """Yield the messages; what is neither a message nor needed for one is passed over."""
        if stream.read(len(MAGIC)) != MAGIC:
            raise EndedError("it does not begin as an MCAP file")
        code = 0
        while code != Opcode.FOOTER:
            code, length = HEAD.unpack(stream.read(HEAD.size))
            start = stream.tell()
            if code in FOLLOWED:
                if length > LARGEST:
                    raise TooMuchError("a record that is too large")
                data = stream.read(length)
                yield from self._chunk(data) if code == Opcode.CHUNK else self._record(code, data)
            elif code in NAMES:
                self._extras.add(_extra(code, stream.read(min(length, LONGEST_NAME))))
            elif code == 0:
                raise EndedError("no record begins with 0")
            stream.skip(length - (stream.tell() - start))
        if stream.read(len(MAGIC)) != MAGIC:
            raise EndedError("it does not end as an MCAP file")

    def _chunk(self, data: bytes) -> Iterator[RecordedMessage]:
        chunk = Chunk.read(ReadDataStream(BytesIO(data)))
        if chunk.uncompressed_size > LARGEST:
            raise TooMuchError("a chunk that is too large")
        try:
            content = unpacked(chunk.compression, chunk.data, chunk.uncompressed_size)
        except ImportError:
            raise
        except TooMuchError:
            raise EndedError("a chunk is longer than it says") from None
        except Exception as error:  # noqa: BLE001 - the libraries raise their own kinds for what is damaged
            raise EndedError(f"a chunk cannot be unpacked ({type(error).__name__})") from None
        if len(content) != chunk.uncompressed_size:
            raise EndedError("a chunk is shorter than it says")
        if chunk.uncompressed_crc and zlib.crc32(content) != chunk.uncompressed_crc:
            raise EndedError("a chunk is not what its checksum says")
        at = 0
        while at < len(content):
            code, length = HEAD.unpack_from(content, at)
            at += HEAD.size
            if length > len(content) - at:
                raise EndedError("a chunk ends within a record")
            yield from self._record(code, content[at : at + length])
            at += length

    def _record(self, code: int, data: bytes) -> Iterator[RecordedMessage]:
        if code == Opcode.MESSAGE:
            number, sequence, logged, published = MESSAGE.unpack_from(data)
            if number not in self._channels:
                raise EndedError("a message of a channel that is not stated before it")
            yield RecordedMessage(self._channels[number], sequence, logged, published, data[MESSAGE.size :])
        elif code == Opcode.SCHEMA:
            schema = Schema.read(ReadDataStream(BytesIO(data)))
            state(self._schemas, schema.id, RecordedSchema(schema.name, schema.encoding, schema.data))
        elif code == Opcode.CHANNEL:
            channel = Channel.read(ReadDataStream(BytesIO(data)))
            if channel.schema_id and channel.schema_id not in self._schemas:
                raise EndedError("a channel of a schema that is not stated before it")
            facts = (channel.topic, channel.message_encoding, self._schemas.get(channel.schema_id))
            state(self._channels, channel.id, RecordedChannel(*facts, tuple(channel.metadata.items())))


def _extra(code: int, data: bytes) -> str:
    """What lies beside messages, with the name that it has."""
    what, start = NAMES[Opcode(code)]
    size = int.from_bytes(data[start : start + 4], "little")
    return f"{what} {shown(data[start + 4 : start + 4 + size].decode('utf-8', 'replace'))!r}"
