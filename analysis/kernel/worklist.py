"""The fixpoint of rule S8 on Python's own integers: for graphs on which it takes less time than to import numpy.

In: a ``LabelledGraph``. Out: per vertex the bits that arrive and the bits that leave. ``fixpoint.py`` is the form for
large graphs; a test holds each to the other, bit for bit.
"""

from __future__ import annotations

from collections import OrderedDict, defaultdict
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph


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
    keep, everything = graph.keep, graph.all_bits
    arrives: dict[int, int] = {}
    leaves = {vertex: bits for vertex, bits in graph.emitted.items() if bits}
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
            left = leaves.get(target, 0)
            if more := onward & ~left:
                leaves[target] = left | more
                waiting[target] = waiting.get(target, 0) | more
    return dict(sorted(arrives.items())), dict(sorted(leaves.items()))
