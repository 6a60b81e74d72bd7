"""An error that nobody foresaw is ours, and no answer: what to say of it, and what to send us.

In: the exception. Out: one line, and a file that tells where in the program it was. Neither has text of an input: types
of exceptions and lines of the program only, no messages, which may quote names.
"""

from __future__ import annotations

import sys
import tempfile
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.files_read import names_read
from rosprivacy.analysis.text import counted
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator

PACKAGE = Path(__file__).resolve().parent.parent
SHOWN_AT_MOST = 3  # files that are named


def confessed(error: BaseException) -> str:
    """Write down where the program failed; return the line that says so.

    Where no file can be written, the line alone has to do.
    """
    first = error.__cause__ or error
    what = f"rosprivacy: an error of the program itself, and no answer: {_kind(first)} in {_place(first)}"
    read = [shown(name) for name in names_read() if not _is_ours(Path(name))]
    more = f" and {counted(len(read) - SHOWN_AT_MOST, 'more file')}" if len(read) > SHOWN_AT_MOST else ""
    inputs = f", and, if you may, what was read: {', '.join(read[:SHOWN_AT_MOST])}{more}" if read else ""
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="rosprivacy-error-", suffix=".txt", delete=False, encoding="utf-8"
        ) as file:
            file.write("".join(_lines(error)))
    except OSError:
        return f"{what}; please send us this line{inputs}"
    return f"{what}; please send us {shown(file.name)}, which has no text of your files{inputs}"


def _lines(error: BaseException) -> Iterator[str]:
    """A traceback without messages; what caused an error stands above it."""
    yield f"rosprivacy {__version__}, Python {sys.version.split()[0]}, {sys.platform}\n"
    for one in _chain(error):
        yield f"\n{_kind(one)}\n"
        yield from traceback.StackSummary.extract(traceback.walk_tb(one.__traceback__)).format()


def _chain(error: BaseException) -> list[BaseException]:
    """An error and its causes, the first cause first."""
    chain: list[BaseException] = []
    left: BaseException | None = error
    while left is not None and left not in chain:
        chain.append(left)
        left = left.__cause__ or left.__context__
    return chain[::-1]


def _kind(error: BaseException) -> str:
    kind = type(error)
    return kind.__name__ if kind.__module__ == "builtins" else f"{kind.__module__}.{kind.__name__}"


def _place(error: BaseException) -> str:
    """The innermost line of the program, as ``module.py:line``."""
    frames = [(Path(f.f_code.co_filename), line) for f, line in traceback.walk_tb(error.__traceback__)]
    ours = [(file, line) for file, line in frames if _is_ours(file)]
    file, line = (ours or frames or [(PACKAGE, 0)])[-1]
    return f"{file.parent.name}/{file.name}:{line}"


def _is_ours(file: Path) -> bool:
    """Whether a file came with the program; in a checkout the rooms are links."""
    rooms = {PACKAGE, *(room.resolve() for room in PACKAGE.iterdir() if room.is_symlink())}
    return bool(rooms & set(file.resolve().parents))
