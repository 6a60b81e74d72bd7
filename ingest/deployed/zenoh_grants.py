"""Zenoh's access control -> policies: what each process may send and receive, and what lists leave to everybody.

In: configurations of a robot. Out: for each a ``Policy`` with an enclave of the file's name, and grants of the DDS
topics that stand for the same channels: a ``put`` is a message of a topic, a ``query`` the request leg of a service, a
``reply`` its response leg. What is not certain is granted: an allow that is narrower than a channel allows the channel,
a deny counts only if it takes the whole channel from everybody (rules S5, S11).

In the enforced view (rule S6) also what processes may do with a session that no list of their own holds back. A list
holds back the process that loads it, and no other. So whom a list does not tell from others can send what it lets in
and get what it lets out, and all of these are one enclave. Told apart is who has a certificate or a user name of his
own; an identity that a file is named after is that process, and whoever has another name may be any.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors, noting, shown
from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Policy, Profile, Severity
from rosprivacy.analysis.modes import View
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.deployed.access_file import PROPERTIES, identities, read_access
from rosprivacy.ingest.deployed.permissions import dds_grant, which_domain
from rosprivacy.ingest.deployed.zenoh_keys import (
    HISTORY,
    MESSAGES,
    ONE,
    OTHERS,
    TOKENS,
    Keys,
    channels,
    domain_of,
    namespaces_of,
)
from rosprivacy.ingest.policies.names import NON_ROS_KEYS
from rosprivacy.ingest.reading.bounded_file import contents

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.deployed.access_file import AccessFile, AccessRule, Identity
    from rosprivacy.ingest.deployed.zenoh_keys import Channels

LEGS = {"put": ("rt", ""), "query": ("rq", "Request"), "reply": ("rr", "Reply")}
"""Messages with data, and how the DDS topic of the same channel begins and ends; others carry none."""
DATA = frozenset(LEGS)
ROLES = {"egress": "publish", "ingress": "subscribe"}
OTHER_WAY = {"publish": "subscribe", "subscribe": "publish"}
LATE = {"publish": "late joiners get the messages", "subscribe": "as a late joiner it gets the messages"}
ANY_SESSION = "zenoh:any-session"
"""The enclave of all sessions that no list tells apart; no enclave of SROS 2 has such a name."""
_NAMES = tuple(PROPERTIES.index(name) for name in ("cert_common_names", "usernames"))
RulesHeld = dict["Identity", list["AccessRule"]]


class ZenohRight(NamedTuple):
    """What a line allows or denies: ``publish`` or ``subscribe`` of a DDS topic."""

    allow: bool
    role: str
    dds: str
    place: Place


def policy_of(access: AccessFile, keys: Keys) -> Policy:
    """Return what the process with an access list may send and receive."""
    own = process_of(access)
    profile = Profile(own, own, access.place)
    remarks = list(_remarks(access, keys))
    held = identities(access) if access.decides else {}
    granted = rights(access, held, keys, remarks)
    grants = [
        dds_grant(profile, access.file, right.place, right.role, right.dds, allow=right.allow) for right in granted
    ]
    if not any(grant.allow for grant in grants):
        where = f" in domain {keys.domain}" if keys.domain != ONE else ""
        remarks.append(_warning(access.place, f"nothing is granted{where}: the process can send and receive no data"))
    digest = hashlib.sha256(contents(Path(access.file), access.file)).hexdigest()
    sources = ((access.file, digest),)
    return Policy(access.file, sources, (profile,), tuple(dict.fromkeys(grants)), tuple(dict.fromkeys(remarks)))


def process_of(access: AccessFile) -> str:
    """Return the name of the process that loads a file: that of the file."""
    return f"/{Path(access.file).stem}"


def keys_of(access: AccessFile, domain: int | None, namespaces: Iterable[str]) -> Keys:
    """Return which keys the messages of a session have, in a domain and behind the namespaces of all sessions.

    The domain is that of the robot; None where it does not matter, since all keys are of the same one.

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
            raise which_domain(place, what)
        first = written or first
    return Keys(first or ONE, own)


def rights(access: AccessFile, rules_held: RulesHeld, keys: Keys, remarks: list[Diagnostic]) -> Iterator[ZenohRight]:
    """Yield what passes a list between its process and those at the other end of a link.

    Parameters
    ----------
    rules_held
        The rules of the identities that these may have; of none where no rule is looked at.
    said
        Gets what a reader has to know.
    """
    if access.allow or not access.enabled:
        everything = [*(f"{begins}/*" for begins, _ in LEGS.values()), f"{NON_ROS_KEYS[0]}*", f"{NON_ROS_KEYS[1]}*"]
        yield from (ZenohRight(True, role, dds, access.place) for role in OTHER_WAY for dds in everything)
    everywhere = not access.allow or any(not any(identity) for identity in rules_held)
    rules = dict.fromkeys(rule for rules in rules_held.values() for rule in rules)
    late = frozenset(OTHER_WAY) if access.allow else _late(rules, keys)
    for rule in rules:
        if rule.allow:
            yield from _of_rule(rule, keys)
        else:
            for_all = everywhere and all(rule in some for some in rules_held.values())
            yield from _of_deny(rule, keys, remarks, late if for_all else None)


