"""Rules that an enclave breaks as a whole: who shares it, and how large its permissions get (rule S6).

Source: sros2's ``permissions.xsl`` for the size, with the signature that ``openssl`` makes; issue 228 of ros2/sros2 for
the bound: the handshake carries permissions in one message, and a message of UDP has at most 64 KiB.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Breach
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.lint.rule_table import RULES
from rosprivacy.ingest.policies.names import endpoints

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Bound, FlowGraph, Grant, Policy, Profile

MOST = 64 * 2**10  # bytes
FRAME = 440  # of a grant: subject, validity, domains, default and what is around them
SECTION = 78  # <publish><topics> with their ends
TOPIC = 28  # <topic></topic> with its indent and the end of its line
SIGNATURE = 1_700
NAMED = 3


def enclave_breaches(policies: Sequence[Policy], graph: FlowGraph, bound: Bound) -> Iterator[Breach]:
    """Yield the rules that enclaves break.

    Parameters
    ----------
    bound
        What labels say of the graph.
    """
    profiles: dict[str, dict[str, Profile]] = defaultdict(dict)
    for policy in policies:
        for profile in policy.profiles:
            profiles[profile.enclave].setdefault(profile.node, profile)
    roles = _labelled(graph, bound)
    for enclave, members in sorted(profiles.items()):
        place = min((profile.place for profile in members.values()), key=lambda at: (at.file, at.line))
        if len(members) > 1:
            what = f"enclave {shown(enclave)} has {counted(len(members), 'node')} ({_named(members)}): "
            yield Breach(RULES["crowded-enclave"], place, f"{what}each may do what any of them may; split it")
        sources, leaks = (sorted(node for node in members if node in roles[role]) for role in ("source", "leak"))
        if sources and any([node] != sources for node in leaks):
            what = f"enclave {shown(enclave)} has a source ({_named(sources)}) and a leak ({_named(leaks)})"
            yield Breach(RULES["mixed-enclave"], place, f"{what}; give them enclaves of their own")
    for policy in policies:
        for enclave, size in sorted(permissions_sizes(policy.grants).items()):
            if size > MOST:
                place = next(profile.place for profile in policy.profiles if profile.enclave == enclave)
                what = f"the permissions of enclave {shown(enclave)} will have some {size:,} bytes, more than {MOST:,}"
                yield Breach(RULES["large-permissions"], place, f"{what}; split it, or use fewer names")


def permissions_sizes(grants: Iterable[Grant]) -> dict[str, int]:
    """Return how many bytes the signed permissions of each enclave will have, as sros2 writes them; an estimate."""
    topics: dict[str, set[tuple[bool, bool, str]]] = defaultdict(set)
    for grant in grants:
        for end in endpoints(grant.role, grant.kind, grant.name):
            topics[grant.enclave].add((grant.allow, end.writes, end.dds))
    return {
        enclave: SIGNATURE
        + FRAME
        + 2 * len(enclave)
        + SECTION * len({(allow, writes) for allow, writes, _ in lines})
        + sum(TOPIC + len(dds.encode()) for _, _, dds in lines)
        for enclave, lines in topics.items()
    }


def _labelled(graph: FlowGraph, bound: Bound) -> dict[str, set[str]]:
    """By role, the nodes that labels call sources and leaks."""
    found: dict[str, set[str]] = {"source": set(), "leak": set()}
    for vertex, statements in bound.elements.items():
        for statement in statements:
            if graph.elements[vertex].is_node and statement.role in found:
                found[statement.role].add(graph.elements[vertex].name)
    return found


def _named(nodes: Iterable[str]) -> str:
    names = sorted(nodes)
    return ", ".join(map(shown, names[:NAMED])) + (", …" if len(names) > NAMED else "")
