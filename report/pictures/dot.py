"""Picture -> DOT, the language of Graphviz, with a legend; the same for the same picture, to the byte.

In: a ``Picture``. Out: text. Names stand in quoted strings, or below in an HTML-like label, and are escaped for each.
"""

from __future__ import annotations

from html import escape
from textwrap import wrap
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.pictures.looks import INK, LINE_LOOKS, PALE, SHAPES, TEXT, Entry, box_look, legend
from rosprivacy.report.pictures.wording import broken

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.pictures.picture import Box, Line, Picture

FONT = "Helvetica,Arial,sans-serif"
SIZE = 11  # of letters, in points
LONGEST_NOTE = 110
FOLDED_NAMES = 3
COLUMNS = 3
WIDEST_WORDS = 34  # letters of a line on a box


def dot(picture: Picture, *, direction: str = "LR", legend: bool = True) -> str:
    """Return a picture as DOT.

    Parameters
    ----------
    direction
        ``LR`` or ``TB``: where the data goes on the paper.
    legend
        Whether title, notes and legend stand below it.
    """
    caption = f"label=<{_caption(picture)}>, " if legend else ""
    text = f'fontname="{FONT}", fontsize={SIZE}'
    place = f"labelloc=b, labeljust=l, rankdir={direction}, nodesep=0.22, ranksep=0.4, pad=0.1"
    rows = [
        "digraph rosprivacy {",
        f'  graph [{caption}{place}, {text}, fontcolor="{INK}", charset="UTF-8", bgcolor=transparent];',
        f'  node [{text}, fontcolor="{TEXT}", color="{INK}", margin="0.1,0.05", height=0.35];',
        f'  edge [color="{INK}", arrowsize=0.7];',
    ]
    groups = sorted({box.group for box in picture.boxes if box.group})
    for number, group in enumerate(groups):
        rows.append(f"  subgraph cluster_{number} {{")
        name = quoted(shortened(group, 60))
        rows.append(f'    graph [label={name}, labeljust=l, labelloc=t, color="{INK}", style=dotted, id=g{number}];')
        rows += [f"    {_box(picture, box)}" for box in picture.boxes if box.group == group]
        rows.append("  }")
    rows += [f"  {_box(picture, box)}" for box in picture.boxes if not box.group]
    rows += [f"  {_line(picture, line, number, both=both)}" for number, (line, both) in enumerate(paired(picture))]
    return "\n".join([*rows, "}", ""])


def quoted(text: str) -> str:
    r"""Return a quoted string of DOT that shows text as it is: no escape sequence, no entity.

    >>> quoted('a"b' + chr(92) + "N&amp;")
    '"a\\"b\\\\N&amp;amp;"'
    """
    return '"' + printable(text).replace("\\", "\\\\").replace('"', '\\"').replace("&", "&amp;") + '"'


def _lines(texts: list[str]) -> str:
    """Several lines as one quoted string; none is empty: for such a line Graphviz 14 frees what it has not set."""
    return '"' + "\\n".join(quoted(text)[1:-1] or " " for text in texts) + '"'


def label_lines(picture: Picture, box: Box) -> list[str]:
    """Return what stands on a box: its name or names, the robot where there are several, and its words."""
    robots = len({box.robot for box in picture.boxes if box.robot}) > 1
    lines = (
        [shortened(box.robot, 28)] if robots and box.robot and not box.group.startswith(("robot ", box.robot)) else []
    )
    if len(box.names) == 1:
        lines += broken(box.names[0])
    else:
        lines += [shortened(name, 36) for name in box.names[:FOLDED_NAMES]]
        more = len(box.names) - FOLDED_NAMES
        lines += [f"and {more} more"] if more > 0 else []
    return [*lines, *(line for word in box.words for line in wrap(shortened(word, 60), WIDEST_WORDS))]


def hover(picture: Picture, box: Box) -> str:
    """Return what is said of a box where there is room: its full name, kind, role."""
    names = ", ".join(shortened(name, 200) for name in box.names[:20])
    said = [box.kind.replace("-", " "), *([f"robot {shortened(box.robot, 60)}"] if box.robot else [])]
    if picture.view == "privacy":
        said.append(box_look(picture.view, box.look).words.partition(":")[0])
    said += box.words
    if box.open and box.look != "open":
        said.append("not reviewed for all")
    return f"{names} ({'; '.join(said)})"


def line_hover(line: Line) -> str:
    """Return what is said of a line: its ends, the grants behind it, what goes along it."""
    arrow = f"{shortened(line.source[2], 100)} to {shortened(line.target[2], 100)}"
    said = [LINE_LOOKS[line.look].words, ", ".join(line.roles)]
    if line.carries:
        said.append(("pseudonymised " if line.pseudonymised else "") + ", ".join(line.carries))
    said += [shortened(str(place), 100) for place in line.places[:3]]
    if len(line.places) > 3:  # noqa: PLR2004 - as above
        said.append(f"and {len(line.places) - 3} more lines")
    return f"{arrow} ({'; '.join(text for text in said if text)})"


