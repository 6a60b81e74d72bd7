"""Scenes are laid out and drawn, one after the other, and remembered by what is drawn.

In: a ``Scene``. Out: SVG as text. Graphviz runs in a process of its own with a time limit; where it is not installed,
is too slow, or fails, the picture says so in its place, and lists beside it say the rest.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import replace
from threading import Lock
from typing import TYPE_CHECKING, Self

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.report.explorer.live_svg import fits, live_svg, without_places
from rosprivacy.report.explorer.unnamed_dot import unnamed_dot
from rosprivacy.report.pictures.graphviz import Graphviz, Job, TooLongError, available
from rosprivacy.report.pictures.layout import DIRECTIONS, ORDERED, way_of
from rosprivacy.report.pictures.layout import WAYS as ON_PAPER

if TYPE_CHECKING:
    from types import TracebackType

    from rosprivacy.report.explorer.live_svg import Links
    from rosprivacy.report.explorer.scenes import Scene
    from rosprivacy.report.pictures.layout import Way

SECONDS = 8.0
WAYS = (replace(ON_PAPER[0], most=150_000), *ON_PAPER[1:])  # a page waits less long than paper: 0.3 s, not 2
ROOM = (900.0, 700.0)
ACROSS, DOWN = DIRECTIONS
REMEMBERED = 64  # layouts; one takes some 20 kB


class Drawing:
    """What draws scenes; several threads may use one, in turn.

    Use it in a ``with`` statement, or ``close`` it: the process of Graphviz lives as long as it does.

    Parameters
    ----------
    seconds
        For one layout.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.report.explorer.scenes import Scenes
    >>> with Drawing() as drawing:
    ...     svg = drawing.svg(Scenes(analyse(*factory())).of())
    >>> svg.startswith("<svg"), "/camera" in svg
    (True, True)
    """

    def __init__(self, seconds: float = SECONDS) -> None:
        self._seconds, self._lock = seconds, Lock()
        self._graphviz = Graphviz() if available() else None
        self._layouts: OrderedDict[tuple[str, str], bytes] = OrderedDict()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the process of Graphviz; the next picture starts another."""
        with self._lock:
            if self._graphviz:
                self._graphviz.close()

    def svg(self, scene: Scene, links: Links | None = None, room: tuple[float, float] = ROOM) -> str:
        """Return a scene as SVG for a page, see ``live_svg.py``; the same scene gives the same bytes.

        Parameters
        ----------
        room
            Width and height that a page has for it, in pixels: data goes across or down, as more of it fits.
        """
        if not scene.picture.boxes:
            return without_places(scene, "")
        if self._graphviz is None:
            return without_places(scene, scene.picture.say("pic.explore.none"))
        try:
            return live_svg(self._laid_out(scene, room, self._graphviz), scene, links)
        except TooLongError:
            return without_places(scene, scene.picture.say("pic.explore.late", seconds=f"{self._seconds:g}"))
        except DrawingError:
            return without_places(scene, scene.picture.say("pic.explore.failed"))

    def _laid_out(self, scene: Scene, room: tuple[float, float], graphviz: Graphviz) -> bytes:
        """Across if that fits, else the way that more of fits; what has no order has one way."""
        dot, way = unnamed_dot(scene), way_of(scene.picture, WAYS)
        across = self._layout(dot, way, ACROSS, graphviz)
        if way.engine != ORDERED or fits(across, room) == 1:
            return across
        return max(across, self._layout(dot, way, DOWN, graphviz), key=lambda data: fits(data, room))

    def _layout(self, dot: str, way: Way, direction: str, graphviz: Graphviz) -> bytes:
        what = direction, dot
        with self._lock:
            if what not in self._layouts:
                job = Job(dot, way.engine, "svg", {**way.attributes, "rankdir": direction})
                self._layouts[what] = graphviz.draw(job, self._seconds)
            self._layouts.move_to_end(what)
            while len(self._layouts) > REMEMBERED:
                self._layouts.popitem(last=False)
            return self._layouts[what]
