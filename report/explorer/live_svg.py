"""What Graphviz draws of a scene -> SVG for a page: names, words and roles come to it; boxes can be reached by keys.

In: SVG of ``unnamed_dot``, and its ``Scene``. Out: one ``<svg>`` element as text. It has no style and no script of its
own: classes say what is what, and ``style_sheet.py`` how that looks. Only known shapes are taken over.

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
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from lxml import etree

from rosprivacy.analysis.text import printable
from rosprivacy.report.explorer.unnamed_dot import SIZE, caption, is_step, levels, texts
from rosprivacy.report.pictures.dot import hover, line_hover, paired
from rosprivacy.report.pictures.picture import GROUP as SEVERAL
from rosprivacy.report.pictures.picture import RECORD
from rosprivacy.report.pictures.svg import NAMESPACE, alt_text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.report.explorer.scenes import Scene
    from rosprivacy.report.pictures.picture import Box, Key, Line

SHAPES = {f"{{{NAMESPACE}}}{name}" for name in ("path", "polygon", "polyline", "ellipse")}
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
        text = _said(root, TEXT, line)
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
    _said(root, TITLE, scene.picture.title).set("id", "picture-title")
    _said(root, DESCRIPTION, alt_text(scene.picture)).set("id", "picture-description")
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
    _said(group, TITLE, tip)
    group.extend(_shapes(drawn))
    places, said = list(drawn.findall(TEXT)), texts(scene, box)
    for place, text in zip(places[len(places) - len(said) :], said, strict=True):
        written = _said(group, TEXT, text.text)
        written.set("class", "name" if text.is_name else "word")
        written.set("x", str(place.get("x")))
        written.set("y", str(place.get("y")))


def _line(sheet: etree._Element, drawn: etree._Element, scene: Scene, line: Line) -> None:
    classes = ["line", f"look-{line.look}", *(["hidden"] if line.pseudonymised else [])]
    group, step = etree.SubElement(sheet, GROUP), is_step(line)
    group.set("class", " ".join([*classes, *(["step"] if step else [])]))
    _said(group, TITLE, line_hover(scene.picture, replace(line, words="") if step else line))
    group.extend(_shapes(drawn))
    place = drawn.find(TEXT)
    if line.words and not step and place is not None:
        written = _said(group, TEXT, caption(line).text)
        written.set("class", "word")
        written.set("x", str(place.get("x")))
        written.set("y", str(place.get("y")))


def _shapes(drawn: etree._Element) -> Iterator[etree._Element]:
    """The shapes of a group, with nothing but their places; what was not filled is an outline."""
    for shape in drawn:
        if shape.tag in SHAPES:
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
    _said(group, TEXT, number).set("x", f"{x:g}")
    group[-1].set("y", f"{y + SIZE * BASELINE:.2f}")


def _said(parent: etree._Element, tag: str, text: str) -> etree._Element:
    element = etree.SubElement(parent, tag)
    element.text = printable(text)
    return element
