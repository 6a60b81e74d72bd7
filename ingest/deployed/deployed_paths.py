"""What the user names, told apart by what is in it: SROS 2 policies, or permissions files and keystores.

In: paths. Out: two lists of them. Light, since every command asks it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.ingest.reading.bounded_file import beginning
from rosprivacy.ingest.reading.file_kinds import HEAD, is_signed
from rosprivacy.ingest.reading.path_kinds import is_dir

if TYPE_CHECKING:
    from collections.abc import Iterable

PARTS = ("enclaves", "public")  # folders of a keystore


def deployed(arguments: Iterable[str]) -> tuple[list[str], list[str]]:
    """Return which of some arguments are permissions files or keystores, and which are something else."""
    ours: list[str] = []
    others: list[str] = []
    for argument in dict.fromkeys(arguments):
        (ours if _is_deployed(argument) else others).append(argument)
    return ours, others


def _is_deployed(argument: str) -> bool:
    try:
        head = beginning(argument, HEAD)
    except (OSError, ValueError):
        return False  # who reads it says why not
    return is_signed(head) or b"<dds" in head or is_keystore(argument)


def is_keystore(folder: str) -> bool:
    """Return whether a folder is an SROS 2 keystore."""
    try:
        return all(is_dir(Path(folder, name)) for name in PARTS)
    except (OSError, ValueError):
        return False
