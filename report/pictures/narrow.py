"""Smaller pictures of larger ones: a robot, a neighbourhood, channels with the same ends as one, groups.

In: a ``Picture``. Out: a ``Picture`` that says what it leaves out. A name that nothing has is an error.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DrawingError, shown
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest
from rosprivacy.report.pictures.looks import MATCHES
from rosprivacy.report.pictures.picture import Box, Picture, PictureLine, sorted_lines

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
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
