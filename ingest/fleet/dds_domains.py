"""Robots that share a DDS domain -> one graph: channels of one name are one channel (rule S1).

In: what each robot runs, and its own graph with what labels say. Out: a ``Part`` in which nodes belong to their robot,
channels under a robot's namespace to that robot, and all others to the domain. Wildcards of one robot reach what
others write and read (rule S4); a DENY holds for the enclaves of its own robot (rule S5).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.model import Bound, Element, FlowGraph
from rosprivacy.ingest.fleet.mergeable_graph import Part, together
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.namespaces import as_written, pushed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Diagnostic, Flow, Grant, Policy, Profile
    from rosprivacy.ingest.fleet.fleet_file import Robot
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.types.types_file import TypesFile

MARK = "\0"  # between robot and name; no policy has it


@dataclass(frozen=True, slots=True)
class Member:
    """A robot with its own graph.

    Attributes
    ----------
    policies
        As they are written.
    graph
        Its elements under the names that labels and reports use, without its namespace.
    bound
        What is said of it.
    full
        The elements of ROS -> the same under their full names.
    profiles
        Of the policies, with the nodes under the names of ``graph``.
    files
        Its label files.
    diagnostics
        Of its policies and label files.
    types
        Its files of observed message types.
    pushed
        The namespace that stands before names of its lines: that of the robot for which its policies were read.
    """

    robot: Robot
    policies: tuple[Policy, ...]
    graph: FlowGraph
    bound: Bound
    full: Mapping[Element, Element]
    profiles: tuple[Profile, ...] = ()
    files: tuple[Labels, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    types: tuple[TypesFile, ...] = ()
    pushed: str = ""


def stripped(graph: FlowGraph, namespace: str) -> tuple[FlowGraph, dict[Element, Element]]:
    """Take a namespace off the names of a graph; one that would then be there twice keeps it.

    Returns
    -------
    graph, full
        The graph, sorted anew; and its elements -> those of the graph given.
    """
    if not namespace:
        return graph, {element: element for element in graph.elements}
    taken = set(graph.elements)
    shown = {}
    for element in graph.elements:
        new = replace(element, name=_without(element.name, namespace))
        shown[element] = element if new in taken else new
    elements = tuple(sorted(shown.values(), key=Element.sort_key))
    number = {element: i for i, element in enumerate(elements)}
    moved = [number[shown[element]] for element in graph.elements]

    def renumbered(flows: Sequence[Flow]) -> tuple[Flow, ...]:
        new = [flow._replace(source=moved[flow.source], target=moved[flow.target]) for flow in flows]
        return tuple(sorted(new, key=lambda flow: (flow.source, flow.target, flow.role)))

    nodes = {element.name: new.name for element, new in shown.items() if element.is_node}
    profiles = tuple(profile._replace(node=nodes[profile.node]) for profile in graph.profiles)
    changed = FlowGraph(
        elements, renumbered(graph.flows), renumbered(graph.denied), profiles, graph.view,
        renumbered(graph.denied_matches), graph.careful,
    )  # fmt: skip
    return changed, {new: element for element, new in shown.items()}


def _with_grants(part: Part, change: Callable[[Grant], Grant]) -> Part:
    """A part with other grants."""
    flows = {key: tuple(map(change, grants)) for key, grants in part.flows.items()}
    denied = {key: (tuple(map(change, a)), tuple(map(change, b))) for key, (a, b) in part.denied.items()}
    return replace(part, flows=flows, denied=denied)


def _without(name: str, namespace: str) -> str:
    return name[len(namespace) :] if name.startswith(f"{namespace}/") else name


def alone(member: Member) -> Part:
    """The part of a robot that has a domain of its own: everything in it is the robot's."""
    robot = member.robot.id

    def own(e: Element) -> Element:  # as replace(e, robot=robot), in a third of the time
        return Element(e.kind, e.name, robot, e.leg, e.side, e.without)

    return _part(member, own)


def pseudo_robot(domain: str) -> str:
    """Return the name under which a domain's own channels are filed; no robot can have it."""
    return f"domain {domain}"


