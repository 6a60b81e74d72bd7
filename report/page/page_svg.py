"""What Graphviz draws -> a picture that may stand in an HTML page: shapes and text, in the colours of the page.

In: SVG of a ``Picture``'s DOT. Out: one ``<svg>`` element. Only elements and attributes that are known to draw are
kept, so that nothing in it can run, load, link or style, whatever a name says. It has no ids: pictures of a page cannot
meet.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from lxml import etree
from markupsafe import Markup

from rosprivacy.analysis.text import shortened
from rosprivacy.report.pictures.dot import FONT, SIZE
from rosprivacy.report.pictures.looks import INK, PALE
from rosprivacy.report.pictures.svg import NAMESPACE, TITLE, group_of, unlink

if TYPE_CHECKING:
    from rosprivacy.report.pictures.picture import Picture

DRAWS = {f"{{{NAMESPACE}}}{name}" for name in ("g", "path", "polygon", "polyline", "ellipse", "text", "title")}
SAYS = {
    "cx", "cy", "d", "fill", "font-size", "font-weight", "points", "rx", "ry", "stroke", "stroke-dasharray",
    "stroke-width", "text-anchor", "transform", "x", "y",
}  # fmt: skip
PLACES = ("d", "points", "x", "y", "cx", "cy", "rx", "ry")
INKS = frozenset({"black", INK})
LONGEST_TIP = 300
WIDE = 400  # points; on a small screen such a picture is moved, others are made smaller
_DECIMALS = re.compile(r"-?\d+(\.\d+)?")
_LOADS = re.compile(r"url|[\\<>]", re.IGNORECASE)


def page_svg(data: bytes, picture: Picture, label: str) -> Markup:
    """Return an element for a page, as large as it was drawn.

    Parameters
    ----------
    label
        What it shows, for people who do not see it.
    """
    parser = etree.XMLParser(
        resolve_entities=False, load_dtd=False, no_network=True, remove_comments=True, remove_pis=True, huge_tree=True
    )
    root = etree.fromstring(data, parser)
    size = {name: root.get(name, "") for name in ("viewBox", "width", "height")}
    size |= {"class": "wide"} if width(data) > WIDE else {}
    _tips(root, picture)
    for element in list(root.iter()):
        if element is not root:
            _cleaned(element)
    root.attrib.clear()
    page = {"font-family": FONT, "font-size": str(SIZE), "role": "img", "aria-label": label}
    for name, value in {**size, **page}.items():
        root.set(name, value)
    etree.cleanup_namespaces(root)
    return Markup(etree.tostring(root, encoding="unicode", with_tail=False))  # noqa: S704 - only what is known to draw


def width(data: bytes) -> float:
    """Return how wide a picture is, in points."""
    found = re.search(rb'<svg width="([\d.]+)pt"', data)
    assert found
    return float(found[1])


def _tips(root: etree._Element, picture: Picture) -> None:
    """A tip on each box: its names, longer than on it, and what is said of it. None on lines: there the page does."""
    tips = {box.key: "; ".join((shortened(", ".join(box.names), LONGEST_TIP), *box.words)) for box in picture.boxes}
    names = {picture.keys[key]: tip for key, tip in tips.items()}
    for group in list(root.iter(f"{{{NAMESPACE}}}g")):
        unlink(group)
        title = group.find(TITLE)
        if title is None:
            continue
        if group_of(group) == "node":
            title.text = names[str(group.get("id"))]
        else:
            group.remove(title)


def _cleaned(element: etree._Element) -> None:
    parent = element.getparent()
    if parent is None:  # it went with what it was in
        return
    if element.tag not in DRAWS:
        parent.remove(element)
        return
    for name, value in list(element.attrib.items()):
        if name not in SAYS or _LOADS.search(str(value)):
            del element.attrib[name]
    for name in PLACES:
        if place := element.get(name):
            element.set(
                name, _DECIMALS.sub(lambda number: f"{float(number[0]):.1f}" if number[1] else number[0], place)
            )
    _coloured(element)
    if element.get("font-size") == f"{SIZE:.2f}":
        del element.attrib["font-size"]


def _coloured(element: etree._Element) -> None:
    """Lines and text on the page have the colour of its text; what nobody reviewed shows the page behind it."""
    for name in ("stroke", "fill"):
        if element.get(name) in INKS:
            element.set(name, "currentColor")
        elif element.get(name) == PALE:
            element.set(name, "none")
    if element.tag == f"{{{NAMESPACE}}}text" and element.get("fill") is None:
        element.set("fill", "currentColor")
