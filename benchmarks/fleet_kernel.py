"""Robots that all differ, through the kernel: 1,000 to 100,000 of 80 elements, and pairs of source and leak.

The graphs are those of ``fleet_flows``, with labels that grow with the fleet: 100,000 robots are 8 million elements in
arrays, 18 million flows and 24 kinds of data, each brought in once per robot, and one cloud that joins them all.
"""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from fleet_flows import NODES, fleet, full_sweeps
from measure import Measured, Row, per_robot, side_by_side, timed
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order

from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.fleet.source_leak_pairs import pairs
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.kernel.edges import Edges
from rosprivacy.analysis.kernel.fixpoint import fixpoint
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.model import Bound, Element, Flow, FlowGraph, Method, Place, Statement

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fleet_flows import Fleet
    from numpy.typing import NDArray

    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.kernel.spread import Spread

    Indices = NDArray[np.int64]

LARGE, SMALL = 100_000, 1_000
HERE = Place("fleet.labels.yaml", 1)
KIND = "Video"
HIERARCHY = Hierarchy({KIND: {KIND: 0}}, {KIND: {KIND: 0}})


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: the kernel on a large and a small fleet, its memory, and pairs against searches."""
    large = LARGE // 20 if quick else LARGE
    sizes = large, SMALL
    fleets = [_in_order(fleet(robots, labelled=robots, deriving=2 * robots)) for robots in sizes]
    what = f"per robot, by the kernel: {large:,} that differ"
    yield Row(what, f"{SMALL:,}", lambda: _grown(fleets, sizes, with_edges=True), bound=1.5)
    if not quick:
        yield Row("the same, the fixpoint alone", f"{SMALL:,}", lambda: _grown(fleets, sizes), bound=1.5)
        yield Row(f"memory of the kernel, {large:,} robots, per million flows", "", lambda: _memory(fleets[0]))
    yield Row(
        "pairs of source and leak by the kernel",
        "two scipy searches per source",
        lambda: _pairs(SMALL, rounds=1 if quick else 3),
        bound=0.15 if quick else 0.1,  # one round, beside other work
    )


def _grown(fleets: list[Fleet], sizes: tuple[int, int], *, with_edges: bool = False) -> Measured:
    """Time both fleets.

    Raises
    ------
    AssertionError
        If the small fleet's answer is not that of full sweeps.
    """
    edges = [_edges(some) for some in fleets]
    for found, expected in zip(_fixpoint(edges[1], fleets[1]), full_sweeps(fleets[1]), strict=True):
        assert np.array_equal(found, expected), "the fixpoint differs from the full sweeps"
    # The small one several times in a row, or chance would decide.
    again = (1, max(1, sizes[0] // SMALL // 5))

    def side(i: int) -> None:
        for _ in range(again[i]):
            _fixpoint(_edges(fleets[i]) if with_edges else edges[i], fleets[i])

    seconds = side_by_side(3, lambda: side(0), lambda: side(1))
    size = f"{fleets[0].count:,} elements, {len(fleets[0].sources):,} flows in arrays, every robot another"
    note = f"{size}; edges and fixpoint together" if with_edges else size
    return per_robot(seconds, (sizes[0], SMALL * again[1]), note)


def _memory(given: Fleet) -> Measured:
    """Measure what edges and fixpoint allocate at most, the answer included, their input not."""
    tracemalloc.start()
    _fixpoint(_edges(given), given)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # Bytes per flow are megabytes per million flows.
    return Measured(f"{peak / len(given.sources):.0f} MB", note="peak of numpy under tracemalloc")


def _in_order(some: Fleet) -> Fleet:
    """The same with flows sorted by source and target, as a ``FlowGraph`` has them."""
    order = np.lexsort((some.targets, some.sources))
    return replace(some, sources=some.sources[order], targets=some.targets[order])


def _edges(some: Fleet) -> Edges:
    return Edges.of(some.count, some.sources, some.targets, some.split)


def _fixpoint(edges: Edges, some: Fleet) -> tuple[NDArray[np.uint64], NDArray[np.uint64]]:
    return fixpoint(edges, some.emitted, some.keep, some.derivations)


def _pairs(robots: int, rounds: int) -> Measured:
    """All pairs of one kind of data: by the kernel, and by two searches of scipy's per source.

    Two, since a finding says whether every way goes through another leak: one search stops there, one does not.

    Raises
    ------
    AssertionError
        If pairs are not those of the searches.
    """
    given = fleet(robots)
    random = np.random.default_rng(2)
    picked = random.permuted(np.arange(robots * NODES).reshape(robots, NODES), axis=1) + 1
    sources, leaks, cleaners = picked[:, 0], picked[:, 1], picked[::2, 2]
    found, bound = _labelled(given, sources, leaks, cleaners)
    kinds = tuple(concerns(found, bound, HIERARCHY))
    searched = _searched(given, sources, leaks, cleaners)
    kernel = _by_kernel(found, kinds)
    assert np.array_equal(kernel, searched()), "pairs differ from what searches find"
    size = f"{len(kernel):,} pairs, {given.count:,} elements, {len(given.sources):,} flows"
    note = f"{robots:,} sources and leaks, {size}; making the searches' two matrices is not counted"
    return timed(rounds, lambda: _by_kernel(found, kinds), searched, note=note)


def _labelled(given: Fleet, sources: Indices, leaks: Indices, cleaners: Indices) -> tuple[Spread, Bound]:
    """The same graph as the program has it, with labels; carried to the fixpoint."""
    nodes = [Element("node", f"/{i}") for i in range(given.split)]
    elements = (*nodes, *(Element("topic", f"/{i}") for i in range(given.split, given.count)))
    ends = sorted(set(zip(given.sources.tolist(), given.targets.tolist(), strict=True)))
    graph = FlowGraph(elements, tuple(Flow(a, b, "publish") for a, b in ends), (), ())
    said: dict[int, tuple[Statement, ...]] = {}
    for role, vertices in (("source", sources), ("leak", leaks), ("sanitizer", cleaners)):
        method = Method.DROP if role == "sanitizer" else None
        said |= dict.fromkeys(vertices.tolist(), (Statement(role, (KIND,), (1, 1), HERE, method),))
    bound = Bound(dict(sorted(said.items())))
    return spread(graph, bound, HIERARCHY), bound


def _by_kernel(found: Spread, kinds: tuple[Concern, ...]) -> Indices:
    """Rows of source, leak, dismissed."""
    (part,) = pairs(found, kinds, found.all_bits)
    return np.column_stack((part.sources, part.leaks, part.dismissed))


def _searched(given: Fleet, sources: Indices, leaks: Indices, cleaners: Indices) -> Callable[[], Indices]:
    """What finds the same by searches, made ready."""

    def matrix(closed: Indices) -> csr_array:
        going = ~np.isin(given.sources, closed)
        ends = given.sources[going].astype(np.int32), given.targets[going].astype(np.int32)
        return csr_array((np.ones(len(ends[0])), ends), shape=(given.count, given.count))

    through, free = matrix(cleaners), matrix(np.concatenate((cleaners, leaks)))

    def search() -> Indices:
        rows = []
        is_leak = np.zeros(given.count, bool)
        is_leak[leaks] = True
        for source in sources.tolist():
            anyway, directly = (breadth_first_order(m, source, return_predecessors=False) for m in (through, free))
            got = np.sort(anyway[is_leak[anyway]])
            rows.append(np.column_stack((np.full(len(got), source), got, ~np.isin(got, directly))))
        found = np.concatenate(rows)
        return found[np.lexsort((found[:, 1], found[:, 0]))]

    return search
