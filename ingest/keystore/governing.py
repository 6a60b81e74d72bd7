"""Which rules of governance may decide in the domains that permissions are about.

In: governance files, permissions, and the domain of the robot if it is known. Out: their rules, each with its domains,
and the domains in which none surely decides. A rule that is perhaps about a domain hides none that stands after it, so
what any of them leaves open is left open.

Source: DDS-Security 1.1, 9.4.1.2.3: the first rule about a domain decides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.keystore.domains import LAST_OF_ROS, common, without

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.ingest.keystore.domains import Spans
    from rosprivacy.ingest.keystore.governance_file import DomainRule, Governance
    from rosprivacy.ingest.keystore.permissions_file import Permissions

OF_ROS: Spans = ((0, LAST_OF_ROS),)


class Governed(NamedTuple):
    """A rule, and the domains in which it may decide."""

    file: str
    rule: DomainRule
    spans: Spans


def domains_of(permissions: Permissions, domain: int | None) -> Spans:
    """Return the domains that permissions are about, as far as is known: those of ROS, or if there are none, all."""
    if domain is not None:
        return ((domain, domain),)
    spans = tuple(span for grant in permissions.grants for rule in grant.rules for span in rule.domains.spans)
    return common(OF_ROS, spans) or spans or OF_ROS


def governed(governance: Governance, spans: Spans) -> Iterator[Governed]:
    """Yield the rules that may decide in some domains, in their order."""
    for rule in governance.rules:
        if within := common(spans, rule.domains.spans):
            yield Governed(governance.file, rule, within)
        spans = without(spans, rule.domains.certain)


def ungoverned(governances: Iterable[Governance], spans: Spans) -> Spans:
    """Return the domains of which no rule is surely about."""
    for governance in governances:
        for rule in governance.rules:
            spans = without(spans, rule.domains.certain)
    return spans


def differing(governances: Iterable[Governance], spans: Spans) -> Iterator[tuple[Governed, Governed, Spans]]:
    """Yield what two files say of the same domains, where it is not the same, with these domains."""
    files = [list(governed(one, spans)) for one in governances]
    for at, first in enumerate(files):
        for second in files[at + 1 :]:
            for one in first:
                for other in second:
                    shared = common(one.spans, other.spans)
                    if shared and one.rule.says() != other.rule.says():
                        yield one, other, shared
