"""The journal of a session: what is not saved yet, written down at once, outlives a process that ends in its midst.

In: each entry as it says something else. Out: a file of JSON lines in the user's state folder, through to the disk; and
what sessions before this one left there. A line that was cut off by a kill or a full disk is left out, and told.
"""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, reason, shown
from rosprivacy.explorer.edits import Edit
from rosprivacy.ingest.labels.edited_entries import KINDS, SaidOfElement
from rosprivacy.report.atomic import write_texts

if TYPE_CHECKING:
    from collections.abc import Iterable

    from filelock import BaseFileLock

    from rosprivacy.system import System

FORMAT = "rosprivacy.session"
BOUND = 16  # journals of one label file: of sessions that run, and of those that ended
MOST_READ = 64 * 2**20  # bytes
LONGEST = 2**20  # bytes; a longer one is written anew, with the last word on each entry


def journal_folder() -> Path:
    """Return where journals are kept, whether or not it is there; ``ROSPRIVACY_DATA`` takes the place of the user's."""
    from platformdirs import user_state_path  # noqa: PLC0415 - light start

    data = os.environ.get("ROSPRIVACY_DATA")
    return (Path(data) if data else user_state_path("rosprivacy", appauthor=False)) / "explorer"


class Base(NamedTuple):
    """What edits are made on.

    Attributes
    ----------
    labels, policies
        Digests of the label file, empty where there is none yet, and of all policies.
    """

    labels: str
    policies: str


NOTHING = Base("", "")


class Unsaved(NamedTuple):
    """What a session left that ended before it was saved, as it is offered to a person.

    Attributes
    ----------
    changed
        Whether policies or the label file are other ones now: making the edits again is then a merge.
    torn
        How many lines of its journal cannot be read, such as one that was cut off.
    """

    edits: tuple[Edit, ...]
    changed: bool
    torn: int


class Left(NamedTuple):
    """The journal of a session that ended before it was saved.

    Attributes
    ----------
    base
        What it was made on.
    edits
        The last word on each entry.
    torn
        How many lines cannot be read.
    """

    file: Path
    base: Base
    edits: tuple[Edit, ...]
    torn: int


