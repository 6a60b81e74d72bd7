"""Pictures with what the enforced view adds: steps that the profile of their node does not allow, dashed (rule S6).

In: a ``Picture`` of a finding of the enforced view, or of the declared one as a whole. Out: a ``Picture``. Only paths
of findings that the enforced view adds are drawn, not all that the middleware lets through.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.beyond import granted
from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.pictures.looks import BEYOND, ONWARD
from rosprivacy.report.pictures.picture import PRIVACY, sorted_boxes, sorted_lines
from rosprivacy.report.pictures.views import PER_BOX, FindingViews

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.report.pictures.phrases import Phrases
    from rosprivacy.report.pictures.picture import Box, Key, Picture, PictureLine

BOUND = 16  # boxes of the paths of one finding, unless the shortest is longer


def marking(analysis: Analysis) -> Callable[[Picture], Picture]:
    """Return what marks the steps of a picture that no profile allows, by the flows of the declared view."""
    declared = frozenset(key[:3] for key in granted(analysis.graph))  # a box is of both sides of a wildcard

    def marked(picture: Picture) -> Picture:
        lines = (replace(line, look=BEYOND) if _is_beyond(line, declared) else line for line in picture.lines)
        return replace(picture, lines=sorted_lines(lines))

    return marked


def _is_beyond(line: PictureLine, declared: Collection[tuple[Key, Key, str]]) -> bool:
    return bool(line.places) and all((line.source, line.target, role) not in declared for role in line.roles)


def with_added(
    declared: Analysis,
    enforced: PathsToLeaks,
    added: Collection[Added],
    say: Phrases,
    draw: Callable[[Collection[Key]], Picture],
) -> Picture:
    """Return a picture of the declared view with the paths of what the enforced view adds.

    In the ROS view these are the steps that no profile allows; in the privacy view also where data goes on then.

    Parameters
    ----------
    declared, enforced
        The system under both views, the enforced one with its paths to leaks.
    added
        What the enforced view adds.
    draw
        Draws the declared view; it gets what will be drawn beside it.
    """
    marked, views = marking(declared), FindingViews(enforced, say)
    more = [marked(views.of(one.finding, PER_BOX * BOUND)) for one in added]
    more_boxes: dict[Key, Box] = {box.key: box for each in more for box in each.boxes}
    picture = draw(more_boxes)
    boxes = {**(more_boxes if picture.view == PRIVACY else {}), **{box.key: box for box in picture.boxes}}
    there = {(line.source, line.target) for line in picture.lines}
    new = {line.sort_key()[:2]: line for each in more for line in _new(each.lines, there, picture.view)}
    lines = sorted_lines([*picture.lines, *(line for line in new.values() if {line.source, line.target} <= set(boxes))])
    note = plain(picture.words.count(len(added), "picture.added"))
    core = picture.core | (frozenset(key for one in added for key in _witness(one)) & set(boxes))
    return replace(picture, boxes=sorted_boxes(boxes.values()), lines=lines, core=core).noted(note)


def _new(lines: Iterable[PictureLine], present: Collection[tuple[Key, Key]], view: str) -> Iterable[PictureLine]:
    for line in lines:
        if line.look == BEYOND:
            yield line
        elif view == PRIVACY and (line.source, line.target) not in present:
            yield replace(line, look=ONWARD)


def _witness(added: Added) -> Iterable[Key]:
    return (element.identity for element in added.finding.witness)
