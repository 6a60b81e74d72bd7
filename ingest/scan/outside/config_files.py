"""Configurations of a checkout, in YAML or JSON5 -> values that know their line; what cannot be read is a gap."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.deployed.access_file import parse_json5
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import beginning, read_utf8
from rosprivacy.ingest.scan.scan_facts import CodePlace, External, Gap

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.ingest.reading.yaml_values import Value

MAX_BYTES = 2**20
JSON5 = (".json5",)
DOCUMENT = "---"


class Stated(NamedTuple):
    """What configurations state of the world outside ROS, and what of them could not be read."""

    externals: tuple[External, ...]
    gaps: tuple[Gap, ...]


def config_text(root: Path, file: str) -> str:
    """Return the text of a configuration; ``InputError`` if it cannot be read."""
    return read_utf8(str(root / file), MAX_BYTES, partial(InputError, file))[0]


def documents(root: Path, file: str) -> Iterator[Value]:
    """Yield the documents of a file of YAML or JSON5, each with the lines that it has there.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    text, fail = config_text(root, file), partial(InputError, file)
    if file.endswith(JSON5):
        yield parse_json5(text, fail)
        return
    lines = text.split("\n")
    begins = [at for at, line in enumerate(lines) if line.rstrip() == DOCUMENT]
    for first, last in zip([0, *(at + 1 for at in begins)], [*begins, len(lines)], strict=True):
        part = "\n".join(lines[first:last])
        if any(line.strip() and not line.lstrip().startswith("#") for line in lines[first:last]):
            yield yaml_values.parse("\n" * first + part, fail)


def first_bytes(root: Path, file: str) -> bytes:
    """Return the beginning of a file, to see what it is; nothing of one that cannot be read."""
    try:
        return beginning(str(root / file), MAX_BYTES, passed_over=True)
    except (OSError, ValueError):
        return b""


def unread(file: str, error: InputError) -> Gap:
    """Return the gap that a configuration is which cannot be read."""
    return Gap(CodePlace(file, error.line), "file", f"not read: {error.problem}")
