"""Where data goes, in three models: nothing of it, one type of relationship per kind, one ``CARRIES {kinds}`` for all.

Each model in a private Neo4j of its own: time of the load, size on disk, pairs of source and leak of some kinds,
asked as people ask first. ``docs/performance.md`` has the figures.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial
from statistics import median
from typing import TYPE_CHECKING

from graph_database import ASKED, private_server, served, timed
from measure import Measured, NotMeasured, Row
from neo4j_fleet import ROBOTS, VOCABULARY, fleet

from rosprivacy.ingest.neo4j_graph import cypher
from rosprivacy.ingest.neo4j_graph.ids import carries
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

BY_TYPE = cypher.CREATE_CARRIES
BY_LIST = BY_TYPE.replace(
    "UNWIND row.types AS type CREATE (a)-[:$(type)]->(b)", "CREATE (a)-[:CARRIES {kinds: row.types}]->(b)"
)
NAIVE = "MATCH (s:{0}Source)-[:{1}*1..]->(l:{0}Leak) RETURN DISTINCT s.id, l.id"
LISTED = "MATCH (s:{0}Source)(()-[c:CARRIES WHERE '{1}' IN c.kinds]->())+(l:{0}Leak) RETURN DISTINCT s.id, l.id"
SHORTEST = "MATCH (s:{0}Source) CALL (s) {{ MATCH p = ANY SHORTEST (s)-[:{1}]->+(l:{0}Leak) RETURN p }} RETURN p"
LISTED_SHORTEST = (
    "MATCH (s:{0}Source) CALL (s) {{ "
    "MATCH p = ANY SHORTEST (s)(()-[c:CARRIES WHERE '{1}' IN c.kinds]->())+(l:{0}Leak) RETURN p }} RETURN p"
)
MODELS = {
    "nothing": (BY_TYPE, ()),
    "a type per kind": (BY_TYPE, (NAIVE, SHORTEST)),
    "CARRIES {kinds}": (BY_LIST, (LISTED, LISTED_SHORTEST)),
}


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: each model in a server of its own.

    Raises
    ------
    NotMeasured
        In the quick form.
    """
    if quick:
        raise NotMeasured("servers and minutes; in the full form only")
    written = list(fleet(ROBOTS))
    ends = sum(len(one.carried) for one in written)
    kinds = sum(len(row["types"]) for one in written for row in one.carried)
    note = f"{len(written):,} robots; data goes between {ends:,} pairs of ends, {kinds:,} times of one kind"
    model = cache(lambda name: measured(written, name))

    def ratio(ours: str, other: str, place: int, unit: str) -> Measured:
        a, b = model(ours)[place], model(other)[place]
        return Measured(f"{a:.3g} {unit}", f"{b:.3g} {unit}", a / b, note)

    nothing, types, listed = MODELS
    for ours in (types, listed):
        yield Row(f"load with {ours}", "without", partial(ratio, ours, nothing, 0, "s"))
        yield Row(f"size with {ours}", "without", partial(ratio, ours, nothing, 1, "MB"))
    yield Row(f"naive pairs, {listed}", types, partial(ratio, listed, types, 2, "s"))
    yield Row(f"any shortest, {listed}", types, partial(ratio, listed, types, 3, "s"))


def measured(written: list[RobotRows], name: str) -> list[float]:
    """Load one model into a new database; return seconds of the load, megabytes, seconds of each query."""
    statement, queries = MODELS[name]
    cypher.CREATE_CARRIES = statement
    some = written if queries else [replace(one, carried=[]) for one in written]
    with private_server() as (driver, folder):
        load(driver, some[:20], VOCABULARY)  # warms the server up
        seconds = timed(lambda: load(driver, some, VOCABULARY))
        asked = [median(served(driver, query.format(kind, carries(kind)), {}) for kind in ASKED) for query in queries]
        connection.stop()
        size = sum(file.stat().st_size for file in folder.rglob("databases/neo4j/**/*") if file.is_file())
    return [seconds, size / 2**20, *asked]
