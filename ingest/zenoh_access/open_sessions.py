"""What access lists of Zenoh leave to everybody: grants of the enforced view, and what is to be said of it (rule S6).

In: all access files of a robot. Out: a ``Policy`` of what processes may do with a session that no list of their own
holds back, and a warning for each list that lets such a session in. A list holds back the process that loads it, and
no other. So whom a list does not tell from others can send what it lets in and get what it lets out, and all of these
are one enclave. Told apart is who has a certificate or a user name of his own; an identity that a file is named after
is that process, and whoever has another name may be any.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Grant, Policy, Profile, Severity
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.policies.names import DDS
from rosprivacy.ingest.zenoh_access.access_decision import identities
from rosprivacy.ingest.zenoh_access.access_file import PROPERTIES
from rosprivacy.ingest.zenoh_access.access_grants import OTHER_WAY, process_of, rights

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.ingest.zenoh_access.access_decision import Identity
    from rosprivacy.ingest.zenoh_access.access_file import AccessFile
    from rosprivacy.ingest.zenoh_access.access_grants import Right
    from rosprivacy.ingest.zenoh_access.ros_keys import Keys

ANY_SESSION = "zenoh:any-session"
"""The enclave of all sessions that no list tells apart; no enclave of SROS 2 has such a name."""
_NAMES = tuple(PROPERTIES.index(name) for name in ("cert_common_names", "usernames"))


def open_sessions(files: Mapping[AccessFile, Keys], sources: tuple[tuple[str, str], ...]) -> Policy:
    """Return what processes may do where the lists of others do not tell them apart; nothing of a single process.

    Parameters
    ----------
    files
        Each with the keys of its session.
    sources
        (file, SHA-256) of each.
    """
    known = {process_of(access): access.place for access in files}
    grants = [
        Grant(right.allow, OTHER_WAY[right.role], DDS, right.dds, who or ANY_SESSION, process_of(access), right.place,
              f"{access.file}: {who or ANY_SESSION}", absolute=True)
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
        message = f"{_who(access, known)} may {what}: what such a session does is not known; the declared view takes "
        message += "each process to keep to its own list (rule S6)"
        yield Diagnostic(access.place, Severity.WARNING, message, ACCESS_GAP)


def _left_to(who: str, access: AccessFile, keys: Keys, known: Collection[str]) -> Iterable[Right]:
    """What passes to and from a process by its name, or those that are not told apart."""
    of_all = identities(access) if access.decides else {}
    held = {identity: rules for identity, rules in of_all.items() if who in (_named(identity, known) or {""})}
    if not held and (who or (access.enabled and not access.allow)):
        return ()
    return rights(access, held, keys, [])


def _named(identity: Identity, known: Collection[str]) -> set[str]:
    """The processes that an identity names; none if it may be any."""
    names = {f"/{name}" for at in _NAMES if (name := identity[at]) is not None}
    return names if names <= set(known) else set()


def _who(access: AccessFile, known: Collection[str]) -> str:
    """Who is not told apart."""
    open_to = [identity for identity in identities(access) if not _named(identity, known)]
    names = sorted({name for identity in open_to for at in _NAMES if (name := identity[at]) is not None})
    if access.allow or not access.decides or any(all(one[at] is None for at in _NAMES) for one in open_to):
        return "any session"
    return f"whoever is {' or '.join(map(shown, names))}, after whom no file is named,"
