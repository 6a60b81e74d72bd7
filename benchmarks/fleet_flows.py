"""The fixpoint on a synthetic fleet against one breadth-first search of scipy's over the same graph.

10,000 robots of 20 nodes and 60 topics, joined by one cloud element: 800,000 elements, 1.8 million flows, 24 kinds of
data. Both sides get the graph in the form that they work on; making that form is no part of either time.
"""

from __future__ import annotations

import tracemalloc
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from measure import Measured, Row, timed
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order

from rosprivacy.analysis.kernel.edges import Edges
from rosprivacy.analysis.kernel.fixpoint import WORD, fixpoint

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]

ROBOTS = 10_000  # of fewer, what the search touches fits into some processors' caches
NODES, TOPICS = 20, 60  # of one robot
NEXT, NEAR = 4, 15  # nodes that come next in the pipeline, and how much rather they subscribe than others
CATEGORIES = 24
LABELLED = 1_000  # sources, and as many sanitizers, of one kind of data in the whole fleet
DERIVING = 2_000  # nodes that make one kind of data of another
CLOUD = 0


@dataclass(frozen=True, slots=True)
class Fleet:
    """Flows between numbered elements, nodes first, and what labels say of them, as ``flow.fixpoint`` takes it.

    Attributes
    ----------
    split
        Number of nodes: channels come after them.
    """

    count: int
    split: int
    sources: Indices
    targets: Indices
    emitted: Bits
    keep: Bits
    derivations: Indices


def fleet(robots: int, seed: int = 1, labelled: int = LABELLED, deriving: int = DERIVING) -> Fleet:
    """Make a fleet.

    Parameters
    ----------
    labelled, deriving
        Sources (and sanitizers) of one kind, and nodes that make one kind of another, in the whole fleet.

    Notes
    -----
    A robot's nodes form a pipeline from sensors to actuators: a topic is mostly read by the one to three nodes that
    come next, now and then by any other. The first topic of a robot goes to the cloud too, the last comes from there.
    As in a real graph, numbers follow names and not the pipeline.
    """
    random = np.random.default_rng(seed)
    split = 1 + robots * NODES
    count = split + robots * TOPICS
    topic = np.arange(robots * TOPICS)
    robot = topic // TOPICS
    place = np.argsort(random.random((robots, NODES)), axis=1) + 1 + np.arange(robots)[:, None] * NODES
    writer = random.integers(0, NODES, len(topic))
    publisher = place[robot, writer]
    publisher[TOPICS - 1 :: TOPICS] = CLOUD
    # The least of exponential times with weights as rates: drawn by weight, without repetition.
    ahead = (np.arange(NODES) - writer[:, None]) % NODES
    times = random.standard_exponential(ahead.shape, np.float32)
    times[ahead == 0] = np.inf
    times[(ahead > 0) & (ahead <= NEXT)] /= NEAR
    readers = np.argpartition(times, range(3), axis=1)[:, :3]
    reading = np.arange(3) < random.integers(1, 4, len(topic))[:, None]
    subscriber, subscribed = place[robot[:, None], readers][reading], np.nonzero(reading)[0]
    uplink = np.arange(robots) * TOPICS + split
    sources = np.concatenate((publisher, subscribed + split, uplink))
    targets = np.concatenate((topic + split, subscriber, np.full(robots, CLOUD)))
    return Fleet(count, split, sources, targets, *_labels(random, count, split, labelled, deriving))


