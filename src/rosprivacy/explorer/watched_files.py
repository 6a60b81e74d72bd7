"""Whether files are still what was read: each is looked at first, and read again only if it looks otherwise.

In: names of files, with the hashes of what was read. Out: the names of those that hold something else now.
"""

from __future__ import annotations

import time
from pathlib import Path
from stat import S_ISREG
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.explorer.edited_file import digest_of
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.reading.bounded_file import contents

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

SETTLED = 2_000_000_000  # nanoseconds: a file system may not tell apart two changes that are nearer to each other
SECURED = b"</dds>"  # of a security file, signed or not, the text within is read, and has another hash than the file


class _Look(NamedTuple):
    """How a file looks without being read."""

    size: int
    modified: int
    changed: int
    inode: int


class WatchedFiles:
    """Remembers how files look, and what they held then."""

    def __init__(self) -> None:
        self._looks: dict[str, tuple[_Look, str]] = {}
        self._first: dict[str, str | None] = {}  # of security files: what they held when they were looked at first

    def changed(self, read: Iterable[tuple[str, str]]) -> tuple[str, ...]:
        """Return those that hold something else than what was read, sorted; one that is gone or closed is changed, too.

        Parameters
        ----------
        read
            (file, SHA-256 of what was read). What comes with the program does not change.
        """
        changed = set[str]()
        for file, digest in read:
            if not file.startswith(OURS) and self._holds(file) not in (digest, self._first[file], None):
                changed.add(file)
        return tuple(sorted(changed))

    def _holds(self, file: str) -> str | None:
        """The SHA-256 of what a file holds; empty if it cannot be read, None for what can be read only once."""
        try:
            status = Path(file).stat()
            if not S_ISREG(status.st_mode):
                self._first.setdefault(file, None)
                return None
            look = _Look(status.st_size, status.st_mtime_ns, status.st_ctime_ns, status.st_ino)
            seen = self._looks.get(file)
            if seen and seen[0] == look:
                return seen[1]
            data = contents(Path(file))
        except OSError:
            self._first.setdefault(file, None)
            return ""
        digest = digest_of(data)
        self._first.setdefault(file, digest if SECURED in data else None)
        if max(look.modified, look.changed) + SETTLED < time.time_ns():
            self._looks[file] = look, digest
        return digest


def files_in(rests_on: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Return the files that an answer rests on, with their hashes (rule S12).

    >>> list(files_in({"view": "declared", "types": [{"file": "t", "sha256": "1"}], "decisions": None}))
    [('t', '1')]
    """
    for rows in rests_on.values():
        for row in rows if isinstance(rows, list) else [rows]:
            if isinstance(row, dict) and "file" in row and "sha256" in row:
                yield row["file"], row["sha256"]
