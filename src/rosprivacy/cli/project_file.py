"""The project file: what a folder says once of its system, so that commands need not be told it each time.

In: the working folder, or a file that is named. Out: a ``Project``. It is ``rosprivacy.toml``, or ``[tool.rosprivacy]``
in a ``pyproject.toml``, in the nearest folder upwards that has one. It comes with a checkout, so it is not trusted: it
names files below its own folder only, and neither where to read with fewer checks nor where to write.
"""

from __future__ import annotations

import hashlib
import os
import re
import stat
from functools import lru_cache, partial
from glob import has_magic, iglob
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.python_311 import tomllib
from rosprivacy.analysis.written_names import did_you_mean, nearest
from rosprivacy.cli.exit_code import FailOn
from rosprivacy.cli.options import Language
from rosprivacy.ingest.reading.bounded_file import beginning, leaves, read_utf8, what_leaves
from rosprivacy.ingest.reading.path_kinds import exists, is_file

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.python_311 import StrEnum

OWN_FILE, PYTHON_FILE = "rosprivacy.toml", "pyproject.toml"
MAX_BYTES = 1_000_000
SHIPPED = "rosprivacy:"  # what names of shipped label files begin with
TRUST = "if you trust it, name it with --project; else give --no-project"
SYNTAX = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")


class Project(NamedTuple):
    """What a project file states; each file as it is found from the working folder.

    Attributes
    ----------
    file, sha256
        The project file itself.
    baseline
        A saved analysis, with which ``diff`` compares.
    domain
        As of ``Options``.
    lang
        Of what people read.
    fail_on
        What ``analyze`` ends with a code other than 0 for.
    """

    file: str
    sha256: str
    policies: tuple[str, ...] = ()
    fleet: str | None = None
    labels: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    decisions: str | None = None
    baseline: str | None = None
    domain: int | None = None
    lang: Language | None = None
    fail_on: tuple[FailOn, ...] = ()

    @property
    def name_and_hash(self) -> tuple[str, str]:
        """What an answer says that it rests on."""
        return self.file, self.sha256

    def is_about(self, policies: Sequence[str] | None, fleet: str | None) -> bool:
        """Whether a user names no system, or that of this file."""
        return (not policies or _files_of(policies) == _files_of(self.policies)) and fleet in (None, self.fleet)

    def use(self, fields: Sequence[str], ignored: Sequence[str], reason: str) -> str:
        """Return the line that says what a command takes of it, and why not all; empty if there is nothing to say."""
        parts = [self._rows(fields)] if fields else []
        parts += [f"not its {self._rows(ignored)}, since {reason}"] if ignored else []
        return f"{shown(self.file)}: {shown('; '.join(parts))}" if parts else ""

    def _rows(self, names: Sequence[str]) -> str:
        rows = ((name, getattr(self, name)) for name in names)
        return ", ".join(f"{name} {' '.join(v) if isinstance(v, tuple) else v}" for name, v in rows)


def project_of(chosen: Path | None, *, ignored: bool = False) -> Project | None:
    """Return the project file that is named, or the one that is found; None where there is none, or none is wanted.

    Raises
    ------
    InputErrors
        If it cannot be trusted or read, or says what it may not; every problem at its line.
    """
    if ignored:
        return None
    file = chosen or nearest_project(Path.cwd())
    if file is None:
        return None
    if not chosen:
        _check_trust(file)
    return read_project(file)


def _files_of(names: Iterable[str]) -> set[str]:
    """What names and globs lead to."""
    return {os.path.realpath(file) for name in names for file in _matches(name)}


def _matches(name: str) -> Iterable[str]:
    """The files that a name stands for, as policies are named."""
    return iglob(name, recursive=True) if has_magic(name) else [name]  # noqa: PTH207 - as policies are named


