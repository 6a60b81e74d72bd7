"""Where data goes, in three models: nothing of it, one type of relationship per kind, one ``CARRIES {kinds}`` for all.

    python benchmarks/carried_kinds.py [--quick]

Each model in a private Neo4j of its own: time of the load, size on disk, pairs of source and leak of some kinds,
asked as people ask first. ``docs/database.md`` says what was decided and why. ``--quick`` takes 100 robots.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from graph_database import ASKED, FEW, served, timed
from neo4j_fleet import ROBOTS, VOCABULARY, fleet

from rosprivacy.ingest.database import cypher
from rosprivacy.ingest.database.ids import carries
from rosprivacy.ingest.database.loading import load
from rosprivacy.private_neo4j import connection

if TYPE_CHECKING:
    from rosprivacy.ingest.database.rows import RobotRows

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


def measured(rows: list[RobotRows], name: str) -> str:
    """Load one model into a new database; return its line."""
    statement, queries = MODELS[name]
    cypher.CREATE_CARRIES = statement
    some = rows if queries else [replace(one, carried=[]) for one in rows]
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.environ["ROSPRIVACY_DATA"] = folder
        try:
            with connection.open_driver(connection.start()) as driver:
                load(driver, some[:20], VOCABULARY)  # warms the server up
                seconds = timed(lambda: load(driver, some, VOCABULARY))
                asked = [
                    median(served(driver, query.format(kind, carries(kind)), {}) for kind in ASKED) for query in queries
                ]
        finally:
            connection.stop()
        size = sum(file.stat().st_size for file in Path(folder).rglob("databases/neo4j/**/*") if file.is_file())
    times = "".join(f"{second * 1000:>16,.0f} ms" for second in asked)
    return f"{name:<20}{seconds:>10.1f} s{size / 2**20:>12,.0f} MB{times}"


def main() -> None:
    """Print one line for each model."""
    parser = argparse.ArgumentParser(description="Where kinds of data go, in three models.")
    parser.add_argument("--quick", action="store_true", help=f"{FEW} robots")
    for name in ("NEO4J_URI", "NEO4J_USERNAME", "NEO4J_PASSWORD"):
        os.environ.pop(name, None)
    rows = list(fleet(FEW if parser.parse_args().quick else ROBOTS))
    ends = sum(len(one.carried) for one in rows)
    kinds = sum(len(row["types"]) for one in rows for row in one.carried)
    print(f"{len(rows):,} robots; data goes between {ends:,} pairs of ends, {kinds:,} times of one kind")
    print(f"{'model':<20}{'load':>12}{'size':>15}{'naive pairs':>19}{'any shortest':>19}")
    for name in MODELS:
        print(measured(rows, name), flush=True)


if __name__ == "__main__":
    main()
