"""Where data's path ends without anybody known: channels that nobody reads, elements that nothing reaches (rule S11).

In: a spread. Out: ``UnknownEnd`` facts, sorted. They change no verdict; who reads the verdict is told of them, since
the reader may stand in a policy that was not given, or be a node without any.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import NETWORK, NON_ROS, PARTICIPANT, UnknownEnd

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.meeting import Meeting
    from rosprivacy.analysis.model import Element, FlowGraph


def unknown_ends(spread: Spread, mask: int) -> tuple[UnknownEnd, ...]:
    """Return channels with data that nobody known reads, and elements outside ROS that no flow reaches.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.

    Notes
    -----
    Who reads is a matter of flows: a flow that a DENY takes back makes no reader, one that some data may not take
    makes one. O(flows).

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> unread = replace(graph, flows=graph.flows[:5])  # nobody subscribes
    >>> carried = spread(unread, bound, hierarchy)
    >>> [(end.element.name, end.what, end.categories) for end in unknown_ends(carried, carried.all_bits)]
    [('/video', 'reader', ('Video',))]
    """
    merged: dict[tuple[str, str, str, str], tuple[Element, int]] = {}
    for vertex in _unread(spread, mask):
        element = spread.graph.elements[vertex]
        first, bits = merged.get(element.shown_as, (element, 0))  # the other side of a wildcard
        merged[element.shown_as] = first, bits | spread.present(vertex) & mask
    ends = [UnknownEnd(element, "reader", spread.names(bits)) for element, bits in merged.values()]
    ends += [UnknownEnd(spread.graph.elements[vertex], "flow") for vertex in _unreached(spread)]
    return tuple(sorted(ends, key=lambda end: end.element.sort_key()))


def _unread(spread: Spread, mask: int) -> Iterator[int]:
    """Channels with data from which no flow leads to anything but channels."""
    elements = spread.graph.elements
    known = spread.shape.kept("readable", None, lambda: _readable(spread.graph))
    for vertex in sorted(spread.leaves):
        if elements[vertex].is_channel and spread.present(vertex) & mask and vertex not in known:
            yield vertex


def _readable(graph: FlowGraph) -> Collection[int]:
    """Return the channels that a node reads, by their name or through wildcards that match it (rule S4)."""
    known: set[int] = set()
    before: dict[int, list[int]] = defaultdict(list)
    own, meetings = parted(graph.flows)
    for _, flow in own:
        if not graph.elements[flow.source].is_channel:
            continue
        if graph.elements[flow.target].is_channel:
            before[flow.target].append(flow.source)
        else:
            known.add(flow.source)
    met: dict[int, list[Meeting]] = defaultdict(list)
    for meeting in meetings:
        known.update(meeting.written if meeting.of_written else ())
        for target in meeting.read if meeting.of_wildcards else ():
            met[target].append(meeting)
    waiting = list(known)
    done: set[int] = set()
    while waiting:
        read = waiting.pop()
        new = [meeting for meeting in met.get(read, ()) if id(meeting) not in done]
        done.update(map(id, new))
        for channel in (*before.get(read, ()), *(source for meeting in new for source in meeting.written)):
            if channel not in known:
                known.add(channel)
                waiting.append(channel)
    return known


def _is_network(element: Element) -> bool:
    """Whether an element stands for whoever is on the network: what it reads is a matter of the enforced view (S6)."""
    return element.kind == PARTICIPANT and element.name == NETWORK


def _unreached(spread: Spread) -> Iterator[int]:
    """Elements outside ROS that nothing flows into; where data may begin, a flow out is enough."""
    graph = spread.graph
    outside = [v for v, e in enumerate(graph.elements) if e.kind in NON_ROS and not _is_network(e)]
    if not outside:
        return
    own = [flow for _, flow in parted(graph.flows)[0]]  # a meeting is one of channels, or of them and nodes
    entered = {flow.target for flow in own}
    left = {flow.source for flow in own}
    for vertex in outside:
        if vertex not in entered:
            begins = graph.elements[vertex].kind == PARTICIPANT  # it was seen to write, and nobody says what
            begins |= any("source" in fact.roles for fact in spread.facts.get(vertex, {}).values())
            if not (begins and vertex in left):
                yield vertex
