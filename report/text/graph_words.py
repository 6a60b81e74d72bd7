"""Nodes, relationships and paths of a query in words, as the program says paths elsewhere; never cut.

In: values of a query's rows. Out: text, not yet escaped for where it goes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CHANNELS
from rosprivacy.queries.graph_values import Node, Relationship, graph_values, nodes_in
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words
from rosprivacy.report.naming import kind_of
from rosprivacy.report.stored import flow_said, record_kind, record_name
from rosprivacy.report.text.finding_lines import verb

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.queries.graph_values import GraphValue
    from rosprivacy.report.stored import StoredNames


@dataclass(frozen=True, slots=True)
class GraphWords:
    """How values of the graph are told.

    Attributes
    ----------
    robots
        Whether there are several, so that each element is named with its own.
    words
        Of the reader's language.
    """

    names: StoredNames
    robots: bool
    words: Words = IN_ENGLISH

    @classmethod
    def for_rows(cls, names: StoredNames, rows: object, words: Words = IN_ENGLISH) -> GraphWords:
        """Return how the values of some rows are told."""
        elements = (names.element(node) for value in graph_values(rows) for node in nodes_in(value))
        return cls(names, len({element["robot"] for element in elements if element} - {""}) > 1, words)

    def of(self, value: GraphValue) -> str:
        """Return a value in words: a path hop by hop, a relationship with its ends."""
        if isinstance(value, Node):
            return self._node(value)
        if isinstance(value, Relationship):
            return f"{self._node(value.start)}{self._step(value, value.start)}{self._node(value.end)}"
        text = self._node(value.nodes[0])
        for before, relationship, node in zip(value.nodes, value.relationships, value.nodes[1:], strict=False):
            text += f"{self._step(relationship, before)}{self._node(node)}"
        return text

    def _node(self, node: Node) -> str:
        element = self.names.element(node)
        if element is None:
            return f"{record_name(node)} ({record_kind(node)})"
        robot = f"{element['robot']}:" if self.robots and element["robot"] else ""
        return f"{robot}{element['name']} ({self._kind(element)})"

    def _kind(self, element: Mapping[str, Any]) -> str:
        return kind_of(element) if self.words == IN_ENGLISH else self.words.kind(element)

    def _step(self, relationship: Relationship, before: Node) -> str:
        """What is between two nodes, with the place where it stands; an arrow that points where the data goes."""
        text = self._verb(relationship)
        file, line = (relationship.properties.get(key) for key in ("file", "line"))
        if file:
            text += f" {file}:{line}" if line else f" {file}"
        return f" | {text} -> " if relationship.start.id == before.id else f" <- {text} | "

    def _verb(self, relationship: Relationship) -> str:
        if relationship.type != self.names.flow:
            return relationship.type
        end = self.names.element(relationship.end)
        role, denied = flow_said(relationship)
        into_channel = end is not None and end["kind"] in CHANNELS
        text = verb(role, into_channel=into_channel, words=self.words)
        return f"{text} ({self.words('picture.look.denied')})" if denied else text
