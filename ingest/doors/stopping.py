"""To stop a look that has no end: by Ctrl-C, or as a supervisor ends a process.

In: signals. Out: whether a look goes on. A signal that raises wherever the program is can be lost, in a callback of a
library for instance, and with it what a door still had to tell; so it is noted, and a door asks where it waits.
"""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Stop:
    """Whether somebody has asked to stop."""

    def __init__(self) -> None:
        self._asked = threading.Event()

    def wait(self, seconds: float) -> bool:
        """Wait a moment; return whether somebody has asked to stop."""
        return self._asked.wait(seconds)

    @contextmanager
    def heard(self) -> Iterator[None]:
        """Note signals, and do nothing else on them; in the main thread."""
        before = {one: signal.signal(one, lambda *_: self._asked.set()) for one in SIGNALS}
        try:
            yield
        finally:
            for one, handler in before.items():
                signal.signal(one, handler)
