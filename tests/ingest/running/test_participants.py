"""Endpoints of no node are elements outside ROS, named by participant, whatever a system is read from (S9, S16)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ingest.running.observed_files import policy_xml, prepared, types_yaml
from rosprivacy.private_neo4j import connection
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.observed import endpoint, saw
from tests.helpers.written_systems import told

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli

NAME = "participant_010f"
SAID = f'<participant node="/_no_node/{NAME}"/>'
SOURCE = "labels: 1\nnodes: {/cam: {source: [Video]}}\nchannels: {/image: sensitive, /shape: mundane}\n"
LEAK = SOURCE + f"elements: {{{NAME}: {{kind: participant, leak: [Video]}}}}\n"
CLOUD = SOURCE + f"elements: {{{NAME}: {{kind: external-system, country: DE}}}}\n"
FLEET = "fleet: 1\nrobots: {robot: {policies: p.xml, labels: l.yaml}}\n"
DOMAIN = "fleet: 1\nrobots:\n  r1: {policies: p.xml, labels: l.yaml, domain: 3}\n  r2: {policies: p.xml, domain: 3}\n"


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A node that publishes, and a program of another kind that reads and writes."""
    ready = prepared(
        saw(
            endpoint("/cam", "publish", "/image", "sensor_msgs/msg/Image"),
            endpoint("", "subscribe", "/image", "sensor_msgs/msg/Image", key="a", participant="010f"),
            endpoint("", "publish", "/shape", "std_msgs/msg/Bool", key="b", participant="010f"),
            door="dds",
        )
    )
    (tmp_path / "p.xml").write_bytes(policy_xml(ready))
    (tmp_path / "t.yaml").write_text(types_yaml(ready.observation))
    (tmp_path / "f.yaml").write_text(FLEET)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def analysed(robot: Path, labels: str, **options: Any) -> dict[str, Any]:
    (robot / "l.yaml").write_text(labels)
    return rosprivacy.analyze("p.xml", "l.yaml", **options).document()


def open_elements(document: dict[str, Any]) -> list[tuple[str, str]]:
    return [(question["element"]["kind"], question["element"]["name"]) for question in document["open"]]


def test_something_without_a_node_reads_the_camera(robot: Path) -> None:
    """It is to be reviewed, no node and in no enclave, and the gap stays."""
    document = analysed(robot, SOURCE)
    assert document["verdict"] == "undetermined"
    assert open_elements(document) == [("participant", NAME)]
    (row,) = document["outside"]
    assert (row["element"]["name"], row["file"], row["holds"]) == (NAME, "p.xml", ["Video"])
    assert row["line"] > 0
    assert [enclave["nodes"] for enclave in document["enclaves"]] == [["/cam"]]
    assert "observation-gap" in {said.get("code") for said in document["diagnostics"]}
    assert not document["unknown_ends"] or {end["element"]["kind"] for end in document["unknown_ends"]} == {"topic"}


def test_it_takes_labels_under_elements(robot: Path) -> None:
    (finding,) = analysed(robot, LEAK)["findings"]
    assert [element["name"] for element in finding["witness"]] == ["/cam", "/image", NAME]
    assert [line["profile"] for step in finding["steps"] for line in step["policy"]] == ["/cam", f"/_no_node/{NAME}"]
    (finding,) = analysed(robot, LEAK, view="enforced")["findings"]
    assert finding["leak"]["name"] == NAME


def test_a_person_says_of_what_kind_it_is(robot: Path) -> None:
    document = analysed(robot, CLOUD)
    (finding,) = document["findings"]
    assert (finding["leak"]["kind"], finding["leak"]["name"]) == ("external-system", NAME)
    assert [row["element"]["kind"] for row in document["outside"]] == ["external-system"]


def test_reviewed_it_leaves_the_gap(robot: Path) -> None:
    """S16: undetermined at best."""
    document = analysed(robot, SOURCE + f"elements: {{{NAME}: {{kind: participant, conduit: [Video]}}}}\n")
    assert (document["verdict"], document["findings"], document["open"]) == ("undetermined", [], [])


def test_its_types_are_known(robot: Path) -> None:
    """S15: who writes /shape is known, so what a Bool cannot carry stops there."""
    document = analysed(robot, SOURCE.replace(", /shape: mundane", ""), types="t.yaml")
    (row,) = document["assumptions"]["type_limits_reached"]
    assert (row["element"]["name"], row["categories"]) == ("/shape", ["Video"])
    assert not [said for said in document["diagnostics"] if said.get("code") == "types-of-nothing"]


