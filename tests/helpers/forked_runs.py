"""The program, run many times and killed at a given moment: a process that is warm forks itself for each run.

A run is killed at its n-th call to the system, before or after it, as Python counts them, or after some seconds. The
process that forks has loaded what commands need, so that a run costs what the command itself costs.
"""

from __future__ import annotations

import io
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import cache
from typing import IO, TYPE_CHECKING, Any

import typer.main

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path
    from types import FrameType

    from rosprivacy.analysis.python_311 import Self

OF_FILES = ("open", "write", "flush", "fsync", "chmod", "replace", "unlink", "flock", "link", "mkdir")
OF_SOCKETS = ("sendall",)
_MODULES = ("posix", "fcntl", "_posixsubprocess")
_TYPES = (io.BufferedWriter, socket.socket)


@dataclass(frozen=True, slots=True)
class Run:
    """A run of the program that is to be.

    Attributes
    ----------
    arguments, folder
        The command line, and where it runs.
    calls
        Names of the calls that are counted.
    at, seconds
        When ``victim`` is killed: at that call, from 1 on, each counted when it begins and when it ends, or after so
        many seconds; 0 for never.
    victim
        Number of a process; 0 for the run itself.
    before
        Python that is run first: what it breaks a test has to see.
    """

    arguments: tuple[str, ...]
    folder: str
    calls: tuple[str, ...] = OF_FILES
    at: int = 0
    seconds: float = 0.0
    victim: int = 0
    before: str = ""


@dataclass(frozen=True, slots=True)
class Ended:
    """A run that has ended.

    Attributes
    ----------
    code
        Exit code, or the signal as a negative number.
    made
        The calls that it made, if it was not killed.
    seconds
        How long it took.
    """

    code: int
    output: str
    error: str
    seconds: float
    made: list[str] = field(default_factory=list)


class Forked:
    """A process that runs the program in forks of itself; use it in a ``with`` statement.

    Parameters
    ----------
    warm
        Commands that are run first, in the process itself, for what they load.
    """

    def __init__(self, folder: Path, *warm: tuple[str, ...]) -> None:
        command = [sys.executable, "-m", "tests.helpers.forked_runs", str(folder), json.dumps(warm)]
        today = os.environ | {"SOURCE_DATE_EPOCH": "1760000000"}  # no midnight between two runs
        self._process = subprocess.Popen(
            command, cwd=ROOT, env=today, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate(timeout=60)

    def begin(self, run: Run) -> None:
        """Begin a run, and do not wait for it."""
        assert self._process.stdin
        print(json.dumps(asdict(run)), file=self._process.stdin, flush=True)

    def end(self) -> Ended:
        """Wait for the run that was begun."""
        assert self._process.stdout
        return Ended(**json.loads(self._process.stdout.readline()))

    def __call__(self, run: Run) -> Ended:
        """Begin a run and wait for it."""
        self.begin(run)
        return self.end()


def _serve(warm: list[list[str]]) -> None:
    """One line of JSON in, one out."""
    orders, answers = sys.stdin, os.fdopen(os.dup(1), "w")
    sys.stdin = open(os.devnull)  # noqa: PTH123, SIM115 - for the whole life of the process
    with open(os.devnull, "wb") as nowhere:  # noqa: PTH123
        os.dup2(nowhere.fileno(), 1)
    typer.main.get_command = cache(typer.main.get_command)  # the command line is built once, not for every run
    for arguments in warm:
        _program(arguments)
    for order in orders:
        print(json.dumps(asdict(_forked(Run(**json.loads(order))))), file=answers, flush=True)


def _forked(run: Run) -> Ended:
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as error, tempfile.TemporaryFile() as made:
        begin = time.monotonic()
        child = os.fork()
        if not child:
            os.dup2(output.fileno(), 1)
            os.dup2(error.fileno(), 2)
            code = 70
            try:
                code = _child(run, made)
            finally:
                os._exit(code)
        while run.seconds and not os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT):
            if time.monotonic() - begin > run.seconds:
                os.kill(run.victim or child, signal.SIGKILL)
                break
            time.sleep(0.0005)
        status = os.waitpid(child, 0)[1]
        taken = time.monotonic() - begin
        texts = []
        for file in (output, error, made):
            file.seek(0)
            texts.append(file.read().decode("utf-8", "replace"))
    return Ended(os.waitstatus_to_exitcode(status), texts[0], texts[1], taken, texts[2].splitlines())


def _child(run: Run, made: IO[bytes]) -> int:
    os.chdir(run.folder)
    exec(run.before, {})  # noqa: S102 - of our own tests
    calls: list[str] = []

    def count(_: FrameType, event: str, function: Any) -> None:
        if not event.startswith("c_") or getattr(function, "__name__", "") not in run.calls:
            return
        if function.__module__ not in _MODULES and not isinstance(function.__self__, _TYPES):
            return
        calls.append(f"{event} {function.__name__}")
        if len(calls) == run.at:
            os.kill(run.victim or os.getpid(), signal.SIGKILL)

    sys.setprofile(count)
    code = _program(run.arguments)
    sys.setprofile(None)
    made.write("\n".join(calls).encode())
    made.flush()
    return code


def _program(arguments: list[str] | tuple[str, ...]) -> int:
    from rosprivacy.cli.app import main

    sys.argv = ["rosprivacy", *arguments]
    code: Any = 0
    try:
        main()
    except SystemExit as ended:
        code = ended.code or 0
    with suppress(OSError):
        sys.stdout.flush()
        sys.stderr.flush()
    return int(code)


if __name__ == "__main__":
    os.chdir(sys.argv[1])
    _serve(json.loads(sys.argv[2]))
