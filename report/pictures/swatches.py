"""The legend of a picture in DOT: boxes and lines that look like those which they explain, in a part of its own.

In: the entries of a legend. Out: rows of DOT, for ``dot.py``. Graphviz lays the part out by itself, below the picture.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from rosprivacy.report.pictures.looks import INK, PALE, Entry, Look, Shape
from rosprivacy.report.pictures.wording import quoted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

BOXES, LINES = 4, 2  # in a row; a line has two ends
PACKED = {"LR": "array_cltu1", "TB": "array_lu1"}  # in one column, to the left, in the order of the file
FRAME = 'graph [label="", peripheries=0, margin=0];'


def box_style(look: Look, shape: Shape, *, dashed: bool = False) -> list[str]:
    """Return the attributes of a box, of the picture or of its legend."""
    name, style = shape.graphviz
    styles = ["filled", *([style] if style else []), *(["dashed"] if dashed or look.style == "dashed" else [])]
    return [
        f"shape={name}",
        f'style="{",".join(styles)}"',
        f'fillcolor="{look.colour}"',
        f"penwidth={look.width:g}",
        *(["peripheries=2"] if look.double else []),
        *([f'fontcolor="{INK}"'] if look.colour == PALE else []),
    ]


def line_style(look: Look, *, dashed: bool = False) -> list[str]:
    """Return the attributes of a line, of the picture or of its legend."""
    style = "dashed" if dashed else look.style
    return [
        f'color="{look.colour}"',
        *([f"style={style}"] if style != "solid" else []),
        *([f"penwidth={look.width:g}"] if look.width != 1 else []),
        *([f"arrowhead={look.head}"] if look.head != "normal" else []),
    ]


def swatches(entries: Sequence[Entry], direction: str) -> Iterator[str]:
    """Return the legend as a cluster: rows of boxes, then rows of lines, held together by lines that nobody sees."""
    boxes = [(f"l{number}", f"l{number}") for number, entry in enumerate(entries) if entry.shape]
    lines = [(f"s{number}", f"l{number}") for number, entry in enumerate(entries) if not entry.shape]
    rows = [*_rows(boxes, BOXES), *_rows(lines, LINES)]
    if direction == "LR":  # Graphviz lays out from below
        rows.reverse()
    said = {name: text for number, entry in enumerate(entries) for name, text in _sample(entry, number).items()}
    yield "  subgraph cluster_legend {"
    yield f"    {FRAME}"
    yield '    node [height=0.26, margin="0.07,0.02"]; edge [weight=100];'
    yield from (f"    {said[name]}" for row in rows for sample in row for name in dict.fromkeys(sample))
    yield from (f"    {said[f'{start} -> {end}']}" for start, end in lines)
    yield from (f"    {end} -> {start} [style=invis];" for row in rows for end, start in _joints(row))
    yield "  }"


def _sample(entry: Entry, number: int) -> dict[str, str]:
    """What stands for an entry: a box with its words in it, or a line that leads to them."""
    box, start = f"l{number}", f"s{number}"
    if entry.shape:
        style = ", ".join(box_style(entry.look, entry.shape))
        return {box: f"{box} [label={quoted(entry.words)}, {style}, id={box}];"}
    return {
        start: f'{start} [label=" ", shape=point, style=invis, id={start}];',
        box: f"{box} [label={quoted(entry.words)}, shape=plaintext, id={box}];",
        f"{start} -> {box}": f"{start} -> {box} [{', '.join(line_style(entry.look))}, id=k{number}];",
    }


def _rows(samples: Sequence[tuple[str, str]], most: int) -> Iterable[Sequence[tuple[str, str]]]:
    return (samples[at : at + most] for at in range(0, len(samples), most))


def _joints(row: Sequence[tuple[str, str]]) -> Iterable[tuple[str, str]]:
    """Where each sample of a row ends, and where the next one starts."""
    return ((one[1], other[0]) for one, other in pairwise(row))
