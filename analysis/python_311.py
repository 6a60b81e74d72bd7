"""What Python brings from 3.11 on, for 3.10 too: from Python itself where it is there, else from here.

ROS 2 Humble runs on Python 3.10. Once Humble has ended, this module goes, and its names come from Python again.
"""

from __future__ import annotations

import sys
from datetime import datetime

if sys.version_info >= (3, 11):
    from contextlib import chdir
    from enum import StrEnum
    from typing import NotRequired, Self, TypedDict, Unpack, dataclass_transform

    import tomllib

    from_iso = datetime.fromisoformat
else:
    import os
    from contextlib import contextmanager
    from enum import Enum
    from pathlib import Path
    from typing import TYPE_CHECKING

    import tomli as tomllib
    from typing_extensions import NotRequired, Self, TypedDict, Unpack, dataclass_transform

    if TYPE_CHECKING:
        from collections.abc import Iterator

    class StrEnum(str, Enum):
        """Members are strings, and are written as their values."""

        def __str__(self) -> str:
            return str(self.value)

        __format__ = str.__format__  # type: ignore[assignment]

    @contextmanager
    def chdir(path: str | os.PathLike[str]) -> Iterator[None]:
        """Make a folder the current one until the ``with`` statement ends."""
        before = Path.cwd()
        os.chdir(path)
        try:
            yield
        finally:
            os.chdir(before)

    def from_iso(text: str) -> datetime:
        """Return a time of ISO 8601; 3.10 itself knows no ``Z``."""
        return datetime.fromisoformat(f"{text[:-1]}+00:00" if text.endswith("Z") else text)


__all__ = [
    "NotRequired",
    "Self",
    "StrEnum",
    "TypedDict",
    "Unpack",
    "chdir",
    "dataclass_transform",
    "from_iso",
    "tomllib",
]
