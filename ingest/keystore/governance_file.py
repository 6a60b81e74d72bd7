"""DDS-Security governance -> what is checked and what is encrypted, by domain and topic.

In: the text of a governance file, signed or not. Out: ``Governance``, or every problem at its line.

Source: DDS-Security 1.1, 9.4.1.2; the first domain rule that holds a domain decides, then its first topic rule that
matches the DDS topic.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.ingest.keystore.permissions_file import NOWHERE
from rosprivacy.ingest.keystore.security_xml import Source, security_entries
from rosprivacy.ingest.policies.names import covers

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.keystore.domains import Domains
    from rosprivacy.ingest.keystore.security_xml import Section

ENCRYPTING = ("ENCRYPT", "ENCRYPT_WITH_ORIGIN_AUTHENTICATION")
BASIC = ("NONE", "SIGN", "ENCRYPT")
PROTECTION = (*BASIC, "SIGN_WITH_ORIGIN_AUTHENTICATION", ENCRYPTING[1])
OF_DOMAIN: dict[str, tuple[str, ...]] = {
    "domains": (), "allow_unauthenticated_participants": (), "enable_join_access_control": (),
    "discovery_protection_kind": PROTECTION, "liveliness_protection_kind": PROTECTION,
    "rtps_protection_kind": PROTECTION, "topic_access_rules": (),
}  # fmt: skip
OF_TOPIC: dict[str, tuple[str, ...]] = {
    "topic_expression": (), "enable_discovery_protection": (), "enable_liveliness_protection": (),
    "enable_read_access_control": (), "enable_write_access_control": (), "metadata_protection_kind": PROTECTION,
    "data_protection_kind": BASIC,
}  # fmt: skip
LATER = {"enable_liveliness_protection"}  # not in version 1.0 of the document; nothing here depends on it


@dataclass(frozen=True, slots=True)
class TopicRule:
    """What holds for the DDS topics of an expression.

    Attributes
    ----------
    reading, writing
        Whether permissions are asked before somebody may read or write.
    metadata, data
        The protection of a whole message about the data, and of the data in it.
    """

    expression: str
    reading: bool
    writing: bool
    metadata: str
    data: str
    place: Place


@dataclass(frozen=True, slots=True)
class DomainRule:
    """What holds in some domains.

    Attributes
    ----------
    unauthenticated
        Whether a participant without a certificate may join.
    joining
        Whether permissions are asked before an authenticated participant may join.
    rtps
        The protection of everything that is sent.
    """

    domains: Domains
    unauthenticated: bool
    joining: bool
    rtps: str
    topics: tuple[TopicRule, ...]
    place: Place

    def of(self, dds: str) -> TopicRule | None:
        """Return the rule of a DDS topic; a middleware refuses a topic that has none."""
        return next((rule for rule in self.topics if covers(rule.expression, dds)), None)

    def says(self) -> tuple[object, ...]:
        """Return what it says, wherever it stands and whatever domains it is about."""
        topics = ((t.expression, t.reading, t.writing, t.metadata, t.data) for t in self.topics)
        return (self.unauthenticated, self.joining, self.rtps, *topics)

    def in_force(self) -> tuple[TopicRule, ...]:
        """Return the topic rules that an earlier one does not hide whole."""
        return tuple(
            rule
            for at, rule in enumerate(self.topics)
            if not any(covers(first.expression, rule.expression) for first in self.topics[:at])
        )

    def encrypted(self, rule: TopicRule) -> bool:
        """Return whether what is sent under a rule is encrypted: as a whole, with its message, or by itself."""
        return any(kind in ENCRYPTING for kind in (self.rtps, rule.metadata, rule.data))


@dataclass(frozen=True, slots=True)
class Governance:
    """All domain rules of a governance file, in its order."""

    file: str
    rules: tuple[DomainRule, ...]

    def of(self, domain: int) -> DomainRule | None:
        """Return the rule of a domain, as the standard has it; without one no participant starts in it."""
        return next((rule for rule in self.rules if domain in rule.domains), None)


def read_governance(data: bytes, file: str, before: int = 0) -> Governance:
    """Read the text of a governance file.

    Parameters
    ----------
    before
        Lines of the file before the text, as in a signed file.

    Raises
    ------
    InputErrors
        With every problem of the text, each a ``PolicyError`` of one line.
    """
    source = Source(file, before)
    rules = tuple(map(_domain_rule, security_entries(data, source, "domain_access_rules", "domain_rule")))
    source.check()
    return Governance(file, rules)


def _domain_rule(rule: Section) -> DomainRule:
    parts = {tag: rule.one(tag, OF_DOMAIN) for tag in OF_DOMAIN}
    domains, topics = parts["domains"], parts["topic_access_rules"]
    return DomainRule(
        domains.domains() if domains else NOWHERE,
        _true(parts["allow_unauthenticated_participants"]),
        _true(parts["enable_join_access_control"]),
        _kind(parts["rtps_protection_kind"]),
        tuple(_topic_rule(topic) for topic in topics.children({"topic_rule"})) if topics else (),
        rule.place,
    )


def _topic_rule(rule: Section) -> TopicRule:
    parts = {tag: _optional(rule, tag) if tag in LATER else rule.one(tag, OF_TOPIC) for tag in OF_TOPIC}
    expression = parts["topic_expression"]
    if expression and not expression.text:
        rule.source.problem(expression.element, "<topic_expression> is empty", "write an expression, or * for all")
    return TopicRule(
        expression.text if expression else "",
        _true(parts["enable_read_access_control"]),
        _true(parts["enable_write_access_control"]),
        _kind(parts["metadata_protection_kind"]),
        _kind(parts["data_protection_kind"]),
        rule.place,
    )


def _optional(rule: Section, tag: str) -> Section | None:
    return next((child for child in rule.children(OF_TOPIC) if child.tag == tag), None)


def _true(part: Section | None) -> bool:
    return part is not None and part.boolean()


def _kind(part: Section | None) -> str:
    return part.chosen({**OF_DOMAIN, **OF_TOPIC}[part.tag], "NONE") if part else "NONE"
