"""What tests share: examples analysed, once each; as rows; and a whole database as a value that can be compared."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from neo4j import Driver

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.result import Result

FACTORY, CARE = "examples/factory", "examples/care-home"


def factory(run: int) -> Result:
    """One of the paper's five runs."""
    policy = "before" if run < 4 else "after"
    return analysed(f"{FACTORY}/{policy}.policy.xml", f"{FACTORY}/run{run}.labels.yaml")


def care_home() -> Result:
    return analysed(f"{CARE}/care-home.policy.xml", f"{CARE}/care-home.labels.yaml")


@cache
def hospital() -> Result:
    """The fleet of the examples."""
    with chdir(ROOT):
        return answer_fleet("examples/fleet/fleet.yaml", Settings())


@cache
def analysed(policy: str, labels: str) -> Result:
    """Files are named as from the repository's folder, so that what is made of them is the same on every machine."""
    with chdir(ROOT):
        return rosprivacy.analyze([policy], [labels])


def rows_of(robot: str, result: Result) -> RobotRows:
    return robot_rows(robot, result.analysis, result.bound, result.vocabulary)


def dump(driver: Driver, *, without: tuple[str, ...] = ()) -> tuple[set[str], list[str]]:
    """Nodes and relationships as text, but for what loads are remembered by; ``without`` some properties."""
    nodes: dict[str, str] = {}
    for record in driver.execute_query(
        "MATCH (n) WHERE NOT n:Load AND NOT n:Change RETURN elementId(n) AS key, labels(n) AS l, properties(n) AS p"
    ).records:
        nodes[record["key"]] = text(sorted(record["l"]), record["p"], without)
    query = (
        "MATCH (a)-[r]->(b) WHERE NOT a:Load AND NOT a:Change "
        "RETURN elementId(a) AS a, elementId(b) AS b, type(r) AS t, properties(r) AS p"
    )
    relationships = [
        f"{nodes[r['a']]} -{text(r['t'], r['p'], without)}-> {nodes[r['b']]}"
        for r in driver.execute_query(query).records
    ]
    assert len(set(nodes.values())) == len(nodes)
    return set(nodes.values()), sorted(relationships)


def text(kind: Any, properties: dict[str, Any], without: tuple[str, ...]) -> str:
    return json.dumps([kind, {key: value for key, value in sorted(properties.items()) if key not in without}])
