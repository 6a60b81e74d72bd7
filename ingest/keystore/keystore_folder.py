"""An SROS 2 keystore -> what its enclaves may do: everything verified, or told by name.

In: the folder that ``ros2 security create_keystore`` makes. Out: permissions and the governance that counts for them.
``private/`` is never opened, nor is any ``key.pem``.

Source: ROS 2 design, article on DDS-Security; sros2's ``keystore`` package: ``public/`` has the CAs, ``enclaves/`` a
folder for each enclave with ``cert.pem``, ``governance.p7s`` and ``permissions.p7s``.
"""

from __future__ import annotations

import os
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import SIGNED_BY, Diagnostic, Place, Severity
from rosprivacy.ingest.keystore.certificate import given_by, read_authority, read_certificate
from rosprivacy.ingest.keystore.governance_file import read_governance
from rosprivacy.ingest.keystore.grants import enclave_of
from rosprivacy.ingest.keystore.permissions_file import read_permissions
from rosprivacy.ingest.keystore.signed_file import read_signed
from rosprivacy.ingest.policies.folders import Contents, beside_keystore, contents

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.keystore.certificate import Authority
    from rosprivacy.ingest.keystore.governance_file import Governance
    from rosprivacy.ingest.keystore.permissions_file import Permissions
    from rosprivacy.ingest.keystore.signed_file import SignedText

PERMISSIONS, GOVERNANCE, CERTIFICATE = "permissions.p7s", "governance.p7s", "cert.pem"
FILES = (".p7s", ".pem")
PERMISSIONS_CA, IDENTITY_CA = "permissions_ca.cert.pem", "identity_ca.cert.pem"
CALLED = {PERMISSIONS_CA: "the permissions CA", IDENTITY_CA: "the identity CA"}
PINNED = "it is that of --permissions-ca"
NOT_PINNED = "it lies beside what it signed, so nothing shows whose it is (--permissions-ca pins it)"
PIN = "find out who made it; correct the option, or the keystore"


@dataclass(frozen=True, slots=True)
class Deployed:
    """Permissions as they are deployed, with their governance and the SHA-256 of all files that were read."""

    permissions: Permissions
    governance: Governance
    sources: tuple[tuple[str, str], ...]


def read_keystore(
    folder: str,
    today: str,
    *,
    allow_unsigned: bool = False,
    besides: Iterable[str] = (),
    pins: frozenset[str] = frozenset(),
) -> tuple[tuple[Deployed, ...], tuple[Diagnostic, ...]]:
    """Read all enclaves of a keystore.

    Parameters
    ----------
    today
        ISO date on which certificates are valid or not.
    allow_unsigned
        Whether what is unsigned or badly signed is read too; then that is told.
    besides
        Files and folders that somebody else reads.
    pins
        Fingerprints of the CAs that may have signed; none where the CA of the keystore may.

    Raises
    ------
    InputErrors
        With every problem of the keystore, one line each.
    """
    inside = contents(str(Path(folder) / "enclaves")) or Contents()
    unread = {Path(error.file): error for error in inside.problems}
    paths = (*map(Path, inside.files | (inside.others - inside.hidden)), *unread)
    enclaves = sorted({path.parent for path in paths if path.name in (PERMISSIONS, CERTIFICATE)})
    problems = [error for path, error in unread.items() if path.suffix not in FILES]  # of a file who reads it says it
    if not (enclaves or problems):
        problems.append(PolicyError(folder, 0, f"a keystore without any {PERMISSIONS}", "create an enclave in it"))
    shared = _Shared(folder, today, allow_unsigned, pins)
    deployed: list[Deployed] = []
    said = list(beside_keystore(folder, {*map(os.path.realpath, besides)}))
    for enclave in enclaves:
        reader = _Enclave(shared, enclave)
        try:
            deployed.append(reader.read())
        except InputErrors as error:
            problems += error.errors
        said += reader.said
    if problems:
        raise InputErrors(problems)
    return tuple(deployed), (*said, *shared.signers())


