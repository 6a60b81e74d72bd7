"""Certificates and signed files of a keystore, verified by the program ``openssl`` as by the middlewares' library.

In: files, regular and bounded. Out: ``Authority``, ``Certificate``, ``SignedText``, or why a file is refused. The
program gets bytes that we have read (a file of a keystore could be a pipe or without end) and nothing of the user's
configuration; it asks nobody anything, and no key is opened. Signatures are verified with the switches of Fast DDS and
Cyclone DDS: the CA itself is the only signer that counts, certificates that come with the signature are not looked at,
and the text is read after its header.

Source: DDS-Security 1.1, 9.4.1.1; ``Permissions.cpp`` of Fast DDS and ``access_control_utils.c`` of Cyclone DDS
(``PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN``).
"""

from __future__ import annotations

import binascii
import hashlib
import os
import re
import shutil
import ssl
import subprocess
import tempfile
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import PolicyError, shown
from rosprivacy.analysis.python_311 import from_iso
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.file_kinds import is_signed

if TYPE_CHECKING:
    from rosprivacy.analysis.errors import InputError

SECONDS = 60
AUTHORITY = "CA"  # in the arguments: where the certificates of the CA are to be named
MAX_CERTIFICATE = 2**20
FINGERPRINT = re.compile(r"(?:[0-9A-Fa-f]{2}:?){32}")
_PEM = re.compile(rb"-----BEGIN (?:X509 )?CERTIFICATE-----([^-]*)-----END (?:X509 )?CERTIFICATE-----")
_LINE = re.compile(r"(subject|notBefore|notAfter)=(.*)")
MAX_SIGNED = 64 * 2**20
_XML = (b"<?xml", b"<dds")
ALONE = {"OPENSSL_CONF": os.devnull, "LC_ALL": "C"}


