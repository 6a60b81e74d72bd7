"""What all paths to a vertex go through: immediate dominators.

In: a graph as the targets of each vertex. Out: for each vertex that can be reached, the last vertex before it that
every path to it passes. The algorithm is that of Cooper, Harvey and Kennedy, 'A simple, fast dominance algorithm'
(2001), as in networkx, whose import takes longer than most analyses.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

UNKNOWN = -1
V = TypeVar("V", int, tuple[int, int, int])  # a vertex


def immediate_dominators(following: Mapping[V, Iterable[V]], start: V) -> dict[V, V]:
    """Return the immediate dominator of each vertex that can be reached, but for the start itself.

    Notes
    -----
    Complexity: O(V · E) at worst, on flow graphs a few passes over the edges.

    Examples
    --------
    >>> immediate_dominators({0: [1, 2], 1: [3], 2: [3], 3: [4]}, 0)
    {1: 0, 2: 0, 3: 0, 4: 3}
    """
    order = _finished(following, start)
    rank = {vertex: at for at, vertex in enumerate(order)}
    entering: list[list[int]] = [[] for _ in order]
    for at, here in enumerate(order):
        for there in following.get(here, ()):
            entering[rank[there]].append(at)
    root: int = len(order) - 1
    above = [*[UNKNOWN] * root, root]
    changed = True
    while changed:
        changed = False
        for vertex in range(root - 1, -1, -1):
            dominator = UNKNOWN
            for other in entering[vertex]:
                if above[other] != UNKNOWN and other != dominator:
                    if dominator == UNKNOWN:
                        dominator = other
                    while other != dominator:  # up to the nearest that dominates both; a higher rank is nearer
                        if other < dominator:
                            other = above[other]  # noqa: PLW2901
                        else:
                            dominator = above[dominator]
            if above[vertex] != dominator:
                above[vertex] = dominator
                changed = True
    return {vertex: order[above[at]] for vertex, at in sorted(rank.items()) if at != root}


def _finished(following: Mapping[V, Iterable[V]], start: V) -> list[V]:
    """The vertices that can be reached, each after all that a depth-first search meets behind it: the start is last."""
    finished: list[V] = []
    seen = {start}
    stack = [(start, iter(following.get(start, ())))]
    while stack:
        vertex, targets = stack[-1]
        for target in targets:
            if target not in seen:
                seen.add(target)
                stack.append((target, iter(following.get(target, ()))))
                break
        else:
            stack.pop()
            finished.append(vertex)
    return finished
