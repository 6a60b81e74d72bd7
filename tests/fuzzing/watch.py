"""What one input may not do: open a file that is not its own, ask the network, start a process, hang, or grow.

Python's own opens come from an audit hook, those of C libraries from ``Guard``.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.ingest.mitigation.deny_patch import TEMPORARY
from rosprivacy.report.pictures.graphviz import WORKER
from tests.fuzzing.mutations import Guard
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from types import FrameType, TracebackType

    from rosprivacy.analysis.python_311 import Self

SECONDS = 10
GROWTH = 2**30
OUTWARD = (
    "socket.connect", "socket.bind", "socket.getaddrinfo", "socket.sendto", "subprocess.Popen", "os.exec", "os.system",
    "os.posix_spawn", "os.fork", "os.forkpty",
)  # fmt: skip
OUR_OWN = (ROOT, Path(sys.prefix), Path(sys.base_prefix), Path("/dev/null"), Path("/usr/share"), Path("/etc/localtime"))


class Hang(BaseException):
    """An input took longer than the bound; no ``except Exception`` hides it."""


class Watch:
    """Notes what is done between ``__enter__`` and ``__exit__``.

    Attributes
    ----------
    broken
        What was done that no input may do.
    """

    _active: Watch | None = None
    _hooked = False

    def __init__(self, folder: Path, outside: Path, cache: Path) -> None:
        allowed = (folder, cache, *OUR_OWN, *(path for path in map(Path, sys.path) if path.name == "site-packages"))
        self._allowed = (
            *(os.path.realpath(path) for path in allowed),
            os.path.realpath(tempfile.gettempdir()) + os.sep + TEMPORARY,  # a patch is tried there, on a copy
        )
        self._folder = os.path.realpath(folder) + os.sep
        self.guard = Guard(outside)
        self.broken: list[str] = []
        self.seconds = 0.0
        if not Watch._hooked:
            sys.addaudithook(_audit)
            signal.signal(signal.SIGPROF, _hang)
            Watch._hooked = True

    def __enter__(self) -> Self:
        self._begun, self._largest = time.process_time(), _memory()
        self._opened = len(self.guard.check())
        self.broken = []
        Watch._active = self
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        signal.setitimer(signal.ITIMER_PROF, 0)
        Watch._active = None
        self.seconds = time.process_time() - self._begun
        if len(self.guard.check()) > self._opened:
            self.broken.append(f"opened {self.guard.opened[-1]}")
        if (grown := _memory() - self._largest) > GROWTH:
            self.broken.append(f"grew by {grown / 2**20:.0f} MB")

    def note(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event == "subprocess.Popen" and WORKER in arguments[1]:
            return  # Graphviz draws in a process of its own
        if event != "open":
            self.broken.append(f"{event} {arguments[:2]!r}")
        elif isinstance(arguments[0], str | bytes):
            path = os.path.realpath(os.fsdecode(arguments[0]))
            if not path.startswith(self._folder) and not path.startswith(self._allowed):
                self.broken.append(f"opened {path}")


def peak() -> int:
    """The most memory that this process has had, in bytes."""
    return _memory()


def _memory() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if (event == "open" or event in OUTWARD) and Watch._active:
        Watch._active.note(event, arguments)


def _hang(_signal: int, _frame: FrameType | None) -> None:
    raise Hang
