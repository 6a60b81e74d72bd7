"""The fixpoint of rule S8, in the form that suits the size of the graph: the one place where that is chosen.

In: a ``LabelledGraph``. Out: per element the bits that arrive and the bits that leave.
"""

from __future__ import annotations

from collections import OrderedDict, defaultdict
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph


SMALL = 20_000  # edges up to which a worklist takes less time than the import of numpy


def least_solution(graph: LabelledGraph) -> tuple[dict[int, int], dict[int, int]]:
    """Return what arrives at and what leaves each element where there is any, in order.

    >>> from rosprivacy.analysis.example import CAMERA, ROSOUT, factory
    >>> from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph
    >>> from rosprivacy.analysis.kernel.spreading import meaning
    >>> labelled = meaning(*factory(), ["FaceTemplate", "Video"])
    >>> arrives, leaves = least_solution(LabelledGraph.of(labelled))
    >>> labelled.names(arrives[ROSOUT]), labelled.names(leaves[CAMERA]), leaves.get(ROSOUT, 0)
    (('Video',), ('Video',), 0)
    """
    if len(graph.sources) > SMALL:
        from rosprivacy.analysis.kernel.arrays import solved  # noqa: PLC0415 - numpy, only where it saves time

        arrives, leaves = solved(graph)
    else:
        arrives, leaves = worklist(graph)
    return _elements(arrives, graph.count), _elements(leaves, graph.count)


def _elements(bits: dict[int, int], count: int) -> dict[int, int]:
    return {vertex: some for vertex, some in bits.items() if vertex < count}


def worklist(graph: LabelledGraph) -> tuple[dict[int, int], dict[int, int]]:
    """Return what arrives at and what leaves each vertex where there is any, in order: the least solution of rule S8.

    What is new at a vertex waits to be sent on; first in, first out, so that what comes along several edges goes on
    together.

    Examples
    --------
    >>> from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph
    >>> line = LabelledGraph(3, 3, [0, 1], [1, 2], (), 0b11, {0: 1}, {0: 0, 1: 0, 2: 0}, [(1, 0, 1)])
    >>> worklist(line)  # 0 -> 1 -> 2, and vertex 1 makes bit 1 of bit 0
    ({1: 1, 2: 2}, {0: 1, 1: 2})
    """
    ahead: dict[int, list[int]] = defaultdict(list)
    for source, target in zip(graph.sources, graph.targets, strict=True):
        ahead[source].append(target)
    derived: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for vertex, before, after in graph.derivations:
        derived[vertex].append((before, after))
    return propagated(ahead, derived, graph.keep, graph.emitted, graph.all_bits, {})


def propagated(
    ahead: Mapping[int, Iterable[int]],
    derived: Mapping[int, Iterable[tuple[int, int]]],
    keep: Mapping[int, int],
    emitted: Mapping[int, int],
    everything: int,
    closed: Mapping[int, int],
) -> tuple[dict[int, int], dict[int, int]]:
    """Return the same of edges by their source; O(edges of the vertices that anything gets to).

    Parameters
    ----------
    closed
        Vertex -> bits that do not leave it, whatever else it does.

    Examples
    --------
    >>> propagated({0: [1], 1: [2]}, {}, {}, {0: 0b11}, 0b11, {1: 0b01})
    ({1: 3, 2: 2}, {0: 3, 1: 2, 2: 2})
    """
    arrives: dict[int, int] = {}
    leaves = {vertex: some for vertex, bits in emitted.items() if (some := bits & ~closed.get(vertex, 0))}
    waiting = OrderedDict(leaves)  # the first key of a dict is found past all that were taken out
    while waiting:
        vertex, bits = waiting.popitem(last=False)
        for target in ahead.get(vertex, ()):
            known = arrives.get(target, 0)
            new = bits & ~known
            if not new:
                continue
            arrives[target] = known | new
            onward = new & keep.get(target, everything)
            for before, after in derived.get(target, ()):
                onward |= (new >> before & 1) << after
            if target in closed:
                onward &= ~closed[target]
            left = leaves.get(target, 0)
            if more := onward & ~left:
                leaves[target] = left | more
                waiting[target] = waiting.get(target, 0) | more
    return dict(sorted(arrives.items())), dict(sorted(leaves.items()))
