"""Certificates on loopback, made anew for each test and never kept: a CA, and what it signs."""

from __future__ import annotations

import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

NEW_KEY = ("-newkey", "rsa:2048", "-nodes")


def _openssl(folder: Path, *words: str) -> None:
    if shutil.which("openssl") is None:
        pytest.skip("NO openssl: sessions with TLS were not tested")
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)


def authority(folder: Path, name: str) -> Path:
    """Make a CA; return its certificate."""
    _openssl(folder, "req", "-x509", *NEW_KEY, "-keyout", f"{name}.key", "-out", f"{name}.pem", "-subj", f"/CN={name}")
    return folder / f"{name}.pem"


def signed(folder: Path, name: str, by: str) -> tuple[Path, Path]:
    """Make a key for 127.0.0.1 that a CA of the same folder has signed; return the certificate and the key."""
    (folder / "names").write_text("subjectAltName=IP:127.0.0.1,DNS:localhost\n")
    _openssl(folder, "req", *NEW_KEY, "-keyout", f"{name}.key", "-out", f"{name}.csr", "-subj", f"/CN={name}")
    ca = ("-CA", f"{by}.pem", "-CAkey", f"{by}.key", "-CAcreateserial", "-extfile", "names")
    _openssl(folder, "x509", "-req", "-in", f"{name}.csr", "-out", f"{name}.pem", *ca)
    return folder / f"{name}.pem", folder / f"{name}.key"
