"""What stands in the database, for readers: which node is which element, and how what is none is called.

In: nodes of a query's rows, and the names of the graph's schema. Out: elements as ``naming`` takes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.queries.graph_values import Node, Relationship

CALLED_BY = ("name", "path", "category", "title", "id")  # of what is no element; the first that is there


class StoredNames(NamedTuple):
    """Names of the schema that a reader has to know.

    Attributes
    ----------
    kinds
        Label -> kind of element.
    flow
        The type of relationships that are flows.
    carries
        How the types of relationships begin along which a kind of data goes.
    """

    kinds: Mapping[str, str]
    flow: str
    carries: str

    def element(self, node: Node) -> dict[str, Any] | None:
        """Return a node as the element that it is, None if it is none.

        Its labels count, as in the analysis; an ``Intake`` has no label of a kind.
        """
        own = str(node.properties.get("kind"))
        stated = own if own in self.kinds.values() else ""
        kind = next((self.kinds[label] for label in node.labels if label in self.kinds), stated)
        if not kind or "name" not in node.properties:
            return None
        texts = {key: str(node.properties.get(key, "")) for key in ("robot", "name", "leg")}
        return {**texts, "kind": kind, "pattern": "side" in node.properties}


def flow_said(flow: Relationship) -> tuple[str, bool]:
    """Return the role of a flow, and whether a DENY takes it back."""
    return str(flow.properties.get("role", "flow")), flow.properties.get("decision") == "deny"


def record_name(node: Node) -> str:
    """Return what a node is called that is no element.

    >>> from rosprivacy.queries.graph_values import Node
    >>> record_name(Node("4:x:1", ("Enclave",), {"id": "r1|/a", "path": "/a"}))
    '/a'
    """
    return next((str(node.properties[key]) for key in CALLED_BY if key in node.properties), node.id)


def record_kind(node: Node) -> str:
    """Return its labels."""
    return ", ".join(node.labels) or "no label"
