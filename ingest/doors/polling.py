"""To ask a middleware again and again what has changed, and to tell it when all is quiet.

In: how to ask, and how to say what is there. Out: observations, the last one of the end of the look.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

from rosprivacy.ingest.policies.observed_metadata import STILL_CHANGING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.ingest.observe.observation import Observation

    Wait = Callable[[float], bool | None]

POLL = 0.05


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
    take: Callable[[], bool], seen: Callable[[bool], Observation], pace: Pace, seconds: float | None, wait: Wait
) -> Iterator[Observation]:
    """Tell what is there, each time that it has changed and been quiet for a moment, and at the end.

    Parameters
    ----------
    take
        Takes what is new; returns whether anything is.
    seen
        Says what is there; whether it is the end, at which nothing is waited for any more, is given.
    seconds
        How long to look; None until ``wait`` says that somebody has asked to stop.
    wait
        Waits so many seconds.
    """
    end = None if seconds is None else time.monotonic() + seconds
    changed, told = -inf, len(pace.told_after)
    while end is None or time.monotonic() < end:
        if take():
            changed, told = time.monotonic(), 0
        elif told < len(pace.told_after) and time.monotonic() - changed > pace.told_after[told]:
            told += 1
            yield seen(False)
        if wait(POLL):
            break
    last = seen(True)
    late = time.monotonic() - changed < pace.settled
    yield replace(last, gaps={**last.gaps, STILL_CHANGING: 1}) if late else last
