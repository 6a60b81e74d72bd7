"""A scene -> DOT without any name of the system: ids of our own, and letters that take as much room as the names do.

In: a ``Scene``. Out: text for Graphviz, which lays it out and draws the shapes. Names, colours and words come to it
afterwards (``live_svg.py``), so nothing that a file says can get into Graphviz, and a new label that changes no text
does not move a box.
"""

from __future__ import annotations

import unicodedata
from collections import defaultdict, deque
from dataclasses import replace
from math import ceil
from textwrap import wrap
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.text import shortened
from rosprivacy.report.pictures.dot import label_lines, paired
from rosprivacy.report.pictures.looks import LEAK, LINE_LOOKS, OTHER, SHAPES, SHORTEST, SOURCE, box_look

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.explorer.scenes import Scene
    from rosprivacy.report.pictures.picture import Box, Key, Line, Picture

SIZE = 13  # of letters, in pixels of the page
SMALL = 11  # of words below a name: the smallest that stand in a picture
LETTER = "n"  # stands for every other: wider than most are
WIDEST_NAME = 20  # signs of a line: a page is narrower than paper
WIDEST_WORDS, LONGEST_WORDS = 22, 160  # signs of a line, and of all lines of a phrase
TOLD_BY_SHAPE = ("node", "topic", "group", "record")  # other shapes need a word
STRAIGHT, QUIET = 8, 2  # how much a line wants to be short and straight: on a path, to the element in hand


class Text(NamedTuple):
    """A line of text on a box: a name, or a word about it."""

    text: str
    is_name: bool


def texts(scene: Scene, box: Box) -> list[Text]:
    """Return what stands on a box."""
    picture = scene.picture
    names = label_lines(picture, replace(box, words=()), WIDEST_NAME)
    words = [line for word in box.words for line in wrap(shortened(word, LONGEST_WORDS), WIDEST_WORDS)]
    if box.kind not in TOLD_BY_SHAPE:
        words.insert(0, picture.say(f"pic.look.{box.kind}"))
    if box.key == scene.focus:
        words.append(picture.say("pic.explore.decide" if box.open else "pic.explore.chosen"))
    return [*(Text(name, is_name=True) for name in names), *(Text(word, is_name=False) for word in words)]


def unnamed_dot(scene: Scene) -> str:
    """Return a scene as DOT: sources on one side, leaks on the other, paths straight.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.report.explorer.scenes import Scenes
    >>> text = unnamed_dot(Scenes(analyse(*factory())).of())
    >>> "camera" in text, "rank=min" in text
    (False, True)
    """
    picture = scene.picture
    rows = [
        "digraph {",
        "graph [nodesep=0.2, ranksep=0.35, pad=0.15, bgcolor=transparent];",
        f'node [fontname="Helvetica", fontsize={SIZE}, margin="0.07,0.05", height=0.32];',
        "node [style=filled, fillcolor=white];",  # what is not filled then is an outline
        f'edge [fontname="Helvetica", fontsize={SIZE}, arrowsize=0.8];',
        *(_box(scene, box) for box in picture.boxes),
        *_sides(picture),
        *_lines(scene),
    ]
    return "\n".join([*rows, "}", ""])


def _box(scene: Scene, box: Box) -> str:
    look, (shape, style) = box_look(scene.picture.view, box.look), SHAPES[box.kind].graphviz
    lid = [LETTER] if look.double and shape == "cylinder" else []
    label = "\\n".join([*lid, *map(_room, texts(scene, box))])
    key = scene.picture.keys[box.key]
    attributes = [f'label="{label}"', f"id={key}", f"shape={shape}", *(["peripheries=2"] if look.double else [])]
    attributes += [f'style="filled,{style}"'] if style else []
    return f"{key} [{', '.join(attributes)}];"


def _room(text: Text) -> str:
    """As many letters as take the room of a text, without its meaning; two for each wide sign of East Asia."""
    signs = len(text.text) + sum(unicodedata.east_asian_width(sign) in "WF" for sign in text.text)
    return LETTER * max(1, ceil(signs * (1 if text.is_name else SMALL / SIZE)))


def _sides(picture: Picture) -> Iterator[str]:
    """Sources first and leaks last, but for those that lie on a path to another leak."""
    on_path = [line for line in picture.lines if line.look == SHORTEST]
    inside = {line.source for line in on_path} & {line.target for line in on_path}
    for look, rank in ((SOURCE, "min"), (LEAK, "max")):
        keys = [picture.keys[box.key] for box in picture.boxes if box.look == look and box.key not in inside]
        if keys:
            yield f"{{ rank={rank}; {'; '.join(keys)} }}"


def _lines(scene: Scene) -> Iterator[str]:
    """The lines; what is on no path leads away from the sources, or it does not say which box comes first."""
    picture, place = scene.picture, levels(scene.picture)
    last = len(picture.boxes)
    for number, (line, both) in enumerate(paired(picture)):
        look, weight = LINE_LOOKS[line.look], _weight(scene, line)
        onward = place.get(line.source, last) < place.get(line.target, last)
        backward = both and not onward and place.get(line.source, last) > place.get(line.target, last)
        heads = [f"arrowhead={look.head}"] if look.head != "normal" else []
        heads += [f"arrowtail={look.head}"] if both and heads else []
        attributes = [f"id=e{number}", f"penwidth={look.width:g}", *(["dir=both"] if both else []), *heads]
        attributes += [f"weight={weight}"] if weight > 1 else []
        attributes += [f'label="{_room(caption(line))}"'] if line.words else []
        attributes += ["constraint=false"] if not (onward or backward or weight == STRAIGHT) else []
        ends = [picture.keys[line.source], picture.keys[line.target]]
        yield f"{' -> '.join(reversed(ends) if backward else ends)} [{', '.join(attributes)}];"


def levels(picture: Picture) -> dict[Key, int]:
    """Return how many lines data goes from a source to each box that it gets to: along paths first, then anyhow."""
    found = {box.key: 0 for box in picture.boxes if box.look == SOURCE}
    for some in ([line for line in picture.lines if _on_path(line)], picture.lines):
        following: dict[Key, list[Key]] = defaultdict(list)
        for line in some:
            following[line.source].append(line.target)
        waiting = deque(sorted(found, key=found.__getitem__))
        while waiting:
            here = waiting.popleft()
            for there in following[here]:
                if there not in found:
                    found[there] = found[here] + 1
                    waiting.append(there)
    return found


def caption(line: Line) -> Text:
    """Return what stands on a line: the number of a step, or the type of a relationship that is no flow."""
    return Text("nn", is_name=True) if is_step(line) else Text(shortened(line.words, WIDEST_WORDS), is_name=False)


def is_step(line: Line) -> bool:
    """Whether it is a numbered step to the element in hand."""
    return bool(line.words) and line.look != OTHER


def _on_path(line: Line) -> bool:
    return line.look == SHORTEST or is_step(line)


def _weight(scene: Scene, line: Line) -> int:
    if _on_path(line):
        return STRAIGHT
    return QUIET if scene.focus in (line.source, line.target) else 1
