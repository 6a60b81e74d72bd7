"""Graphviz in a process of its own: it can be ended when it takes too long, and may crash without harm to us.

In: DOT. Out: SVG or PNG, as bytes. The process is started once and draws one picture after the other; it imports
pygraphviz, which brings Graphviz along, and nothing of ours but ``graphviz_worker.py``.
"""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from abc import ABC, abstractmethod
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Self

from rosprivacy.analysis.errors import DrawingError, shown
from rosprivacy.report.installing import command_for

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import TracebackType

WORKER = "rosprivacy.report.pictures.graphviz_worker"
MISSING = (
    "graph: Graphviz is not installed, so there is no SVG and no PNG; take --format dot, graphml or mermaid, or "
    "install it with its headers (Debian: libgraphviz-dev) and then"
)


def available() -> bool:
    """Return whether Graphviz is installed."""
    return find_spec("pygraphviz") is not None


class TooLongError(Exception):
    """The layout took longer than it was given."""


@dataclass(frozen=True, slots=True)
class Job:
    """What to draw, and how.

    Attributes
    ----------
    dot
        The graph.
    engine
        Of Graphviz: ``dot``, ``sfdp``, …
    form
        ``svg`` or ``png``.
    attributes
        Of the graph, in place of its own.
    """

    dot: str
    engine: str = "dot"
    form: str = "svg"
    attributes: Mapping[str, str] | None = None


class Closing(ABC):
    """What is closed at the end of a ``with`` statement."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """End what runs."""


class Graphviz(Closing):
    """A running Graphviz; use it in a ``with`` statement.

    Raises
    ------
    DrawingError
        If pygraphviz is not installed.
    """

    def __init__(self) -> None:
        if not available():
            raise DrawingError(f"{MISSING} {command_for('views')}")
        self._process: subprocess.Popen[bytes] | None = None

    def draw(self, job: Job, seconds: float) -> bytes:
        """Draw one picture.

        Raises
        ------
        TooLongError
            If it is not done in time.
        DrawingError
            If Graphviz refuses the graph or crashes.
        """
        process = self._running()
        assert process.stdin is not None
        assert process.stdout is not None
        over = threading.Event()

        def end() -> None:
            over.set()
            process.kill()

        timer = threading.Timer(seconds, end)
        timer.start()
        try:
            order = {
                "engine": job.engine,
                "form": job.form,
                "seconds": seconds,
                "attributes": dict(job.attributes or {}),
            }
            _send(process, json.dumps(order).encode(), job.dot.encode())
            head = process.stdout.readline()
            answer = json.loads(head) if head else None
            data = process.stdout.read(answer["size"]) if answer else b""
        except OSError:  # it ended while we wrote
            answer, data = None, b""
        finally:
            timer.cancel()
            timer.join()
        if answer is None or over.is_set() or len(data) < answer["size"]:
            self.close()
            if over.is_set():
                raise TooLongError
            raise DrawingError("graph: Graphviz ended while it drew; take --format dot and draw that by other means")
        if answer["error"]:
            raise DrawingError(f"graph: Graphviz cannot draw this: {shown(answer['error'])}; take --format dot")
        return data

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None:
            command = [sys.executable, "-P", "-m", WORKER]  # -P: nothing is imported from the current folder
            self._process = subprocess.Popen(  # noqa: S603 - our own module
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
            )
        return self._process

    def close(self) -> None:
        """End the process, whatever it does."""
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                try:
                    stream.close()
                except OSError:  # what it did not read any more
                    continue
        process.wait()


def _send(process: subprocess.Popen[bytes], *parts: bytes) -> None:
    assert process.stdin is not None
    for part in parts:
        process.stdin.write(len(part).to_bytes(8, "big") + part)
    process.stdin.flush()
