"""What Zenoh's access control decides of one message: whether it passes between a process and the other end of a link.

In: an access file, a link, and a message with its key. Out: whether it passes. The keys of a ``put`` are decided one by
one; a declaration is decided by its own expression, so a deny of less does not stop it. This is the plain form of what
grants say of all keys at once.

Source: ``policy_decision_point`` of Zenoh; ``eclipse-zenoh`` 1.10.2 is the judge of the tests.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.ingest.deployed.access_file import PROPERTIES, identities
from rosprivacy.ingest.deployed.zenoh_keys import includes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ingest.deployed.access_file import AccessFile, AccessRule, Identity


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
