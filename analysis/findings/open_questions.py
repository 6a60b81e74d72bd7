"""What needs a person's judgement: elements that a category reaches and that no label covers (rule S11).

In: a spread. Out: open questions in the order of review. The frontier is found by the same search as paths are, with
open nodes and leaks of the category as ends.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import OpenQuestion
from rosprivacy.analysis.kernel.search import from_sources, present, search

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.kernel.states import Net

NOTHING: Mapping[int, tuple[str, ...]] = MappingProxyType({})


def open_questions(net: Net, mask: int, unknown: Mapping[int, tuple[str, ...]] = NOTHING) -> tuple[OpenQuestion, ...]:
    """Return the elements that a category reaches and no label covers, in the order of review.

    Parameters
    ----------
    net
        Of a spread.
    mask
        Bits of the categories that the answer is about.
    unknown
        Vertex -> what has to be known of it and is not stated (``non_ros.unanswered``): open for all that gets there.

    Returns
    -------
    tuple of OpenQuestion
        Nodes on the frontier first, then by distance and name; O(flows) for each category that others are made into,
        and once for all the rest.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> [(question.element.name, question.distance) for question in open_questions(net, net.spread.all_bits)]
    [('/video', 1), ('/filtered', 3)]
    """
    spread, elements = net.spread, net.spread.graph.elements
    uncovered = open_bits(spread, unknown)
    if not uncovered:
        return ()
    _, nearest = from_sources(spread)
    first = _first(net, nearest.begun, uncovered)
    merged: dict[tuple[str, str, str, str], OpenQuestion] = {}
    levels: dict[tuple[int, int], int] = spread.course.kept("levels", None, dict)
    names = {bits: spread.names(bits & mask) for bits in set(uncovered.values())}
    for vertex, everything in sorted(uncovered.items()):
        element, bits = elements[vertex], everything & mask
        if not bits:
            continue
        if (vertex, bits) not in levels:
            levels[vertex, bits] = nearest.level(vertex, bits) or 0
        frontier = not element.is_channel and bool(first.get(vertex, 0) & bits)
        missing = unknown.get(vertex, ())
        question = OpenQuestion(element, names[everything], levels[vertex, bits], frontier, missing)
        known = merged.get(element.shown_as)  # the other side of a wildcard
        if known:
            categories = tuple(sorted({*known.categories, *question.categories}))
            question = known._replace(categories=categories, distance=min(known.distance, question.distance))
        merged[element.shown_as] = question
    # the elements of a graph are sorted, and so are these; what is alike here stays in that order
    return tuple(sorted(merged.values(), key=lambda q: (not q.frontier, q.distance)))


def open_bits(spread: Spread, unknown: Collection[int]) -> dict[int, int]:
    """Return what is at elements without a label that covers it, or of which something has to be known and is not.

    >>> from rosprivacy.analysis.example import DISK, NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> {NAMES[vertex]: carried.names(bits) for vertex, bits in sorted(open_bits(carried, {DISK}).items())}
    {'disk': ('FaceTemplate', 'Video'), '/filtered': ('Video',), '/video': ('Video',)}
    """
    covered, present = spread.covered, spread.present
    uncovered: dict[int, int] = {}
    for vertex in {*spread.arrives, *spread.leaves}:
        if bits := present(vertex) & ~(0 if vertex in unknown else covered.get(vertex, 0)):
            uncovered[vertex] = bits
    return uncovered


def _first(net: Net, sources: Iterable[int], uncovered: Mapping[int, int]) -> dict[int, int]:
    """Open node -> bits that get there past no other open node, and past no leak of their category.

    One search does for all categories that nothing is made into; each of the others takes one, since what it is made
    of passes its leaks.
    """
    spread = net.spread
    nodes = {v: spread.bits.in_both_forms(b) for v, b in uncovered.items() if not spread.graph.elements[v].is_channel}
    asked = 0
    for bits in nodes.values():
        asked |= bits
    made = sum(map(spread.bits.both, spread.made))
    first: dict[int, int] = dict.fromkeys(nodes, 0)
    for own in [asked & ~made, *(spread.bits.both(i) & asked for i in sorted(spread.made))]:
        if own:
            ends = nodes | {v: nodes.get(v, 0) | there for v, bits in spread.leaks.items() if (there := bits & own)}
            reached = search(net, sources, _becoming(spread, own), ends)
            for vertex, bits in nodes.items():
                if bits & own:
                    first[vertex] |= present(reached, vertex) & own
    return first


def _becoming(spread: Spread, bits: int) -> int:
    """Some bits, and those that they are made of somewhere: nothing else can become one of them on its way."""
    pairs = {pair for there in spread.derives.values() for pair in there}
    found = 0
    while found != bits:
        found = bits
        for before, after in pairs:
            bits |= (bits >> after & 1) << before
    return found
