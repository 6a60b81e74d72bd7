"""DDS-Security governance -> what is checked and encrypted by domain and topic, and what is left open.

In: the text of a governance file; permissions, and the domain of the robot if it is known. Out: ``Governance``, or
every problem at its line; the rules that may decide, each with its domains; grants of the enforced view (rule S6);
warnings (rule S11). A rule that is perhaps about a domain hides none that stands after it, so what any of them leaves
open is left open.

Source: DDS-Security 1.1, 9.4.1.2: the first domain rule that holds a domain decides, then its first topic rule that
matches the DDS topic.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise, product
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Place, Policy, Protection, TopicProtection
from rosprivacy.ingest.deployed.permissions import DIRECTIONS, NOWHERE, dds_grant
from rosprivacy.ingest.deployed.security_xml import (
    LAST_OF_ROS,
    XmlSource,
    common,
    security_entries,
    warning,
    without,
    written,
)
from rosprivacy.ingest.policies.names import covers

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Profile
    from rosprivacy.ingest.deployed.permissions import Permissions
    from rosprivacy.ingest.deployed.security_xml import Domains, Spans, XmlSection

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
OF_ROS: Spans = ((0, LAST_OF_ROS),)
NO_RULE = "no rule is surely about it, and where none is, no participant starts"
NOT_KNOWN = "so whether permissions are asked there is not known, nor what is encrypted; name its governance"
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


def read_governance(data: bytes, file: str, before: int = 0) -> Governance:
    """Read the text of a governance file, before which so many lines stand; ``InputErrors`` has every problem."""
    source = XmlSource(file, before)
    rules = tuple(map(_domain_rule, security_entries(data, source, "domain_access_rules", "domain_rule")))
    source.check()
    return Governance(file, rules)


def _domain_rule(rule: XmlSection) -> DomainRule:
    parts = {tag: rule.child(tag, OF_DOMAIN) for tag in OF_DOMAIN}
    domains, topics = parts["domains"], parts["topic_access_rules"]
    return DomainRule(
        domains.domains() if domains else NOWHERE,
        _is_true(parts["allow_unauthenticated_participants"]),
        _is_true(parts["enable_join_access_control"]),
        _protection_kind(parts["rtps_protection_kind"]),
        tuple(_topic_rule(topic) for topic in topics.children({"topic_rule"})) if topics else (),
        rule.place,
    )


def _topic_rule(rule: XmlSection) -> TopicRule:
    parts = {tag: _optional(rule, tag) if tag in LATER else rule.child(tag, OF_TOPIC) for tag in OF_TOPIC}
    expression = parts["topic_expression"]
    if expression and not expression.text:
        rule.source.problem(expression.element, "<topic_expression> is empty", "write an expression, or * for all")
    return TopicRule(
        expression.text if expression else "",
        _is_true(parts["enable_read_access_control"]),
        _is_true(parts["enable_write_access_control"]),
        _protection_kind(parts["metadata_protection_kind"]),
        _protection_kind(parts["data_protection_kind"]),
        rule.place,
    )


def _optional(rule: XmlSection, tag: str) -> XmlSection | None:
    return next((child for child in rule.children(OF_TOPIC) if child.tag == tag), None)


def _is_true(part: XmlSection | None) -> bool:
    return part is not None and part.boolean()


def _protection_kind(part: XmlSection | None) -> str:
    return part.chosen({**OF_DOMAIN, **OF_TOPIC}[part.tag], "NONE") if part else "NONE"


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
    for first, second in combinations([list(governed(governance, spans)) for governance in governances], 2):
        for one, other in product(first, second):
            shared = common(one.spans, other.spans)
            if shared and one.rule.says() != other.rule.says():
                yield one, other, shared


def protection(rule: DomainRule) -> Protection:
    """Return what a domain rule says of protection on the wire."""
    topics = (TopicProtection(topic.expression, rule.encrypted(topic), topic.place) for topic in rule.in_force())
    return Protection(tuple(topics), rule.place if rule.unauthenticated else None)


def open_topics(
    file: str, rule: DomainRule, profiles: Sequence[Profile], sources: tuple[tuple[str, str], ...]
) -> Policy:
    """Return what a rule of a governance file leaves open to some enclaves; nothing where it asks of all topics.

    A rule that comes first and does ask takes its topics out, as a DENY would. ``sources`` are (file, SHA-256) of the
    governance, and of the permissions that state the enclaves.
    """
    name = f"{file}:{rule.place.line}"  # of each rule its own: what one takes out, another may leave open
    grants = [
        dds_grant(profile, name, topic.place, direction, topic.expression, allow=not asked, rank=rank)
        for direction in DIRECTIONS
        for rank, topic, asked in _in_order(rule.in_force(), direction)
        for profile in profiles
    ]
    return Policy(name, sources, tuple(profiles) if grants else (), tuple(grants), protections=(protection(rule),))


def _in_order(topics: Sequence[TopicRule], direction: str) -> Iterator[tuple[int, TopicRule, bool]]:
    """The rules up to the last that asks nobody, with their places from 1, and whether permissions are asked."""
    asked = [topic.writing if direction == "publish" else topic.reading for topic in topics]
    last = max((at for at, is_asked in enumerate(asked, 1) if not is_asked), default=0)
    yield from zip(range(1, last + 1), topics, asked, strict=False)


def governance_remarks(governance: Governance, permissions: Permissions, domain: int | None) -> Iterator[Diagnostic]:
    """Yield what is to be said of the domains that permissions are about."""
    spans = domains_of(permissions, domain)
    if governance.rules and (left := ungoverned([governance], spans)):
        yield warning(governance.rules[0].place, f"domain {written(left)}: {NO_RULE}")
    for one in governed(governance, spans):
        yield from rule_remarks(one.rule)


def rule_remarks(rule: DomainRule) -> Iterator[Diagnostic]:
    """Yield what is to be said of a rule that may decide."""
    if rule.domains.opened:
        message = "<id_range> without <max>: to Fast DDS and Cyclone DDS one domain, in the standard all from there on"
        yield warning(rule.place, f"{message}; the rules after this one are taken to hold too; write <max>")
    if rule.unauthenticated:
        yield warning(rule.place, "a participant without a certificate may join")
    if not rule.joining:
        yield warning(rule.place, "who has a certificate may join, whatever its permissions say of the domain")
    for topic in rule.in_force():
        free = [word for word, checked in (("read", topic.reading), ("write", topic.writing)) if not checked]
        named = f"DDS topics {topic.expression}"
        if free:
            message = f"{named}: permissions are not asked, so every participant may {' and '.join(free)} there"
            message += "; the declared view takes each to keep to its permissions (rule S6)"
            yield warning(topic.place, message, ACCESS_GAP)
        if not rule.encrypted(topic):
            yield warning(topic.place, f"{named} are sent without encryption: who is on the network can read them")


def joint_remarks(
    governances: Sequence[Governance], permissions: Sequence[Permissions], domain: int | None
) -> Iterator[Diagnostic]:
    """Yield what is to be said of files that stand in no keystore."""
    about = [domains_of(one, domain) for one in permissions]
    for one, spans in zip(permissions, about, strict=True):
        if left := ungoverned(governances, spans):
            which = "no governance that is named is surely about it" if governances else "no governance is named"
            yield warning(one.grants[0].place, f"domain {written(left)}: {which}, {NOT_KNOWN}", ACCESS_GAP)
    everywhere = tuple(span for spans in about for span in spans)
    for first, other, shared in differing(governances, everywhere):
        message = (
            f"domain {written(shared)}: {other.rule.place} says something else, and which of them holds is not known"
        )
        yield warning(first.rule.place, f"{message}; what either leaves open counts; name the one that is deployed")
    for governance in governances:
        if not any(governed(governance, everywhere)):
            message = "governance of domains that no permissions named here are about: it is not used"
            yield warning(Place(governance.file, 0), f"{message}; name their permissions, or leave it out")


def apart_remarks(permissions: Sequence[Permissions], domain: int | None) -> Iterator[Diagnostic]:
    """Yield a warning for permissions of domains of their own: nothing goes from one domain to another."""
    if domain is not None:
        return
    for one, other in pairwise(file for file in permissions if any(grant.rules for grant in file.grants)):
        first, second = (domains_of(file, None) for file in (one, other))
        if not common(first, second):
            message = f"permissions for domain {written(second)}, and in {one.file} for domain {written(first)}"
            hint = "they are read as if they were in one domain; say which with --domain N"
            yield warning(other.grants[0].place, f"{message}: {hint}")