def openssl(arguments: list[str], file: str, data: bytes, authority: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    """Run ``openssl`` on what is in a file.

    Certificates in PEM of an authority stand where ``AUTHORITY`` does in the arguments.

    Raises
    ------
    PolicyError
        If it is not there or does not end.
    """
    program = shutil.which("openssl")
    if program is None:
        what = "its signature cannot be verified: there is no openssl on the path"
        raise PolicyError(file, 0, what, "install openssl, or read it all the same with --allow-unsigned")
    try:
        with tempfile.TemporaryDirectory() as folder:
            ca_file = Path(folder, "ca.pem")
            ca_file.write_bytes(authority)
            named = [str(ca_file) if argument == AUTHORITY else argument for argument in arguments]
            return subprocess.run(  # noqa: S603 - a fixed program, switches, and a path of ours
                [program, *named], input=data, capture_output=True, check=False, timeout=SECONDS, env=ALONE
            )
    except subprocess.TimeoutExpired:
        raise PolicyError(file, 0, f"not verified: openssl did not end in {SECONDS} s", "check the file") from None
    except OSError as error:
        raise PolicyError(file, 0, f"openssl could not verify it: {shown(str(error))}", "check openssl") from None


@dataclass(frozen=True, slots=True)
class Certificate:
    """Whom it names, as in permissions (RFC 2253), and when it is valid; its bytes, and the SHA-256 of its file."""

    file: str
    data: bytes
    sha256: str
    subject: str
    not_before: datetime
    not_after: datetime


class Authority(NamedTuple):
    """The certificates of a CA, as its file has them, and the SHA-256 of the file.

    Attributes
    ----------
    fingerprints
        SHA-256 of each certificate, as ``openssl x509 -fingerprint -sha256`` has it, but without colons.
    """

    file: str
    pem: bytes
    sha256: str
    fingerprints: tuple[str, ...]


def read_authority(file: str, subject: str) -> Authority:
    """Read the certificates of a CA: all of them, since a middleware takes each; ``what`` names it in the error.

    Raises
    ------
    PolicyError
        If it cannot be read or has none.
    """
    data = read_regular(file, MAX_CERTIFICATE, partial(PolicyError, file))
    try:
        found = [binascii.a2b_base64(match[1]) for match in _PEM.finditer(data)]
    except binascii.Error:
        found = []
    if not found:
        raise PolicyError(file, 0, f"no certificate of {subject}", "name a certificate in PEM, or correct the keystore")
    pem = "".join(map(ssl.DER_cert_to_PEM_cert, found)).encode()
    fingerprints = (hashlib.sha256(one).hexdigest() for one in found)
    return Authority(file, pem, hashlib.sha256(data).hexdigest(), tuple(fingerprints))


def pinned(stated: tuple[str, ...]) -> frozenset[str]:
    """Return the fingerprints of CAs that a user names, each by its certificate or by its fingerprint.

    Raises
    ------
    PolicyError
        If a certificate cannot be read.
    """
    fingerprints: set[str] = set()
    for one in stated:
        plain = [one.replace(":", "").lower()] if FINGERPRINT.fullmatch(one) else None
        fingerprints.update(plain or read_authority(one, "a CA").fingerprints)
    return frozenset(fingerprints)


def read_certificate(file: str) -> Certificate:
    """Read a certificate; ``PolicyError`` if it cannot be read or is none."""
    data = read_regular(file, MAX_CERTIFICATE, partial(PolicyError, file))
    facts = ["-noout", "-subject", "-startdate", "-enddate", "-nameopt", "RFC2253", "-dateopt", "iso_8601"]
    done = openssl(["x509", *facts], file, data)
    lines = done.stdout.decode("utf-8", "replace").splitlines()
    said = {match[1]: match[2] for line in lines if (match := _LINE.fullmatch(line))}
    if done.returncode or len(said) < len(("subject", "notBefore", "notAfter")):
        raise PolicyError(file, 0, "not a certificate", "name a certificate in PEM")
    dates = _moment(said["notBefore"]), _moment(said["notAfter"])
    return Certificate(file, data, hashlib.sha256(data).hexdigest(), said["subject"].strip(), *dates)


def given_by(certificate: Certificate, authority: Authority) -> bool:
    """Return whether a CA signed a certificate; whether it is valid today is another question."""
    switches = ["-no_check_time", "-partial_chain", "-no-CApath", "-no-CAstore", "-CAfile", AUTHORITY]
    return openssl(["verify", *switches], certificate.file, certificate.data, authority.pem).returncode == 0


def _moment(text: str) -> datetime:
    return from_iso(text.strip()).astimezone(timezone.utc)


@dataclass(frozen=True, slots=True)
class SignedText:
    """The text of a file.

    Attributes
    ----------
    sha256
        Of the file as it lies there.
    before
        Lines of the file before the text.
    verified
        Whether its signature was verified.
    """

    file: str
    sha256: str
    data: bytes
    before: int
    verified: bool


def read_signed(file: str, authority: Authority | None) -> SignedText:
    """Read a signed file; without the permissions CA its text is taken as it stands, whether it is signed or not.

    Raises
    ------
    PolicyError
        If it cannot be read, is not signed, or its signature is not the CA's.
    """
    data = read_regular(file, MAX_SIGNED, partial(PolicyError, file))
    sha256 = hashlib.sha256(data).hexdigest()
    text, before = _text(data)
    if authority is None:
        return SignedText(file, sha256, text, before, verified=False)
    if not is_signed(data):
        raise PolicyError(file, 1, "not signed", "sign it, or read it all the same with --allow-unsigned")
    return SignedText(file, sha256, _verified(file, data, authority), before, verified=True)


def _text(data: bytes) -> tuple[bytes, int]:
    """The XML in a file, and how many lines stand before it."""
    starts = [at for sign in _XML if (at := data.find(sign)) >= 0]
    if not starts:
        return data, 0
    start = min(starts)
    end = data.rfind(b"</dds>")
    return data[start : end + len(b"</dds>") if end >= 0 else len(data)], data.count(b"\n", 0, start)


def _verified(file: str, data: bytes, authority: Authority) -> bytes:
    """The text that openssl takes out of a file whose signature is that of the CA."""
    switches = ["-verify", "-text", "-noverify", "-nointern", "-inform", "SMIME", "-certfile", AUTHORITY]
    done = openssl(["smime", *switches], file, data, authority.pem)
    if done.returncode:
        raise _refused(file, authority.file, done.stderr.decode("utf-8", "replace"))
    return done.stdout


def _refused(file: str, authority: str, output: str) -> InputError:
    """Why openssl refuses a signature, in the words of a person."""
    if "signer certificate not found" in output:
        what = f"it was signed by somebody else than {shown(authority)}"
    elif "digest failure" in output or "bad signature" in output or "signature failure" in output:
        what = f"it was changed after it was signed by {shown(authority)}"
    else:
        lines = [line for line in output.splitlines() if "rror" in line]
        what = f"its signature is not readable: {shown(lines[-1].rpartition(':')[0][-120:] if lines else 'no reason')}"
    return PolicyError(file, 0, what, "sign it anew, or read it all the same with --allow-unsigned")
