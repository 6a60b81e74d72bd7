"""The pictures of an explorer: an analysis, the element in hand and the kinds that are shown -> what a page puts in.

In: an ``Analysis`` after each edit. Out: ``PagePicture``. What pictures of one analysis share is kept until another
comes, and layouts are kept by what is drawn. Graphviz runs in a process of its own with a time limit; where it is not
installed, is too slow, or fails, the picture says so in its place, and lists beside it say the rest.

The style sheet has the colours and widths of ``looks.py`` and is the same for every picture; the legend is a list with
only what is in the picture. Ink and paper are those of the page (``--picture-ink``, ``--picture-paper``), or else those
of the reader's system, so that it is dark where the page is. Nothing hangs on colour alone: a role is also an outline
and a word, a kind is a shape, a line has a width and a head.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import replace
from threading import Lock
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.report.pictures.graphviz import (
    DIRECTIONS,
    ORDERED,
    Closing,
    Graphviz,
    Job,
    TooLongError,
    available,
    way_of,
)
from rosprivacy.report.pictures.graphviz import WAYS as ON_PAPER
from rosprivacy.report.pictures.live_svg import SIZE, SMALL, fits, live_svg, unnamed_dot, without_places
from rosprivacy.report.pictures.looks import BLUE, DRAWN_ROLES, INK, KIND_LOOKS, LINE_LOOKS, OPEN, PALE, TEXT
from rosprivacy.report.pictures.phrases import Phrases
from rosprivacy.report.pictures.picture import DRAWN, PRIVACY
from rosprivacy.report.pictures.scenes import Scene, Scenes

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.witness import WhyCarried, Witness
    from rosprivacy.report.pictures.graphviz import Way
    from rosprivacy.report.pictures.live_svg import Links
    from rosprivacy.report.pictures.looks import Look
    from rosprivacy.report.pictures.picture import Key, Picture

NODE, TOPIC, SERVICE = "node", "topic", "service"
_BLOCK = '<polygon class="area" points="4,3 28,3 28,15 4,15"/>'
_OVAL = '<ellipse class="area" cx="16" cy="9" rx="12" ry="6"/>'
_FORMS = {
    NODE: _OVAL,
    TOPIC: _BLOCK,
    SERVICE: '<rect class="area" x="4" y="3" width="24" height="12" rx="5"/>',
}
_DOUBLE = '<ellipse class="outline" cx="16" cy="9" rx="15" ry="8.5"/>'
_ITEM = '<li><svg class="picture" width="32" height="18" aria-hidden="true"><g class="{classes}">{form}</g></svg> '
_LINE = '<path class="outline" d="M2,9 L24,9"/><polygon class="area" points="24,5 31,9 24,13"/>'
_ENDS = '<path class="outline" d="M2,9 L28,9 M28,4 L28,14"/>'


class Sign(NamedTuple):
    """One look and its meaning.

    Attributes
    ----------
    classes
        Of the style sheet.
    form
        Its shapes, as SVG of 32 to 18 pixels.
    words
        What it means.
    """

    classes: str
    form: str
    words: str


def signs(scene: Scene) -> tuple[Sign, ...]:
    """Return what of a picture needs to be explained: roles, then kinds of elements, then lines."""
    picture = scene.picture
    looks = {box.look for box in picture.boxes} | ({OPEN} if any(box.open for box in picture.boxes) else set())
    kinds, lines = {box.kind for box in picture.boxes}, {line.look for line in picture.lines}
    forms = _FORMS if picture.view == PRIVACY else {kind: _FORMS.get(kind, _BLOCK) for kind in DRAWN}
    found = [
        Sign(
            f"box look-{name}{' open' if name == OPEN else ''}",
            _OVAL + (_DOUBLE if look.double else ""),
            picture.say(f"picture.look.{name}"),
        )
        for name, look in DRAWN_ROLES.items()
        if name in looks
    ]
    for kind, form in forms.items():
        if kind in kinds:  # where there are no roles, kinds have colours
            coloured = f" look-{kind}" if kind in looks else ""
            found.append(Sign(f"box kind-{kind}{coloured}", form, picture.say(f"picture.look.{kind}")))
    found += [
        Sign(f"line look-{name}", _ENDS if look.head == "tee" else _LINE, picture.say(f"picture.look.{name}"))
        for name, look in LINE_LOOKS.items()
        if name in lines
    ]
    if any(line.pseudonymised for line in picture.lines):
        found.append(Sign("line hidden", _LINE, picture.say("picture.dashed")))
    return tuple(found)


def legend(scene: Scene) -> Markup:
    """Return the legend as a list of HTML.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.report.pictures.scenes import Scenes
    >>> "way out: lets data out" in legend(Scenes(analyse(*factory())).of())
    True
    """
    items = (Markup(_ITEM).format(classes=sign.classes, form=Markup(sign.form)) + sign.words for sign in signs(scene))  # noqa: S704 - forms of our own
    return Markup('<ul class="picture-legend">') + Markup("").join(items) + Markup("</ul>")


FONT = "system-ui, Helvetica, Arial, sans-serif"
DASHED, DOTTED = "6 3", "2 3"
_HEAD = f"""\
.picture {{ color: var(--picture-ink, CanvasText); font: {SIZE}px {FONT}; max-width: none; }}
.picture text {{ fill: currentColor; stroke: none; text-anchor: middle; }}
.picture .word {{ font-size: {SMALL}px; }}
.picture .area, .picture .outline {{ stroke: currentColor; stroke-width: 1; }}
.picture .outline {{ fill: none; }}
.picture .area {{ fill: var(--picture-paper, Canvas); }}
.picture .box {{ cursor: pointer; }}
.picture .box.open .area, .picture .box.open .outline {{ stroke-dasharray: {DASHED}; }}
.picture .box:focus {{ outline: none; }}
.picture .box:hover .area, .picture .box:focus .area {{ stroke: {BLUE}; stroke-width: 3; }}
.picture .box.focus .area {{ stroke: {BLUE}; stroke-width: 5; stroke-dasharray: none; }}
.picture .box.focus .name {{ font-weight: bold; }}
.picture .box:focus-visible {{ outline: 3px solid {BLUE}; outline-offset: 3px; }}
.picture-legend {{ list-style: none; margin: 0; padding: 0; display: flex; flex-wrap: wrap; gap: 0.2rem 1rem; }}
.picture-legend svg {{ vertical-align: middle; }}
.picture .line .area {{ fill: currentColor; }}
.picture .line.hidden .outline {{ stroke-dasharray: {DASHED}; }}
.picture .number circle {{ fill: {BLUE}; stroke: var(--picture-paper, Canvas); stroke-width: 1.5; }}
.picture .number text {{ fill: {PALE}; font-weight: bold; }}
"""


def style_sheet() -> str:
    """Return the style sheet.

    >>> "look-leak" in style_sheet()
    True
    """
    return "".join([_HEAD, *_boxes(), *_lines()])


def _boxes() -> Iterator[str]:
    for name, look in (*DRAWN_ROLES.items(), *KIND_LOOKS.items()):
        box = f".picture .box.look-{name}"
        if look.colour != PALE:
            yield f"{box} > .area {{ fill: {look.colour}; }}\n{box} text {{ fill: {TEXT}; }}\n"
        if look.width != 1:
            yield f"{box}:not(.focus) > .area {{ stroke-width: {look.width:g}; }}\n"


def _lines() -> Iterator[str]:
    for name, look in LINE_LOOKS.items():
        line = f".picture .line.look-{name}"
        colour = "currentColor" if look.colour == INK else look.colour
        yield f"{line} > .outline {{ stroke: {colour}; stroke-width: {look.width:g};{_dashes(look)} }}\n"
        yield f"{line} > .area {{ stroke: {colour}; fill: {colour}; }}\n"


def _dashes(look: Look) -> str:
    return {"dashed": f" stroke-dasharray: {DASHED};", "dotted": f" stroke-dasharray: {DOTTED};"}.get(look.style, "")


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


class PagePicture(NamedTuple):
    """What a page shows of a picture.

    Attributes
    ----------
    svg
        One ``<svg>`` element: ``live_svg.py`` says what a page can rely on, ``style_sheet`` how it looks.
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
    ) -> PagePicture:
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
        return PagePicture(
            self._drawing.svg(scene, links, room), legend(scene), picture.title, picture.notes, picture.ways
        )

    def drawn(self, picture: Picture, links: Links | None = None, room: tuple[float, float] = ROOM) -> PagePicture:
        """Return a picture that was made elsewhere, such as what a query of the database gives.

        Parameters
        ----------
        links, room
            As of ``of``.
        """
        scene = Scene(picture)
        return PagePicture(
            self._drawing.svg(scene, links, room), legend(scene), picture.title, picture.notes, picture.ways
        )


class AlonePicture(NamedTuple):
    """A picture that needs no page: its SVG carries its style. A notebook shows it.

    Attributes
    ----------
    svg, title, notes
        As of ``PagePicture``.
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
