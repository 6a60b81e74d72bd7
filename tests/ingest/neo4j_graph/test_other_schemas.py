"""Whin an earlier version wrote into a database is answered with 'load it again' (DESIGN.md, Contracts)."""

from __future__ import annotations

import hashlib
import json
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ingest.neo4j_graph.read_back import read_stored
from rosprivacy.ingest.neo4j_graph.robot_facts import of_other_schemas
from rosprivacy.ingest.neo4j_graph.schema import SCHEMA
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from tests.helpers.command import Cli, refused
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from neo4j import Driver


pytestmark = pytest.mark.slow  # each loads a database of its own

VOCABULARY = load_vocabulary()
HOME = ROOT / "examples" / "care-home"
LOAD = ("load", HOME / "care-home.policy.xml", "--labels", HOME / "care-home.labels.yaml", "--robot", "care")
HINT = "load it again from its files, with rosprivacy load"
BESIDE = ("robot", "properties", "foreign", "beyond")  # the rest are rows of its own; beyond only where it is asked for
AS_EARLIER = "MATCH (r:Robot {name: 'care'}) REMOVE r.schema"  # the first versions wrote none
EVERYTHING = "MATCH (n) OPTIONAL MATCH (n)-[r]->() RETURN count(DISTINCT n), count(r), sum(size(keys(n)))"


@pytest.fixture
def driver(driver: Driver) -> Driver:
    """Of a database with two robots, of which the first is as an earlier version left it."""
    load(driver, [rows_of(name, care_home()) for name in ("care", "home")], VOCABULARY)
    driver.execute_query(AS_EARLIER)
    return driver


def rows(driver: Driver, query: str) -> list[list[Any]]:
    return [list(record) for record in driver.execute_query(query).records]


@pytest.mark.database
class TestOfADatabase:
    @pytest.mark.parametrize("command", ["analyze", "report"])
    def test_it_is_refused_and_nothing_is_written(self, cli: Cli, driver: Driver, command: str) -> None:
        before = rows(driver, EVERYTHING)
        (line,) = refused(cli(command, "--from-database"))
        assert line == f"the database: robot care was loaded by an earlier version; {HINT}"
        assert rows(driver, EVERYTHING) == before

    def test_another_version_is_refused_too(self, driver: Driver) -> None:
        for schema, which in ((SCHEMA - 1, "an earlier"), (SCHEMA + 1, "another")):
            driver.execute_query("MATCH (r:Robot {name: 'care'}) SET r.schema = $schema", schema=schema)
            with pytest.raises(InputErrors) as told:
                read_stored(driver, VOCABULARY)
            assert str(told.value) == f"the database: robot care was loaded by {which} version; {HINT}"

    @pytest.mark.parametrize("question", [("findings",), ("--cypher", "MATCH (f:Finding) RETURN f.id")])
    def test_a_question_is_answered_with_a_warning(self, cli: Cli, driver: Driver, question: tuple[str, ...]) -> None:
        done = cli("query", *question, "-f", "csv")
        assert (done.returncode, len(done.stdout.splitlines())) == (0, 7)  # two robots with three findings each
        why = "warning: robot care was loaded by an earlier version, so rows can be missing or differ"
        assert done.stderr == f"{why}; {HINT}\n"
        driver.execute_query("MATCH (r:Robot {name: 'care'}) SET r.schema = $schema", schema=SCHEMA)
        assert cli("query", *question, "-f", "csv").stderr == ""

    def test_loaded_again_it_is_analysed(self, cli: Cli, driver: Driver) -> None:
        assert "robot care is written" in cli(*LOAD).stdout
        assert rows(driver, "MATCH (r:Robot) RETURN DISTINCT r.schema") == [[SCHEMA]]
        done = cli("analyze", "--from-database", "-q")
        assert (done.returncode, done.stderr) == (1, "")

    def test_a_robot_that_people_made_by_hand_was_never_loaded(self, driver: Driver) -> None:
        driver.execute_query("MATCH (r:Robot {name: 'care'}) SET r.schema = $schema", schema=SCHEMA)
        driver.execute_query("CREATE (:Robot {name: 'mine'})")
        assert set(read_stored(driver, VOCABULARY).robots) == {"care", "home", "mine"}


def test_a_load_takes_no_robot_of_another_schema_as_unchanged() -> None:
    """Else 'load it again' would change nothing: the digest of the first versions was made without the schema."""
    rows = rows_of("care", care_home())
    known = {key: value for key, value in rows.properties.items() if key != "digest"}
    parts = {field.name: getattr(rows, field.name) for field in fields(rows) if field.name not in BESIDE}
    assert digest("care", known, parts) == rows.digest
    del known["schema"]
    assert digest("care", known, parts) != rows.digest


def digest(*what: Any) -> str:
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()


def test_many_robots_are_one_line() -> None:
    robots = [{"name": f"r{number}", "version": 1} for number in range(9)]
    assert of_other_schemas(robots) == "robots r0, r1, r2, r3, r4 and 4 more were loaded by an earlier version"
