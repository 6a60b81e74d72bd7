"""Nodes for which nothing is enforced: they were observed, and nobody named what they are held to (rule S6).

In: policies of a robot, or of all robots of a domain. Out: enclaves, and under the enforced view profiles and grants in
which these are one, with the network as an element outside ROS that reads what passes there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import NETWORK, NOTHING_ENFORCED, OBSERVED, SCANNED, Diagnostic, Profile, Severity
from rosprivacy.ingest.policies.names import DDS, endpoints

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Grant, Policy
    from rosprivacy.ingest.policies.names import Endpoint

ENCLAVE = "/ (nothing enforced)"  # of all unsecured nodes of a domain; no policy has a blank in a path
READING = {"topic": ("subscribe",), "service": ("request", "reply"), "action": ("call", "execute"), DDS: ("subscribe",)}
SHOWN_AT_MOST = 3


def is_observed(policy: Policy) -> bool:
    """Whether a policy was made of what was seen running, or of source code: no middleware is held to it (rule S16)."""
    return any(diagnostic.code in (OBSERVED, SCANNED) for diagnostic in policy.diagnostics)


def unsecured(policies: Sequence[Policy]) -> frozenset[str]:
    """Return the enclaves of observed nodes for which no policy, permissions or access list of a person is given."""
    held = {profile.enclave for policy in policies if not is_observed(policy) for profile in policy.profiles}
    seen = {profile.enclave for policy in policies if is_observed(policy) for profile in policy.profiles}
    return frozenset(seen - held)


def unsecured_notices(policies: Sequence[Policy]) -> Iterator[Diagnostic]:
    """Return a diagnostic for each observed policy with nodes for which nothing is enforced, with their number."""
    enclaves = unsecured(policies)
    for policy in policies:
        nodes = sorted({p.node for p in policy.profiles if p.enclave in enclaves and not p.participant})
        if nodes and is_observed(policy):
            first = min(p.place for p in policy.profiles)
            named = ", ".join([*map(shown, nodes[:SHOWN_AT_MOST]), *(["…"] if len(nodes) > SHOWN_AT_MOST else [])])
            how = "scanned" if any(said.code == SCANNED for said in policy.diagnostics) else "observed"
            what = f"nothing is enforced for what was {how} here ({named}): any program on the network may do it"
            yield Diagnostic(first, Severity.WARNING, f"{what}; see --view both", NOTHING_ENFORCED, len(nodes))


def network_profiles(profiles: Iterable[Profile], enclaves: Collection[str]) -> list[Profile]:
    """Return a profile of the network for each robot that has unsecured nodes."""
    first: dict[str, Profile] = {}
    for profile in profiles:
        if profile.enclave in enclaves:
            first.setdefault(_robot(profile.enclave), profile)
    return [Profile(ENCLAVE, f"{mark}/{NETWORK}", p.place, f"{mark}{NETWORK}") for mark, p in sorted(first.items())]


def in_one_enclave(
    profiles: Iterable[Profile], grants: Iterable[Grant], enclaves: Collection[str]
) -> tuple[tuple[Profile, ...], list[Grant]]:
    """Return profiles and grants in which the unsecured nodes stand in one enclave."""
    moved = (p._replace(enclave=ENCLAVE) if p.enclave in enclaves else p for p in profiles)
    return tuple(moved), [g._replace(enclave=ENCLAVE) if g.enclave in enclaves else g for g in grants]


def read_by_network(grants: Iterable[Grant], enclaves: Collection[str]) -> Iterator[tuple[str, Grant, Endpoint]]:
    """Yield (profile of the network, grant, what it reads by it): all that unsecured nodes write or read, once."""
    read = set()
    for grant in grants:
        mark = _robot(grant.enclave)
        for role in READING[grant.kind] if grant.enclave in enclaves else ():
            for endpoint in endpoints(role, grant.kind, grant.name):
                if not endpoint.writes and (mark, endpoint) not in read:
                    read.add((mark, endpoint))
                    yield f"{mark}/{NETWORK}", grant._replace(role=role), endpoint


def _robot(enclave: str) -> str:
    """What stands before names of a robot where policies of several are joined."""
    return enclave[: enclave.find("\0") + 1]
