"""A file that the user names -> its bytes: a regular file, of bounded size, or an error that says why not.

A pipe would be waited for, a device read without end: neither is opened. What a file names in its turn is read only
below a folder, so that a stranger's file opens nothing else with our rights: symbolic links are followed first; a hard
link cannot be told from the file. What is read is noted, so that it is not written in the same run.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import reason, shown
from rosprivacy.analysis.files_read import noted
from rosprivacy.analysis.written_names import MUCH, did_you_mean, nearest
from rosprivacy.ingest.reading.path_kinds import exists, is_file

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.errors import InputError

WIDEN = "move the file inside it, or widen with --include-root"


def leaves(file: str | Path, root: str | Path) -> bool:
    """Return whether a file, or what a link leads to, lies outside a folder; one that is not there by its name.

    Parameters
    ----------
    root
        Links followed.

    Examples
    --------
    >>> here = os.path.realpath(os.curdir)
    >>> leaves("policies/robot.xml", here), leaves("policies/../../robot.xml", here), leaves("/etc/passwd", here)
    (False, True, True)
    """
    return not Path(os.path.realpath(file)).is_relative_to(root)


def what_leaves(name: str, root: str | Path) -> str:
    """Return what to say of a name that leaves a folder."""
    return f"{shown(repr(name))} leaves the folder {shown(str(root))}"


def unusable(file: str) -> str:
    """Return why the system can look for no file of that name, whether there is one or not; empty if it can.

    >>> unusable("nowhere.xml"), unusable("a" * 300)
    ('', 'File name too long')
    """
    try:
        os.stat(file)  # noqa: PTH116 - a path object refuses some names in its own words
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except (OSError, ValueError) as error:
        return reason(error)
    return ""


def contents(path: Path, name: str = "") -> bytes:
    """Read a file whole, and note that it was read; for callers that have made sure what it is.

    Parameters
    ----------
    name
        By which the user knows it; the path by default.
    """
    with path.open("rb") as file:
        return noted(file, name or str(path)).read()


def beginning(name: str, size: int, *, passed_over: bool = False) -> bytes:
    """Read the first bytes of a regular file by the name that the user knows it by; none of anything else.

    Parameters
    ----------
    passed_over
        Whether nothing in it goes into an answer: then it is not noted, and may be written in this run.

    Raises
    ------
    OSError, ValueError
        If it cannot be read.
    """
    path = Path(name)
    if not is_file(path):
        return b""
    with path.open("rb") as file:
        return (file if passed_over else noted(file, name)).read(size)


def nearest_file(path: Path) -> str:
    """Return what to do about a file that is not there: the nearest names in its folder."""
    try:
        there = sorted(other.name for other in path.parent.iterdir())
    except (OSError, ValueError):
        there = []
    near = nearest(path.name, there, like=MUCH)  # names that share their ending only are not alike
    return did_you_mean([str(path.with_name(name)) for name in near], "correct the path")


def read_regular(file: str, max_bytes: int, fail: Callable[[int, str, str], InputError]) -> bytes:
    """Read a file whole.

    Parameters
    ----------
    fail
        Makes the error of the caller's kind from line, problem and hint.

    Raises
    ------
    InputError
        Of the caller's kind.
    """
    path = Path(file)
    try:
        if not file:
            raise fail(0, "no file named", "name a file")
        if not exists(path):
            raise fail(0, "file not found", nearest_file(path))
        if not is_file(path):
            raise fail(0, "not a regular file", "name a regular file")
        if path.stat().st_size > max_bytes:
            raise fail(0, f"more than {max_bytes} bytes", "split the file")
        return contents(path)
    except (OSError, ValueError) as error:
        raise fail(0, f"cannot be read: {reason(error)}", "check the path and its permissions") from None


def read_utf8(file: str, max_bytes: int, fail: Callable[[int, str, str], InputError]) -> tuple[str, bytes]:
    """Read a file whole as UTF-8; return its text and its bytes.

    Parameters
    ----------
    fail
        As in ``read_regular``.

    Raises
    ------
    InputError
        Of the caller's kind.
    """
    data = read_regular(file, max_bytes, fail)
    try:
        return data.decode("utf-8-sig"), data
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise fail(line, "not UTF-8", "save the file as UTF-8") from None
