"""A picture that people can read, where nobody said what to draw of a large one; it says what it leaves out.

In: a ``Picture``. Out: a ``Picture``, and what a reader has to know of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.pictures.looks import LEAK, SOURCE
from rosprivacy.report.pictures.narrow import folded, without_loose_ends
from rosprivacy.report.pictures.picture import LEGIBLE, PRIVACY
from rosprivacy.report.pictures.views import bounded

if TYPE_CHECKING:
    from rosprivacy.report.pictures.picture import Picture


def legible(picture: Picture, limit: int = LEGIBLE) -> tuple[Picture, tuple[str, ...]]:
    """Return a picture of no more boxes than people read, where that can be.

    First channels with the same ends are one box. Then, of the privacy view, the longer paths to leaks are left out,
    and of the ROS graph the channels that one node names. The shortest path of each finding stays. Where no finding
    says what counts, nothing more is left out.

    Returns
    -------
    The picture, and the notes that it has beside those of the whole one.
    """
    if len(picture.boxes) <= limit:
        return picture, ()
    small = folded(picture)
    if len(small.boxes) > limit:
        if picture.view != PRIVACY:
            small = without_loose_ends(small)
        elif picture.core:
            small = bounded(small, limit)
    if (small.boxes, small.lines) == (picture.boxes, picture.lines):
        return picture, ()
    drawn = {(box.robot, box.kind, name) for box in small.boxes for name in box.names}
    gone = [box for box in picture.boxes if box.key not in drawn]
    counts = {
        "picture.source": sum(box.look == SOURCE for box in gone),
        "exit": sum(box.look == LEAK for box in gone),
        "picture.open": sum(box.open for box in gone),
    }
    said = [picture.count(number, thing) for thing, number in counts.items() if number]
    if said:
        small = small.noted(picture.say("picture.gone", what=", ".join(said)))
    elements, boxes = picture.count(len(picture.boxes), "element"), picture.count(len(small.boxes), "picture.box")
    small = small.noted(picture.say("picture.smaller", boxes=boxes, elements=elements))
    return small, tuple(note for note in small.notes if note not in picture.notes)
