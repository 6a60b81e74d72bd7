"""Keystores, permissions and governance files -> policies: what is deployed, in the facts that a policy gives.

In: their paths. Out: ``Policy`` facts, with what a reader has to know of governance, signatures and dates.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.analysis.modes import View
from rosprivacy.ingest.keystore.certificate import pinned
from rosprivacy.ingest.keystore.files_alone import read_alone
from rosprivacy.ingest.keystore.governance_remarks import governance_remarks, rule_remarks
from rosprivacy.ingest.keystore.governing import domains_of, governed
from rosprivacy.ingest.keystore.grants import expired, policy_of
from rosprivacy.ingest.keystore.joint_remarks import apart_remarks, joint_remarks
from rosprivacy.ingest.keystore.keystore_folder import read_keystore
from rosprivacy.ingest.keystore.open_topics import open_topics
from rosprivacy.ingest.keystore.protections import protection
from rosprivacy.ingest.keystore.told_apart import is_keystore

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Diagnostic, Policy
    from rosprivacy.ingest.keystore.governing import Governed
    from rosprivacy.ingest.keystore.permissions_file import Permissions

Read = tuple[tuple["Policy", ...], tuple["Diagnostic", ...]]
ALONE = "not verified with --permissions-ca, since it is named without its keystore"
_Found = tuple[list["Policy"], list["Diagnostic"]]


def read_deployed(
    arguments: Iterable[str],
    domain: int | None,
    today: str,
    *,
    allow_unsigned: bool = False,
    view: str = View.declared,
    besides: Iterable[str] = (),
    authorities: tuple[str, ...] = (),
) -> Read:
    """Read keystores, and permissions and governance files in any order.

    Parameters
    ----------
    domain
        That of the robot; None where it does not matter, since all rules are about the same ones.
    today
        ISO date on which grants and certificates are valid or not.
    allow_unsigned
        Whether what is not signed, or badly, is read too. A file that is named by itself has no keystore that says who
        may sign it, so it is read in this way only.
    view
        The enforced view has also what the governance leaves to everybody (rule S6).
    besides
        Files and folders that somebody else reads.
    authorities
        Certificates or fingerprints of the CAs that may have signed; none where that of a keystore may. A file that is
        named by itself is not verified, so it is refused then.

    Raises
    ------
    InputErrors
        With every problem, one line each.
    """
    arguments = tuple(arguments)
    try:
        reading = _Reading(domain, today, allow_unsigned, view, tuple(besides), pinned(authorities))
    except PolicyError as error:
        raise InputErrors([error]) from None
    alone = [argument for argument in arguments if not is_keystore(argument)]
    parts = [partial(reading.keystore, argument) for argument in arguments if is_keystore(argument)]
    policies: list[Policy] = []
    said: list[Diagnostic] = []
    problems: list[InputError] = []
    for part in (*parts, *([partial(reading.alone, alone)] if alone else ())):
        try:
            read, more = part()
        except InputErrors as error:
            problems += error.errors
        else:
            policies += read
            said += more
    if problems:
        raise InputErrors(problems)
    return tuple(policies), tuple(dict.fromkeys(said))


class _Reading(NamedTuple):
    """How to read, as ``read_deployed`` is told."""

    domain: int | None
    today: str
    allow_unsigned: bool
    view: str
    besides: tuple[str, ...]
    pins: frozenset[str]

    def keystore(self, folder: str) -> _Found:
        """What a keystore grants; each enclave has a governance beside it."""
        enclaves, told = read_keystore(
            folder, self.today, allow_unsigned=self.allow_unsigned, besides=self.besides, pins=self.pins
        )
        policies: list[Policy] = []
        said = list(told)
        for enclave in enclaves:
            found = governed(enclave.governance, domains_of(enclave.permissions, self.domain))
            policies += self._granted(enclave.permissions, enclave.sources, found)
            said += governance_remarks(enclave.governance, enclave.permissions, self.domain)
        said += self._remarks([enclave.permissions for enclave in enclaves])
        return policies, sorted(said, key=lambda d: (d.place.file, d.place.line, d.message))

    def alone(self, names: Iterable[str]) -> _Found:
        """What files by themselves grant; each governance counts for the domains that its rules name."""
        if self.pins:
            raise InputErrors([PolicyError(name, 0, ALONE, "name the keystore") for name in names])
        read = read_alone(names, allow_unsigned=self.allow_unsigned)
        policies: list[Policy] = []
        said: list[Diagnostic] = []
        for permissions, source in read.permissions:
            about = domains_of(permissions, self.domain)
            found = [(hashed, one) for governance, hashed in read.governances for one in governed(governance, about)]
            sources = tuple(sorted({source, *(hashed for hashed, _ in found)}))
            policies += self._granted(permissions, sources, (one for _, one in found))
            said += (remark for _, one in found for remark in rule_remarks(one.rule))
        stated = [permissions for permissions, _ in read.permissions]
        said += joint_remarks([governance for governance, _ in read.governances], stated, self.domain)
        return policies, [*said, *self._remarks(stated)]

    def _granted(
        self, permissions: Permissions, sources: tuple[tuple[str, str], ...], found: Iterable[Governed]
    ) -> Iterator[Policy]:
        """What permissions grant, and in the enforced view what governance leaves open beside it."""
        found = tuple(found)
        granted = policy_of(permissions, self.domain, sources)
        yield replace(granted, protections=tuple(protection(one.rule) for one in found))
        if View(self.view) is View.enforced:
            for one in found:
                yield open_topics(one.file, one.rule, granted.profiles, granted.sources)

    def _remarks(self, stated: Sequence[Permissions]) -> Iterator[Diagnostic]:
        yield from apart_remarks(stated, self.domain)
        yield from expired(stated, self.today)