def nearest_project(start: Path) -> Path | None:
    """Return the project file of the nearest folder that has one, from a folder upwards.

    The search ends at the root of a repository, at another file system and below the home folder: what lies further up
    belongs to something else.
    """
    home, device = _home(), start.stat().st_dev
    for folder in (start, *start.parents):
        if (folder == home and folder != start) or folder.stat().st_dev != device or not os.access(folder, os.X_OK):
            return None
        own, of_python = folder / OWN_FILE, folder / PYTHON_FILE
        files = [file for file in (own, of_python) if is_file(file) and (file == own or _has_table(file))]
        if len(files) > 1:
            what = f"states what {OWN_FILE} beside it states, too"
            raise InputErrors([InputError(_near(of_python), 0, what, "keep one of them")])
        if files:
            return files[0]
        if exists(folder / ".git"):
            return None
    return None


def read_project(file: Path) -> Project:
    """Read a project file.

    Raises
    ------
    InputErrors
        With every problem of it, one line each.
    """
    text, data = read_utf8(str(file), MAX_BYTES, partial(InputError, _near(file)))
    return _parsed(file, Path.cwd(), text, hashlib.sha256(data).hexdigest())


@lru_cache(maxsize=8)  # a command asks for it several times, and what it names may be a large folder
def _parsed(file: Path, working_folder: Path, text: str, sha256: str) -> Project:
    """What a text states; names are relative to the working folder."""
    del working_folder
    name = _near(file)
    try:
        whole = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        at = SYNTAX.search(str(error))
        line = int(at[1]) if at and at[1] else text.count("\n") + 1
        raise InputErrors([InputError(name, line, SYNTAX.sub("", str(error)), "correct the TOML")]) from None
    table: Mapping[str, Any] = whole
    if file.name == PYTHON_FILE:
        table = whole.get("tool", {}).get("rosprivacy")
        if not isinstance(table, dict):
            raise InputErrors([InputError(name, 0, "has no [tool.rosprivacy]", "write one, or name another file")])
    reader = _Reader(name, text, file.parent)
    values = {key.replace("-", "_"): reader.value(key, value) for key, value in table.items()}
    if "policies" in table and "fleet" in table:
        reader.problem("fleet", "policies and a fleet", "a system is one or the other: keep one of them")
    if reader.problems:
        raise InputErrors(reader.problems)
    return Project(name, sha256, **values)


class _Reader:
    """Values of one project file, and all that is wrong with them."""

    def __init__(self, file: str, text: str, folder: Path) -> None:
        self.problems: list[InputError] = []
        self._file, self._lines, self._folder = file, text.splitlines(), folder

    def problem(self, key: str, problem: str, hint: str) -> None:
        """Note what is wrong at the line of a key."""
        keys = (text.partition("=")[0].strip().strip("\"'") for text in self._lines)
        line = next((number for number, there in enumerate(keys, 1) if there == key), 0)
        self.problems.append(InputError(self._file, line, problem, hint))

    def value(self, key: str, value: Any) -> Any:
        """Return what a key states; None, and a problem, if it states nothing that there is."""
        known = KEYS.get(key)
        if known is None:
            near = nearest(key, KEYS)
            hint = did_you_mean(near, f"a project file states {', '.join(KEYS)}; all else is said on the command line")
            self.problem(key, f"unknown key {shown(repr(key))}", hint)
            return None
        return known.read(self, key, value)

    def file(self, key: str, value: Any) -> str | None:
        """One file below the folder of the project file."""
        if not isinstance(value, str) or not value:
            self.problem(key, f"{key} is no name of a file", f'write {key} = "name"')
            return None
        if key == "labels" and value.startswith(SHIPPED):
            return value
        path = self._folder / value
        root = os.path.realpath(self._folder)
        if (
            Path(value).is_absolute()
            or leaves(path, root)
            or any(leaves(each, root) for name in _matches(str(path)) for each in _all_of(name))
        ):
            self.problem(key, what_leaves(value, self._folder), "name a file below the project file, without links out")
            return None
        return _near(path)

    def files(self, key: str, value: Any) -> tuple[str, ...]:
        """Some files; one may stand without a list."""
        names = value if isinstance(value, list) else [value]
        return tuple(file for name in names if (file := self.file(key, name)) is not None)

    def number(self, key: str, value: Any) -> int | None:
        """A number from 0 on."""
        if isinstance(value, int) and not isinstance(value, bool) and value >= 0:
            return value
        self.problem(key, f"{shown(repr(value))} is no {key}", f"write {key} = 0, or another number")
        return None

    def language(self, key: str, value: Any) -> Language | None:
        """One of the languages."""
        return Language(value) if self._is_choice(key, value, Language) else None

    def failures(self, key: str, value: Any) -> tuple[FailOn, ...]:
        """What a command fails on."""
        names = value if isinstance(value, list) else [value]
        return tuple(FailOn(name) for name in names if self._is_choice(key, name, FailOn))

    def _is_choice(self, key: str, value: Any, kind: type[StrEnum]) -> bool:
        known = value in [each.value for each in kind]
        if not known:
            self.problem(key, f"{shown(repr(value))} is no value of {key}", f"write one of {', '.join(kind)}")
        return known


