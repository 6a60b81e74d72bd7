"""``rosprivacy check``: what a policy says, and what is deployed."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest

from tests.helpers.checkouts import CAMERA, put_checkout
from tests.helpers.command import cli
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]
SCHEMA = json.loads((ROOT / "docs/check.schema.json").read_text("utf-8"))

POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="/camera"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>/video</topic></topics>
<services reply="ALLOW"><service>/start</service></services>
</profile></profiles></enclave></enclaves></policy>
"""
REPLY = (rule("allow", publish=("rt/video", "rr/startReply", "ros_discovery_info"), subscribe=("rq/startRequest",)),)
ACL = """{access_control: {enabled: true, default_permission: "deny",
 rules: [{id: "r", messages: ["put"], flows: ["egress"], permission: "allow", key_exprs: ["0/audio/*/*"]}],
 subjects: [{id: "s"}], policies: [{rules: ["r"], subjects: ["s"]}]}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "p.policy.xml").write_text(POLICY)
    return tmp_path


def test_what_sros2_made_of_a_policy_holds_what_it_says(cli: Cli, folder: Path) -> None:
    Keystore(folder / "k").enclave("/camera", permissions(grant("/camera", *REPLY)))
    done = cli("check", "p.policy.xml", "k", cwd=folder)
    same, signer = done.stdout.splitlines()
    assert (done.returncode, same) == (0, "what is deployed is what the policy says")
    assert signer.startswith("notice: k/public/permissions_ca.cert.pem: the CA of the signatures, SHA-256 ")


def test_what_only_one_of_them_says_is_told_with_its_line(cli: Cli, folder: Path) -> None:
    other = rule("allow", publish=("rt/video", "rt/audio"))
    Keystore(folder / "k").enclave("/camera", permissions(grant("/camera", other)))
    done = cli("check", "p.policy.xml", "k", cwd=folder)
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert lines[2] == "      write topic /audio   k/enclaves/camera/permissions.p7s:17"
    assert lines[4] == "      read service /start (request)   p.policy.xml:4"
    assert lines[-1] == "2 rights of the policy not deployed, 1 right deployed and not in the policy"


def checked(cli: Cli, folder: Path, *more: str) -> Any:
    """The document, which keeps its contract, beside the exit code."""
    done = cli("check", "p.policy.xml", *more, "-f", "json", cwd=folder)
    document = json.loads(done.stdout)
    jsonschema.validate(document, SCHEMA)
    return document | {"code": done.returncode}


def test_each_enclave_is_compared(cli: Cli, folder: Path) -> None:
    Keystore(folder / "k").enclave("/viewer", permissions(grant("/viewer", rule("allow", subscribe=("rt/video",)))))
    document = checked(cli, folder, "k")
    assert {(row["enclave"], row["only_in"], row["right"], row["name"]) for row in document["differences"]} == {
        ("/camera", "policy", "write", "/video"),
        ("/camera", "policy", "read", "/start"),
        ("/camera", "policy", "write", "/start"),
        ("/viewer", "deployed", "read", "/video"),
    }


def test_a_file_of_zenoh_is_compared_with_the_node_of_its_name(cli: Cli, folder: Path) -> None:
    """The generator that rmw_zenoh has loses lines: these are told."""
    pytest.importorskip("json5")
    (folder / "camera.json5").write_text(ACL)
    done = cli("check", "p.policy.xml", "camera.json5", cwd=folder)
    assert done.returncode == 1
    assert "      write topic /audio   camera.json5:2" in done.stdout.splitlines()
    assert "      write topic /video   p.policy.xml:3" in done.stdout.splitlines()


@pytest.mark.parametrize(
    ("rules", "code"),
    [(None, 4), (governance(topic_rule(reading="false")), 4), (governance(), 0)],
    ids=["no governance", "not asked", "asked"],
)
def test_where_permissions_may_not_be_asked_no_difference_is_not_told_as_none(
    cli: Cli, folder: Path, rules: str | None, code: int
) -> None:
    """Nothing says whether they are; they are not (rule S11). What is not verified is not compared unasked."""
    (folder / "permissions.xml").write_text(permissions(grant("/camera", *REPLY)))
    files = ["permissions.xml"]
    if rules:
        (folder / "governance.xml").write_text(rules)
        files.append("governance.xml")
    assert cli("check", "p.policy.xml", *files, cwd=folder).returncode == 2
    assert checked(cli, folder, *files, "--allow-unsigned")["code"] == code
    (folder / "p.policy.xml").write_text(POLICY.replace("/video", "/audio"))
    document = checked(cli, folder, *files, "--allow-unsigned")
    assert (document["code"], document["undetermined"]) == (1, bool(code))


@pytest.mark.parametrize(
    ("rules", "exposed"),
    [
        (governance(), []),
        (governance(topic_rule("rt/open", data="NONE", metadata="SIGN"), topic_rule(), rtps="NONE"),
         [("not-encrypted", "rt/open")]),
        (governance(unauthenticated="true"), [("strangers", "*")]),
    ],
    ids=["closed", "not encrypted", "strangers"],
)  # fmt: skip
def test_what_the_governance_leaves_in_the_open_is_no_difference_and_is_seen(
    cli: Cli, folder: Path, rules: str, exposed: list[tuple[str, str]]
) -> None:
    """A policy says nothing of it, so the rights are the same; a gate can ask for it."""
    keystore = Keystore(folder / "k")
    keystore.enclave("/camera", permissions(grant("/camera", *REPLY)))
    keystore.governance(rules)
    assert checked(cli, folder, "k")["code"] == 0
    assert ("\nexposed: 1 rule of the governance lets" in cli("check", "p.policy.xml", "k", cwd=folder).stdout) == bool(
        exposed
    )
    document = checked(cli, folder, "k", "--fail-on", "exposure")
    assert document["code"] == bool(exposed)
    assert [(row["cause"], row["dds"]) for row in document["exposed"]] == exposed
    assert all(row["file"].endswith("governance.p7s") and row["line"] for row in document["exposed"])


@pytest.mark.parametrize("named", ["robot", "robot/camera.nodl.yaml", "apart"])
def test_what_a_description_says_is_compared_with_what_the_code_does(cli: Cli, tmp_path: Path, named: str) -> None:
    """Of the nodes that are described: both places are named, and channels of ROS itself count on neither side."""
    stated = "nodl_version: 2\npublishers:\n  - {name: image, type: a/msg/A}\n  - {name: ~/faces, type: a/msg/B}\n"
    rosout = "  - {name: /rosout, type: rcl_interfaces/msg/Log}\n"
    extra = CAMERA.replace('"image", 10)', '"image", 10)\n        self.create_publisher(Image, "extra", 10)')
    put_checkout(tmp_path / "robot", guide__camera_dot_py=extra)
    folder = tmp_path / ("apart" if named == "apart" else "robot")
    folder.mkdir(exist_ok=True)
    (folder / "camera.nodl.yaml").write_text(stated + rosout)
    done = cli("check", named, "robot", "--format", "json", cwd=tmp_path)
    document = json.loads(done.stdout)
    jsonschema.validate(document, SCHEMA)
    assert (done.returncode, document["compared"]) == (1, "description")
    assert [(one["only_in"], one["name"], one["file"], one["line"]) for one in document["differences"]] == [
        ("deployed", "/robot/extra", "robot/guide/camera.py", 12),
        ("policy", "/robot/camera/faces", f"{folder.name}/camera.nodl.yaml" if named != "apart" else
         "robot/../apart/camera.nodl.yaml", 4),
    ]  # fmt: skip
    notices = [one["message"] for one in document["diagnostics"] if one["file"] == "robot/guide/camera.py"]
    assert len(notices) == 1
    assert "camera.nodl.yaml:1" in notices[0]


def test_code_that_does_what_is_described_is_undetermined_at_best(cli: Cli, tmp_path: Path) -> None:
    stated = "nodl_version: 2\npublishers: [{name: image, type: sensor_msgs/msg/Image}]\n"
    put_checkout(tmp_path / "robot", camera_dot_nodl_dot_yaml=stated)
    done = cli("check", "robot", "robot", cwd=tmp_path)
    assert (done.returncode, done.stdout.partition(":")[0]) == (4, "undetermined")