def paired(picture: Picture) -> Iterator[tuple[Line, bool]]:
    """Each line to be drawn, and whether it also stands for the one that goes back and looks the same."""
    looks = {(line.source, line.target, line.look): line for line in picture.lines}
    drawn = set()
    for line in picture.lines:
        here = (line.source, line.target, line.look)
        there = (line.target, line.source, line.look)
        if here in drawn:
            continue
        back = looks.get(there)
        both = back is not None and back.pseudonymised == line.pseudonymised
        drawn |= {here, there} if both else {here}
        yield line, both


def _box(picture: Picture, box: Box) -> str:
    look, shape = box_look(picture.view, box.look), SHAPES[box.kind]
    name, style = shape.graphviz
    styles = ["filled", *([style] if style else []), *(["dashed"] if box.open or look.style == "dashed" else [])]
    under_the_lid = [""] if look.double and name == "cylinder" else []
    attributes = [
        f"label={_lines([*under_the_lid, *label_lines(picture, box)])}",
        f"shape={name}",
        f'style="{",".join(styles)}"',
        f'fillcolor="{look.colour}"',
        f"penwidth={look.width:g}",
        *(["peripheries=2"] if look.double else []),
        *([f'fontcolor="{INK}"'] if look.colour == PALE else []),
        f"id={picture.keys[box.key]}",
        f"tooltip={quoted(hover(picture, box))}",
    ]
    return f"{picture.keys[box.key]} [{', '.join(attributes)}];"


def _line(picture: Picture, line: Line, number: int, *, both: bool) -> str:
    look = LINE_LOOKS[line.look]
    style = "dashed" if line.pseudonymised else look.style
    attributes = [
        f'color="{look.colour}"',
        *([f"style={style}"] if style != "solid" else []),
        *([f"penwidth={look.width:g}"] if look.width != 1 else []),
        *([f"arrowhead={look.head}"] if look.head != "normal" else []),
        *(["dir=both"] if both else []),
        *([f"arrowtail={look.head}"] if both and look.head != "normal" else []),
        f"id=e{number}",
        f"tooltip={quoted(line_hover(line))}",
    ]
    return f"{picture.keys[line.source]} -> {picture.keys[line.target]} [{', '.join(attributes)}];"


def _caption(picture: Picture) -> str:
    """Title, notes and legend as an HTML-like label."""
    rows = [f'<TR><TD ALIGN="LEFT" COLSPAN="{COLUMNS * 2}"><B>{line}</B></TD></TR>' for line in _wrapped(picture.title)]
    for note in picture.notes:
        rows += [f'<TR><TD ALIGN="LEFT" COLSPAN="{COLUMNS * 2}">{line}</TD></TR>' for line in _wrapped(note)]
    entries = legend(picture)
    for at in range(0, len(entries), COLUMNS):
        cells = [
            f'<TD ALIGN="CENTER">{_sample(entry)}</TD><TD ALIGN="LEFT">{escape(entry.in_words)}</TD>'
            for entry in entries[at : at + COLUMNS]
        ]
        cells += ["<TD></TD><TD></TD>"] * (COLUMNS - len(cells))
        rows.append(f"<TR>{''.join(cells)}</TR>")
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="2" CELLPADDING="2">{"".join(rows)}</TABLE>'


def _wrapped(text: str) -> list[str]:
    lines = [""]
    for word in printable(text).split(" "):
        if lines[-1] and len(lines[-1]) + 1 + len(word) > LONGEST_NOTE:
            lines.append("")
        lines[-1] += f" {shortened(word, LONGEST_NOTE)}" if lines[-1] else shortened(word, LONGEST_NOTE)
    return [escape(line) for line in lines]


def _sample(entry: Entry) -> str:
    """A small box, or a piece of line."""
    look = entry.look
    bare = 'CELLBORDER="0" CELLSPACING="0" CELLPADDING="0"'
    width = max(1, round(look.width))
    if entry.shape is None:
        line = f'BORDER="{width}" SIDES="B" STYLE="{look.style.upper()}" COLOR="{look.colour}"'
        return f'<TABLE {line} {bare}><TR><TD WIDTH="30" HEIGHT="5"></TD></TR></TABLE>'
    round_ = entry.shape.graphviz[0] in ("ellipse", "octagon", "cylinder") or entry.shape.graphviz[1] == "rounded"
    style = ",".join((["ROUNDED"] if round_ else []) + [look.style.upper()])
    outline = f'STYLE="{style}" COLOR="{INK}"'
    filled = f'BGCOLOR="{look.colour}"><TR><TD WIDTH="22" HEIGHT="10"></TD></TR></TABLE>'
    table = f'<TABLE BORDER="{width}" {bare} {outline} {filled}'
    if look.double:
        inner = f'<TABLE BORDER="{width}" {bare} STYLE="{style}" COLOR="{INK}" {filled}'
        around = 'BORDER="1" CELLBORDER="0" CELLSPACING="2" CELLPADDING="0"'
        return f"<TABLE {around} {outline}><TR><TD>{inner}</TD></TR></TABLE>"
    return table
