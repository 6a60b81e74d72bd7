"""File names -> URIs that mean the same on every machine: relative to the root of the repository where they can be.

In: the names that a user gave. Out: URIs as RFC 3986 has them, and whether they are relative.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

if TYPE_CHECKING:
    from collections.abc import Iterable

LONGEST = 4000  # characters of a path; no system has longer ones


def repository_root(files: Iterable[str]) -> Path:
    """Return the folder that file names are shown relative to.

    The repository around the working directory if it holds one of the files, else that around the first file in one,
    else the working directory. A repository is a folder with ``.git`` in it.
    """
    here = Path.cwd()
    absolute = [Path(os.path.abspath(file)) for file in files if "\0" not in file]  # noqa: PTH100 - links stay links
    around = _repository(here)
    if around and (not absolute or any(file.is_relative_to(around) for file in absolute)):
        return around
    return next((found for file in absolute if (found := _repository(file.parent))), around or here)


def uri_of(file: str, root: Path) -> tuple[str, bool]:
    """Return the URI of a file, and whether it is relative to the root.

    >>> uri_of("/work/robot/my policy.xml", Path("/work"))
    ('robot/my%20policy.xml', True)
    >>> uri_of("/etc/policy.xml", Path("/work"))
    ('file:///etc/policy.xml', False)
    """
    path = Path(os.path.abspath(file[:LONGEST].replace("\0", "")))  # noqa: PTH100 - what a link points to has another name
    for base, inside in ((root, path), (_resolved(root), _resolved(path))):
        if inside.is_relative_to(base) and inside != base:
            return _quoted(inside.relative_to(base).as_posix()), True
    return f"file://{'' if path.as_posix().startswith('/') else '/'}{_quoted(path.as_posix())}", False


def _repository(folder: Path) -> Path | None:
    try:
        return next((above for above in (folder, *folder.parents) if (above / ".git").exists()), None)
    except OSError:  # a name that is too long, a folder that may not be entered
        return None


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError):  # as above; a loop of links
        return path


def _quoted(path: str) -> str:
    """Escape all that is no plain character of a path; a name that is no UTF-8 keeps its bytes."""
    return quote(os.fsencode(path), safe="/")
