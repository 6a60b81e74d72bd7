"""Parts that were read, in a folder of the user's: a run that goes on where one was killed does not read them again.

In: some units, and what reads them. Out: the same as this returns, from a file where all that was read then is as it
was. The file of a part is named by its units and by what they are read with, and begins with the hash of what follows.
That is unpickled: so the folder is its owner's alone, as a folder of keys is, and nothing but values of this program is
made of it.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import stat
import time
from dataclasses import dataclass, fields
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputError, InputErrors, reason
from rosprivacy.analysis.files_read import names_read, one_run
from rosprivacy.analysis.model import FALLBACK_TAKEN
from rosprivacy.ingest.fleet.alike_robots import digest
from rosprivacy.ingest.reading.path_kinds import exists, is_dir
from rosprivacy.report.atomic import write_texts
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rosprivacy.parts.units import Unit
    from rosprivacy.parts.workers import Built
    from rosprivacy.settings import Settings

OPTION = "--resume"
TICK = 100_000_000  # nanoseconds: the clock of a file system is a little behind
ANOTHER = "name a folder that is not there yet"
PLAIN = {("builtins", "frozenset"), ("builtins", "set"), ("collections", "defaultdict"), ("collections", "Counter")}


@dataclass(frozen=True, slots=True)
class KeptParts:
    """A folder of parts.

    Attributes
    ----------
    key
        Hash of all with which any part is read: program, fleet file, settings and the files that these name.
    """

    folder: str
    key: str

    def built(self, units: Sequence[Unit], build: Callable[[Sequence[Unit]], Built]) -> Built:
        """Return what was read of some units, if it was; else read them, and keep that.

        What had errors is not kept, nor what is read in the place of a file that is not there: it may be there the
        next time. Nor is a part of which a file changed while it was read.

        Raises
        ------
        InputErrors
            If the file of the part is not as it was written.
        """
        robots = [(robot.id, robot.files) for unit in units for group in unit.groups for robot in group.robots]
        file = Path(self.folder, hashlib.sha256(repr((self.key, robots)).encode()).hexdigest()[:32])
        if exists(file):
            seen, kept = _read(file)
            if all(_state(name) == state for name, state in seen.items()):
                there: Built = kept
                return there
        begun = time.time_ns() - TICK
        with one_run():
            new = build(units)
            names = {*names_read(), *_folders(units)}
        names |= {str(Path(name).parent) for name in names}
        unsure = new.report.problems or any(said.code == FALLBACK_TAKEN for said in new.report.diagnostics)
        if not unsure and not any(_changed_since(name, begun) for name in names):
            seen = {name: _state(name) for name in sorted(names)}
            content = pickle.dumps((seen, new))
            write_texts([(file, hashlib.sha256(content).digest() + content)])
        return new


def kept_parts(folder: str, settings: Settings, fleet: Sequence[tuple[str, str]]) -> KeptParts:
    """Return the parts in a folder, which is made if it is not there.

    Parameters
    ----------
    fleet
        The files of the fleet, each with the hash of what was read: flows between robots stand there.

    Raises
    ------
    InputErrors
        If it is not a folder of this user's alone.
    """
    try:
        Path(folder).mkdir(mode=0o700, parents=True, exist_ok=True)
        _check_own(Path(folder))
    except OSError as error:
        raise InputErrors([InputError(OPTION, 0, f"{folder}: {reason(error)}", ANOTHER)]) from None
    named = (*settings.ontologies, *settings.types, *settings.permissions_ca)
    named += tuple(file for file in (settings.standard_channels, settings.type_limits) if file)
    asked = [(field.name, getattr(settings, field.name)) for field in fields(settings) if field.name != "progress"]
    key = (__version__, _program(), [*fleet], asked, str(Path.cwd()), [(file, digest(file)) for file in named])
    return KeptParts(folder, hashlib.sha256(repr(key).encode()).hexdigest())


@cache
def _program() -> str:
    """The hash of the program with what it ships: what a changed one reads can be something else."""
    whole = hashlib.sha256()
    package = Path(__file__).parent.parent
    for folder, folders, files in os.walk(package, followlinks=True):
        folders[:] = sorted(set(folders) - {"__pycache__"})
        for name in sorted(files):
            whole.update(name.encode() + Path(folder, name).read_bytes())
    return whole.hexdigest()


def _check_own(folder: Path) -> None:
    """Refuse a folder that others own, read or write, and a link: what lies in it is unpickled."""
    status = folder.lstat()
    mine = hasattr(os, "getuid") and status.st_uid == os.getuid()
    if not mine or not stat.S_ISDIR(status.st_mode) or status.st_mode & 0o077:
        what = f"{folder} is not a folder of yours alone"
        raise InputErrors([InputError(OPTION, 0, what, f"{ANOTHER}, or chmod go= {folder}")])


def _folders(units: Sequence[Unit]) -> Iterator[str]:
    """The folders that are read for some units, with all below."""
    for name in {name for unit in units for group in unit.groups for name in group.robots[0].policies}:
        if is_dir(name):
            yield from (folder for folder, _, _ in os.walk(name, followlinks=True))


def _changed_since(name: str, begun: int) -> bool:
    """Whether a file or folder was changed, or put there, after a time."""
    try:
        return Path(name).stat().st_ctime_ns > begun
    except OSError:
        return True


def _state(name: str) -> str | int:
    """The hash of a file, empty for what is not there; when a folder got or lost one."""
    path = Path(name)
    return path.stat().st_mtime_ns if is_dir(path) else digest(name)


class _Unpickler(pickle.Unpickler):
    """Makes classes of this program, and sets; nothing else that a file may name."""

    def find_class(self, module: str, name: str) -> Any:
        if module.startswith("rosprivacy.") or (module, name) in PLAIN:
            found = super().find_class(module, name)
            if isinstance(found, type):
                return found
        raise pickle.UnpicklingError(f"{module}.{name} is no part")


def _read(file: Path) -> tuple[dict[str, str | int], Any]:
    """What was read then, and what came of it."""
    content = file.read_bytes()
    problem = "" if hashlib.sha256(content[32:]).digest() == content[:32] else "another hash"
    try:
        seen, kept = ({}, None) if problem else _Unpickler(BytesIO(content[32:])).load()
    except (pickle.UnpicklingError, EOFError, AttributeError, ImportError, TypeError, ValueError, IndexError) as error:
        problem = reason(error)
    if problem:
        what = f"{file} is not as it was written: {problem}"
        raise InputErrors([InputError(OPTION, 0, what, f"remove it, or {ANOTHER}")])
    return seen, kept
