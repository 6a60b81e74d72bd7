"""What a reader has to know of a governance: where permissions do not hold, and what is sent in the open (rule S11).

In: a governance and the permissions beside it. Out: warnings at its lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Severity
from rosprivacy.ingest.keystore.domains import written
from rosprivacy.ingest.keystore.governing import domains_of, governed, ungoverned

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.keystore.governance_file import DomainRule, Governance
    from rosprivacy.ingest.keystore.permissions_file import Permissions


NO_RULE = "no rule is surely about it, and where none is, no participant starts"


def governance_remarks(governance: Governance, permissions: Permissions, domain: int | None) -> Iterator[Diagnostic]:
    """Yield what is to be said of the domains that permissions are about."""
    spans = domains_of(permissions, domain)
    if governance.rules and (left := ungoverned([governance], spans)):
        yield _warning(governance.rules[0].place, f"domain {written(left)}: {NO_RULE}")
    for one in governed(governance, spans):
        yield from rule_remarks(one.rule)


def rule_remarks(rule: DomainRule) -> Iterator[Diagnostic]:
    """Yield what is to be said of a rule that may decide."""
    if rule.domains.opened:
        message = "<id_range> without <max>: to Fast DDS and Cyclone DDS one domain, in the standard all from there on"
        yield _warning(rule.place, f"{message}; the rules after this one are taken to hold too; write <max>")
    yield from _of_domain(rule)


def _of_domain(rule: DomainRule) -> Iterator[Diagnostic]:
    if rule.unauthenticated:
        yield _warning(rule.place, "a participant without a certificate may join")
    if not rule.joining:
        yield _warning(rule.place, "who has a certificate may join, whatever its permissions say of the domain")
    for topic in rule.in_force():
        free = [word for word, checked in (("read", topic.reading), ("write", topic.writing)) if not checked]
        named = f"DDS topics {topic.expression}"
        if free:
            message = f"{named}: permissions are not asked, so every participant may {' and '.join(free)} there"
            message += "; the declared view takes each to keep to its permissions (rule S6)"
            yield Diagnostic(topic.place, Severity.WARNING, shown(message), ACCESS_GAP)
        if not rule.encrypted(topic):
            yield _warning(topic.place, f"{named} are sent without encryption: who is on the network can read them")


def _warning(place: Place, message: str) -> Diagnostic:
    return Diagnostic(place, Severity.WARNING, shown(message))
