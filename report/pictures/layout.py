"""Picture -> SVG or PNG, the same whatever else the machine does: the layout is chosen by the picture's size.

In: a ``Picture``. Out: bytes, and what a reader has to know of how they came about.
"""

from __future__ import annotations

import re
import struct
import time
from dataclasses import dataclass
from functools import cache
from math import inf
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
DIRECTIONS = ("LR", "TB")
ORDERED = "dot"  # the engine that knows a direction
PAGE = (1100, 1400)  # points: what can be read without moving it to the side
REMEDY = "--finding, --around, --most and --fold draw less"
INSTEAD = "draw less (--around, --finding, --fold, --most), give it more with --seconds, or take --format dot"
DOTS_PER_INCH = 144
LARGEST_INCHES = 50  # of a PNG: 7,200 dots a side, 200 MB while it is drawn


@dataclass(frozen=True, slots=True)
class Way:
    """One way to lay a picture out.

    Attributes
    ----------
    engine, attributes
        Of Graphviz.
    max_crossings
        What it is taken for: see ``crossings``.
    words
        What a reader has to know of it.
    """

    engine: str
    attributes: Mapping[str, str]
    max_crossings: float = inf
    words: str = ""


# By size, never by time: the same picture on a busy machine. dot takes 0.4 s of processor time for 450 boxes and 673
# lines of benchmarks/pictures.py, 2 for 500 and 833, 28 for 520 and 953, and is not done in 100 for 540 and 1,100;
# each picture of the public policies takes less than 0.3. sfdp takes 4 for all 1,900 boxes and 5,215 lines.
WAYS = (
    Way("dot", {}, 1_000_000),
    Way(
        "sfdp",
        {"overlap": "ortho_yx", "splines": "line"},
        150_000_000,
        "boxes stand near what they are joined to, unordered",
    ),
    Way("sfdp", {"overlap": "true", "splines": "line", "K": "3"}, words="boxes may lie on each other"),
)


@dataclass(frozen=True, slots=True)
class Drawn:
    """A picture, drawn.

    Attributes
    ----------
    data
        The file.
    remarks
        What a reader has to know: that it was laid out by other means, that it was made smaller. Empty as a rule.
    """

    data: bytes
    remarks: tuple[str, ...] = ()


def drawn(
    picture: Picture,
    form: str,
    *,
    direction: str = "LR",
    seconds: float = SECONDS,
    ways: tuple[Way, ...] = WAYS,
    remedy: str = REMEDY,
    instead: str = INSTEAD,
) -> Drawn:
    """Draw a picture.

    Parameters
    ----------
    form
        ``svg`` or ``png``.
    direction
        See ``dot``; empty for the one that can be drawn larger on a page.
    seconds
        For all of it. The picture does not depend on it: when time runs out there is none.
    less, instead
        What a reader can do who wants less of it, and where none is done in time.

    Raises
    ------
    DrawingError
        If it is not done in time, or Graphviz is not installed.
    """
    end = time.monotonic() + seconds
    way = way_of(picture, ways)
    note = (f"Laid out by Graphviz's {way.engine}, since it is large: {way.words}; {remedy}",) if way.words else ()
    noted = picture.noted(*note)
    with Graphviz() as graphviz:

        @cache
        def draw(form: str, direction: str) -> bytes:
            job = Job(dot(noted, direction=direction), way.engine, form, {**way.attributes, **_paper(form)})
            return graphviz.draw(job, end - time.monotonic())

        try:
            if not direction and way.engine == ORDERED:
                direction = max(DIRECTIONS, key=lambda one: _scale(draw(SVG, one)))
            data = draw(form, direction or DIRECTIONS[0])
        except TooLongError:
            what = f"the layout of {counted(len(picture.boxes), 'box', 'boxes')} takes more than {seconds:g} seconds"
            raise DrawingError(f"graph: {what}; {instead}") from None
    if form == SVG:
        return Drawn(finished(data, noted), note)
    return Drawn(data, (*note, *_smaller(data)))


def way_of(picture: Picture, ways: tuple[Way, ...] = WAYS) -> Way:
    """Return how a picture is laid out: by its size alone."""
    return next(way for way in ways if crossings(len(picture.boxes), len(picture.lines)) <= way.max_crossings)


def crossings(boxes: int, lines: int) -> int:
    """Return how often a line may meet a box or another line: what an ordered layout has to weigh up."""
    return lines * (boxes + lines)


def _scale(svg: bytes) -> float:
    """How large a picture can be on a page; no larger than it is."""
    sides = re.search(rb'<svg width="([\d.]+)pt" height="([\d.]+)pt"', svg)
    assert sides
    return min(1.0, *(page / float(side) for page, side in zip(PAGE, sides.groups(), strict=True)))


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
