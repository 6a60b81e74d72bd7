"""What a governance leaves in the open is a finding of its own, through every door and in every output (rule S10)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.report.compare.changes import changes
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.command import cli
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule
from tests.helpers.parts import documents, in_list
from tests.helpers.paths import ROOT
from tests.helpers.written_systems import told

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli

__all__ = ["cli"]
KIND = "unprotected-channel"
LABELS = """labels: 1
nodes: {/camera: {source: [Video]}, /screen: {conduit: [Video], leak: none}}
channels: {/video: sensitive}
"""
FLEET = """fleet: 1
models: {eye: {policies: keystore, labels: labels.yaml}}
robots: {a: {model: eye, domain: hall}, b: {model: eye, domain: hall}, c: {model: eye}, d: {model: eye}}
"""
SIGNED = topic_rule("rt/video", metadata="SIGN", data="NONE")


def deployed(folder: Path, *topics: str, **domain: str) -> Path:
    """A keystore of a camera and a screen, with its labels; return the keystore."""
    made = Keystore(folder / "keystore")
    made.enclave("/camera", permissions(grant("/camera", rule("allow", publish=("rt/video",)))))
    made.enclave("/screen", permissions(grant("/screen", rule("allow", subscribe=("rt/video",)))))
    made.governance(governance(*topics, **domain))
    (folder / "labels.yaml").write_text(LABELS)
    (folder / "fleet.yaml").write_text(FLEET)
    return made.folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    where = tmp_path_factory.mktemp("unprotected")
    deployed(where, SIGNED, topic_rule())
    with chdir(where):
        yield where


def found(document: dict[str, Any]) -> list[tuple[str, ...]]:
    rows = document["findings"]
    return [(f["kind"], f["category"], f["source"]["name"], f["leak"]["name"]) for f in rows]


def test_what_is_only_signed_can_be_read_and_the_reason_is_the_line(cli: Cli, folder: Path) -> None:
    done = cli("analyze", "keystore", "-l", "labels.yaml", "--format", "json", cwd=folder)
    document = json.loads(done.stdout)
    assert (done.returncode, found(document)) == (1, [(KIND, "Video", "/camera", "/video")])
    [finding] = document["findings"]
    lines = (folder / "keystore/enclaves/governance.p7s").read_text().splitlines()
    line = int(finding["because"]["values"]["line"])
    assert "<topic_expression>rt/video" in lines[line - 1]
    assert finding["reason"] == f"nothing encrypts what is sent there, by keystore/enclaves/governance.p7s:{line}"


@pytest.mark.parametrize(
    ("topics", "domain", "kinds"),
    [
        ((), {}, []),
        ((SIGNED, topic_rule()), {"rtps": "ENCRYPT"}, []),
        ((), {"unauthenticated": "true"}, [KIND]),
        ((SIGNED, topic_rule()), {"unauthenticated": "true"}, [KIND]),
    ],
)
def test_protected_and_open(tmp_path: Path, topics: tuple[str, ...], domain: dict[str, str], kinds: list[str]) -> None:
    """As sros2 makes it; all encrypted; a stranger may join; both."""
    result = rosprivacy.analyze(deployed(tmp_path, *topics, **domain), tmp_path / "labels.yaml")
    assert [finding.kind for finding in result.analysis.findings] == kinds
    assert [str(f.why.key) for f in result.analysis.findings if f.why] == (
        [] if not kinds else ["not-encrypted-nor-closed" if topics else "strangers"]
    )


def test_a_saved_graph_gives_the_same(folder: Path, cli: Cli, tmp_path: Path) -> None:
    saved = tmp_path / "g.json"
    expected = cli("analyze", "keystore", "-l", "labels.yaml", "--save-graph", saved, "--format", "json", cwd=folder)
    assert expected.returncode == 1
    again = cli("analyze", "--add", saved, "-l", "labels.yaml", "--format", "json", cwd=folder)
    assert again.stdout == expected.stdout
    earlier = json.loads(saved.read_text())
    for policy in earlier["policies"]:
        del policy["protections"]
    saved.write_text(json.dumps(earlier))
    done = cli("analyze", "--add", saved, "-l", "labels.yaml", cwd=folder)
    assert done.returncode == 4  # it is not known
    assert "saved by an earlier version, which did not keep what the governance says of encryption" in done.stdout


def test_where_permissions_are_not_asked_a_saved_graph_is_as_undetermined(cli: Cli, tmp_path: Path) -> None:
    """What the governance says is kept with the policies (rule S11)."""
    deployed(tmp_path, topic_rule("rt/other", reading="false"), topic_rule())
    (tmp_path / "labels.yaml").write_text(LABELS.replace("conduit: [Video]", "sanitizer: {Video: drop}"))
    options = ("-l", "labels.yaml", "--format", "json")
    first = cli("analyze", "keystore", *options, "--save-graph", "g.json", cwd=tmp_path)
    again = cli("analyze", "--add", "g.json", *options, cwd=tmp_path)
    assert (first.returncode, again.returncode) == (4, 4)
    assert again.stdout == first.stdout


def test_permissions_by_themselves_say_that_nothing_is_known_of_it(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(permissions(grant("/camera", rule("allow", publish=("rt/video",)))))
    done = cli("analyze", "p.xml", "--allow-unsigned", cwd=tmp_path)
    assert "no governance is named, so whether permissions are asked there is not known, nor what is encrypted" in (
        done.stdout
    )


@pytest.mark.usefixtures("folder")
def test_on_a_fleet_robots_share_a_pattern_and_a_domain_its_channel() -> None:
    document = rosprivacy.analyze_fleet("fleet.yaml").document()
    patterns = {
        (p["findings"], tuple(p["robots"]), f["leak"]["robot"])
        for p in document["fleet"]["patterns"]
        for f in document["findings"]
        if f["id"] == p["finding"]
    }
    assert patterns == {(2, ("c", "d"), "c"), (2, ("a", "b"), "domain hall")}
    assert {kind for kind, *_ in found(document)} == {KIND}


@pytest.mark.slow
@pytest.mark.usefixtures("folder")
def test_in_parts_as_spark_has_them_the_fleet_is_the_same() -> None:
    documents("fleet.yaml", in_list)


def test_it_is_never_dismissed_and_a_decision_accepts_it(folder: Path) -> None:
    labels = LABELS.replace("conduit: [Video], leak: none", "leak: [Video]")
    (folder / "leak.yaml").write_text(labels)
    result = rosprivacy.analyze("keystore", "leak.yaml")
    assert [(f.kind, f.dismissed) for f in result.analysis.findings] == [("disclosure", False), (KIND, False)]
    finding = rosprivacy.analyze("keystore", "labels.yaml").analysis.findings[0]
    (folder / "d.yaml").write_text(
        f"decisions: 1\nfindings:\n  - {{id: {finding.id}, decision: accept, owner: A. Person, reason: own wire,\n"
        "     legal_basis: ['6(1)(f)']}\n"
    )
    decided = rosprivacy.analyze("keystore", "labels.yaml", decisions="d.yaml")
    assert [f.accepted for f in decided.analysis.findings] == [True]
    assert decided.analysis.verdict == "no-leak-found"


def test_mitigate_names_the_line_and_with_it_changed_the_finding_is_gone(cli: Cli, tmp_path: Path) -> None:
    keystore = deployed(tmp_path, SIGNED, topic_rule(), unauthenticated="true")
    done = cli("mitigate", keystore, "-l", tmp_path / "labels.yaml", "--format", "json")
    [proposal] = json.loads(done.stdout)["proposals"]
    assert (done.returncode, proposal["steps"], proposal["keeps"]) == (0, [], [])
    assert proposal["proven"]
    assert proposal["verdict_then"] == "no-leak-found"
    assert [(row["cause"], [c["name"] for c in row["channels"]]) for row in proposal["protect"]] == [
        ("strangers", ["/video"]),
        ("not-encrypted", ["/video"]),
    ]
    lines = (keystore / "enclaves/governance.p7s").read_text().splitlines()
    assert [lines[row["line"] - 1][:13] for row in proposal["protect"]] == ["<dds><domain_", "<topic_access"]
    text = cli("mitigate", keystore, "-l", tmp_path / "labels.yaml").stdout
    assert "Change the governance, and sign it anew: that ends 1 finding" in text
    Keystore(keystore).governance(governance())
    assert rosprivacy.analyze(keystore, tmp_path / "labels.yaml").analysis.verdict == "no-leak-found"


@pytest.mark.usefixtures("folder")
def test_a_line_that_has_moved_is_no_difference() -> None:
    before = rosprivacy.analyze("keystore", "labels.yaml").document()
    now = json.loads(json.dumps(before))
    now["findings"][0]["because"]["values"]["line"] = "99"
    now["findings"][0]["reason"] = "nothing encrypts what is sent there, by keystore/enclaves/governance.p7s:99"
    assert changes(before, now).nothing
    now["findings"][0]["because"]["key"] = "strangers"
    assert set(changes(before, now).changed.values()) == {("reason",)}


def test_reports_name_the_governance_and_redacted_ones_no_file(cli: Cli, folder: Path, tmp_path: Path) -> None:
    asked = ("report", "keystore", "-l", "labels.yaml", "--format", "markdown")
    plain, hidden = tmp_path / "p.md", tmp_path / "h.md"
    cli(*asked, "-o", plain, cwd=folder)
    cli(*asked, "--redact", "-o", hidden, cwd=folder)
    assert "governance.p7s" in plain.read_text()
    assert "governance.p7s" not in hidden.read_text()


@pytest.mark.slow
@pytest.mark.database
@pytest.mark.usefixtures("folder")
def test_the_database_gives_the_same(neo4j_server: Connection) -> None:
    result = rosprivacy.analyze("keystore", "labels.yaml")
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load(driver, [robot_of("robot", result)], result.vocabulary)
        stored = answer_stored(driver, Settings())
        [[of]] = driver.execute_query("MATCH (c:Topic {name: '/video'}) RETURN c.unprotected").records
        driver.execute_query("MATCH (n) DETACH DELETE n")
    assert told(stored) == told(result)
    assert [text.partition(": ")[0] for text in of] == ["not-encrypted"]


def test_the_kinds_of_findings_are_one_list() -> None:
    """Who reads the contract, the ontology and the shapes reads the same kinds."""
    schema = json.loads((ROOT / "docs/analysis.schema.json").read_text("utf-8"))
    kinds = schema["$defs"]["FindingEntry"]["properties"]["kind"]["enum"]
    assert KIND in kinds
    for file in ("ontology/elements.ttl", "report/rdf/findings.shapes.ttl", "report/sarif/rules.py"):
        assert all(f'"{kind}"' in (ROOT / file).read_text("utf-8") for kind in kinds)


def test_many_that_one_line_stands_behind_are_one_line_of_the_list(cli: Cli, tmp_path: Path) -> None:
    kinds = ["Video", "Voice", "Location"]
    made = Keystore(tmp_path / "keystore")
    made.enclave("/camera", permissions(grant("/camera", rule("allow", publish=("rt/a", "rt/b", "rt/c")))))
    made.governance(governance(topic_rule(metadata="NONE", data="NONE")))
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes: {{/camera: {{source: [{', '.join(kinds)}]}}}}\n")
    done = cli("analyze", "keystore", "-l", "l.yaml", cwd=tmp_path)
    [line] = [line for line in done.stdout.splitlines() if "can be read on the network: " in line]
    assert line.startswith("  1. can be read on the network: Video, Voice, Location, 9 findings, 3 channels; nothing")
    assert (
        len(json.loads(cli("analyze", "keystore", "-l", "l.yaml", "-f", "json", cwd=tmp_path).stdout)["findings"]) == 9
    )
