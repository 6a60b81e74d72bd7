"""Grants that were seen in use although another policy denies them: told, and never taken away (rules S5, S16).

In: all policies of a robot. Out: warnings. A DENY holds in its own policy only, so it cuts no observed flow; who reads
the answer has to know that what is denied there runs all the same.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import SEEN_ALTHOUGH_DENIED, Diagnostic, Severity
from rosprivacy.ingest.policies.names import covers, endpoints

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Grant, Policy


def seen_although_denied(policies: Iterable[Policy]) -> Iterator[Diagnostic]:
    """Return a warning for each observed grant that a DENY of another policy covers, for an enclave of its node."""
    policies = tuple(policies)
    seen = [grant for policy in policies for grant in policy.grants if grant.seen]
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
        if lines and grant.seen:
            first = min(lines, key=lambda line: (line.place.file, line.place.line))
            message = f"seen although denied: {grant.node} {grant.role} {grant.name}, from {grant.seen.first} to "
            message += f"{grant.seen.last}; {shown(str(first.place))} denies it; see why it runs all the same"
            yield Diagnostic(grant.place, Severity.WARNING, shown(message), SEEN_ALTHOUGH_DENIED)