class _Key(NamedTuple):
    """What a key may state: how it is read, its JSON Schema, and what it means, for editors."""

    read: Callable[[_Reader, str, Any], Any]
    schema: Mapping[str, Any]
    description: str


FILE = {"type": "string", "minLength": 1}
FILES = {"anyOf": [FILE, {"type": "array", "items": FILE}]}
CODES = {"enum": [each.value for each in FailOn]}
KEYS = {
    "policies": _Key(_Reader.files, FILES, "Policies, folders, keystores or globs, below this folder."),
    "fleet": _Key(_Reader.file, FILE, "A fleet file, in place of policies."),
    "labels": _Key(_Reader.files, FILES, "Label files; rosprivacy:infrastructure is one that comes with the program."),
    "types": _Key(_Reader.files, FILES, "Files of message types."),
    "decisions": _Key(_Reader.file, FILE, "The log of decisions."),
    "baseline": _Key(_Reader.file, FILE, "A saved analysis, with which rosprivacy diff compares."),
    "domain": _Key(_Reader.number, {"type": "integer", "minimum": 0}, "The DDS domain."),
    "lang": _Key(_Reader.language, {"enum": [each.value for each in Language]}, "Of what people read."),
    "fail-on": _Key(
        _Reader.failures,
        {"anyOf": [CODES, {"type": "array", "items": CODES}]},
        "What rosprivacy analyze fails on.",
    ),
}


def project_schema() -> dict[str, Any]:
    """Return the JSON Schema of project files (draft 2020-12), for editors; a pyproject.toml has it below its table."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "rosprivacy project file",
        "description": "What a folder says once of its system, so that commands need not be told it each time.",
        "type": "object",
        "additionalProperties": False,
        "properties": {name: {**key.schema, "description": key.description} for name, key in KEYS.items()},
        "not": {"required": ["policies", "fleet"]},
    }


def _check_trust(file: Path) -> None:
    """Refuse a file that somebody else put there for whoever works below it."""
    if not hasattr(os, "getuid"):
        return
    name, folder = _near(file), file.parent.stat()
    if file.stat().st_uid != os.getuid():
        raise InputErrors([InputError(name, 0, "the project file belongs to another user", TRUST)])
    if folder.st_mode & stat.S_IWOTH:
        raise InputErrors([InputError(name, 0, "the project file lies in a folder that all may write to", TRUST)])


def _home() -> Path | None:
    try:
        return Path.home()
    except RuntimeError:  # nobody knows where it is
        return None


def _has_table(file: Path) -> bool:
    """Whether a ``pyproject.toml`` speaks of this program; one that does not is not even parsed."""
    data = beginning(str(file), MAX_BYTES, passed_over=True)
    if b"rosprivacy" not in data:
        return False
    try:
        return "rosprivacy" in tomllib.loads(data.decode()).get("tool", {})
    except (ValueError, TypeError):  # who reads it says what is wrong
        return True


def _all_of(name: str) -> Iterator[str]:
    """A file, or a folder with all below it, without following links to folders."""
    yield name
    for folder, folders, files in os.walk(name):
        yield from (os.path.join(folder, each) for each in (*folders, *files))  # noqa: PTH118 - many


def _near(file: Path) -> str:
    """A file by its name from the working folder."""
    return os.path.relpath(file)
