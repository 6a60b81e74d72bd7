"""Zenoh's access control -> a ``Policy``: what the process that loads the file may send and receive, as grants.

In: access files. Out: for each an enclave with the file's name, and grants of the DDS topics that stand for the same
channels: a ``put`` is a message of a topic, a ``query`` the request leg of a service, a ``reply`` its response leg.
What is not certain is granted: an allow that is narrower than a channel allows the channel, a deny counts only if it
takes the whole channel from everybody (rules S5, S11).
"""

from __future__ import annotations

import hashlib
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import Diagnostic, Grant, Policy, Profile, Severity
from rosprivacy.ingest.policies.names import DDS, NON_ROS_KEYS
from rosprivacy.ingest.reading.bounded_file import contents
from rosprivacy.ingest.zenoh_access.access_decision import identities
from rosprivacy.ingest.zenoh_access.key_expressions import ONE
from rosprivacy.ingest.zenoh_access.ros_keys import HISTORY, MESSAGES, OTHERS, TOKENS, Keys, channels, domain_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.zenoh_access.access_decision import Identity
    from rosprivacy.ingest.zenoh_access.access_file import AccessFile, AccessRule
    from rosprivacy.ingest.zenoh_access.ros_keys import Channels

LEGS = {"put": ("rt", ""), "query": ("rq", "Request"), "reply": ("rr", "Reply")}
"""Messages with data, and how the DDS topic of the same channel begins and ends; others carry none."""
DATA = frozenset(LEGS)
ROLES = {"egress": "publish", "ingress": "subscribe"}
OTHER_WAY = {"publish": "subscribe", "subscribe": "publish"}
LATE = {"publish": "late joiners get the messages", "subscribe": "as a late joiner it gets the messages"}
Held = dict["Identity", list["AccessRule"]]


class Right(NamedTuple):
    """What a line allows or denies: ``publish`` or ``subscribe`` of a DDS topic."""

    allow: bool
    role: str
    dds: str
    place: Place


def policy_of(access: AccessFile, keys: Keys) -> Policy:
    """Return what the process with an access list may send and receive."""
    own = process_of(access)
    profile = Profile(own, own, access.place)
    said = list(_remarks(access, keys))
    held = identities(access) if access.decides else {}
    granted = rights(access, held, keys, said)
    grants = [
        Grant(right.allow, right.role, DDS, right.dds, own, own, right.place, access.file, absolute=True)
        for right in granted
    ]
    if not any(grant.allow for grant in grants):
        where = f" in domain {keys.domain}" if keys.domain != ONE else ""
        said.append(_warning(access.place, f"nothing is granted{where}: the process can send and receive no data"))
    digest = hashlib.sha256(contents(Path(access.file), access.file)).hexdigest()
    sources = ((access.file, digest),)
    return Policy(access.file, sources, (profile,), tuple(dict.fromkeys(grants)), tuple(dict.fromkeys(said)))


def process_of(access: AccessFile) -> str:
    """Return the name of the process that loads a file: that of the file."""
    return f"/{Path(access.file).stem}"


def keys_of(access: AccessFile, domain: int | None, namespaces: Iterable[str]) -> Keys:
    """Return which keys the messages of a session have.

    Parameters
    ----------
    domain
        That of the robot; None where it does not matter, since all keys are of the same one.
    namespaces
        Of all sessions.

    Raises
    ------
    InputErrors
        If the keys are of different domains, and none is given.
    """
    own = (access.namespace,) if access.namespace else ("", *sorted(set(namespaces) - {""}))
    if domain is not None:
        return Keys(str(domain), own)
    first = ""
    for key, place in (one for rule in access.rules for one in rule.key_expressions):
        written = domain_of(key, own)
        if written and first not in ("", written):
            what = f"keys of domain {first} and of domain {written}"
            raise InputErrors([PolicyError(place.file, place.line, what, "say which with --domain N")])
        first = written or first
    return Keys(first or ONE, own)


