"""DDS-Security permissions -> what each subject may do; and the ``Policy`` that says the same of a domain.

In: the text of a permissions file. Out: ``Permissions``, rule by rule as it is written, or every problem at its line;
for each subject a profile, which is its enclave, and grants of DDS topics with the rules in their order. What is not
certain is granted: a rule that is narrowed by partitions or data tags allows all that it names, and denies nothing that
it may not deny (rule S5, and S11: what is not known is said).

Source: DDS-Security 1.1, 9.4.1.3; ``Permissions.cpp`` of Fast DDS; sros2's ``permissions.xsl`` for the subjects.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import SEVERAL_PROFILES, Diagnostic, Grant, Policy, Profile, Severity
from rosprivacy.analysis.python_311 import from_iso
from rosprivacy.ingest.deployed.security_xml import Domains, XmlSource, security_entries, warning
from rosprivacy.ingest.policies.names import DDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.deployed.security_xml import XmlSection

RULES = {"allow_rule": True, "deny_rule": False}
CRITERIA = ("publish", "subscribe", "relay")
DIRECTIONS = CRITERIA[:2]
DEFAULT_PARTITION = ("", "*")  # expressions of partitions that hold the one that ROS 2 uses
NOWHERE = Domains(())
_TIME = re.compile(r"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d)(?:\.\d+)?(Z|[+-]\d\d:\d\d)?")


@dataclass(frozen=True, slots=True)
class PermissionCriterion:
    """What one ``<publish>``, ``<subscribe>`` or ``<relay>`` is about.

    Attributes
    ----------
    topics
        (expression, where it stands), as written.
    partitions
        Expressions; empty where none is written: then it is about the default partition, which ROS 2 uses.
    tags
        Whether ``<data_tags>`` narrow it, which Fast DDS and Cyclone DDS do not look at.
    """

    direction: str
    topics: tuple[tuple[str, Place], ...]
    partitions: tuple[str, ...]
    tags: bool
    place: Place


@dataclass(frozen=True, slots=True)
class PermissionRule:
    """``<allow_rule>`` or ``<deny_rule>``; the first that matches decides."""

    allow: bool
    domains: Domains
    criteria: tuple[PermissionCriterion, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class SubjectGrant:
    """What a certificate's subject may do, and when.

    Attributes
    ----------
    allow
        ``<default>``: what holds where no rule matches.
    default
        Where that stands.
    not_before, not_after
        Without a time zone it is UTC.
    """

    name: str
    subject: str
    not_before: datetime
    not_after: datetime
    rules: tuple[PermissionRule, ...]
    allow: bool
    default: Place
    place: Place


@dataclass(frozen=True, slots=True)
class Permissions:
    """All grants of a permissions file, in its order."""

    file: str
    grants: tuple[SubjectGrant, ...]


def read_permissions(data: bytes, file: str, before: int = 0) -> Permissions:
    """Read the text of a permissions file, before which so many lines stand; ``InputErrors`` has every problem."""
    source = XmlSource(file, before)
    grants = tuple(map(_subject_grant, security_entries(data, source, "permissions", "grant")))
    source.check()
    return Permissions(file, grants)


def _subject_grant(grant: XmlSection) -> SubjectGrant:
    tags = {"subject_name", "validity", "default", *RULES}
    parts = {tag: grant.child(tag, tags) for tag in ("subject_name", "validity", "default")}
    subject, validity, default = parts["subject_name"], parts["validity"], parts["default"]
    if subject and not subject.text.strip():
        grant.source.problem(subject.element, "<subject_name> is empty", "write the subject of a certificate")
    rules = tuple(_rule(rule) for rule in grant.children(tags) if rule.tag in RULES)
    first, last = (_time(end) for end in _ends(validity))
    return SubjectGrant(
        str(grant.element.get("name") or ""),
        subject.text.strip() if subject else "",
        first,
        last,
        rules,
        default is not None and default.chosen({"ALLOW", "DENY"}, "DENY") == "ALLOW",
        default.place if default else grant.place,
        grant.place,
    )


def _ends(validity: XmlSection | None) -> tuple[XmlSection | None, XmlSection | None]:
    if validity is None:
        return None, None
    return validity.child("not_before", {"not_after"}), validity.child("not_after", {"not_before"})


def _time(end: XmlSection | None) -> datetime:
    """A moment of the XML schema's ``dateTime``; whole seconds."""
    if end is None:
        return datetime.min.replace(tzinfo=timezone.utc)
    match = _TIME.fullmatch(end.text.strip())
    try:
        written = from_iso(match[1] + (match[2] or "")) if match else None
    except ValueError:
        written = None
    if written is None:
        what = f"{shown(repr(end.text.strip()))} in <{end.tag}>"
        end.source.problem(end.element, what, "write a moment such as 2026-01-31T00:00:00Z")
        return datetime.min.replace(tzinfo=timezone.utc)
    return written if written.tzinfo else written.replace(tzinfo=timezone.utc)


