"""Which vertices are one element to a reader: legs of services, sides of wildcards (rules S2, S4).

In: a ``Spread``. Out: vertices by identity, or by what is shown; made once for all answers about a graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.kernel.spread import Spread


def by_identity(spread: Spread) -> Mapping[tuple[str, str, str], Sequence[int]]:
    """Return the vertices of each element, in the order of the graph.

    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> by_identity(spread(*factory()))["", "node", "/camera"] == [CAMERA]
    True
    """

    def find() -> dict[tuple[str, str, str], list[int]]:
        found: dict[tuple[str, str, str], list[int]] = {}
        for vertex, element in enumerate(spread.graph.elements):
            found.setdefault(element.identity, []).append(vertex)
        return found

    return spread.shape.memoised("vertices by identity", None, find)


def by_shown(spread: Spread) -> Mapping[tuple[str, str, str, str], Sequence[int]]:
    """Return the vertices of each element and leg, in the order of the graph.

    >>> from rosprivacy.analysis.example import VIDEO, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> by_shown(spread(*factory()))["", "topic", "/video", ""] == [VIDEO]
    True
    """

    def find() -> dict[tuple[str, str, str, str], list[int]]:
        found: dict[tuple[str, str, str, str], list[int]] = {}
        for vertex, element in enumerate(spread.graph.elements):
            found.setdefault(element.shown_as, []).append(vertex)
        return found

    return spread.shape.memoised("vertices by what is shown", None, find)
