"""Fleet files and the policies that they name, written where a test wants them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rosprivacy.ingest.fleet.fleet_file import Fleet, read_fleet
from rosprivacy.ontology.vocabulary import load


def policy(*profiles: str) -> str:
    """Profiles as ``node>written<read``, names separated by commas; ``!`` before a name denies it."""
    text = ""
    for profile in profiles:
        node, written, read = re.fullmatch(r"([^<>]+)(?:>([^<]*))?(?:<(.*))?", profile).groups()  # type: ignore[union-attr]
        space, _, name = node.rpartition("/")
        text += f'<profile ns="{space or "/"}" node="{name}">'
        for role, names in (("publish", written), ("subscribe", read)):
            for topic in (names or "").split(","):
                rule = "DENY" if topic.startswith("!") else "ALLOW"
                text += f'<topics {role}="{rule}"><topic>{topic.strip("!")}</topic></topics>' if topic else ""
        text += "</profile>"
    enclave = f'<enclave path="/e"><profiles>{text}</profiles></enclave>'
    return f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>'


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two models: one sees, one shows."""
    monkeypatch.chdir(tmp_path)
    write("eye.xml", policy("/camera>/image", "/uplink</image"))
    write(
        "eye.yaml",
        "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: conduit\nchannels: {/image: sensitive}\n",
    )
    write("wall.xml", policy("/receiver>/picture", "/screen</picture"))
    write(
        "wall.yaml",
        "labels: 1\nnodes:\n  /receiver: conduit\n  /screen: {leak: [Video]}\nchannels: {/picture: sensitive}\n",
    )
    return tmp_path


def write(name: str, text: str) -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text(text, "utf-8")


MODELS = "models: {eye: {policies: eye.xml, labels: eye.yaml}, wall: {policies: wall.xml, labels: wall.yaml}}\n"


def read(text: str) -> Fleet:
    write("f.yaml", text)
    return read_fleet("f.yaml", load())
