"""Files are written whole or not at all: to a neighbour first, then renamed over the old one.

What is no regular file (a pipe, ``/dev/stdout``) cannot be replaced so and is written to.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, reason

if TYPE_CHECKING:
    from collections.abc import Mapping


def write_texts(texts: Mapping[Path, str | bytes]) -> None:
    """Write UTF-8 texts, or bytes, to files, all of them or none.

    Raises
    ------
    InputError
        If a folder is not there or a file cannot be written; what was at the paths is then untouched.
    """
    staged: dict[str, Path] = {}
    at = Path()
    try:
        for at, text in texts.items():
            if at.exists() and not at.is_file() and not at.is_dir():
                at.write_bytes(_bytes(text))
            else:
                target = at.resolve()
                staged[_stage(target, text)] = target
        for temporary, at in staged.items():
            Path(temporary).replace(at)
    except (OSError, RuntimeError, ValueError) as error:
        hint = "name a file in a folder that can be written"
        raise InputError(str(at), 0, f"cannot be written: {reason(error)}", hint) from None
    finally:
        for temporary in staged:
            Path(temporary).unlink(missing_ok=True)


def _bytes(text: str | bytes) -> bytes:
    return text.encode() if isinstance(text, str) else text


def _stage(target: Path, text: str | bytes) -> str:
    """Write a text beside its target, with the target's permissions; return where."""
    if target.is_dir():
        raise IsADirectoryError(0, "it is a folder")
    mode = target.stat().st_mode if target.exists() else 0o666 & ~_umask()
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:50]}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(_bytes(text))
        Path(temporary).chmod(mode)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return temporary


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
