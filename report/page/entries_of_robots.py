"""What differs only in the robot is one entry, with its robots counted and listed (rule S10).

In: rows of a document. Out: the same in groups, the first of each in its place. Robots of one row are told apart by
the order in which they are named, so that a path from one robot to another is not one inside a robot.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import name

Row = TypeVar("Row")
NOBODY: Mapping[str, Collection[str]] = MappingProxyType({})

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Hashable, Iterable, Mapping

    from rosprivacy.report.catalogs.words import Words


def grouped(rows: Iterable[Row], pattern: Callable[[Row], Hashable]) -> list[list[Row]]:
    """Return rows of one pattern together, in the order of the first of each."""
    groups: dict[Hashable, list[Row]] = {}
    for row in rows:
        groups.setdefault(pattern(row), []).append(row)
    return list(groups.values())


def without_robots(elements: Iterable[Mapping[str, Any]]) -> tuple[tuple[Any, ...], ...]:
    """Return elements with numbers in place of robots.

    >>> without_robots([{"robot": "b", "kind": "node", "name": "/x"}, {"robot": "a", "kind": "topic", "name": "/y"}])
    ((0, 'node', '/x', '', False), (1, 'topic', '/y', '', False))
    """
    numbers: dict[str, int] = {"": -1}
    return tuple(
        (numbers.setdefault(e["robot"], len(numbers) - 1), e["kind"], e["name"], e.get("leg", ""), "pattern" in e)
        for e in elements
    )


def finding_pattern(finding: Mapping[str, Any]) -> Hashable:
    """Return what findings have in common that differ only in the robot; policy files are the robot's own."""
    elements = [*finding["witness"], finding["source"], finding["leak"], *finding["through"]]
    elements += [finding["special_from"]] if finding["special_from"] else []
    elements += [element for path in finding.get("paths", ()) for element in path]
    steps = tuple((step["role"], step["category"], step["pseudonymised"]) for step in finding.get("steps", ()))
    same = (finding["kind"], finding["category"], finding["pseudonymised"], finding["dismissed"])
    more = (finding.get("accepted"), finding.get("reason"), finding["disjoint_paths"])
    return (same, more, without_robots(elements), steps, tuple(map(len, finding.get("paths", ()))))


def names_of(
    elements: Iterable[Mapping[str, Any]], words: Words, alike: Mapping[str, Collection[str]] = NOBODY
) -> tuple[str, ...]:
    """Return the names of elements, each once; one that several robots have, with their number.

    Parameters
    ----------
    alike
        A robot that stands for others -> these and itself.

    >>> from rosprivacy.report.catalogs.words import Words
    >>> names_of([{"robot": r, "kind": "node", "name": "/camera"} for r in ("r1", "r2")], Words("en"))
    ('/camera (2 robots)',)
    """
    groups = grouped(elements, lambda element: (element["kind"], element["name"]))
    return tuple(dict.fromkeys(_name_of(group, words, alike) for group in groups))


def _name_of(group: list[Mapping[str, Any]], words: Words, alike: Mapping[str, Collection[str]]) -> str:
    robots = weight({element["robot"] for element in group}, alike)
    return name(group[0]) if robots == 1 else f"{fit(group[0]['name'])} ({words.count(robots, 'robot')})"


def weight(robots: Iterable[str], alike: Mapping[str, Collection[str]]) -> int:
    """Return how many robots some robots stand for."""
    return sum(len(alike.get(robot, ("",))) for robot in robots)
