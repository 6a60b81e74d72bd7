"""What the enforced view adds, in Neo4j: there to be asked, and nothing else says anything else (rule S6)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.both_views import both_views_of_fleet
from rosprivacy.queries.library import pack
from rosprivacy.settings import Settings
from tests.helpers.command import cli
from tests.helpers.shared_enclaves import EXAMPLE, EXAMPLE_LABELS, FLEET, THREE, apart, policy

if TYPE_CHECKING:
    from neo4j import Driver

    from tests.helpers.command import Cli

__all__ = ["cli"]
pytestmark = pytest.mark.database

LOAD = ("load", "p.xml", "-l", "l.yaml", "--robot", "r1")
LEFT = """
MATCH (n) WHERE NOT n:AddedFinding AND NOT n:Load
OPTIONAL MATCH (n)-[r]->(m) WHERE NOT type(r) IN ['COULD_FLOW_TO', 'MADE_POSSIBLE_BY', 'ENDED_BY_SPLITTING']
RETURN properties(n) AS node, labels(n) AS labels, type(r) AS type, properties(r) AS properties, m.id AS other
"""
NOT_ALIKE = dict.fromkeys(("beyond", "digest", "version"))


@pytest.fixture
def driver(driver: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Driver:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy(THREE))
    Path("l.yaml").write_text(EXAMPLE_LABELS)
    return driver


def rows(driver: Driver, cypher: str) -> list[list[Any]]:
    return [list(record.values()) for record in driver.execute_query(cypher)[0]]


@pytest.mark.slow
def test_plain_data_is_added_beside_the_finding_that_has_it_pseudonymised(cli: Cli, driver: Driver) -> None:
    """Both have one id; each keeps its own ends (S6, S10)."""
    Path("l.yaml").write_text(EXAMPLE_LABELS.replace("anonymise", "pseudonymise"))
    assert cli(*LOAD, "--view", "both").returncode == 0
    found = """MATCH (a)<-[:FROM]-(f:Finding)-[:TO]->(b), (x)<-[:FROM]-(g:AddedFinding)-[:TO]->(y)
        RETURN f.id = g.id, f.pseudonymised, g.pseudonymised, g.plain, a = x, b = y, g.split"""
    assert rows(driver, found) == [[True, True, False, True, True, True, ["/robot"]]]
    ends = "MATCH (:Finding)-[r:FROM|TO|OF_CATEGORY]->() RETURN type(r), count(*) ORDER BY type(r)"
    assert rows(driver, ends) == [["FROM", 1], ["OF_CATEGORY", 1], ["TO", 1]]
    assert cli(*LOAD).returncode == 0
    assert rows(driver, "MATCH (f:Finding) OPTIONAL MATCH (g:AddedFinding) RETURN count(f), count(g)") == [[1, 0]]


@pytest.mark.slow
def test_a_finding_has_its_enclave_and_its_steps_and_goes_when_it_is_loaded_otherwise(cli: Cli, driver: Driver) -> None:
    assert cli(*LOAD, "--view", "both").returncode == 0
    found = """MATCH (f:AddedFinding {view: 'enforced'})-[:MADE_POSSIBLE_BY]->(e:Enclave)<-[:ENDED_BY_SPLITTING]-(f)
        MATCH (a)<-[:FROM]-(f)-[:TO]->(b) MATCH (f)-[:OF_CATEGORY]->(c)
        MATCH (x)-[s:COULD_FLOW_TO]->(y)
        RETURN a.name, b.name, c.name, e.path, x.name, s.role, y.name, s.profile, s.enclave"""
    step = ["/camera", "publish", "/blurred", "/blur", "/robot"]
    assert rows(driver, found) == [["/camera", "/uplink", "Video", "/robot", *step]]
    assert rows(driver, "MATCH (r:Robot) RETURN r.beyond, r.verdict, r.view") == [[1, "no-leak-found", "declared"]]
    assert rows(driver, "MATCH (f:Finding) RETURN f") == []
    assert "is there already" in cli(*LOAD, "--view", "both").stdout
    for again in (LOAD, ("unload", "--robot", "r1")):
        cli(*LOAD, "--view", "both")
        assert cli(*again).returncode == 0
        assert rows(driver, "MATCH (f:AddedFinding) RETURN f") == []
        assert rows(driver, "MATCH ()-[c:COULD_FLOW_TO]->() RETURN c") == []
        assert rows(driver, "MATCH (r:Robot) WHERE r.beyond IS NOT NULL RETURN r") == []


@pytest.mark.slow
def test_all_else_in_the_database_and_every_answer_from_it_stay_as_they_were(cli: Cli, driver: Driver) -> None:
    asked = ("analyze", "--from-database", "-f", "json")
    queries = [name for name, query in pack().items() if name not in ("beyond-profiles", "loads") and not any(
        field.default is None for field in query.parameters)]  # fmt: skip
    told = []
    for more in ((), ("--view", "both")):
        driver.execute_query("MATCH (n) DETACH DELETE n")
        assert cli(*LOAD, *more).returncode == 0
        answers = [cli("query", name, "--format", "json").stdout for name in queries]
        left = [[{**node, **NOT_ALIKE}, *more] for node, *more in rows(driver, LEFT)]
        told.append((sorted(json.dumps(row, sort_keys=True) for row in left), cli(*asked).stdout, answers))
    assert told[0] == told[1]
    assert json.loads(told[0][1])["verdict"] == "no-leak-found"
    assert cli(*asked, "--view", "both").returncode == 2


def test_an_answer_from_the_database_keeps_it_until_somebody_has_changed_what_was_loaded(
    cli: Cli, driver: Driver
) -> None:
    cli(*LOAD, "--view", "both")
    added = "MATCH (f:AddedFinding)-[:FROM]->({name: '/camera'}) RETURN f.leak"
    assert cli("analyze", "--from-database").returncode == 0
    assert rows(driver, added) == [["/uplink"]]
    driver.execute_query("MATCH (b {name: '/blur'})-[s:SANITIZES]->() DELETE s")
    assert cli("analyze", "--from-database").returncode == 1
    assert rows(driver, added) == []
    assert rows(driver, "MATCH (r:Robot) RETURN r.beyond") == [[None]]  # not known any more


@pytest.mark.slow
def test_the_query_says_of_which_robots_it_is_not_known(cli: Cli, driver: Driver) -> None:
    del driver
    cli(*LOAD, "--view", "both")
    cli("load", "p.xml", "-l", "l.yaml", "--robot", "r2")
    found = json.loads(cli("query", "beyond-profiles", "--format", "json").stdout)
    assert [(row["robot"], row["asked"], row["leak"]) for row in found] == [
        ("r1", True, "/uplink"), ("r2", False, None),
    ]  # fmt: skip


@pytest.mark.slow
def test_each_robot_of_a_fleet_has_what_is_added_there(cli: Cli, driver: Driver) -> None:
    Path("apart.xml").write_text(policy(apart(EXAMPLE, ["/robot"])))
    open_camera = [*EXAMPLE["/robot"]["/camera"], ("publish", "/blurred", "ALLOW")]
    Path("open.xml").write_text(policy({**EXAMPLE, "/robot": {**EXAMPLE["/robot"], "/camera": open_camera}}))
    Path("f.yaml").write_text(FLEET)
    assert cli("load", "--fleet", "f.yaml", "--view", "both").returncode == 0
    [entry] = both_views_of_fleet("f.yaml", Settings()).document()["enforced"]["added"]
    found = """MATCH (f:AddedFinding)-[:MADE_POSSIBLE_BY]->(e:Enclave {robot: f.robot})
        MATCH (f)-[:FROM]->(a {robot: f.robot})-[:COULD_FLOW_TO {robot: f.robot}]->(b {robot: f.robot})
        RETURN f.robot, e.path, a.name, b.name ORDER BY f.robot"""
    assert rows(driver, found) == [[robot, "/robot", "/camera", "/blurred"] for robot in entry["robots"]]
    counts = dict(rows(driver, "MATCH (r:Robot) WHERE coalesce(r.shared, false) = false RETURN r.name, r.beyond"))
    assert counts == {robot: int(robot in entry["robots"]) for robot in ("apart", "carrier_1", "carrier_2", "open")}
