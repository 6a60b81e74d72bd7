"""What Zenoh's access control decides of one message: whether it passes between a process and the other end of a link.

In: an access file, a link, and a message with its key. Out: whether it passes. The keys of a ``put`` are decided one by
one; a declaration is decided by its own expression, so a deny of less does not stop it.

Source: ``policy_decision_point`` of Zenoh; ``eclipse-zenoh`` 1.10.2 is the judge of the tests.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from rosprivacy.ingest.zenoh_access.access_file import PROPERTIES
from rosprivacy.ingest.zenoh_access.key_expressions import includes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ingest.zenoh_access.access_file import AccessFile, AccessRule, AccessSubject

Identity = tuple[str | None, ...]
"""One value for each of ``PROPERTIES``; None is anybody."""


@dataclass(frozen=True, slots=True)
class Link:
    """What is known of the other end of a link; its properties are named as those of a subject."""

    interfaces: frozenset[str] = frozenset()
    cert_common_names: frozenset[str] = frozenset()
    usernames: frozenset[str] = frozenset()
    link_protocols: frozenset[str] = frozenset()
    zids: frozenset[str] = frozenset()


def passes(access: AccessFile, link: Link, flow: str, message: str, key: str) -> bool:
    """Return whether a message passes.

    Of the rules of one identity a deny that includes the key wins; else the default or an allow that includes it lets
    it pass. Of several identities that the link has, one suffices.

    Parameters
    ----------
    flow
        ``egress``: what the process sends; ``ingress``: what it lets in.
    key
        The key or the expression of the message, as it is on the link: behind the namespace of the session.
    """
    if not access.decides:
        return access.allow or not access.enabled
    mine = [rules for identity, rules in identities(access).items() if _has(link, identity)]
    return any(_allowed(rules, flow, message, key, default=access.allow) for rules in mine) if mine else access.allow


def identities(access: AccessFile) -> dict[Identity, list[AccessRule]]:
    """Return the rules that hold for each identity; two subjects that state the same are one."""
    rules = {rule.id: rule for rule in access.rules}
    of_subject = {subject.id: _stated(subject) for subject in access.subjects}
    held: dict[Identity, list[AccessRule]] = defaultdict(list)
    for identities in of_subject.values():
        for identity in identities:
            held[identity] = []  # a subject without a policy has the default
    for policy in access.policies:
        for subject in policy.subjects:
            for identity in of_subject[subject]:
                held[identity] += (rules[name] for name in policy.rules)
    return held


def _stated(subject: AccessSubject) -> tuple[Identity, ...]:
    """Every combination of what a subject's lists name."""
    properties = dict(subject.properties)
    return tuple(dict.fromkeys(product(*(properties.get(name, (None,)) for name in PROPERTIES))))


def _has(link: Link, identity: Identity) -> bool:
    return all(value is None or value in getattr(link, name) for name, value in zip(PROPERTIES, identity, strict=True))


def _allowed(rules: Iterable[AccessRule], flow: str, message: str, key: str, *, default: bool) -> bool:
    said = {
        rule.allow
        for rule in rules
        if flow in rule.flows
        and message in rule.messages
        and any(includes(own, key) for own, _ in rule.key_expressions)
    }
    return False not in said and (default or True in said)
