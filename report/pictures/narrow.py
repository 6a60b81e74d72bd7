"""Smaller pictures of larger ones: a robot, a neighbourhood, channels with the same ends as one, groups, a fleet.

In: a ``Picture``. Out: a ``Picture`` that says what it leaves out. A name that nothing has is an error. Where nobody
said what to draw of a large one, it becomes one that people can read. Of a fleet, one robot is drawn for all that are
alike, and it says for how many: what goes from one robot to another like it is drawn as going from it to itself.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DrawingError, shown
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain
from rosprivacy.report.pictures.looks import (
    DATA,
    DERIVATION,
    LEAK,
    MATCHES,
    OPEN,
    REVIEWED,
    SANITIZER,
    SHORTEST,
    SOURCE,
    WAY,
)
from rosprivacy.report.pictures.picture import LEGIBLE, PRIVACY, Box, Picture, PictureLine, sorted_boxes, sorted_lines
from rosprivacy.report.pictures.views import bounded

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Profile
    from rosprivacy.report.pictures.picture import Key

SHORTEST_ID = 4  # characters of a finding's id


def the_finding(analysis: Analysis, prefix: str) -> Finding:
    """Return the finding whose id begins so.

    Raises
    ------
    DrawingError
        If there is none, or more than one.
    """
    found = [finding for finding in analysis.findings if len(prefix) >= SHORTEST_ID and finding.id.startswith(prefix)]
    if len(found) == 1:
        return found[0]
    what = f"{len(found)} findings begin with" if found else "there is no finding"
    names = [f"{finding.id} ({finding.category})" for finding in (found or analysis.findings)[:5]]
    hint = f"such as {', '.join(names)}" if names else "rosprivacy analyze lists them"
    raise DrawingError(f"--finding: {what} {shown(prefix)!r}; give the number in brackets of the report, {hint}")


def of_robot(picture: Picture, robot: str) -> Picture:
    """Return what belongs to a robot, and what of no robot, or of another one, it is joined to.

    Raises
    ------
    DrawingError
        If nothing belongs to it.
    """
    own = {box.key for box in picture.boxes if box.robot == robot}
    if not own:
        robots = sorted({box.robot for box in picture.boxes if box.robot})
        raise DrawingError(f"--robot: there is no robot {shown(robot)!r}; {_nearest(robot, robots)}")
    joined = {line.target for line in picture.lines if line.source in own}
    joined |= {line.source for line in picture.lines if line.target in own}
    return picture.part(own | joined, _part(picture, own | joined, picture.say("picture.part.robot", robot=robot)))


def around(picture: Picture, names: Iterable[str], steps: int) -> Picture:
    """Return what is within some steps of elements, whatever the direction.

    Parameters
    ----------
    names
        Full names; an element of any kind.

    Raises
    ------
    DrawingError
        If nothing in the picture has one of the names.
    """
    names = list(names)
    by_name: dict[str, set[Key]] = defaultdict(set)
    for box in picture.boxes:
        for name in box.names:
            by_name[name].add(box.key)
    missing = [name for name in names if name not in by_name]
    if missing:
        what = "in this picture there is no"
        raise DrawingError("\n".join(f"--around: {what} {shown(n)!r}; {_nearest(n, by_name)}" for n in missing))
    kept = within(picture, {key for name in names for key in by_name[name]}, steps)
    what = picture.say("picture.part.within", steps=picture.count(steps, "step"), names=", ".join(names))
    return picture.part(kept, _part(picture, kept, what))


def carrying(picture: Picture, analysis: Analysis) -> Picture:
    """Return what data of the analysis gets to."""
    carried = {one.element.identity for one in analysis.carried}
    kept = {box.key for box in picture.boxes if box.key in carried}
    kinds = ", ".join(analysis.emitted) or picture.say("picture.empty")
    return picture.part(kept, _part(picture, kept, picture.say("picture.part.carries", kinds=kinds)))


def within(picture: Picture, starts: Collection[Key], steps: int) -> set[Key]:
    """Return the boxes within some steps of others."""
    beside: dict[Key, set[Key]] = defaultdict(set)
    for line in picture.lines:
        beside[line.source].add(line.target)
        beside[line.target].add(line.source)
    kept = level = set(starts)
    for _ in range(steps):
        level = {there for here in level for there in beside[here]} - kept
        kept = kept | level
    channels = {box.key: box.pattern for box in picture.boxes if box.is_channel}
    for key in [key for key in kept if channels.get(key)]:  # a wildcard says nothing without those who use it
        kept = kept | {there for there in beside[key] if there not in channels}
    return kept


def _part(picture: Picture, keys: Collection[Key], scope: str) -> str:
    return picture.say("picture.part", what=scope, n=len(keys), elements=picture.count(len(picture.boxes), "element"))


def _nearest(name: str, names: Iterable[str]) -> str:
    every = sorted(names)
    return did_you_mean(nearest(name, every, FEW), f"there are {counted(len(every), 'name')}")


def _as_one(boxes: Sequence[Box]) -> Box:
    """Boxes that are drawn as one, with the names and the message types of all."""
    types = tuple(sorted({name for box in boxes for name in box.types}))
    return replace(boxes[0], names=tuple(n for box in boxes for n in box.names), types=types)


def folded(picture: Picture, apart: Collection[Key] = ()) -> Picture:
    """Return the picture with channels of one kind that have the same ends, lines and role drawn as one box.

    Every name is kept; the box names the first ones and how many more there are. No line goes from a wildcard to each
    name that it covers: it says how many there are.

    Parameters
    ----------
    apart
        Boxes that stay by themselves.
    """
    lines_kept = tuple(line for line in picture.lines if line.look != MATCHES)
    if len(lines_kept) < len(picture.lines):
        picture = replace(picture, lines=lines_kept).noted(picture.say("picture.matches"))
    joins: dict[Key, set[tuple[object, ...]]] = defaultdict(set)
    for line in picture.lines:
        joins[line.source].add(("to", line.target, line.look, line.pseudonymised, line.length, line.roles))
        joins[line.target].add(("from", line.source, line.look, line.pseudonymised, line.length, line.roles))
    alike: dict[object, list[Box]] = defaultdict(list)
    for box in picture.boxes:
        same = (box.robot, box.kind, box.look, box.words, box.open, box.group, frozenset(joins[box.key]))
        alone = box.pattern or box.key in apart or not box.is_channel
        alike[box.key if alone else same].append(box)
    first = {box.key: boxes[0].key for boxes in alike.values() for box in boxes}
    boxes = tuple(_as_one(some) for some in alike.values())
    lines: dict[tuple[Key, Key, str], PictureLine] = {}
    for line in picture.lines:
        ends = first[line.source], first[line.target], line.look
        old = lines.get(ends)
        carries, places = {*line.carries, *(old.carries if old else ())}, {*line.places, *(old.places if old else ())}
        lines[ends] = replace(
            line,
            source=ends[0],
            target=ends[1],
            carries=tuple(sorted(carries)),
            places=tuple(sorted(places, key=lambda place: (place.file, place.line))),
        )
    core = frozenset(first[key] for key in picture.core)
    return replace(picture, boxes=boxes, lines=sorted_lines(lines.values()), core=core)


def without_loose_ends(picture: Picture) -> Picture:
    """Return the picture without channels that no more than one node names; wildcards stay, though they cover some."""
    users: dict[Key, set[Key]] = defaultdict(set)
    channels = {box.key for box in picture.boxes if box.is_channel}
    for line in picture.lines:
        for here, there in ((line.source, line.target), (line.target, line.source)):
            if here in channels and there not in channels:
                users[here].add(there)
    loose = {box.key for box in picture.boxes if box.is_channel and not box.pattern and len(users[box.key]) < 2}  # noqa: PLR2004 - two ends
    if not loose:
        return picture
    names = sum(len(box.names) for box in picture.boxes if box.key in loose)
    return picture.part(
        {box.key for box in picture.boxes} - loose,
        picture.count(names, "picture.loose"),
    )


def grouped(
    picture: Picture,
    by: str,
    profiles: Iterable[Profile],
    profiles_by_robot: Mapping[str, Iterable[Profile]] | None = None,
) -> Picture:
    """Return the picture with its boxes in groups; a channel is in a group if all that it is joined to are.

    Parameters
    ----------
    by
        ``enclave``, ``namespace`` or ``robot``.
    profiles
        Of the whole graph.
    profiles_by_robot
        Robot -> its profiles, where there are several robots; what has none is no robot.
    """
    group_of = _namers(profiles, profiles_by_robot or {}, picture)[by]
    names = {box.key: group_of(box) for box in picture.boxes if by == "robot" or not box.is_channel}
    if by != "robot":
        ends: dict[Key, set[str]] = defaultdict(set)
        channels = {box.key for box in picture.boxes if box.is_channel}
        for line in picture.lines:
            for here, there in ((line.source, line.target), (line.target, line.source)):
                if here in channels and there not in channels:
                    ends[here].add(names[there])
        names |= {key: next(iter(ends[key])) for key in channels if len(ends[key]) == 1}
    return replace(picture, boxes=tuple(replace(box, group=names.get(box.key, "")) for box in picture.boxes))


def _namers(
    profiles: Iterable[Profile], profiles_by_robot: Mapping[str, Iterable[Profile]], picture: Picture
) -> Mapping[str, Callable[[Box], str]]:
    enclaves: dict[tuple[str, str], set[str]] = defaultdict(set)
    for name, some in (profiles_by_robot or {"": profiles}).items():
        for profile in some:
            enclaves[name, profile.node].add(profile.enclave)

    def robot(box: Box) -> str:
        named = box.robot and (not profiles_by_robot or box.robot in profiles_by_robot)
        return picture.say("picture.robot", robot=box.robot) if named else box.robot

    def enclave(box: Box) -> str:
        at = box.robot if profiles_by_robot else ""
        found = sorted(enclaves.get((at, box.key[2]), ())) if box.kind == "node" else []
        if not found:
            return ""
        names = picture.say("enclave.named", names=picture.words("terminal.and").join(found))
        return ", ".join([*([robot(box)] if box.robot else []), names])

    def namespace(box: Box) -> str:
        space = box.key[2].rpartition("/")[0] if box.kind == "node" else ""
        return ", ".join([*([robot(box)] if box.robot else []), space]) if space else ""

    return {"robot": robot, "enclave": enclave, "namespace": namespace}


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
