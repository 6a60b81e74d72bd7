"""The pictures of an explorer: an analysis, the element in hand and the kinds that are shown -> what a page puts in.

In: an ``Analysis`` after each edit. Out: ``Shown``. What pictures of one analysis share is kept until another comes,
and layouts are kept by what is drawn. Graphviz runs in a process of its own with a time limit; where it is not
installed, is too slow, or fails, the picture says so in its place, and lists beside it say the rest.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import replace
from threading import Lock
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.report.pictures.graphviz import Closing, Graphviz, Job, TooLongError, available
from rosprivacy.report.pictures.layout import DIRECTIONS, ORDERED, way_of
from rosprivacy.report.pictures.layout import WAYS as ON_PAPER
from rosprivacy.report.pictures.legend import legend, style_sheet
from rosprivacy.report.pictures.live_svg import fits, live_svg, unnamed_dot, without_places
from rosprivacy.report.pictures.phrases import Phrases
from rosprivacy.report.pictures.scenes import Scene, Scenes

if TYPE_CHECKING:
    from collections.abc import Collection

    from markupsafe import Markup

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.witness import WhyCarried, Witness
    from rosprivacy.report.pictures.layout import Way
    from rosprivacy.report.pictures.live_svg import Links
    from rosprivacy.report.pictures.picture import Key, Picture

SECONDS = 8.0
WAYS = (replace(ON_PAPER[0], max_crossings=150_000), *ON_PAPER[1:])  # a page waits less long than paper: 0.3 s, not 2
ROOM = (900.0, 700.0)
ACROSS, DOWN = DIRECTIONS
REMEMBERED = 64  # layouts; one takes some 20 kB


class Drawing(Closing):
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
    >>> from rosprivacy.report.pictures.scenes import Scenes
    >>> with Drawing() as drawing:
    ...     svg = drawing.svg(Scenes(analyse(*factory())).of())
    >>> svg.startswith("<svg"), "/camera" in svg
    (True, True)
    """

    def __init__(self, seconds: float = SECONDS) -> None:
        self._seconds, self._lock = seconds, Lock()
        self._graphviz = Graphviz() if available() else None
        self._layouts: OrderedDict[tuple[str, str], bytes] = OrderedDict()

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
            return without_places(scene, scene.picture.say("picture.explore.none"))
        try:
            return live_svg(self._laid_out(scene, room, self._graphviz), scene, links)
        except TooLongError:
            return without_places(scene, scene.picture.say("picture.explore.late", seconds=f"{self._seconds:g}"))
        except DrawingError:
            return without_places(scene, scene.picture.say("picture.explore.failed"))

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


class Shown(NamedTuple):
    """What a page shows of a picture.

    Attributes
    ----------
    svg
        One ``<svg>`` element: ``live_svg.py`` says what a page can rely on, ``legend.style_sheet`` how it looks.
    legend
        A list of HTML.
    title
        One sentence.
    notes
        What is not drawn.
    ways
        The paths to leaks that are drawn, in words.
    """

    svg: str
    legend: Markup
    title: str
    notes: tuple[str, ...]
    ways: tuple[str, ...]


class Pictures(Closing):
    """What draws the pictures of one explorer; threads may share it.

    Use it in a ``with`` statement, or ``close`` it: the process of Graphviz lives as long as it does.

    Parameters
    ----------
    say
        The words on the boxes: of the reader's language, and what kinds of data are called.
    seconds
        For one layout; a picture that takes longer says so in its place.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> with Pictures() as pictures:
    ...     shown = pictures.of(analyse(*factory()), ("", "topic", "/filtered"))
    >>> shown.notes
    ('Not drawn: 1 standard ROS channel',)
    """

    def __init__(self, say: Phrases | None = None, seconds: float = SECONDS) -> None:
        self._say, self._drawing, self._lock = say or Phrases(), Drawing(seconds), Lock()
        self._reached: Scenes | None = None

    def close(self) -> None:
        """End the process of Graphviz; the next picture starts another."""
        self._drawing.close()

    def of(
        self,
        analysis: Analysis,
        focus: Key | None = None,
        kinds: Collection[str] | None = None,
        links: Links | None = None,
        room: tuple[float, float] = ROOM,
        *,
        everything: bool = False,
        why: WhyCarried | None = None,
        way: Witness | None = None,
    ) -> Shown:
        """Return a picture; the same for the same analysis, element and kinds, to the byte.

        Parameters
        ----------
        focus
            ``Element.identity`` of the element in hand. None, or one that is not there, for the paths to leaks; where
            there are none, for where data goes first.
        kinds
            Names of emitted categories that are shown; None for all.
        links
            What leads to an element; None for a picture that leads nowhere.
        room
            As of ``Drawing.svg``.
        everything
            Draw the whole system, above some 150 boxes in groups, and not only what matters.
        why
            Of the analysis, by who has it already.
        way
            As of ``Scenes.of``.
        """
        with self._lock:
            if self._reached is None or self._reached.analysis is not analysis:
                self._reached = Scenes(analysis, self._say, why)
            scene = (self._reached.whole_system if everything else self._reached.of)(focus, kinds, way=way)
        picture = scene.picture
        return Shown(self._drawing.svg(scene, links, room), legend(scene), picture.title, picture.notes, picture.ways)

    def drawn(self, picture: Picture, links: Links | None = None, room: tuple[float, float] = ROOM) -> Shown:
        """Return a picture that was made elsewhere, such as what a query of the database gives.

        Parameters
        ----------
        links, room
            As of ``of``.
        """
        scene = Scene(picture)
        return Shown(self._drawing.svg(scene, links, room), legend(scene), picture.title, picture.notes, picture.ways)


class AlonePicture(NamedTuple):
    """A picture that needs no page: its SVG carries its style. A notebook shows it.

    Attributes
    ----------
    svg, title, notes
        As of ``Shown``.
    """

    svg: str
    title: str
    notes: tuple[str, ...]

    def _repr_svg_(self) -> str:
        return self.svg


def picture_alone(
    analysis: Analysis, focus: Key | None = None, kinds: Collection[str] | None = None, *, everything: bool = False
) -> AlonePicture:
    """Return a picture for a notebook or a file; the parameters are those of ``Pictures.of``.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> picture = picture_alone(analyse(*factory()), ("", "topic", "/filtered"))
    >>> picture.title, "<style>" in picture.svg
    ('How Video gets to /filtered, and where it can go from there', True)
    """
    with Pictures() as pictures:
        shown = pictures.of(analysis, focus, kinds, everything=everything)
    head, end, rest = shown.svg.partition(">")
    return AlonePicture(f"{head}{end}<style>{style_sheet()}</style>{rest}", shown.title, shown.notes)
