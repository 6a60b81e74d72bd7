"""Bags with what can be in them -> rows -> Neo4j: each bag in place of what was there of it.

In: judged bags, and the robot that was recorded where a user names one; a driver. Out: ``BagRows``, and
``(:Bag)-[:HAS_TOPIC]->(:RecordedTopic)-[:RECORDS]->(:Element)`` as ``schema.py`` declares it, the last only where the
robot is there and has a channel of that name. Loaded twice, nothing changes.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.model import Element
from rosprivacy.ingest.neo4j_graph import cypher
from rosprivacy.ingest.neo4j_graph.ids import element_id, topic_id
from rosprivacy.ingest.neo4j_graph.loading import in_batches, refusals, write, write_vocabulary
from rosprivacy.ingest.neo4j_graph.schema import constraints
from rosprivacy.ingest.policies.names import recorded_channels

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from neo4j import Driver, ManagedTransaction

    from rosprivacy.analysis.model import Confidence
    from rosprivacy.analysis.model.recording import JudgedBag, TopicKinds
    from rosprivacy.ontology.vocabulary import Vocabulary

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class BagRows:
    """What is written of one bag.

    Attributes
    ----------
    bag
        ``id``, ``properties``, and ``topics``: the ids of its topics.
    topics
        ``id``, ``properties``, and ``channels``: ids of the elements of which a topic tells, if they are there.
    """

    bag: Row
    topics: tuple[Row, ...]


def bag_rows(judged: JudgedBag, robot: str, assumptions: Mapping[str, Any]) -> BagRows:
    """Return the rows of a bag.

    >>> from rosprivacy.analysis.model.recording import Bag, BagTopic, JudgedBag, TopicKinds
    >>> rows = bag_rows(JudgedBag(Bag("/b"), (TopicKinds(BagTopic("/a")),)), "r1", {})
    >>> rows.bag["id"], rows.topics[0]["id"], rows.topics[0]["channels"]
    ('/b', '/b|/a', ['r1|topic|/a'])
    """
    bag = judged.bag
    place = str(Path(bag.path).resolve())
    topics = tuple(_topic(topic, place, robot) for topic in judged.topics)
    properties = {
        "path": bag.path,
        "robot": robot or None,
        "verdict": str(judged.verdict),
        "kinds": list(judged.kinds),
        "suggested": _suggested(judged.suggested),
        "open_topics": list(judged.open_topics),
        "gaps": list(bag.gaps),
        "beside": list(bag.extras),
        "storage": bag.storage,
        "distro": bag.distro or None,
        "compression": bag.compression or None,
        "bytes": bag.size,
        "topics": len(bag.topics),
        "messages": bag.messages,
        "start": bag.start,
        "end": bag.end,
        "assumptions": json.dumps(assumptions, ensure_ascii=False, sort_keys=True),
    }
    return BagRows({"id": place, "properties": properties, "topics": [row["id"] for row in topics]}, topics)


def _topic(judged: TopicKinds, place: str, robot: str) -> Row:
    topic = judged.topic
    properties = {
        "name": topic.name,
        "types": list(topic.types),
        "messages": topic.messages,
        "kinds": list(judged.kinds),
        "suggested": _suggested(judged.surest),
        "unknown": judged.unknown or None,
        "why": judged.why or None,
    }
    channels = [element_id(robot, Element(kind, name, leg=leg)) for kind, name, leg in recorded_channels(topic.name)]
    return {"id": topic_id(place, topic.name), "properties": properties, "channels": channels if robot else []}


def _suggested(surest: Mapping[str, Confidence]) -> list[str]:
    return [f"{kind} ({sure})" for kind, sure in surest.items()]


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
        for batch in in_batches(bags, lambda rows: len(rows.topics) + 1, lambda rows: str(rows.bag["id"])):
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
