"""What needs a person's judgement: elements that a category reaches and that no label covers (rule S11).

In: a spread. Out: open questions in the order of review. The frontier is found by the same search as paths are, with
open nodes and leaks as ends.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import OpenQuestion
from rosprivacy.analysis.search import present, search

if TYPE_CHECKING:
    from collections.abc import Collection

    from rosprivacy.analysis.search import Net
    from rosprivacy.analysis.spread import Spread


def open_questions(net: Net, mask: int, unknown: Collection[int] = ()) -> tuple[OpenQuestion, ...]:
    """Return the elements that a category reaches and no label covers, in the order of review.

    Parameters
    ----------
    net
        Of a spread.
    mask
        Bits of the categories that the answer is about.
    unknown
        Vertices whose country has to be known and is not: open for all that gets there.

    Returns
    -------
    tuple of OpenQuestion
        Nodes on the frontier first, then by distance and name; O(flows) for a fixed number of categories.
    """
    found, elements = net.spread, net.spread.graph.elements
    uncovered = open_bits(found, unknown)
    if not uncovered:
        return ()
    sources = [vertex for vertex in found.facts if found.begins(vertex)]
    nearest = search(net, sources, found.all_bits, {})
    first = search(net, sources, found.all_bits, _ends(found, uncovered))
    merged: dict[tuple[str, str, str, str], OpenQuestion] = {}
    for vertex, everything in sorted(uncovered.items()):
        element, bits = elements[vertex], everything & mask
        if not bits:
            continue
        frontier = not element.is_channel and bool(present(first, vertex) & bits)
        missing = ("country",) if vertex in unknown else ()
        question = OpenQuestion(element, found.names(bits), nearest.level(vertex, bits) or 0, frontier, missing)
        known = merged.get(element.shown_as)  # the other side of a wildcard
        if known:
            categories = tuple(sorted({*known.categories, *question.categories}))
            question = replace(known, categories=categories, distance=min(known.distance, question.distance))
        merged[element.shown_as] = question
    return tuple(sorted(merged.values(), key=lambda q: (not q.frontier, q.distance, q.element.sort_key())))


def open_bits(found: Spread, unknown: Collection[int]) -> dict[int, int]:
    """Return what is at elements without a label that covers it, or where it is not known in which country it is."""
    reached = {vertex: found.present(vertex) for vertex in {*found.arrives, *found.leaves}}
    covered = {vertex: bits for vertex, bits in found.covered.items() if vertex not in unknown}
    uncovered = {vertex: bits & ~covered.get(vertex, 0) for vertex, bits in reached.items()}
    return {vertex: bits for vertex, bits in uncovered.items() if bits}


def _ends(found: Spread, uncovered: dict[int, int]) -> dict[int, int]:
    """Leaks and open nodes, beyond which nothing is on the frontier."""
    ends = dict(found.leaks)
    for vertex, bits in uncovered.items():
        if not found.graph.elements[vertex].is_channel:
            ends[vertex] = ends.get(vertex, 0) | bits
    return {vertex: _both_planes(bits, found) for vertex, bits in ends.items() if bits}


def _both_planes(bits: int, found: Spread) -> int:
    """A category that is open or a leak in one plane is so in the other."""
    k = len(found.categories)
    either = (bits | bits >> k) & ((1 << k) - 1)
    return either | either << k
