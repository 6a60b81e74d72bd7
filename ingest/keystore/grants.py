"""Permissions of a domain -> a ``Policy``: the same grants as a policy's, with the rules in their order.

In: ``Permissions`` and a domain. Out: for each subject a profile, which is its enclave, and grants of DDS topics.
What is not certain is granted: a rule that is narrowed by partitions or data tags allows all that it names, and denies
nothing that it may not deny (rule S5, and S11: what is not known is said).

Source: DDS-Security 1.1, 9.4.1.3; ``Permissions.cpp`` of Fast DDS; sros2's ``permissions.xsl`` for the subjects.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import SEVERAL_PROFILES, Diagnostic, Grant, Policy, Profile, Severity
from rosprivacy.ingest.policies.names import DDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.keystore.permissions_file import Criterion, Permissions, Rule, SubjectGrant

DIRECTIONS = ("publish", "subscribe")
DEFAULT_PARTITION = ("", "*")  # expressions of partitions that hold the one that ROS 2 uses


def enclave_of(subject: str) -> str:
    """Return the enclave that the subject of a certificate names; another subject is taken whole.

    >>> enclave_of("CN=/robot/camera"), enclave_of("CN=Alice,O=Example")
    ('/robot/camera', 'CN=Alice,O=Example')
    """
    name = subject.removeprefix("CN=")
    return name if name.startswith("/") and "," not in name else subject


def policy_of(permissions: Permissions, domain: int | None, sources: tuple[tuple[str, str], ...]) -> Policy:
    """Return what permissions grant in a domain.

    Parameters
    ----------
    domain
        None where all rules are about the same domains, so that it does not matter.
    sources
        (file, SHA-256) of the permissions and of what counts with them, sorted.

    Raises
    ------
    InputErrors
        If the rules are about different domains, and none is given.
    """
    rules = [rule for grant in permissions.grants for rule in grant.rules]
    others = [rule for rule in rules if rule.domains != rules[0].domains]
    if domain is None and others:
        what = f"rules for domain {rules[0].domains} and for domain {others[0].domains}"
        place = others[0].place
        raise InputErrors([PolicyError(place.file, place.line, what, "say which with --domain N")])
    said: list[Diagnostic] = []
    profiles: dict[str, Profile] = {}
    grants: list[Grant] = []
    for grant in permissions.grants:
        enclave = enclave_of(grant.subject)
        dead = enclave in profiles
        if dead:
            message = f"second grant for {enclave}: the middleware uses the first one that is valid"
            message = f"{message}; what this one allows is read too, what it denies is not"
            said.append(Diagnostic(grant.place, Severity.WARNING, shown(message), SEVERAL_PROFILES))
        profile = profiles.setdefault(enclave, Profile(enclave, enclave, grant.place))
        grants += _grants(permissions.file, profile, grant, domain, dead=dead)
        said += _remarks(grant, domain)
    return Policy(permissions.file, sources, tuple(profiles.values()), tuple(grants), tuple(dict.fromkeys(said)))


def _grants(file: str, profile: Profile, grant: SubjectGrant, domain: int | None, *, dead: bool) -> Iterator[Grant]:
    for rank, rule in _rules(grant, domain):
        if not rule.allow and domain is not None and not rule.domains.surely(domain):
            continue  # to some middleware it is about another domain
        for criterion in rule.criteria:
            if criterion.direction in DIRECTIONS and (rule.allow or is_about_ros(criterion)):
                for dds, place in criterion.topics:
                    yield Grant(
                        rule.allow, criterion.direction, DDS, dds, profile.enclave, profile.node, place, file, dead,
                        absolute=True, rank=rank,
                    )  # fmt: skip
    if grant.allow:
        for direction in DIRECTIONS:
            yield Grant(
                True, direction, DDS, "*", profile.enclave, profile.node, grant.default, file, dead,
                absolute=True, rank=len(grant.rules) + 1,
            )  # fmt: skip


def _rules(grant: SubjectGrant, domain: int | None) -> Iterator[tuple[int, Rule]]:
    """The rules of a domain, with their places from 1."""
    for rank, rule in enumerate(grant.rules, 1):
        if domain is None or domain in rule.domains:
            yield rank, rule


def is_about_ros(criterion: Criterion) -> bool:
    """Return whether a DENY takes away what ROS 2 writes and reads: in the default partition, without data tags."""
    here = not criterion.partitions or any(name in DEFAULT_PARTITION for name in criterion.partitions)
    return here and not criterion.tags


def _remarks(grant: SubjectGrant, domain: int | None) -> Iterator[Diagnostic]:
    """What a reader has to know of a grant."""
    rules = list(_rules(grant, domain))
    if domain is not None and not rules:
        yield _warning(grant.place, f"grant of {grant.subject} has no rule for domain {domain}: it cannot join it")
    for _, rule in rules:
        if domain is not None and not rule.domains.surely(domain):
            what = "it is taken to allow there" if rule.allow else "it is taken to deny nothing there"
            message = (
                f"<id_range> without <max>: to Fast DDS and Cyclone DDS not about domain {domain}, in the standard"
            )
            yield _warning(rule.place, f"{message} it is; {what}; write <max>")
        for criterion in rule.criteria:
            yield from _narrowed(rule, criterion)
    if grant.allow:
        message = "<default>ALLOW: what no rule names is allowed, as DDS-Security has it and Cyclone DDS does"
        yield _warning(grant.default, f"{message}; Fast DDS refuses it")


def _narrowed(rule: Rule, criterion: Criterion) -> Iterator[Diagnostic]:
    if criterion.direction not in DIRECTIONS:
        yield _notice(criterion.place, f"<{criterion.direction}> is not read: no ROS node relays")
        return
    if criterion.tags:
        what = "they allow more than they say" if rule.allow else "this rule is taken to deny nothing"
        message = f"<data_tags>: Fast DDS and Cyclone DDS do not look at them, so {what}"
        yield _warning(criterion.place, f"{message}; state the topics themselves")
    if criterion.partitions and not any(name in DEFAULT_PARTITION for name in criterion.partitions):
        named = ", ".join(map(shown, criterion.partitions))
        what = "it is taken to allow them there" if rule.allow else "it is taken to deny nothing"
        message = f"<partitions> {named}: ROS 2 writes and reads in the default partition"
        yield _warning(criterion.place, f"{message}; {what}")


def expired(permissions: Iterable[Permissions], today: str) -> Iterator[Diagnostic]:
    """Yield a warning for each grant that is not valid on a day, such as ``2026-11-22``."""
    for grant in (grant for file in permissions for grant in file.grants):
        first, last = grant.not_before.date().isoformat(), grant.not_after.date().isoformat()
        if not first <= today <= last:
            message = f"grant of {grant.subject} is valid from {first} to {last}, not on {today}: a middleware refuses"
            yield _warning(grant.place, f"{message} it now; it is read, since it can be renewed")


def _warning(place: Place, message: str) -> Diagnostic:
    return Diagnostic(place, Severity.WARNING, shown(message))


def _notice(place: Place, message: str) -> Diagnostic:
    return Diagnostic(place, Severity.NOTICE, shown(message))
