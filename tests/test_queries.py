"""Every query of the pack runs, on nothing and on two robots, and gives the columns that its header names, in order."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy import database
from rosprivacy.analysis.errors import QueryError
from rosprivacy.ingest.neo4j import load
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.queries.library import Query, find, pack, parse
from rosprivacy.queries.run import run
from tests.graphs import care_home, factory, rows_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import Driver

    from rosprivacy.database import Connection

EXAMPLES = {
    "category": "Video", "source": "/camera", "leak": "/uplink", "first": "Video", "second": "Location",
    "from": "/camera", "to": "/recorder", "element": "/blur",
}  # fmt: skip
GOOD = """\
// name: x
// kind: table
// description: What is there?
// param robot: string, a name
// returns name: string, its name
// order: name
MATCH (n:Element {robot: $robot})
RETURN n.name AS name
ORDER BY name
"""


@pytest.fixture(scope="module")
def driver(neo4j_server: Connection) -> Iterator[Driver]:
    with database.open_driver(neo4j_server) as driver:
        yield driver


def values(query: Query) -> dict[str, object]:
    given = {p.name: EXAMPLES[p.name] for p in query.parameters if p.default is None}
    return query.values(given)


def test_there_are_at_least_twenty() -> None:
    assert len(pack()) >= 20


@pytest.mark.database
class TestPack:
    def test_on_an_empty_database(self, driver: Driver) -> None:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        for query in pack().values():
            rows = run(driver, query.text, values(query))
            assert rows.columns == tuple(column.name for column in query.columns), query.name

    def test_on_two_robots(self, driver: Driver) -> None:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load(driver, [rows_of("care", care_home()), rows_of("factory", factory(2))], load_vocabulary())
        types = {"string": str, "integer": int, "boolean": bool, "list of string": list}
        some = 0
        for query in pack().values():
            rows = run(driver, query.text, values(query))
            some += bool(rows.rows)
            for row in rows.rows:
                for column, value in zip(query.columns, row, strict=True):
                    assert value is None or type(value) is types[column.type], (query.name, column.name, value)
        assert some >= 20

    def test_findings_under_article_9(self, driver: Driver) -> None:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load(driver, [rows_of("care", care_home()), rows_of("factory", factory(2))], load_vocabulary())
        rows = run(driver, find("findings-under-article").text, {**values(find("findings-under-article"))}).rows
        assert len(rows) == 1
        assert {"care", "FaceTemplate", "conditional"} <= {str(value) for value in rows[0]}

    @pytest.mark.parametrize(
        "text",
        [
            "CREATE (n:X) RETURN n",
            "MATCH (n) SET n.x = 1",
            "MERGE (n:X) RETURN n",
            "MATCH (n) DETACH DELETE n",
            "CREATE INDEX i FOR (n:X) ON (n.y)",
        ],
    )
    def test_what_writes_is_refused(self, driver: Driver, text: str) -> None:
        with pytest.raises(QueryError, match=r"the query would write|refuses"):
            run(driver, text)

    def test_a_bound_on_rows_and_on_time(self, driver: Driver) -> None:
        rows = run(driver, "UNWIND range(1, 10) AS x RETURN x", limit=3)
        assert (rows.rows, rows.more) == (((1,), (2,), (3,)), True)
        with pytest.raises(QueryError, match=r"took longer than 0\.2 s"):
            run(driver, "UNWIND range(1, 1000000000) AS x WITH x WHERE x < 0 RETURN x", timeout=0.2)

    def test_what_is_no_cypher(self, driver: Driver) -> None:
        with pytest.raises(QueryError, match="the server refuses the query"):
            run(driver, "WHAT IS THIS")


class TestHeader:
    def test_a_good_one(self) -> None:
        assert parse("x", GOOD).values({"robot": "r"}) == {"robot": "r"}

    @pytest.mark.parametrize(
        ("old", "new", "message"),
        [
            ("name: x", "name: y", "name is 'y'"),
            ("kind: table", "kind: chart", "kind is 'chart'"),
            ("// order: name\n", "", "order is missing"),
            ("// kind: table\n", "// kind: table\n// kind: table\n", "stands twice"),
            ("// param robot: string, a name\n", "", "not declared"),
            ("$robot", "'r'", "not used"),
            ("n.name AS name", "n.name AS other", "RETURN gives"),
            ("ORDER BY name", "LIMIT 3", "stable order"),
            ("RETURN n.name", "SET n.x = 1 RETURN n.name", "SET writes"),
            ("returns name: string,", "returns name: text,", "the type is one of"),
            ("// order", "// odd", "no line of a header"),
        ],
    )
    def test_each_fault_is_found(self, old: str, new: str, message: str) -> None:
        assert old in GOOD
        with pytest.raises(QueryError, match=message):
            parse("x", GOOD.replace(old, new))

    def test_parameters(self) -> None:
        query = parse("x", GOOD)
        with pytest.raises(QueryError, match="robot is missing"):
            query.values({})
        with pytest.raises(QueryError, match="did you mean 'robot'"):
            query.values({"robt": "r"})
        with pytest.raises(QueryError, match="there is no such query; did you mean"):
            find("leak-path")
