"""Enclaves -> one enclave for each of their nodes: what would be if somebody split them (rule S6).

In: policies and the paths of enclaves. Out: the same policies, in which each node of these has an enclave of its own. A
DENY of the enclave goes with each of its nodes, so that splitting alone opens nothing.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from rosprivacy.analysis.model import Grant, Policy


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
