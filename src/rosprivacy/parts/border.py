"""A part of a graph that is cut at its border: what leaves the border goes in, what gets there goes out (S8, S10).

In: a spread without its fixpoint, and which of its elements are the border. Out: arrays for the kernel, which carries
what leaves the border through the part and says what arrives there. Transfer is monotone and takes unions apart, so
parts that meet only at borders reach the fixpoint of the whole by handing each other such sets until none grows.

Of each category then: pairs of source and leak within a unit, and which classes of sources of other units get to which
leaks. Sources that bring the same forms of a category to the same places of the border are one class: for all that
lies behind the border they are alike. In the units of a part sources share their bits, one for the first source of
each unit, one for the second, …, since nothing gets from unit to unit within the part.

The core, where the parts meet, is the other side: a part whose border are gates before its elements.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.findings.concerns import Arrival, shown_arrivals
from rosprivacy.analysis.fleet.source_leak_pairs import CategoryRun, unpacked
from rosprivacy.analysis.kernel.arrays import GraphArrays
from rosprivacy.analysis.kernel.fixpoint import WORD, fixpoint
from rosprivacy.analysis.model import DISCLOSURE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.kernel.spread import Spread

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]
    Flags = NDArray[np.bool_]
    Codes = NDArray[np.uint8]

Bringer = dict[tuple[int, int], int]  # number in the border, bit -> unit


@dataclass(frozen=True, slots=True)
class PartNetwork:
    """A part for the kernel.

    Attributes
    ----------
    network
        Nothing passes its border.
    border
        Vertices, in the order that all parts agree on.
    unit
        By element: the number of the unit that it belongs to, -1 on the border. Nothing gets from one unit to another
        but through the border.
    exits
        Shape (n, 3), by unit: vertex that hands data to the border, number in the border, unit.
    """

    network: GraphArrays
    border: Indices
    unit: Indices
    exits: Indices

    @classmethod
    def of(cls, spread: Spread, border: Sequence[int], unit: Sequence[int]) -> PartNetwork:
        """Make the arrays; O(flows · log flows)."""
        network = GraphArrays.of(spread)
        number = {vertex: i for i, vertex in enumerate(border)}
        special = {index: network.count + i for i, index in enumerate(network.special)}
        exits = [
            (special.get(index, flow.source), number[flow.target], unit[flow.source])
            for index, flow in enumerate(spread.graph.flows)
            if flow.target in number
        ]
        at = np.array(border, np.int64)
        rows = np.array(exits, np.int64).reshape(-1, 3)
        order = np.argsort(rows[:, 2], kind="stable")
        return cls(network.closed(at), at, np.array(unit, np.int64), rows[order])

    def carried(self, leaving: Bits) -> tuple[Bits, Bits]:
        """Return what arrives at and what leaves each vertex.

        Parameters
        ----------
        leaving
            Shape (border, words): what leaves each element of the border.
        """
        return _carried(self.network, self.border, leaving)

    def bringers(self, leaves: Bits, new: Bits) -> Bringer:
        """Return, for each bit that is new at the border, the first unit that brings it there.

        Parameters
        ----------
        leaves
            What leaves each vertex.
        new
            Shape (border, words).
        """
        brought_by: Bringer = {}
        for at in np.flatnonzero(new.any(axis=1)).tolist():
            exits = self.exits[self.exits[:, 1] == at]
            for word, bits in enumerate(new[at].tolist()):
                brought = leaves[exits[:, 0], word] & np.uint64(bits)
                for bit in range(WORD) if bits else ():
                    if bits >> bit & 1:
                        has = brought >> np.uint64(bit) & np.uint64(1)
                        if has.any():
                            brought_by[at, word * WORD + bit] = int(exits[np.argmax(has), 2])
        return brought_by


@dataclass(frozen=True, slots=True)
class Core:
    """Where the parts meet, for the kernel: elements that are in no part, and gates through which parts hand data in.

    Attributes
    ----------
    gates, border
        Vertices, in the order that all parts agree on: a gate, and the element that it leads to.
    """

    network: GraphArrays
    gates: Indices
    border: Indices

    def carried(self, arrived: Bits) -> tuple[Bits, Bits]:
        """Return what arrives at and what leaves each vertex, when this much arrived at the border: (border, words)."""
        return _carried(self.network, self.gates, arrived)


def _carried(network: GraphArrays, at: Indices, begun: Bits) -> tuple[Bits, Bits]:
    """The fixpoint, when some vertices emit what is given."""
    emitted = network.emitted.copy()
    emitted[at] = begun
    return fixpoint(network.edges, emitted, network.keep, network.derivations)


Met = frozenset[tuple[int, int]]  # number in the border, place of the form: where the data of a source gets to it
Class = tuple[Met, Met]  # on paths without another leak of the category, on all paths
STOPS = (True, False)
NOTHING = np.empty(0, np.int64)
NOT_REACHED = 0  # in place of how data gets somewhere, which is a flag for each ``Arrival``


@dataclass(frozen=True, slots=True)
class Crossing:
    """One category in one part.

    Attributes
    ----------
    forms
        Bits of the spread, as in ``CategoryRun``.
    numbers
        Of the sources of ``category``, within their unit.
    ends
        By kind of finding: vertices of elements of the part, sorted.
    """

    cut: PartNetwork
    category: CategoryRun
    forms: tuple[int, ...]
    numbers: Indices
    ends: Mapping[str, Indices]

    @classmethod
    def of(
        cls, spread: Spread, cut: PartNetwork, number: int, forms: tuple[int, ...], kinds: Sequence[Concern]
    ) -> Crossing:
        """Make ready what all rounds need."""
        category = CategoryRun(spread, cut.network, number, forms)
        return cls(cut, category, forms, _within(cut.unit[category.sources]), ends_of(spread, number, kinds))

    def classes(self) -> dict[int, Class]:
        """Source -> where in the border its data gets to."""
        met: tuple[dict[int, set[tuple[int, int]]], ...] = ({}, {})
        for numbers, sources, n in self._rounds():
            table = self._table(numbers, sources, n)
            for stop, some in zip(STOPS, met, strict=True):
                _, leaves = self.category.carried(self.category.begun(sources, numbers, n), n, stop=stop)
                for at in range(len(self.forms)):
                    exits, number = np.nonzero(unpacked(leaves[self.cut.exits[:, 0]], n * at, n))
                    rows = self.cut.exits[exits]
                    for source, border in zip(table[rows[:, 2], number].tolist(), rows[:, 1].tolist(), strict=True):
                        some.setdefault(source, set()).add((border, at))
        nothing: set[tuple[int, int]] = set()
        return {
            source: (frozenset(met[0].get(source, nothing)), frozenset(met[1].get(source, nothing)))
            for source in self.category.sources.tolist()
        }

    def carried(self, leaving: Bits, n: int, *, stop: bool) -> tuple[Bits, Bits]:
        """Return what arrives at and leaves each vertex of n classes; ``leaving`` has shape (border, words)."""
        emitted = self.category.nothing(n)
        emitted[self.cut.border] = leaving
        return self.category.carried(emitted, n, stop=stop)

    def arriving(self, leaving: tuple[Bits, Bits], n: int) -> dict[str, Codes]:
        """Return, by kind, how the data of each class gets from the border to each end: shape (ends, n).

        Parameters
        ----------
        leaving
            What leaves the border on paths without another leak, and on all paths.
        """
        carried = [self.carried(given, n, stop=stop) for given, stop in zip(leaving, STOPS, strict=True)]
        return how(self.category, carried, self.ends, n)

    def within(self, arriving: Mapping[str, Codes], numbers: Mapping[int, int]) -> Iterator[tuple[str, int, int, int]]:
        """(kind, source, end, how): the pairs of one unit, by paths within it and paths over the border.

        Parameters
        ----------
        arriving
            As above.
        numbers
            Source -> its class.
        """
        of_class = np.full(len(self.cut.unit) + 1, -1, np.int64)
        of_class[list(numbers)] = list(numbers.values())
        for some, sources, n in self._rounds():
            table = self._table(some, sources, n)
            begun = self.category.begun(sources, some, n)
            carried = [self.category.carried(begun, n, stop=stop) for stop in STOPS]
            for kind, own in how(self.category, carried, self.ends, n, sources, some).items():
                ends, codes = self.ends[kind], arriving[kind]
                source = table[self.cut.unit[ends]]  # by end and number within the unit; -1 for none
                klass = of_class[source]
                padded = np.column_stack([codes, np.zeros(len(codes), np.uint8)])
                over = np.take_along_axis(padded, np.where(klass < 0, codes.shape[1], klass), axis=1)
                best = own | over
                best[source < 0] = NOT_REACHED
                for end, number in zip(*np.nonzero(best), strict=True):
                    yield kind, int(source[end, number]), int(ends[end]), int(best[end, number])

    def _rounds(self) -> Iterator[tuple[Indices, Indices, int]]:
        """(number within the unit, less those of the rounds before; source) of so many as one run takes; and n."""
        if not len(self.numbers):
            return
        at_once = self.category.at_once()
        for start in range(0, int(self.numbers.max()) + 1, at_once):
            here = (self.numbers >= start) & (self.numbers < start + at_once)
            yield self.numbers[here] - start, self.category.sources[here], int(self.numbers[here].max()) - start + 1

    def _table(self, numbers: Indices, sources: Indices, n: int) -> Indices:
        """The source by unit and number; -1 for none, also in the row of what is no unit."""
        table = np.full((int(self.cut.unit.max(initial=-1)) + 2, n), -1, np.int64)
        table[self.cut.unit[sources], numbers] = sources
        return table


def _within(units: Indices) -> Indices:
    """Number those of each unit, from 0 on."""
    order = np.argsort(units, kind="stable")
    begins = np.flatnonzero(np.diff(units[order], prepend=-2))
    lengths = np.diff(begins, append=len(units))
    numbers = np.empty(len(units), np.int64)
    numbers[order] = np.arange(len(units)) - np.repeat(begins, lengths)
    return numbers


def ends_of(spread: Spread, number: int, kinds: Sequence[Concern]) -> dict[str, Indices]:
    """Return, by kind of finding, the vertices where data of a category ends in one; sorted.

    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.findings.concerns import concerns
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> carried = spread(graph, bound, hierarchy)
    >>> ends = ends_of(carried, carried.categories.index("Video"), tuple(concerns(carried, bound, hierarchy)))
    >>> {kind: [NAMES[vertex] for vertex in vertices] for kind, vertices in ends.items() if len(vertices)}
    {'disclosure': ['/archive'], 'storage-limitation': ['disk']}
    """
    both = spread.forms_of(spread.categories[number])
    ends = {concern.kind: concern.taken_up(spread).items() for concern in kinds}
    return {kind: np.array(sorted(v for v, bits in some if bits & both), np.int64) for kind, some in ends.items()}


def how(
    category: CategoryRun,
    carried: Sequence[tuple[Bits, Bits]],
    ends: Mapping[str, Indices],
    n: int,
    sources: Indices = NOTHING,
    numbers: Indices = NOTHING,
) -> dict[str, Codes]:
    """Return how data gets to the ends of each kind; only disclosures are dismissed (rule S10).

    Parameters
    ----------
    carried
        What arrives at and leaves each vertex, in the order of ``STOPS``.
    sources, numbers
        Those whose own data counts, too.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.kernel.arrays import GraphArrays
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> video, one = carried.categories.index("Video"), np.array([0])
    >>> run = CategoryRun(carried, GraphArrays.of(carried), video, carried.bits.forms(video))
    >>> runs = [run.carried(run.begun(run.sources, one, 1), 1, stop=stop) for stop in STOPS]
    >>> codes = how(run, runs, {DISCLOSURE: np.array([ARCHIVE])}, 1)
    >>> forms_of(int(codes[DISCLOSURE][0, 0]))
    ((False, True, False),)
    """

    def flags_at(number: int, at: Indices) -> tuple[Flags, Flags]:
        flags = category.arriving(*carried[number], at, n, stop=STOPS[number])
        return category.brought(flags, at, sources, numbers)

    codes = {}
    for kind, at in ends.items():
        through = flags_at(1, at)
        codes[kind] = _codes_of(flags_at(0, at) if kind == DISCLOSURE else through, through)
    return codes


def _codes_of(free: tuple[Flags, Flags], through: tuple[Flags, Flags]) -> Codes:
    """How data gets there, without what changes nothing about it."""
    codes = np.zeros(free[0].shape, np.uint8)
    for arrival, flags in zip(Arrival, shown_arrivals(*free, *through), strict=True):
        codes[flags] |= 1 << arrival
    return codes


def forms_of(how: int) -> tuple[tuple[bool, bool, bool], ...]:
    """Return (dismissed, pseudonymised, beside) of the findings that a code means (rule S10).

    >>> forms_of(1 << Arrival.PSEUDONYMISED | 1 << Arrival.PLAIN_THROUGH)
    ((False, True, False), (True, False, True))
    """
    flags = shown_arrivals(*np.array([how >> arrival & 1 for arrival in Arrival], bool))
    shown = [arrival for arrival, flag in zip(Arrival, flags, strict=True) if flag]
    return tuple((one.dismissed, one.pseudonymised, number > 0) for number, one in enumerate(shown))
