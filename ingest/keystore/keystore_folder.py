"""An SROS 2 keystore -> what its enclaves may do: everything verified, or told by name.

In: the folder that ``ros2 security create_keystore`` makes. Out: permissions and the governance that counts for them.
``private/`` is never opened, nor is any ``key.pem``.

Source: ROS 2 design, article on DDS-Security; sros2's ``keystore`` package: ``public/`` has the CAs, ``enclaves/`` a
folder for each enclave with ``cert.pem``, ``governance.p7s`` and ``permissions.p7s``.
"""

from __future__ import annotations

import hashlib
import os
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.ingest.keystore.certificate import given_by, read_certificate
from rosprivacy.ingest.keystore.governance_file import read_governance
from rosprivacy.ingest.keystore.grants import enclave_of
from rosprivacy.ingest.keystore.permissions_file import read_permissions
from rosprivacy.ingest.keystore.signed_file import read_signed
from rosprivacy.ingest.policies.folders import Contents, beside_keystore, contents

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.keystore.governance_file import Governance
    from rosprivacy.ingest.keystore.permissions_file import Permissions
    from rosprivacy.ingest.keystore.signed_file import SignedText

PERMISSIONS, GOVERNANCE, CERTIFICATE = "permissions.p7s", "governance.p7s", "cert.pem"
FILES = (".p7s", ".pem")
PERMISSIONS_CA, IDENTITY_CA = "permissions_ca.cert.pem", "identity_ca.cert.pem"


@dataclass(frozen=True, slots=True)
class Deployed:
    """Permissions as they are deployed, with their governance and the SHA-256 of both files."""

    permissions: Permissions
    governance: Governance
    sources: tuple[tuple[str, str], ...]


def read_keystore(
    folder: str, today: str, *, allow_unsigned: bool = False, besides: Iterable[str] = ()
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
    verified: dict[str, SignedText] = {}
    deployed: list[Deployed] = []
    said = list(beside_keystore(folder, {*map(os.path.realpath, besides)}))
    for enclave in enclaves:
        reader = _Enclave(folder, enclave, today, allow_unsigned, verified)
        try:
            deployed.append(reader.read())
        except InputErrors as error:
            problems += error.errors
        said += reader.said
    if problems:
        raise InputErrors(problems)
    return tuple(deployed), tuple(said)


@dataclass(slots=True)
class _Enclave:
    """One folder with its permissions, and what is found in it."""

    keystore: str
    folder: Path
    today: str
    allow_unsigned: bool
    verified: dict[str, SignedText]  # by file: the governance that all enclaves share is asked for once
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
        shared = Path(self.keystore) / "enclaves" / name
        if name == GOVERNANCE and shared.is_file() and Path(file).is_file() and shared.samefile(file):
            file = str(shared)  # sros2 links it into each enclave
        authority = str(Path(self.keystore) / "public" / PERMISSIONS_CA)
        try:
            signed = self.verified.get(file) or read_signed(file, authority)
        except PolicyError as error:
            if not self.allow_unsigned or not Path(file).is_file():
                self.problems.append(error)
                return None
            signed = read_signed(file, None)
            self._warn(file, f"not verified: {error.problem}; read all the same, as --allow-unsigned asks")
        if signed.verified:
            self.verified[file] = signed
        self.sources[file] = hashlib.sha256(signed.data).hexdigest()
        return signed

    def _certificate(self, permissions: Permissions) -> None:
        """Whose permissions these are: the certificate beside them says it, and its CA vouches for it."""
        file = str(self.folder / CERTIFICATE)
        certificate = read_certificate(file)
        authority = Path(self.keystore) / "public" / IDENTITY_CA
        if not given_by(certificate, str(authority)):
            raise PolicyError(file, 0, f"not given by {shown(str(authority))}", "create the enclave anew")
        named = [grant.subject for grant in permissions.grants]
        if certificate.subject not in named:
            what = f"permissions of {shown(', '.join(named))}, beside the certificate of {shown(certificate.subject)}"
            raise PolicyError(permissions.file, 0, what, "the middleware refuses this enclave; create it anew")
        path = "/" + self.folder.relative_to(Path(self.keystore) / "enclaves").as_posix()
        if enclave_of(certificate.subject) != path:
            self._warn(file, f"the certificate of {certificate.subject} stands in the folder of enclave {path}")
        if not certificate.not_before.date().isoformat() <= self.today <= certificate.not_after.date().isoformat():
            when = f"from {certificate.not_before.date()} to {certificate.not_after.date()}"
            message = f"the certificate of {certificate.subject} is valid {when}, not on {self.today}"
            self._warn(file, f"{message}: a middleware refuses it now; it is read, since it can be renewed")

    def _warn(self, file: str, message: str) -> None:
        self.said.append(Diagnostic(Place(file, 0), Severity.WARNING, shown(message)))
