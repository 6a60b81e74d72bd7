"""Where data's way ends without anybody known: channels that nobody reads, elements that nothing reaches (rule S11).

In: a spread. Out: ``UnknownEnd`` facts, sorted. They change no verdict; who reads the verdict is told of them, since
the reader may stand in a policy that was not given, or be a node without any.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import NON_ROS, UnknownEnd

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, FlowGraph


def unknown_ends(found: Spread, mask: int) -> tuple[UnknownEnd, ...]:
    """Return channels with data that nobody known reads, and elements outside ROS that no flow reaches.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.

    Notes
    -----
    Who reads is a matter of flows: a flow that a DENY takes back makes no reader, one that some data may not take
    makes one. O(flows).
    """
    merged: dict[tuple[str, str, str, str], tuple[Element, int]] = {}
    for vertex in _unread(found, mask):
        element = found.graph.elements[vertex]
        first, bits = merged.get(element.shown_as, (element, 0))  # the other side of a wildcard
        merged[element.shown_as] = first, bits | found.present(vertex) & mask
    ends = [UnknownEnd(element, "reader", found.names(bits)) for element, bits in merged.values()]
    ends += [UnknownEnd(found.graph.elements[vertex], "flow") for vertex in _unreached(found)]
    return tuple(sorted(ends, key=lambda end: end.element.sort_key()))


def _unread(found: Spread, mask: int) -> Iterator[int]:
    """Channels with data from which no flow leads to anything but channels."""
    elements = found.graph.elements
    known = readable(found.graph)
    for vertex in sorted(found.leaves):
        if elements[vertex].is_channel and found.present(vertex) & mask and vertex not in known:
            yield vertex


def readable(graph: FlowGraph) -> Collection[int]:
    """Return the channels that a node reads, by their name or through wildcards that match it (rule S4)."""
    known: set[int] = set()
    before: dict[int, list[int]] = defaultdict(list)
    for flow in graph.flows:
        if not graph.elements[flow.source].is_channel:
            continue
        if graph.elements[flow.target].is_channel:
            before[flow.target].append(flow.source)
        else:
            known.add(flow.source)
    waiting = list(known)
    while waiting:
        for channel in before.get(waiting.pop(), ()):
            if channel not in known:
                known.add(channel)
                waiting.append(channel)
    return known


def _unreached(found: Spread) -> Iterator[int]:
    """Elements outside ROS that nothing flows into; data may begin at one, then a flow out of it is enough."""
    graph = found.graph
    entered = {flow.target for flow in graph.flows}
    left = {flow.source for flow in graph.flows}
    for vertex, element in enumerate(graph.elements):
        if element.kind in NON_ROS and vertex not in entered:
            begins = any("source" in fact.roles for fact in found.facts.get(vertex, {}).values())
            if not (begins and vertex in left):
                yield vertex
