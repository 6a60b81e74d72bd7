"""The fleet in Neo4j: loading it against bare writes, asking it against the query that comes to mind first.

    python benchmarks/graph_database.py [--quick]

Starts a private Neo4j in a folder of its own and ends with 1 if a bound is missed. ``--quick`` takes 100 robots in
place of 1,000. (Not named ``ingest/database/loading.py``: as a script it would hide the driver of that name.)
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from dataclasses import replace
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import neo4j
from measure import Line, compared, print_header, print_line
from neo4j_fleet import NAMES, ROBOTS, VOCABULARY, fleet

from rosprivacy.ingest.database.cypher import CREATE_CARRIES, create_relationships
from rosprivacy.ingest.database.loading import BATCH, load
from rosprivacy.ingest.database.schema import ACROSS, DERIVES_FROM, FLOWS_TO, IN_ENCLAVE, ROLES
from rosprivacy.private_neo4j import connection
from rosprivacy.queries.library import pack

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from neo4j import Driver

    from rosprivacy.ingest.database.rows import RobotRows

ROUNDS = 2
FEW = 100
ASKED = NAMES[::8]  # kinds of data whose leak paths are asked for
PATIENCE = 300.0  # seconds for the naive query
SLOWEST_LEAK_PATHS, SLOWEST = 2.0, 5.0  # seconds of server time
WIPE = "MATCH (n) CALL (n) { DETACH DELETE n } IN TRANSACTIONS OF 2000 ROWS"
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


def writing(driver: Driver, robots: int) -> Iterator[Line]:
    """Load, bare writes of the same rows, and a load that finds nothing to change."""
    rows = list(fleet(robots))
    load(driver, rows[:20], VOCABULARY)  # warms the server up
    sides: list[list[float]] = [[], []]
    again: list[float] = []
    making: list[float] = []
    for number in range(ROUNDS):
        for side in (1 - number % 2, number % 2):
            wipe(driver)
            sides[side].append(timed((lambda: load(driver, rows, VOCABULARY), lambda: bare(driver, rows))[side]))
            if side == 0:
                making.append(timed(lambda: list(fleet(robots))))
                again.append(timed(lambda: load(driver, rows, VOCABULARY)))
    wipe(driver)
    load(driver, rows, VOCABULARY)
    count = sum(len(r.elements) for r in rows), sum(len(r.flows) for r in rows), sum(len(r.findings) for r in rows)
    note = "{:,} elements, {:,} flows, {:,} findings".format(*count)
    yield compared(f"load {robots:,} robots / bare UNWIND … CREATE", sides, 1.5, note=note)
    yield compared("load them again unchanged / first load", [again, sides[0]], 1 / 3)
    both = [[a + b for a, b in zip(part, making, strict=True)] for part in (again, sides[0])]
    yield compared("the same with the analysis and the making of the rows on both sides", both)


def wipe(driver: Driver) -> None:
    with driver.session() as session:
        session.run(WIPE).consume()


def asking(driver: Driver) -> Iterator[Line]:
    """Leak paths of a kind, as stored and as walked anew, against the query of one line; then each question alone."""
    stored, walked = pack()["leak-paths"], pack()["leak-paths-of-category"]
    seconds: list[list[float]] = [[], [], []]
    for kind in ASKED:
        for number, query in enumerate((stored, walked)):
            values = query.values({"category": kind})
            seconds[number].append(min(served(driver, query.text, values) for _ in range(2)))
        seconds[2].append(served(driver, NAIVE.format(kind), {}))
    naive = "MATCH …-[:FLOWS_TO*1..8]->…"
    note = "the naive ways have at most 8 flows, and go through sanitizers and along what does not carry the kind"
    yield compared(f"leak-paths of a kind / {naive}", [seconds[0], seconds[2]], 1 / 20, note=note)
    yield compared(f"leak-paths-of-category / {naive}", [seconds[1], seconds[2]])
    yield within("the slowest of leak-paths-of-category", max(seconds[1]), SLOWEST_LEAK_PATHS)
    shortest = [served(driver, SHORTEST.format(ASKED[0]), {})]
    yield compared("leak-paths-of-category / shortestPath(…)", [seconds[1][:1], shortest])
    for name, query in pack().items():
        given = {field.name: ASKED_FOR[field.name] for field in query.parameters if field.default is None}
        values = query.values(given)
        served(driver, query.text, values)
        yield within(f"query {name}", served(driver, query.text, values), SLOWEST)


def within(what: str, seconds: float, bound: float) -> Line:
    """Return the line for seconds of server time; the ratio is to the seconds that it may take."""
    return replace(Line(what, f"{seconds * 1000:.0f} ms", f"{bound:.0f} s", seconds / bound), bound=1.0)


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


def main() -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(description="Measured claims about the database, as ratios.")
    parser.add_argument("--quick", action="store_true", help=f"{FEW} robots")
    robots = FEW if parser.parse_args().quick else ROBOTS
    for name in ("NEO4J_URI", "NEO4J_USERNAME", "NEO4J_PASSWORD"):
        os.environ.pop(name, None)
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.environ["ROSPRIVACY_DATA"] = folder
        try:
            with connection.open_driver(connection.start()) as driver:
                print_header()
                met = [print_line(line).met for part in (writing(driver, robots), asking(driver)) for line in part]
        finally:
            connection.stop()
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())
