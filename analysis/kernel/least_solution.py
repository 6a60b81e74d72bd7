"""The fixpoint of rule S8, in the form that suits the size of the graph: the one place where that is chosen.

In: a ``LabelledGraph``. Out: per element the bits that arrive and the bits that leave.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.worklist import worklist

if TYPE_CHECKING:
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
