"""The legend of a picture that is laid out already: in a corner that is free, or else in a strip of its own.

In: what the legend has to explain, and the picture as SVG. Out: nodes and lines of DOT with their places, for a layout
that keeps all places. A legend takes at most a tenth of the picture, down to the smallest letters that can be read.
"""

from __future__ import annotations

import re
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

from lxml import etree

from rosprivacy.report.pictures.dot import box_style, line_style
from rosprivacy.report.pictures.phrases import quoted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.report.pictures.looks import LegendEntry

SIZES = (9, 8, 7)  # of letters, in points; the largest that leaves room for the picture
LETTER, ROW = 0.53, 1.6  # width of a letter and height of a row, in sizes of letters
SWATCH, GAP = 22.0, 4.0  # points: what a sample takes, and the room before its words
APART = 8.0  # points: from what is drawn
SHARE = 0.1  # of the area of a picture
RINGS, THINNEST = 8.0, 3.0  # points: what a second outline takes, and the least height of the box inside
HEADS = {"normal": 5.0, "vee": 5.0, "tee": 1.5}  # points: how long the head of a line is
HEAD = 0.5  # of the size that Graphviz gives to heads
INCH = 72.0
UNSEEN = {"none", "transparent"}  # strokes and fills
DRAWN = ("node", "edge", "cluster")  # groups of Graphviz's SVG
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


class Box(NamedTuple):
    """A rectangle, in points, by its sides; upwards as Graphviz counts."""

    west: float
    south: float
    east: float
    north: float

    @property
    def area(self) -> float:
        """How much of the paper it takes."""
        return (self.east - self.west) * (self.north - self.south)

    def meets(self, other: Box) -> bool:
        """Whether it lies on another one, or too near to it."""
        return (
            self.west < other.east + APART
            and other.west < self.east + APART
            and self.south < other.north + APART
            and other.south < self.north + APART
        )


class Shape(NamedTuple):
    """A legend in columns: how large letters are, how many rows a column has, and how wide and high all is."""

    size: int
    rows: int
    width: float
    height: float


class Place(NamedTuple):
    """A legend at its place: its shape, its rectangle, and that of the picture with it."""

    shape: Shape
    box: Box
    whole: Box


class DrawnBoxes(NamedTuple):
    """The rectangles of what Graphviz drew, a curve in its parts; and of the title above it."""

    drawn: tuple[Box, ...]
    title: tuple[Box, ...]


def drawn_boxes(svg: bytes) -> DrawnBoxes:
    """Return the rectangles of a picture.

    >>> drawn_boxes(b'<svg><g class="graph"><g class="node"><polygon points="0,-10 20,-30"/></g></g></svg>').drawn
    (Box(west=0.0, south=10.0, east=20.0, north=30.0),)
    """
    parser = etree.XMLParser(resolve_entities=False, load_dtd=False, no_network=True, huge_tree=True)
    groups = list(etree.fromstring(svg, parser).iter("{*}g"))
    drawn = (shape for group in groups if group.get("class") in DRAWN for shape in group.iter("{*}*"))
    title = (text for group in groups if group.get("class") == "graph" for text in group.findall("{*}text"))
    return DrawnBoxes(
        tuple(box for shape in drawn for box in _boxes(shape)),
        tuple(box for text in title for box in _boxes(text)),
    )


def _boxes(shape: etree._Element) -> Iterator[Box]:
    tag = etree.QName(shape).localname
    if tag == "ellipse":
        x, y, rx, ry = (float(shape.get(name, "0")) for name in ("cx", "cy", "rx", "ry"))
        yield Box(x - rx, -y - ry, x + rx, -y + ry)
    elif tag == "text":
        x, y, size = (float(shape.get(name, "0")) for name in ("x", "y", "font-size"))
        wide = len(shape.text or "") * size * LETTER
        west = x if shape.get("text-anchor") == "start" else x - wide / 2
        yield Box(west, -y, west + wide, size - y)
    elif tag in ("polygon", "polyline", "path") and not {shape.get("stroke"), shape.get("fill")} <= UNSEEN:
        numbers = [float(number) for number in _NUMBER.findall(shape.get("points") or shape.get("d") or "")]
        points = list(zip(numbers[::2], numbers[1::2], strict=False))
        step = 3 if tag == "path" else len(points)
        for at in range(0, max(len(points) - 1, 1), step):
            yield around(Box(x, -y, x, -y) for x, y in points[at : at + step + 1])


