"""What a policy says and what is deployed, side by side: the rights that only one of them has, and how they were lost.

In: policies of both sides. Out: ``GrantDifference`` by enclave, and ``Loss`` by the line that does not hold; sorted. Of
a plain name it is exact. A wildcard of one side is held by the other if one expression there covers it and nothing is
taken out of it there that is not taken out here too; else it is told, also where several expressions together would do
(rules S4, S5). A loss is a difference that the known generator of Zenoh's lists makes.

Source: ``config_generator.cpp`` of zenoh_security_tools (ros2/rmw_zenoh, 2025), read line by line; until Humble 0.1.6
its keys ended with ``/**``.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.policies.names import covers, endpoints, is_pattern, overlaps

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.analysis.model import Grant, Place, Policy, Profile
    from rosprivacy.ingest.policies.names import Endpoint

ADDED = "ros_discovery_info"  # by sros2, to the permissions of every enclave


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


class GrantDifference(NamedTuple):
    """A right that one side has and the other has not.

    Attributes
    ----------
    stated
        Whether the policy has it; else what is deployed has it.
    writes
        Whether it is to write; else to read.
    place
        The line that grants it.
    """

    enclave: str
    stated: bool
    writes: bool
    kind: str
    name: str
    leg: str
    dds: str
    place: Place


def differences(
    stated: Iterable[Policy], deployed: Iterable[Policy], name_of: Callable[[Grant], str] = lambda grant: grant.enclave
) -> tuple[GrantDifference, ...]:
    """Return what differs, by enclave.

    Parameters
    ----------
    name_of
        Under which name a grant of the policy is compared.

    Notes
    -----
    Linear in plain names; O(rights of an enclave, times wildcards and DENY lines of the other side) beside that.
    """
    ours, theirs = (
        {name: _RightsOfNode(grants) for name, grants in _by_name(policies, by).items()}
        for policies, by in ((stated, name_of), (deployed, lambda grant: grant.enclave))
    )
    found: set[GrantDifference] = set()
    for enclave in sorted({*ours, *theirs}):
        first, second = ours.get(enclave, _NO_RIGHTS), theirs.get(enclave, _NO_RIGHTS)
        for one, other, is_stated in ((first, second, True), (second, first, False)):
            for grant, end in one.rights():
                if end.dds != ADDED and not other.holds(end, one.takes_out(grant, end)):
                    of_end = end.writes, end.kind, end.name, end.leg, end.dds
                    found.add(GrantDifference(enclave, is_stated, *of_end, grant.place))
    return tuple(sorted(found))


def _by_name(policies: Iterable[Policy], name_of: Callable[[Grant], str]) -> dict[str, list[Grant]]:
    grants: dict[str, list[Grant]] = defaultdict(list)
    for policy in policies:
        for grant in policy.grants:
            grants[name_of(grant)].append(grant)
    return grants


class _RightsOfNode:
    """What the lines of an enclave allow and deny."""

    def __init__(self, grants: Iterable[Grant]) -> None:
        self.allowed: list[tuple[Grant, Endpoint]] = []
        self.denied: list[tuple[Grant, Endpoint]] = []
        for grant in grants:
            ends = [(grant, end) for end in endpoints(grant.role, grant.kind, grant.name)]
            if grant.allow:
                self.allowed += ends
            elif not grant.dead:
                self.denied += ends
        self.patterns = [one for one in self.allowed if is_pattern(one[1].dds)]
        self.plain: dict[tuple[bool, str], list[tuple[Grant, Endpoint]]] = defaultdict(list)
        for one in self.allowed:
            self.plain[one[1].writes, one[1].dds].append(one)

    def rights(self) -> Iterator[tuple[Grant, Endpoint]]:
        """What is allowed and not denied whole."""
        for grant, end in self.allowed:
            if not any(covers(dds, end.dds) for dds in self.takes_out(grant, end)):
                yield grant, end

    def takes_out(self, grant: Grant, end: Endpoint) -> list[str]:
        """The DDS names and expressions that DENY lines take out of what a line opens."""
        return [
            denied.dds
            for line, denied in self.denied
            if (denied.writes, line.policy) == (end.writes, grant.policy)
            and line.rank <= grant.rank
            and overlaps(denied.dds, end.dds)
        ]

    def holds(self, end: Endpoint, without: Iterable[str]) -> bool:
        """Whether there is a line that opens all that another opens, but for what that one takes out itself."""
        without = list(without)
        near = [*self.plain.get((end.writes, end.dds), ()), *self.patterns]
        for grant, own in near:
            if own.writes == end.writes and covers(own.dds, end.dds):
                lost = [dds for dds in self.takes_out(grant, own) if overlaps(dds, end.dds)]
                if all(any(covers(taken, dds) for taken in without) for dds in lost):
                    return True
        return False


_NO_RIGHTS = _RightsOfNode(())


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
    differences: Iterable[GrantDifference],
    name_of: Callable[[Grant], str],
) -> tuple[Loss, ...]:
    """Return the differences that the known generator makes, by the line that does not hold.

    Parameters
    ----------
    name_of
        The name of the list that a grant of the policy is held to.

    Notes
    -----
    O(lines of a node, times differences of its list).
    """
    stated, deployed = tuple(stated), tuple(deployed)
    lists = _by_name(deployed, lambda grant: grant.enclave)
    files = {profile.enclave: profile.place.file for policy in deployed for profile in policy.profiles}
    missing: dict[str, list[GrantDifference]] = defaultdict(list)
    more: dict[str, list[GrantDifference]] = defaultdict(list)
    for one in differences:
        (missing if one.stated else more)[one.enclave].append(one)
    losses: list[Loss] = list(_profiles(stated, files))
    for name, grants in _by_name(stated, name_of).items():
        if name in files:
            deny = (_deny(grant, grants, more[name]) for grant in grants if not grant.allow)
            lost = (_lost(grant, missing[name], grants, lists[name], files[name]) for grant in grants if grant.allow)
            losses += chain.from_iterable(chain(deny, lost))
        losses += _below(more[name], lists[name])
    return tuple(sorted(set(losses)))


def _deny(grant: Grant, grants: Iterable[Grant], differences: Iterable[GrantDifference]) -> Iterator[Loss]:
    """A DENY of which the list allows something."""
    for end in _ends(grant):
        for extra in differences:
            if extra.writes != end.writes or not overlaps(end.dds, extra.dds):
                continue
            ends = (other for one in grants if one.allow for other in _ends(one))
            allowed = any(other.writes == end.writes and covers(other.dds, end.dds) for other in ends)
            became = grant.role == "publish" and not allowed
            what = f"to {'write' if extra.writes else 'read'} {extra.kind} {shown(extra.name)}"
            what = f"{_at(extra.place)} allows {what}"
            yield _of_grant(grant, DENY_ALLOWED if became else DENY_LOST, what)


def _lost(
    grant: Grant, missing: Iterable[GrantDifference], grants: Iterable[Grant], listed: list[Grant], file: str
) -> Iterator[Loss]:
    """An ALLOW that the list does not have, or not under this name."""
    lacking = {(one.writes, one.dds) for one in missing}
    ends = [end for end in _ends(grant) if (end.writes, end.dds) in lacking]
    if not ends:
        return
    if grant.kind == "action":
        yield _of_grant(grant, ACTION, f"{shown(file)} has nothing of it")
        return
    namespace = grant.node.rpartition("/")[0]
    plain = {(end.writes, end.dds) for end in _ends(grant, grant.name.removeprefix(namespace))}
    have = {(end.writes, end.dds) for one in listed if one.allow for end in _ends(one)}
    if namespace and not grant.absolute and grant.name.startswith(f"{namespace}/") and have.issuperset(plain):
        yield _of_grant(grant, NAMESPACE, f"{shown(file)} has {shown(grant.name.removeprefix(namespace))}")
    elif any(_other_role(one, grant) for one in grants):
        yield _of_grant(grant, ROLE, f"{shown(file)} has it for the other role only")


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


def _below(differences: Iterable[GrantDifference], listed: Iterable[Grant]) -> Iterator[Loss]:
    """Names below a name that the same line of a list opens."""
    opened = {(grant.place, grant.role == "publish", grant.name) for grant in listed if grant.allow}
    for extra in differences:
        base = extra.dds.removesuffix("/*")
        if base != extra.dds and (extra.place, extra.writes, base) in opened:
            message = f"line {_at(extra.place)} opens all names below {shown(extra.name.removesuffix('/*'))} too"
            yield _loss(extra.place, BELOW, message)


def _ends(grant: Grant, name: str = "") -> tuple[Endpoint, ...]:
    return endpoints(grant.role, grant.kind, name or grant.name)


def _other_role(line: Grant, grant: Grant) -> bool:
    """Whether two lines are one element with two roles."""
    return line.allow and line.role != grant.role and (line.place, line.kind, line.name, line.node) == (
        grant.place, grant.kind, grant.name, grant.node,
    )  # fmt: skip


def _of_grant(grant: Grant, fault: str, message: str) -> Loss:
    line = f"line {_at(grant.place)} {'ALLOW' if grant.allow else 'DENY'} {grant.role} {grant.kind} {shown(grant.name)}"
    return _loss(grant.place, fault, f"{line}: {message}")


def _of_profile(profile: Profile, fault: str, message: str) -> Loss:
    return _loss(profile.place, fault, f"line {_at(profile.place)} profile {shown(profile.node)}: {message}")


def _loss(place: Place, fault: str, message: str) -> Loss:
    return Loss(place, fault, f"{message}; a known loss of zenoh_security_tools: {FAULTS[fault]}")


def _at(place: Place) -> str:
    return f"{shown(place.file)}:{place.line}"
