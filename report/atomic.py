"""The one place that writes files of users: whole or not at all, never what was read in the same run, one at a time.

Texts are written to a neighbour first, which is then renamed over the old file. What is no regular file (a pipe,
``/dev/stdout``) cannot be replaced so and is written to. A process that is killed leaves each file old or new, and may
leave a neighbour, ``.NAME.`` and eight signs, which nobody reads.

A file of people's work (decisions, labels) is read, changed and written back by one run after the other: a block in
which no other run of the program edits it. An editor or another program knows nothing of this; ``write_texts`` sees
what they wrote meanwhile and writes nothing.
"""

from __future__ import annotations

import os
import stat
import tempfile
import unicodedata
import warnings
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from rosprivacy.analysis.errors import InputError, InputErrors, reason, shown
from rosprivacy.analysis.files_read import changed_since, read_as

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

Text: TypeAlias = "str | bytes | Iterable[str] | Iterable[bytes]"  # in one piece or in several
STANDARD_OUTPUT = Path("/dev/stdout")


class _Output(NamedTuple):
    """Where a text is to go.

    Attributes
    ----------
    written_path
        As the user wrote it.
    file
        What is behind the name, links followed.
    status
        Of what is there already.
    """

    written_path: Path
    file: Path
    status: os.stat_result | None

    @property
    def stream(self) -> bool:
        """Whether it is written to as it is."""
        return self.status is not None and not (stat.S_ISREG(self.status.st_mode) or stat.S_ISDIR(self.status.st_mode))


def write_texts(
    texts: Iterable[tuple[Path, Text | None]],
    *,
    edited: Path | None = None,
    check: Callable[[Path], None] | None = None,
) -> None:
    """Write UTF-8 texts, or bytes, to files, all of them or none.

    Parameters
    ----------
    texts
        File and text; None for a file that is left as it is this time, and refused as if it were written.
    edited
        The one input that is meant to be replaced by what was made of it, unless it was changed since it was read.
    check
        Looks at each file before it gets its name; what it raises leaves all files as they were.

    Raises
    ------
    InputError
        If a folder is not there, a file cannot be written, or ``edited`` is not what was read any more; what was at
        the paths is then untouched.
    InputErrors
        If a file was read in this run, or is named for two outputs; the same.
    """
    texts = list(texts)
    outputs = check_outputs([file for file, _ in texts], edited=edited)
    staged: list[tuple[Path, _Output]] = []
    pairs = [(at, text) for at, (_, text) in zip(outputs, texts, strict=True) if text is not None]
    try:
        for at, text in pairs:
            if not at.stream:
                with writing(at.written_path):
                    staged.append((_stage(at, _pieces(text)), at))
        for at, text in pairs:
            if at.stream:
                with writing(at.written_path), at.written_path.open("wb") as file:
                    file.writelines(_pieces(text))
        _check_edited(outputs, edited)
        if check:
            for temporary, _ in staged:
                check(temporary)
        for temporary, at in staged:
            with writing(at.written_path):
                temporary.replace(at.file)
                keep_name(at.file.parent)
    finally:
        for temporary, _ in staged:
            temporary.unlink(missing_ok=True)


def check_outputs(files: Iterable[Path], *, edited: Path | None = None) -> list[_Output]:
    """Refuse outputs over inputs, and two outputs on one file, by what the names lead to.

    Raises
    ------
    InputError
        If it cannot be told what a name leads to.
    InputErrors
        With every output that is refused.
    """
    outputs = []
    for file in files:
        with writing(file):
            outputs.append(_Output(file, file.resolve(), _status(file)))
    problems = [*_over_inputs(outputs, edited), *_on_one_file(outputs)]
    if problems:
        raise InputErrors(problems)
    return outputs


def _over_inputs(outputs: list[_Output], edited: Path | None) -> Iterator[InputError]:
    for at in outputs:
        if at.stream or at.written_path == edited:
            continue
        name = read_as(str(at.file), at.status)
        if name is not None:
            same = "" if name == str(at.written_path) else f"is the same file as {shown(name)}, which "
            yield InputError(str(at.written_path), 0, f"{same}is read in this run", "name another file to write to")


def _check_edited(outputs: list[_Output], edited: Path | None) -> None:
    """What somebody else wrote into the file meanwhile is not written over."""
    for at in outputs:
        if at.written_path == edited and not at.stream and changed_since(str(at.written_path), _status(at.file)):
            raise InputError(
                str(at.written_path), 0, "was changed meanwhile, so nothing is written", "run the command again"
            )