class Journal:
    """The journal of one session, with its lock; and the journals that sessions before it left.

    Parameters
    ----------
    folder
        None for a session without a journal: nothing is written, and nothing was left.
    about
        The label file that is edited, or policies as a user named them.

    Attributes
    ----------
    left
        The newest first; they are locked too, so that no other session takes them up.
    remarks
        What a person has to know of it.
    """

    def __init__(self, folder: Path | None = None, about: str = "", base: Base = NOTHING) -> None:
        self.base = base
        self.remaining: list[Left] = []
        self.remarks: list[str] = []
        self._locks: dict[Path, BaseFileLock] = {}
        self._file: Path | None = None
        self._size, self._limit = 0, LONGEST
        self._whole = False  # whether the file holds all that was said
        if folder is None:
            return
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._take(folder, hashlib.sha256(about.encode("utf-8", "surrogatepass")).hexdigest()[:32])
        except OSError as error:
            self._fails(folder, error)
        self.remaining.sort(key=lambda one: one.file.stat().st_mtime_ns, reverse=True)

    @classmethod
    def begin(cls, folder: Path, file: str, digest: str, named_files: tuple[str, ...], system: System) -> Journal:
        """Begin a journal about a label file that holds what a digest says; both are empty where there is none."""
        read = sorted({source for policy in system.policies for source in policy.sources})
        policies = hashlib.sha256(repr(read).encode("utf-8", "surrogatepass")).hexdigest()
        return cls(folder, str(Path(file).resolve()) if file else repr(named_files), Base(digest, policies))

    @property
    def offered(self) -> Unsaved | None:
        """What the newest of the sessions before left; None if there is nothing."""
        if not self.remaining:
            return None
        return Unsaved(self.remaining[0].edits, self.remaining[0].base != self.base, self.remaining[0].torn)

    def _take(self, folder: Path, name: str) -> None:
        """Lock a file of our own, and what nobody holds."""
        import filelock  # noqa: PLC0415 - light start

        for number in range(BOUND):
            file = folder / f"{name}-{number}.jsonl"
            beside = Path(f"{file}.lock")
            if self._file and not file.exists() and not beside.exists():
                continue
            lock = filelock.FileLock(beside, timeout=0, mode=0o600)
            try:
                lock.acquire()
            except filelock.Timeout:
                continue
            self._locks[file] = lock
            if file.exists():
                self._note(file)
            elif self._file:
                self._drop(file)
            else:
                self._file = file
        if not self._file:
            self.remarks.append(f"{shown(str(folder))}: {BOUND} journals are there already; this session has none")

    def _note(self, file: Path) -> None:
        left = read_journal(file)
        if left.torn:
            self.remarks.append(f"{shown(str(file))}: {left.torn} lines cannot be read, such as one that was cut off")
        if left.edits:
            self.remaining.append(left)
        elif not left.torn:  # what cannot be read stays for a person to look at
            self._drop(file)

    def _drop(self, file: Path) -> None:
        file.unlink(missing_ok=True)
        lock = self._locks.pop(file)
        Path(f"{file}.lock").unlink(missing_ok=True)
        lock.release()

    def settle(self, refused: Iterable[Edit] = ()) -> None:
        """Forget what the newest of the sessions before left, but for what could not be made again."""
        if not self.remaining:
            return
        left, edits = self.remaining.pop(0), tuple(refused)
        if edits:
            write_texts([(left.file, _text(left.base, edits))])
            self.remaining.insert(0, left._replace(edits=edits))
        else:
            self._drop(left.file)

    def note(self, edits: Iterable[Edit], all_of_them: Iterable[Edit]) -> None:
        """Write entries down as they are now; all that is not saved anew if the file lacks something or is too long."""
        if self._file is None:
            return
        data, all_of_them = "".join(map(_line, edits)).encode(), tuple(all_of_them)
        if not all_of_them or not self._whole or self._size + len(data) > self._limit:
            self.rewrite(self.base, all_of_them)
            return
        try:
            self._whole = False
            with self._file.open("ab") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            self._size += len(data)
            self._whole = True
        except OSError as error:
            self._fails(self._file, error)

    def begin_anew(self, digest: str, unsaved: Iterable[Edit]) -> None:
        """Go on with a label file that holds something else now: what was saved is forgotten."""
        self.rewrite(self.base._replace(labels=digest), unsaved)

    def rewrite(self, base: Base, edits: Iterable[Edit]) -> None:
        """Write the whole journal anew; without edits there is none."""
        self.base = base
        if self._file is None:
            return
        edits = tuple(edits)
        try:
            if not edits:
                self._file.unlink(missing_ok=True)
                self._whole = False
                return
            text = _text(base, edits)
            write_texts([(self._file, text)])
            self._whole, self._size = True, len(text.encode())
            self._limit = max(LONGEST, 2 * self._size)
        except (OSError, InputError) as error:
            self._fails(self._file, error)

    def _fails(self, place: Path, error: Exception) -> None:
        why = error.problem if isinstance(error, InputError) else reason(error) if isinstance(error, OSError) else ""
        what = f"{shown(str(place))}: {why}; until they are saved, edits are in this session only"
        if what not in self.remarks:
            self.remarks.append(what)

    def close(self) -> None:
        """Let go of all journals; what is not saved stays."""
        for file, lock in list(self._locks.items()):
            if not file.exists():
                Path(f"{file}.lock").unlink(missing_ok=True)
            lock.release()
            del self._locks[file]
        self._file = None


def read_journal(file: Path) -> Left:
    """Read what a session left; what cannot be read of it is counted."""
    base, edits, torn = NOTHING, dict[tuple[str, str, str], Edit](), 0
    try:
        if file.stat().st_size > MOST_READ:
            return Left(file, base, (), 1)
        lines = file.read_bytes().splitlines()
    except OSError:
        return Left(file, base, (), 1)
    for number, line in enumerate(lines):
        try:
            said = json.loads(line)
            if not number:
                base = Base(str(said["labels"]), str(said["policies"])) if said[FORMAT] == 1 else base
            else:
                edit = _edit(said)
                edits[edit.file, edit.section, edit.name] = edit
        except (ValueError, LookupError, TypeError, RecursionError):
            torn += 1
    return Left(file, base, tuple(edits.values()), torn)


def _edit(entry: Any) -> Edit:
    section, name, value, file = entry if len(entry) > len(SaidOfElement._fields) else (*entry, "")
    if section not in KINDS or not isinstance(name, str) or not isinstance(file, str):
        raise ValueError
    return Edit(section, name, value, file)


def _text(base: Base, edits: Iterable[Edit]) -> str:
    head = json.dumps({FORMAT: 1, **base._asdict()})
    return f"{head}\n{''.join(map(_line, edits))}"


def _line(edit: Edit) -> str:
    return f"{json.dumps(edit if edit.file else edit.statement)}\n"
