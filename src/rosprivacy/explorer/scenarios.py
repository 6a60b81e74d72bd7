"""Try before you do: the answer if something were other than it is, beside the answer of now (issue 22).

In: a system as a session has it, and ``WhatIf``. Out: the answer, and what a person has to know of it. Nothing of it is
an edit: the label file and the policies stay as they are.
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
from rosprivacy.ingest.labels.edited_entries import KINDS, same_name
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.mitigation.deny_lines import open_ended, with_denied
from rosprivacy.reading.robot_system import lenient_system

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sized

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.analysis.model import Grant, Policy, Statement
    from rosprivacy.explorer.effects import Difference
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System

    End = str | Mapping[str, str]


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
    what: WhatIf
    version: int
    result: Result
    difference: Difference
    remarks: tuple[str, ...] = ()


def tried(system: System, asked: Question, what: WhatIf) -> tuple[Result, tuple[str, ...]]:
    """Return the answer if something were so, and what to tell of it.

    Raises
    ------
    InputErrors
        If it names what is not there.
    """
    if what.robots:
        raise InputErrors([InputError("what is tried", 0, "names robots, and this is one robot", "leave robots away")])
    grants, labels = cut(system.policies, what), stated(asked, what)
    files = (*system.labels, labels) if labels else system.labels
    remarks: tuple[str, ...] = ()
    if grants:
        read = with_denied(system.policies, grants), system.diagnostics
        there, problems = lenient_system(read, list(files), asked, system.types)
        remarks = tuple(map(str, problems))
    elif labels:
        assert system.under is not None, "of one robot"
        there = system.under(files)
    else:
        there = system
    return answer(with_steps(doubting(there, asked, what), what), asked), remarks


def cut(policies: Iterable[Policy], what: WhatIf) -> list[Grant]:
    """Return the lines that are set to DENY.

    Raises
    ------
    InputErrors
        If a line allows nothing.
    """
    policies = tuple(policies)
    found = [
        grant
        for policy in policies
        for grant in policy.grants
        if grant.allow and (grant.place.file, grant.place.line) in what.cut
    ]
    lines = {(grant.place.file, grant.place.line) for grant in found}
    hint = "name a line that allows something"
    problems = [InputError(*place, "allows nothing", hint) for place in what.cut if place not in lines]
    if problems:
        raise InputErrors(problems)
    chosen = {grant for step in what.steps if step.kind == DENY for grant in step.grants}
    return found + [grant for policy in policies for grant in policy.grants if grant in chosen]


def stated(asked: Question, what: WhatIf) -> Labels | None:
    """Return what a label file would say; None for nothing."""
    flows: list[dict[str, Any]] = [{"from": a, "to": b, "never": list(kinds)} for a, b, kinds in what.filters]
    flows += [{"from": a, "to": b} for a, b in what.flows]
    if not (flows or what.elements):
        return None
    said = {"labels": 1, "elements": dict(what.elements), "flows": flows}
    return parse_labels(said, asked.vocabulary, name="what is tried", bounds=asked.settings.bounds)


def with_steps(system: System, what: WhatIf, wild: Mapping[str, frozenset[int]] | None = None) -> System:
    """Return the system after reviews and filters; what is set to DENY is gone already.

    Parameters
    ----------
    wild
        As of ``with_changes``; None for all wildcards of the graph.

    Raises
    ------
    InputErrors
        If there is nothing any more to review or to filter.
    """
    steps = [step for step in what.steps if step.kind != DENY]
    if not steps:
        return system
    elements = system.graph.elements
    flows = system.graph.flows if any(step.between for step in steps) else ()
    ends = {(elements[flow.source].shown_as, elements[flow.target].shown_as) for flow in flows}
    channels = {element.identity for element in elements if element.is_channel}
    for step in steps:
        there = any((a.shown_as, b.shown_as) in ends for a, b in step.between)
        if step.channel:
            there = step.channel.identity in channels
        if not there:
            problem = f"there is nothing any more {'to filter' if step.kind == FILTER else 'to review'}"
            raise InputErrors([InputError("what is tried", 0, problem, "look at how it stands now, and try again")])
    wild = open_ended(system.graph) if wild is None else wild
    graph, bound = with_changes(system.graph, system.bound, steps, wild)
    return replace(system, graph=graph, bound=bound)


def doubting(system: System, asked: Question, what: WhatIf) -> System:
    """Return the system without what some sanitizers are said to clean.

    Raises
    ------
    InputErrors
        If one is none.
    """
    elements = dict(system.bound.elements)
    for kind, name, kinds in what.doubted:
        section = section_of(kind, name, "what is tried")
        hierarchy = asked.vocabulary.hierarchy
        touched = 0
        for vertex, said in system.bound.elements.items():
            element = system.graph.elements[vertex]
            if what.robots and element.robot not in what.robots:
                continue
            if element.kind in KINDS[section] and same_name(element.name, name):
                elements[vertex] = tuple(one for one in said if not any(_cleans(one, kinds, hierarchy)))
                touched += len(elements[vertex]) < len(said)
        if not touched:
            problem = f"{shown(name)!r} is no sanitizer" + (f" of {', '.join(kinds)}" if kinds else "")
            raise InputErrors([InputError("what is tried", 0, problem, "name one that cleans something")])
    return replace(system, bound=replace(system.bound, elements=elements)) if what.doubted else system


def _cleans(said: Statement, kinds: tuple[str, ...], hierarchy: Hierarchy) -> Iterator[bool]:
    """Whether a statement says that something is cleaned, of one of some kinds or of any."""
    if said.role == "sanitizer" and said.method is not Method.ABSENT:
        yield from (
            not kinds or any(hierarchy.overlap(one, kind) is not None for kind in kinds) for one in said.categories
        )


def told(what: WhatIf) -> str:
    """Return in few words how much is tried.

    >>> told(WhatIf(cut=(("p.xml", 3),), doubted=(("nodes", "/blur", ()),)))
    '1 line cut, 1 sanitizer doubted'
    """
    parts: dict[str, Sized] = {
        "change made": what.steps,
        "line cut": what.cut,
        "flow filtered": what.filters,
        "element added": what.elements,
    }
    more: dict[str, Sized] = {"flow added": what.flows, "sanitizer doubted": what.doubted}
    return ", ".join(_few(len(some), name) for name, some in {**parts, **more}.items() if some)


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
        problem = "is not about the same robots"
        raise InputErrors([InputError("what is tried", 0, problem, "try both on the same robots")])
    renamed = {name: _free(name, first, second) for name in second.elements}
    flows = tuple((_renamed(a, renamed), _renamed(b, renamed)) for a, b in second.flows)
    return WhatIf(
        cut=tuple(dict.fromkeys((*first.cut, *second.cut))),
        filters=tuple(dict.fromkeys((*first.filters, *second.filters))),
        elements={**first.elements, **{renamed[name]: said for name, said in second.elements.items()}},
        flows=(*first.flows, *(flow for flow in flows if flow not in first.flows)),
        doubted=tuple(dict.fromkeys((*first.doubted, *second.doubted))),
        steps=tuple(dict.fromkeys((*first.steps, *second.steps))),
        robots=first.robots,
    )


def _free(name: str, first: WhatIf, second: WhatIf) -> str:
    """A name for an element of the second: its own, unless the first has another element of that name."""
    if name not in first.elements or _told_of(name, first) == _told_of(name, second):
        return name
    taken = first.elements.keys() | second.elements.keys()
    return next(other for number in count(2) if (other := f"{name} {number}") not in taken)


def _told_of(name: str, what: WhatIf) -> object:
    return what.elements[name], [flow for flow in what.flows if name in map(_name_of, flow)]


def _renamed(end: End, names: Mapping[str, str]) -> End:
    return names.get(end, end) if isinstance(end, str) else {kind: names.get(of, of) for kind, of in end.items()}


def _name_of(end: End) -> str:
    return end if isinstance(end, str) else next(iter(end.values()))


def _few(number: int, name: str) -> str:
    noun, _, done = name.partition(" ")
    return f"{counted(number, noun)} {done}"
