"""Picture -> SVG or PNG by Graphviz, the same whatever else the machine does; SVG as people can read it.

In: a ``Picture``. Out: bytes, and what a reader has to know of how they came about: the layout is chosen by the
picture's size. Graphviz runs in a process of its own: it can be ended when it takes too long, and may crash without
harm to us. The process is started once and draws one picture after the other; it imports pygraphviz, which brings
Graphviz along, and nothing of ours but ``graphviz_worker.py``. The SVG gets a title and a description, tips on boxes
and lines, and has nothing external.
"""

from __future__ import annotations

import json
import re
import struct
import subprocess
import sys
import threading
import time
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from lxml import etree

from rosprivacy.analysis.errors import DrawingError, shown
from rosprivacy.analysis.installing import command_for
from rosprivacy.analysis.text import counted, printable
from rosprivacy.report.pictures.corner_legend import drawn_boxes, legend_dot, legend_place
from rosprivacy.report.pictures.dot import dot, hover, line_hover, paired
from rosprivacy.report.pictures.looks import legend
from rosprivacy.report.pictures.phrases import sentences

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import TracebackType

    from rosprivacy.analysis.python_311 import Self
    from rosprivacy.report.pictures.picture import Picture

WORKER = str(Path(__file__).with_name("graphviz_worker.py"))
MISSING = "Graphviz is not installed, so there is no"
LIBRARIES = "libexpat1 libglib2.0-0 libxext6 libxrender1"  # Debian's packages of what the wheels leave to the system


def available() -> bool:
    """Return whether Graphviz is installed."""
    return find_spec("pygraphviz") is not None


def how_to_get_it() -> str:
    """Return what to do where Graphviz is not installed; most machines need no more than the command."""
    return f"install it: {command_for('views')} (where no wheel fits, first its headers; Debian: libgraphviz-dev)"


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
            text_forms = "take --format dot, graphml or mermaid, or"
            raise DrawingError(f"graph: {MISSING} SVG and no PNG; {text_forms} {how_to_get_it()}")
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
            what = f"graph: Graphviz cannot draw this: {shown(answer['error'])}"
            libraries = "" if answer["loaded"] else f"install the system's libraries (Debian: {LIBRARIES}), or "
            raise DrawingError(f"{what}; {libraries}take --format dot")
        return data

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None:
            command = [sys.executable, WORKER]
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


NAMESPACE = "http://www.w3.org/2000/svg"
TITLE, DESCRIPTION = f"{{{NAMESPACE}}}title", f"{{{NAMESPACE}}}desc"
MOST_WAYS = 20  # that are told in the description


def finished(data: bytes, picture: Picture) -> bytes:
    """Return a file of its own."""
    root = _described(data, picture)
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def alt_text(picture: Picture) -> str:
    """Return what a picture shows, for people who do not see it."""
    ways = [picture.say("picture.alt.way", way=way) for way in picture.ways[:MOST_WAYS]]
    if len(picture.ways) > MOST_WAYS:
        ways.append(picture.say("picture.alt.more", n=len(picture.ways) - MOST_WAYS))
    return printable(sentences([*picture.notes, *ways])) or picture.say("picture.alt.nothing")


def _described(data: bytes, picture: Picture) -> etree._Element:
    parser = etree.XMLParser(resolve_entities=False, load_dtd=False, remove_comments=True, huge_tree=True)
    root = etree.fromstring(data, parser)
    tips = {picture.keys[box.key]: hover(picture, box) for box in picture.boxes}
    tips |= {f"e{number}": line_hover(picture, line) for number, (line, _) in enumerate(paired(picture))}
    for group in list(root.iter(f"{{{NAMESPACE}}}g")):
        unlink(group)
        title = group.find(TITLE)
        if title is None:
            continue
        tip = tips.get(str(group.get("id")))
        if tip is None:  # of the whole, of a cluster, of the legend: what there is to say is drawn
            group.remove(title)
        else:
            title.text = tip
    _head(root, picture)
    etree.cleanup_namespaces(root)
    return root


def group_of(group: etree._Element) -> str:
    """Return what a group of Graphviz's draws: ``graph``, ``cluster``, ``node`` or ``edge``."""
    return str(group.get("class"))


def unlink(group: etree._Element) -> None:
    """Take the links out that Graphviz makes of tooltips: they lead nowhere."""
    for holder in list(group):
        if holder.tag == f"{{{NAMESPACE}}}g" and str(holder.get("id", "")).startswith("a_"):
            shapes = [shape for link in holder for shape in link]
            at = group.index(holder)
            group.remove(holder)
            for number, shape in enumerate(shapes):
                group.insert(at + number, shape)


def _head(root: etree._Element, picture: Picture) -> None:
    title, description = etree.Element(TITLE), etree.Element(DESCRIPTION)
    title.text, description.text = printable(picture.title), alt_text(picture)
    title.set("id", "title")
    description.set("id", "desc")
    root.insert(0, title)
    root.insert(1, description)
    root.set("role", "img")
    root.set("aria-labelledby", "title desc")


SVG, PNG = "svg", "png"
PLACED, IN_PLACE = "dot", "nop2"  # a graph with the places of all in it, and the layout that keeps them
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

        def draw(job: Job) -> bytes:
            return graphviz.draw(job, end - time.monotonic())

        @cache
        def laid_out(direction: str) -> tuple[str, bytes]:
            text = dot(noted, direction=direction, legend=False)
            laid = draw(Job(text, way.engine, PLACED, way.attributes)).decode()
            return laid, draw(Job(laid, IN_PLACE, SVG, {"notranslate": "true"}))

        try:
            if not direction and way.engine == ORDERED:
                direction = max(DIRECTIONS, key=lambda one: _scale(laid_out(one)[1]))
            text = _with_legend(noted, *laid_out(direction or DIRECTIONS[0]))
            data = draw(Job(text, IN_PLACE, form, _paper(form)))
        except TooLongError:
            what = f"the layout of {counted(len(picture.boxes), 'box', 'boxes')} takes more than {seconds:g} seconds"
            raise DrawingError(f"graph: {what}; {instead}") from None
    if form == SVG:
        return Drawn(finished(data, noted), note)
    return Drawn(data, (*note, *_smaller(data)))


def _with_legend(picture: Picture, laid: str, svg: bytes) -> str:
    """A graph with all places, and its legend in a corner."""
    entries, boxes = legend(picture), drawn_boxes(svg)
    if not (entries and boxes.drawn):
        return laid
    return f"{laid.rstrip().removesuffix('}')}{legend_dot(entries, legend_place(entries, boxes))}\n}}\n"


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
