"""Picture -> a Mermaid flowchart, for READMEs; GraphML, for programs that draw or count graphs.

In: a ``Picture``. Out: text. In Mermaid, which hosts of code draw where it stands, a label holds only letters, digits
and a few signs as they are; all else is written as a number, so that no name can end a label, begin a tag, or be read
as a word of the language. In GraphML (Gephi, yEd, Cytoscape, networkx) every fact of the picture is an attribute,
nothing is shortened; networkx writes it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.pictures.dot import label_lines, paired
from rosprivacy.report.pictures.looks import INK, KIND_LOOKS, LINE_LOOKS, ROLE_LOOKS, SHAPES, TEXT, box_look, legend
from rosprivacy.report.pictures.picture import PRIVACY

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.report.pictures.looks import Look
    from rosprivacy.report.pictures.picture import Box, Picture, PictureLine

MOST_LINES, MOST_CHARACTERS = 500, 50_000  # what Mermaid draws unless its host says otherwise
SAFE = frozenset("/_-.,()* ")


def mermaid(picture: Picture, *, direction: str = "LR") -> str:
    """Return a picture as a flowchart, with alt text and legend."""
    rows = [
        f"flowchart {direction}",
        f"  accTitle: {_plain(picture.title)}",
        f"  accDescr: {_plain('. '.join([*picture.notes, *picture.ways]))}",
    ]
    groups = sorted({box.group for box in picture.boxes if box.group})
    for number, group in enumerate(groups):
        rows += [f'  subgraph g{number}["{label(shortened(group, 60))}"]', f"    direction {direction}"]
        rows += [f"    {_box(picture, box)}" for box in picture.boxes if box.group == group]
        rows.append("  end")
    rows += [f"  {_box(picture, box)}" for box in picture.boxes if not box.group]
    lines = list(paired(picture))
    rows += [f"  {picture.keys[a.source]} {_arrow(a, two_way=both)} {picture.keys[a.target]}" for a, both in lines]
    rows += [f"  linkStyle {n} {_stroke(a)}" for n, (a, _) in enumerate(lines)]
    rows += [f"  {row}" for row in _legend(picture, len(lines))]
    rows += [f"  {row}" for row in _classes(picture)]
    return "\n".join([*rows, ""])


def too_large(picture: Picture, text: str) -> bool:
    """Return whether Mermaid would refuse to draw it, as it is set by default."""
    return len(picture.lines) > MOST_LINES or len(text) > MOST_CHARACTERS


def label(text: str) -> str:
    """Return text for a quoted label.

    >>> label('<b>"#')
    '#60;b#62;#34;#35;'
    """
    return "".join(c if c in SAFE or (c.isascii() and c.isalnum()) else f"#{ord(c)};" for c in printable(text))


def _plain(text: str) -> str:
    """Text for an alt text, which ends with its line and knows no escapes."""
    return "".join(c if c in SAFE or c == ":" or c.isalnum() else "_" for c in shortened(text, 1000))


def _box(picture: Picture, box: Box) -> str:
    before, after = SHAPES[box.kind].mermaid
    lines = "<br/>".join(label(line) for line in label_lines(picture, box))
    return f'{picture.keys[box.key]}{before}"{lines}"{after}:::{_class(box.look)}'


def _class(look: str) -> str:
    """The name of a class; some words mean something to Mermaid, so all have a capital letter."""
    return "Look" + "".join(part.capitalize() for part in look.split("-"))


def _arrow(line: PictureLine, *, two_way: bool) -> str:
    look = LINE_LOOKS[line.look]
    dashed = line.pseudonymised or look.style != "solid"
    body = "-.-" if dashed else "==" if look.width > 1 else "--"
    head = "x" if look.head == "tee" else ">"
    tail = ("x" if head == "x" else "<") if two_way else ""
    return f"{tail}{body}{head}"


def _stroke(line: PictureLine) -> str:
    look = LINE_LOOKS[line.look]
    colour = "" if look.colour == INK else f"stroke:{look.colour},"  # the theme's own: it may be a dark one
    return f"{colour}stroke-width:{look.width:g}px"


def _legend(picture: Picture, drawn: int) -> Iterator[str]:
    entries = legend(picture)
    if not entries:
        return
    yield f'subgraph legend["{label(picture.say("picture.legend"))}"]'
    yield "  direction LR"
    boxes = [entry for entry in entries if entry.shape is not None]
    looks = ROLE_LOOKS if picture.view == PRIVACY else KIND_LOOKS
    names = {look.words: name for name, look in looks.items()}
    for number, entry in enumerate(boxes):
        assert entry.shape is not None
        before, after = entry.shape.mermaid
        known = names.get(entry.look.words)
        style = f":::{_class(known)}" if known else ""
        yield f'  l{number}{before}"{label(entry.words)}"{after}{style}'
    samples = [
        next(one for one in picture.lines if one.look == look) for look in sorted({a.look for a in picture.lines})
    ]
    rows = [(replace(sample, pseudonymised=False), picture.say(f"picture.look.{sample.look}")) for sample in samples]
    if any(line.pseudonymised for line in picture.lines):
        rows.append((replace(samples[0], pseudonymised=True), picture.say("picture.dashed")))
    for number, (sample, words) in enumerate(rows):
        yield f'  s{number}((" ")) {_arrow(sample, two_way=False)} t{number}["{label(words)}"]'
    yield "end"
    for number, (sample, _) in enumerate(rows):
        yield f"linkStyle {drawn + number} {_stroke(sample)}"
    for number, entry in enumerate(boxes):
        if entry.look.style == "dashed":
            yield f"class l{number} Unreviewed"


def _classes(picture: Picture) -> Iterator[str]:
    looks = ROLE_LOOKS if picture.view == PRIVACY else KIND_LOOKS
    for name in sorted({box.look for box in picture.boxes}):
        yield f"classDef {_class(name)} {_style(looks[name])}"
    unreviewed = [picture.keys[box.key] for box in picture.boxes if box.open]
    if unreviewed:
        yield "classDef Unreviewed stroke-dasharray:6 4"
        yield f"class {','.join(unreviewed)} Unreviewed"


def _style(look: Look) -> str:
    width = 3 if look.double else look.width
    return f"fill:{look.colour},color:{TEXT},stroke:{INK},stroke-width:{width:g}px"


def graphml(picture: Picture) -> str:
    """Return a picture as GraphML; lists are one name a line."""
    import networkx as nx  # noqa: PLC0415 - heavy

    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph(
        title=printable(picture.title), notes=_list(picture.notes), ways=_list(picture.ways)
    )
    for box in picture.boxes:
        graph.add_node(
            picture.keys[box.key],
            label=printable(box.names[0]),
            names=_list(box.names),
            kind=box.kind,
            robot=printable(box.robot),
            role=box.look,
            words=_list(box.words),
            reviewed=not box.open,
            wildcard=box.pattern,
            group=printable(box.group),
            fill=box_look(picture.view, box.look).colour,
        )
    for number, line in enumerate(picture.lines):
        graph.add_edge(
            picture.keys[line.source],
            picture.keys[line.target],
            key=f"e{number}",
            look=line.look,
            roles=_list(line.roles),
            carries=_list(line.carries),
            pseudonymised=line.pseudonymised,
            policy=_list(str(place) for place in line.places),
            steps=line.length,
            stroke=LINE_LOOKS[line.look].colour,
        )
    rows = ['<?xml version="1.0" encoding="UTF-8"?>', *nx.generate_graphml(graph, encoding="utf-8"), ""]
    return "\n".join(row for number, row in enumerate(rows) if number == 0 or not row.startswith("<?xml"))


def _list(texts: Iterable[str]) -> str:
    return "\n".join(printable(text) for text in texts)