def _rule(rule: XmlSection) -> PermissionRule:
    domains = rule.child("domains", CRITERIA)
    criteria = tuple(_criterion(child) for child in rule.children({"domains", *CRITERIA}) if child.tag in CRITERIA)
    return PermissionRule(RULES[rule.tag], domains.domains() if domains else NOWHERE, criteria, rule.place)


def _criterion(criterion: XmlSection) -> PermissionCriterion:
    topics: list[tuple[str, Place]] = []
    partitions: list[str] = []
    tags = False
    for part in criterion.children({"topics", "partitions", "data_tags"}):
        if part.tag == "topics":
            topics += ((name.text, name.place) for name in _domains_named(part, "topic"))
        elif part.tag == "partitions":
            partitions += (name.text for name in _domains_named(part, "partition"))
        else:
            tags = True
    return PermissionCriterion(criterion.tag, tuple(topics), tuple(partitions), tags, criterion.place)


def _domains_named(part: XmlSection, tag: str) -> Iterator[XmlSection]:
    names = list(part.children({tag}))
    if not names:
        part.source.problem(part.element, f"<{part.tag}> is empty", f"add a <{tag}>")
    for name in names:
        if name.text or tag == "partition":  # the empty partition is the default one
            yield name
        else:
            part.source.problem(name.element, f"<{tag}> without a name", "write a name, or * for all")


def enclave_of(subject: str) -> str:
    """Return the enclave that the subject of a certificate names; another subject is taken whole.

    >>> enclave_of("CN=/robot/camera"), enclave_of("CN=Alice,O=Example")
    ('/robot/camera', 'CN=Alice,O=Example')
    """
    name = subject.removeprefix("CN=")
    return name if name.startswith("/") and "," not in name else subject


def which_domain(place: Place, message: str) -> InputErrors:
    """Return the error that what is read is about several domains, and none is given."""
    return InputErrors([PolicyError(place.file, place.line, message, "say which with --domain N")])


def dds_grant(
    of: Profile, policy: str, place: Place, role: str, dds: str, *, allow: bool, rank: int = 0, dead: bool = False
) -> Grant:
    """Return a grant that names a DDS topic, or an expression of such; no namespace goes before it."""
    return Grant(allow, role, DDS, dds, of.enclave, of.node, place, policy, dead, absolute=True, rank=rank)


def policy_of(permissions: Permissions, domain: int | None, sources: tuple[tuple[str, str], ...]) -> Policy:
    """Return what permissions grant in a domain; None where all rules are about the same domains.

    ``sources`` are (file, SHA-256) of the permissions and of what counts with them, sorted.

    Raises
    ------
    InputErrors
        If the rules are about different domains, and none is given.
    """
    rules = [rule for grant in permissions.grants for rule in grant.rules]
    others = [rule for rule in rules if rule.domains != rules[0].domains]
    if domain is None and others:
        what = f"rules for domain {rules[0].domains} and for domain {others[0].domains}"
        raise which_domain(others[0].place, what)
    remarks: list[Diagnostic] = []
    profiles: dict[str, Profile] = {}
    grants: list[Grant] = []
    for grant in permissions.grants:
        enclave = enclave_of(grant.subject)
        dead = enclave in profiles
        if dead:
            message = f"second grant for {enclave}: the middleware uses the first one that is valid"
            message = f"{message}; what this one allows is read too, what it denies is not"
            remarks.append(warning(grant.place, message, SEVERAL_PROFILES))
        profile = profiles.setdefault(enclave, Profile(enclave, enclave, grant.place))
        grants += _grants(permissions.file, profile, grant, domain, dead=dead)
        remarks += _remarks(grant, domain)
    return Policy(permissions.file, sources, tuple(profiles.values()), tuple(grants), tuple(dict.fromkeys(remarks)))


