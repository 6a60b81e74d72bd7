"""What is granted against what was seen in use: what runs and is not granted, and what is granted and was never seen.

In: policies, and policies that were made of observations. Out: uses and grants (rules S3 to S6, S16). What was not seen
proves nothing, so of nodes that were never seen running nothing is proposed; and a DENY holds for its whole enclave, so
a line is proposed to be denied only if that takes nothing from anybody else.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from rosprivacy.analysis.modes import View
from rosprivacy.ingest.policies.names import covers, endpoints, is_pattern, overlaps
from rosprivacy.ingest.running.node_info import DOOR
from rosprivacy.ingest.running.observed_names import plain_name

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Grant, Policy
    from rosprivacy.ingest.policies.names import Endpoint

ACTION_PARTS = "_action"
NOT_GRANTED, DENIED, NO_PROFILE = "not-granted", "denied", "no-profile"
Part = tuple[str, bool, str]  # node, whether it writes, DDS name
Place = tuple[str, str, bool, str]  # policy, enclave, whether it writes, DDS name or expression


@dataclass(frozen=True, slots=True)
class Use:
    """What runs and is not granted.

    Attributes
    ----------
    grant
        As it was seen.
    why
        ``NO_PROFILE``: the policies do not know the node; ``DENIED``: they deny it; else ``NOT_GRANTED``.
    lines
        The DENY lines.
    """

    grant: Grant
    why: str
    lines: tuple[Grant, ...] = ()


@dataclass(frozen=True, slots=True)
class Usage:
    """The comparison; everything is sorted.

    Attributes
    ----------
    not_granted
        What runs and is not granted.
    unused
        ALLOW lines of nodes that were seen running, of which nothing was ever seen; those that are denied are none.
    to_deny
        Those of them that can be denied without taking anything from others of their enclave, but for ``hidden``.
    hidden
        Those of them of which nothing can be known: a text of ``ros2 node info`` has hidden names only if that was
        asked to, and no name of this observation is hidden.
    never_seen
        Nodes that have a profile and were never seen running -> how many lines allow them something.
    """

    not_granted: tuple[Use, ...]
    unused: tuple[Grant, ...]
    to_deny: tuple[Grant, ...]
    never_seen: Mapping[str, int]
    hidden: frozenset[Grant] = frozenset()


def usage(granted: Iterable[Policy], observed: Iterable[Policy], view: str = View.declared) -> Usage:
    """Compare policies with what was seen.

    Parameters
    ----------
    view
        ``declared``: a node may do what its own profile says; ``enforced``: what any profile of its enclave says.
    """
    granted = tuple(granted)
    seen = [grant for policy in observed for grant in policy.grants if grant.observation]
    rights = _UsedRights(granted, view)
    not_granted = tuple(sorted(filter(None, map(rights.missing, seen)), key=lambda use: _key(use.grant)))
    used: dict[str, set[tuple[bool, str]]] = defaultdict(set)
    for node in {plain_name(profile.node)[0] for policy in observed for profile in policy.profiles}:
        used[node] = set()
    for grant in seen:
        used[plain_name(grant.node)[0]].update((end.writes, end.dds) for end in _ends(grant))
    lines = [grant for policy in granted for grant in policy.grants if grant.allow and rights.is_effective(grant)]
    unused, never = [], defaultdict(int)
    for node in sorted({profile.node for policy in granted for profile in policy.profiles}):
        if plain_name(node)[0] not in used:
            never[node] = 0
    for grant in lines:
        own = used.get(plain_name(grant.node)[0])
        if own is None:
            never[grant.node] += 1
        elif not _is_used(grant, own):
            unused.append(grant)
    hidden = frozenset(filter(_is_hidden, unused if _lacks_hidden(seen) else ()))
    known = [grant for grant in unused if grant not in hidden]
    return Usage(
        not_granted,
        tuple(sorted(unused, key=_key)),
        _deniable(granted, known, seen),
        dict(sorted(never.items())),
        hidden,
    )


def _lacks_hidden(observation: Iterable[Grant]) -> bool:
    """Whether an observation may have left out hidden names: only texts tell of it, and they have none."""
    doors = {door for grant in observation if grant.observation for door in grant.observation.by}
    return doors <= {DOOR} and not any(map(_is_hidden, observation))


def _is_hidden(grant: Grant) -> bool:
    """Whether ROS hides a name: a part of it begins with ``_``; what actions are made of, texts tell as actions."""
    parts = grant.name.split("/")
    return any(part.startswith("_") and part != ACTION_PARTS for part in parts)


def _ends(grant: Grant) -> Sequence[Endpoint]:
    """What a line opens, without what a listed generator made up at one start."""
    return endpoints(grant.role, grant.kind, _steady(grant.name))


@cache
def _steady(name: str) -> str:
    return "/".join(plain_name(f"/{part}")[0][1:] for part in name.split("/")) if "_" in name else name


def _is_used(grant: Grant, used: Collection[tuple[bool, str]]) -> bool:
    ends = _ends(grant)
    if not is_pattern(grant.name):
        return any((end.writes, end.dds) in used for end in ends)
    return any(end.writes == writes and covers(end.dds, dds) for end in ends for writes, dds in used)


class _UsedRights:
    """What the policies allow and deny, by the node that may use it."""

    def __init__(self, policies: Iterable[Policy], view: str) -> None:
        self.nodes: set[str] = set()
        self.allowed: dict[Part, list[Grant]] = defaultdict(list)  # plain names
        self.patterns: dict[tuple[str, bool], list[tuple[str, Grant]]] = defaultdict(list)
        self.denied: dict[tuple[str, str, bool], list[tuple[str, Grant]]] = defaultdict(list)
        self.homes: dict[str, set[tuple[str, str]]] = defaultdict(set)  # node -> policy and enclave
        for policy in policies:
            members: dict[str, set[str]] = defaultdict(set)
            for profile in policy.profiles:
                node = plain_name(profile.node)[0]
                members[profile.enclave].add(node)
                self.homes[node].add((policy.file, profile.enclave))
            for grant in policy.grants:
                own = {plain_name(grant.node)[0]} if view == View.declared else members[grant.enclave]
                self._add(grant, own)

    def _add(self, grant: Grant, nodes: Iterable[str]) -> None:
        for end in _ends(grant):
            if not grant.allow:
                if not grant.dead:
                    self.denied[grant.policy, grant.enclave, end.writes].append((end.dds, grant))
                continue
            for node in nodes:
                if is_pattern(end.dds):
                    self.patterns[node, end.writes].append((end.dds, grant))
                else:
                    self.allowed[node, end.writes, end.dds].append(grant)

    def missing(self, use: Grant) -> Use | None:
        """What is not granted of a use; None if all of it is."""
        node = plain_name(use.node)[0]
        if node not in self.homes:
            return Use(use, NO_PROFILE)
        lacking = [end for end in _ends(use) if not self._granted(node, end)]
        if not lacking:
            return None
        lines = {
            line
            for end in lacking
            for policy, enclave in self.homes[node]
            for line in self._denials(policy, enclave, end)
        }
        return Use(use, DENIED if lines else NOT_GRANTED, tuple(sorted(lines, key=_key)))

    def is_effective(self, line: Grant) -> bool:
        """Whether DENYs leave anything of an ALLOW line."""
        return any(not any(self._denials(line.policy, line.enclave, end)) for end in _ends(line))

    def _granted(self, node: str, end: Endpoint) -> bool:
        lines = self.allowed.get((node, end.writes, end.dds), [])
        covering = (line for dds, line in self.patterns.get((node, end.writes), ()) if covers(dds, end.dds))
        return any(not any(self._denials(line.policy, line.enclave, end)) for line in (*lines, *covering))

    def _denials(self, policy: str, enclave: str, end: Endpoint) -> Iterator[Grant]:
        return (line for dds, line in self.denied.get((policy, enclave, end.writes), ()) if covers(dds, end.dds))


def _deniable(policies: Iterable[Policy], unused: Iterable[Grant], uses: Iterable[Grant]) -> tuple[Grant, ...]:
    """Unused lines of which a DENY, which holds for the whole enclave, meets no line that may be in use.

    The largest set of lines of which each meets, in its policy, enclave and direction, only others of the set; and
    nothing that a node of the enclave was seen to do.
    """
    chosen = set(unused)
    members: dict[tuple[str, str], set[str]] = defaultdict(set)
    kept: dict[Place, list[Grant]] = defaultdict(list)  # plain names
    patterns: dict[tuple[str, str, bool], list[tuple[str, Grant]]] = defaultdict(list)
    for policy in policies:
        for profile in policy.profiles:
            members[policy.file, profile.enclave].add(plain_name(profile.node)[0])
        for grant in policy.grants:
            if grant.allow:
                for end in _ends(grant):
                    kept[policy.file, grant.enclave, end.writes, end.dds].append(grant)
                    if is_pattern(end.dds):
                        patterns[policy.file, grant.enclave, end.writes].append((end.dds, grant))
    does: dict[tuple[str, bool], set[str]] = defaultdict(set)
    for grant in uses:
        for end in _ends(grant):
            does[plain_name(grant.node)[0], end.writes].add(end.dds)
    chosen = {grant for grant in chosen if not grant.dead and not _denies_use(grant, members, does)}
    while out := {grant for grant in chosen if any(line not in chosen for line in _met(grant, kept, patterns))}:
        chosen -= out
    return tuple(sorted(chosen, key=_key))


def _denies_use(
    grant: Grant, members: Mapping[tuple[str, str], set[str]], does: Mapping[tuple[str, bool], set[str]]
) -> bool:
    """Whether a DENY of a line would take away what a node of its enclave was seen to do."""
    return any(
        covers(end.dds, dds)
        for end in _ends(grant)
        for node in members[grant.policy, grant.enclave]
        for dds in does.get((node, end.writes), ())
    )


def _met(
    grant: Grant, uses: Mapping[Place, list[Grant]], patterns: Mapping[tuple[str, str, bool], list[tuple[str, Grant]]]
) -> Iterator[Grant]:
    """The lines of its enclave that a DENY of a line would touch."""
    for end in _ends(grant):
        at = grant.policy, grant.enclave, end.writes
        yield from uses.get((*at, end.dds), ())
        yield from (line for dds, line in patterns.get(at, ()) if overlaps(dds, end.dds))
        if is_pattern(end.dds):
            near = ((dds, lines) for (*where, dds), lines in uses.items() if tuple(where) == at)
            yield from (line for dds, lines in near if overlaps(dds, end.dds) for line in lines)


def _key(grant: Grant) -> tuple[object, ...]:
    place = grant.place
    return (grant.node, grant.kind, grant.name, grant.role, place.file, place.line, grant.enclave)