def _remarks(access: AccessFile, keys: Keys) -> Iterator[Diagnostic]:
    if not access.enabled or access.allow:
        why = "default_permission is allow" if access.enabled else "access control is not enabled"
        yield _warning(access.place, f"{why}: whatever no deny names passes, and is read as granted")
    for rule in access.rules if access.namespace else ():
        for key, place in rule.key_expressions:
            if not any(channels(key, keys._replace(domain=ONE))):
                what = f"{shown(key)!r} is about no key of this session: they begin with its namespace"
                yield _warning(place, f"{what} {shown(access.namespace)!r}")


def _of_rule(rule: AccessRule, keys: Keys) -> Iterator[ZenohRight]:
    for key, place in rule.key_expressions:
        for some in channels(key, keys):
            for flow, message in product(rule.flows, rule.messages):
                yield from (ZenohRight(True, role, dds, place) for role, dds in _of_message(some, message, ROLES[flow]))


def _of_deny(
    rule: AccessRule, keys: Keys, remarks: list[Diagnostic], late: frozenset[str] | None
) -> Iterator[ZenohRight]:
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
            elif some.sort in (OTHERS, TOKENS) and not DATA.issubset(rule.messages):
                why = why or "of keys that are no ROS channel it does not name put, query and reply"
            for flow, message in product(rule.flows, rule.messages):
                role = ROLES[flow]
                served = some.sort == MESSAGES and message == "put" and role in (late or ())
                if not why and served and "reply" not in rule.messages:
                    remarks.append(_nothing(key, place, f"{LATE[role]} by reply all the same; deny both in one rule"))
                elif not why:
                    yield from (ZenohRight(False, role, dds, place) for role, dds in _of_message(some, message, role))
            if why:
                remarks.append(_nothing(key, place, why))


def _late(rules: Iterable[AccessRule], keys: Keys) -> frozenset[str]:
    """The roles in which a list lets queries for history through."""
    return frozenset(
        OTHER_WAY[ROLES[flow]]
        for rule in rules
        if rule.allow and "query" in rule.messages
        for key, _ in rule.key_expressions
        if any(some.sort == HISTORY for some in channels(key, keys))
        for flow in rule.flows
    )


def _of_message(channels: Channels, message: str, role: str) -> Iterator[tuple[str, str]]:
    """Yield (role, DDS topic) of a message with data.

    Who is asked for history sends messages of the topic, in replies with its own key; what is put behind ``@adv`` are
    numbers. Replies about tokens say who is there.
    """
    if message not in LEGS:
        return
    if channels.sort == MESSAGES:
        begins, ends = LEGS[message]
        yield from ((role, f"{begins}{name}{ends}") for name in channels.names)
    elif channels.sort == HISTORY:
        yield from ((OTHER_WAY[role], f"rt{name}") for name in channels.names if message == "query")
    elif not (channels.sort == TOKENS and message == "reply"):
        yield from ((role, name) for name in channels.names)


def _nothing(key: str, place: Place, why: str) -> Diagnostic:
    return _warning(place, f"a deny of {shown(key)!r} is taken to deny nothing: {why}")


def _warning(place: Place, message: str, code: str = "") -> Diagnostic:
    return Diagnostic(place, Severity.WARNING, message, code)


def open_sessions(files: Mapping[AccessFile, Keys], sources: tuple[tuple[str, str], ...]) -> Policy:
    """Return what processes may do where the lists of others do not tell them apart; nothing of a single process.

    ``files`` come with the keys of their sessions, ``sources`` are (file, SHA-256) of each.
    """
    known = {process_of(access): access.place for access in files}
    grants = [
        dds_grant(
            Profile(who or ANY_SESSION, process_of(access), access.place), f"{access.file}: {who or ANY_SESSION}",
            right.place, OTHER_WAY[right.role], right.dds, allow=right.allow,
        )
        for access, keys in (files.items() if len(known) > 1 else ())
        for who in ("", *sorted(known))
        for right in _left_to(who, access, keys, known)
    ]  # fmt: skip
    profiles = [Profile(ANY_SESSION, process, place) for process, place in sorted(known.items()) if grants]
    return Policy(ANY_SESSION, sources, tuple(profiles), tuple(dict.fromkeys(grants)))


