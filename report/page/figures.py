"""The pictures of a report: one of each path to assess, as many as a file that can be mailed holds, and their legend.

In: a ``Document`` and the entries of the report. Out: ``Figures``, which know what is missing, and why.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.document.contents import required
from rosprivacy.report.page.inline import Inline, Wishes, picture_of_all, pictures_of
from rosprivacy.report.page.redacted_pictures import renamed
from rosprivacy.report.pictures.added_flows import marking
from rosprivacy.report.pictures.graphviz import Graphviz, available
from rosprivacy.report.pictures.looks import BEYOND, CLEANED, INK, LINE_LOOKS, ROLE_LOOKS, SHORTEST, WAY, Look
from rosprivacy.report.pictures.overview import drawable
from rosprivacy.report.pictures.phrases import Phrases

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.page.outline import Outline
    from rosprivacy.report.pictures.picture import Key

ROOM = 5 * 2**20  # bytes of all pictures together
OVERVIEW = 24  # elements of the first picture


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
    rows = [[findings[entry.id] for entry in row.entries if entry.id in findings] for row in report.opening.rows]
    rows = rows[: next((n for n, row in enumerate(rows) if not row), len(rows))]
    count = drawable([row[0] for row in rows], OVERVIEW)
    shown = [finding for row in rows[:count] for finding in row]
    if not shown:
        return None, 0
    label = plain(report.words("opening.picture"))
    return picture_of_all(graphviz, analysis, shown, replace(wishes, labels={shown[0].id: label})), count


def page_legend(words: Words, *, beyond: bool = False) -> list[tuple[Look, bool, str]]:
    """Return what the pictures of a page mean: a look, whether it is that of a box or of a line, and words."""
    boxes = [(look, True, words(f"phrase.look.{name}")) for name, look in ROLE_LOOKS.items()]
    lines = [(LINE_LOOKS[name], False, words(f"phrase.look.{name}")) for name in (SHORTEST, WAY, CLEANED)]
    lines += [(LINE_LOOKS[BEYOND], False, words(f"phrase.look.{BEYOND}"))] if beyond else []
    return [*boxes, *lines, (Look("", INK, style="dashed"), False, words("phrase.look.hidden"))]
