"""A keystore in place of a policy: the same answer through every door, and what is not known is said (S5, S6, S11)."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.model import ACCESS_GAP
from rosprivacy.reading.granted import read_granted
from rosprivacy.settings import Settings
from tests.helpers.command import cli
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"
POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="/camera"><profiles><profile ns="/" node="camera"><topics publish="ALLOW"><topic>/video</topic></topics>
</profile></profiles></enclave>
<enclave path="/uplink"><profiles><profile ns="/" node="uplink"><topics subscribe="ALLOW"><topic>/video</topic></topics>
</profile></profiles></enclave></enclaves></policy>"""
PUBLISHED = permissions(grant("/camera", rule("allow", publish=("rt/video",))))


@pytest.fixture(scope="module")
def keystore(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("deployed")
    made = Keystore(folder / "keystore")
    made.enclave("/camera", PUBLISHED)
    made.enclave("/uplink", permissions(grant("/uplink", rule("allow", subscribe=("rt/video",)))))
    (folder / "labels.yaml").write_text(LABELS)
    (folder / "policy.xml").write_text(POLICY)
    (folder / "permissions.xml").write_text(PUBLISHED)
    return folder


def steps(cli: Cli, *arguments: str | Path) -> tuple[int, list[list[str]]]:
    """The exit code, and the names on the way of each finding."""
    done = cli("analyze", *arguments, "--format", "json")
    assert done.returncode in (0, 1, 4), done.stderr
    found = json.loads(done.stdout)["findings"]
    return done.returncode, [[step["name"] for step in finding["witness"]] for finding in found]


def test_the_deployed_keystore_gives_the_findings_of_its_policy(cli: Cli, keystore: Path) -> None:
    labels = ("-l", keystore / "labels.yaml")
    stated, granted = (steps(cli, keystore / name, *labels) for name in ("policy.xml", "keystore"))
    assert stated == granted == (1, [["/camera", "/video", "/uplink"]])


def test_a_saved_graph_keeps_what_was_deployed(cli: Cli, keystore: Path, tmp_path: Path) -> None:
    saved = tmp_path / "graph.json"
    first = steps(cli, keystore / "keystore", "-l", keystore / "labels.yaml", "--save-graph", saved)
    assert steps(cli, "--add", saved, "-l", keystore / "labels.yaml") == first


def test_what_is_said_of_a_file_goes_with_the_policies_that_rest_on_it(keystore: Path, tmp_path: Path) -> None:
    """So a saved graph keeps it, and each policy alone has it; once, where it is about one enclave."""
    shutil.copytree(keystore / "keystore", tmp_path / "k", symlinks=True)
    Keystore(tmp_path / "k").governance(governance(topic_rule(reading="false")))
    policies, said = read_granted([str(tmp_path / "k")], Settings(today="2070-01-01"))
    told = [[one.message.partition(" is valid")[0] for one in policy.diagnostics] for policy in policies]
    assert said == ()
    assert [[text for text in texts if "certificate" in text] for texts in told] == [
        ["the certificate of CN=/camera"], ["the certificate of CN=/uplink"]
    ]  # fmt: skip
    assert [[text for text in texts if text.startswith("grant of")] for texts in told] == [
        ["grant of CN=/camera"], ["grant of CN=/uplink"]
    ]  # fmt: skip
    assert [sum(one.code == ACCESS_GAP for one in policy.diagnostics) for policy in policies] == [1, 1]


def test_a_fleet_can_name_a_keystore(keystore: Path) -> None:
    fleet = keystore / "fleet.yaml"
    fleet.write_text("fleet: 1\nrobots: {r1: {policies: [keystore], labels: [labels.yaml]}}\n")
    result = rosprivacy.analyze_fleet(fleet)
    assert [finding.verdict for finding in [result.analysis]] == ["leak"]


def test_a_keystore_outside_the_folder_of_its_fleet_is_refused(keystore: Path, tmp_path: Path) -> None:
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"fleet: 1\nrobots: {{r1: {{policies: [{keystore / 'keystore'}]}}}}\n")
    with pytest.raises(rosprivacy.InputErrors, match="outside"):
        rosprivacy.analyze_fleet(fleet)


def test_permissions_by_themselves_are_read_only_where_nobody_has_to_have_signed_them(cli: Cli, keystore: Path) -> None:
    done = cli("analyze", keystore / "permissions.xml")
    assert done.returncode == 2
    assert "nothing says who may sign them; name the keystore, or read them all the same" in done.stderr
    assert cli("analyze", keystore / "permissions.xml", "--allow-unsigned").returncode in (0, 4)


def test_what_is_signed_is_changed_in_the_policy_not_by_a_patch(cli: Cli, keystore: Path) -> None:
    done = cli("mitigate", keystore / "keystore", "-l", keystore / "labels.yaml", "--by", "deny")
    assert "no change can be proposed" in done.stdout


def test_where_permissions_are_not_asked_the_answer_is_undetermined_at_best(cli: Cli, tmp_path: Path) -> None:
    made = Keystore(tmp_path / "keystore")
    made.enclave("/camera", PUBLISHED)
    made.enclave("/uplink", permissions(grant("/uplink", rule("allow", subscribe=("rt/other",)))))
    made.governance(governance(topic_rule("rt/video", reading="false"), topic_rule()))
    (tmp_path / "labels.yaml").write_text(f"{LABELS}channels: {{/video: sensitive}}\n")
    arguments = ("analyze", made.folder, "-l", tmp_path / "labels.yaml")
    declared = cli(*arguments)
    assert declared.returncode == 4
    assert cli(*arguments, "--save-graph", tmp_path / "graph.json").returncode == 4
    again = cli("analyze", "--add", tmp_path / "graph.json", "-l", tmp_path / "labels.yaml")
    assert (again.returncode, again.stdout) == (4, declared.stdout)
    assert declared.stdout.startswith("undetermined: no leak reached, but not all is known; what ")
    enforced = cli(*arguments, "--view", "enforced", "--format", "json", "--save-graph", tmp_path / "open.json")
    saved = ("analyze", "--add", tmp_path / "open.json", "-l", tmp_path / "labels.yaml")
    assert cli(*saved, "--view", "enforced", "--format", "json").stdout == enforced.stdout
    [finding] = json.loads(enforced.stdout)["findings"]
    assert [step["name"] for step in finding["witness"]][::2] == ["/camera", "/uplink"]
    [added] = json.loads(cli(*arguments, "--view", "both", "--format", "json").stdout)["enforced"]["added"]
    assert (added["finding"], added["enclaves"]) == (
        finding,
        [],
    )  # nobody shares one
    assert ["governance" in one["file"] for one in added["opened_by"]] == [True]
    assert "only because permissions are not asked there: " in cli(*arguments, "--view", "both").stdout
    for language, words in (("de", "ist nicht bekannt"), ("fr", "pas connu")):
        assert words in cli(*arguments, "--lang", language).stdout.splitlines()[0]