def open_remarks(files: Mapping[AccessFile, Keys]) -> Iterator[Diagnostic]:
    """Yield a warning for each list that lets through what nobody knows of; its place is that of the list."""
    known = {process_of(access) for access in files}
    for access, keys in files.items():
        left = [right for right in _left_to("", access, keys, known) if right.allow]
        if not left:
            continue
        if access.enabled and not access.allow:
            ways = (("subscribe", "send {} that this list lets in"), ("publish", "get {} that this list lets out"))
            names = ((words, {right.dds for right in left if right.role == role}) for role, words in ways)
            what = " and ".join(words.format(counted(len(some), "name")) for words, some in names if some)
        else:
            what = "send this process all that no deny names, and get it from there"
        message = (
            f"{_senders(access, known)} may {what}: what such a session does is not known; the declared view takes "
        )
        message += "each process to keep to its own list (rule S6)"
        yield _warning(access.place, message, ACCESS_GAP)


def _left_to(process: str, access: AccessFile, keys: Keys, processes: Collection[str]) -> Iterable[ZenohRight]:
    """What passes to and from a process by its name, or those that are not told apart."""
    of_all = identities(access) if access.decides else {}
    held = {
        identity: rules
        for identity, rules in of_all.items()
        if process in (_processes_named(identity, processes) or {""})
    }
    if not held and (process or (access.enabled and not access.allow)):
        return ()
    return rights(access, held, keys, [])


def _processes_named(identity: Identity, processes: Collection[str]) -> set[str]:
    """The processes that an identity names; none if it may be any."""
    names = {f"/{name}" for at in _NAMES if (name := identity[at]) is not None}
    return names if names <= set(processes) else set()


def _senders(access: AccessFile, processes: Collection[str]) -> str:
    """Who is not told apart."""
    open_to = [identity for identity in identities(access) if not _processes_named(identity, processes)]
    names = sorted({name for identity in open_to for at in _NAMES if (name := identity[at]) is not None})
    if access.allow or not access.decides or any(all(one[at] is None for at in _NAMES) for one in open_to):
        return "any session"
    return f"whoever is {' or '.join(map(shown, names))}, after whom no file is named,"


def read_zenoh(files: Iterable[str], domain: int | None, *, view: str = View.declared) -> tuple[Policy, ...]:
    """Read configurations of Zenoh.

    Parameters
    ----------
    domain
        That of the robot; None where it does not matter, since all keys are of the same one.
    view
        The enforced view has also what sessions may do that no list tells apart (rule S6).

    Raises
    ------
    InputErrors
        With every problem, one line each.
    """
    read: list[AccessFile] = []
    problems: list[InputError] = []
    for file in files:
        with noting(problems):
            read.append(read_access(file))
    spaces = {access.namespace: access.place for access in read if access.namespace} | _written_for(read)
    keys: dict[AccessFile, Keys] = {}
    for access in read:
        with noting(problems):
            keys[access] = keys_of(access, domain, spaces)
    if problems:
        raise InputErrors(problems)
    remarks = (*open_remarks(keys), *_joined(spaces), *_one_name(read))
    policies = [_with(policy_of(access, of_it), remarks) for access, of_it in keys.items()]
    sources = tuple(sorted({source for policy in policies for source in policy.sources}))
    if View(view) is View.enforced and (left := open_sessions(keys, sources)).grants:
        policies.append(left)
    return tuple(policies)


def _with(policy: Policy, remarks: Iterable[Diagnostic]) -> Policy:
    """A policy with what is said of its file too: a saved graph keeps it there."""
    own = (one for one in remarks if one.place.file == policy.file)
    return replace(policy, diagnostics=(*policy.diagnostics, *own))


def _written_for(read: Iterable[AccessFile]) -> dict[str, Place]:
    """The namespaces that keys of sessions without one are written for, each with a line."""
    rules = (rule for access in read if not access.namespace for rule in access.rules)
    keys = (key for rule in rules for key in rule.key_expressions)
    return {namespace: place for key, place in keys for namespace in namespaces_of([key])}


def _joined(spaces: Mapping[str, Place]) -> Iterator[Diagnostic]:
    """A warning where keys stand behind several namespaces, of which only the names are read."""
    if len(spaces) > 1:
        last = max(spaces)
        named = ", ".join(repr(shown(one)) for one in sorted(spaces))
        message = f"keys behind namespaces {named}: Zenoh keeps them apart, here a name is one channel in all of them"
        yield _warning(spaces[last], message)


def _one_name(read: Iterable[AccessFile]) -> Iterator[Diagnostic]:
    """A gap where two files make one process: what goes from one of them to the other is no flow then (rule S11)."""
    first: dict[str, AccessFile] = {}
    for access in read:
        if (other := first.setdefault(process_of(access), access)) is not access:
            message = f"the process is called as that of {shown(other.file)}: both are one element here, and what goes "
            message += "from one to the other is not seen; give the files different names"
            yield _warning(access.place, message, ACCESS_GAP)
