"""What Graphviz writes as SVG -> SVG for people: a title and a description, tips on boxes and lines, nothing external.

In: SVG of a ``Picture``'s DOT. Out: SVG, a file of its own; ``page/page_svg.py`` makes what stands in a page.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from rosprivacy.analysis.text import printable
from rosprivacy.report.pictures.dot import hover, line_hover, paired
from rosprivacy.report.pictures.wording import sentences

if TYPE_CHECKING:
    from rosprivacy.report.pictures.picture import Picture

NAMESPACE = "http://www.w3.org/2000/svg"
TITLE, DESCRIPTION = f"{{{NAMESPACE}}}title", f"{{{NAMESPACE}}}desc"
MOST_WAYS = 20  # that are told in the description


def finished(data: bytes, picture: Picture) -> bytes:
    """Return a file of its own."""
    root = _described(data, picture)
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def alt_text(picture: Picture) -> str:
    """Return what a picture shows, for people who do not see it."""
    ways = [picture.say("picture.alt.way", way=way) for way in picture.ways[:MOST_WAYS]]
    if len(picture.ways) > MOST_WAYS:
        ways.append(picture.say("picture.alt.more", n=len(picture.ways) - MOST_WAYS))
    return printable(sentences([*picture.notes, *ways])) or picture.say("picture.alt.nothing")


def _described(data: bytes, picture: Picture) -> etree._Element:
    parser = etree.XMLParser(resolve_entities=False, load_dtd=False, remove_comments=True, huge_tree=True)
    root = etree.fromstring(data, parser)
    tips = {picture.keys[box.key]: hover(picture, box) for box in picture.boxes}
    tips |= {f"e{number}": line_hover(picture, line) for number, (line, _) in enumerate(paired(picture))}
    for group in list(root.iter(f"{{{NAMESPACE}}}g")):
        unlink(group)
        title = group.find(TITLE)
        if title is None:
            continue
        tip = tips.get(str(group.get("id")))
        if tip is None:  # of the whole, of a cluster, of the legend: what there is to say is drawn
            group.remove(title)
        else:
            title.text = tip
    _head(root, picture)
    etree.cleanup_namespaces(root)
    return root


def group_of(group: etree._Element) -> str:
    """Return what a group of Graphviz's draws: ``graph``, ``cluster``, ``node`` or ``edge``."""
    return str(group.get("class"))


def unlink(group: etree._Element) -> None:
    """Take the links out that Graphviz makes of tooltips: they lead nowhere."""
    for holder in list(group):
        if holder.tag == f"{{{NAMESPACE}}}g" and str(holder.get("id", "")).startswith("a_"):
            shapes = [shape for link in holder for shape in link]
            at = group.index(holder)
            group.remove(holder)
            for number, shape in enumerate(shapes):
                group.insert(at + number, shape)


def _head(root: etree._Element, picture: Picture) -> None:
    title, description = etree.Element(TITLE), etree.Element(DESCRIPTION)
    title.text, description.text = printable(picture.title), alt_text(picture)
    title.set("id", "title")
    description.set("id", "desc")
    root.insert(0, title)
    root.insert(1, description)
    root.set("role", "img")
    root.set("aria-labelledby", "title desc")
