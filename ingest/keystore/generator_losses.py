"""What is lost between a policy and lists of Zenoh, where it is lost as the known generator loses it.

In: a policy, the lists that are deployed, and what only one side says. Out: ``Loss``, sorted: which line does not
hold, and by which fault. Nothing is told of which no right differs.

Source: ``config_generator.cpp`` of zenoh_security_tools (ros2/rmw_zenoh, 2025), read line by line; until Humble 0.1.6
its keys ended with ``/**``.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.policies.names import covers, endpoints, overlaps

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.analysis.model import Grant, Place, Policy, Profile
    from rosprivacy.ingest.keystore.deployed_rights import Difference
    from rosprivacy.ingest.policies.names import Endpoint

DENY_ALLOWED, DENY_LOST, ACTION, ENCLAVE, ROLE, NAMESPACE, SAME_FILE, BELOW = (
    "deny-became-allow", "deny-not-written", "action-not-read", "enclave-not-read", "one-role-only",
    "namespace-not-applied", "one-file-for-two-nodes", "names-below",
)  # fmt: skip
FAULTS = {
    DENY_ALLOWED: "a DENY of publish is taken for an ALLOW",
    DENY_LOST: "a DENY is not written",
    ACTION: "actions are not read",
    ENCLAVE: "only the first enclave is read",
    ROLE: "of an element with two roles only one is read",
    NAMESPACE: "names get no namespace",
    SAME_FILE: "nodes with one base name write one file",
    BELOW: "keys that end with /** open all names below too",
}


class Loss(NamedTuple):
    """A line that does not hold as it stands there.

    Attributes
    ----------
    place
        Of the policy; of a list where it opens more.
    fault
        One of ``FAULTS``.
    """

    place: Place
    fault: str
    message: str


def generator_losses(
    stated: Iterable[Policy],
    deployed: Iterable[Policy],
    found: Iterable[Difference],
    who: Callable[[Grant], str],
) -> tuple[Loss, ...]:
    """Return the differences that the known generator makes, by the line that does not hold.

    Parameters
    ----------
    who
        The name of the list that a grant of the policy is held to.

    Notes
    -----
    O(lines of a node, times differences of its list).
    """
    stated, deployed = tuple(stated), tuple(deployed)
    lists = _by_name(deployed, lambda grant: grant.enclave)
    files = {profile.enclave: profile.place.file for policy in deployed for profile in policy.profiles}
    missing, more = _split(found)
    losses: list[Loss] = list(_profiles(stated, files))
    for name, grants in _by_name(stated, who).items():
        if name in files:
            deny = (_deny(grant, grants, more[name]) for grant in grants if not grant.allow)
            lost = (_lost(grant, missing[name], grants, lists[name], files[name]) for grant in grants if grant.allow)
            losses += chain.from_iterable(chain(deny, lost))
        losses += _below(more[name], lists[name])
    return tuple(sorted(set(losses)))


def _split(found: Iterable[Difference]) -> tuple[dict[str, list[Difference]], dict[str, list[Difference]]]:
    sides: dict[bool, dict[str, list[Difference]]] = {True: defaultdict(list), False: defaultdict(list)}
    for one in found:
        sides[one.stated][one.enclave].append(one)
    return sides[True], sides[False]


def _by_name(policies: Iterable[Policy], who: Callable[[Grant], str]) -> dict[str, list[Grant]]:
    grants: dict[str, list[Grant]] = defaultdict(list)
    for policy in policies:
        for grant in policy.grants:
            grants[who(grant)].append(grant)
    return grants


def _deny(grant: Grant, grants: Iterable[Grant], more: Iterable[Difference]) -> Iterator[Loss]:
    """A DENY of which the list allows something."""
    for end in _ends(grant):
        for extra in more:
            if extra.writes != end.writes or not overlaps(end.dds, extra.dds):
                continue
            allowed = any(covers(other.dds, end.dds) for one in grants if one.allow for other in _same_way(one, end))
            became = grant.role == "publish" and not allowed
            what = f"{shown(extra.place.file)}:{extra.place.line} allows {_named(extra)}"
            yield _loss(grant, DENY_ALLOWED if became else DENY_LOST, what)


def _lost(
    grant: Grant, missing: Iterable[Difference], grants: Iterable[Grant], there: list[Grant], file: str
) -> Iterator[Loss]:
    """An ALLOW that the list does not have, or not under this name."""
    lacking = {(one.writes, one.dds) for one in missing}
    ends = [end for end in _ends(grant) if (end.writes, end.dds) in lacking]
    if not ends:
        return
    if grant.kind == "action":
        yield _loss(grant, ACTION, f"{shown(file)} has nothing of it")
        return
    namespace = grant.node.rpartition("/")[0]
    plain = {(end.writes, end.dds) for end in _ends(grant, grant.name.removeprefix(namespace))}
    have = {(end.writes, end.dds) for one in there if one.allow for end in _ends(one)}
    if namespace and not grant.absolute and grant.name.startswith(f"{namespace}/") and have.issuperset(plain):
        yield _loss(grant, NAMESPACE, f"{shown(file)} has {shown(grant.name.removeprefix(namespace))}")
    elif any(_other_role(one, grant) for one in grants):
        yield _loss(grant, ROLE, f"{shown(file)} has it for the other role only")


def _profiles(stated: Iterable[Policy], files: dict[str, str]) -> Iterator[Loss]:
    """Profiles of which there is no list, or that share one."""
    for policy in stated:
        first: dict[str, Profile] = {}
        order = sorted(policy.profiles, key=lambda profile: (profile.place.file != policy.file, profile.place.line))
        for profile in order:
            base = f"/{profile.node.rpartition('/')[2]}"
            other = first.setdefault(base, profile)
            if other.node != profile.node and base in files:
                what = f"node {shown(other.node)} of line {other.place.line} has the same list {shown(files[base])}"
                yield _of_profile(profile, SAME_FILE, what)
            if profile.enclave != order[0].enclave and base not in files:
                yield _of_profile(profile, ENCLAVE, f"enclave {shown(profile.enclave)} has no list for it here")


def _below(more: Iterable[Difference], there: Iterable[Grant]) -> Iterator[Loss]:
    """Names below a name that the same line of a list opens."""
    opened = {(grant.place, grant.role == "publish", grant.name) for grant in there if grant.allow}
    for extra in more:
        base = extra.dds.removesuffix("/*")
        if base != extra.dds and (extra.place, extra.writes, base) in opened:
            message = f"line {_at(extra.place)} opens all names below {shown(extra.name.removesuffix('/*'))} too"
            yield Loss(extra.place, BELOW, f"{message}; {_known(BELOW)}")


def _ends(grant: Grant, name: str = "") -> tuple[Endpoint, ...]:
    return endpoints(grant.role, grant.kind, name or grant.name)


def _same_way(grant: Grant, end: Endpoint) -> Iterator[Endpoint]:
    return (one for one in _ends(grant) if one.writes == end.writes)


def _other_role(one: Grant, grant: Grant) -> bool:
    """Whether two lines are one element with two roles."""
    return one.allow and one.role != grant.role and (one.place, one.kind, one.name, one.node) == (
        grant.place, grant.kind, grant.name, grant.node,
    )  # fmt: skip


def _named(one: Difference) -> str:
    return f"to {'write' if one.writes else 'read'} {one.kind} {shown(one.name)}"


def _loss(grant: Grant, fault: str, what: str) -> Loss:
    line = f"line {_at(grant.place)} {'ALLOW' if grant.allow else 'DENY'} {grant.role} {grant.kind} {shown(grant.name)}"
    return Loss(grant.place, fault, f"{line}: {what}; {_known(fault)}")


def _of_profile(profile: Profile, fault: str, what: str) -> Loss:
    line = f"line {_at(profile.place)} profile {shown(profile.node)}"
    return Loss(profile.place, fault, f"{line}: {what}; {_known(fault)}")


def _known(fault: str) -> str:
    return f"a known loss of zenoh_security_tools: {FAULTS[fault]}"


def _at(place: Place) -> str:
    return f"{shown(place.file)}:{place.line}"
