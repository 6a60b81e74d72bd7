"""Try before you do on a fleet: something is otherwise on some robots, and the answer is that of the whole fleet.

In: a fleet as a session has it, and ``WhatIf`` with robots. Out: as of ``scenarios.tried``. Robots on which it is
tried are not alike to others any more. Their policies and label files are taken as they were read.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.answering import answer
from rosprivacy.explorer.scenarios import cut, doubting, stated, with_steps
from rosprivacy.ingest.fleet.dds_domains import pseudo_robot
from rosprivacy.ingest.mitigation.deny_lines import open_ended
from rosprivacy.reading.robot_reader import Tried

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.analysis.model import Element, Policy
    from rosprivacy.explorer.scenarios import WhatIf
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.question import Question
    from rosprivacy.reading.fleet_system import FleetSystem
    from rosprivacy.result import Result
    from rosprivacy.system import System

    Read = Callable[[Collection[str], Tried], tuple[FleetSystem, list[InputError]]]


def tried_on_robots(now: FleetSystem, read: Read, asked: Question, what: WhatIf) -> tuple[Result, tuple[str, ...]]:
    """Return the answer of the fleet if something were so on some robots, and what to tell of it.

    Parameters
    ----------
    read
        Makes the fleet with something otherwise on some robots.

    Raises
    ------
    InputErrors
        If it names what is not there, or no robots.
    """
    _check_robots(now.fleet, what.robots)
    tried = Tried(frozenset(cut(_policies(now, what.robots), what)), stated(asked, what))
    there, missing = read(what.robots, tried)
    return answer(_filtered(doubting(there, asked, what), now.fleet, what), asked), tuple(
        dict.fromkeys(map(str, missing))
    )


def _check_robots(fleet: Fleet, robots: Collection[str]) -> None:
    there = {robot.id for robot in (*fleet.robots, *fleet.infrastructure)}
    hint = "name robots of the fleet, such as those of target(robot)"
    if not robots:
        raise InputErrors([InputError("what is tried", 0, "does not say on which robots", hint)])
    unknown = [name for name in robots if name not in there]
    if unknown:
        raise InputErrors(
            [InputError("what is tried", 0, f"{shown(name)!r} is no robot of the fleet", hint) for name in unknown]
        )


def _policies(now: FleetSystem, robots: Collection[str]) -> list[Policy]:
    """The policies that these robots read."""
    wanted = set(robots)
    groups = (group for group in now.groups if any(one.id in wanted for one in group.robots))
    found = [policy for group in groups for policy in now.members[group.robots[0].id].policies]
    return list({policy.file: policy for policy in found}.values())


def _filtered(system: System, fleet: Fleet, what: WhatIf) -> System:
    """The fleet with the steps on each robot; a filter there is read by wildcards of its robot and its domain only."""
    if not what.steps:
        return system
    domains = {robot.id: robot.domain for robot in (*fleet.robots, *fleet.infrastructure)}
    graph, wild = system.graph, open_ended(system.graph)
    there = {element.shown_as for element in graph.elements}
    placed = [name for name in dict.fromkeys(e.robot for e in graph.elements) if name in what.robots]
    done = 0
    for robot in placed:
        steps = tuple(step for one in what.steps for step in _on(one, robot, what.robots, there))
        if steps:
            near = {robot, pseudo_robot(domains[robot])} if domains[robot] else {robot}
            system = with_steps(system, what._replace(steps=steps), _of_robots(near, wild, graph.elements))
            done += 1
    if not done:
        hint = "look at how it stands now, and try again"
        raise InputErrors([InputError("what is tried", 0, "is on none of these robots", hint)])
    return system


def _on(step: ProposedStep, robot: str, robots: Collection[str], there: Collection[object]) -> Iterator[ProposedStep]:
    """A step as it is on a robot, if its elements are there."""

    def moved(element: Element) -> Element:
        return replace(element, robot=robot) if element.robot in robots else element

    between = tuple((moved(a), moved(b)) for a, b in step.between)
    between = tuple((a, b) for a, b in between if a.shown_as in there and b.shown_as in there)
    channel = moved(step.channel) if step.channel else None
    if between or (channel and channel.shown_as in there):
        yield replace(step, between=between, channel=channel)


def _of_robots(
    robots: Collection[str], wild: Mapping[str, frozenset[int]], elements: tuple[Element, ...]
) -> Mapping[str, frozenset[int]]:
    return {kind: frozenset(v for v in found if elements[v].robot in robots) for kind, found in wild.items()}
