"""A certificate of a keystore -> whom it names, when it is valid, and whether its CA gave it; no key is opened.

In: a file in PEM. Out: ``Certificate``. ``openssl`` reads it, as for signatures.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime

from rosprivacy.analysis.errors import PolicyError
from rosprivacy.ingest.keystore.openssl import absolute, openssl
from rosprivacy.ingest.reading.bounded_file import read_regular

MAX_BYTES = 2**20
_LINE = re.compile(r"(subject|notBefore|notAfter)=(.*)")


@dataclass(frozen=True, slots=True)
class Certificate:
    """Whom it names, as in permissions (RFC 2253), and when it is valid."""

    file: str
    subject: str
    not_before: datetime
    not_after: datetime


def read_certificate(file: str) -> Certificate:
    """Read a certificate.

    Raises
    ------
    PolicyError
        If it cannot be read or is none.
    """
    read_regular(file, MAX_BYTES, lambda line, what, hint: PolicyError(file, line, what, hint))
    facts = ["-noout", "-subject", "-startdate", "-enddate", "-nameopt", "RFC2253", "-dateopt", "iso_8601"]
    done = openssl(["x509", "-in", absolute(file), *facts], file)
    lines = done.stdout.decode("utf-8", "replace").splitlines()
    said = {match[1]: match[2] for line in lines if (match := _LINE.fullmatch(line))}
    if done.returncode or len(said) < len(("subject", "notBefore", "notAfter")):
        raise PolicyError(file, 0, "not a certificate", "name a certificate in PEM")
    return Certificate(file, said["subject"].strip(), _moment(said["notBefore"]), _moment(said["notAfter"]))


def given_by(certificate: Certificate, authority: str) -> bool:
    """Return whether a CA signed a certificate; whether it is valid today is another question."""
    switches = ["-no_check_time", "-partial_chain", "-no-CApath", "-no-CAstore"]
    done = openssl(["verify", *switches, "-CAfile", absolute(authority), absolute(certificate.file)], certificate.file)
    return done.returncode == 0


def _moment(text: str) -> datetime:
    return datetime.fromisoformat(text.strip()).astimezone(UTC)
