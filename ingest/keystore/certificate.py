"""Certificates of a keystore: whom one names, when it is valid, whether its CA gave it, and which CA that is.

In: files in PEM, regular and bounded. Out: ``Certificate``, ``Authority``. ``openssl`` reads the text, as for
signatures; no key is opened.
"""

from __future__ import annotations

import binascii
import hashlib
import re
import ssl
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from typing import NamedTuple

from rosprivacy.analysis.errors import PolicyError
from rosprivacy.ingest.keystore.openssl import AUTHORITY, openssl
from rosprivacy.ingest.reading.bounded_file import read_regular

MAX_BYTES = 2**20
FINGERPRINT = re.compile(r"(?:[0-9A-Fa-f]{2}:?){32}")
_PEM = re.compile(rb"-----BEGIN (?:X509 )?CERTIFICATE-----([^-]*)-----END (?:X509 )?CERTIFICATE-----")
_LINE = re.compile(r"(subject|notBefore|notAfter)=(.*)")


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


def read_authority(file: str, what: str) -> Authority:
    """Read the certificates of a CA: all of them, since a middleware takes each.

    Parameters
    ----------
    what
        Which CA, for the error.

    Raises
    ------
    PolicyError
        If it cannot be read or has none.
    """
    data = read_regular(file, MAX_BYTES, partial(PolicyError, file))
    try:
        found = [binascii.a2b_base64(match[1]) for match in _PEM.finditer(data)]
    except binascii.Error:
        found = []
    if not found:
        raise PolicyError(file, 0, f"no certificate of {what}", "name a certificate in PEM, or correct the keystore")
    pem = "".join(map(ssl.DER_cert_to_PEM_cert, found)).encode()
    fingerprints = (hashlib.sha256(one).hexdigest() for one in found)
    return Authority(file, pem, hashlib.sha256(data).hexdigest(), tuple(fingerprints))


def pinned(named: tuple[str, ...]) -> frozenset[str]:
    """Return the fingerprints of CAs that a user names, each by its certificate or by its fingerprint.

    Raises
    ------
    PolicyError
        If a certificate cannot be read.
    """
    fingerprints: set[str] = set()
    for one in named:
        plain = [one.replace(":", "").lower()] if FINGERPRINT.fullmatch(one) else None
        fingerprints.update(plain or read_authority(one, "a CA").fingerprints)
    return frozenset(fingerprints)


def read_certificate(file: str) -> Certificate:
    """Read a certificate.

    Raises
    ------
    PolicyError
        If it cannot be read or is none.
    """
    data = read_regular(file, MAX_BYTES, partial(PolicyError, file))
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
    return datetime.fromisoformat(text.strip()).astimezone(UTC)
