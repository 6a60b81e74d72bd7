"""Rows of bags -> Neo4j: each bag in place of what was there of it, many in one transaction. Takes a driver.

In: ``BagRows``. Out: ``(:Bag)-[:HAS_TOPIC]->(:RecordedTopic)-[:RECORDS]->(:Element)`` as ``schema.py`` declares it, the
last only where the robot that was recorded is there and has a channel of that name. Loaded twice, nothing changes.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.ingest.database import cypher
from rosprivacy.ingest.database.bag_rows import in_batches
from rosprivacy.ingest.database.loading import BATCH, refusals, write, write_vocabulary
from rosprivacy.ingest.database.schema import constraints

if TYPE_CHECKING:
    from collections.abc import Sequence

    from neo4j import Driver, ManagedTransaction

    from rosprivacy.ingest.database.bag_rows import BagRows
    from rosprivacy.ontology.vocabulary import Vocabulary


def load_bags(driver: Driver, bags: Sequence[BagRows], robot: str, vocabulary: Vocabulary) -> int:
    """Write bags and categories; return how many topics tell of a channel of the robot that was recorded.

    Raises
    ------
    QueryError
        If a robot is named that is not there: its channels would be linked to nothing in silence (S11).
    DatabaseError
        If the server refuses or is lost; each bag is there as a whole or as before.
    """
    with refusals(), driver.session() as session:
        if robot and not session.execute_read(_is_there, robot):
            raise QueryError(f"no robot {shown(robot)} in the database; load it first, or see rosprivacy query robots")
        for statement in constraints():
            session.run(statement).consume()
        session.execute_write(write_vocabulary, vocabulary)
        for batch in in_batches(bags, BATCH):
            session.execute_write(_write, batch)
        return session.execute_read(_linked, [rows.bag["id"] for rows in bags])


def unload_bags(driver: Driver, path: str) -> list[str]:
    """Remove the bag at a path, or all bags below it; return where they are, sorted."""
    with refusals(), driver.session() as session:
        return session.execute_write(_remove, str(Path(path).resolve()))


def _is_there(transaction: ManagedTransaction, robot: str) -> bool:
    return any(record["known"] for record in transaction.run(cypher.READ_ROBOTS, names=[robot]))


def _write(transaction: ManagedTransaction, bags: list[BagRows]) -> None:
    topics = [row for rows in bags for row in rows.topics]
    write(transaction, cypher.MERGE_BAGS, [rows.bag for rows in bags])
    write(transaction, cypher.DELETE_OLD_TOPICS, [rows.bag for rows in bags])
    write(transaction, cypher.MERGE_TOPICS, topics)
    ends = [{"source": r.bag["id"], "target": topic["id"], "properties": {}} for r in bags for topic in r.topics]
    write(transaction, cypher.MERGE_HAS_TOPIC, ends)
    write(transaction, cypher.DELETE_OLD_RECORDS, topics)
    links = [{"source": row["id"], "target": to, "properties": {}} for row in topics for to in row["channels"]]
    write(transaction, cypher.MERGE_RECORDS, links)


def _linked(transaction: ManagedTransaction, ids: list[str]) -> int:
    return sum(record["linked"] for record in transaction.run(cypher.COUNT_RECORDS, ids=ids))


def _remove(transaction: ManagedTransaction, path: str) -> list[str]:
    return [record["id"] for record in transaction.run(cypher.DELETE_BAGS, path=path)]