def legend_place(entries: Sequence[LegendEntry], boxes: DrawnBoxes) -> Place:
    """Return where the legend stands: where it makes the picture least larger, in the largest letters that fit.

    Complexity: O(entries x boxes).
    """
    content, best = around(boxes.drawn), None
    frame = around([content, *boxes.title])._replace(north=content.north)
    for size in SIZES:
        shapes = [_shape(entries, size, columns) for columns in range(1, len(entries) + 1)]
        places = [
            Place(shape, box, around([content, *boxes.title, box]))
            for shape in shapes
            for box in _corners(shape, frame, boxes.drawn)
        ]
        best = min(places, key=lambda place: (place.whole.area, place.shape.height))
        if best.box.area <= SHARE * best.whole.area:
            break
    assert best is not None
    return best


def around(boxes: Iterable[Box]) -> Box:
    """Return the rectangle around some."""
    wests, souths, easts, norths = zip(*boxes, strict=True)
    return Box(min(wests), min(souths), max(easts), max(norths))


def _shape(entries: Sequence[LegendEntry], size: int, columns: int) -> Shape:
    rows = ceil(len(entries) / columns)
    wide = sum(_width(entries[at : at + rows], size) for at in range(0, len(entries), rows))
    return Shape(size, rows, wide, rows * size * ROW)


def _width(entries: Iterable[LegendEntry], size: int) -> float:
    """Of a column."""
    return SWATCH + GAP + (max(len(entry.words) for entry in entries) + 2) * size * LETTER


def _corners(shape: Shape, frame: Box, boxes: Sequence[Box]) -> Iterator[Box]:
    """A free corner below the title; else a strip below all, or at its right."""
    wests = (frame.west, frame.east - shape.width)
    souths = (frame.south, frame.north - shape.height)
    corners = [_of(west, south, shape) for south in souths for west in wests]
    inside = shape.width <= frame.east - frame.west and shape.height <= frame.north - frame.south
    if inside and (free := next((c for c in corners if not any(c.meets(box) for box in boxes)), None)):
        yield free
    yield _of(frame.west, frame.south - APART - shape.height, shape)
    yield _of(frame.east + APART, frame.south, shape)


def _of(west: float, south: float, shape: Shape) -> Box:
    return Box(west, south, west + shape.width, south + shape.height)


def legend_dot(entries: Sequence[LegendEntry], place: Place) -> str:
    """Return the legend as lines of DOT with places, to stand at the end of a graph."""
    shape, box = place.shape, place.box
    rows: list[str] = []
    west = box.west
    for at in range(0, len(entries), shape.rows):
        column = entries[at : at + shape.rows]
        wide = _width(column, shape.size)
        for number, entry in enumerate(column):
            middle = box.north - (number + 0.5) * shape.size * ROW
            rows += _sample(entry, at + number, west, middle, shape.size)
            rows.append(_words(entry, at + number, west + SWATCH + GAP, west + wide, middle, shape.size))
        west += wide
    return "\n".join(rows)


def _sample(entry: LegendEntry, number: int, west: float, middle: float, size: int) -> Iterator[str]:
    """What stands before the words: a small box, or a short line."""
    if entry.shape:
        rings = RINGS if entry.look.double else 0.0
        high = max(THINNEST, size * ROW - 2 - rings) if rings else size * 1.2
        place = f'pos="{west + SWATCH / 2:.2f},{middle:.2f}", fixedsize=true, label="", id=l{number}'
        sides = f"width={(SWATCH - rings - 2) / INCH:.3f}, height={high / INCH:.3f}"
        yield f"l{number} [{', '.join(box_style(entry.look, entry.shape))}, {place}, {sides}];"
        return
    start, end = west + 1, west + SWATCH - 1
    for name, x in ((f"s{number}", start), (f"e{number}", end)):
        point = "shape=point, style=invis, fixedsize=true, width=0.01, height=0.01"
        yield f'{name} [label="", {point}, pos="{x:.2f},{middle:.2f}", id={name}];'
    last = end - HEADS[entry.look.head]
    bends = " ".join(f"{x:.2f},{middle:.2f}" for x in (start, start + 4, last - 4, last))
    style = ", ".join(line_style(entry.look))
    yield f's{number} -> e{number} [{style}, arrowsize={HEAD}, pos="e,{end:.2f},{middle:.2f} {bends}", id=k{number}];'


def _words(entry: LegendEntry, number: int, west: float, east: float, middle: float, size: int) -> str:
    label = quoted(entry.words)[:-1] + '\\l"'
    sides = f"fixedsize=true, width={(east - west) / INCH:.3f}, height={size * ROW / INCH:.3f}"
    place = f'pos="{(west + east) / 2:.2f},{middle:.2f}", id=t{number}'
    return f"t{number} [label={label}, shape=plaintext, margin=0, fontsize={size}, {sides}, {place}];"
