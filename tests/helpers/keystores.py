"""Enclaves of a keystore, as sros2 lays them out, for tests: made with openssl, which is not what reads them.

What a permissions and a governance file say is stated in Python, in the order in which it is written.
"""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

ANY_DOMAIN = ((0, 230),)
CURVE = ("-algorithm", "EC", "-pkeyopt", "ec_paramgen_curve:prime256v1")


@dataclass(frozen=True)
class Rule:
    """An allow rule or a deny rule of a grant."""

    allow: bool
    publish: tuple[str, ...] = ()
    subscribe: tuple[str, ...] = ()
    partitions: tuple[str, ...] = ()
    domains: tuple[tuple[int, int], ...] = ANY_DOMAIN

    @property
    def xml(self) -> str:
        name = "allow_rule" if self.allow else "deny_rule"
        partitions = _each("partition", self.partitions)
        within = f"<partitions>{partitions}</partitions>" if partitions else ""
        ways = [("publish", self.publish), ("subscribe", self.subscribe)]
        criteria = [f"<{way}><topics>{_each('topic', names)}</topics>{within}</{way}>" for way, names in ways if names]
        return f"<{name}>{_domains(self.domains)}{''.join(criteria)}</{name}>"


@dataclass(frozen=True)
class Grant:
    """What the permissions of an enclave grant; for another subject, if one is named."""

    rules: tuple[Rule, ...]
    default: str = "DENY"
    valid: tuple[str, str] = ("2020-01-01T00:00:00", "2040-01-01T00:00:00")
    subject: str = ""

    def xml(self, own: str) -> str:
        subject = escape(self.subject or own)
        start, end = self.valid
        return (
            f'<grant name="{subject}"><subject_name>CN={subject}</subject_name><validity><not_before>{start}'
            f"</not_before><not_after>{end}</not_after></validity>{''.join(rule.xml for rule in self.rules)}"
            f"<default>{self.default}</default></grant>"
        )


@dataclass(frozen=True)
class TopicRule:
    """What governance says of topics: whether permissions are asked, and how data are protected."""

    topics: str = "*"
    read: bool = True
    write: bool = True
    protection: str = "ENCRYPT"
    discovery: bool = True
    liveliness: bool = True

    @property
    def xml(self) -> str:
        said = {
            "topic_expression": escape(self.topics),
            "enable_discovery_protection": str(self.discovery).lower(),
            "enable_liveliness_protection": str(self.liveliness).lower(),
            "enable_read_access_control": str(self.read).lower(),
            "enable_write_access_control": str(self.write).lower(),
            "metadata_protection_kind": self.protection,
            "data_protection_kind": self.protection,
        }
        return f"<topic_rule>{_fields(said)}</topic_rule>"


@dataclass(frozen=True)
class Governance:
    """What holds in a domain, by default as sros2 says it."""

    topics: tuple[TopicRule, ...] = (TopicRule(),)
    join: bool = True
    unauthenticated: bool = False
    discovery: str = "ENCRYPT"
    liveliness: str = "ENCRYPT"
    rtps: str = "SIGN"
    domains: tuple[tuple[int, int], ...] = ANY_DOMAIN

    @property
    def xml(self) -> str:
        said = {
            "allow_unauthenticated_participants": str(self.unauthenticated).lower(),
            "enable_join_access_control": str(self.join).lower(),
            "discovery_protection_kind": self.discovery,
            "liveliness_protection_kind": self.liveliness,
            "rtps_protection_kind": self.rtps,
        }
        topics = "".join(rule.xml for rule in self.topics)
        rule = f"{_domains(self.domains)}{_fields(said)}<topic_access_rules>{topics}</topic_access_rules>"
        return _document(f"<domain_access_rules><domain_rule>{rule}</domain_rule></domain_access_rules>")


@dataclass(frozen=True)
class Enclave:
    """What lies in the folder of an enclave, and who signed it."""

    grants: tuple[Grant, ...]
    governance: Governance = Governance()
    identity_by: str = "identity"
    permissions_by: str = "permissions"


class Keystore:
    """A folder with authorities (of certificates, of permissions, and others that nobody trusts) and enclaves."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._signed: dict[tuple[str, str], bytes] = {}
        (folder / "private").mkdir(parents=True)
        _openssl("genpkey", *CURVE, "-out", folder / "private" / "enclave.pem")  # one for all: they are not enemies

    def enclave(self, path: str, enclave: Enclave) -> Path:
        """Write the folder of an enclave; return it."""
        folder = self.folder / "enclaves" / path.removeprefix("/")
        folder.mkdir(parents=True)
        shutil.copy(self.folder / "private" / "enclave.pem", folder / "key.pem")
        shutil.copy(self._authority("identity")[0], folder / "identity_ca.cert.pem")
        shutil.copy(self._authority("permissions")[0], folder / "permissions_ca.cert.pem")
        certificate, key = self._authority(enclave.identity_by)
        request, subject = folder / "request.pem", "/CN=" + path.replace("/", r"\/")
        _openssl("req", "-new", "-key", folder / "key.pem", "-subj", subject, "-out", request)
        signer = ("-CA", certificate, "-CAkey", key, "-CAcreateserial", "-days", "3650")
        _openssl("x509", "-req", "-in", request, *signer, "-out", folder / "cert.pem")
        request.unlink()
        permissions = _document(f"<permissions>{''.join(one.xml(path) for one in enclave.grants)}</permissions>")
        (folder / "permissions.p7s").write_bytes(self._signature(permissions, enclave.permissions_by))
        (folder / "governance.p7s").write_bytes(self._signature(enclave.governance.xml, enclave.permissions_by))
        return folder

    def _authority(self, name: str) -> tuple[Path, Path]:
        """The certificate and the key of an authority, which is there from now on."""
        certificate, key = self.folder / f"{name}_ca.cert.pem", self.folder / "private" / f"{name}_ca.key.pem"
        if not key.exists():
            _openssl("genpkey", *CURVE, "-out", key)
            _openssl("req", "-x509", "-new", "-key", key, "-subj", f"/CN={name}", "-days", "3650", "-out", certificate)
        return certificate, key

    def _signature(self, text: str, authority: str) -> bytes:
        if (text, authority) not in self._signed:
            certificate, key = self._authority(authority)
            plain, signed = self.folder / "private" / "text.xml", self.folder / "private" / "text.p7s"
            plain.write_text(text, "utf-8")
            _openssl("smime", "-sign", "-text", "-in", plain, "-out", signed, "-signer", certificate, "-inkey", key)
            self._signed[text, authority] = signed.read_bytes()
        return self._signed[text, authority]


def _openssl(*words: str | Path) -> None:
    done = subprocess.run(["openssl", *map(str, words)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def _document(inside: str) -> str:
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<dds>{inside}</dds>\n'


def _fields(said: dict[str, str]) -> str:
    return "".join(f"<{name}>{value}</{name}>" for name, value in said.items())


def _each(name: str, values: Sequence[str]) -> str:
    return "".join(f"<{name}>{escape(value)}</{name}>" for value in values)


def _domains(ranges: Sequence[tuple[int, int]]) -> str:
    inside = "".join(f"<id_range><min>{low}</min><max>{high}</max></id_range>" for low, high in ranges)
    return f"<domains>{inside}</domains>"
