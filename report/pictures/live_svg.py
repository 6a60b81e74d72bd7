"""A scene -> DOT without any name of the system -> what Graphviz draws of it -> SVG for a page.

In: a ``Scene``. Out: text for Graphviz, which lays it out and draws the shapes: ids of our own, and letters that take
as much room as the names do. Names, words and roles come to it afterwards, so nothing that a file says can get into
Graphviz, and a new label that changes no text does not move a box. Then one ``<svg>`` element as text. It has no style
and no script of its own: classes say what is what, and ``legend.style_sheet`` how that looks. Only known shapes are
taken over.

What a page can rely on:

- a box is ``<a class="box kind-… look-…" href="…" data-element="…" aria-label="…">`` where the page says what leads to
  an element, else a ``<g>``; a folded box leads to the first of its elements, and all names stand in its title;
- ``open`` is a class of what is not reviewed, ``focus`` of the box in hand, which also has ``aria-current="true"``;
- a line is ``<g class="line look-…">``, with the type of a relationship on it that is no flow; ``hidden`` is a class of
  what only pseudonymised data goes along, ``step`` of a numbered step to the box in hand;
- both have a ``<title>``: full names, policy lines, kinds of data;
- ``width`` and ``height`` are in pixels in which text can be read: scroll a picture that is too large, never shrink it.
"""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict, deque
from dataclasses import replace
from math import ceil
from textwrap import wrap
from typing import TYPE_CHECKING, NamedTuple

from lxml import etree

from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.pictures.dot import hover, label_lines, line_hover, paired
from rosprivacy.report.pictures.graphviz import NAMESPACE, alt_text
from rosprivacy.report.pictures.looks import LEAK, LINE_LOOKS, OTHER, SHAPES, SHORTEST, SOURCE, box_look
from rosprivacy.report.pictures.picture import GROUP as SEVERAL
from rosprivacy.report.pictures.picture import RECORD

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.report.pictures.picture import Box, Key, Picture, PictureLine
    from rosprivacy.report.pictures.scenes import Scene


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
        words.insert(0, picture.say(f"picture.look.{box.kind}"))
    if box.key == scene.focus:
        words.append(picture.say("picture.explore.decide" if box.open else "picture.explore.chosen"))
    return [*(Text(name, is_name=True) for name in names), *(Text(word, is_name=False) for word in words)]


