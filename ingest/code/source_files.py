"""Files and folders that a user names -> the source code in them, read by its language.

What a folder holds is found as policies are found (rule S11). Left out are hidden folders, and what is no Python and no
C++ by its name or first line. Code below what was named that is not built here, by a file ``COLCON_IGNORE`` or
``AMENT_IGNORE``, and code of others (``third_party``, ``node_modules``, ``build`` …) are no code of the nodes: they are
left out, and that is told.
"""

from __future__ import annotations

import os
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ingest.code.python_code import read_python
from rosprivacy.ingest.code.source_code import SECONDS, Code, OutOfTime
from rosprivacy.ingest.policies.policy_files import contents
from rosprivacy.ingest.reading.bounded_file import beginning, read_regular
from rosprivacy.ingest.reading.path_kinds import exists, is_dir, is_file

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rosprivacy.analysis.errors import InputError

PYTHON = (".py", ".pyi")
CPP = (".c++", ".cc", ".cpp", ".cxx", ".h", ".h++", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp")
IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE")
OF_OTHERS = frozenset(
    ["third_party", "thirdparty", "3rdparty", "vendor", "vendored", "node_modules", "site-packages", "build", "install"]
)
MAX_BYTES = 4 * 2**20
FIRST_LINE = 200
BINARY = "name the source of it, or save it as UTF-8"
LATE = "split it, or put a file COLCON_IGNORE into its folder to leave it out"
MISSING = "install the extra [code] from where rosprivacy came from"


class Sources(NamedTuple):
    """What was read.

    Attributes
    ----------
    codes
        Sorted by file; what cannot be read is among them, with its problem.
    of_others
        Folders with code of others, or that is not built, that were left out; sorted.
    unread
        (file, folder) of code that was left out by the name of a folder alone: nobody said that it is not built.
    """

    codes: tuple[Code, ...]
    of_others: tuple[str, ...]
    unread: tuple[tuple[str, str], ...] = ()


def read_code(file: str, data: bytes) -> Code:
    """Read a file by its language; raises what ``read_cpp`` raises."""
    return (read_cpp if is_cpp(file) else read_python)(file, data)


def read_sources(sources: Iterable[str], read: Callable[[str, bytes], Code] = read_code) -> Sources:
    """Read all source code that some files and folders hold.

    Parameters
    ----------
    read
        Reads one file.
    """
    problems: list[InputError] = []
    files: set[str] = set()
    left_out: dict[str, str] = {}
    for source in sources:
        try:
            files.update(_files(source, problems, left_out))
        except (OSError, ValueError):
            problems.append(LabelError(source, 0, "cannot be a path", "correct it"))
    codes = [Code(error.file, "", problems=(error,)) for error in problems]
    lacking = False  # said once
    for file in sorted(files):
        try:
            codes.append(read(file, _text(file)))
        except LabelError as error:
            codes.append(Code(file, "", problems=(error,)))
        except OutOfTime:
            late = LabelError(file, 0, f"not read to its end in {SECONDS:g} s of processor time", LATE)
            codes.append(Code(file, "", problems=(late,)))
        except ImportError as error:
            refused = LabelError(file, 0, f"C++ needs a library that is not installed ({error})", MISSING)
            codes += [] if lacking else [Code(file, "c++", problems=(refused,))]
            lacking = True
    unread = ((file, folder) for file, folder in left_out.items() if file not in files and not _not_built(file, folder))
    folders = tuple(sorted(set(left_out.values())))
    return Sources(tuple(sorted(codes, key=lambda code: code.file)), folders, tuple(sorted(unread)))


def _files(source: str, problems: list[InputError], left_out: dict[str, str]) -> set[str]:
    found = contents(source)
    if found is None:
        if is_file(source) and not _language(source):
            problems.append(LabelError(source, 0, "no Python and no C++ by its name", "name source code, or a folder"))
            return set()
        return {source}  # one that is not there is told when it is read
    problems += [one for one in found.problems if not (_hidden(source, one.file) or _left_out(source, one.file))]
    files = {file for file in (*found.files, *found.passed_over) if not _hidden(source, file) and _language(file)}
    folders = {file: _left_out(source, file) for file in files}
    others = {folder for folder in folders.values() if folder}
    if not files:
        problems.append(LabelError(source, 0, "no Python and no C++ in it", "name the folder of a package"))
    elif all(folders.values()):
        what = f"no Python and no C++ in it but what is not read as code of others: {shown(', '.join(sorted(others)))}"
        problems.append(LabelError(source, 0, what, "name such a folder by itself to have it read"))
    left_out.update((file, folder) for file, folder in folders.items() if folder)
    return {file for file, folder in folders.items() if not folder}


def _text(file: str) -> bytes:
    data = read_regular(file, MAX_BYTES, partial(LabelError, file))
    if b"\0" in data:
        raise LabelError(file, 1, "no text in UTF-8: it has bytes that are zero", BINARY)
    return data


def is_cpp(file: str) -> bool:
    """Return whether a file is read as C++."""
    return Path(file).suffix.lower() in CPP


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


def _hidden(source: str, file: str) -> bool:
    """Whether a file stands in a hidden folder, below what was named, or is hidden itself."""
    return any(part.startswith(".") and part.strip(".") for part in _below(source, file)[1])


def _left_out(source: str, file: str) -> str:
    """The folder, below what was named, that a file stands in and that is left out; empty if there is none."""
    above, parts = _below(source, file)
    for at, part in enumerate(parts[:-1]):
        folder = str(above.joinpath(*parts[: at + 1]))
        if part in OF_OTHERS or _ignored(folder):
            return folder
    return ""


def _not_built(file: str, folder: str) -> bool:
    """Whether a file says that the folder, or one in it on the way to a file, is not built."""
    inside = (str(one) for one in Path(file).parents if one == Path(folder) or one.is_relative_to(folder))
    return any(map(_ignored, inside))


def _below(source: str, file: str) -> tuple[Path, tuple[str, ...]]:
    """The folder that was named, and the parts of the path from there."""
    folder = source if is_dir(source) else ""
    parts = Path(os.path.relpath(file, folder)).parts if folder else Path(file).parts[len(Path(source).parts) - 1 :]
    return Path(folder) if folder else Path(file).parents[len(parts) - 1], parts


@cache
def _ignored(folder: str) -> bool:
    return any(exists(Path(folder, name)) for name in IGNORED)
