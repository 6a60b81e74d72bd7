"""Several policies make one graph: what is to be said of that, since nobody may have meant it (rules S4, S5, S11).

In: all policies that were read as one system, or of a robot. Out: notices that name files, and warnings of enclaves
that several state and of names that no ROS node can have, few and sorted.

Source: ROS 2's ``rmw_validate_full_topic_name``, which refuses such a name when a node starts; sros2 writes it into the
permissions all the same, where it meets no other name. A doubled underscore is not refused.
"""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import (
    MERGED,
    REFUSED_NAME,
    SEEN_ALTHOUGH_DENIED,
    SHARED_ENCLAVE,
    Diagnostic,
    Place,
    Severity,
)
from rosprivacy.analysis.written_names import did_you_mean, nearest
from rosprivacy.ingest.policies.names import covers, endpoints, is_pattern, matcher
from rosprivacy.ingest.policies.unsecured import is_observed, unsecured_notices

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Grant, Policy

SHOWN_AT_MOST = 3  # of nodes, files, parts and enclaves
EVERYBODY = ("rosout", "parameter_events", "clock")  # channels of every node: they join no two systems
FEWEST_ALIKE = 3  # nodes of a robot whose names tell it from a part of one
COMPARED_PARTS = 1_000_000  # wildcards with names; beyond that nothing is said of parts
ALONE = "--per-policy analyses each alone"
OF_ONE_ROBOT = "name for a robot of the fleet only what runs on it"


def merging_notices(policies: Iterable[Policy], instead: str = ALONE) -> tuple[Diagnostic, ...]:
    """Return notices for files that state one node differently, that have nothing in common, or the same nodes.

    The same but for the namespace in which they stand. Observations of one robot may differ, since they were made at
    different times.

    Parameters
    ----------
    instead
        What to do if they were not meant to make one graph.
    """
    of_files = (policy for policy in policies if policy.profiles and policy.file in dict(policy.sources))
    policies = sorted(of_files, key=lambda policy: policy.file)
    if len(policies) < 2:  # noqa: PLR2004 - two make one
        return ()
    apart = (*_without_common_names(policies, instead),)
    return (*_stated_differently(deployed(policies), instead), *(apart or _alike_below(policies, instead)))


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


def _alike_below(policies: Sequence[Policy], instead: str) -> Iterator[Diagnostic]:
    """Files of the same nodes, but for the namespace: as of two robots of one model that share a channel."""
    alike: dict[frozenset[str], dict[str, Policy]] = defaultdict(dict)
    for policy in policies:
        nodes = {profile.node for profile in policy.profiles}
        first = {node.split("/")[1] for node in nodes}
        below = f"/{first.pop()}" if len(first) == 1 else ""
        if len(nodes) >= FEWEST_ALIKE:
            alike[frozenset(node.removeprefix(below) for node in nodes)].setdefault(below, policy)
    for same in alike.values():
        if len(same) > 1:
            files = sorted(policy.file for policy in same.values())
            below = ", ".join(shown(namespace or "/") for namespace in sorted(same))
            what = f"{len(policies):,} policies make one graph; {_files(files)} have the same nodes below {below}"
            place = min(same.values(), key=lambda policy: policy.file).profiles[0].place
            yield Diagnostic(place, Severity.NOTICE, f"{what}; if these are several robots, {instead}", MERGED)


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
    if len(wildcards) * len(names) > COMPARED_PARTS:
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


LONGEST = 247  # characters that the middlewares of ROS 2 take
COMPARED = 50  # refused names that are compared with all others

_WILDCARD = re.compile(r"\[[!^]?\]?[^\]]*\]|[*?]")
_FINE = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+")  # as nearly all are: none of the following
_REFUSED = (
    (re.compile(r"[^A-Za-z0-9_/]"), "it has characters other than letters, digits, _ and /"),
    (re.compile(r"/$"), "it ends with /"),
    (re.compile(r"//"), "it has // in it"),
    (re.compile(r"/[0-9]"), "a part of it begins with a digit"),
    (re.compile(rf"(?s).{{{LONGEST + 1}}}"), f"it is longer than {LONGEST} characters"),
)


def joint_warnings(policies: Iterable[Policy]) -> tuple[Diagnostic, ...]:
    """Return what is to be said of policies that are read as one system."""
    policies = sorted(policies, key=lambda policy: policy.file)
    found = (
        *_shared_enclaves(policies),
        *_refused_names(policies),
        *seen_although_denied(policies),
        *unsecured_notices(policies),
    )
    return tuple(sorted(found, key=lambda said: (said.place.file, said.place.line, said.message)))


def deployed(policies: Iterable[Policy]) -> list[Policy]:
    """Return the policies that may be in force: one that was made of an observation stands beside them (rule S16)."""
    return [policy for policy in policies if not is_observed(policy)]


