"""The files that a run has read: every reader notes them here, and the one writer writes none of them.

It stands here, as the errors do, because every room reads or writes. It opens no file: it keeps what the system says of
one that is open.

The notes live as long as a run, which is one call of the command line. Outside of a run nothing is kept and nothing is
refused: a program that uses the library may analyse and write as often and in as many threads as it likes.
"""

from __future__ import annotations

import os
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import BinaryIO

Key = tuple[int, int] | str  # device and inode, or a whole path
_NOTES: ContextVar[dict[Key, tuple[str, os.stat_result]] | None] = ContextVar("files_read", default=None)


@contextmanager
def one_run() -> Iterator[None]:
    """Keep what is read in the block, and forget it at its end; a run within a run has notes of its own.

    >>> with one_run():
    ...     note("labels.yaml", os.stat(os.curdir))
    ...     read_as("labels.yaml", None)
    'labels.yaml'
    >>> read_as("labels.yaml", None) is None
    True
    """
    token = _NOTES.set({})
    try:
        yield
    finally:
        _NOTES.reset(token)


def noted(file: BinaryIO, name: str) -> BinaryIO:
    """Note a file that is open, under the name that the user knows, and return it to be read.

    >>> import tempfile
    >>> with one_run(), tempfile.TemporaryFile() as file:
    ...     noted(file, "policy.xml") is file, read_as("link.xml", os.fstat(file.fileno()))
    (True, 'policy.xml')
    """
    note(name, os.fstat(file.fileno()))
    return file


def note(name: str, status: os.stat_result) -> None:
    """Note that a file is read; for one that another process reads, which has no notes here.

    >>> with one_run():
    ...     note("policy.xml", os.stat(os.curdir))
    ...     read_as("policy.xml", None)
    'policy.xml'
    """
    notes = _NOTES.get()
    if notes is not None:
        for key in _keys(name, status):
            notes.setdefault(key, (name, status))


def read_as(name: str, status: os.stat_result | None) -> str | None:
    """Return the name under which a file was read in this run; None if it was not.

    Parameters
    ----------
    name
        Any name of the file: links, other spellings and relative names lead to the same device and inode.
    status
        What the system says of the file, links followed; None if it is not there (any more).

    Examples
    --------
    >>> with one_run():
    ...     note("policy.xml", os.stat(os.curdir))
    ...     read_as("link.xml", os.stat(os.curdir)), read_as("./policy.xml", None), read_as("labels.yaml", None)
    ('policy.xml', 'policy.xml', None)
    """
    before = _noted(name, status)
    return before[0] if before else None


def names_read() -> list[str]:
    """Return the names of the files that were read in this run, each once, in the order of reading.

    >>> with one_run():
    ...     note("policy.xml", os.stat(os.curdir))
    ...     names_read()
    ['policy.xml']
    """
    return list(dict.fromkeys(name for name, _ in (_NOTES.get() or {}).values()))


def changed_since(name: str, status: os.stat_result | None) -> bool:
    """Return whether a file is another one than that which was read in this run, or is there though it was not.

    Parameters
    ----------
    name, status
        As of ``read_as``. Outside of a run nothing is known, and nothing counts as changed.

    Examples
    --------
    >>> now = os.stat(os.curdir)
    >>> with one_run():
    ...     note("labels.yaml", now)
    ...     changed_since("labels.yaml", now), changed_since("labels.yaml", None), changed_since("made.yaml", now)
    (False, True, False)
    >>> with one_run():
    ...     changed_since("made.yaml", now), changed_since("made.yaml", None)
    (True, False)
    """
    if _NOTES.get() is None:
        return False
    noted_as = _noted(name, status)
    if noted_as is None or status is None:
        return (noted_as is None) != (status is None)
    before = noted_as[1]
    return (before.st_ino, before.st_mtime_ns, before.st_size) != (status.st_ino, status.st_mtime_ns, status.st_size)


def _noted(name: str, status: os.stat_result | None) -> tuple[str, os.stat_result] | None:
    """The name under which a file was read, and what the system said of it then."""
    notes = _NOTES.get() or {}
    return next((notes[key] for key in _keys(name, status) if key in notes), None)


def _keys(name: str, status: os.stat_result | None) -> tuple[Key, ...]:
    """What a file is known by; the path too, for one that was replaced meanwhile or a file system without inodes."""
    path = os.path.abspath(name)  # noqa: PTH100 - by its text
    return ((status.st_dev, status.st_ino), path) if status and status.st_ino else (path,)
