"""What a policy says and what is deployed, side by side: the rights of one that the other does not have, by enclave.

In: policies of both sides. Out: ``Difference``, sorted. Of a plain name it is exact. A wildcard of one side is held by
the other if one expression there covers it and nothing is taken out of it there that is not taken out here too; else it
is told, also where several expressions together would do (rules S4, S5).
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.policies.names import covers, endpoints, is_pattern, overlaps

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.analysis.model import Grant, Place, Policy
    from rosprivacy.ingest.policies.names import Endpoint

ADDED = "ros_discovery_info"  # by sros2, to the permissions of every enclave


class Difference(NamedTuple):
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
    stated: Iterable[Policy], deployed: Iterable[Policy], who: Callable[[Grant], str] = lambda grant: grant.enclave
) -> tuple[Difference, ...]:
    """Return what differs, by enclave.

    Parameters
    ----------
    who
        Under which name a grant of the policy is compared.

    Notes
    -----
    Linear in plain names; O(rights of an enclave, times wildcards and DENY lines of the other side) beside that.
    """
    ours, theirs = _by_enclave(stated, who), _by_enclave(deployed, lambda grant: grant.enclave)
    found: dict[Difference, None] = {}
    for enclave in sorted({*ours, *theirs}):
        first, second = ours.get(enclave, _NONE), theirs.get(enclave, _NONE)
        for one, other, is_stated in ((first, second, True), (second, first, False)):
            for grant, end in one.rights():
                if end.dds != ADDED and not other.holds(end, one.takes_out(grant, end)):
                    place = grant.place
                    found[Difference(enclave, is_stated, end.writes, end.kind, end.name, end.leg, end.dds, place)] = (
                        None
                    )
    return tuple(sorted(found))


def _by_enclave(policies: Iterable[Policy], who: Callable[[Grant], str]) -> dict[str, _Rights]:
    grants: dict[str, list[Grant]] = defaultdict(list)
    for policy in policies:
        for grant in policy.grants:
            grants[who(grant)].append(grant)
    return {name: _Rights(some) for name, some in grants.items()}


class _Rights:
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


_NONE = _Rights(())