def _shared_enclaves(policies: Sequence[Policy]) -> Iterator[Diagnostic]:
    """One warning for all enclaves that the same files state."""
    stated: dict[str, dict[str, Place]] = defaultdict(dict)
    for policy in deployed(policies):
        for profile in policy.profiles:
            stated[profile.enclave].setdefault(policy.file, profile.place)
    several = {enclave: files for enclave, files in stated.items() if len(files) > 1}
    said = _places_shown(policies, several) if several else {}
    shared: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for enclave, files in several.items():
        if any(said[file, enclave] != said[next(iter(files)), enclave] for file in files):
            shared[tuple(files)].append(enclave)
    for names, enclaves in sorted(shared.items()):
        named = ", ".join(
            [*map(shown, sorted(enclaves)[:SHOWN_AT_MOST]), *(["…"] if len(enclaves) > SHOWN_AT_MOST else [])]
        )
        what = f"enclave {named} is" if len(enclaves) == 1 else f"{len(enclaves):,} enclaves ({named}) are"
        others = " and ".join(shown(file) for file in names[1:])
        message = f"{what} stated in {others} too: sros2 makes permissions of one file; all are read, and no file's "
        message += "DENY cuts what another file allows; name only what is deployed"
        yield Diagnostic(stated[min(enclaves)][names[0]], Severity.WARNING, message, SHARED_ENCLAVE)


def _places_shown(policies: Sequence[Policy], enclaves: Collection[str]) -> dict[tuple[str, str], set[object]]:
    """By file and enclave, the lines that state it: the same ones where a policy includes another one's enclave."""
    said: dict[tuple[str, str], set[object]] = defaultdict(set)
    for policy in policies:
        for profile in policy.profiles:
            if profile.enclave in enclaves:
                said[policy.file, profile.enclave].add(profile)
        for grant in policy.grants:
            if grant.enclave in enclaves:
                line = grant.place, grant.allow, grant.role, grant.name, grant.node, grant.dead
                said[policy.file, grant.enclave].add(line)
    return said


def why_refused(name: str) -> str:
    """Return why no ROS node can have a fully qualified name, or with wildcards any that it covers; empty if it can.

    >>> why_refused("/video/"), why_refused("/r1/*"), why_refused("/a__b")
    ('it ends with /', '', '')
    """
    if len(name) <= LONGEST and _FINE.fullmatch(name):
        return ""
    plain = _WILDCARD.sub("a", name) if is_pattern(name) else name
    if not plain.startswith("/"):
        return ""  # its namespace does not begin with /, and that is told
    return next((why for expression, why in _REFUSED if expression.search(plain)), "")


def _refused_names(policies: Iterable[Policy]) -> Iterator[Diagnostic]:
    first: dict[tuple[str, str], Grant] = {}
    good: dict[str, set[str]] = defaultdict(set)
    refused: dict[tuple[str, str], str] = {}
    for policy in policies:
        for grant in policy.grants:
            key = grant.kind, grant.name
            if key in first:
                continue
            first[key] = grant
            if why := why_refused(grant.name):
                refused[key] = why
            elif not is_pattern(grant.name):
                good[grant.kind].add(grant.name)
    for number, ((kind, name), why) in enumerate(sorted(refused.items())):
        near = _nearest(name, good[kind], compare=number < COMPARED)
        hint = did_you_mean(near, "correct it")
        message = f"no ROS node can use the {kind} {shown(repr(name))}: {why}; {hint}"
        yield Diagnostic(first[kind, name].place, Severity.WARNING, message, REFUSED_NAME)


def _nearest(name: str, good: set[str], *, compare: bool) -> list[str]:
    mended = re.sub(r"/+", "/", name.strip()).rstrip("/")
    if mended in good:
        return [mended]
    return nearest(name, sorted(good)) if compare else []


def seen_although_denied(policies: Iterable[Policy]) -> Iterator[Diagnostic]:
    """Return a warning for each observed grant that a DENY of another policy covers, for an enclave of its node."""
    policies = tuple(policies)
    seen = [grant for policy in policies for grant in policy.grants if grant.observation]
    if not seen:
        return
    denials: dict[tuple[str, bool], list[tuple[str, Grant]]] = defaultdict(list)
    for policy in policies:
        nodes: dict[str, set[str]] = defaultdict(set)
        for profile in policy.profiles:
            nodes[profile.enclave].add(profile.node)
        for grant in policy.grants:
            if grant.allow or grant.dead:
                continue
            for end in endpoints(grant.role, grant.kind, grant.name):
                for node in nodes[grant.enclave]:
                    denials[node, end.writes].append((end.dds, grant))
    for grant in seen:
        lines = [
            line
            for end in endpoints(grant.role, grant.kind, grant.name)
            for dds, line in denials.get((grant.node, end.writes), ())
            if line.policy != grant.policy and covers(dds, end.dds)
        ]
        if lines and grant.observation:
            first = min(lines, key=lambda line: (line.place.file, line.place.line))
            message = (
                f"seen although denied: {grant.node} {grant.role} {grant.name}, from {grant.observation.first} to "
            )
            message += f"{grant.observation.last}; {shown(str(first.place))} denies it; see why it runs all the same"
            yield Diagnostic(grant.place, Severity.WARNING, shown(message), SEEN_ALTHOUGH_DENIED)
