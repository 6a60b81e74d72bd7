"""Nodes and relationships as a query gives them, made by hand, and the names of the schema that readers know."""

from __future__ import annotations

from typing import Any

from rosprivacy.ingest.neo4j_graph.schema import CARRIES, FLOWS_TO, KIND_LABELS
from rosprivacy.queries.graph_values import Node, Relationship
from rosprivacy.report.stored import StoredNames

NAMES = StoredNames({label: kind for kind, label in KIND_LABELS.items()}, FLOWS_TO.type, CARRIES)


def node(name: str, *labels: str, robot: str = "r1", **properties: Any) -> Node:
    """An element, by its labels."""
    return Node(f"{robot}{name}{labels}", ("Element", *labels), {"name": name, "robot": robot, **properties})


def relation(start: Node, type_: str, end: Node, **properties: Any) -> Relationship:
    return Relationship(f"{start.id}-{type_}-{end.id}", type_, start, end, properties)
