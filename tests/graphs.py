"""What tests of the database share: an example as rows, and the whole graph as a value that can be compared."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.ingest.rows import robot_rows

if TYPE_CHECKING:
    from neo4j import Driver

    from rosprivacy.assembly import Result
    from rosprivacy.ingest.rows import RobotRows

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
FACTORY, CARE = EXAMPLES / "factory", EXAMPLES / "care-home"


def factory(run: int) -> Result:
    """One of the paper's five runs."""
    policy = "before" if run < 4 else "after"
    return rosprivacy.analyze([str(FACTORY / f"{policy}.policy.xml")], [str(FACTORY / f"run{run}.labels.yaml")])


def care_home() -> Result:
    return rosprivacy.analyze([str(CARE / "care-home.policy.xml")], [str(CARE / "care-home.labels.yaml")])


def rows_of(robot: str, result: Result) -> RobotRows:
    return robot_rows(robot, result.analysis, result.bound, result.vocabulary)


def dump(driver: Driver, *, without: tuple[str, ...] = ()) -> tuple[set[str], list[str]]:
    """Nodes and relationships as text; ``without`` some properties."""
    nodes: dict[str, str] = {}
    for record in driver.execute_query(
        "MATCH (n) RETURN elementId(n) AS key, labels(n) AS l, properties(n) AS p"
    ).records:
        nodes[record["key"]] = text(sorted(record["l"]), record["p"], without)
    query = "MATCH (a)-[r]->(b) RETURN elementId(a) AS a, elementId(b) AS b, type(r) AS t, properties(r) AS p"
    relationships = [
        f"{nodes[r['a']]} -{text(r['t'], r['p'], without)}-> {nodes[r['b']]}"
        for r in driver.execute_query(query).records
    ]
    assert len(set(nodes.values())) == len(nodes)
    return set(nodes.values()), sorted(relationships)


def text(kind: Any, properties: dict[str, Any], without: tuple[str, ...]) -> str:
    return json.dumps([kind, {key: value for key, value in sorted(properties.items()) if key not in without}])
