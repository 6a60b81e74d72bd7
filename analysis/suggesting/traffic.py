"""Who writes and who reads which channel by its name: the flows of grants, without standard channels (rules S3, S13).

What a wildcard covers is not followed: a grant for everything says nothing of what a node is for.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import CANNOT

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.model import Bound, FlowGraph


class Traffic(NamedTuple):
    """By vertex of a node the vertices of channels that it writes and reads, and the other way round; sorted."""

    writes: Mapping[int, tuple[int, ...]]
    reads: Mapping[int, tuple[int, ...]]
    writers: Mapping[int, tuple[int, ...]]
    readers: Mapping[int, tuple[int, ...]]


def traffic(graph: FlowGraph, bound: Bound) -> Traffic:
    """Return the traffic of a graph; of a service or action each leg is a channel (rule S2).

    >>> from rosprivacy.analysis.example import CAMERA, FILTER, factory
    >>> graph, bound, _ = factory()
    >>> told = traffic(graph, bound)
    >>> named = lambda vertices: [graph.elements[vertex].name for vertex in vertices]
    >>> named(told.writes[CAMERA]), named(told.reads[FILTER]), named(told.readers[told.writes[CAMERA][0]])
    (['/video'], ['/video'], ['/face_id', '/filter'])
    """
    is_channel = [element.is_channel for element in graph.elements]
    standard = standard_in(bound)
    found: list[dict[int, set[int]]] = [defaultdict(set) for _ in Traffic._fields]
    writes, reads, writers, readers = found
    for _, flow in parted(graph.flows)[0]:  # a meeting is one of channels
        source, target = flow.source, flow.target
        if is_channel[source] == is_channel[target] or source in standard or target in standard:
            continue
        if is_channel[target]:
            writes[source].add(target)
            writers[target].add(source)
        else:
            reads[target].add(source)
            readers[source].add(target)
    return Traffic(*({at: tuple(sorted(ends)) for at, ends in sorted(one.items())} for one in found))


def standard_in(bound: Bound) -> set[int]:
    """Return the vertices of which a shipped file says that they are standard: nothing else decides the traffic.

    >>> from rosprivacy.analysis.example import factory
    >>> graph, bound, _ = factory()
    >>> [graph.elements[vertex].name for vertex in standard_in(bound)]
    ['/rosout']
    """
    return {
        vertex for vertex, said in bound.elements.items() if any(one.shipped and one.role != CANNOT for one in said)
    }
