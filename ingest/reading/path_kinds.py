"""What stands at a path: a file, a folder, or nothing; and an error where the system does not let us look.

From Python 3.14 on ``Path.exists``, ``is_file`` and ``is_dir`` answer False there too: with a path that is too long, or
in a folder that we may not enter. A policy would be passed over in silence, so what reads does not ask them.
"""

from __future__ import annotations

import errno
import stat
from pathlib import Path

NOTHING = {errno.ENOENT, errno.ENOTDIR, errno.EBADF, errno.ELOOP}
NOTHING_ON_WINDOWS = {
    21,
    123,
    1921,
}  # no disk in the drive, a name that there can be none of, a link that cannot be followed


def exists(path: str | Path) -> bool:
    """Return whether anything stands at a path; of a link, where it leads.

    Raises
    ------
    OSError
        If the system does not say.

    Examples
    --------
    >>> exists("."), exists("nowhere.xml")
    (True, False)
    """
    return _mode(path) is not None


def is_file(path: str | Path) -> bool:
    """Return whether a regular file stands at a path; raises as ``exists``."""
    mode = _mode(path)
    return mode is not None and stat.S_ISREG(mode)


def is_dir(path: str | Path) -> bool:
    """Return whether a folder stands at a path; raises as ``exists``."""
    mode = _mode(path)
    return mode is not None and stat.S_ISDIR(mode)


def _mode(path: str | Path) -> int | None:
    """The kind of what stands there and the rights on it, as the system codes them; None where nothing does."""
    try:
        return Path(path).stat().st_mode
    except ValueError:
        return None  # a name that no system takes
    except OSError as error:
        if error.errno in NOTHING or getattr(error, "winerror", None) in NOTHING_ON_WINDOWS:
            return None
        raise
