"""Bags in Neo4j: rows as declared, twice changes nothing, links to the robot that was recorded, and out again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.bags import IMAGE, ODOMETRY, rosbag2
from tests.helpers.graphs import dump

if TYPE_CHECKING:
    from pathlib import Path

    from neo4j import Driver

    from tests.helpers.command import Cli

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="cam"><topics publish="ALLOW"><topic>camera</topic></topics>
  <actions execute="ALLOW"><action>spin</action></actions></profile>
</profiles></enclave></enclaves></policy>"""
TOPICS = {"/camera": (IMAGE, 5), "/spin/_action/feedback": (ODOMETRY, 1), "/new": (ODOMETRY, 2)}
LINKS = (
    "MATCH (b:Bag)-[:HAS_TOPIC]->(t)-[:RECORDS]->(e:Element) "
    "RETURN b.path + ' ' + t.name + ' ' + e.id AS link ORDER BY link"
)


@pytest.fixture
def there(tmp_path: Path) -> Path:
    (tmp_path / "r1.policy.xml").write_text(POLICY)
    (tmp_path / "l.yaml").write_text("labels: 1\nchannels: {/camera: {only: [Video]}}\n")
    rosbag2(tmp_path / "bags" / "1", topics=TOPICS)
    rosbag2(tmp_path / "bags" / "2", "sqlite3")
    return tmp_path


def column(driver: Driver, query: str) -> list[Any]:
    return [record[0] for record in driver.execute_query(query).records]


@pytest.mark.slow
@pytest.mark.database
def test_bags_are_rows_of_their_own_with_links_to_the_robot(cli: Cli, there: Path, driver: Driver) -> None:
    """What the document says stands there; a topic that the robot has is linked to it, also a part of an action."""
    assert cli("load", there / "r1.policy.xml", "-l", there / "l.yaml").returncode == 0
    before = dump(driver)
    done = cli("bag", "bags", "-l", "l.yaml", "--load", "--robot", "r1", cwd=there)
    assert done.returncode == 1
    assert done.stderr == "2 bags with 5 topics written into the database, 3 of them linked to channels of r1\n"
    assert column(driver, LINKS) == [
        "bags/1 /camera r1|topic|/camera",
        "bags/1 /spin/_action/feedback r1|action|/spin|response",
        "bags/2 /camera r1|topic|/camera",
    ]
    (bag,) = column(driver, "MATCH (b:Bag) WHERE b.path = 'bags/1' RETURN properties(b)")
    assert bag["id"] == str((there / "bags" / "1").resolve())
    assert (bag["verdict"], bag["kinds"], bag["messages"]) == ("personal-data", ["Video"], 8)
    assert bag["suggested"][-1] == "Video (likely)"
    assert bag["open_topics"] == ["/new", "/spin/_action/feedback"]
    assert (bag["start"], bag["robot"]) == (1_700_000_000 * 10**9, "r1")
    whole = dump(driver)
    assert cli("bag", "bags", "-l", "l.yaml", "--load", "--robot", "r1", cwd=there).returncode == 1
    assert dump(driver) == whole  # twice changes nothing
    assert whole != before
    gone = cli("unload", "--bag", "bags", cwd=there)
    assert gone.stdout == "".join(f"bag {(there / 'bags' / name).resolve()} is removed\n" for name in "12")
    assert dump(driver) == before


@pytest.mark.slow
@pytest.mark.database
def test_what_is_no_longer_in_a_bag_goes_and_what_others_loaded_stays(cli: Cli, there: Path, driver: Driver) -> None:
    assert cli("load", there / "r1.policy.xml", "-l", there / "l.yaml").returncode == 0
    for arguments in (("--robot", "r1"), ()):
        assert cli("bag", "bags", "--load", *arguments, cwd=there).returncode == 4
    assert column(driver, LINKS) == []  # of no robot any more
    metadata = there / "bags" / "1" / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace("/new", "/other"))
    assert cli("bag", "bags/1", "--load", cwd=there).returncode == 4
    named = "MATCH (b:Bag)-[:HAS_TOPIC]->(t) RETURN b.path + ' ' + t.name AS name ORDER BY name"
    names = column(driver, named)
    assert [name for name in names if name.startswith("bags/1 /other")]
    assert len([name for name in names if name.startswith("bags/2 ")]) == 2
    assert len(column(driver, "MATCH (t:RecordedTopic) RETURN t")) == len(names)
    analysed = cli("analyze", "--from-database", cwd=there)
    assert analysed.returncode in (0, 4)  # bags take part in no path


@pytest.mark.database
def test_a_robot_that_is_not_there_is_told(cli: Cli, there: Path, driver: Driver) -> None:
    done = cli("bag", "bags", "--load", "--robot", "r2", cwd=there)
    assert (done.returncode, column(driver, "MATCH (b:Bag) RETURN b")) == (2, [])
    assert "no robot r2 in the database; load it first" in done.stderr
    gone = cli("unload", "--bag", "nix", cwd=there)
    assert gone.returncode == 2
    assert "no bag nix in the database" in gone.stderr


def test_a_server_or_a_robot_without_load_is_refused(cli: Cli, there: Path) -> None:
    for option in ("--robot", "--neo4j"):
        done = cli("bag", "bags", option, "x", cwd=there)
        assert done.returncode == 2
        assert option in done.stderr
