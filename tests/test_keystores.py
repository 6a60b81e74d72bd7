"""A keystore in place of a policy: the same answer through every door, and what is not known is said (S5, S6, S11)."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.model import ACCESS_GAP
from rosprivacy.settings import Settings
from rosprivacy.systems.granted import read_granted
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli


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


def test_the_deployed_keystore_gives_the_findings_of_its_policy(cli: Cli, keystore: Path, tmp_path: Path) -> None:
    """So does a graph that is saved of it."""
    labels, saved = ("-l", keystore / "labels.yaml"), tmp_path / "graph.json"
    stated = steps(cli, keystore / "policy.xml", *labels)
    granted = steps(cli, keystore / "keystore", *labels, "--save-graph", saved)
    assert stated == granted == steps(cli, "--add", saved, *labels) == (1, [["/camera", "/video", "/uplink"]])


def test_what_is_said_of_a_file_goes_with_the_policies_that_rest_on_it(keystore: Path, tmp_path: Path) -> None:
    """So a saved graph keeps it, and each policy alone has it; once, where it is about one enclave."""
    shutil.copytree(keystore / "keystore", tmp_path / "k", symlinks=True)
    Keystore(tmp_path / "k").governance(governance(topic_rule(reading="false")))
    policies, said = read_granted([str(tmp_path / "k")], Settings(today="2070-01-01"))
    told = [[one.message.partition(" is valid")[0] for one in policy.diagnostics] for policy in policies]
    assert said == ()
    for of_whom, texts in zip(("/camera", "/uplink"), told, strict=True):
        dated = [text for text in texts if "certificate" in text or text.startswith("grant of")]
        assert sorted(dated) == [f"grant of CN={of_whom}", f"the certificate of CN={of_whom}"]
    assert [sum(one.code == ACCESS_GAP for one in policy.diagnostics) for policy in policies] == [1, 1]


def test_a_fleet_can_name_a_keystore_in_its_folder(keystore: Path, tmp_path: Path) -> None:
    fleet = keystore / "fleet.yaml"
    fleet.write_text("fleet: 1\nrobots: {r1: {policies: [keystore], labels: [labels.yaml]}}\n")
    assert rosprivacy.analyze_fleet(fleet).analysis.verdict == "leak"
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"fleet: 1\nrobots: {{r1: {{policies: [{keystore / 'keystore'}]}}}}\n")
    with pytest.raises(rosprivacy.InputErrors, match="leaves the folder"):
        rosprivacy.analyze_fleet(fleet)


def test_permissions_by_themselves_are_read_only_where_nobody_has_to_have_signed_them(cli: Cli, keystore: Path) -> None:
    done = cli("analyze", keystore / "permissions.xml")
    assert done.returncode == 2
    assert "nothing says who may sign them; name the keystore, or read them all the same" in done.stderr
    assert cli("analyze", keystore / "permissions.xml", "--allow-unsigned").returncode in (0, 4)


def test_what_is_signed_is_changed_in_the_policy_not_by_a_patch(cli: Cli, keystore: Path) -> None:
    done = cli("mitigate", keystore / "keystore", "-l", keystore / "labels.yaml", "--by", "deny")
    assert "no change can be proposed" in done.stdout


@pytest.mark.slow
def test_where_permissions_are_not_asked_the_answer_is_undetermined_at_best(cli: Cli, tmp_path: Path) -> None:
    """In a saved graph too; the enforced view has the way that is open, and names the governance that opens it."""
    made = Keystore(tmp_path / "keystore")
    made.enclave("/camera", PUBLISHED)
    made.enclave("/uplink", permissions(grant("/uplink", rule("allow", subscribe=("rt/other",)))))
    made.governance(governance(topic_rule("rt/video", reading="false"), topic_rule()))
    (tmp_path / "labels.yaml").write_text(f"{LABELS}channels: {{/video: sensitive}}\n")

    def asked(*arguments: str | Path) -> tuple[int, str]:
        done = cli("analyze", *arguments, "-l", tmp_path / "labels.yaml", "-f", "json")
        return done.returncode, done.stdout

    graph = tmp_path / "graph.json"
    declared = asked(made.folder, "--save-graph", graph)
    assert declared[0] == 4
    assert asked("--add", graph) == declared
    enforced = asked(made.folder, "--view", "enforced", "--save-graph", tmp_path / "open.json")
    assert asked("--add", tmp_path / "open.json", "--view", "enforced") == enforced
    [finding] = json.loads(enforced[1])["findings"]
    assert [step["name"] for step in finding["witness"]][::2] == ["/camera", "/uplink"]
    [added] = json.loads(asked(made.folder, "--view", "both")[1])["enforced"]["added"]
    assert (added["finding"], added["enclaves"]) == (finding, [])  # nobody shares one
    assert ["governance" in one["file"] for one in added["opened_by"]] == [True]