@dataclass(slots=True)
class _Shared:
    """A keystore, how to read it, and what its enclaves share: it is asked for once."""

    keystore: str
    today: str
    allow_unsigned: bool
    pins: frozenset[str]
    verified: dict[str, SignedText] = field(default_factory=dict)  # by file
    authorities: dict[str, Authority] = field(default_factory=dict)  # by name

    def authority(self, name: str) -> Authority:
        """Return a CA; a permissions CA that is not pinned is none."""
        if name not in self.authorities:
            file = str(Path(self.keystore) / "public" / name)
            read = read_authority(file, CALLED[name])
            others = [one for one in read.fingerprints if one not in self.pins]
            if name == PERMISSIONS_CA and self.pins and others:
                raise _NotPinnedError(
                    file, 0, f"not the CA of --permissions-ca: its SHA-256 fingerprint is {others[0]}", PIN
                )
            self.authorities[name] = read
        return self.authorities[name]

    def signers(self) -> Iterator[Diagnostic]:
        """Say which CA the signatures are of."""
        authority = self.authorities.get(PERMISSIONS_CA)
        if authority is None or not self.verified:
            return
        for fingerprint in authority.fingerprints:
            message = f"the CA of the signatures, SHA-256 {fingerprint}: {PINNED if self.pins else NOT_PINNED}"
            yield Diagnostic(Place(authority.file, 0), Severity.NOTICE, message, SIGNED_BY)


class _NotPinnedError(PolicyError):
    """The CA of a keystore is not the one that a user pinned: --allow-unsigned does not help."""


@dataclass(slots=True)
class _Enclave:
    """One folder with its permissions, and what is found in it."""

    shared: _Shared
    folder: Path
    said: list[Diagnostic] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)
    sources: dict[str, str] = field(default_factory=dict)

    def read(self) -> Deployed:
        """Read and verify what stands in the folder; raise all that is wrong with it."""
        governance = permissions = None
        if (signed := self._signed(GOVERNANCE)) is not None:
            with self._noted():
                governance = read_governance(signed.data, signed.file, signed.before)
        if (signed := self._signed(PERMISSIONS)) is not None:
            with self._noted():
                permissions = read_permissions(signed.data, signed.file, signed.before)
        if permissions:
            with self._noted():
                self._certificate(permissions)
        if self.problems or permissions is None or governance is None:
            raise InputErrors(self.problems)
        return Deployed(permissions, governance, tuple(sorted(self.sources.items())))

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """Note the problems of a part, and go on with the next."""
        try:
            yield
        except PolicyError as error:
            self.problems.append(error)
        except InputErrors as error:
            self.problems += error.errors

    def _signed(self, name: str) -> SignedText | None:
        """A signed file of the folder; None, with the problem noted, if it is refused."""
        file = str(self.folder / name)
        enclaves = Path(self.shared.keystore) / "enclaves"
        if name == GOVERNANCE and (common := enclaves / name).is_file() and Path(file).is_file():
            file = str(common) if common.samefile(file) else file  # sros2 links it into each enclave
        try:
            authority = self.shared.authority(PERMISSIONS_CA)
            signed = self.shared.verified.get(file) or read_signed(file, authority)
            self.sources[authority.file] = authority.sha256
        except PolicyError as error:
            unsigned = self.shared.allow_unsigned and not isinstance(error, _NotPinnedError)
            if not unsigned or not Path(file).is_file():
                self.problems.append(error)
                return None
            signed = read_signed(file, None)
            self._warn(file, f"not verified: {error.problem}; read all the same, as --allow-unsigned asks")
        if signed.verified:
            self.shared.verified[file] = signed
        self.sources[file] = signed.sha256
        return signed

    def _certificate(self, permissions: Permissions) -> None:
        """Whose permissions these are: the certificate beside them says it, and its CA vouches for it."""
        file = str(self.folder / CERTIFICATE)
        certificate, authority = read_certificate(file), self.shared.authority(IDENTITY_CA)
        self.sources |= {file: certificate.sha256, authority.file: authority.sha256}
        if not given_by(certificate, authority):
            raise PolicyError(file, 0, f"not given by {shown(authority.file)}", "create the enclave anew")
        named = [grant.subject for grant in permissions.grants]
        if certificate.subject not in named:
            what = f"permissions of {shown(', '.join(named))}, beside the certificate of {shown(certificate.subject)}"
            raise PolicyError(permissions.file, 0, what, "the middleware refuses this enclave; create it anew")
        path = "/" + self.folder.relative_to(Path(self.shared.keystore) / "enclaves").as_posix()
        if enclave_of(certificate.subject) != path:
            self._warn(file, f"the certificate of {certificate.subject} stands in the folder of enclave {path}")
        if (
            not certificate.not_before.date().isoformat()
            <= self.shared.today
            <= certificate.not_after.date().isoformat()
        ):
            when = f"from {certificate.not_before.date()} to {certificate.not_after.date()}"
            message = f"the certificate of {certificate.subject} is valid {when}, not on {self.shared.today}"
            self._warn(file, f"{message}: a middleware refuses it now; it is read, since it can be renewed")

    def _warn(self, file: str, message: str) -> None:
        self.said.append(Diagnostic(Place(file, 0), Severity.WARNING, shown(message)))
