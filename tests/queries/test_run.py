"""Cypher that only reads: the server refuses the rest; rows and time have bounds; values come back as JSON has them."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import DatabaseError, QueryError
from rosprivacy.private_neo4j import connection
from rosprivacy.queries import run as running
from rosprivacy.queries.graph_values import Relationship, plain, value_of
from rosprivacy.queries.run import ALIKE, DEEPEST, OPERATORS, run

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import Driver

    from rosprivacy.private_neo4j.connection import Connection

pytestmark = pytest.mark.database


@pytest.fixture(scope="module")
def driver(neo4j_server: Connection) -> Iterator[Driver]:
    with connection.open_driver(neo4j_server) as opened:
        yield opened


def test_rows_have_a_bound(driver: Driver) -> None:
    text = "UNWIND range(1, 5) AS x RETURN x"
    assert (run(driver, text, limit=3).rows, run(driver, text, limit=3).truncated) == (((1,), (2,), (3,)), True)
    assert (len(run(driver, text, limit=5).rows), run(driver, text, limit=5).truncated) == (5, False)
    assert len(run(driver, text, limit=None).rows) == 5


def test_time_has_a_bound(driver: Driver) -> None:
    with pytest.raises(QueryError, match=r"took longer than 0\.2 s; .*--timeout"):
        run(driver, "UNWIND range(1, 1000000000) AS x WITH x WHERE x < 0 RETURN x", timeout=0.2)


@pytest.mark.parametrize("text", ["WHAT IS THIS", "RETURN $missing", "RETURN 1/0", "RETURN x"])
def test_what_the_server_cannot_do_is_one_line(driver: Driver, text: str) -> None:
    with pytest.raises(QueryError, match="the server refuses the query: ") as caught:
        run(driver, text)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("value", [2**63, "\udcff"])
def test_what_cannot_be_sent_is_one_line(driver: Driver, value: object) -> None:
    with pytest.raises(QueryError, match="cannot be sent"):
        run(driver, "RETURN $x", {"x": value})


def test_values_are_those_of_json(driver: Driver) -> None:
    rows = run(
        driver, "RETURN 1 AS a, 1.5 AS b, true AS c, null AS d, 'x' AS e, [1, {k: 'v'}] AS f, date('2026-01-02')"
    )
    assert rows.rows == ((1, 1.5, True, None, "x", [1, {"k": "v"}], "2026-01-02"),)


@pytest.mark.parametrize("pair", ["()", "[]", "{}"])
def test_brackets_that_the_server_would_not_survive_are_refused_before_it_gets_them(driver: Driver, pair: str) -> None:
    def nested(depth: int) -> str:
        return f"RETURN {pair[0] * depth}1{pair[1] * depth} AS x"

    with pytest.raises(QueryError, match="brackets within brackets, more than 150 deep; ask for less"):
        run(driver, nested(DEEPEST + 1))
    if pair != "{}":
        assert run(driver, nested(DEEPEST)).columns == ("x",)


@pytest.mark.parametrize(
    ("text", "most"),
    [
        ("RETURN {}true AS x", ("NOT ", ALIKE)),
        ("RETURN 1{} AS x", (" + 1", ALIKE)),
        ("RETURN {{a: 1}}{} AS x", (".a", ALIKE)),
        ("RETURN 1{} AS x", (" + 1 - 1", OPERATORS // 2)),
        ("RETURN {}1{} AS x", ("CASE WHEN true THEN ", DEEPEST)),
    ],
)
def test_operators_that_the_server_would_not_survive_are_refused_before_it_gets_them(
    driver: Driver, text: str, most: tuple[str, int]
) -> None:
    part, count = most
    ends = [" END" * (count * 4)] if "CASE" in part else []
    begun = time.monotonic()
    with pytest.raises(QueryError, match=r"(in a row|within brackets)"):
        run(driver, text.format(part * (count * 4), *ends))
    assert time.monotonic() - begun < 10


@pytest.mark.slow
def test_many_values_and_alternatives_are_no_row_of_operators(driver: Driver) -> None:
    values = ", ".join(["1 + 1"] * OPERATORS)
    assert run(driver, f"WITH [{values}] AS many, '{'+' * OPERATORS}' AS x RETURN size(many)").rows == ((OPERATORS,),)


@pytest.mark.slow
def test_a_server_that_plans_on_and_on_is_not_waited_for(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server's own bound holds while it runs a query. Of this one its stack overflows, and it says nothing."""
    monkeypatch.setattr(running, "refuse_too_much", lambda _: None)
    monkeypatch.setattr(running, "GRACE", 1.0)
    begun = time.monotonic()
    with pytest.raises(QueryError, match="has not answered within 3 s: it may still be planning the query"):
        run(driver, "RETURN " + "NOT " * 5000 + "true", timeout=2)
    assert time.monotonic() - begun < 30
    assert run(driver, "RETURN 1").rows == ((1,),)