def called_in_fleet(members: Sequence[Member]) -> Iterator[tuple[Member, Callable[[Element], Element]]]:
    """Yield robots with what gives elements of their own graph the names that they have in the fleet."""
    domains: dict[str, list[Member]] = defaultdict(list)
    for member in members:
        if member.robot.domain:
            domains[member.robot.domain].append(member)
        else:
            yield member, partial(replace, robot=member.robot.id)
    for domain, some in domains.items():
        names = _DomainNames(domain, some)
        yield from ((member, names.of_member(member)) for member in some)


def is_domain(name: str) -> bool:
    """Return whether channels of a domain are filed under a name."""
    return name.startswith(pseudo_robot(""))


def shared(domain: str, members: Sequence[Member], view: str, bounds: Bounds = BOUNDS) -> Part:
    """The part of robots that share a domain."""
    names = _DomainNames(domain, members)
    graph = build([_marked(policy, member.robot) for member in members for policy in member.policies], view, bounds)
    added = {member.robot.id: member.robot.add for member in members}

    def unmarked(grant: Grant) -> Grant:
        robot, node = grant.node.split(MARK)
        return as_written(grant._replace(enclave=grant.enclave.rpartition(MARK)[2], node=node), added[robot])

    whole = _with_grants(Part.of(graph, Bound({}), names.of_marked), unmarked)
    return together([whole, *(_part(member, names.of_member(member)) for member in members)])


def _part(member: Member, name: Callable[[Element], Element]) -> Part:
    """The part of a robot under the names of the fleet, with the lines as its policies write them.

    Message types are told of the writers of this robot: of others in its domain they say nothing.
    """
    part, robot = Part.of(member.graph, member.bound, name), member.robot.id
    part.types = {e: tuple(one._replace(robot=robot) for one in some) for e, some in part.types.items()}
    return _with_grants(part, lambda grant: as_written(grant, member.pushed)) if member.pushed else part


class _DomainNames:
    """What the elements of a domain are called in the fleet."""

    def __init__(self, domain: str, members: Sequence[Member]) -> None:
        self._domain = pseudo_robot(domain)
        spaces = [(member.robot.strip or member.robot.add, member.robot.id) for member in members]
        count = Counter(space for space, _ in spaces)
        own = [(space, robot) for space, robot in spaces if space and count[space] == 1]  # two of one name share it
        self._owners = sorted(own, key=lambda pair: len(pair[0]), reverse=True)
        full = ((m.robot.id, shown, full) for m in members for shown, full in m.full.items())
        self._nodes = {(robot, full.name): shown for robot, shown, full in full if shown.is_node}
        stated = ((member.robot.id, element) for member in members for element in member.graph.elements)
        self._nodes |= {(robot, e.name): e for robot, e in stated if not (e.is_node or e.is_channel)}

    def of_marked(self, element: Element) -> Element:
        """The name of an element of the graph of all policies."""
        if element.is_channel:
            return self._channel(element)
        robot, name = element.name.split(MARK)
        return replace(self._nodes[robot, name], robot=robot)

    def of_member(self, member: Member) -> Callable[[Element], Element]:
        """The name of an element of a robot's own graph."""

        def name(element: Element) -> Element:
            if not element.is_channel:
                return replace(element, robot=member.robot.id)
            return self._channel(member.full[element])

        return name

    def _channel(self, full: Element) -> Element:
        for space, robot in self._owners:
            name = _without(full.name, space)
            if name != full.name:
                return replace(full, name=name, robot=robot)
        return replace(full, robot=self._domain)


def _marked(policy: Policy, robot: Robot) -> Policy:
    """A policy as the robot runs it, in which enclaves and nodes are told from those of other robots."""
    mark, run = f"{robot.id}{MARK}", pushed(policy, robot.add)
    return replace(
        run,
        profiles=tuple(
            p._replace(enclave=mark + p.enclave, node=mark + p.node, participant=p.participant and mark + p.participant)
            for p in run.profiles
        ),
        grants=tuple(g._replace(enclave=mark + g.enclave, node=mark + g.node) for g in run.grants),
    )
