"""Picture -> DOT, the language of Graphviz, with a legend; the same for the same picture, to the byte.

In: a ``Picture``. Out: text. Names stand in quoted strings, or below in an HTML-like label, and are escaped for each.
"""

from __future__ import annotations

from html import escape
from itertools import pairwise
from textwrap import wrap
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.pictures.looks import (
    INK,
    LEAK,
    LINE_LOOKS,
    PALE,
    SHAPES,
    SHORTEST,
    SOURCE,
    TEXT,
    LegendEntry,
    Look,
    Shape,
    box_look,
)
from rosprivacy.report.pictures.looks import legend as legend_of
from rosprivacy.report.pictures.phrases import LONGEST_LINE, broken, quoted
from rosprivacy.report.pictures.picture import PRIVACY, RECORD

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.report.pictures.picture import Box, Picture, PictureLine


FONT = "Helvetica,Arial,sans-serif"
SIZE = 11  # of letters, in points
LONGEST_NOTE = 110
FOLDED_NAMES = 3
STRAIGHT = 8  # how much a step of a shortest path wants to be short and straight; others 1
WIDEST_WORDS = 34  # letters of a line on a box
LONGEST_WORD = 60  # on a line
ON_A_LINE = "shape=plaintext, margin=0, height=0, width=0"
LONGEST_WORDS = 300  # of all lines of a phrase: what some kinds of data are called goes in whole


def dot(picture: Picture, *, direction: str = "LR", legend: bool = True, title: bool = True) -> str:
    """Return a picture as DOT.

    Parameters
    ----------
    direction
        ``LR`` or ``TB``: where the data goes on the paper.
    legend
        Whether a legend stands below it.
    title
        Whether title and notes stand above it.
    """
    entries = legend_of(picture) if legend else []
    caption = f"label=<{_caption(picture)}>, " if title else ""
    packed = f'pack=12, packmode="{PACKED[direction]}", ' if entries else ""
    text = f'fontname="{FONT}", fontsize={SIZE}'
    place = f"labelloc=t, labeljust=l, {packed}rankdir={direction}, nodesep=0.22, ranksep=0.4, pad=0.1"
    rows = [
        "digraph rosprivacy {",
        f'  graph [{caption}{place}, {text}, fontcolor="{INK}", charset="UTF-8", bgcolor=transparent];',
        f'  node [{text}, fontcolor="{TEXT}", color="{INK}", margin="0.1,0.05", height=0.35];',
        f'  edge [color="{INK}", arrowsize=0.7];',
    ]
    drawn = list(_drawn(picture))
    if title:  # in a cluster, which makes a picture narrower
        drawn = ["  subgraph cluster_drawn {", f"    {FRAME}", *drawn, "  }"]
    if entries:
        legend_rows = swatches(entries, direction)
        drawn = [*legend_rows, *drawn] if direction == "LR" else [*drawn, *legend_rows]  # LR is packed from below
    return "\n".join([*rows, *drawn, "}", ""])


def _drawn(picture: Picture) -> Iterator[str]:
    groups = sorted({box.group for box in picture.boxes if box.group})
    for number, group in enumerate(groups):
        yield f"  subgraph cluster_{number} {{"
        name = quoted(shortened(group, 60))
        style = f'label={name}, labeljust=l, labelloc=t, color="{INK}", style=dotted, peripheries=1, margin=8'
        yield f"    graph [{style}, id=g{number}];"
        yield from (f"    {_box(picture, box)}" for box in picture.boxes if box.group == group)
        yield "  }"
    yield from (f"  {_box(picture, box)}" for box in picture.boxes if not box.group)
    if picture.view == PRIVACY:
        yield from _sides(picture)
    yield from (
        f"  {_line(picture, line, number, two_way=both)}" for number, (line, both) in enumerate(paired(picture))
    )


def _sides(picture: Picture) -> Iterator[str]:
    """Sources on one side, leaks on the other; what is in a group stays there."""
    for look, rank in ((SOURCE, "min"), (LEAK, "max")):
        keys = [picture.keys[box.key] for box in picture.boxes if box.look == look and not box.group]
        if keys:
            yield f"  {{ rank={rank}; {'; '.join(keys)} }}"


def _lines(texts: list[str]) -> str:
    """Several lines as one quoted string; none is empty: for such a line Graphviz 14 frees what it has not set."""
    return '"' + "\\n".join(quoted(text)[1:-1] or " " for text in texts) + '"'


def label_lines(picture: Picture, box: Box, width: int = LONGEST_LINE) -> list[str]:
    """Return what stands on a box: its name or names, the robot where there are several, and its words.

    Parameters
    ----------
    width
        Letters of a line of a name; names of several elements are a little longer.
    """
    robots = len({box.robot for box in picture.boxes if box.robot}) > 1
    grouped = box.group.startswith((picture.say("picture.robot", robot=""), box.robot))
    lines = [shortened(box.robot, 28)] if robots and box.robot and not grouped else []
    if len(box.names) == 1:
        lines += broken(box.names[0], width)
    else:
        lines += [shortened(name, width + 8) for name in box.names[:FOLDED_NAMES]]
        more = len(box.names) - FOLDED_NAMES
        lines += [picture.say("more", n=more)] if more > 0 else []
    return [*lines, *(line for word in box.words for line in wrap(shortened(word, LONGEST_WORDS), WIDEST_WORDS))]