def _on_one_file(outputs: list[_Output]) -> Iterator[InputError]:
    first: dict[object, Path] = {}
    for at in outputs:
        if at.stream:
            continue
        key = _key(at)
        if key in first:
            also = "" if first[key] == at.written_path else f", also as {shown(str(first[key]))}"
            what = f"is named for two outputs{also}"
            yield InputError(
                str(at.written_path), 0, what, "name a file for each; upper and lower case alone do not differ"
            )
        first.setdefault(key, at.written_path)


def _key(at: _Output) -> object:
    """What two names have in common that lead to one file, on any file system.

    Of a file that is not there yet nobody can say whether its folder tells case or forms of Unicode apart, so neither
    is told apart.
    """
    if at.status and at.status.st_ino:
        return at.status.st_dev, at.status.st_ino
    folder = _status(at.file.parent)
    name = unicodedata.normalize("NFC", at.file.name).casefold()
    return (folder.st_dev, folder.st_ino, name) if folder and folder.st_ino else (at.file.parent, name)


def _status(file: Path) -> os.stat_result | None:
    """Links are followed here and not only by ``resolve``: a system that distrusts a link of others refuses this."""
    try:
        return file.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None


@contextmanager
def writing(file: Path) -> Iterator[None]:
    """Say of what the system refuses that a file cannot be written."""
    try:
        yield
    except (OSError, RuntimeError, ValueError) as error:
        hint = "name a file in a folder that can be written"
        raise InputError(str(file), 0, f"cannot be written: {reason(error)}", hint) from None


def _pieces(text: Text) -> Iterator[bytes]:
    for piece in (text,) if isinstance(text, str | bytes) else text:
        yield piece.encode() if isinstance(piece, str) else piece


def _stage(at: _Output, pieces: Iterable[bytes]) -> Path:
    """Write a text beside its target, with the target's permissions; return where."""
    if at.status and stat.S_ISDIR(at.status.st_mode):
        raise IsADirectoryError(0, "it is a folder")
    mode = at.status.st_mode if at.status else 0o666 & ~_umask()
    handle, name = tempfile.mkstemp(dir=at.file.parent, prefix=f".{at.file.name[:50]}.")
    temporary = Path(name)
    try:
        temporary.chmod(stat.S_IMODE(mode))
        with os.fdopen(handle, "wb") as file:
            file.writelines(pieces)
            file.flush()
            os.fsync(file.fileno())
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return temporary


def keep_name(folder: Path) -> None:
    """Write a new name in a folder through to the disk, where the system can; the file itself is there already."""
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


LOCK_LIMIT = 60.0  # seconds; an edit takes one or two


@contextmanager
def editing(file: Path) -> Iterator[None]:
    """Let one run at a time edit a file; the others wait.

    The lock is a neighbour of the file, so that it holds for all users and containers that see the folder. The system
    drops the lock of a process that dies.

    Raises
    ------
    InputError
        If another run edits the file for longer than ``LOCK_LIMIT``, or its folder cannot be written.
    """
    import filelock  # noqa: PLC0415 - light start

    with writing(file):
        target = file.resolve()
        target.parent.stat()  # filelock would make the folder
        neighbour = target.with_name(f".{target.name[:50]}.lock")
        if neighbour.is_symlink():  # filelock follows none
            raise InputError(
                str(file), 0, f"{shown(str(neighbour))} is a link, and no lock of ours", "remove that link"
            )
        replaced = target.is_file() or not file.exists()
    if not replaced:  # a pipe
        yield
        return
    with writing(neighbour if neighbour.exists() else file):  # one that another user left may be closed to us
        lock = filelock.FileLock(neighbour, timeout=LOCK_LIMIT)
        try:
            with warnings.catch_warnings():  # a file system without such locks: filelock names the process in the file
                warnings.simplefilter("ignore", UserWarning)
                lock.acquire()
        except filelock.Timeout:
            what = f"another rosprivacy has been editing it for {LOCK_LIMIT:.0f} s"
            hint = f"wait until it has ended, or end it; if none runs on any machine, remove {shown(str(neighbour))}"
            raise InputError(str(file), 0, what, hint) from None
    try:
        yield
    finally:
        with suppress(OSError):  # those who wait see that it is gone, and make a new one
            if not neighbour.stat().st_size:
                neighbour.unlink()
        lock.release()
