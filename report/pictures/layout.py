"""Picture -> SVG or PNG within a given time: by the best layout that is done in it, and the reader is told which.

In: a ``Picture``. Out: bytes, and what a reader has to know of how they came about.
"""

from __future__ import annotations

import struct
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.analysis.text import counted
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.pictures.graphviz import Graphviz, Job, TooLongError
from rosprivacy.report.pictures.svg import finished

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.pictures.picture import Picture

SVG, PNG = "svg", "png"
SECONDS = 45.0
LESS = "--finding, --around, --most and --fold draw less"
DOTS_PER_INCH = 144
LARGEST_INCHES = 50  # of a PNG: 7,200 dots a side, 200 MB while it is drawn


@dataclass(frozen=True, slots=True)
class Way:
    """One way to lay a picture out.

    Attributes
    ----------
    engine, attributes
        Of Graphviz.
    share
        Of the time that is left, at most.
    words
        What a reader has to know of it.
    """

    engine: str
    attributes: Mapping[str, str]
    share: float
    words: str = ""


WAYS = (
    Way("dot", {}, 1 / 3),
    Way(
        "sfdp",
        {"overlap": "ortho_yx", "splines": "line"},
        0.75,
        "boxes stand near what they are joined to, unordered",
    ),
    Way("sfdp", {"overlap": "true", "splines": "line", "K": "3"}, 1.0, "boxes may lie on each other"),
)


@dataclass(frozen=True, slots=True)
class Drawn:
    """A picture, drawn.

    Attributes
    ----------
    data
        The file.
    said
        What a reader has to know: that it was laid out by other means, that it was made smaller. Empty as a rule.
    """

    data: bytes
    said: tuple[str, ...] = ()


def drawn(
    picture: Picture, form: str, *, direction: str = "LR", seconds: float = SECONDS, ways: tuple[Way, ...] = WAYS
) -> Drawn:
    """Draw a picture.

    Parameters
    ----------
    form
        ``svg`` or ``png``.
    direction
        See ``dot``.
    seconds
        For all attempts together.

    Raises
    ------
    DrawingError
        If nothing is done in time, or Graphviz is not installed.
    """
    end = time.monotonic() + seconds
    said: tuple[str, ...] = ()
    with Graphviz() as graphviz:
        for way in ways:
            given = (end - time.monotonic()) * way.share
            if given <= 0:
                break
            note = (*said, f"Laid out by Graphviz's {way.engine}: {way.words}")[-2:] if way.words else ()
            text = dot(picture.noted(*note), direction=direction)
            try:
                data = graphviz.draw(Job(text, way.engine, form, {**way.attributes, **_paper(form)}), given)
            except TooLongError:
                said = (f"Graphviz's {way.engine} did not finish in {counted(round(given), 'second')}; {LESS}",)
                continue
            if form == SVG:
                return Drawn(finished(data, picture.noted(*note)), note)
            return Drawn(data, (*note, *_smaller(data)))
    what = f"the layout of {counted(len(picture.boxes), 'box', 'boxes')} takes more than {seconds:g} seconds"
    hint = "draw less (--around, --finding, --fold, --most), give it more with --seconds, or take --format dot"
    raise DrawingError(f"graph: {what}; {hint}")


def _paper(form: str) -> dict[str, str]:
    """A page: white, and for a PNG of a bounded size."""
    if form == SVG:
        return {"bgcolor": "white"}
    return {"bgcolor": "white", "dpi": str(DOTS_PER_INCH), "size": f"{LARGEST_INCHES},{LARGEST_INCHES}"}


def _smaller(data: bytes) -> tuple[str, ...]:
    """Whether a PNG was made to fit."""
    width, height = struct.unpack(">II", data[16:24])
    if max(width, height) < LARGEST_INCHES * DOTS_PER_INCH - 1:
        return ()
    return (f"The PNG is made smaller to fit into {max(width, height)} dots; an SVG is not",)
