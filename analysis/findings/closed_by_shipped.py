"""Ways to a leak that only a shipped file closes: nobody has said that the channel is harmless (rules S11, S13).

In: a spread at its fixpoint. Out: ``ClosedByShipped`` facts: the channel, what stops there, the nearest leak, storage
or element outside ROS that it would get to, and how much that weighs.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import ClosedByShipped
from rosprivacy.analysis.findings.closures import PERHAPS, behind, standard_closures
from rosprivacy.analysis.many_flows import leaving
from rosprivacy.analysis.model import NON_ROS, STANDARD, Rank, Statement

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element


def closed_by_shipped(
    spread: Spread, mask: int, beyond: Collection[int] = (), unit: Sequence[int] = ()
) -> tuple[ClosedByShipped, ...]:
    """Return what shipped statements alone close, one for both legs and sides of a channel, in the order of channels.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.
    beyond
        Of a part of a graph, the vertices through which data gets to other parts: a leak may lie behind each.
    unit
        Of a part of a graph, by vertex: what a node has to have in common with its services; empty for nothing.

    Notes
    -----
    Nothing where nobody reads what was closed; else a few runs of the kernel, as for the ledger.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.model import Place
    >>> graph, bound, hierarchy = factory()
    >>> faces = [element.name for element in graph.elements].index("/faces")
    >>> mundane = Statement("mundane", (), (STANDARD, 0), Place("rosprivacy:standard", 7), shipped=True)
    >>> bound = replace(bound, elements={**bound.elements, faces: (mundane,)})
    >>> carried = spread(graph, bound, hierarchy)
    >>> [(row.channel.name, row.end.name, row.rank) for row in closed_by_shipped(carried, carried.all_bits)]
    [('/faces', '/archive', None)]
    """
    elements, onward = spread.graph.elements, leaving(spread.graph.flows) if spread.standard else {}
    closed = [one for one in standard_closures(spread) if one.bits & mask and one.vertex in onward]
    if not closed:
        return ()
    ends = {v: bits & mask for v, bits in spread.leaks.items()}
    ends |= {v: mask for v, element in enumerate(elements) if element.kind in NON_ROS}
    ends |= dict.fromkeys(beyond, mask)
    nodes: dict[int, set[str]] = defaultdict(set)
    for v, element in enumerate(elements):
        if element.is_node and v not in spread.absent:
            nodes[unit[v] if unit else 0].add(element.name)
    found: dict[tuple[str, str, str], list[ClosedByShipped]] = defaultdict(list)
    for number, end in sorted(behind(spread, closed, ends).items()):
        closure = closed[number]
        lines = [line for line in closure.lines if isinstance(line, Statement) and line.shipped]
        by_standard = any(line.rank[0] == STANDARD for line in lines)
        channel = elements[closure.vertex]
        outside = Rank.BREAKS if not in_its_place(channel, nodes[unit[closure.vertex] if unit else 0]) else None
        row = ClosedByShipped(
            channel,
            spread.names(closure.bits & mask),
            None if end == PERHAPS or (end in beyond and elements[end].kind not in NON_ROS) else elements[end],
            tuple(sorted({line.place for line in lines})),
            outside if by_standard else Rank.RIDES,
        )
        found[channel.identity].append(row)
    return tuple(_one(found[key]) for key in sorted(found))


def in_its_place(channel: Element, nodes: Collection[str]) -> bool:
    """Return whether a standard channel is where ROS has it: a topic at the root, a service of a node that is there.

    >>> from rosprivacy.analysis.model import Element
    >>> [in_its_place(Element("topic", name), ()) for name in ("/clock", "/patient/clock")]
    [True, False]
    >>> [in_its_place(Element("service", "/cloud/get_parameters"), nodes) for nodes in (["/cloud"], ["/camera"])]
    [True, False]

    Versions of rclcpp before Foxy name ``parameter_events`` below the namespace of the node:

    >>> [in_its_place(Element("topic", "/map/parameter_events"), nodes) for nodes in (["/map/server"], ["/camera"])]
    [True, False]
    """
    owner, _, last = channel.name.rpartition("/")
    if channel.kind == "service":
        return owner in nodes
    return not owner or (last == "parameter_events" and any(node.rpartition("/")[0] == owner for node in nodes))


def _one(rows: list[ClosedByShipped]) -> ClosedByShipped:
    """Legs and sides of a channel as one, with what weighs most."""
    first = min(rows, key=lambda row: (row.rank is None, row.rank or "", row.end is None))
    categories = {name for row in rows for name in row.categories}
    places = {place for row in rows for place in row.places}
    return first._replace(categories=tuple(sorted(categories)), places=tuple(sorted(places)))
