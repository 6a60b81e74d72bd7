"""Bags as another library (``rosbags``) writes them, and as the ``mcap`` library does."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

IMAGE, ODOMETRY = "sensor_msgs/msg/Image", "nav_msgs/msg/Odometry"
TOPICS = {"/camera": (IMAGE, 5), "/odom": (ODOMETRY, 1)}
START = 1_700_000_000 * 10**9
SECRET = b"the face of somebody"


@cache
def _store() -> Any:
    return get_typestore(Stores.ROS2_JAZZY)


def rosbag2(
    folder: Path,
    storage: str = "mcap",
    topics: Mapping[str, tuple[str, int]] = TOPICS,
    *,
    packed: str = "",
    custom: str = "",
) -> Path:
    """Write a recording: (type, how many messages) by topic."""
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin[storage.upper()])
    if packed:
        writer.set_compression(CompressionMode[packed.upper()], CompressionFormat.ZSTD)
    if custom:
        writer.set_custom_data("operator", custom)
    with writer:
        at = START
        for name, (kind, count) in topics.items():
            connection = writer.add_connection(name, kind, typestore=_store())
            for _ in range(count):
                writer.write(connection, at, SECRET * 5)
                at += 10**9
    return folder


def mcap(file: Path, packed: str = "ZSTD", *, messages: int = 50, attachment: str = "", metadata: str = "") -> Path:
    """Write an MCAP file in chunks."""
    with file.open("wb") as stream:
        writer = McapWriter(stream, chunk_size=2_000, compression=CompressionType[packed])
        writer.start()
        for number, (name, (kind, _)) in enumerate(TOPICS.items()):
            schema = writer.register_schema(kind, "ros2msg", b"")
            channel = writer.register_channel(name, "cdr", schema)
            for at in range(messages if number == 0 else 1):
                writer.add_message(channel, START + at, SECRET * 5, START + at)
        if attachment:
            writer.add_attachment(START, START, attachment, "image/png", b"picture")
        if metadata:
            writer.add_metadata(metadata, {"driver": "A. Person"})
        writer.finish()  # type: ignore[no-untyped-call] # it has no types
    return file
