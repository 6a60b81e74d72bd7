"""A signed file -> the text in it, once its signature is verified, by the library that the middlewares use.

In: a file in S/MIME and the certificate of the permissions CA. Out: the text and where it begins, or why the file is
refused. ``openssl`` does it (``smime -verify``), with the switches of Fast DDS and Cyclone DDS: the CA itself is the
only signer that counts, certificates that come with the signature are not looked at, and the text is read after its
header. No key is opened.

Source: DDS-Security 1.1, 9.4.1.1; ``Permissions.cpp`` of Fast DDS and ``access_control_utils.c`` of Cyclone DDS
(``PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN``).
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import PolicyError, shown
from rosprivacy.ingest.keystore.openssl import AUTHORITY, openssl
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.file_kinds import is_signed

if TYPE_CHECKING:
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.keystore.certificate import Authority

MAX_BYTES = 64 * 2**20
_XML = (b"<?xml", b"<dds")


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
    """Read a signed file.

    Parameters
    ----------
    authority
        The permissions CA; None where the signature shall not count. Then the text is taken as it
        stands, whether it is signed or not.

    Raises
    ------
    PolicyError
        If it cannot be read, is not signed, or its signature is not the CA's.
    """
    data = read_regular(file, MAX_BYTES, partial(PolicyError, file))
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


def _refused(file: str, authority: str, said: str) -> InputError:
    """Why openssl refuses a signature, in the words of a person."""
    if "signer certificate not found" in said:
        what = f"it was signed by somebody else than {shown(authority)}"
    elif "digest failure" in said or "bad signature" in said or "signature failure" in said:
        what = f"it was changed after it was signed by {shown(authority)}"
    else:
        lines = [line for line in said.splitlines() if "rror" in line]
        what = f"its signature is not readable: {shown(lines[-1].rpartition(':')[0][-120:] if lines else 'no reason')}"
    return PolicyError(file, 0, what, "sign it anew, or read it all the same with --allow-unsigned")
