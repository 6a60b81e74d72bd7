"""One writer at a time: a file of people's work is read, changed and written back by one run after the other.

In: a file that a command edits, decisions or labels. Out: a block in which no other run of the program edits it. An
editor or another program knows nothing of this; ``write_texts`` sees what they wrote meanwhile and writes nothing.
"""

from __future__ import annotations

import warnings
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.report.atomic import writing

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

LOCK_LIMIT = 60.0  # seconds; an edit takes one or two


@contextmanager
def editing(file: Path) -> Iterator[None]:
    """Let one run at a time edit a file; the others wait.

    The lock is a neighbour of the file, so that it holds for all users and containers that see the folder. The system
    drops the lock of a process that dies.

    Raises
    ------
    InputError
        If another run edits the file for longer than ``LOCK_LIMIT``, or its folder cannot be written.
    """
    import filelock  # noqa: PLC0415 - light start

    with writing(file):
        target = file.resolve()
        target.parent.stat()  # filelock would make the folder
        neighbour = target.with_name(f".{target.name[:50]}.lock")
        if neighbour.is_symlink():  # filelock follows none
            raise InputError(
                str(file), 0, f"{shown(str(neighbour))} is a link, and no lock of ours", "remove that link"
            )
        replaced = target.is_file() or not file.exists()
    if not replaced:  # a pipe
        yield
        return
    with writing(neighbour if neighbour.exists() else file):  # one that another user left may be closed to us
        lock = filelock.FileLock(neighbour, timeout=LOCK_LIMIT)
        try:
            with warnings.catch_warnings():  # a file system without such locks: filelock names the process in the file
                warnings.simplefilter("ignore", UserWarning)
                lock.acquire()
        except filelock.Timeout:
            what = f"another rosprivacy has been editing it for {LOCK_LIMIT:.0f} s"
            hint = f"wait until it has ended, or end it; if none runs on any machine, remove {shown(str(neighbour))}"
            raise InputError(str(file), 0, what, hint) from None
    try:
        yield
    finally:
        with suppress(OSError):  # those who wait see that it is gone, and make a new one
            if not neighbour.stat().st_size:
                neighbour.unlink()
        lock.release()
