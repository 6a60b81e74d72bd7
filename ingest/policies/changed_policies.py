"""Policies -> the same with something changed: enclaves split, a profile moved, DENY lines added; and their graph.

In: policies as they were read, a ``PolicyChange``, and the graph of the enforced view that was built of them. Out:
policies, as if somebody had written them so; the graph that ``build`` makes of these, but for the names of new
enclaves, or None where only that tells: a DENY of a wildcard or of a new name makes other elements, rules of
permissions have an order, an endpoint of no node may be several profiles (rules S4 to S6).
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import Flows, Right, parted, sharing
from rosprivacy.analysis.model import Flow, Grant, Place
from rosprivacy.ingest.policies.names import covers, endpoints, is_pattern

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.findings.beyond import DenyLine
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Element, FlowGraph, Policy


class PolicyChange(NamedTuple):
    """What somebody could change.

    Attributes
    ----------
    split
        Enclaves, each into one for each of its nodes.
    move
        (enclave, node) of profiles that get an enclave of their own.
    deny
        Lines that are added.
    """

    split: frozenset[str] = frozenset()
    move: frozenset[tuple[str, str]] = frozenset()
    deny: frozenset[DenyLine] = frozenset()


NO_CHANGE = PolicyChange()


def changed(policies: Iterable[Policy], change: PolicyChange) -> tuple[Policy, ...]:
    """Return policies with a change; DENY lines of an enclave go with each node that leaves it, so it opens nothing."""
    policies = tuple(policies)
    if change.split:
        policies = split(policies, change.split)
    if change.move:
        policies = tuple(_moved(policy, change.move) for policy in policies)
    if change.deny:
        policies = tuple(_denied(policy, change.deny) for policy in policies)
    return policies


def _moved(policy: Policy, move: frozenset[tuple[str, str]]) -> Policy:
    profiles = tuple(
        one._replace(enclave=own_enclave(one.enclave, one.node)) if (one.enclave, one.node) in move else one
        for one in policy.profiles
    )
    return replace(policy, profiles=profiles, grants=tuple(new for one in policy.grants for new in _reduced(one, move)))


def _reduced(grant: Grant, move: frozenset[tuple[str, str]]) -> Iterator[Grant]:
    """An ALLOW goes with its profile; a DENY stays for those who stay, and goes with each who goes."""
    own = (grant.enclave, grant.node) in move
    if not (grant.allow and own):
        yield grant
    for enclave, node in sorted(move):
        if enclave == grant.enclave and (node == grant.node if grant.allow else True):
            yield grant._replace(enclave=own_enclave(enclave, node), node=node)


def _denied(policy: Policy, deny: frozenset[DenyLine]) -> Policy:
    place = Place(policy.file, 0)
    new = (
        Grant(
            allow=False, role=one.role, kind=one.kind, name=one.name, enclave=one.enclave, node=one.node, place=place,
            policy=policy.file, absolute=True,
        )
        for one in sorted(deny)
        if one.policy == policy.file
    )  # fmt: skip
    return replace(policy, grants=(*policy.grants, *new))


def split(policies: Iterable[Policy], enclaves: Collection[str]) -> tuple[Policy, ...]:
    """Return policies with some enclaves split.

    Notes
    -----
    Linear, but for the DENY lines of an enclave, which are there once for each of its nodes.
    """
    policies = tuple(policies)
    nodes: dict[str, set[str]] = {enclave: set() for enclave in enclaves}
    for profile in (profile for policy in policies for profile in policy.profiles):
        if profile.enclave in nodes:
            nodes[profile.enclave].add(profile.node)
    return tuple(
        replace(
            policy,
            profiles=tuple(
                one._replace(enclave=own_enclave(one.enclave, one.node)) if one.enclave in nodes else one
                for one in policy.profiles
            ),
            grants=tuple(of_node for one in policy.grants for of_node in _split(one, nodes)),
        )
        for policy in policies
    )


def _split(grant: Grant, nodes: dict[str, set[str]]) -> Iterator[Grant]:
    if grant.enclave not in nodes:
        yield grant
        return
    of = {grant.node} if grant.allow else {grant.node, *nodes[grant.enclave]}
    for node in sorted(of):
        yield grant._replace(enclave=own_enclave(grant.enclave, node), node=node)


def own_enclave(enclave: str, node: str) -> str:
    """Return the path of the enclave that a node gets for itself."""
    return f"{enclave} {node}"  # no enclave has a space


ANYONE = ""  # a node that no change is about by its name
_ends = attrgetter("source", "target", "role")  # of a flow
Where = tuple[str, str, bool]  # policy, enclave, whether it is about writing


def changed_graph(graph: FlowGraph, policies: Sequence[Policy], change: PolicyChange) -> FlowGraph | None:
    """Return the graph after a change, None where the policies have to be looked at anew; O(flows that are stored).

    Parameters
    ----------
    graph
        Of the enforced view; with what labels add.
    """
    kept = _Kept.of(policies, change, graph.elements)
    if kept is None:
        return None
    vertices = {element.name: vertex for vertex, element in enumerate(graph.elements) if element.is_node}
    own, meetings = parted(graph.flows)
    stored = [flow for _, old in own if (flow := kept.flow(old, graph.elements)) is not None]
    left: list[Meeting] = []
    for meeting in meetings:
        if meeting.of_wildcards:
            left.append(meeting)
            continue
        shared, single = kept.meeting(meeting, graph.elements, vertices)
        left += shared
        stored += single
    flows: Sequence[Flow] = tuple(sorted(stored, key=_ends))
    if isinstance(graph.flows, Flows) and left:
        met = tuple(sorted(left, key=lambda one: (one.written, one.read)))
        flows = replace(graph.flows, stored=tuple(flows), meetings=met)
    return replace(graph, flows=flows)


@dataclass(frozen=True, slots=True)
class _Kept:
    """Which grants a node still has.

    Attributes
    ----------
    change
        What changes.
    enclaves
        Those that change in some way.
    denied
        The DDS topics of new DENY lines.
    channels
        Which these are; None where enclaves are split or profiles go: all.
    moved
        Nodes of profiles that go.
    """

    change: PolicyChange
    enclaves: frozenset[str]
    denied: Mapping[Where, frozenset[str]]
    channels: frozenset[int] | None
    moved: frozenset[str]

    @classmethod
    def of(cls, policies: Iterable[Policy], change: PolicyChange, elements: Iterable[Element]) -> _Kept | None:
        denied: dict[Where, set[str]] = defaultdict(set)
        names = set()
        for line in change.deny:
            for end in endpoints(line.role, line.kind, line.name):
                denied[line.policy, line.enclave, end.writes].add(end.dds)
                names.add((end.kind, end.name, end.leg))
        channels = frozenset(v for v, e in enumerate(elements) if (e.kind, e.name, e.leg) in names)
        policies = tuple(policies)
        if any(profile.participant for policy in policies for profile in policy.profiles):
            return None
        if change.deny and (len(channels) < len(names) or not _plain(policies, change, denied)):
            return None
        return cls(
            change,
            frozenset({*change.split, *(of for of, _ in change.move), *(line.enclave for line in change.deny)}),
            {where: frozenset(some) for where, some in denied.items()},
            None if change.split or change.move else channels,
            frozenset(node for _, node in change.move),
        )

    def flow(self, flow: Flow, elements: Sequence[Element]) -> Flow | None:
        """Return a flow with the grants that are left; None if it had some and none is."""
        if not self._touches(flow.grants):
            return flow
        writes = elements[flow.target].is_channel
        ends = (flow.source, flow.target) if writes else (flow.target, flow.source)
        node, channel = (elements[end] for end in ends)
        grants = self._without_removed(flow.grants, node.name, channel, writes=writes)
        return flow._replace(grants=grants) if grants else None

    def meeting(
        self, meeting: Meeting, elements: Sequence[Element], vertices: Mapping[str, int]
    ) -> tuple[list[Meeting], list[Flow]]:
        """Return what nodes and channels still share, and the flows of single nodes."""
        if self.channels is not None and self.channels.isdisjoint((*meeting.written, *meeting.read)):
            return [meeting], []
        writes = bool(meeting.of_read)
        nodes, channels, rights = (
            (meeting.written, meeting.read, meeting.of_read)
            if writes
            else (meeting.read, meeting.written, meeting.of_written)
        )
        names = {vertex: elements[vertex].name for vertex in nodes}
        movers = [vertex for vertex in nodes if names[vertex] in self.moved]
        others = tuple(vertex for vertex in nodes if names[vertex] not in self.moved)
        shared: dict[int, Right] = {}
        single: list[Flow] = []
        for channel, right in zip(channels, rights, strict=True):
            touched = (self.channels is None or channel in self.channels) and self._touches(right.grants)
            left = (
                self._without_removed(right.grants, ANYONE, elements[channel], writes=writes)
                if touched
                else right.grants
            )
            owners = self._owners(right.grants, vertices).intersection(others) if touched else set()
            if left and not owners:
                shared[channel] = right._replace(grants=left)
            for node in (*movers, *(others if left and owners else owners)):
                own = self._without_removed(right.grants, names[node], elements[channel], writes=writes)
                source, target = (node, channel) if writes else (channel, node)
                single += [Flow(source, target, right.role, own)] if own else []
        if not shared or not others:
            return [], single
        return [sharing(others, tuple(shared), tuple(shared.values()), writes=writes)], single

    def _touches(self, grants: Iterable[Grant]) -> bool:
        """Whether the change is about an enclave of some grants at all."""
        return any(grant.enclave in self.enclaves for grant in grants)

    def _owners(self, grants: Iterable[Grant], vertices: Mapping[str, int]) -> set[int]:
        """The nodes that keep a grant of an enclave that is split, since it is their own."""
        return {vertices[grant.node] for grant in grants if grant.enclave in self.change.split}

    def _without_removed(
        self, grants: Iterable[Grant], node: str, channel: Element, *, writes: bool
    ) -> tuple[Grant, ...]:
        return tuple(one for one in grants if self._has(node, one) and self._open(one, channel, writes=writes))

    def _has(self, node: str, grant: Grant) -> bool:
        if grant.enclave in self.change.split and grant.node != node:
            return False
        return all(grant.enclave != of or (grant.node == one) == (node == one) for of, one in self.change.move)

    def _open(self, grant: Grant, channel: Element, *, writes: bool) -> bool:
        """Whether no new DENY is about all of what a grant opens at a channel."""
        denied = self.denied.get((grant.policy, grant.enclave, writes))
        return not denied or any(
            end.dds not in denied
            for end in endpoints(grant.role, grant.kind, grant.name)
            if (end.writes, end.kind, end.name, end.leg) == (writes, channel.kind, channel.name, channel.leg)
        )


def _plain(policies: Iterable[Policy], change: PolicyChange, denied: Mapping[Where, Iterable[str]]) -> bool:
    """Whether new DENY lines and the grants that they are about have no wildcards, nor an order."""
    if any(is_pattern(line.name) for line in change.deny):
        return False
    about = {(policy, enclave) for policy, enclave, _ in denied}
    return not any(
        grant.rank or (is_pattern(grant.name) and _met(grant, denied))
        for policy in policies
        for grant in policy.grants
        if (grant.policy, grant.enclave) in about
    )


def _met(grant: Grant, denied: Mapping[Where, Iterable[str]]) -> bool:
    return any(
        covers(end.dds, dds)
        for end in endpoints(grant.role, grant.kind, grant.name)
        for dds in denied.get((grant.policy, grant.enclave, end.writes), ())
    )
