"""Keystores, permissions and governance files -> policies: what is deployed, in the facts that a policy gives.

In: their paths. Out: ``Policy`` facts, with what a reader has to know of governance, signatures and dates. Of a
keystore (the folder that ``ros2 security create_keystore`` makes) everything is verified, or told by name; ``private/``
is never opened, nor is any ``key.pem``. Nothing says who may sign files that are named without their keystore, so these
are read only where that is allowed.

Source: ROS 2 design, article on DDS-Security; sros2's ``keystore`` package: ``public/`` has the CAs, ``enclaves/`` a
folder for each enclave with ``cert.pem``, ``governance.p7s`` and ``permissions.p7s``.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors, PolicyError, noting, shown
from rosprivacy.analysis.model import SIGNED_BY, Diagnostic, Place, Severity
from rosprivacy.analysis.modes import View
from rosprivacy.ingest.deployed.deployed_paths import is_keystore
from rosprivacy.ingest.deployed.governance import (
    apart_remarks,
    domains_of,
    governance_remarks,
    governed,
    joint_remarks,
    open_topics,
    protection,
    read_governance,
    rule_remarks,
)
from rosprivacy.ingest.deployed.permissions import enclave_of, expired, policy_of, read_permissions
from rosprivacy.ingest.deployed.security_xml import section_of, warning
from rosprivacy.ingest.deployed.signatures import given_by, pinned, read_authority, read_certificate, read_signed
from rosprivacy.ingest.policies.policy_files import Contents, beside_keystore, contents
from rosprivacy.ingest.reading.path_kinds import is_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.deployed.governance import Governance, Governed
    from rosprivacy.ingest.deployed.permissions import Permissions
    from rosprivacy.ingest.deployed.signatures import Authority, SignedText

PERMISSIONS_FILE, GOVERNANCE_FILE, CERTIFICATE = "permissions.p7s", "governance.p7s", "cert.pem"
FILES = (".p7s", ".pem")
PERMISSIONS_CA, IDENTITY_CA = "permissions_ca.cert.pem", "identity_ca.cert.pem"
CA_NAMES = {PERMISSIONS_CA: "the permissions CA", IDENTITY_CA: "the identity CA"}
PINNED = "it is that of --permissions-ca"
NOT_PINNED = "it lies beside what it signed, so nothing shows whose it is (--permissions-ca pins it)"
PIN = "find out who made it; correct the option, or the keystore"
GOVERNS = "domain_access_rules"
GOVERNANCE_ALONE = "governance by itself: nothing says who may sign it"
PERMISSIONS_ALONE = "permissions by themselves: nothing says who may sign them"
ALONE = "not verified with --permissions-ca, since it is named without its keystore"
Hashed = tuple[str, str]
"""A file and its SHA-256."""
Read = tuple[tuple["Policy", ...], tuple["Diagnostic", ...]]
_Granted = tuple[list["Policy"], list["Diagnostic"]]


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
    remarks: list[Diagnostic] = []
    problems: list[InputError] = []
    for part in (*parts, *([partial(reading.alone, alone)] if alone else ())):
        with noting(problems):
            read, more = part()
            policies += read
            remarks += more
    if problems:
        raise InputErrors(problems)
    return tuple(policies), tuple(dict.fromkeys(remarks))


class _Reading(NamedTuple):
    """How to read, as ``read_deployed`` has it; ``pins`` are fingerprints of the CAs that may have signed."""

    domain: int | None
    today: str
    allow_unsigned: bool
    view: str
    besides: tuple[str, ...]
    pins: frozenset[str]

    def keystore(self, folder: str) -> _Granted:
        """What a keystore grants; each enclave has a governance beside it."""
        keystore = _Keystore(folder, self)
        policies: list[Policy] = []
        enclaves = keystore.enclaves()
        remarks = keystore.remarks
        for enclave in enclaves:
            found = governed(enclave.governance, domains_of(enclave.permissions, self.domain))
            policies += self._granted(enclave.permissions, enclave.sources, found)
            remarks += governance_remarks(enclave.governance, enclave.permissions, self.domain)
        remarks += self._remarks([enclave.permissions for enclave in enclaves])
        return policies, sorted(remarks, key=lambda d: (d.place.file, d.place.line, d.message))

    def alone(self, names: Iterable[str]) -> _Granted:
        """What files by themselves grant; each governance counts for the domains that its rules name."""
        if self.pins:
            raise InputErrors([PolicyError(name, 0, ALONE, "name the keystore") for name in names])
        stated, governances = _read_alone(names, allow_unsigned=self.allow_unsigned)
        policies: list[Policy] = []
        remarks: list[Diagnostic] = []
        for permissions, source in stated:
            about = domains_of(permissions, self.domain)
            found = [(hashed, one) for governance, hashed in governances for one in governed(governance, about)]
            sources = tuple(sorted({source, *(hashed for hashed, _ in found)}))
            policies += self._granted(permissions, sources, (one for _, one in found))
            remarks += (remark for _, one in found for remark in rule_remarks(one.rule))
        read = [permissions for permissions, _ in stated]
        remarks += joint_remarks([governance for governance, _ in governances], read, self.domain)
        return policies, [*remarks, *self._remarks(read)]

    def _granted(
        self, permissions: Permissions, sources: tuple[tuple[str, str], ...], policies: Iterable[Governed]
    ) -> Iterator[Policy]:
        """What permissions grant, and in the enforced view what governance leaves open beside it."""
        policies = tuple(policies)
        granted = policy_of(permissions, self.domain, sources)
        yield replace(granted, protections=tuple(protection(one.rule) for one in policies))
        if View(self.view) is View.enforced:
            for one in policies:
                yield open_topics(one.file, one.rule, granted.profiles, granted.sources)

    def _remarks(self, stated: Sequence[Permissions]) -> Iterator[Diagnostic]:
        yield from apart_remarks(stated, self.domain)
        yield from expired(stated, self.today)


class _Deployed(NamedTuple):
    """Permissions as they are deployed, with their governance and the SHA-256 of all files that were read."""

    permissions: Permissions
    governance: Governance
    sources: tuple[Hashed, ...]


@dataclass(slots=True)
class _Keystore:
    """A keystore, how to read it, and what its enclaves share: it is asked for once."""

    folder: str
    how: _Reading
    verified: dict[str, SignedText] = field(default_factory=dict)  # by file
    authorities: dict[str, Authority] = field(default_factory=dict)  # by name
    problems: list[InputError] = field(default_factory=list)
    remarks: list[Diagnostic] = field(default_factory=list)

    def enclaves(self) -> list[_Deployed]:
        """Read all enclaves, also such as a certificate alone stands in; raise every problem."""
        inside = contents(str(Path(self.folder) / "enclaves")) or Contents()
        unread = {Path(error.file): error for error in inside.problems}
        paths = (*map(Path, inside.files | (inside.passed_over - inside.hidden)), *unread)
        folders = sorted({path.parent for path in paths if path.name in (PERMISSIONS_FILE, CERTIFICATE)})
        self.problems += (error for path, error in unread.items() if path.suffix not in FILES)  # of others who reads it
        if not (folders or self.problems):
            what = f"a keystore without any {PERMISSIONS_FILE}"
            self.problems.append(PolicyError(self.folder, 0, what, "create an enclave in it"))
        self.remarks += beside_keystore(self.folder, {*map(os.path.realpath, self.how.besides)})
        enclaves = [enclave for folder in folders if (enclave := _Enclave(self, folder).read())]
        if self.problems:
            raise InputErrors(self.problems)
        self.remarks += self._signers()
        return enclaves

    def authority(self, name: str) -> Authority:
        """Return a CA; a permissions CA that is not pinned is none."""
        if name not in self.authorities:
            file = str(Path(self.folder) / "public" / name)
            read = read_authority(file, CA_NAMES[name])
            others = [fingerprint for fingerprint in read.fingerprints if fingerprint not in self.how.pins]
            if name == PERMISSIONS_CA and self.how.pins and others:
                what = f"not the CA of --permissions-ca: its SHA-256 fingerprint is {others[0]}"
                raise _NotPinnedError(file, 0, what, PIN)
            self.authorities[name] = read
        return self.authorities[name]

    def _signers(self) -> Iterator[Diagnostic]:
        """Which CA the signatures are of."""
        authority = self.authorities.get(PERMISSIONS_CA)
        if authority is None or not self.verified:
            return
        for fingerprint in authority.fingerprints:
            message = f"the CA of the signatures, SHA-256 {fingerprint}: {PINNED if self.how.pins else NOT_PINNED}"
            yield Diagnostic(Place(authority.file, 0), Severity.NOTICE, message, SIGNED_BY)


class _NotPinnedError(PolicyError):
    """The CA of a keystore is not the one that a user pinned: --allow-unsigned does not help."""


@dataclass(slots=True)
class _Enclave:
    """One folder with its permissions, and the SHA-256 of what was read of it."""

    keystore: _Keystore
    folder: Path
    sources: dict[str, str] = field(default_factory=dict)

    def read(self) -> _Deployed | None:
        """Read and verify what stands in the folder; None, with the problems noted, if it cannot be read."""
        governance = permissions = None
        if (signed := self._signed(GOVERNANCE_FILE)) is not None:
            with noting(self.keystore.problems):
                governance = read_governance(signed.data, signed.file, signed.before)
        if (signed := self._signed(PERMISSIONS_FILE)) is not None:
            with noting(self.keystore.problems):
                permissions = read_permissions(signed.data, signed.file, signed.before)
        if permissions is None:
            return None
        with noting(self.keystore.problems):
            self._certificate(permissions)
        return _Deployed(permissions, governance, tuple(sorted(self.sources.items()))) if governance else None

    def _signed(self, name: str) -> SignedText | None:
        """A signed file of the folder; None, with the problem noted, if it is refused."""
        file = str(self.folder / name)
        keystore, enclaves = self.keystore, Path(self.keystore.folder) / "enclaves"
        if name == GOVERNANCE_FILE and is_file(common := enclaves / name) and is_file(file):
            file = str(common) if common.samefile(file) else file  # sros2 links it into each enclave
        try:
            authority = keystore.authority(PERMISSIONS_CA)
            signed = keystore.verified.get(file) or read_signed(file, authority)
            self.sources[authority.file] = authority.sha256
        except PolicyError as error:
            unsigned = keystore.how.allow_unsigned and not isinstance(error, _NotPinnedError)
            if not unsigned or not is_file(file):
                keystore.problems.append(error)
                return None
            signed = read_signed(file, None)
            self._warn(file, f"not verified: {error.problem}; read all the same, as --allow-unsigned asks")
        if signed.verified:
            keystore.verified[file] = signed
        self.sources[file] = signed.sha256
        return signed

    def _certificate(self, permissions: Permissions) -> None:
        """Whose permissions these are: the certificate beside them says it, and its CA vouches for it."""
        file = str(self.folder / CERTIFICATE)
        certificate, authority = read_certificate(file), self.keystore.authority(IDENTITY_CA)
        self.sources |= {file: certificate.sha256, authority.file: authority.sha256}
        if not given_by(certificate, authority):
            raise PolicyError(file, 0, f"not given by {shown(authority.file)}", "create the enclave anew")
        named = [grant.subject for grant in permissions.grants]
        if certificate.subject not in named:
            what = f"permissions of {shown(', '.join(named))}, beside the certificate of {shown(certificate.subject)}"
            raise PolicyError(permissions.file, 0, what, "the middleware refuses this enclave; create it anew")
        path = "/" + self.folder.relative_to(Path(self.keystore.folder) / "enclaves").as_posix()
        if enclave_of(certificate.subject) != path:
            self._warn(file, f"the certificate of {certificate.subject} stands in the folder of enclave {path}")
        first, last, today = certificate.not_before.date(), certificate.not_after.date(), self.keystore.how.today
        if not first.isoformat() <= today <= last.isoformat():
            message = f"the certificate of {certificate.subject} is valid from {first} to {last}, not on {today}"
            self._warn(file, f"{message}: a middleware refuses it now; it is read, since it can be renewed")

    def _warn(self, file: str, message: str) -> None:
        self.keystore.remarks.append(warning(Place(file, 0), message))


def _read_alone(
    names: Iterable[str], *, allow_unsigned: bool
) -> tuple[list[tuple[Permissions, Hashed]], list[tuple[Governance, Hashed]]]:
    """Files of permissions and of governance; governance without permissions is a problem."""
    permissions: list[tuple[Permissions, Hashed]] = []
    governances: list[tuple[Governance, Hashed]] = []
    problems: list[InputError] = []
    for name in sorted(names):
        with noting(problems):
            signed = read_signed(name, None)
            governs = section_of(signed.data, name) == GOVERNS
            if not allow_unsigned:
                what = GOVERNANCE_ALONE if governs else PERMISSIONS_ALONE
                raise PolicyError(name, 0, what, "name the keystore, or read them all the same with --allow-unsigned")
            if governs:
                governances.append((read_governance(signed.data, name, signed.before), (name, signed.sha256)))
            else:
                permissions.append((read_permissions(signed.data, name, signed.before), (name, signed.sha256)))
    if not (permissions or problems):
        what = "governance without permissions: it does not say who may do what"
        hint = "name the permissions too; a keystore has a governance of its own"
        problems += (PolicyError(file, 0, what, hint) for _, (file, _) in governances)
    if problems:
        raise InputErrors(problems)
    return permissions, governances
