"""Pictures of a fleet: one robot is drawn for all that are alike, and it says for how many.

In: a ``Picture`` of the graph in which some robots have a second one beside them. Out: a ``Picture`` without second
robots: what goes from one robot to another like it is drawn as going from it to itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain
from rosprivacy.report.pictures.looks import DATA, DERIVATION, LEAK, OPEN, REVIEWED, SANITIZER, SHORTEST, SOURCE, WAY
from rosprivacy.report.pictures.picture import Box, Picture, PictureLine, sorted_boxes, sorted_lines

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.report.pictures.picture import Key

WAYS = (DATA, WAY, SHORTEST)  # the later hides the earlier
ROLES = (LEAK, SOURCE, DERIVATION, SANITIZER, OPEN, REVIEWED)  # what a box in several roles is coloured by


def label(robot: str, likeness: Likeness, words: Words = IN_ENGLISH) -> str:
    """Return how the robot that is drawn for a robot is called; the name itself if it stands for no other.

    Parameters
    ----------
    robot
        Any of the fleet, or what is no robot.
    words
        Of the reader's language.
    """
    drawn = next((first for first, robots in likeness.members.items() if robot in robots), robot)
    drawn = likeness.second.get(drawn, drawn)
    others = likeness.weight(drawn) - 1
    return plain(words("picture.alike", robot=drawn, n=others)) if others > 0 else drawn


def represented(picture: Picture, likeness: Likeness) -> Picture:
    """Return a picture with one robot for those that are alike.

    Complexity: O(boxes + lines).
    """
    labels = {robot: label(robot, likeness, picture.words) for robot in {box.robot for box in picture.boxes}}

    def moved(key: Key) -> Key:
        return (labels[key[0]], *key[1:])

    boxes: dict[Key, Box] = {}
    for box in picture.boxes:
        now = replace(box, key=moved(box.key))
        old = boxes.get(now.key)
        boxes[now.key] = _merged(old, now) if old else now
    lines: dict[tuple[Key, Key, str], PictureLine] = {}
    for line in picture.lines:
        source, target = moved(line.source), moved(line.target)
        if source != target:
            now_line = replace(line, source=source, target=target)
            slot = (source, target, "" if line.look in WAYS else line.look)
            old_line = lines.get(slot)
            lines[slot] = _joined(old_line, now_line) if old_line else now_line
    standing = sum(likeness.weight(robot) > 1 for robot in likeness.members)
    robots = picture.count(sum(map(likeness.weight, likeness.members)), "robot")
    note = picture.say("picture.fleet", robots=robots, drawn=picture.count(standing, "robot"))
    made = replace(
        picture,
        boxes=sorted_boxes(boxes.values()),
        lines=sorted_lines(lines.values()),
        core=frozenset(moved(key) for key in picture.core),
    )
    return made.noted(note) if standing else made


def _merged(first: Box, second: Box) -> Box:
    look = first.look if first.look == second.look else min(first.look, second.look, key=ROLES.index)
    words = tuple(dict.fromkeys((*first.words, *second.words)))
    return replace(first, look=look, words=words, open=first.open or second.open)


def _joined(first: PictureLine, second: PictureLine) -> PictureLine:
    """What leads to a leak hides what leads to none."""
    lengths = [line.length for line in (first, second) if line.length]
    return replace(
        first,
        look=max(first.look, second.look, key=WAYS.index) if first.look != second.look else first.look,
        roles=_all(first.roles, second.roles),
        carries=_all(first.carries, second.carries),
        pseudonymised=first.pseudonymised and second.pseudonymised,
        places=tuple(sorted({*first.places, *second.places}, key=lambda place: (place.file, place.line))),
        length=min(lengths, default=0),
    )


def _all(texts: Iterable[str], additional: Iterable[str]) -> tuple[str, ...]:
    return tuple(sorted({*texts, *additional}))
