"""Policies -> the same with something changed: enclaves split, a profile moved, DENY lines added (rules S5, S6).

In: policies as they were read, and a ``PolicyChange``. Out: policies, as if somebody had written them so.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Grant, Place

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from rosprivacy.analysis.findings.beyond import DenyLine
    from rosprivacy.analysis.model import Policy


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
