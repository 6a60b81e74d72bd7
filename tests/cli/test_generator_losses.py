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
SAID = "a known loss of zenoh_security_tools"


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


def test_where_nothing_is_lost_nothing_is_told(cli: Cli, tmp_path: Path) -> None:
    services = '<services reply="ALLOW"><service>~/start</service></services>'
    assert losses(cli, tmp_path, f"{HEAD}{VIDEO}{services}{FOOT}") == []


def test_a_deny_of_publish_becomes_an_allow(cli: Cli, tmp_path: Path) -> None:
    (loss,) = losses(cli, tmp_path, f'{HEAD}{VIDEO}\n<topics publish="DENY"><topic>/voice</topic></topics>{FOOT}')
    assert loss[:2] == ("deny-became-allow", 5)
    assert loss[2].startswith("line p.xml:5 DENY publish topic /voice: camera.json5:")
    assert loss[2].endswith(f"allows to write topic /voice; {SAID}: {FAULTS[loss[0]]}")


@pytest.mark.parametrize(
    ("group", "item", "role"), [("topics", "topic", "subscribe"), ("services", "service", "request")]
)
def test_other_denies_are_not_written(cli: Cli, tmp_path: Path, group: str, item: str, role: str) -> None:
    written = f'<{group} {role}="{{}}"><{item}>{{}}</{item}></{group}>'
    lines = f"{written.format('ALLOW', '*')}\n{written.format('DENY', '/voice')}"
    said = losses(cli, tmp_path, f"{HEAD}{lines}{FOOT}")
    assert ("deny-not-written", 5) in {one[:2] for one in said}
    assert all(one[2].startswith(f"line p.xml:5 DENY {role} {item} /voice: camera.json5:") for one in said)


def test_actions_are_not_read(cli: Cli, tmp_path: Path) -> None:
    lines = f'{VIDEO}\n<actions execute="ALLOW"><action>/spin</action></actions>'
    message = f"line p.xml:5 ALLOW execute action /spin: camera.json5 has nothing of it; {SAID}: actions are not read"
    assert losses(cli, tmp_path, f"{HEAD}{lines}{FOOT}") == [("action-not-read", 5, message)]


def test_only_the_first_enclave_is_read(cli: Cli, tmp_path: Path) -> None:
    second = '</profile></profiles></enclave>\n<enclave path="/b"><profiles>\n<profile ns="/" node="lidar">'
    message = f"line p.xml:6 profile /lidar: enclave /b has no list for it here; {SAID}: only the first enclave is read"
    assert losses(cli, tmp_path, f"{HEAD}{VIDEO}{second}{VIDEO}{FOOT}") == [("enclave-not-read", 6, message)]


def test_the_old_form_of_a_key_opens_names_below(cli: Cli, tmp_path: Path) -> None:
    (loss,) = losses(cli, tmp_path, f"{HEAD}{VIDEO}{FOOT}", "/**")
    assert (loss[0], "camera.json5:" in loss[2]) == ("names-below", True)
    assert "opens all names below /video too; " in loss[2]


def test_of_an_element_with_two_roles_one_is_read(cli: Cli, tmp_path: Path) -> None:
    lines = '<topics publish="ALLOW" subscribe="ALLOW"><topic>/video</topic></topics>'
    message = "line p.xml:4 ALLOW publish topic /video: camera.json5 has it for the other role only; "
    assert losses(cli, tmp_path, f"{HEAD}{lines}{FOOT}") == [
        ("one-role-only", 4, f"{message}{SAID}: {FAULTS['one-role-only']}")
    ]


@pytest.mark.parametrize("name", ["video", "~/video"])
def test_names_get_no_namespace(cli: Cli, tmp_path: Path, name: str) -> None:
    head = HEAD.replace('<profile ns="/" node="camera">', SPACE)
    lines = f'<topics publish="ALLOW"><topic>{name}</topic></topics>'
    had = name.replace("~", "camera")
    message = f"line p.xml:4 ALLOW publish topic /robot/{had}: camera.json5 has /{had}; {SAID}: names get no namespace"
    assert losses(cli, tmp_path, f"{head}{lines}{FOOT}") == [("namespace-not-applied", 4, message)]


def test_nodes_with_one_base_name_have_one_list(cli: Cli, tmp_path: Path) -> None:
    policy = f"{HEAD}{VIDEO}</profile>\n{SPACE}<topics publish='ALLOW'><topic>/other</topic></topics>{FOOT}"
    message = "line p.xml:5 profile /robot/camera: node /camera of line 3 has the same list camera.json5; "
    assert losses(cli, tmp_path, policy) == [
        ("one-file-for-two-nodes", 5, f"{message}{SAID}: {FAULTS['one-file-for-two-nodes']}")
    ]


def test_each_fault_has_a_test() -> None:
    from pathlib import Path

    text = Path(__file__).read_text("utf-8")
    assert all(f'"{fault}"' in text for fault in FAULTS)