@pytest.mark.parametrize("labels", [SOURCE, LEAK, CLOUD], ids=["not labelled", "a leak", "another kind"])
def test_a_saved_graph_and_a_fleet_say_the_same(cli: Cli, robot: Path, labels: str) -> None:
    (robot / "l.yaml").write_text(labels)
    expected = told(rosprivacy.analyze("p.xml", "l.yaml"))
    assert cli("analyze", "p.xml", "--save-graph", "g.json", cwd=robot).returncode == 4
    assert told(rosprivacy.analyze(labels="l.yaml", add="g.json")) == expected
    assert told(rosprivacy.analyze_fleet("f.yaml")) == expected


@pytest.mark.parametrize("labels", [SOURCE, CLOUD], ids=["not labelled", "another kind"])
def test_robots_of_one_domain_have_their_own(robot: Path, labels: str) -> None:
    """One of them says what its participant is; that is not said of the other's."""
    (robot / "l.yaml").write_text(labels)
    (robot / "f.yaml").write_text(DOMAIN)
    document = rosprivacy.analyze_fleet("f.yaml").document()
    kind = "participant" if labels == SOURCE else "external-system"
    outside = {(row["element"]["robot"], row["element"]["kind"], row["element"]["name"]) for row in document["outside"]}
    assert outside == {("r1", kind, NAME), ("r2", "participant", NAME)}
    reached = {row["element"]["robot"] for row in document["outside"] if row["holds"]}
    assert reached == {"r1", "r2"}


@pytest.mark.database
def test_the_database_says_the_same(robot: Path, neo4j_server: Connection) -> None:
    (robot / "l.yaml").write_text(LEAK)
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        everything = rosprivacy.analyze("p.xml", "l.yaml")
        load(driver, [robot_of("robot", everything)], everything.vocabulary)
        stored = answer_stored(driver, Settings())
        found = driver.execute_query(
            "MATCH (c:RosNode)-[:FLOWS_TO]->(:Topic)-[:FLOWS_TO]->(p:Participant:Video) RETURN c.name AS c, p.name AS p"
        )
        members = driver.execute_query("MATCH (p:Participant)-[:IN_ENCLAVE]->() RETURN p")
        driver.execute_query("MATCH (n) DETACH DELETE n")
    assert [(row["c"], row["p"]) for row in found.records] == [("/cam", NAME)]
    assert not members.records
    assert told(stored) == told(everything)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("analyze p.xml -l l.yaml -f turtle: Participant", 4),
        (f"graph p.xml -l l.yaml -f dot: {NAME}", 0),
        ("report p.xml -l l.yaml -f markdown: program without a ROS node", 0),
        (f"labels --init p.xml: {NAME}: {{kind: participant}}  # writes /shape; reads /image", 0),
        (f"labels --next p.xml -l l.yaml: elements: {{{NAME}: {{kind: external-system}}}}", 0),
    ],
)
def test_every_output_shows_it_as_what_it_is(cli: Cli, robot: Path, words: str, code: int) -> None:
    (robot / "l.yaml").write_text(SOURCE)
    asked, said = words.split(": ", 1)
    done = cli(*asked.split(), cwd=robot)
    answer = done.stdout + done.stderr
    assert (done.returncode, said in answer) == (code, True), answer
    assert NAME in answer.replace("\\", "")
    assert asked[0] not in "gl" or "/_no_node" not in answer


@pytest.mark.parametrize(
    "node", ["/cam", "/_no_node/cam", "/_no_node/participant_a/b", "/_no_node/participant_a:b", ""]
)
def test_metadata_that_call_a_node_a_participant_are_not_believed(robot: Path, node: str) -> None:
    """What looks like ours and cannot be read is a gap (S16); the node stays one."""
    text = (robot / "p.xml").read_text()
    (robot / "p.xml").write_text(
        text.replace(f'<participant node="/_no_node/{NAME}"/>', f'<participant node="{node}"/>')
    )
    document = analysed(robot, SOURCE)
    assert document["outside"] == []
    assert ("node", f"/_no_node/{NAME}") in open_elements(document)
    assert any("names no participant" in said["message"] for said in document["diagnostics"])


def test_a_policy_of_an_earlier_version_has_nodes(robot: Path) -> None:
    text = (robot / "p.xml").read_text()
    (robot / "p.xml").write_text(text.replace(SAID, ""))
    assert open_elements(analysed(robot, SOURCE)) == [("node", f"/_no_node/{NAME}")]
