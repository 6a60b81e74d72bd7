"""The list of doubts by robot, as a database keeps it: a line for each that nobody has accepted (rule S11).

In: doubts of an answer, and what was said of each robot's files. Out: lines in English, and who has one that breaks.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import writers_and_readers
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.records import doubt_entry
from rosprivacy.report.verdict import phrase

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Diagnostic, Doubt, Element, FlowGraph


def doubt_lines(doubts: Iterable[Doubt]) -> list[str]:
    """Return a line for each doubt that nobody has accepted, sorted.

    >>> from rosprivacy.analysis.model import UNREAD_FILE, Doubt, Place
    >>> doubt_lines([Doubt(UNREAD_FILE, place=Place("d/x.xml", 1))])
    ['breaks unread-file: d/x.xml was not read']
    """
    rows = [doubt_entry(doubt) for doubt in doubts if doubt.accepted is None]
    return sorted({f"{row['rank']} {row['doubt']}: {phrase([row], IN_ENGLISH)}" for row in rows})


def doubts_by_robot(
    doubts: Iterable[Doubt],
    robots: Mapping[str, Iterable[Diagnostic]],
    graph: FlowGraph,
    likeness: Likeness,
    robot_of: Callable[[Element], str],
) -> dict[str, list[Doubt]]:
    """Return the doubts of each robot: what is about the whole answer is about all.

    A channel that robots share counts for each of them that writes or reads it; an element that people added to a
    database and that belongs to no robot counts for all.

    Parameters
    ----------
    robots
        Robots of the graph, and what is shared, each with what its files were read with.
    robot_of
        Element -> name of its robot; of robots that are alike that of the first.

    Notes
    -----
    O(flows + doubts * robots).
    """
    reported: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    for name, diagnostics in robots.items():
        for key in {(said.code, said.place.file, said.message) for said in diagnostics}:
            reported[key].append(name)
    doubts = tuple(doubts)
    beside: dict[tuple[str, ...], set[str]] = defaultdict(set)  # channel, as it is shown -> robots
    for channel, other in writers_and_readers(graph, (doubt.element for doubt in doubts if doubt.element)):
        beside[channel.shown_as].add(robot_of(other))
    told: dict[str, list[Doubt]] = {name: [] for name in robots}
    for doubt in doubts:
        element = doubt.element
        if element is None:
            names = reported.get((doubt.name, doubt.place.file, doubt.message)) or [*robots]
            mine = doubt
        else:
            names = sorted({robot_of(element), *beside[element.shown_as]} & robots.keys()) or [*robots]
            mine = replace(
                doubt, element=likeness.alike(element), count=doubt.count // max(likeness.weight(element.robot), 1)
            )
        for name in names:
            told[name].append(mine)
    return told


def breaking(doubts_by_robot: Mapping[str, Iterable[Doubt]]) -> list[str]:
    """Return the robots of which a doubt leaves no better verdict than 'undetermined'."""
    return [name for name, doubts in doubts_by_robot.items() if any(doubt.breaks for doubt in doubts)]
