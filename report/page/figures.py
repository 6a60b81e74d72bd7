"""The pictures of a report: one of each path to assess, as many as a file that can be mailed holds, and their legend.

In: a ``Document`` and the entries of the report. Out: ``Figures``, which know what is missing, and why: each picture is
an ``<svg>`` element with nothing external, fit for dark mode; the legend is the page's, once for all. In a redacted
report pictures have no name that the copy of the document does not have (``redact.py``).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

from lxml import etree
from markupsafe import Markup

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.analysis.text import shortened
from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.document.contents import required
from rosprivacy.report.naming import key
from rosprivacy.report.pictures.dot import FONT, SIZE, dot
from rosprivacy.report.pictures.graphviz import (
    NAMESPACE,
    ORDERED,
    TITLE,
    Graphviz,
    Job,
    TooLongError,
    alt_text,
    available,
    group_of,
    unlink,
    way_of,
)
from rosprivacy.report.pictures.looks import (
    BEYOND,
    CLEANED,
    INK,
    LINE_LOOKS,
    OPEN,
    PALE,
    ROLE_LOOKS,
    SHORTEST,
    WAY,
    Look,
)
from rosprivacy.report.pictures.narrow import folded
from rosprivacy.report.pictures.phrases import Phrases
from rosprivacy.report.pictures.views import PER_BOX, FindingViews, bounded, drawable, is_cut, marking, overview

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
    from typing import Any

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.page.outline import Outline
    from rosprivacy.report.pictures.picture import Box, Key, Picture

ROOM = 5 * 2**20  # bytes of all pictures together
OVERVIEW = 24  # elements of the first picture
HIDDEN = "hidden"  # a look: of what only pseudonymised data goes along


@dataclass(frozen=True, slots=True)
class Figures:
    """The pictures.

    Attributes
    ----------
    of
        Id of a finding -> its picture.
    installed
        Whether what draws them is.
    overview
        The shortest paths of the first things to decide, in one picture; ``drawn`` says how many things these are.
    beyond
        As ``of``, of what only the enforced view has.
    """

    of: Mapping[str, Inline] = field(default_factory=dict)
    installed: bool = True
    overview: Inline | None = None
    drawn: int = 0
    beyond: Mapping[str, Inline] = field(default_factory=dict)

    @property
    def looks(self) -> frozenset[str]:
        """What a legend has to explain of all of them."""
        overview = [self.overview] if self.overview else []
        return frozenset(look for one in (*self.of.values(), *self.beyond.values(), *overview) for look in one.looks)


def figures(
    document: Document, report: Outline, aliases: Mapping[Key, tuple[str, str]] | None = None, *, room: int = ROOM
) -> Figures:
    """Draw the entries of a report, in their order, until there is no more room.

    Parameters
    ----------
    aliases
        Element -> the robot and name that are shown in place of its own; None to show all names. What has no alias
        then has no name.
    room
        Bytes of all pictures together.

    Complexity: linear in the pictures; ``room`` bounds their number.
    """
    if not available():
        return Figures(installed=False)
    analysis = document.analysis
    findings = {finding.id: finding for finding in analysis.findings}
    entries = [entry for entry in report.entries if entry.detailed and entry.id in findings]
    words = report.words
    titles = {kind.name: kind.title for kind in report.kinds}
    say = Phrases.of_report(words, titles)
    labels = {entry.id: words("entry.picture", way=entry.brief) for entry in entries}
    wishes = Wishes(say=say, labels=labels)
    if aliases is not None:
        wishes = replace(wishes, change=lambda picture: renamed(picture, aliases))
    with Graphviz() as graphviz:  # one process for all of them
        pictures = pictures_of(
            graphviz, required(document.paths_to_leaks), (findings[entry.id] for entry in entries), wishes
        )
        found, room = _fitting([entry.id for entry in entries], pictures, room)
        picture, rows = _overview(graphviz, analysis, report, wishes)
        beyond = _beyond(graphviz, document, report, wishes, room)
    return Figures(found, overview=picture, drawn=rows, beyond=beyond)


def _fitting(ids: Iterable[str], pictures: Iterable[Inline | None], room: int) -> tuple[dict[str, Inline], int]:
    """The pictures of findings, in their order, for which there is room, and how much is left; less than 0 for none."""
    found: dict[str, Inline] = {}
    for finding, picture in zip(ids, pictures, strict=True):
        room -= len(picture.svg.encode()) if picture else 0
        if room < 0:
            break
        if picture:
            found[finding] = picture
    return found, room


def _beyond(graphviz: Graphviz, document: Document, report: Outline, wishes: Wishes, room: int) -> dict[str, Inline]:
    """What only the enforced view has, with the steps marked that no profile allows, while there is room."""
    if not document.enforced or not report.beyond or room < 0:
        return {}
    mark, renamed_as = marking(document.analysis), wishes.change
    labels = {entry.id: report.words("entry.picture", way=entry.brief) for entry in report.beyond}
    marked = replace(wishes, change=lambda picture: renamed_as(mark(picture)), labels=labels)
    added = [one.finding for one in document.enforced.added]
    pictures = pictures_of(graphviz, required(document.enforced.paths_to_leaks), added, marked)
    return _fitting([finding.id for finding in added], pictures, room)[0]


def _overview(graphviz: Graphviz, analysis: Analysis, report: Outline, wishes: Wishes) -> tuple[Inline | None, int]:
    """One picture of the first things to decide, and how many they are."""
    findings = {finding.id: finding for finding in analysis.findings}
    rows = [
        [findings[entry.id] for entry in row.entries if entry.id in findings] for row in report.opening.rows[:OVERVIEW]
    ]
    rows = rows[: next((n for n, row in enumerate(rows) if not row), len(rows))]
    count = drawable([row[0] for row in rows], OVERVIEW)
    shown = [finding for row in rows[:count] for finding in row]
    if not shown:
        return None, 0
    label = plain(report.words("opening.picture"))
    return picture_of_all(graphviz, analysis, shown, replace(wishes, labels={shown[0].id: label})), count


def page_legend(words: Words, looks: Collection[str]) -> list[tuple[Look, bool, str]]:
    """Return what the pictures of a page mean: a look, whether it is that of a box or of a line, and words.

    Parameters
    ----------
    looks
        What is in them, see ``looks_of``; the legend has no more.
    """
    boxes = [(name, look, True) for name, look in ROLE_LOOKS.items()]
    lines = [(name, LINE_LOOKS[name], False) for name in (SHORTEST, WAY, CLEANED, BEYOND)]
    every = [*boxes, *lines, (HIDDEN, Look("", INK, style="dashed"), False)]
    return [(look, box, words(f"phrase.look.{name}")) for name, look, box in every if name in looks]


def looks_of(picture: Picture) -> frozenset[str]:
    """Return the looks of the boxes and lines of a picture, by name."""
    looks = {box.look for box in picture.boxes} | {line.look for line in picture.lines}
    looks |= {OPEN} if any(box.open for box in picture.boxes) else set()
    return frozenset(looks | ({HIDDEN} if any(line.pseudonymised for line in picture.lines) else set()))


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


class Inline(NamedTuple):
    """A picture for a page.

    Attributes
    ----------
    all_paths
        Whether every path of the finding is in it, not the shorter ones only.
    looks
        What a legend has to explain of it.
    """

    svg: Markup
    all_paths: bool
    looks: frozenset[str] = frozenset()


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
        return Inline(page_svg(data, changed, label), all_paths and wanted is picture, looks_of(changed))
    return None


def _best(graphviz: Graphviz, picture: Picture) -> bytes:
    """To the right, as people read, or downwards where that would be too wide and downwards is less so."""
    right = graphviz.draw(Job(dot(picture, legend=False, title=False)), SECONDS)
    if width(right) <= WIDEST:
        return right
    down = graphviz.draw(Job(dot(picture, legend=False, title=False, direction="TB")), SECONDS)
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


def aliases_of(document: Any, changed: Any) -> dict[Key, tuple[str, str]]:
    """Return how elements of a document are called in a copy of it whose names were replaced."""
    parts: Iterable[tuple[Any, Any]]
    if isinstance(document, list):
        parts = zip(document, changed, strict=True)
    elif isinstance(document, dict):
        if {"robot", "kind", "name"} <= set(document):
            return {key(document)[:3]: (changed["robot"], changed["name"])}
        parts = ((document[name], changed[name]) for name in document if name in changed)
    else:
        return {}
    found: dict[Key, tuple[str, str]] = {}
    for part in parts:
        found |= aliases_of(*part)
    return found


def renamed(picture: Picture, aliases: Mapping[Key, tuple[str, str]]) -> Picture:
    """Return a picture with other names; what has none is known by its kind and number in the picture only."""
    keys = {
        box.key: (alias[0], box.kind, alias[1]) if (alias := aliases.get(box.key)) else ("", box.kind, f"… {number}")
        for number, box in enumerate(picture.boxes, 1)
    }

    def names(box: Box) -> tuple[str, ...]:
        others = [aliases.get((box.robot, box.kind, name), ("", "…"))[1] for name in box.names[1:]]
        return (keys[box.key][2], *others)

    boxes = tuple(replace(box, key=keys[box.key], names=names(box), group="") for box in picture.boxes)
    lines = tuple(replace(line, source=keys[line.source], target=keys[line.target]) for line in picture.lines)
    core = frozenset(keys[one] for one in picture.core)
    return replace(picture, title="", notes=(), ways=(), boxes=boxes, lines=lines, core=core)
