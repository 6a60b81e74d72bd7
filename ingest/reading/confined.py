"""What a file names is read only below a folder: a stranger's file opens nothing else with our rights.

In: a name, and the folder. Out: whether it lies below. Symbolic links are followed first; a hard link cannot be told
from the file.
"""

from __future__ import annotations

import os
from pathlib import Path

from rosprivacy.analysis.errors import reason, shown

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
