"""What Graphviz writes as SVG -> SVG for people: a title and a description, tips on boxes and lines, nothing external.

In: SVG of a ``Picture``'s DOT. Out: SVG. For a page that holds many (``inline.py``) ids get a prefix, and the colour of
lines and of text on the paper is that of the page's own text, so that it is seen in dark mode too.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from lxml import etree

from rosprivacy.report.dot import FONT, SIZE, hover, line_hover, paired
from rosprivacy.report.looks import INK, PALE
from rosprivacy.report.wording import printable, sentences

if TYPE_CHECKING:
    from rosprivacy.report.picture import Picture

_DECIMALS = re.compile(r"-?\d+\.\d+")
NAMESPACE = "http://www.w3.org/2000/svg"
TITLE, DESCRIPTION = f"{{{NAMESPACE}}}title", f"{{{NAMESPACE}}}desc"
INKS = frozenset({"black", INK})
MOST_WAYS = 20  # that are told in the description


def finished(data: bytes, picture: Picture) -> bytes:
    """Return a file of its own."""
    root = _described(data, picture, "")
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def inline(data: bytes, picture: Picture, prefix: str) -> str:
    """Return an element for a page.

    Parameters
    ----------
    prefix
        Of all ids; must differ from those of the other pictures of the page.
    """
    root = _described(data, picture, prefix)
    for element in root.iter():
        for attribute in ("stroke", "fill"):
            if element.get(attribute) in INKS:
                element.set(attribute, "currentColor")
            elif element.get(attribute) == PALE:  # what nobody reviewed has the page's colour, so that its dashes show
                element.set(attribute, "none")
        if element.tag == f"{{{NAMESPACE}}}text" and element.get("fill") is None:
            element.set("fill", "currentColor")
        _lighten(element)
    width = root.attrib.pop("width")
    root.attrib.pop("height", None)
    root.set("style", f"width:100%;max-width:{width};height:auto;font:{SIZE}px {FONT}")
    return etree.tostring(root, encoding="unicode")


def _lighten(element: etree._Element) -> None:
    """Take out what is said once for the whole picture, and what nobody sees: a page may hold hundreds."""
    for attribute in ("d", "points", "x", "y", "cx", "cy", "rx", "ry"):
        value = element.get(attribute)
        if value is not None:
            element.set(attribute, _DECIMALS.sub(lambda number: f"{float(number[0]):.1f}", value))
    if element.tag == f"{{{NAMESPACE}}}text":
        element.attrib.pop("font-family", None)
        if float(element.get("font-size", "0")) == SIZE:
            element.attrib.pop("font-size")
        if "  " not in (element.text or ""):
            element.attrib.pop("{http://www.w3.org/XML/1998/namespace}space", None)


def alt_text(picture: Picture) -> str:
    """Return what a picture shows, for people who do not see it."""
    ways = [f"Way to a leak: {way}" for way in picture.ways[:MOST_WAYS]]
    if len(picture.ways) > MOST_WAYS:
        ways.append(f"And {len(picture.ways) - MOST_WAYS} more ways")
    return printable(sentences([*picture.notes, *ways])) or "Nothing is drawn."


def _described(data: bytes, picture: Picture, prefix: str) -> etree._Element:
    parser = etree.XMLParser(resolve_entities=False, load_dtd=False, remove_comments=True, huge_tree=True)
    root = etree.fromstring(data, parser)
    tips = {picture.keys[box.key]: hover(picture, box) for box in picture.boxes}
    tips |= {f"e{number}": line_hover(line) for number, (line, _) in enumerate(paired(picture))}
    for group in list(root.iter(f"{{{NAMESPACE}}}g")):
        _unlink(group)
        title = group.find(TITLE)
        if title is None:
            continue
        if group.get("class") == "cluster":
            group.remove(title)  # its name is drawn
        elif group.get("class") == "graph":
            group.remove(title)
        else:
            title.text = tips[str(group.get("id"))]
    for element in root.iter():
        if element.get("id"):
            element.set("id", f"{prefix}{element.get('id')}")
    _head(root, picture, prefix)
    etree.cleanup_namespaces(root)
    return root


def _unlink(group: etree._Element) -> None:
    """Take the links out that Graphviz makes of tooltips: they lead nowhere."""
    for holder in list(group):
        if holder.tag == f"{{{NAMESPACE}}}g" and str(holder.get("id", "")).startswith("a_"):
            shapes = [shape for link in holder for shape in link]
            at = group.index(holder)
            group.remove(holder)
            for number, shape in enumerate(shapes):
                group.insert(at + number, shape)


def _head(root: etree._Element, picture: Picture, prefix: str) -> None:
    title, description = etree.Element(TITLE), etree.Element(DESCRIPTION)
    title.text, description.text = printable(picture.title), alt_text(picture)
    title.set("id", f"{prefix}title")
    description.set("id", f"{prefix}desc")
    root.insert(0, title)
    root.insert(1, description)
    root.set("role", "img")
    root.set("aria-labelledby", f"{prefix}title {prefix}desc")
