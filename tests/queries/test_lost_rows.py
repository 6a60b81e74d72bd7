"""What a question must not lose: what may fall under an article, a slip of a person, rows that are cut (S11, S12).

What ends at a robot or at infrastructure, and what may be of a kind, is held by ``test_pack_on_fleets.py``.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors, QueryError
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.queries.library import find
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored, rows_of
from tests.helpers.daily import one_in
from tests.helpers.fleet_files import policy
from tests.helpers.fleet_rows import VOCABULARY

if TYPE_CHECKING:
    from pathlib import Path

    from neo4j import Driver

    from tests.helpers.command import Cli

pytestmark = pytest.mark.database


@pytest.fixture
def driver(driver: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Driver:
    monkeypatch.chdir(tmp_path)
    return driver


def write(folder: Path, **files: str) -> None:
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text, "utf-8")


def load_robot(driver: Driver, folder: Path, labels: str, text: str = "") -> None:
    write(folder, p_xml=text or policy("/camera>/video", "/uplink</video"), l_yaml=labels)
    load(driver, [robot_of("x", rosprivacy.analyze("p.xml", "l.yaml"))], VOCABULARY)


def ask(driver: Driver, name: str, **given: str) -> list[dict[str, Any]]:
    query = find(name)
    found = rows_of(driver, query.text, query.values(given), limit=None, timeout=None, query=query).rows
    return [dict(zip(found.columns, row, strict=True)) for row in found.rows]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("source", "may", "row"),
    [
        ("PersonalData", "true", ("PersonalData", "may-reveal", True)),
        ("PersonalData", "false", ("PersonalData", "may-reveal", True)),
        ("FaceTemplate", "false", ("FaceTemplate", "conditional", False)),
    ],
)
def test_data_of_a_broader_kind_may_fall_under_an_article(
    driver: Driver, tmp_path: Path, source: str, may: str, row: tuple[str, str, bool]
) -> None:
    """Rules S7 and S11."""
    nodes = f"{{/camera: {{source: [{source}]}}, /uplink: {{leak: [Biometric]}}}}"
    load_robot(driver, tmp_path, f"labels: 1\nnodes: {nodes}\n")
    (shown,) = ask(driver, "findings-under-article", article="9", may=may)
    assert (shown["category"], shown["verdict"], shown["may_be"]) == row


def test_what_carries_a_broader_kind_may_carry_two(driver: Driver, tmp_path: Path) -> None:
    """Rules S7 and S11."""
    load_robot(
        driver, tmp_path, "labels: 1\nnodes: {/camera: {source: [PersonalData]}, /uplink: {leak: [Biometric]}}\n"
    )
    shown = ask(driver, "carrying-both", first="Biometric", second="Location")
    assert [(row["element"], row["may_be"]) for row in shown] == [
        ("/camera", True), ("/uplink", True), ("/video", True),
    ]  # fmt: skip


CLEAN = (
    "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: none, conduit: [Video]}}\n"
    "channels: {/video: sensitive}\n"
)
THESE = "MATCH (n {name: '/uplink'}), (m {name: '/camera'}), (c:DataCategory {name: 'Video'}) "
MEANINGLESS = [  # what is written by hand, and what the error has to name
    ("MERGE (n)-[:LEAK]->(c)", "LEAK' .*did you mean LEAKS"),
    ("MERGE (n)-[:leaks]->(c)", "leaks' .*did you mean LEAKS"),
    ("MERGE (n)-[:FLOW_TO]->(m)", "FLOW_TO' .*did you mean FLOWS_TO"),
    ("MERGE (n)-[:FLOW_TO]->(:ExternalSystem {name: 'cloud'})", "FLOW_TO' .*did you mean FLOWS_TO"),
    ("MERGE (n)-[:SANITISES]->(c)", "SANITISES' .*did you mean SANITIZES"),
    ("MERGE (c)-[:LEAKS]->(n)", r"LEAKS' .*\(n\)-\[:LEAKS\]->\(:DataCategory"),
    ("MERGE (n)-[:LEAKS]->(m)", r"LEAKS' .*\(n\)-\[:LEAKS\]->\(:DataCategory"),
    ("SET n:VideoLeak", r"VideoLeak; write \(n\)-\[:LEAKS\]->\(:DataCategory {name: 'Video'}\)"),
    ("SET n:VideoLeaks", "VideoLeaks; did you mean VideoLeak"),
    ("SET m:VideoSanitizer", "VideoSanitizer; write .*SANITIZES"),
    ("SET n.leaks = ['Video']", "leaks, .*VideoLeak; write .*LEAKS"),
    ("SET m.begins = ['Voice']", "begins, .*VoiceSource; write .*SOURCE_OF"),
    ("REMOVE m:VideoSource", "begins, .*VideoSource"),
    ("CREATE (:Storage:Element:VideoLeak {name: 'disk'})", "'disk' .*VideoLeak"),
]


class TestByHand:
    @pytest.mark.parametrize(("edit", "message"), one_in(4, MEANINGLESS))
    def test_what_means_nothing_is_an_error(self, driver: Driver, tmp_path: Path, edit: str, message: str) -> None:
        load_robot(driver, tmp_path, CLEAN)
        driver.execute_query(THESE + edit)
        before = driver.execute_query("MATCH (n:Element) RETURN n.name, labels(n) ORDER BY n.name").records
        with pytest.raises(InputErrors, match=message):
            answer_stored(driver, Settings())
        assert driver.execute_query("MATCH (n:Element) RETURN n.name, labels(n) ORDER BY n.name").records == before

    def test_all_at_once(self, driver: Driver, tmp_path: Path) -> None:
        load_robot(driver, tmp_path, CLEAN)
        wrong = "MERGE (n)-[:LEAK]->(c) SET n:VideoLeak MERGE (n)-[:SANITIZES {method: 'x'}]->(c)"
        driver.execute_query(THESE + wrong)
        with pytest.raises(InputErrors) as error:
            answer_stored(driver, Settings())
        assert len(str(error.value).splitlines()) == 3

    def test_what_is_a_person_s_own_stays(self, driver: Driver, tmp_path: Path) -> None:
        """Labels, relationships and properties that are not near to ours; a role that is taken away, or a right one."""
        load_robot(driver, tmp_path, CLEAN.replace("leak: none, conduit: [Video]", "leak: [Video]"))
        own = "MERGE (n)-[:AT_SITE]->(:Site {name: 'hall'}) MERGE (n)-[:HAS_ROLE]->(m) SET n:Audited, n.owner = 'Ada'"
        driver.execute_query(f"{THESE} {own}")
        assert str(answer_stored(driver, Settings()).analysis.verdict) == "leak"
        driver.execute_query("MATCH (:RosNode {name: '/uplink'})-[l:LEAKS]->() DELETE l")
        assert not answer_stored(driver, Settings()).analysis.findings
        driver.execute_query(f"{THESE} MERGE (n)-[:LEAKS]->(c)")
        assert str(answer_stored(driver, Settings()).analysis.verdict) == "leak"
        assert driver.execute_query(
            "MATCH (:Audited:VideoLeak {owner: 'Ada'})-[:AT_SITE]->(s) RETURN s.name"
        ).records[0][0] == "hall"  # fmt: skip


@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("findings-by-data-type", {"type": "vidio"}, "no data type 'vidio' .*video"),
        ("findings-by-identity-factor", {"factor": "ecnomic"}, "no identity factor 'ecnomic' .*economic"),
        ("findings-under-article", {"article": "99"}, "no article '99' .*9"),
        ("findings-under-article", {"article": "nine"}, r"no article 'nine' .*9, 9\(1\)"),
    ],
)
def test_a_misspelt_parameter_is_no_answer(
    driver: Driver, tmp_path: Path, name: str, given: dict[str, str], message: str
) -> None:
    load_robot(driver, tmp_path, CLEAN)
    with pytest.raises(QueryError, match=message):
        ask(driver, name, **given)


def test_labels_of_leaks_stand_for_what_arrives_or_is_named(driver: Driver, tmp_path: Path) -> None:
    labels = (
        "labels: 1\nnodes: {/camera: {source: [FaceTemplate]}, /uplink: {leak: [Biometric, Video]}}\n"
        "elements: {screen: {kind: display}, wall: {kind: display}}\n"
        "flows: [{from: /uplink, to: screen}, {from: /gauge, to: wall}]\n"
    )
    load_robot(driver, tmp_path, labels, policy("/camera>/video", "/uplink</video", "/gauge>/video"))
    found = driver.execute_query(
        "MATCH (n:Element) WHERE n.name IN ['screen', 'wall', '/uplink'] "
        "RETURN n.name, [l IN labels(n) WHERE l ENDS WITH 'Leak'] AS leaks"
    ).records
    above = {name: {f"{up}Leak" for up in VOCABULARY.hierarchy.ancestors[name]} for name in VOCABULARY.categories}
    assert {name: {*leaks} for name, leaks in found} == {
        "screen": above["FaceTemplate"],
        "wall": set(),
        "/uplink": above["Video"] | above["FaceTemplate"],
    }


@pytest.mark.slow
@pytest.mark.usefixtures("driver")
def test_what_a_program_reads_is_whole_or_says_that_it_is_not(cli: Cli) -> None:
    many = "UNWIND range(1, 1500) AS i RETURN i"
    whole = cli("query", "--cypher", many, "-f", "json")
    assert (whole.returncode, len(json.loads(whole.stdout)), whole.stderr) == (0, 1500, "")
    for form, size in (("json", 2), ("csv", 3)):
        cut = cli("query", "--cypher", many, "-f", form, "--limit", "2")
        assert cut.returncode == 4
        assert (len(json.loads(cut.stdout)) if form == "json" else len(cut.stdout.splitlines())) == size
    assert cli("query", "--cypher", "RETURN 1 AS i", "-f", "csv", "--limit", "1").returncode == 0
    assert cli("query", "--cypher", many).returncode == 0  # a person sees the line below the table
