"""Where a category is kept too long or leaves the EEA, and why (rules S9, S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import DISCLOSURE, STORAGE_LIMITATION, THIRD_COUNTRY
from rosprivacy.analysis.non_ros import kept_too_long, transferred

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Reason


class Concern(NamedTuple):
    """A kind of finding: vertex -> bits that must not get there, and why."""

    kind: str
    bits: Mapping[int, int]
    reasons: Mapping[tuple[int, str], Reason]


def concerns(spread: Spread, bound: Bound, hierarchy: Hierarchy) -> Iterator[Concern]:
    """Return where each kind of finding can be (rule S10); disclosure first.

    >>> from rosprivacy.analysis.example import DISK, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> kinds = list(concerns(spread(graph, bound, hierarchy), bound, hierarchy))
    >>> [(concern.kind, str(concern.reasons.get((DISK, "Video"), ""))) for concern in kinds]
    [('disclosure', ''), ('storage-limitation', 'no retention is stated'), ('third-country-transfer', '')]
    """
    yield Concern(DISCLOSURE, spread.leaks, {})
    elements = spread.graph.elements
    storages = {v: facts for v, facts in bound.outside.items() if elements[v].kind == "storage"}
    too_long = {(v, c): kept_too_long(facts, c, hierarchy) for v, facts in storages.items() for c in spread.categories}
    abroad = {(v, c): transferred(facts) for v, facts in bound.outside.items() for c in spread.categories}
    for kind, reasons in ((STORAGE_LIMITATION, too_long), (THIRD_COUNTRY, abroad)):
        bits: dict[int, int] = {}
        for (vertex, category), why in reasons.items():
            if why:
                here = spread.both(category) & ~spread.gone.get(vertex, 0)  # nothing gets to what is not on the robot
                bits[vertex] = bits.get(vertex, 0) | here
        yield Concern(kind, bits, {key: why for key, why in reasons.items() if why})
