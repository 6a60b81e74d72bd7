"""Classes of sources at the border of parts, carried to the fixpoint: which of them gets how to which leak (rule S10).

In: what each part says of its sources, and the core. Out: for each class what leaves the border, from which each part
sees what gets to its leaks; and what gets to those of the core. Sources that bring the same to the same places are one
class, so the number of robots does not matter.
"""

from __future__ import annotations

from collections import defaultdict
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.fleet.source_leak_pairs import CategoryRun
from rosprivacy.analysis.kernel.fixpoint import WORD
from rosprivacy.parts import workers
from rosprivacy.parts.border import STOPS, ends_of, how
from rosprivacy.parts.part_patterns import CORE, PartEnd, PartSource

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.fleet.patterns import CountedPattern
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element
    from rosprivacy.parts.border import Class, Core
    from rosprivacy.parts.units import Piece
    from rosprivacy.parts.workers import Brought, Parts, Run

    Bits = NDArray[np.uint64]
    Indices = NDArray[np.int64]


class Classes:
    """Classes of sources, which stand for all that bring the same to the same places; and the sources of the core.

    Attributes
    ----------
    numbers
        Number of a category -> class -> its number.
    counts
        Number of a category -> how many classes and sources of the core it has.
    leaving
        What leaves the border, when all is carried.
    """

    def __init__(
        self, ours: Spread, piece: Piece, middle: Core, ways: Mapping[int, tuple[int, ...]], hierarchy: Hierarchy
    ) -> None:
        self.numbers: dict[int, dict[Class, int]] = {number: {} for number in ways}
        self.counts: dict[int, int] = {}
        self.leaving: dict[Run, Bits] = {}
        self._ours, self._piece, self._middle, self._ways = ours, piece, middle, ways
        self._kinds = workers.kinds_of(piece, ours, hierarchy)
        self._categories = {i: CategoryRun(ours, middle.network, i, some) for i, some in ways.items()}
        self._at: dict[Run, tuple[Bits, Bits]] = {}
        self._brought: dict[Run, Brought] = defaultdict(dict)

    def number(self, listed: Iterable[Sequence[tuple[int, str, int, Class]]]) -> None:
        """Number the classes; sources of the core come after them, each by itself."""
        found: dict[int, set[Class]] = defaultdict(set)
        for some in listed:
            for number, _, _, met in some:
                found[number].add(met)
        for number in self._ways:
            order = sorted(found[number], key=lambda met: (sorted(met[0]), sorted(met[1])))
            self.numbers[number] = {met: i for i, met in enumerate(order)}
            self.counts[number] = len(order) + len(self._categories[number].sources)

    def carry(self, kernels: Parts[workers.Kernel]) -> None:
        """Iterate the classes at the border to the fixpoint."""
        arrived = {(number, stop): self._begin(number, stop=stop) for number in self._ways for stop in STOPS}
        running = {run for run in arrived if self.counts[run[0]]}
        while True:
            for run in running:
                self._at[run] = self._carried(run, arrived[run])
                self.leaving[run] = self._at[run][1][self._middle.border]
            if not running:
                break
            given = {run: self.leaving[run] for run in running}
            before = {run: arrived[run] for run in running}
            ask = partial(workers.classes_carried, leaving=given, before=before, counts=self.counts)
            answers = list(kernels.map(ask).collect())
            for run in sorted(running):
                new = np.bitwise_or.reduce([answer[run][0] for answer in answers])
                self._brought[run] |= first_of(answer[run][1] for answer in answers)
                if not (new & ~arrived[run]).any():
                    running.discard(run)
                arrived[run] = arrived[run] | new
        for number in self._ways:
            for stop in STOPS:
                self.leaving.setdefault((number, stop), np.zeros((len(self._middle.border), 0), np.uint64))

    def own_sources(self) -> list[PartSource]:
        """Return the sources of the core."""
        names, elements = self._ours.categories, self._piece.graph.elements
        return [
            PartSource(names[number], elements[vertex], CORE, len(self.numbers[number]) + i)
            for number, category in self._categories.items()
            for i, vertex in enumerate(category.sources.tolist())
        ]

    def own_ends(self) -> list[PartEnd]:
        """Return the leaks and the like of the core, and how each class gets there."""
        found = []
        elements = self._piece.graph.elements
        for number, category in self._categories.items():
            n = self.counts[number]
            if not n:
                continue
            ends = ends_of(self._ours, number, self._kinds)
            own = np.arange(len(category.sources)) + len(self.numbers[number])
            carried = [self._at[number, stop] for stop in STOPS]
            for kind, codes in how(category, carried, ends, n, category.sources, own).items():
                for row in np.flatnonzero(codes.any(axis=1)).tolist():
                    name, element = self._ours.categories[number], elements[int(ends[kind][row])]
                    found.append(PartEnd(kind, name, element, CORE, codes[row].tobytes()))
        return found

    def bringers(self, groups: Iterable[CountedPattern], sources: Iterable[PartSource]) -> set[str]:
        """Return the units that bring the classes of what is shown to where they get."""
        wanted: dict[tuple[str, Element], set[bool]] = defaultdict(set)
        for group in groups:
            wanted[group.pair.category, group.pair.source] |= set(STOPS)
        found = set()
        for source in sources:
            number = self._ours.categories.index(source.category)
            for stop in wanted.get((source.category, source.element), ()):
                for (_, bit), unit in self._brought[number, stop].items():
                    if bit % self.counts[number] == source.number:
                        found.add(unit)
        return found

    def all_bringers(self) -> set[str]:
        """Return the units that bring any class to where it gets."""
        return {unit for brought in self._brought.values() for unit in brought.values()}

    def _begin(self, number: int, *, stop: bool) -> Bits:
        """Where each class begins: what its sources bring to the border."""
        n, ways = self.counts[number], self._ways[number]
        found = np.zeros((len(self._middle.border), -(-n * len(ways) // WORD)), np.uint64)
        for met, i in self.numbers[number].items():
            for at, place in met[STOPS.index(stop)]:
                word, bit = divmod(n * place + i, WORD)
                found[at, word] |= np.uint64(1 << bit)
        return found

    def _carried(self, run: Run, arrived: Bits) -> tuple[Bits, Bits]:
        number, stop = run
        category, n = self._categories[number], self.counts[number]
        own = np.arange(len(category.sources)) + len(self.numbers[number])
        begun = category.begun(category.sources, own, n)
        begun[self._middle.gates] = arrived
        return category.carried(begun, n, stop=stop)


def first_of(brought: Iterable[Brought]) -> Brought:
    """Return for each bit the first unit, by name."""
    found: Brought = {}
    for some in brought:
        for key, unit in some.items():
            found[key] = min(unit, found.get(key, unit))
    return found
