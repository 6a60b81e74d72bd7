"""Try before you do: the answer if something were other than it is, beside the answer of now.

In: a system as a session has it, and ``WhatIf``. Out: the answer, and what a person has to know of it. Nothing of it is
an edit: label files and policies stay as they are. On a fleet something is otherwise on some robots, which are then not
alike to others, and the answer is that of the whole fleet.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.mitigation.changed_system import with_changes
from rosprivacy.analysis.mitigation.limits import DENY, FILTER
from rosprivacy.analysis.model import Method
from rosprivacy.analysis.text import counted
from rosprivacy.answering import answer
from rosprivacy.explorer.edits import section_of
from rosprivacy.ingest.fleet.dds_domains import pseudo_robot
from rosprivacy.ingest.labels.edited_entries import KINDS, same_name
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.mitigation.deny_lines import open_ended, with_denied
from rosprivacy.systems.fleet_system import FleetSystem
from rosprivacy.systems.robot_reader import Tried
from rosprivacy.systems.robot_system import lenient_system

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sized

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.analysis.model import Element, Grant, Policy, Statement
    from rosprivacy.explorer.effects import Difference
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System

    End = str | Mapping[str, str]
    ReadFleet = Callable[[Collection[str], Tried], tuple[FleetSystem, list[InputError]]]


TRIED, LOOK_AGAIN = "what is tried", "look at how it stands now, and try again"


class WhatIf(NamedTuple):
    """What could be other than it is; several together are tried together.

    Attributes
    ----------
    cut
        (file, line) of grants that are set to DENY; as in a policy, this holds for the whole enclave (rule S5).
    filters
        (from, to, kinds): flows along which these kinds of data go no longer; names as in the section ``flows``.
    elements
        Elements outside ROS that are added: name -> what the section ``elements`` says of it.
    flows
        (from, to) of flows to them and from them; a name, or ``{kind: name}`` where several are called so.
    doubted
        (section or kind of element, name, kinds) of sanitizers that do not clean; without kinds, nothing at all.
    robots
        Of a fleet: the robots on which all of this is tried, by id. Names are then those on each of them; elements of
        ``steps`` are those of one of them, or belong to no robot.
    steps
        Changes as ``mitigate`` proposes and proves them. A filter among them is one in a policy, with a channel of its
        own: what gets past it along wildcards, gets past it here too.
    """

    cut: tuple[tuple[str, int], ...] = ()
    filters: tuple[tuple[str, str, tuple[str, ...]], ...] = ()
    elements: Mapping[str, Any] = {}
    flows: tuple[tuple[End, End], ...] = ()
    doubted: tuple[tuple[str, str, tuple[str, ...]], ...] = ()
    steps: tuple[ProposedStep, ...] = ()
    robots: tuple[str, ...] = ()


class Scenario(NamedTuple):
    """What would follow.

    Attributes
    ----------
    version
        Of the session with which it is compared.
    result
        The answer if it were so.
    difference
        From the answer of now to it.
    remarks
        What a person has to know, such as labels that would name what is no longer there.
    """

    name: str
    what_if: WhatIf
    version: int
    result: Result
    difference: Difference
    remarks: tuple[str, ...] = ()


def tried(system: System, question: Question, trial: WhatIf) -> tuple[Result, tuple[str, ...]]:
    """Return the answer if something were so, and what to tell of it."""
    if trial.robots:
        raise _not_tried("names robots, and this is one robot", "leave robots away")
    grants, labels = _cut(system.policies, trial), _stated(question, trial)
    files = (*system.labels, labels) if labels else system.labels
    remarks: tuple[str, ...] = ()
    if grants:
        read = with_denied(system.policies, grants), system.diagnostics
        changed, problems = lenient_system(read, list(files), question, system.types)
        remarks = tuple(map(str, problems))
    elif labels:
        assert system.under is not None, "of one robot"
        changed = system.under(files)
    else:
        changed = system
    return answer(_with_steps(_doubting(changed, question, trial), trial), question), remarks


def tried_on_robots(now: System, read: ReadFleet, question: Question, trial: WhatIf) -> tuple[Result, tuple[str, ...]]:
    """Return the answer of the fleet if something were so on some robots, and what to tell of it.

    Parameters
    ----------
    read
        Makes the fleet with something otherwise on some robots.
    """
    assert isinstance(now, FleetSystem), "of a fleet"
    _check_robots(now.fleet, trial.robots)
    groups = (group for group in now.groups if any(robot.id in trial.robots for robot in group.robots))
    policies = {policy.file: policy for group in groups for policy in now.members[group.robots[0].id].policies}
    system, missing = read(trial.robots, Tried(frozenset(_cut(policies.values(), trial)), _stated(question, trial)))
    result = answer(_filtered(_doubting(system, question, trial), now.fleet, trial), question)
    return result, tuple(dict.fromkeys(map(str, missing)))


def _check_robots(fleet: Fleet, robots: Collection[str]) -> None:
    known = {robot.id for robot in (*fleet.robots, *fleet.infrastructure)}
    hint = "name robots of the fleet, such as those of target(robot)"
    problems = [f"{shown(name)!r} is no robot of the fleet" for name in robots if name not in known]
    if not robots:
        problems = ["does not say on which robots"]
    if problems:
        raise InputErrors([InputError(TRIED, 0, problem, hint) for problem in problems])


def _filtered(system: System, fleet: Fleet, trial: WhatIf) -> System:
    """The fleet with the steps on each robot; a filter there is read by wildcards of its robot and its domain only."""
    if not trial.steps:
        return system
    domains = {robot.id: robot.domain for robot in (*fleet.robots, *fleet.infrastructure)}
    elements, wild = system.graph.elements, open_ended(system.graph)
    names = {element.shown_as for element in elements}
    changed = False
    for robot in dict.fromkeys(element.robot for element in elements if element.robot in trial.robots):
        steps = tuple(step for each in trial.steps for step in _on(each, robot, trial.robots, names))
        if steps:
            near = {robot, pseudo_robot(domains[robot])} if domains[robot] else {robot}
            read_by = {kind: frozenset(v for v in at if elements[v].robot in near) for kind, at in wild.items()}
            system = _with_steps(system, trial._replace(steps=steps), read_by)
            changed = True
    if not changed:
        raise _not_tried("is on none of these robots", LOOK_AGAIN)
    return system


def _on(step: ProposedStep, robot: str, robots: Collection[str], names: Collection[object]) -> Iterator[ProposedStep]:
    """A step as it is on a robot, if its elements are there."""

    def moved(element: Element) -> Element:
        return replace(element, robot=robot) if element.robot in robots else element

    between = tuple((moved(a), moved(b)) for a, b in step.between)
    between = tuple((a, b) for a, b in between if a.shown_as in names and b.shown_as in names)
    channel = moved(step.channel) if step.channel else None
    if between or (channel and channel.shown_as in names):
        yield replace(step, between=between, channel=channel)


def _cut(policies: Iterable[Policy], trial: WhatIf) -> list[Grant]:
    """The lines that are set to DENY."""
    grants = [grant for policy in policies for grant in policy.grants]
    named = [grant for grant in grants if grant.allow and (grant.place.file, grant.place.line) in trial.cut]
    lines = {(grant.place.file, grant.place.line) for grant in named}
    hint = "name a line that allows something"
    problems = [InputError(*place, "allows nothing", hint) for place in trial.cut if place not in lines]
    if problems:
        raise InputErrors(problems)
    chosen = {grant for step in trial.steps if step.kind == DENY for grant in step.grants}
    return named + [grant for grant in grants if grant in chosen]


def _stated(question: Question, trial: WhatIf) -> Labels | None:
    """What a label file would say; None for nothing."""
    flows: list[dict[str, Any]] = [{"from": a, "to": b, "never": list(kinds)} for a, b, kinds in trial.filters]
    flows += [{"from": a, "to": b} for a, b in trial.flows]
    if not (flows or trial.elements):
        return None
    entries = {"labels": 1, "elements": dict(trial.elements), "flows": flows}
    return parse_labels(entries, question.vocabulary, name=TRIED, bounds=question.settings.bounds)


def _with_steps(system: System, trial: WhatIf, wild: Mapping[str, frozenset[int]] | None = None) -> System:
    """The system after reviews and filters; what is set to DENY is gone already. ``wild`` is as of ``with_changes``."""
    steps = [step for step in trial.steps if step.kind != DENY]
    if not steps:
        return system
    elements = system.graph.elements
    flows = system.graph.flows if any(step.between for step in steps) else ()
    ends = {(elements[flow.source].shown_as, elements[flow.target].shown_as) for flow in flows}
    channels = {element.identity for element in elements if element.is_channel}
    for step in steps:
        is_there = any((a.shown_as, b.shown_as) in ends for a, b in step.between)
        if step.channel:
            is_there = step.channel.identity in channels
        if not is_there:
            what_for = "to filter" if step.kind == FILTER else "to review"
            raise _not_tried(f"there is nothing any more {what_for}", LOOK_AGAIN)
    wild = open_ended(system.graph) if wild is None else wild
    graph, bound = with_changes(system.graph, system.bound, steps, wild)
    return replace(system, graph=graph, bound=bound)


def _doubting(system: System, question: Question, trial: WhatIf) -> System:
    """The system without what some sanitizers are said to clean."""
    elements = dict(system.bound.elements)
    for kind, name, kinds in trial.doubted:
        section = section_of(kind, name, TRIED)
        hierarchy = question.vocabulary.hierarchy
        cleans_nothing = True
        for vertex, statements in system.bound.elements.items():
            element = system.graph.elements[vertex]
            if trial.robots and element.robot not in trial.robots:
                continue
            if element.kind in KINDS[section] and same_name(element.name, name):
                left = tuple(each for each in statements if not _cleans(each, kinds, hierarchy))
                elements[vertex] = left
                cleans_nothing &= len(left) == len(statements)
        if cleans_nothing:
            problem = f"{shown(name)!r} is no sanitizer" + (f" of {', '.join(kinds)}" if kinds else "")
            raise _not_tried(problem, "name one that cleans something")
    return replace(system, bound=replace(system.bound, elements=elements)) if trial.doubted else system


def _cleans(statement: Statement, kinds: tuple[str, ...], hierarchy: Hierarchy) -> bool:
    """Whether a statement says that something is cleaned, of one of some kinds or of any."""
    if statement.role != "sanitizer" or statement.method is Method.ABSENT:
        return False
    return any(
        not kinds or any(hierarchy.overlap(category, kind) is not None for kind in kinds)
        for category in statement.categories
    )


def summary_of(trial: WhatIf) -> str:
    """Return in few words how much is tried.

    >>> summary_of(WhatIf(cut=(("p.xml", 3),), doubted=(("nodes", "/blur", ()),)))
    '1 line cut, 1 sanitizer doubted'
    """
    parts: list[tuple[Sized, str, str]] = [
        (trial.steps, "change", "made"),
        (trial.cut, "line", "cut"),
        (trial.filters, "flow", "filtered"),
        (trial.elements, "element", "added"),
        (trial.flows, "flow", "added"),
        (trial.doubted, "sanitizer", "doubted"),
    ]
    return ", ".join(f"{counted(len(part), noun)} {verb}" for part, noun, verb in parts if part)


def together(first: WhatIf, second: WhatIf) -> WhatIf:
    """Return what is tried if both are; what both say is said once.

    An element of the second that is called as another one of the first is another element: it gets a number.

    >>> disk = WhatIf(elements={"disk": {"kind": "storage"}}, flows=(("/camera", "disk"),))
    >>> other = WhatIf(elements={"disk": {"kind": "storage"}}, flows=(("/face_id", "disk"),))
    >>> both = together(disk, other)
    >>> list(both.elements), both.flows
    (['disk', 'disk 2'], (('/camera', 'disk'), ('/face_id', 'disk 2')))
    >>> together(disk, disk) == disk
    True
    """
    if first.robots != second.robots:
        raise _not_tried("is not about the same robots", "try both on the same robots")
    renamed = {name: _free(name, first, second) for name in second.elements}
    flows = tuple((_renamed(a, renamed), _renamed(b, renamed)) for a, b in second.flows)
    return WhatIf(
        cut=tuple(dict.fromkeys((*first.cut, *second.cut))),
        filters=tuple(dict.fromkeys((*first.filters, *second.filters))),
        elements={**first.elements, **{renamed[name]: facts for name, facts in second.elements.items()}},
        flows=(*first.flows, *(flow for flow in flows if flow not in first.flows)),
        doubted=tuple(dict.fromkeys((*first.doubted, *second.doubted))),
        steps=tuple(dict.fromkeys((*first.steps, *second.steps))),
        robots=first.robots,
    )


def _free(name: str, first: WhatIf, second: WhatIf) -> str:
    """A name for an element of the second: its own, unless the first has another element of that name."""
    if name not in first.elements or _stated_of(name, first) == _stated_of(name, second):
        return name
    taken = first.elements.keys() | second.elements.keys()
    return next(other for number in count(2) if (other := f"{name} {number}") not in taken)


def _stated_of(name: str, trial: WhatIf) -> object:
    return trial.elements[name], [flow for flow in trial.flows if name in map(_name_of, flow)]


def _renamed(end: End, names: Mapping[str, str]) -> End:
    return names.get(end, end) if isinstance(end, str) else {kind: names.get(of, of) for kind, of in end.items()}


def _name_of(end: End) -> str:
    return end if isinstance(end, str) else next(iter(end.values()))


def _not_tried(problem: str, hint: str) -> InputErrors:
    return InputErrors([InputError(TRIED, 0, problem, hint)])
