"""Files are written whole or not at all: to a neighbour first, then renamed over the old one."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from rosprivacy.analysis.errors import InputError


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text to a file in one step.

    Raises
    ------
    InputError
        If the folder is not there or cannot be written; what was at the path is then untouched.
    """
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:50]}.")
        try:
            with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
            Path(temporary).chmod(path.stat().st_mode if path.exists() else 0o666 & ~_umask())
            Path(temporary).replace(path)
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        hint = "name a file in a folder that can be written"
        raise InputError(str(path), 0, f"cannot be written: {error.strerror}", hint) from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
