"""A finding -> a small picture for an HTML page: SVG with nothing external, fit for dark mode.

In: an ``Analysis`` and its findings. Out: one ``<svg>`` element each. The legend is the page's, once for all pictures.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lxml import etree
from markupsafe import Markup

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.analysis.text import shortened
from rosprivacy.report.pictures.dot import FONT, SIZE, dot
from rosprivacy.report.pictures.graphviz import Job, TooLongError
from rosprivacy.report.pictures.layout import ORDERED, way_of
from rosprivacy.report.pictures.looks import INK, PALE
from rosprivacy.report.pictures.narrow import folded
from rosprivacy.report.pictures.overview import overview
from rosprivacy.report.pictures.svg import NAMESPACE, TITLE, alt_text, group_of, unlink
from rosprivacy.report.pictures.views import PER_BOX, FindingViews, bounded, is_cut

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.report.pictures.graphviz import Graphviz
    from rosprivacy.report.pictures.phrases import Phrases
    from rosprivacy.report.pictures.picture import Picture


BOUND = 16  # boxes, unless the shortest path itself is longer
SECONDS = 60.0  # a picture; it takes some hundredths of one
INSTEAD = "try again when the machine has less to do, or take a report without pictures: --format markdown"
WIDEST = 680.0  # points; what is wider is drawn downwards


def _as_it_is(picture: Picture) -> Picture:
    return picture


@dataclass(frozen=True, slots=True)
class Wishes:
    """How pictures are made for a page.

    Attributes
    ----------
    bound
        Elements in a picture; the shortest path is there whatever its length.
    say
        The words on the boxes; English by default.
    labels
        Id of a finding -> what its picture shows, for people who do not see it; else its notes and path, in English.
    change
        What is done to each picture before it is drawn, such as replacing names.
    """

    bound: int = BOUND
    say: Phrases | None = None
    labels: Mapping[str, str] = field(default_factory=dict)
    change: Callable[[Picture], Picture] = _as_it_is


@dataclass(frozen=True, slots=True)
class Inline:
    """A picture for a page.

    Attributes
    ----------
    all_paths
        Whether every path of the finding is in it, not the shorter ones only.
    """

    svg: Markup
    all_paths: bool


def pictures_of(
    graphviz: Graphviz, paths: PathsToLeaks, findings: Iterable[Finding], wishes: Wishes | None = None
) -> Iterator[Inline | None]:
    """Return a picture of each finding, as an ``<svg>`` element for one HTML page; None where none could be drawn.

    Lines and text on the page have the colour of the page's text. What goes beyond ``bound`` boxes is left out. The
    time that a picture takes decides nothing (rule S14): too large is what ``layout.way_of`` finds so.

    Raises
    ------
    DrawingError
        If Graphviz does not end.

    Notes
    -----
    One after the other: linear in the findings.
    """
    wishes = wishes or Wishes()
    views = FindingViews(paths, wishes.say)
    for finding in findings:
        whole = folded(views.of(finding, PER_BOX * wishes.bound))
        picture = bounded(whole, wishes.bound)
        yield _drawn(graphviz, picture, wishes, finding, all_paths=_is_whole(picture, whole))


def picture_of_all(
    graphviz: Graphviz, analysis: Analysis, findings: Sequence[Finding], wishes: Wishes
) -> Inline | None:
    """Return the shortest paths of findings in one picture; None where it could not be drawn.

    Raises
    ------
    DrawingError
        If Graphviz does not end.
    """
    picture = folded(overview(analysis, findings, wishes.say))
    return _drawn(graphviz, picture, wishes, findings[0], all_paths=True)


def _is_whole(picture: Picture, complete: Picture) -> bool:
    cut = any(is_cut(note, complete.words) for note in complete.notes)
    return not cut and (len(picture.boxes), len(picture.lines)) == (len(complete.boxes), len(complete.lines))


def _drawn(graphviz: Graphviz, picture: Picture, wishes: Wishes, finding: Finding, *, all_paths: bool) -> Inline | None:
    for wanted in (picture, bounded(picture, 1)):
        if way_of(wanted).engine != ORDERED:
            continue
        changed = wishes.change(wanted)
        try:
            data = _best(graphviz, changed)
        except TooLongError:
            raise DrawingError(f"graph: a picture takes more than {SECONDS:g} seconds; {INSTEAD}") from None
        except DrawingError:
            continue
        label = wishes.labels.get(finding.id) or alt_text(changed)
        return Inline(page_svg(data, changed, label), all_paths and wanted is picture)
    return None


def _best(graphviz: Graphviz, picture: Picture) -> bytes:
    """To the right, as people read, or downwards where that would be too wide and downwards is less so."""
    right = graphviz.draw(Job(dot(picture, legend=False)), SECONDS)
    if width(right) <= WIDEST:
        return right
    down = graphviz.draw(Job(dot(picture, legend=False, direction="TB")), SECONDS)
    return min(right, down, key=width)


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