def _grants(file: str, profile: Profile, grant: SubjectGrant, domain: int | None, *, dead: bool) -> Iterator[Grant]:
    for rank, rule in _rules(grant, domain):
        if not rule.allow and domain is not None and not rule.domains.surely(domain):
            continue  # to some middleware it is about another domain
        for criterion in rule.criteria:
            if criterion.direction in DIRECTIONS and (rule.allow or is_about_ros(criterion)):
                for dds, place in criterion.topics:
                    yield dds_grant(
                        profile, file, place, criterion.direction, dds, allow=rule.allow, rank=rank, dead=dead
                    )
    if grant.allow:
        for direction in DIRECTIONS:
            rank = len(grant.rules) + 1
            yield dds_grant(profile, file, grant.default, direction, "*", allow=True, rank=rank, dead=dead)


def _rules(grant: SubjectGrant, domain: int | None) -> list[tuple[int, PermissionRule]]:
    """The rules of a domain, with their places from 1."""
    return [(rank, rule) for rank, rule in enumerate(grant.rules, 1) if domain is None or domain in rule.domains]


def is_about_ros(criterion: PermissionCriterion) -> bool:
    """Return whether a DENY takes away what ROS 2 writes and reads: in the default partition, without data tags."""
    here = not criterion.partitions or any(name in DEFAULT_PARTITION for name in criterion.partitions)
    return here and not criterion.tags


def _remarks(grant: SubjectGrant, domain: int | None) -> Iterator[Diagnostic]:
    """What a reader has to know of a grant."""
    rules = _rules(grant, domain)
    if domain is not None and not rules:
        yield warning(grant.place, f"grant of {grant.subject} has no rule for domain {domain}: it cannot join it")
    for _, rule in rules:
        if domain is not None and not rule.domains.surely(domain):
            what = "it is taken to allow there" if rule.allow else "it is taken to deny nothing there"
            message = (
                f"<id_range> without <max>: to Fast DDS and Cyclone DDS not about domain {domain}, in the standard"
            )
            yield warning(rule.place, f"{message} it is; {what}; write <max>")
        for criterion in rule.criteria:
            yield from _narrowed(rule, criterion)
    if grant.allow:
        message = "<default>ALLOW: what no rule names is allowed, as DDS-Security has it and Cyclone DDS does"
        yield warning(grant.default, f"{message}; Fast DDS refuses it")


def _narrowed(rule: PermissionRule, criterion: PermissionCriterion) -> Iterator[Diagnostic]:
    if criterion.direction not in DIRECTIONS:
        message = f"<{criterion.direction}> is not read: no ROS node relays"
        yield Diagnostic(criterion.place, Severity.NOTICE, shown(message))
        return
    if criterion.tags:
        what = "they allow more than they say" if rule.allow else "this rule is taken to deny nothing"
        message = f"<data_tags>: Fast DDS and Cyclone DDS do not look at them, so {what}"
        yield warning(criterion.place, f"{message}; state the topics themselves")
    if criterion.partitions and not any(name in DEFAULT_PARTITION for name in criterion.partitions):
        named = ", ".join(map(shown, criterion.partitions))
        what = "it is taken to allow them there" if rule.allow else "it is taken to deny nothing"
        message = f"<partitions> {named}: ROS 2 writes and reads in the default partition"
        yield warning(criterion.place, f"{message}; {what}")


def expired(permissions: Iterable[Permissions], today: str) -> Iterator[Diagnostic]:
    """Yield a warning for each grant that is not valid on a day, such as ``2026-11-22``."""
    for grant in (grant for file in permissions for grant in file.grants):
        first, last = grant.not_before.date().isoformat(), grant.not_after.date().isoformat()
        if not first <= today <= last:
            message = f"grant of {grant.subject} is valid from {first} to {last}, not on {today}: a middleware refuses"
            yield warning(grant.place, f"{message} it now; it is read, since it can be renewed")
