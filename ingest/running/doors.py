"""What every door to a running system does: it looks, and tells what is there each time that this has changed.

In: doors; how a middleware is asked; signals. Out: what a door has seen, added up; observations, the last one of the
end of the look; whether a look goes on. A door announces nothing on the ROS graph and writes nothing.
"""

from __future__ import annotations

import signal
import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, Protocol

from rosprivacy.ingest.policies.observed_metadata import STILL_CHANGING
from rosprivacy.ingest.running.observation import continued

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.ingest.running.observation import Observation

    Wait = Callable[[float], bool | None]


POLL = 0.05
SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Door(Protocol):
    """A way to see a running system.

    Doors to what runs have a ``clock``, which tells the time as observations hold it, and a ``wait``, which waits so
    many seconds and returns whether somebody has asked to stop.
    """

    def looks(self, seconds: float | None) -> Iterator[Observation]:
        """Tell what is there now: at once when something is known, and again each time that it has changed.

        Parameters
        ----------
        seconds
            How long to look; None until nobody asks any more. A door of files has looked already.

        Yields
        ------
        Observation
            Not what was there before: who left is missing in the next one. The last one is of the end of the look,
            and has the gap ``STILL_CHANGING`` if something had come shortly before.

        Raises
        ------
        MiddlewareError
            If there is nothing to be reached.
        ObservationError
            If what is needed is not installed, or what is read is not what it should be.
        """


def seen_by(
    door: Door, seconds: float | None, notify: Callable[[Observation | None, Observation], None] = lambda *_: None
) -> Observation | None:
    """Return all that a door has seen.

    Parameters
    ----------
    notify
        Called with what was there before (None at first) and what is there now.
    """
    whole: Observation | None = None
    before: Observation | None = None
    for now in door.looks(seconds):
        whole = now if whole is None else continued(whole, now)
        notify(before, now)
        before = now
    return whole


@dataclass(frozen=True, slots=True)
class Pace:
    """How fast a middleware is, in seconds.

    Attributes
    ----------
    told_after
        After a change, when it is told; once or again later.
    settled
        What came so shortly before the end makes the look one that still changed.
    """

    told_after: tuple[float, ...]
    settled: float


def polled(
    take: Callable[[], bool], observation: Callable[[bool], Observation], pace: Pace, seconds: float | None, wait: Wait
) -> Iterator[Observation]:
    """Tell what is there, each time that it has changed and been quiet for a moment, and at the end.

    ``take`` takes what is new and returns whether anything is; ``observation`` says what is there, and is told whether
    it is the end, at which nothing is waited for any more; without ``seconds``, ``wait`` says when that is.
    """
    end = None if seconds is None else time.monotonic() + seconds
    changed, told = -inf, len(pace.told_after)
    while end is None or time.monotonic() < end:
        if take():
            changed, told = time.monotonic(), 0
        elif told < len(pace.told_after) and time.monotonic() - changed > pace.told_after[told]:
            told += 1
            yield observation(False)
        if wait(POLL):
            break
    last = observation(True)
    late = time.monotonic() - changed < pace.settled
    yield replace(last, gaps={**last.gaps, STILL_CHANGING: 1}) if late else last


class Stop:
    """Whether somebody has asked to stop a look that has no end: by Ctrl-C, or as a supervisor ends a process.

    A signal that raises wherever the program is can be lost, in a callback of a library for instance, and with it what
    a door still had to tell; so it is noted, and a door asks where it waits.
    """

    def __init__(self) -> None:
        self._stop_requested = threading.Event()

    def wait(self, seconds: float) -> bool:
        """Wait a moment; return whether somebody has asked to stop."""
        return self._stop_requested.wait(seconds)

    @contextmanager
    def heard(self) -> Iterator[None]:
        """Note signals, and do nothing else on them; in the main thread."""
        before = {one: signal.signal(one, lambda *_: self._stop_requested.set()) for one in SIGNALS}
        try:
            yield
        finally:
            for one, handler in before.items():
                signal.signal(one, handler)
