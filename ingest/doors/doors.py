"""What every door to a running system does: it looks, and tells what is there each time that this has changed.

In: doors. Out: what each has seen, added up. A door announces nothing on the ROS graph and writes nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from rosprivacy.ingest.observe.observation import continued

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.ingest.observe.observation import Observation


class Door(Protocol):
    """A way to see a running system."""

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
    door: Door, seconds: float | None, told: Callable[[Observation | None, Observation], None] = lambda *_: None
) -> Observation | None:
    """Return all that a door has seen.

    Parameters
    ----------
    told
        Called with what was there before (None at first) and what is there now.
    """
    whole: Observation | None = None
    before: Observation | None = None
    for now in door.looks(seconds):
        whole = now if whole is None else continued(whole, now)
        told(before, now)
        before = now
    return whole
