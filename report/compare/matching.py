"""Two states of a system -> what is new, gone and changed, whatever the names that change at every start.

In: facts by key, before and after. Out: ``StateChanges``. Nodes that a program makes for itself have names with a
process id or an address in them (``transform_listener_impl_5591c2d0``, ``rviz2_31337``). What has no counterpart of the
very same name is matched by a name without these. The keys of elements and findings are the same for ``diff`` and for
``report --since``; of a fleet, a robot that stands for others counts by its model, so that it does not matter which one
is shown.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.python_311 import Self

Key = tuple[str, ...]
Record = dict[str, Any]
# A word at the end of a part of a name: an address (hexadecimal, with a digit), or a number of three digits or more.
_MADE_UP = re.compile(r"(?=[a-f]*[0-9])[0-9a-f]{8,}|[0-9]{3,}")


class ElementChange(NamedTuple):
    """Something that is there before or after, or both and not the same.

    Attributes
    ----------
    key
        After, if it is there.
    before, after
        What is said of it; None where it is not there.
    """

    key: Key
    before: Record | None
    after: Record | None


@dataclass(frozen=True, slots=True)
class StateChanges:
    """What differs, each sorted by key."""

    new: tuple[ElementChange, ...]
    removed: tuple[ElementChange, ...]
    changed: tuple[ElementChange, ...]

    def __bool__(self) -> bool:
        return bool(self.new or self.removed or self.changed)


def normalised(name: str) -> str:
    """Return a name without what differs at every start.

    >>> normalised("/transform_listener_impl_5591c2d0/get_parameters"), normalised("/rviz2_31337")
    ('/transform_listener_impl_*/get_parameters', '/rviz2_*')
    >>> normalised("/camera_1"), normalised("/feedface")
    ('/camera_1', '/feedface')
    """
    return "/".join(map(_without_made_up, name.split("/")))


def _without_made_up(part: str) -> str:
    """A part of a name, ``*`` for all made-up words at its end together; the first word is never made up."""
    words = part.split("_")
    kept = len(words)
    while kept > 1 and _MADE_UP.fullmatch(words[kept - 1]):
        kept -= 1
    return part if kept == len(words) else "_".join([*words[:kept], "*"])


class MatchedPairs(NamedTuple):
    """Which key of before is which one of after; each sorted, ``common`` by the key after."""

    common: tuple[tuple[Key, Key], ...]
    removed: tuple[Key, ...]
    new: tuple[Key, ...]


def paired(before: Collection[Key], after: Collection[Key], *, made_up: bool = True) -> MatchedPairs:
    """Return what is the same before and after: of the same name, or else of one that differs in what is made up.

    Parameters
    ----------
    made_up
        Whether programs can have made up parts of names; in source code none is.
    """
    both = set(before) & set(after)
    pairs = [(key, key) for key in both]
    waiting: dict[Key, list[Key]] = defaultdict(list)
    for key in sorted(set(before) - both):
        waiting[_plain(key)].append(key)
    new = []
    for key in sorted(set(after) - both):
        known = waiting.get(_plain(key)) if made_up else None
        if known:
            pairs.append((known.pop(0), key))
        else:
            new.append(key)
    gone = sorted(key for keys in waiting.values() for key in keys)
    return MatchedPairs(tuple(sorted(pairs, key=lambda pair: pair[1])), tuple(gone), tuple(new))


def compare(before: Mapping[Key, Record], after: Mapping[Key, Record], *, made_up: bool = True) -> StateChanges:
    """Return what differs between two states; linear in their size, but for sorting."""
    pairs = paired(before.keys(), after.keys(), made_up=made_up)
    changed = [
        ElementChange(theirs, before[ours], after[theirs])
        for ours, theirs in pairs.common
        if comparable(before[ours]) != comparable(after[theirs])
    ]
    return StateChanges(
        tuple(ElementChange(key, None, after[key]) for key in pairs.new),
        tuple(ElementChange(key, before[key], None) for key in pairs.removed),
        tuple(changed),
    )


def _plain(key: Iterable[str]) -> Key:
    return tuple(map(normalised, key))


def comparable(value: Any) -> Any:
    """Return a record with normalised names in it, to be compared with others."""
    if isinstance(value, str):
        return normalised(value)
    if isinstance(value, dict):
        return {key: comparable(inside) for key, inside in value.items()}
    return [comparable(inside) for inside in value] if isinstance(value, (list, tuple)) else value


@dataclass(frozen=True, slots=True)
class Identity:
    """The keys of a document.

    Attributes
    ----------
    models
        A robot of a fleet that is shown -> its model; empty for a single robot.
    patterns
        Id of a finding -> its pattern in a fleet.
    """

    models: Mapping[str, str]
    patterns: Mapping[str, Mapping[str, Any]]

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Self:
        """Read a document."""
        fleet = document.get("fleet")
        if not fleet:
            return cls({}, {})
        models = {group["robot"]: group["model"] or group["robot"] for group in fleet["alike"]}
        return cls(models, {pattern["finding"]: pattern for pattern in fleet["patterns"]})

    def element(self, element: Mapping[str, Any]) -> Key:
        """Return (robot or model, kind, name, leg)."""
        robot = self.models.get(element["robot"], element["robot"])
        return (robot, element["kind"], element["name"], element.get("leg", ""))

    def finding(self, finding: Mapping[str, Any]) -> Key:
        """Return (kind, category, source, leak, whether it goes across robots, whether beside a pseudonymised one)."""
        pattern = self.patterns.get(finding["id"])
        across = "across" if pattern and pattern["across"] else ""
        ends = (self._end(finding["source"]), self._end(finding["leak"]))
        beside = "beside" if finding.get("beside_pseudonymised") else ""
        return (finding["kind"], finding["category"], *ends, across, beside)

    def _end(self, element: Mapping[str, Any]) -> str:
        """A source or leak by name; with its robot where that is none, such as what is shared."""
        robot = "" if element["robot"] in self.models or not element["robot"] else f"{element['robot']}:"
        return f"{robot}{element['kind']} {element['name']}"
