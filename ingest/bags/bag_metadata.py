"""The ``metadata.yaml`` of a recording -> what it says, and which files it names.

In: a path. Out: ``Metadata``. It is read as every YAML file is; what it does not say is a gap, not a guess.
Source: rosbag2, ``rosbag2_storage/yaml.hpp``, versions 1 to 9.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import BagError, shown
from rosprivacy.analysis.model.recording import BagTopic
from rosprivacy.ingest.bags.recorded_file import Recorded, moment, united
from rosprivacy.ingest.reading import yaml_values

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.reading.yaml_values import Value

TOP = "rosbag2_bagfile_information"
NAME = "metadata.yaml"
LARGEST = 2**63


@dataclass(frozen=True, slots=True)
class Metadata:
    """What it says, and the names of its files, relative to it."""

    recorded: Recorded
    files: tuple[str, ...]


def read_metadata(file: str) -> Metadata:
    """Read the ``metadata.yaml`` of a recording.

    Raises
    ------
    InputError
        If it is none.
    """
    top, _ = yaml_values.read(file, partial(BagError, file))
    said = top.get(TOP) if top.kind == "map" else None
    if said is None or said.kind != "map":
        raise BagError(file, top.line, f"no {TOP!r}", "name the folder of a recording of rosbag2")
    start, duration = _number(said, "starting_time"), _number(said, "duration")
    span = (moment(start), moment(start + duration)) if start and duration is not None else (None, None)
    rows = said.get("topics_with_message_count")
    topics = [_topic(row) for row in rows.items] if rows else []
    gaps = [] if rows and all(topics) else ["metadata.yaml does not say which topics there are"]
    packed = [_text(said, key) for key in ("compression_format", "compression_mode")]
    recorded = Recorded(
        _text(said, "storage_identifier") or "unknown",
        united(topic for topic in topics if topic),
        *span,
        distro=_text(said, "ros_distro"),
        compression=f"{packed[0]} ({packed[1].lower()})" if all(packed) else packed[0],
        gaps=tuple(gaps),
        beside=tuple(_custom(said)),
    )
    names = said.get("relative_file_paths")
    return Metadata(recorded, tuple(sorted({item.text for item in names.items if item.text})) if names else ())


def _topic(row: Value) -> BagTopic | None:
    about = row.get("topic_metadata")
    name = _text(about, "name") if about else ""
    if about is None or not name:
        return None
    kind, digest = _text(about, "type"), _text(about, "type_description_hash")
    return BagTopic(name, (kind,) if kind else (), (digest,) if digest else (), _count(row.get("message_count")))


def _custom(said: Value) -> Iterator[str]:
    """Free text of the person who recorded."""
    custom = said.get("custom_data")
    for key, _, _ in custom.entries if custom else ():
        yield f"custom data {shown(key)!r}"


def _text(value: Value, key: str) -> str:
    found = value.get(key)
    return found.text if found and found.kind in ("text", "number") else ""


def _number(said: Value, key: str) -> int | None:
    """A time: a map of one number, ``nanoseconds`` or ``nanoseconds_since_epoch``."""
    found = said.get(key)
    return _count(found.entries[0][2]) if found and len(found.entries) == 1 else None


def _count(value: Value | None) -> int | None:
    digits = value.text if value else ""
    return int(digits) if digits.isdecimal() and digits.isascii() and int(digits[:20]) < LARGEST else None