def rights(access: AccessFile, held: Held, keys: Keys, said: list[Diagnostic]) -> Iterator[Right]:
    """Yield what passes a list between its process and those at the other end of a link.

    Parameters
    ----------
    held
        The rules of the identities that these may have; of none where no rule is looked at.
    said
        Gets what a reader has to know.
    """
    if access.allow or not access.enabled:
        everything = [*(f"{begins}/*" for begins, _ in LEGS.values()), f"{NON_ROS_KEYS[0]}*", f"{NON_ROS_KEYS[1]}*"]
        yield from (Right(True, role, dds, access.place) for role in OTHER_WAY for dds in everything)
    everywhere = not access.allow or any(not any(identity) for identity in held)
    rules = dict.fromkeys(rule for rules in held.values() for rule in rules)
    late = frozenset(OTHER_WAY) if access.allow else _late(rules, keys)
    for rule in rules:
        if rule.allow:
            yield from _of_rule(rule, keys)
        else:
            for_all = everywhere and all(rule in some for some in held.values())
            yield from _of_deny(rule, keys, said, late if for_all else None)


def _remarks(access: AccessFile, keys: Keys) -> Iterator[Diagnostic]:
    if not access.enabled or access.allow:
        why = "default_permission is allow" if access.enabled else "access control is not enabled"
        yield _warning(access.place, f"{why}: whatever no deny names passes, and is read as granted")
    for rule in access.rules if access.namespace else ():
        for key, place in rule.key_expressions:
            if not any(channels(key, keys._replace(domain=ONE))):
                what = f"{shown(key)!r} is about no key of this session: they begin with its namespace"
                yield _warning(place, f"{what} {shown(access.namespace)!r}")


def _of_rule(rule: AccessRule, keys: Keys) -> Iterator[Right]:
    for key, place in rule.key_expressions:
        for some in channels(key, keys):
            for flow, message in product(rule.flows, rule.messages):
                yield from (Right(True, role, dds, place) for role, dds in _of_message(some, message, ROLES[flow]))


def _of_deny(rule: AccessRule, keys: Keys, said: list[Diagnostic], late: frozenset[str] | None) -> Iterator[Right]:
    """What a deny takes away, and what is said where it takes nothing.

    Parameters
    ----------
    late
        The roles in which late joiners are served by query and reply; None where the rule is not for everybody.
    """
    for key, place in rule.key_expressions if not DATA.isdisjoint(rule.messages) else ():
        for some in channels(key, keys):
            why = "" if some.whole else "it does not take a whole channel"
            if some.whole and late is None:
                why = "it does not hold for everybody"
            elif some.what in (OTHERS, TOKENS) and not DATA.issubset(rule.messages):
                why = why or "of keys that are no ROS channel it does not name put, query and reply"
            for flow, message in product(rule.flows, rule.messages):
                role = ROLES[flow]
                served = some.what == MESSAGES and message == "put" and role in (late or ())
                if not why and served and "reply" not in rule.messages:
                    said.append(_nothing(key, place, f"{LATE[role]} by reply all the same; deny both in one rule"))
                elif not why:
                    yield from (Right(False, role, dds, place) for role, dds in _of_message(some, message, role))
            if why:
                said.append(_nothing(key, place, why))


def _late(rules: Iterable[AccessRule], keys: Keys) -> frozenset[str]:
    """The roles in which a list lets queries for history through."""
    return frozenset(
        OTHER_WAY[ROLES[flow]]
        for rule in rules
        if rule.allow and "query" in rule.messages
        for key, _ in rule.key_expressions
        if any(some.what == HISTORY for some in channels(key, keys))
        for flow in rule.flows
    )


def _of_message(some: Channels, message: str, role: str) -> Iterator[tuple[str, str]]:
    """Yield (role, DDS topic) of a message with data.

    Who is asked for history sends messages of the topic, in replies with its own key; what is put behind ``@adv`` are
    numbers. Replies about tokens say who is there.
    """
    if message not in LEGS:
        return
    if some.what == MESSAGES:
        begins, ends = LEGS[message]
        yield from ((role, f"{begins}{name}{ends}") for name in some.names)
    elif some.what == HISTORY:
        yield from ((OTHER_WAY[role], f"rt{name}") for name in some.names if message == "query")
    elif not (some.what == TOKENS and message == "reply"):
        yield from ((role, name) for name in some.names)


def _nothing(key: str, place: Place, why: str) -> Diagnostic:
    return _warning(place, f"a deny of {shown(key)!r} is taken to deny nothing: {why}")


def _warning(place: Place, message: str) -> Diagnostic:
    return Diagnostic(place, Severity.WARNING, message)
