"""Where each statement stands that takes data or a question away, and the labels without it (rules S7, S8, S11).

In: elements and flows with what is said of them. Out: ``Spots`` by statement. A glob is one statement wherever it
holds, a full name one on all robots that have it; what is typed by hand is about one robot.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import NOWHERE, Bound, Statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, FlowGraph

BRINGS_IN = frozenset({"source", "leak", "derivation"})
Identity = tuple[Statement, tuple[str, ...]]  # of a name also the names, and the robots if typed by hand


class Spots(NamedTuple):
    """Elements, by vertex, and flows, by index, about which a statement is."""

    vertices: list[int]
    flows: list[int]

    def has_data(self, spread: Spread, bound: Bound) -> bool:
        """Return whether data is at any of them, or a source is named there."""
        at = any(
            v in spread.arrives or v in spread.leaves or any(s.role == "source" for s in bound.elements[v])
            for v in self.vertices
        )
        flows = ((index, spread.graph.flows[index].source) for index in self.flows)
        return at or any(spread.sent.get(source, 0) | spread.flow_emits.get(index, 0) for index, source in flows)

    def with_data(self, spread: Spread) -> list[int]:
        """Return the elements at which data is."""
        return [v for v in self.vertices if v in spread.arrives or v in spread.leaves]

    def without(self, bound: Bound, statement: Statement) -> Bound:
        """Return what else is said of them."""
        return Bound(
            {vertex: _without(bound.elements[vertex], statement) for vertex in self.vertices},
            {index: _without(bound.flows[index], statement) for index in self.flows},
        )


def spots(graph: FlowGraph, bound: Bound, elements: Sequence[Element]) -> dict[Identity, Spots]:
    """Return where each statement is said that takes something away.

    Parameters
    ----------
    elements
        Those of the graph, under the names by which statements about flows are told apart.

    Examples
    --------
    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> graph, bound, _ = factory()
    >>> at = spots(graph, bound, graph.elements)
    >>> {str(statement.place): [NAMES[v] for v in spots.vertices] for (statement, _), spots in at.items()}
    {'labels.yaml:4': ['/filter'], 'labels.yaml:5': ['/faces'], 'standard:1': ['/rosout']}
    """
    at: dict[Identity, Spots] = defaultdict(lambda: Spots([], []))
    for vertex, said in bound.elements.items():
        for statement in filter(_takes, said):
            at[_identity(statement, elements[vertex])].vertices.append(vertex)
    for index, said in bound.flows.items():
        flow = graph.flows[index]
        for statement in filter(_takes, said):
            at[_identity(statement, elements[flow.source], elements[flow.target])].flows.append(index)
    return dict(at)


def _takes(statement: Statement) -> bool:
    return statement.role not in BRINGS_IN and statement.place != NOWHERE


def _identity(statement: Statement, *ends: Element) -> Identity:
    if statement.glob:
        return statement.line, ()
    robots = () if statement.place.line else tuple(end.robot for end in ends)
    return statement, (*(end.name for end in ends), *robots)


def _without(statements: tuple[Statement, ...], statement: Statement) -> tuple[Statement, ...]:
    return tuple(s for s in statements if s.categories != statement.categories or s.line != statement)
