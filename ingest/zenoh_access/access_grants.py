"""Zenoh's access control -> a ``Policy``: what the process that loads the file may send and receive, as grants.

In: the paths of configurations (JSON5). Out: for each an enclave with the file's name, and grants of the DDS topics
that stand for the same channels: a ``put`` is a message of a topic, a ``query`` the request leg of a service, a
``reply`` its response leg. What is not certain is granted: an allow that is narrower than a channel allows the channel,
a deny counts only if it takes the whole channel from everybody (rules S5, S11).

Source: the keys of rmw_zenoh, ``<domain>/<name>/<type>/<hash>``.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Grant, Policy, Profile, Severity
from rosprivacy.ingest.policies.names import DDS
from rosprivacy.ingest.reading.bounded_file import contents
from rosprivacy.ingest.zenoh_access.access_decision import identities
from rosprivacy.ingest.zenoh_access.access_file import read_access
from rosprivacy.ingest.zenoh_access.key_expressions import ANY, INSIDE, ONE, VERBATIM, intersects

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.zenoh_access.access_file import AccessFile, AccessRule

LEGS = {"put": ("rt", ""), "query": ("rq", "Request"), "reply": ("rr", "Reply")}
"""Messages with data, and how the DDS topic of the same channel begins and ends; others carry none."""
ROLES = {"egress": "publish", "ingress": "subscribe"}
_KEY = 2  # chunks after the name: type and hash


def read_zenoh(files: Iterable[str], domain: int | None) -> tuple[Policy, ...]:
    """Read configurations of Zenoh.

    Parameters
    ----------
    domain
        That of the robot; None where it does not matter, since all keys are of the same one.

    Raises
    ------
    InputErrors
        With every problem, one line each.
    """
    policies: list[Policy] = []
    problems: list[InputError] = []
    for file in files:
        try:
            policies.append(policy_of(read_access(file), domain))
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    return tuple(policies)


def policy_of(access: AccessFile, domain: int | None) -> Policy:
    """Return what the process with an access list may send and receive.

    Raises
    ------
    InputErrors
        If the keys are of different domains, and none is given.
    """
    own = f"/{Path(access.file).stem}"
    profile = Profile(own, own, access.place)
    said: list[Diagnostic] = []
    grants = [
        Grant(allow, ROLES[flow], DDS, dds, own, own, place, access.file, absolute=True)
        for allow, flow, dds, place in _granted(access, _domain(access, domain), said)
    ]
    if not any(grant.allow for grant in grants):
        where = f" in domain {domain}" if domain is not None else ""
        said.append(_warning(access.place, f"nothing is granted{where}: the process can send and receive no data"))
    digest = hashlib.sha256(contents(Path(access.file), access.file)).hexdigest()
    sources = ((access.file, digest),)
    return Policy(access.file, sources, (profile,), tuple(dict.fromkeys(grants)), tuple(dict.fromkeys(said)))


def _domain(access: AccessFile, domain: int | None) -> str:
    """The domain as a chunk; ``*`` where it does not matter."""
    if domain is not None:
        return str(domain)
    first = ""
    for rule in access.rules:
        for key, place in rule.key_expressions:
            written = key.split("/")[0]
            if written.isdigit() and first not in ("", written):
                what = f"keys of domain {first} and of domain {written}"
                raise InputErrors([PolicyError(place.file, place.line, what, "say which with --domain N")])
            first = written if written.isdigit() else first
    return first or ONE


def _granted(access: AccessFile, domain: str, said: list[Diagnostic]) -> Iterator[tuple[bool, str, str, Place]]:
    """Yield (allowed, flow, DDS topic, line)."""
    rules = identities(access)
    decided = access.enabled and all((access.rules, access.subjects, access.policies))
    if not access.enabled or access.allow:
        why = "default_permission is allow" if access.enabled else "access control is not enabled"
        said.append(_warning(access.place, f"{why}: whatever no deny names passes, and is read as granted"))
        yield from ((True, flow, f"{begins}/*", access.place) for flow in ROLES for begins, _ in LEGS.values())
    if not decided:
        return
    if all(not any(identity) for identity in rules):
        message = "no subject says who is at the other end: this list holds its own process back, and nobody who sends"
        said.append(Diagnostic(access.place, Severity.NOTICE, f"{message} is told from another"))
    everywhere = not access.allow or any(not any(identity) for identity in rules)
    for rule in dict.fromkeys(rule for held in rules.values() for rule in held):
        for_all = everywhere and all(rule in held for held in rules.values())
        yield from _of_rule(rule, domain, said, for_all=for_all)


def _of_rule(
    rule: AccessRule, domain: str, said: list[Diagnostic], *, for_all: bool
) -> Iterator[tuple[bool, str, str, Place]]:
    messages = [message for message in rule.messages if message in LEGS]
    for key, place in rule.key_expressions if messages else ():
        first = key.split("/")[0]
        names, exact = ros_names(key)
        if not names or not (first.isdigit() or _is_wild(first)):
            message = f"{shown(key)!r} is not read: rmw_zenoh has <domain>/<name>/<type>/<hash>"
            code = ACCESS_GAP if rule.allow else ""  # what it allows is not known
            said.append(Diagnostic(place, Severity.WARNING, message, code))
            continue
        if not intersects(key, f"{domain}/**"):
            continue
        whole = exact and first in (ONE, ANY, domain)
        if not rule.allow and not (whole and for_all):
            why = "it does not hold for everybody" if whole else "it does not take a whole channel"
            said.append(_warning(place, f"a deny of {shown(key)!r} is taken to deny nothing: {why}"))
            continue
        for flow in rule.flows:
            for begins, ends in (LEGS[message] for message in messages):
                yield from ((rule.allow, flow, f"{begins}{name}{ends}", place) for name in names)


def ros_names(key: str) -> tuple[tuple[str, ...], bool]:
    """Return the names that a key expression is about, and whether it is about nothing less than all of each.

    >>> ros_names("0/camera/image/*/*"), ros_names("0/camera/**")
    ((('/camera/image',), True), (('/camera', '/camera/*'), True))
    >>> ros_names("*/$*cam/*/*"), ros_names("**")
    ((('/*cam',), False), (('/*',), True))
    """
    first, *rest = key.split("/")
    if VERBATIM in (chunk[0] for chunk in (first, *rest)):
        return (), False
    if first == ANY:
        return ("/*",), not rest
    if ANY not in rest:
        name = rest[:-_KEY]
        exact = rest[-_KEY:] == [ONE] * _KEY and not any(map(_is_wild, name))
        return (_written(name),) if name else (), exact
    base = rest[: rest.index(ANY)]
    exact = rest[-1:] == [ANY] and len(base) == len(rest) - 1 and not any(map(_is_wild, base))
    while base and (base[-1] == ONE or "::" in base[-1] or base[-1].startswith("RIHS")):
        base, exact = base[:-1], False  # perhaps the type or the hash
    return (_written(base), _written([*base, ONE])) if base else (_written([ONE]),), exact


def _is_wild(chunk: str) -> bool:
    return chunk in (ONE, ANY) or INSIDE in chunk or "[" in chunk


def _written(name: list[str]) -> str:
    """A name as policies write it, where ``*`` is more than a chunk, and ``[`` is no letter."""
    return "".join(f"/{chunk.replace(INSIDE, ONE).replace('[', '?')}" for chunk in name)


def _warning(place: Place, message: str) -> Diagnostic:
    return Diagnostic(place, Severity.WARNING, message)
