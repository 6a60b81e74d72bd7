"""A query reads the graph and nothing else, on our server and on one with the settings that Neo4j comes with.

``LOAD CSV`` reads files and addresses, procedures and admin commands act on the server: the access mode of a
transaction stops none of these, so the server's own plan is asked before a query is run.
"""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING, NamedTuple

import pytest

from rosprivacy.analysis.errors import QueryError
from rosprivacy.private_neo4j import connection
from rosprivacy.queries import run as running
from rosprivacy.queries.library import find, pack
from rosprivacy.queries.run import run
from tests.helpers.command import run as program

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Done

pytestmark = pytest.mark.database
TEXT = "only the owner reads this"
# The planner leaves a subquery in an expression that may not be evaluated where it is: it is no step of the plan.
HIDDEN = "RETURN CASE WHEN rand() < 2 THEN {0} END AS x"
WHERE_EXPRESSIONS_STAND = (
    HIDDEN,
    "WITH 1 AS a WHERE a = CASE WHEN rand() < 2 THEN size({0}) END RETURN a",
    "UNWIND [2, 1] AS a RETURN a ORDER BY CASE WHEN rand() < 2 THEN {0} END",
    "UNWIND [2, 1] AS a RETURN a, count(CASE WHEN rand() < 2 THEN {0} END) AS c",
    "UNWIND CASE WHEN rand() < 2 THEN {0} END AS a RETURN a",
    "RETURN [z IN [1] | CASE WHEN rand() < 2 THEN {0} END] AS x",
    "RETURN reduce(a = [], z IN [1] | a + CASE WHEN rand() < 2 THEN {0} END) AS x",
    "RETURN 1 AS x UNION RETURN CASE WHEN rand() < 2 THEN {0} END AS x",
    "MATCH (n:DataCategory {{name: CASE WHEN rand() < 2 THEN {0}[0] END}}) RETURN n",
    "MATCH (n) WHERE elementId(n) IN CASE WHEN rand() < 2 THEN {0} END RETURN n",
    "MATCH (n) RETURN n {{.*, x: CASE WHEN rand() < 2 THEN {0} END}} AS x",
    "MATCH (n) RETURN n[CASE WHEN rand() < 2 THEN {0}[0] END] AS x",
    "MATCH (n)-[r*1..3]->(m) WHERE all(q IN r WHERE q.w IN CASE WHEN rand() < 2 THEN {0} END) RETURN m",
    "MATCH p = ANY SHORTEST (a:Robot)((b)-[f WHERE f.w IN CASE WHEN rand() < 2 THEN {0} END]->())+(d:Finding) RETURN p",
    (
        "MATCH (a:Robot), (b:Finding) MATCH p = shortestPath((a)-[r*..5]->(b)) "
        "WHERE all(q IN r WHERE q.w IN CASE WHEN rand() < 2 THEN {0} END) RETURN p"
    ),
    "MATCH (n) RETURN [(n)-->(m) | CASE WHEN rand() < 2 THEN {0} END] AS x",
    "MATCH (n:$(CASE WHEN rand() < 2 THEN {0}[0] ELSE 'X' END)) RETURN n",
    "SHOW PROCEDURES YIELD name WHERE name IN CASE WHEN rand() < 2 THEN {0} END RETURN name",
    "RETURN CASE WHEN rand() < 2 THEN COLLECT {{ UNWIND CASE WHEN rand() < 2 THEN {0} END AS y RETURN y }} END AS x",
    "RETURN CASE WHEN rand() < 2 THEN COLLECT {{ RETURN 1 AS x UNION RETURN size({0}) AS x }} END AS x",
)
ACTS = (
    ("CALL db.clearQueryCaches()", "calls db.clearQueryCaches"),
    ("CALL `db`.`clearQueryCaches`() YIELD value AS x RETURN x", "calls db.clearQueryCaches"),
    ("CALL dbms.killConnections(['bolt-0'])", "calls dbms.killConnections"),
    ("CALL dbms.killConnection('bolt-0')", "calls dbms.killConnection"),
    ("CALL dbms.listConfig() YIELD name RETURN name", "calls dbms.listConfig"),
    ("CALL dbms.queryJmx('*:*') YIELD name RETURN name", "calls dbms.queryJmx"),
    ("CALL tx.setMetaData({a: 1})", "calls tx.setMetaData"),
    ("CALL db.stats.stop('QUERIES')", "calls db.stats.stop"),
    ("CALL db.labels() YIELD label CALL dbms.killConnection(label) YIELD message RETURN message", "calls dbms.kill"),
    (HIDDEN.format("COLLECT { CALL db.clearQueryCaches() YIELD value RETURN value }"), "calls a procedure inside"),
    (
        HIDDEN.format("COLLECT { CALL (*) { CALL db.clearQueryCaches() YIELD value RETURN value AS y } RETURN y }"),
        "calls a",
    ),
    ("TERMINATE TRANSACTION 'neo4j-transaction-1'", "has the step TerminateTransactions"),
    ("SHOW TRANSACTIONS YIELD transactionId AS t TERMINATE TRANSACTION t YIELD message RETURN message", "Transactions"),
    ("SHOW SETTINGS", "has the step ShowSettings"),
    ("SHOW USERS", "has the step AdministrationCommand"),
    ("CREATE USER eve SET PASSWORD 'abcdefgh'", "has the step AdministrationCommand"),
    ("ALTER CURRENT USER SET PASSWORD FROM 'a' TO 'abcdefgh'", "has the step AdministrationCommand"),
    ("EXPLAIN CALL db.clearQueryCaches()", "calls db.clearQueryCaches"),
    ("PROFILE CALL db.clearQueryCaches()", "the server refuses the query"),
    ("CREATE (n:ShouldNotBe)", "would write"),
    ("MERGE (n:ShouldNotBe) RETURN n", "would write"),
    ("MATCH (n) SET n.x = 1", "would write"),
    ("MATCH (n) DETACH DELETE n", "would write"),
    ("CALL db.createLabel('ShouldNotBe')", "would write"),
    ("UNWIND [1] AS x CALL (x) { CREATE (:ShouldNotBe) } RETURN x", "would write"),
    ("MATCH (n) CALL (n) { CREATE (:ShouldNotBe) } IN TRANSACTIONS", "would write"),
    ("CREATE INDEX i FOR (n:X) ON (n.y)", "would write"),
    ("DROP INDEX i IF EXISTS", "would write"),
    ("CREATE CONSTRAINT c IF NOT EXISTS FOR (n:X) REQUIRE n.y IS UNIQUE", "would write"),
)


