"""What the nodes of an enclave may do under the enforced view, told once for all that stand in the same ones (rule S6).

In: grants and profiles; later the flows of one node of each such group. Out: whose grants are looked at; then the flows
of all nodes: meetings of nodes and channels where these are many, stored flows where they are few.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import Right, sharing

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Flow, Grant, Profile

STORED = 2  # times its members a group of nodes and channels may have flows that are stored


def alike(profiles: Iterable[Profile], alone: Container[str]) -> dict[str, tuple[str, ...]]:
    """Return the nodes that stand in the same enclaves, by the first of them.

    Parameters
    ----------
    alone
        Nodes that are like no other.
    """
    enclaves: dict[str, set[str]] = defaultdict(set)
    for profile in profiles:
        enclaves[profile.node].add(profile.enclave)
    groups: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for node in sorted(enclaves):
        held = ("" if node not in alone else node, *sorted(enclaves[node]))
        groups[held].append(node)
    return {nodes[0]: tuple(nodes) for nodes in groups.values()}


def enforced(
    grants: Iterable[Grant], profiles: Iterable[Profile], firsts: Container[str]
) -> Iterator[tuple[str, Grant]]:
    """Yield (node, grant): which node may use which grant of its enclaves; of nodes that are alike the first one."""
    members: dict[str, list[str]] = defaultdict(list)
    for enclave, node in sorted({(profile.enclave, profile.node) for profile in profiles}):
        if node in firsts:
            members[enclave].append(node)
    for grant in grants:
        yield from ((node, grant) for node in members[grant.enclave])


def shared(flows: Iterable[Flow], groups: Mapping[int, Sequence[int]]) -> tuple[list[Flow], list[Meeting]]:
    """Return the flows of all nodes: those to store, and meetings of those that share many.

    Parameters
    ----------
    flows
        Of the first node of each group, and others.
    groups
        First node -> all nodes that are like it, sorted; by index.
    """
    stored: list[Flow] = []
    sides: dict[tuple[int, bool], dict[int, list[Flow]]] = defaultdict(lambda: defaultdict(list))
    for flow in flows:
        writes = flow.source in groups
        if writes or flow.target in groups:
            node, channel = (flow.source, flow.target) if writes else (flow.target, flow.source)
            sides[node, writes][channel].append(flow)
        else:
            stored.append(flow)
    meetings: list[Meeting] = []
    for (node, writes), of in sides.items():
        nodes = groups[node]
        single = sorted(channel for channel, roles in of.items() if len(roles) == 1)
        if len(nodes) * len(single) > STORED * (len(nodes) + len(single)):
            rights = tuple(Right(flow.role, flow.grants) for channel in single for flow in of.pop(channel))
            meetings.append(sharing(tuple(nodes), tuple(single), rights, writes=writes))
        stored += of_each((flow for some in of.values() for flow in some), {node: nodes})
    return stored, meetings


def of_each(flows: Iterable[Flow], groups: Mapping[int, Sequence[int]]) -> Iterator[Flow]:
    """Yield the flows of all nodes one by one; as of ``shared``."""
    for flow in flows:
        if flow.source in groups:
            yield from (flow._replace(source=node) for node in groups[flow.source])
        elif flow.target in groups:
            yield from (flow._replace(target=node) for node in groups[flow.target])
        else:
            yield flow