def _labels(
    random: np.random.Generator, count: int, split: int, labelled: int, deriving: int
) -> tuple[Bits, Bits, Indices]:
    """What nodes emit, keep and derive, as ``analysis/kernel/spreading.py`` hands it over: bit i plain, bit i + k
    pseudonymised.

    Every second sanitizer pseudonymises, the others end the kind of data in both planes.
    """
    k = CATEGORIES
    emitted = np.zeros((count, -(-2 * k // WORD)), np.uint64)
    keep = np.full_like(emitted, ~np.uint64(0))
    derivations = []
    share = min(labelled, split // 20)
    for category in range(k):
        nodes = random.choice(np.arange(1, split), 2 * share, replace=False)
        sources, sanitizers = nodes[:share], nodes[share:]
        emitted[sources, category // WORD] |= np.uint64(1) << np.uint64(category % WORD)
        for bit in (category, category + k):
            keep[sanitizers, bit // WORD] &= ~(np.uint64(1) << np.uint64(bit % WORD))
        pseudonymising = sanitizers[::2]
        derivations.append(np.stack(np.broadcast_arrays(pseudonymising, category, category + k), axis=1))
    makers = random.choice(np.arange(1, split), min(deriving, split // 10), replace=False)
    before = random.integers(0, k, len(makers))
    after = (before + random.integers(1, k, len(makers))) % k
    derivations += [np.stack((makers, before, after), axis=1), np.stack((makers, before + k, after + k), axis=1)]
    return emitted, keep, np.concatenate(derivations)


def full_sweeps(fleet: Fleet) -> tuple[Bits, Bits]:
    """Return what arrives at and what leaves each element, by sweeps over all flows until nothing changes.

    The plain definition (rule S8), written without the program's own code: the answer that the fixpoint is held to.
    """
    arrives, leaves = np.zeros_like(fleet.emitted), fleet.emitted.copy()
    vertex, before, after = fleet.derivations.T
    one = np.uint64(1)
    while True:
        np.bitwise_or.at(arrives, fleet.targets, leaves[fleet.sources])
        new = leaves | (arrives & fleet.keep)
        fired = arrives[vertex, before // WORD] >> (before % WORD).astype(np.uint64) & one
        np.bitwise_or.at(new, (vertex, after // WORD), fired << (after % WORD).astype(np.uint64))
        if np.array_equal(new, leaves):
            return arrives, leaves
        leaves = new


def numberings(given: Fleet) -> dict[str, Fleet]:
    """Return the same fleet under other numbers: what the kernel takes depends on where the hub stands."""
    middle = given.split // 2
    others = np.random.default_rng(4)
    nodes, channels = others.permutation(given.split), others.permutation(given.count - given.split) + given.split
    return {
        "the cloud first": given,
        "the cloud in the middle": renumbered(given, _moved(given, middle)),
        "the cloud last of the nodes": renumbered(given, _moved(given, given.split - 1)),
        "numbers at random": renumbered(given, np.concatenate((nodes, channels))),
    }


def _moved(given: Fleet, place: int) -> Indices:
    """Return the new number of each element where the cloud gets a place, and the nodes up to there move down."""
    number = np.arange(given.count)
    number[1 : place + 1] -= 1
    number[CLOUD] = place
    return number


def renumbered(given: Fleet, number: Indices) -> Fleet:
    """Return the fleet with a new number for each element."""
    emitted, keep = np.empty_like(given.emitted), np.empty_like(given.keep)
    emitted[number], keep[number] = given.emitted, given.keep
    derivations = given.derivations.copy()
    derivations[:, 0] = number[derivations[:, 0]]
    return replace(
        given,
        sources=number[given.sources],
        targets=number[given.targets],
        emitted=emitted,
        keep=keep,
        derivations=derivations,
    )


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: the fixpoint against one search, on several numberings, and its memory."""
    first = fleet(ROBOTS)
    for name, given in numberings(first).items():
        bound = 7 if quick else 5 if given is first else 6  # in CI the types are checked beside it
        what = f"fixpoint of {CATEGORIES} kinds of data, {name}"
        yield Row(what, "one scipy BFS", partial(searched, given, 7 if quick else 21), bound)
    if quick:
        return
    yield Row("making the edges beforehand", "making the csr", lambda: made(first))
    yield Row("memory of the fixpoint, per million flows", "", lambda: memory(first))


def _matrix(given: Fleet) -> csr_array:
    # float64 and int32 are what scipy's search works on; other types would be converted in each call.
    ends = given.sources.astype(np.int32), given.targets.astype(np.int32)
    return csr_array((np.ones(len(ends[0])), ends), shape=(given.count, given.count))


def searched(given: Fleet, rounds: int) -> Measured:
    """Time the fixpoint against one search from the hub.

    Raises
    ------
    AssertionError
        If the fixpoint is not the answer of the full sweeps, or if the fleet is no fair ground.
    """
    edges = Edges.of(given.count, given.sources, given.targets, given.split)
    matrix = _matrix(given)
    hub = int(np.bincount(given.sources).argmax())
    reached = breadth_first_order(matrix, hub, return_predecessors=False)
    assert len(reached) > 0.95 * given.count, "the search has to reach nearly all elements"
    expected = full_sweeps(given)
    found = fixpoint(edges, given.emitted.copy(), given.keep, given.derivations)
    for ours, theirs in zip(found, expected, strict=True):
        assert np.array_equal(ours, theirs), "the fixpoint differs from the full sweeps"
    k = np.uint64(CATEGORIES)
    assert (found[1][:, 0] >> k).any(), "both planes have to be in use"
    # Each call gets its own copy of what is emitted: the fixpoint may work in place.
    return timed(
        rounds,
        lambda: fixpoint(edges, given.emitted.copy(), given.keep, given.derivations),
        lambda: breadth_first_order(matrix, hub, return_predecessors=False),
        note=f"{given.count:,} elements, {len(given.sources):,} flows; equal to full sweeps",
    )


def made(given: Fleet) -> Measured:
    """Time the forms that both sides work on, which is no part of the rows above."""
    return timed(7, lambda: Edges.of(given.count, given.sources, given.targets, given.split), lambda: _matrix(given))


def memory(given: Fleet) -> Measured:
    """Measure what one call allocates at most at a time, its answer included, its input not."""
    edges = Edges.of(given.count, given.sources, given.targets, given.split)
    # Bytes per flow are megabytes per million flows.
    return Measured(f"{_peak(edges, given) / len(given.sources):.0f} MB", note="peak of numpy under tracemalloc")


def _peak(edges: Edges, given: Fleet) -> int:
    """Bytes that one call has allocated at most at a time."""
    tracemalloc.start()
    try:
        fixpoint(edges, given.emitted.copy(), given.keep, given.derivations)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