class Opened(NamedTuple):
    to: Connection
    driver: Driver


@pytest.fixture(scope="module", params=["ours", pytest.param("plain", marks=pytest.mark.slow)])
def opened(request: pytest.FixtureRequest) -> Iterator[Opened]:
    to = request.getfixturevalue("neo4j_server" if request.param == "ours" else "plain_neo4j")
    with connection.open_driver(to) as driver:
        yield Opened(to, driver)


@pytest.fixture(scope="module")
def driver(opened: Opened) -> Driver:
    return opened.driver


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    """Whoever connects is seen: a connection waits to be accepted, though nobody answers it."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(0.5)
        yield listening


def loads(url: str, way: str) -> str:
    return f"COLLECT {{ LOAD CSV {way} '{url}' AS line RETURN line[0] }}"


def ask(to: Connection, *arguments: str | Path) -> Done:
    """What the command says that asks this server."""
    return program(
        "query", *arguments, "--neo4j", to.uri, seconds=300, NEO4J_USERNAME=to.username, NEO4J_PASSWORD=to.password
    )


def refusal(driver: Driver, text: str) -> str:
    with pytest.raises(QueryError) as caught:
        run(driver, text)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    return message


@pytest.mark.parametrize(
    "pattern",
    [WHERE_EXPRESSIONS_STAND[0], *(pytest.param(p, marks=pytest.mark.slow) for p in WHERE_EXPRESSIONS_STAND[1:])],
)
def test_a_file_is_not_read_wherever_it_is_asked_for(driver: Driver, tmp_path: Path, pattern: str) -> None:
    file = tmp_path / "secret.csv"
    file.write_text(f"{TEXT}\n", "utf-8")
    message = refusal(driver, pattern.format(loads(file.as_uri(), "FROM")))
    assert "reads a file or an address (LOAD CSV)" in message
    assert TEXT not in message


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        "LOAD CSV FROM $url AS line RETURN line",
        "LOAD CSV WITH HEADERS FROM $url AS line RETURN line",
        "CALL () { LOAD CSV FROM $url AS line RETURN line } RETURN line",
        "/* a comment */ lOaD /* one more */ csv FROM $url AS line RETURN line",
        "CYPHER 5 LOAD CSV FROM $url AS line RETURN line",
    ],
)
def test_no_address_is_asked(driver: Driver, listener: socket.socket, text: str) -> None:
    with pytest.raises(QueryError, match=r"reads a file or an address \(LOAD CSV\)"):
        run(driver, text, {"url": f"http://127.0.0.1:{listener.getsockname()[1]}/x.csv"})
    with pytest.raises(TimeoutError):
        listener.accept()


@pytest.mark.slow
def test_what_acts_on_the_server_is_refused_and_not_done_on_the_way(driver: Driver) -> None:
    """No node, no user, no transaction ended, no index: to ask for the plan does nothing."""
    for text, why in ACTS:
        assert why in refusal(driver, text), text
    assert run(driver, "MATCH (n:ShouldNotBe) RETURN count(n)").rows == ((0,),)
    users = [record["user"] for record in driver.execute_query("SHOW USERS", database_="system").records]
    assert users == ["neo4j"]
    names = [record["labelsOrTypes"] for record in driver.execute_query("SHOW INDEXES").records]
    assert ["X"] not in names


@pytest.mark.parametrize(
    "text",
    [
        "CALL db.labels() YIELD label RETURN label",
        "CALL dbms.components() YIELD name RETURN name",
        "CALL db.schema.visualization()",
        "SHOW INDEXES YIELD name RETURN name",
        "RETURN 'LOAD CSV FROM' AS x // LOAD CSV",
        "WITH 'CALL dbms.killConnections()' AS x WHERE x CONTAINS 'TERMINATE TRANSACTION' OR true RETURN x",
        "MATCH (n) WITH n LIMIT 1 RETURN CASE WHEN rand() < 2 THEN COLLECT { CALL (n) { RETURN 1 AS x } RETURN x } END",
        "RETURN date.truncate('day', date('2026-01-02')) AS day, point.distance(point({x: 1, y: 1}), null) AS far",
    ],
)
def test_what_reads_the_graph_is_answered(driver: Driver, text: str) -> None:
    assert run(driver, text).columns


@pytest.mark.slow  # on ours test_queries asks them all, and reads the rows
@pytest.mark.parametrize("name", pack())
def test_every_question_of_the_pack_is_answered(driver: Driver, name: str) -> None:
    query = find(name)
    values = query.values({field.name: "x" for field in query.parameters if field.default is None})
    assert run(driver, query.text, values).columns == tuple(field.name for field in query.columns)


@pytest.mark.slow
def test_the_command_reads_no_file(opened: Opened, tmp_path: Path) -> None:
    (tmp_path / "secret.csv").write_text(TEXT, "utf-8")
    (tmp_path / "steal.cypher").write_text(
        f"LOAD CSV FROM '{(tmp_path / 'secret.csv').as_uri()}' AS l RETURN l", "utf-8"
    )
    done = ask(opened.to, "--file", tmp_path / "steal.cypher")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert "reads a file or an address (LOAD CSV)" in done.stderr


@pytest.mark.slow
def test_an_answer_that_is_too_large_for_the_server_is_one_line_and_it_runs_on(opened: Opened) -> None:
    done = ask(opened.to, "--cypher", "RETURN range(1, 100000000) AS x")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert "needs more memory than the server gives" in done.stderr or "broke off, and runs" in done.stderr
    assert run(opened.driver, "RETURN 1").rows == ((1,),)


@pytest.mark.slow
def test_rows_have_a_bound_in_size(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "UNWIND range(1, 900) AS x RETURN [y IN range(1, 100) | 'ten bytes.'] AS y, {k: x} AS z"
    monkeypatch.setattr(running, "LARGEST", 2**20)
    assert len(run(driver, text).rows) == 900  # 900 * (1000 + 9) bytes
    monkeypatch.setattr(running, "LARGEST", 900_000)
    assert "the rows take more than" in refusal(driver, text)


def test_lists_that_are_too_deep_are_one_line(driver: Driver) -> None:
    assert "too deep to be read" in refusal(driver, "RETURN reduce(a = [], x IN range(1, 3000) | [a]) AS x")
