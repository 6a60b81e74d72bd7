"""The same system, however it is read, gives the same findings, decisions, assumptions and verdict.

Fleets on Spark and in memory: ``tests/parts/test_spark.py``.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ingest.policies.saved_graph import as_dict
from rosprivacy.private_neo4j import connection
from rosprivacy.report.json_text import as_text
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.written_systems import Written, told, written

if TYPE_CHECKING:
    from rosprivacy.private_neo4j.connection import Connection
    from rosprivacy.result import Result

FLEET = "fleet: 1\nrobots: {robot: {policies: p.xml, labels: p.yaml}}\n"
DECISIONS = "decisions.yaml"


def first_way(system: Written) -> Result:
    """The files of one robot, in the folder of now."""
    system.write(Path(), "p")
    Path("f.yaml").write_text(FLEET, "utf-8")
    try:
        found = rosprivacy.analyze("p.xml", "p.yaml").analysis.findings
        Path(DECISIONS).write_text(system.decisions(found), "utf-8")
        return rosprivacy.analyze("p.xml", "p.yaml", decisions=DECISIONS)
    except rosprivacy.InputErrors:
        with pytest.raises(rosprivacy.InputErrors):
            rosprivacy.analyze_fleet("f.yaml")
        with pytest.raises(rosprivacy.InputErrors):
            saved_way("p.xml")
        assume(False)
        raise


def saved_way(policy: str) -> Result:
    """A graph that an earlier run has saved."""
    result = rosprivacy.analyze(policy)
    Path("g.json").write_text(as_text(as_dict(result.policies, result.diagnostics, result.types)), "utf-8")
    return rosprivacy.analyze(labels="p.yaml", add="g.json", decisions=DECISIONS)


def in_files_a_saved_graph_and_a_fleet(system: Written) -> None:
    with TemporaryDirectory() as folder, chdir(folder):
        expected = told(first_way(system))
        assert told(saved_way("p.xml")) == expected
        assert told(rosprivacy.analyze_fleet("f.yaml", decisions=DECISIONS)) == expected


@given(written())
@settings(max_examples=12, deadline=None)
def test_files_a_saved_graph_and_a_fleet_of_one(system: Written) -> None:
    in_files_a_saved_graph_and_a_fleet(system)


@pytest.mark.slow
@given(written())
@settings(max_examples=settings().max_examples * 3 // 4, deadline=None)
def test_more_of_them(system: Written) -> None:
    in_files_a_saved_graph_and_a_fleet(system)


@pytest.mark.slow
def test_most_of_them_have_a_finding_and_many_an_accepted_one() -> None:
    """Else the tests here would compare empty answers. Which examples come depends on what else is loaded."""
    results: list[Result] = []

    @settings(max_examples=80, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(written())
    def take(system: Written) -> None:
        with TemporaryDirectory() as folder, chdir(folder):
            results.append(first_way(system))

    take()
    findings = [[f for f in result.analysis.findings if not f.dismissed] for result in results]
    assert sum(map(bool, findings)) > len(results) / 6
    assert sum(any(f.accepted for f in some) for some in findings) > len(results) / 50
    changed = [change.aspect for r in results if r.decided for some in r.decided.changed.values() for change in some]
    assert set(changed) == {"view", "path", "disjoint_paths"}


@pytest.mark.slow
@pytest.mark.database
@given(system=written())
@settings(max_examples=5, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_files_and_the_database(neo4j_server: Connection, system: Written) -> None:
    with TemporaryDirectory() as folder, chdir(folder), connection.open_driver(neo4j_server) as driver:
        expected = first_way(system)
        driver.execute_query("MATCH (n) DETACH DELETE n")
        everything = rosprivacy.analyze("p.xml", "p.yaml")
        load(driver, [robot_of("robot", everything)], everything.vocabulary)
        stored = answer_stored(driver, Settings(decisions=DECISIONS))
        driver.execute_query("MATCH (n) DETACH DELETE n")
        assert told(stored) == told(expected)
