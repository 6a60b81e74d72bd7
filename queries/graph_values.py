"""What a query gives of the graph itself: nodes, relationships and paths, as values that outlive the driver.

In: values of the driver. Out: frozen values, and these as JSON has them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


@dataclass(frozen=True, slots=True)
class Node:
    """A node; one that is known only as the end of a relationship has neither labels nor properties.

    Attributes
    ----------
    id
        Of the server, which tells nodes apart and says nothing to people.
    """

    id: str
    labels: tuple[str, ...]
    properties: Mapping[str, Any]

    @property
    def bare(self) -> bool:
        """Whether nothing is known of it but that it is there."""
        return not self.labels and not self.properties


@dataclass(frozen=True, slots=True)
class Relationship:
    """A relationship with its ends."""

    id: str
    type: str
    start: Node
    end: Node
    properties: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Path:
    """A path: nodes, and between each two of them a relationship, which may lead back."""

    nodes: tuple[Node, ...]
    relationships: tuple[Relationship, ...]


GraphValue = Node | Relationship | Path


def value_of(value: Any) -> Any:
    """Return a value of the driver as one of ours, or as JSON has it if it is none of the graph."""
    from neo4j import graph  # noqa: PLC0415 - light start

    if isinstance(value, graph.Node):
        return _node(value)
    if isinstance(value, graph.Relationship):
        return _relationship(value)
    if isinstance(value, graph.Path):
        return Path(tuple(map(_node, value.nodes)), tuple(map(_relationship, value.relationships)))
    if isinstance(value, list):
        return [value_of(item) for item in value]
    if isinstance(value, dict):
        return {key: value_of(item) for key, item in value.items()}
    return value if isinstance(value, str | int | float | bool | None) else str(value)


def plain(value: Any) -> Any:
    """Return a value as JSON has it.

    A node is an object with ``labels`` and its properties, a relationship one with ``type``, a path a list of these in
    turn.
    """
    if isinstance(value, Node):
        return {"labels": list(value.labels), **value.properties}
    if isinstance(value, Relationship):
        return {"type": value.type, **value.properties}
    if isinstance(value, Path):
        steps = [plain(value.nodes[0])]
        for relationship, node in zip(value.relationships, value.nodes[1:], strict=True):
            steps += [plain(relationship), plain(node)]
        return steps
    if isinstance(value, list):
        return [plain(item) for item in value]
    return {key: plain(item) for key, item in value.items()} if isinstance(value, dict) else value


def graph_values(value: Any) -> Iterator[GraphValue]:
    """Return what of the graph is in a value, also within lists and maps."""
    if isinstance(value, GraphValue):
        yield value
    elif isinstance(value, list | tuple | dict):
        for item in value.values() if isinstance(value, dict) else value:
            yield from graph_values(item)


def nodes_in(value: GraphValue) -> tuple[Node, ...]:
    """Return the nodes of a value, the ends of its relationships included."""
    if isinstance(value, Node):
        return (value,)
    if isinstance(value, Relationship):
        return (value.start, value.end)
    return value.nodes


def with_known(value: Any, nodes: Mapping[str, Node]) -> Any:
    """Return a value with the ends of its relationships as they were looked up, by id."""
    if isinstance(value, Node):
        return nodes.get(value.id, value)
    if isinstance(value, Relationship):
        start, end = (nodes.get(node.id, node) for node in (value.start, value.end))
        return Relationship(value.id, value.type, start, end, value.properties)
    if isinstance(value, Path):
        return Path(
            tuple(with_known(node, nodes) for node in value.nodes),
            tuple(with_known(relationship, nodes) for relationship in value.relationships),
        )
    if isinstance(value, list | tuple):
        return type(value)(with_known(item, nodes) for item in value)
    return {key: with_known(item, nodes) for key, item in value.items()} if isinstance(value, dict) else value


def _node(node: Any) -> Node:
    return Node(node.element_id, tuple(sorted(node.labels)), _properties(node))


def _relationship(relationship: Any) -> Relationship:
    start, end = (_node(node) for node in relationship.nodes)
    return Relationship(relationship.element_id, relationship.type, start, end, _properties(relationship))


def _properties(entity: Any) -> dict[str, Any]:
    return {key: value_of(entity[key]) for key in sorted(entity)}
