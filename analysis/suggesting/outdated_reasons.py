"""Labels that were accepted since a channel had a type that is made for other things, and it has another type now.

In: a graph and what is bound to it. Out: warnings. An accepted label keeps its reason in its note; a type in it is
compared with the types that are known today (rule S15). The label stands: it is a person's word, who has to look again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Bound, FlowGraph

TAKING = ("never", "only", "mundane")
NOT_MADE = " is not made for "  # as open_elements and by_package_types say it, the latter with 'which'
PARTS, SORTS = 3, ("msg", "srv", "action")


def outdated_reasons(graph: FlowGraph, bound: Bound) -> Iterator[Diagnostic]:
    """Yield a warning for each such label and channel.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import FACES, factory
    >>> from rosprivacy.analysis.model import MessageType, Place, Statement
    >>> graph, bound, _ = factory()
    >>> why = "accepted by Ada on 2026-11-23 (may): type hri_msgs/msg/IdsList of /faces is not made for Video"
    >>> never = Statement("never", ("Video",), (2, 6), Place("labels.yaml", 5), why=why)
    >>> for name in ("hri_msgs/msg/IdsList", "sensor_msgs/msg/Image"):
    ...     there = replace(bound, elements={FACES: (never,)}, types={FACES: (MessageType(name, Place("t.yaml", 3)),)})
    ...     print([one.message for one in outdated_reasons(graph, there)])
    []
    ['never of /faces was accepted since its type was hri_msgs/msg/IdsList; it is sensor_msgs/msg/Image now \
(t.yaml:3): look at it anew']
    """
    for vertex, said in bound.elements.items():
        types = bound.types.get(vertex, ())
        for one in said if types else ():
            reasons = types_in(one.why) if one.role in TAKING else ()
            new = [now for now in types if now.name not in reasons]
            if reasons and new:
                was, now = shown(", ".join(reasons)), shown(new[0].name)
                what = f"{one.role} of {shown(graph.elements[vertex].name)} was accepted since its type was {was}"
                yield Diagnostic(
                    one.place, Severity.WARNING, f"{what}; it is {now} now ({new[0].place}): look at it anew"
                )


def surest(reasons: Iterable[str]) -> str:
    """Return the first of some reasons, those that are looked at again, and how many more there are.

    >>> surest(["its name", "type a/msg/B of /d is not made for Voice", "its reader", "its writer"])
    'its name; type a/msg/B of /d is not made for Voice; and 2 more reasons'
    """
    first, *others = [*dict.fromkeys(reasons)] or [""]
    types = [reason for reason in others if NOT_MADE in reason]
    more = len(others) - len(types)
    return "; ".join([first, *types, *([f"and {counted(more, 'more reason')}"] if more else [])])


def grounds_of(reasons: Iterable[str]) -> str:
    """Return what reasons rest on, for a note that people read: the first, and those that are looked at again.

    >>> grounds_of(["package usb_cam 0.8.1: it films (its name)", "type a/msg/B of /c: a picture"])
    'package usb_cam 0.8.1'
    >>> grounds_of(["package nav2 1.5.0: a/action/Spin, which is not made for Video", "its name"])
    'package nav2 1.5.0: a/action/Spin, which is not made for Video'
    """
    first, *others = [*dict.fromkeys(reasons)] or [""]
    types = [reason for reason in others if NOT_MADE in reason]
    return "; ".join([first if NOT_MADE in first else first.partition(": ")[0], *types])


def types_in(note: str) -> tuple[str, ...]:
    """Return the types that a note names as its reason.

    >>> types_in("answered by A/msg/B on 2026-11-23 in a list of 2: package nav2 1.5.0: nav2_msgs/action/Spin, "
    ...          "which is not made for Video; type a/msg/B, a/msg/C of /d is not made for Voice")
    ('nav2_msgs/action/Spin', 'a/msg/B', 'a/msg/C')
    """
    found: list[str] = []
    for reason in note.split("; "):
        before, sign, _ = reason.partition(NOT_MADE)
        words = before.rpartition(": ")[2].replace(",", " ").split() if sign else []
        found += [word for word in words if _is_type(word)]
    return tuple(dict.fromkeys(found))


def _is_type(word: str) -> bool:
    parts = word.split("/")
    return len(parts) == PARTS and parts[1] in SORTS and all(parts)
