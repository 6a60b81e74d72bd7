"""Bags with what can be in them -> the rows that Neo4j takes, as plain values.

In: judged bags, and the robot that was recorded where a user names one. Out: ``BagRows``. The properties are those of
``schema.py``; a test holds this.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Element
from rosprivacy.ingest.database.ids import element_id, topic_id
from rosprivacy.ingest.policies.names import recorded_channels

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import Confidence
    from rosprivacy.analysis.model.recording import JudgedBag, TopicKinds

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
        "beside": list(bag.beside),
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


def in_batches(bags: Iterable[BagRows], most: int) -> Iterable[list[BagRows]]:
    """Yield bags together, up to so many topics; a bag with more stands by itself."""
    batch: list[BagRows] = []
    size = 0
    for rows in bags:
        if batch and size + len(rows.topics) > most:
            yield batch
            batch, size = [], 0
        batch.append(rows)
        size += len(rows.topics) + 1
    if batch:
        yield batch
