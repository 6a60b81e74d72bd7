"""``rosprivacy check`` names each line that does not hold after the known generator of Zenoh lists (rules S4, S5)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import jsonschema
import pytest

from rosprivacy.ingest.deployed.differences import FAULTS
from tests.helpers.command import cli
from tests.helpers.lossy_lists import lossy_lists
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

HEAD = '<policy version="0.2.0"><enclaves>\n<enclave path="/"><profiles>\n<profile ns="/" node="camera">\n'
FOOT = "\n</profile>\n</profiles></enclave></enclaves></policy>\n"
VIDEO = '<topics publish="ALLOW"><topic>/video</topic></topics>'
SPACE = '<profile ns="/robot" node="camera">'
IN_SPACE = HEAD.replace('<profile ns="/" node="camera">', SPACE)


def losses(cli: Cli, folder: Path, policy: str, tail: str = "/*/*") -> list[tuple[str, int, str]]:
    """(loss, line, message)."""
    (folder / "p.xml").write_text(policy)
    files = [file.name for file in lossy_lists(policy, folder, tail)]
    done = cli("check", "p.xml", *files, "-f", "json", cwd=folder)
    document = json.loads(done.stdout)
    jsonschema.validate(document, json.loads((ROOT / "docs/check.schema.json").read_text("utf-8")))
    assert document["undetermined"]  # the generator's lists let in any session
    assert done.returncode == (1 if document["differences"] else 4)
    text = cli("check", "p.xml", *files, cwd=folder).stdout.splitlines()
    assert all(one["message"] in text for one in document["losses"])
    return [(one["loss"], one["line"], one["message"]) for one in document["losses"]]


NEXT_ENCLAVE = '</profile></profiles></enclave>\n<enclave path="/b"><profiles>\n<profile ns="/" node="lidar">'
VOICE_DENIED = '<topics publish="DENY"><topic>/voice</topic></topics>'
SPIN = '<actions execute="ALLOW"><action>/spin</action></actions>'
BOTH = '<topics publish="ALLOW" subscribe="ALLOW"><topic>/video</topic></topics>'
CASES = [
    ("deny-became-allow", f"{HEAD}{VIDEO}\n{VOICE_DENIED}", 5, "DENY publish topic /voice: ", "write topic /voice"),
    ("action-not-read", f"{HEAD}{VIDEO}\n{SPIN}", 5, "ALLOW execute action /spin: ", "has nothing of it"),
    ("enclave-not-read", f"{HEAD}{VIDEO}{NEXT_ENCLAVE}{VIDEO}", 6, "profile /lidar: ", "enclave /b has no list"),
    ("one-role-only", f"{HEAD}{BOTH}", 4, "ALLOW publish topic /video: ", "has it for the other role only"),
    ("namespace-not-applied", f"{IN_SPACE}{VIDEO.replace('/video', 'video')}", 4,
     "ALLOW publish topic /robot/video: ", "has /video"),
    ("namespace-not-applied", f"{IN_SPACE}{VIDEO.replace('/video', '~/video')}", 4,
     "ALLOW publish topic /robot/camera/video: ", "has /camera/video"),
    ("one-file-for-two-nodes", f"{HEAD}{VIDEO}</profile>\n{SPACE}{VIDEO}", 5, "profile /robot/camera: ",
     "node /camera of line 3 has the same list camera.json5"),
    ("names-below", f"{HEAD}{VIDEO}", 16, "", "opens all names below /video too"),
]  # fmt: skip


@pytest.mark.parametrize(("fault", "policy", "line", "grant", "lost"), CASES, ids=[case[0] for case in CASES])
def test_a_line_that_does_not_hold_is_named_with_what_the_list_has(
    cli: Cli, tmp_path: Path, fault: str, policy: str, line: int, grant: str, lost: str
) -> None:
    """And with what the generator is known to lose."""
    ((loss, at, message),) = losses(cli, tmp_path, policy + FOOT, "/**" if fault == "names-below" else "/*/*")
    assert (loss, at) == (fault, line)
    assert not grant or message.startswith(f"line p.xml:{line} {grant}")
    assert lost in message
    assert message.endswith(f"a known loss of zenoh_security_tools: {FAULTS[fault]}")
    assert "camera.json5" in message or fault == "enclave-not-read"


@pytest.mark.parametrize(
    ("group", "item", "role"), [("topics", "topic", "subscribe"), ("services", "service", "request")]
)
def test_other_denies_are_not_written(cli: Cli, tmp_path: Path, group: str, item: str, role: str) -> None:
    written = f'<{group} {role}="{{}}"><{item}>{{}}</{item}></{group}>'
    lines = f"{written.format('ALLOW', '*')}\n{written.format('DENY', '/voice')}"
    found = losses(cli, tmp_path, f"{HEAD}{lines}{FOOT}")
    assert ("deny-not-written", 5) in {one[:2] for one in found}
    assert all(one[2].startswith(f"line p.xml:5 DENY {role} {item} /voice: camera.json5:") for one in found)


def test_where_nothing_is_lost_nothing_is_named(cli: Cli, tmp_path: Path) -> None:
    services = '<services reply="ALLOW"><service>~/start</service></services>'
    assert losses(cli, tmp_path, f"{HEAD}{VIDEO}{services}{FOOT}") == []


def test_each_fault_has_a_test() -> None:
    assert {fault for fault, *_ in CASES} | {"deny-not-written"} == set(FAULTS)