@pytest.mark.slow
def test_an_answer_that_nobody_waits_for_asks_the_server_nothing_more(
    neo4j_server: Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A connection that is opened while the driver is closed would stay open."""
    monkeypatch.setattr(running, "refuse_too_much", lambda _: None)
    monkeypatch.setattr(running, "GRACE", 1.0)
    others, asked = {*threading.enumerate()}, []
    with connection.open_driver(neo4j_server) as closed:
        monkeypatch.setattr(closed, "verify_connectivity", lambda: asked.append(threading.current_thread().name))
        with pytest.raises(QueryError, match="has not answered within 2 s"):
            run(closed, "RETURN " + "NOT " * 5000 + "true", timeout=1)
        left = {*threading.enumerate()} - others
    assert left
    for thread in left:
        thread.join(timeout=60)
        assert not thread.is_alive()
    assert not asked


def test_nodes_relationships_and_paths(driver: Driver) -> None:
    with driver.session() as session, session.begin_transaction() as transaction:  # never committed
        transaction.run("CREATE (:Shown:Here {name: 'a'})-[:TO {n: 1}]->(:Shown {name: 'b'})")
        found = transaction.run("MATCH p = (:Here)-[r:TO]->(n:Shown) RETURN p, r, n").single(strict=True)
        start, flow, end = (
            {"labels": ["Here", "Shown"], "name": "a"},
            {"type": "TO", "n": 1},
            {"labels": ["Shown"], "name": "b"},
        )
        assert [plain(value_of(value)) for value in found] == [[start, flow, end], flow, end]


def test_a_relationship_alone_has_its_ends(driver: Driver) -> None:
    """The server names them by their ids only; they are looked up."""
    driver.execute_query("MERGE (:ShownEnd {name: 'a'})-[:TO]->(:ShownEnd {name: 'b'})")
    try:
        ((one, several),) = run(driver, "MATCH (:ShownEnd)-[r:TO]->() RETURN r, [{r: r}]").rows
        assert isinstance(one, Relationship)
        assert (one.start.properties, one.end.labels) == ({"name": "a"}, ("ShownEnd",))
        assert several == [{"r": one}]
    finally:
        driver.execute_query("MATCH (n:ShownEnd) DETACH DELETE n")


@pytest.mark.database
def test_every_session_is_of_the_database_that_is_named(neo4j_server: Connection) -> None:
    with connection.open_driver(replace(neo4j_server, database="neo4j")) as driver, driver.session() as session:
        assert session.run("CALL db.info() YIELD name").single(strict=True)["name"] == "neo4j"
    with (
        pytest.raises(DatabaseError) as error,
        connection.open_driver(replace(neo4j_server, database="nosuch")),
    ):
        pytest.fail("there is none")
    assert str(error.value).endswith(": it has no database nosuch; check NEO4J_DATABASE")