def unnamed_dot(scene: Scene) -> str:
    """Return a scene as DOT: sources on one side, leaks on the other, paths straight.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.report.pictures.scenes import Scenes
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
        *(_dot_box(scene, box) for box in picture.boxes),
        *_sides(picture),
        *_dot_lines(scene),
    ]
    return "\n".join([*rows, "}", ""])


def _dot_box(scene: Scene, box: Box) -> str:
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


def _dot_lines(scene: Scene) -> Iterator[str]:
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


def caption(line: PictureLine) -> Text:
    """Return what stands on a line: the number of a step, or the type of a relationship that is no flow."""
    return Text("nn", is_name=True) if is_step(line) else Text(shortened(line.words, WIDEST_WORDS), is_name=False)


def is_step(line: PictureLine) -> bool:
    """Whether it is a numbered step to the element in hand."""
    return bool(line.words) and line.look != OTHER


def _on_path(line: PictureLine) -> bool:
    return line.look == SHORTEST or is_step(line)


def _weight(scene: Scene, line: PictureLine) -> int:
    if _on_path(line):
        return STRAIGHT
    return QUIET if scene.focus in (line.source, line.target) else 1


SVG_SHAPES = {f"{{{NAMESPACE}}}{name}" for name in ("path", "polygon", "polyline", "ellipse")}
PLACES = ("d", "points", "cx", "cy", "rx", "ry")
NAMES = ("a", "g", "text", "title", "desc", "circle")
LINK, GROUP, TEXT, TITLE, DESCRIPTION, CIRCLE = (f"{{{NAMESPACE}}}{name}" for name in NAMES)
_SIDES = re.compile(rb'<svg width="([\d.]+)pt" height="([\d.]+)pt"')
WIDTH = 700  # of what says that there is no picture, in pixels
BADGE = 10  # radius of a number
BASELINE = 0.34  # of the size of letters, from the middle of a line of text down


class Links(NamedTuple):
    """How a page names elements, and what leads to them; each a function of the identity of an element (rule S1).

    An empty address is one that leads nowhere.
    """

    name: Callable[[Key], str]
    address: Callable[[Key], str]


def live_svg(data: bytes, scene: Scene, links: Links | None = None) -> str:
    """Return the element for a page.

    Parameters
    ----------
    links
        None for a picture of which no box leads anywhere.
    """
    parser = etree.XMLParser(resolve_entities=False, load_dtd=False, no_network=True, remove_comments=True)
    drawn = etree.fromstring(data, parser)
    picture = scene.picture
    width, height = (str(drawn.get(side, "")).removesuffix("pt") for side in ("width", "height"))
    root = _root(scene, width, height, str(drawn.get("viewBox", "")))
    groups = {str(group.get("id")): group for group in drawn.iter(GROUP)}
    sheet = etree.SubElement(root, GROUP, transform=str(groups["graph0"].get("transform", "")))
    for number, (line, _) in enumerate(paired(picture)):
        _line(sheet, groups[f"e{number}"], scene, line)
    for box in _in_reading_order(scene, groups):
        _box(sheet, groups[picture.keys[box.key]], scene, box, links)
    for number, (line, _) in enumerate(paired(picture)):
        if is_step(line):
            _badge(sheet, groups[f"e{number}"], line.words)
    etree.cleanup_namespaces(root)
    return etree.tostring(root, encoding="unicode")


def without_places(scene: Scene, why: str) -> str:
    """Return what stands in place of a picture that could not be laid out: its title, and why."""
    lines = [scene.picture.title, *([why] if why else [])]
    height = 2 * SIZE * (len(lines) + 1)
    root = _root(scene, str(WIDTH), str(height), f"0 0 {WIDTH} {height}")
    for number, line in enumerate(lines, 1):
        text = _label_texts(root, TEXT, line)
        text.set("x", str(WIDTH // 2))
        text.set("y", str(2 * SIZE * number))
    return etree.tostring(root, encoding="unicode")


def fits(data: bytes, room: tuple[float, float]) -> float:
    """Return how large what Graphviz drew can be in some room; no larger than it is."""
    found = _SIDES.search(data)
    assert found
    return min(1.0, *(side / float(length) for side, length in zip(room, found.groups(), strict=True)))


def _root(scene: Scene, width: str, height: str, view: str) -> etree._Element:
    root = etree.Element(f"{{{NAMESPACE}}}svg", nsmap={None: NAMESPACE})
    said = {
        "class": "picture",
        "width": width,
        "height": height,
        "viewBox": view,
        "role": "group",
        "aria-labelledby": "picture-title",
        "aria-describedby": "picture-description",
    }
    for name, value in said.items():
        root.set(name, value)
    _label_texts(root, TITLE, scene.picture.title).set("id", "picture-title")
    _label_texts(root, DESCRIPTION, alt_text(scene.picture)).set("id", "picture-description")
    return root


def _in_reading_order(scene: Scene, groups: Mapping[str, etree._Element]) -> list[Box]:
    """From the sources on, as they stand: the order in which keys go through them."""
    steps = levels(scene.picture)

    def place(box: Box) -> tuple[int, float, float]:
        text = groups[scene.picture.keys[box.key]].find(TEXT)
        assert text is not None
        return steps.get(box.key, len(steps)), float(text.get("y", "0")), float(text.get("x", "0"))

    return sorted(scene.picture.boxes, key=place)


def _box(sheet: etree._Element, drawn: etree._Element, scene: Scene, box: Box, links: Links | None) -> None:
    classes = ["box", f"kind-{box.kind}", f"look-{box.look}"]
    classes += ["open"] if box.open else []
    classes += ["focus"] if box.key == scene.focus else []
    tip = printable(hover(scene.picture, box))
    address = links.address(box.key) if links and box.kind not in (SEVERAL, RECORD) else ""
    group = etree.SubElement(sheet, LINK if address else GROUP)
    group.set("class", " ".join(classes))
    if links and address:
        group.set("href", printable(address))
        group.set("data-element", printable(links.name(box.key)))
        group.set("aria-label", tip)
    if box.key == scene.focus:
        group.set("aria-current", "true")
    _label_texts(group, TITLE, tip)
    group.extend(_shapes(drawn))
    places, said = list(drawn.findall(TEXT)), texts(scene, box)
    for place, text in zip(places[len(places) - len(said) :], said, strict=True):
        written = _label_texts(group, TEXT, text.text)
        written.set("class", "name" if text.is_name else "word")
        written.set("x", str(place.get("x")))
        written.set("y", str(place.get("y")))


def _line(sheet: etree._Element, drawn: etree._Element, scene: Scene, line: PictureLine) -> None:
    classes = ["line", f"look-{line.look}", *(["hidden"] if line.pseudonymised else [])]
    group, step = etree.SubElement(sheet, GROUP), is_step(line)
    group.set("class", " ".join([*classes, *(["step"] if step else [])]))
    _label_texts(group, TITLE, line_hover(scene.picture, replace(line, words="") if step else line))
    group.extend(_shapes(drawn))
    place = drawn.find(TEXT)
    if line.words and not step and place is not None:
        written = _label_texts(group, TEXT, caption(line).text)
        written.set("class", "word")
        written.set("x", str(place.get("x")))
        written.set("y", str(place.get("y")))


def _shapes(drawn: etree._Element) -> Iterator[etree._Element]:
    """The shapes of a group, with nothing but their places; what was not filled is an outline."""
    for shape in drawn:
        if shape.tag in SVG_SHAPES:
            one = etree.Element(shape.tag)
            one.set("class", "outline" if shape.get("fill") == "none" else "area")
            for name in PLACES:
                if value := shape.get(name):
                    one.set(name, value)
            yield one


def _badge(sheet: etree._Element, drawn: etree._Element, number: str) -> None:
    """The number of a step, on its line."""
    place = drawn.find(TEXT)
    if place is None:
        return
    x, y = float(place.get("x", "0")), float(place.get("y", "0")) - SIZE * BASELINE
    group = etree.SubElement(sheet, GROUP)
    group.set("class", "number")
    group.set("aria-hidden", "true")  # the list of steps says it
    etree.SubElement(group, CIRCLE, cx=f"{x:g}", cy=f"{y:.2f}", r=str(BADGE))
    _label_texts(group, TEXT, number).set("x", f"{x:g}")
    group[-1].set("y", f"{y + SIZE * BASELINE:.2f}")


def _label_texts(parent: etree._Element, tag: str, text: str) -> etree._Element:
    element = etree.SubElement(parent, tag)
    element.text = printable(text)
    return element
