"""``absent: why``: a profile that is not on the robot; nothing is said to be cleaned there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.ingest.neo4j_graph.loading import load as load_robots
from rosprivacy.mitigation import run_mitigation
from rosprivacy.private_neo4j import connection
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from rosprivacy.result import Result

PROFILE = '<profile ns="/" node="{}"><topics {}="ALLOW"><topic>{}</topic></topics></profile>'
POLICY = '<policy version="0.2.0"><enclaves><enclave path="/"><profiles>{}</profiles></enclave></enclaves></policy>'
PROFILES = [
    ("camera", "publish", "image"), ("shell", "subscribe", "image"), ("shell", "publish", "copy"),
    ("uplink", "subscribe", "copy"),
]  # fmt: skip
ENDS = "nodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n"


def analyze(folder: Path, labels: str, *more: tuple[str, str, str], **options: str) -> Result:
    (folder / "p.xml").write_text(POLICY.format("".join(PROFILE.format(*profile) for profile in (*PROFILES, *more))))
    (folder / "l.yaml").write_text(f"labels: 1\n{labels}")
    return rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml"), **options)  # type: ignore[arg-type]


def test_nothing_goes_through_what_is_absent_and_every_report_says_so(tmp_path: Path) -> None:
    assert len(analyze(tmp_path, ENDS).findings) == 1
    result = analyze(tmp_path, f"{ENDS}  /shell: {{absent: a debug tool}}\n")
    document = result.document()
    assert document["findings"] == []
    assert [q["element"]["name"] for q in document["open"]] == ["/image"]
    assert document["sanitizers"] == []  # it cleans nothing
    assert not [row for row in document["roles"] if row["element"]["name"] == "/shell"]
    assert [(row["element"]["name"], row["why"]) for row in document["assumptions"]["absent"]] == [
        ("/shell", "a debug tool")
    ]
    (row,) = [row for row in document["taken_away"] if row["element"]["name"] == "/shell"]
    assert (row["by"], row["leak"]["name"]) == ("absent", "/uplink")  # who says so is in the ledger
    assert "   /shell is not on the robot: a debug tool" in result.to("text")
    assert "/shell has a profile and is not on the robot: a debug tool" in result.to("markdown")


def test_a_glob_takes_no_leak_away_that_a_name_states(tmp_path: Path) -> None:
    """S7: the name outranks the glob, so the node is there and lets data out."""
    result = analyze(tmp_path, f'{ENDS}  "/u*": {{absent: old tools}}\n')
    assert [finding.leak.name for finding in result.analysis.findings] == ["/uplink"]
    assert result.document()["verdict"] == "leak"


def test_a_leak_that_a_name_takes_away_is_told(tmp_path: Path) -> None:
    labels = 'nodes:\n  /camera: {source: [Video]}\n  "/u*": {leak: [Video]}\n  /uplink: {absent: sold}\n'
    result = analyze(tmp_path, labels)
    assert result.document()["findings"] == []
    (row,) = result.document()["assumptions"]["overruled"]
    assert (row["elements"], row["role"], row["by"]["says"]) == (["/uplink"], "leak", "absent")


def test_nobody_is_told_that_data_gets_to_what_is_absent(tmp_path: Path) -> None:
    """docs/labels.md: nothing gets to it, so it is in no inventory, and no proposal takes anything from it."""
    labels = (
        f"{ENDS}  /shell: {{absent: a debug tool}}\n  /screen: {{leak: [Video]}}\nchannels: {{/image: sensitive}}\n"
    )
    result = analyze(tmp_path, labels, ("screen", "subscribe", "image"))
    document = result.document()
    assert "/shell" not in {row["element"]["name"] for row in document["carries"]}
    assert "/shell" in {element["name"] for element in document["unreached"]}
    (proposal,) = run_mitigation(result).document()["proposals"]
    assert [step["spares"] for step in proposal["steps"]] == [[]]
    assert "/shell" not in {less["element"]["name"] for less in proposal["affected"]}


def test_what_is_absent_brings_nothing_in(tmp_path: Path) -> None:
    result = analyze(tmp_path, 'nodes:\n  "/c*": {source: [Video]}\n  /camera: {absent: sold}\n')
    assert result.analysis.carried == ()
    assert "/camera: absent takes away the source of Video" in str([d.message for d in result.analysis.diagnostics])


def test_a_channel_that_only_an_absent_node_reads_can_wait(tmp_path: Path) -> None:
    (question,) = analyze(tmp_path, f"{ENDS}  /shell: {{absent: a debug tool}}\n").document()["open"]
    assert question["waits"]
    text = analyze(tmp_path, f"{ENDS}  /shell: {{absent: a debug tool}}\n").to("text")
    assert "1 can wait: from there data gets to no leak and no node that is not reviewed" in text


@pytest.mark.parametrize("others", [(), (("screen", "subscribe", "image"),)])
def test_a_wildcard_that_only_an_absent_node_reads_asks_nothing(
    tmp_path: Path, others: tuple[tuple[str, str, str], ...]
) -> None:
    """S7: the whole node is taken away, with what was granted to it alone."""
    labels = f'{ENDS}  /spy: {{absent: a debug tool}}\nchannels: {{"/image": sensitive}}\n'
    spy = ("spy", "subscribe", "/i*")
    asked = {q.element.name for q in analyze(tmp_path, labels, spy, *others).analysis.open}
    assert "/i*" not in asked
    assert asked == {
        q.element.name for q in analyze(tmp_path, labels, ("spy", "subscribe", "other"), *others).analysis.open
    }
    there = analyze(tmp_path, labels, spy, ("screen", "subscribe", "/i*"))
    assert "/i*" in {q.element.name for q in there.analysis.open}


@pytest.mark.database
def test_a_database_keeps_who_is_absent_and_why(tmp_path: Path, neo4j_server: Connection) -> None:
    result = analyze(tmp_path, f"{ENDS}  /shell: {{absent: a debug tool}}\n")
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load_robots(driver, [robot_of("care", result)], result.vocabulary)
        stored = answer_stored(driver, Settings()).document()
        cleans = "MATCH (e) WHERE any(label IN labels(e) WHERE label ENDS WITH 'Sanitizer') RETURN e"
        cleaning = driver.execute_query(cleans).records
        driver.execute_query("MATCH (n) DETACH DELETE n")
    (row,) = stored["assumptions"]["absent"]
    assert (row["element"]["name"], row["why"]) == ("/shell", "a debug tool")
    assert (stored["findings"], stored["sanitizers"], cleaning) == ([], [], [])