def hover(picture: Picture, box: Box) -> str:
    """Return what is said of a box where there is room: its full name, kind, role."""
    names = ", ".join(shortened(name, 200) for name in box.names[:20])
    said = [picture.say(f"picture.look.{box.kind}") if box.kind != RECORD else box.kind]
    said += [picture.say("picture.robot", robot=shortened(box.robot, 60))] if box.robot else []
    if picture.view == "privacy":
        said.append(picture.say(f"picture.look.{box.look}").partition(":")[0].rstrip())
    said += [shortened(name, 60) for name in box.types[:4]]
    said += box.words
    if box.open and box.look != "open":
        said.append(picture.say("picture.partly"))
    return f"{names} ({'; '.join(said)})"


def line_hover(picture: Picture, line: PictureLine) -> str:
    """Return what is said of a line: its ends, the grants behind it, what goes along it."""
    arrow = picture.words("picture.to").join((shortened(line.source[2], 100), shortened(line.target[2], 100)))
    said = [line.words or picture.say(f"picture.look.{line.look}"), ", ".join(line.roles)]
    if line.carries:
        carries = ", ".join(line.carries)
        said.append(picture.say("terminal.hidden", kind=carries) if line.pseudonymised else carries)
    said += [shortened(str(place), 100) for place in line.places[:3]]
    if len(line.places) > 3:  # noqa: PLR2004 - as above
        said.append(picture.say("policy.more", n=len(line.places) - 3))
    return f"{arrow} ({'; '.join(text for text in said if text)})"


def paired(picture: Picture) -> Iterator[tuple[PictureLine, bool]]:
    """Each line to be drawn, and whether it also stands for the one that goes back and looks the same."""
    looks = {(line.source, line.target, line.look, line.words): line for line in picture.lines}
    drawn = set()
    for line in picture.lines:
        here = (line.source, line.target, line.look, line.words)
        there = (line.target, line.source, line.look, line.words)
        if here in drawn:
            continue
        back = looks.get(there)
        both = back is not None and back.pseudonymised == line.pseudonymised
        drawn |= {here, there} if both else {here}
        yield line, both


def _box(picture: Picture, box: Box) -> str:
    look, shape = box_look(picture.view, box.look), SHAPES[box.kind]
    under_the_lid = [""] if look.double and shape.graphviz[0] == "cylinder" else []
    attributes = [
        f"label={_lines([*under_the_lid, *label_lines(picture, box)])}",
        *box_style(look, shape, dashed=box.open),
        f"id={picture.keys[box.key]}",
        f"tooltip={quoted(hover(picture, box))}",
    ]
    return f"{picture.keys[box.key]} [{', '.join(attributes)}];"


def _line(picture: Picture, line: PictureLine, number: int, *, two_way: bool) -> str:
    look = LINE_LOOKS[line.look]
    attributes = [
        *line_style(look, dashed=line.pseudonymised),
        *(["dir=both"] if two_way else []),
        *([f"arrowtail={look.head}"] if two_way and look.head != "normal" else []),
        *([f"weight={STRAIGHT}"] if line.look == SHORTEST else []),
        f"id=e{number}",
        f"tooltip={quoted(line_hover(picture, line))}",
    ]
    source, target, style = picture.keys[line.source], picture.keys[line.target], ", ".join(attributes)
    if not line.words:
        return f"{source} -> {target} [{style}];"
    # In parts that Graphviz packs, labels of lines are lost; so the words are a box without an outline.
    words = f"w{number} [label={quoted(shortened(line.words, LONGEST_WORD))}, {ON_A_LINE}, id=w{number}];"
    before = style.replace("dir=both", "dir=back") if two_way else f"{style}, dir=none"
    return f"{words} {source} -> w{number} [{before}]; w{number} -> {target} [{style.replace(', dir=both', '')}];"


def _caption(picture: Picture) -> str:
    """Title and notes as an HTML-like label."""
    lines = [f"<B>{line}</B>" for line in _wrapped(picture.title)]
    lines += [line for note in picture.notes for line in _wrapped(note)]
    rows = "".join(f'<TR><TD ALIGN="LEFT">{line}</TD></TR>' for line in lines)
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="2" CELLPADDING="2">{rows}</TABLE>'


def _wrapped(text: str) -> list[str]:
    lines = [""]
    for word in printable(text).split(" "):
        if lines[-1] and len(lines[-1]) + 1 + len(word) > LONGEST_NOTE:
            lines.append("")
        lines[-1] += f" {shortened(word, LONGEST_NOTE)}" if lines[-1] else shortened(word, LONGEST_NOTE)
    return [escape(line) for line in lines]


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


def swatches(entries: Sequence[LegendEntry], direction: str) -> Iterator[str]:
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


def _sample(entry: LegendEntry, number: int) -> dict[str, str]:
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


def _rows(samples: Sequence[tuple[str, str]], limit: int) -> Iterable[Sequence[tuple[str, str]]]:
    return (samples[at : at + limit] for at in range(0, len(samples), limit))


def _joints(row: Sequence[tuple[str, str]]) -> Iterable[tuple[str, str]]:
    """Where each sample of a row ends, and where the next one starts."""
    return ((one[1], other[0]) for one, other in pairwise(row))
