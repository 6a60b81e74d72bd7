"""Several policies make one graph: what is to be said of that, since nobody may have meant it (rules S4, S5, S11).

In: all policies that were read as one system. Out: notices that name files, few and sorted.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import MERGED, Diagnostic, Severity
from rosprivacy.ingest.policies.joint_policies import deployed
from rosprivacy.ingest.policies.names import is_pattern, matcher

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Grant, Place, Policy

SHOWN_AT_MOST = 3  # of nodes, files and parts
EVERYBODY = ("rosout", "parameter_events", "clock")  # channels of every node: they join no two systems
COMPARED = 1_000_000  # wildcards with names; beyond that nothing is said of parts
ALONE = "--per-policy analyses each alone"
OF_ONE_ROBOT = "name for a robot of the fleet only what runs on it"


def merging_notices(policies: Iterable[Policy], instead: str = ALONE) -> tuple[Diagnostic, ...]:
    """Return a notice for files that state one node differently, and one for files that have nothing in common.

    Parameters
    ----------
    instead
        What to do if they were not meant to make one graph.
    """
    of_files = (policy for policy in deployed(policies) if policy.profiles and policy.file in dict(policy.sources))
    policies = sorted(of_files, key=lambda policy: policy.file)
    if len(policies) < 2:  # noqa: PLR2004 - two make one
        return ()
    return (*_stated_differently(policies, instead), *_without_common_names(policies, instead))


def _stated_differently(policies: Sequence[Policy], instead: str) -> Iterator[Diagnostic]:
    """One notice for all nodes that the same files state."""
    places: dict[str, dict[str, Place]] = defaultdict(dict)
    allowed: dict[tuple[str, str], set[tuple[object, ...]]] = defaultdict(set)
    for policy in policies:
        for profile in policy.profiles:
            places[profile.node].setdefault(policy.file, profile.place)
        for grant in policy.grants:
            allowed[grant.node, policy.file].add((grant.allow, grant.role, grant.kind, grant.name, grant.enclave))
    nodes: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for node, files in places.items():
        if any(allowed[node, file] != allowed[node, min(files)] for file in files):
            nodes[tuple(files)].append(node)
    for files_of, stated in sorted(nodes.items()):
        first = min(stated)
        what = f"{_sample(stated, 'node')} stated differently in {_files(files_of)}"
        message = f"{len(policies):,} policies make one graph, with what each of them allows: {what}"
        yield Diagnostic(places[first][files_of[0]], Severity.NOTICE, f"{message}; {instead}", MERGED)


def _without_common_names(policies: Sequence[Policy], instead: str) -> Iterator[Diagnostic]:
    parts = _parts(policies)
    if len(parts) > 1:
        more = f" | and {len(parts) - SHOWN_AT_MOST} more" if len(parts) > SHOWN_AT_MOST else ""
        named = " | ".join(_files([policy.file for policy in part]) for part in parts[:SHOWN_AT_MOST]) + more
        what = f"{len(policies):,} policies make one graph of {len(parts):,} parts that share no node and no channel"
        message = f"{what}: {named}; if these are several systems, {instead}"
        yield Diagnostic(parts[0][0].profiles[0].place, Severity.NOTICE, message, MERGED)


def _parts(policies: Sequence[Policy]) -> list[list[Policy]]:
    """Policies that have a node or a channel in common, over others too; all as one where that takes too long."""
    names: dict[tuple[str, str], set[int]] = defaultdict(set)
    for number, policy in enumerate(policies):
        for profile in policy.profiles:
            names["node", profile.node].add(number)
        for grant in policy.grants:
            if grant.allow and not _of_everybody(grant):
                names[grant.kind, grant.name].add(number)
    wildcards = [key for key in names if key[0] != "node" and is_pattern(key[1])]
    if len(wildcards) * len(names) > COMPARED:
        return [list(policies)]
    joined = [*names.values()]
    for kind, name in wildcards:
        fits = matcher(name)
        joined += [names[kind, name] | names[other] for other in names if other[0] == kind and fits(other[1])]
    part = list(range(len(policies)))
    for numbers in joined:
        meet = {part[number] for number in numbers}
        if len(meet) > 1:
            part = [min(meet) if one in meet else one for one in part]
    return [[policies[i] for i, one in enumerate(part) if one == first] for first in sorted(set(part))]


def _of_everybody(grant: Grant) -> bool:
    return grant.kind == "topic" and grant.name.rpartition("/")[2] in EVERYBODY


def _sample(nodes: Sequence[str], noun: str) -> str:
    named = ", ".join(map(shown, sorted(nodes)[:SHOWN_AT_MOST])) + (", …" if len(nodes) > SHOWN_AT_MOST else "")
    return f"{noun} {named} is" if len(nodes) == 1 else f"{len(nodes):,} {noun}s ({named}) are"


def _files(files: Sequence[str]) -> str:
    more = f" and {len(files) - SHOWN_AT_MOST} more" if len(files) > SHOWN_AT_MOST else ""
    return (", " if more or len(files) > 2 else " and ").join(map(shown, files[:SHOWN_AT_MOST])) + more  # noqa: PLR2004 - a pair
