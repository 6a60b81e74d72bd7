"""SROS 2 keystores for tests, made with ``openssl``: CAs, certificates, signed governance and permissions."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

EC = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
TOPIC_RULE = """<topic_rule><topic_expression>{expression}</topic_expression>
<enable_discovery_protection>{discovery}</enable_discovery_protection>
<enable_liveliness_protection>{discovery}</enable_liveliness_protection>
<enable_read_access_control>{reading}</enable_read_access_control>
<enable_write_access_control>{writing}</enable_write_access_control>
<metadata_protection_kind>{metadata}</metadata_protection_kind>
<data_protection_kind>{data}</data_protection_kind></topic_rule>"""


def topic_rule(
    expression: str = "*",
    reading: str = "true",
    writing: str = "true",
    metadata: str = "ENCRYPT",
    data: str = "ENCRYPT",
    discovery: str = "true",
) -> str:
    said = {"reading": reading, "writing": writing, "metadata": metadata, "data": data, "discovery": discovery}
    return TOPIC_RULE.format(expression=expression, **said)


def governance(
    *topics: str,
    rtps: str = "SIGN",
    unauthenticated: str = "false",
    joining: str = "true",
    discovery: str = "ENCRYPT",
    domains: str = "<id>0</id>",
) -> str:
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<dds><domain_access_rules><domain_rule>
<domains>{domains}</domains>
<allow_unauthenticated_participants>{unauthenticated}</allow_unauthenticated_participants>
<enable_join_access_control>{joining}</enable_join_access_control>
<discovery_protection_kind>{discovery}</discovery_protection_kind>
<liveliness_protection_kind>{discovery}</liveliness_protection_kind>
<rtps_protection_kind>{rtps}</rtps_protection_kind>
<topic_access_rules>{"".join(topics or (topic_rule(),))}</topic_access_rules>
</domain_rule></domain_access_rules></dds>
"""


def joined(*governances: str) -> str:
    """Return one governance with the domain rules of several, in their order."""
    rules = (text.partition("<domain_access_rules>")[2].partition("</domain_access_rules>")[0] for text in governances)
    return f"<dds><domain_access_rules>{''.join(rules)}</domain_access_rules></dds>"


def rule(
    kind: str,
    publish: tuple[str, ...] = (),
    subscribe: tuple[str, ...] = (),
    domains: str = "<id>0</id>",
    partition: str = "",
) -> str:
    """``allow`` or ``deny`` some DDS topics."""
    within = f"<partitions><partition>{partition}</partition></partitions>" if partition else ""
    parts = [f"<domains>{domains}</domains>"]
    for direction, topics in (("publish", publish), ("subscribe", subscribe)):
        if topics:
            named = "\n".join(f"<topic>{topic}</topic>" for topic in topics)
            parts.append(f"<{direction}><topics>\n{named}\n</topics>{within}</{direction}>")
    return f"<{kind}_rule>\n" + "\n".join(parts) + f"\n</{kind}_rule>"


def grant(
    enclave: str, *rules: str, default: str = "DENY", validity: tuple[str, str] = ("2020-01-01", "2060-01-01")
) -> str:
    first, last = validity
    return f"""<grant name="{enclave}"><subject_name>CN={enclave}</subject_name>
<validity><not_before>{first}T00:00:00</not_before><not_after>{last}T00:00:00</not_after></validity>
{chr(10).join(rules)}
<default>{default}</default></grant>"""


def permissions(*grants: str) -> str:
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<dds><permissions>\n{chr(10).join(grants)}\n</permissions></dds>\n'


def _openssl(*arguments: str) -> None:
    subprocess.run(["openssl", *arguments], check=True, capture_output=True, timeout=60)


@dataclass
class Keystore:
    """A keystore in the making; one CA for identities, one for permissions. A copy of a folder goes on where it was."""

    folder: Path

    def __post_init__(self) -> None:
        if self.folder.is_dir() and any(self.folder.iterdir()):
            return
        for name in ("public", "private", "enclaves"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        for name in ("identity_ca", "permissions_ca"):
            self.authority(name)
        self.governance(governance())

    def authority(self, name: str) -> None:
        key, cert = self.folder / "private" / f"{name}.key.pem", self.folder / "public" / f"{name}.cert.pem"
        _openssl("req", "-x509", *EC, "-keyout", str(key), "-out", str(cert), "-subj", f"/CN={name}", "-days", "3000")

    def governance(self, text: str) -> None:
        self.sign(text, self.folder / "enclaves" / "governance.p7s")

    def sign(self, text: str, file: Path, authority: str = "permissions_ca") -> None:
        """Sign a text as sros2 does."""
        plain = file.with_suffix(".xml")
        plain.write_text(text, encoding="utf-8")
        cert, key = f"public/{authority}.cert.pem", f"private/{authority}.key.pem"
        signer = ("-signer", str(self.folder / cert), "-inkey", str(self.folder / key))
        _openssl("smime", "-sign", "-text", "-in", str(plain), "-out", str(file), *signer)

    def enclave(
        self, path: str, text: str, *, subject: str | None = None, days: int = 3000, authority: str = "identity_ca"
    ) -> Path:
        """Add an enclave with its certificate and permissions; return its folder."""
        folder = self.folder / "enclaves" / path.strip("/")
        folder.mkdir(parents=True)
        name = (subject or path).replace("/", r"\/")
        request = str(folder / "request.csr")
        _openssl("req", *EC, "-keyout", str(folder / "key.pem"), "-out", request, "-subj", f"/CN={name}")
        ca, key = self.folder / f"public/{authority}.cert.pem", self.folder / f"private/{authority}.key.pem"
        given = ("-CA", str(ca), "-CAkey", str(key), "-CAcreateserial", "-days", str(days))
        _openssl("x509", "-req", "-in", request, *given, "-out", str(folder / "cert.pem"))
        (folder / "request.csr").unlink()
        self.sign(text, folder / "permissions.p7s")
        for linked in ("enclaves/governance.p7s", "public/identity_ca.cert.pem", "public/permissions_ca.cert.pem"):
            target = self.folder / linked
            (folder / target.name).symlink_to(os.path.relpath(target, folder))
        return folder
