"""Files and folders that a user names -> the source code in them, read by its language.

What a folder holds is found as policies are found (rule S11). Left out are, as colcon does it, hidden folders and
folders with a file ``COLCON_IGNORE`` or ``AMENT_IGNORE``; and what is no Python and no C++ by its name or first line.
"""

from __future__ import annotations

import os
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.annotations.cpp_code import read_cpp
from rosprivacy.ingest.annotations.python_code import read_python
from rosprivacy.ingest.annotations.source_code import Code
from rosprivacy.ingest.policies.folders import contents
from rosprivacy.ingest.reading.bounded_file import beginning, read_regular

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.errors import InputError

PYTHON = (".py", ".pyi")
CPP = (".c++", ".cc", ".cpp", ".cxx", ".h", ".h++", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp")
IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE")
MAX_BYTES = 4 * 2**20
FIRST_LINE = 200
MISSING = "install the extra [code] from where rosprivacy came from"


def read_sources(sources: Iterable[str]) -> tuple[Code, ...]:
    """Read all source code that some files and folders hold, sorted by file.

    What cannot be read is in the result too, with its problem.
    """
    problems: list[InputError] = []
    files: set[str] = set()
    for source in sources:
        try:
            files.update(_files(source, problems))
        except (OSError, ValueError):
            problems.append(LabelError(source, 0, "cannot be a path", "correct it"))
    codes = [Code(error.file, "", problems=(error,)) for error in problems]
    lacking = False  # said once
    for file in sorted(files):
        try:
            data = read_regular(file, MAX_BYTES, partial(LabelError, file))
            codes.append((read_cpp if _language(file) == "c++" else read_python)(file, data))
        except LabelError as error:
            codes.append(Code(file, "", problems=(error,)))
        except ImportError as error:
            refused = LabelError(file, 0, f"C++ needs a library that is not installed ({error})", MISSING)
            codes += [] if lacking else [Code(file, "c++", problems=(refused,))]
            lacking = True
    return tuple(sorted(codes, key=lambda code: code.file))


def _files(source: str, problems: list[InputError]) -> set[str]:
    found = contents(source)
    if found is None:
        if Path(source).is_file() and not _language(source):
            problems.append(LabelError(source, 0, "no Python and no C++ by its name", "name source code, or a folder"))
            return set()
        return {source}  # one that is not there is told when it is read
    problems += [one for one in found.problems if not _left_out(source, one.file)]
    files = {file for file in (*found.files, *found.others) if not _left_out(source, file) and _language(file)}
    if not files:
        problems.append(LabelError(source, 0, "no Python and no C++ in it", "name the folder of a package"))
    return files


def _language(file: str) -> str:
    """``python`` or ``c++``; empty for what is neither."""
    ending = Path(file).suffix.lower()
    if ending in CPP:
        return "c++"
    if ending in PYTHON:
        return "python"
    if ending:
        return ""
    try:
        first = beginning(file, FIRST_LINE).partition(b"\n")[0]
    except OSError:
        return ""
    return "python" if first.startswith(b"#!") and b"python" in first else ""


def _left_out(source: str, file: str) -> bool:
    """Whether a file stands in a folder, below what was named, that is left out."""
    folder = source if Path(source).is_dir() else ""
    parts = Path(os.path.relpath(file, folder)).parts if folder else Path(file).parts[len(Path(source).parts) - 1 :]
    above = Path(folder) if folder else Path(file).parents[len(parts) - 1]
    if any(part.startswith(".") and part.strip(".") for part in parts):
        return True
    return any(_ignored(str(above.joinpath(*parts[:count]))) for count in range(1, len(parts)))


@cache
def _ignored(folder: str) -> bool:
    return any(Path(folder, name).exists() for name in IGNORED)
