"""Where what a node makes of other data comes from: from which source, along which path (rules S8, S10).

In: a spread. Out: one ``Origin`` per (node, category that it makes, source). A source of video that comes to a face
recogniser is the origin of the face templates there.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.near_robots import Units
from rosprivacy.analysis.kernel.search import START, Search, path_to, search
from rosprivacy.analysis.kernel.states import Net

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.kernel.spread import Spread


@dataclass(frozen=True, slots=True)
class Origin:
    """Data of one source is made into a category at a node.

    Attributes
    ----------
    maker, source
        Vertices.
    category
        That is made.
    path
        A shortest path, vertices, source first, maker last.
    flows
        The flows of the path, one fewer.
    past_leak
        Whether every path goes through a leak of the category (rule S10).
    """

    maker: int
    source: int
    category: str
    path: tuple[int, ...]
    flows: tuple[int, ...]
    past_leak: bool


def origins(spread: Spread, shared: AbstractSet[str] | None = None) -> tuple[Origin, ...]:
    """Return the origins of all that is made on the path, sorted by source, category and maker.

    Parameters
    ----------
    shared
        Names under which a fleet files what no robot has. With them, only what is made on the robot of its source, or
        at what is shared.

    Notes
    -----
    One search per source and one per category that is made of its data: O(flows) each, with ``shared`` O(flows of the
    robot). Nothing is searched where nothing is made.

    Examples
    --------
    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> (origin,) = origins(spread(*factory()))
    >>> origin.category, [NAMES[vertex] for vertex in origin.path]
    ('FaceTemplate', ['/camera', '/video', '/face_id'])
    """
    if not spread.made_categories:
        return ()
    net, elements = Net.of(spread), spread.graph.elements
    sources = sorted(vertex for vertex in spread.facts if spread.begins(vertex))
    stops = {category: _stop(spread, category) for category in sorted(spread.made_categories)}
    if shared is None:
        return tuple(origin for source in sources for origin in _of(net, source, stops))
    units = Units(net, shared, [(spread.all_bits, stop) for stop in ({}, *stops.values())])
    return tuple(
        origin
        for source in sources
        for origin in _of(units.near(source, ()), source, stops)
        if elements[origin.maker].robot in {elements[source].robot, *shared}
    )


def pairs_at_most(spread: Spread) -> int:
    """Return a number that (maker, source) of one category cannot exceed; a search finds out how many there are.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> pairs_at_most(spread(*factory()))  # a camera, and what makes face templates
    1
    """
    category = spread.bits.category
    makers = Counter(number for pairs in spread.derives.values() for number in {category(made) for _, made in pairs})
    sources = sum(1 for vertex in spread.facts if spread.begins(vertex))
    return sources * max((makers[number] for number in spread.made_categories), default=0)


def _stop(spread: Spread, category: int) -> dict[int, int]:
    """The leaks of a category, which a search past none of them stops at."""
    both = spread.bits.pair(category)
    return {vertex: bits & both for vertex, bits in spread.leaks.items()}


def _of(net: Net, source: int, stops: Mapping[int, Mapping[int, int]]) -> Iterator[Origin]:
    """The origins of one source; ``stops`` are the leaks of each category that is made."""
    spread = net.spread
    whole = search(net, [source], spread.all_bits, {})
    for number, stop in stops.items():
        category = spread.categories[number]
        both = spread.forms_of(category)
        if not _can_make(spread, whole, both):
            continue
        # Where the category also arrives ready-made through a leak, only the search past no leak shows that it is made.
        makers = _makers(whole, both)
        free = search(net, [source], spread.all_bits, stop)
        not_past = _makers(free, both)
        for maker in sorted(makers.keys() | not_past.keys()):
            past = maker not in not_past
            path = path_to(net, whole, maker, makers[maker]) if past else path_to(net, free, maker, not_past[maker])
            vertices = tuple(vertex for _, vertex, _ in path)
            yield Origin(maker, source, category, vertices, tuple(flow for flow, _, _ in path[1:]), past)


def _can_make(spread: Spread, reach: Search, category_bits: int) -> bool:
    """Whether anything arrives of which a category is made, also where that arrives ready-made as well."""
    return any(
        category_bits >> made & 1 and reach.arrived_bits.get(vertex, 0) >> of & 1
        for vertex, pairs in spread.derives.items()
        for of, made in pairs
    )


def _makers(reach: Search, category_bits: int) -> dict[int, int]:
    """Vertex -> the bit of which it makes a category, where it does; to pseudonymise makes nothing new."""
    makers: dict[int, int] = {}
    for vertex, left in reach.leaving.items():
        for bits, origin in left:
            if bits & category_bits and origin is not None and origin != START and not category_bits >> origin & 1:
                makers.setdefault(vertex, origin)
    return makers
