"""The border of the parts of a fleet as a small graph: which bit that gets there gets where in the end (rule S8).

In: what each unit, and the core, does with each single bit that comes in. Out: ``Crossroads``, which can be changed
where some units do something else.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.fixpoint import WORD

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

# What comes in or gets out at the border: bit ``number in the border * bits of the spread + bit`` of a number.
Crossings = int
Exits = tuple[Crossings, ...]  # by run
Passes = tuple["Mapping[int, Crossings]", ...]  # by run: one crossing that comes in -> where it gets out


class Beyond(NamedTuple):
    """Where data gets to in the end: what arrives at the border, and what leaves it."""

    arriving: Crossings
    leaving: Crossings


@dataclass(frozen=True, eq=False, repr=False)
class Crossroads:
    """How data goes from unit to unit, in each run.

    Attributes
    ----------
    counts
        By run: what leaves the border -> where units bring it -> how many of them.
    core
        By run: what arrives there -> what leaves it for that.
    """

    counts: tuple[Mapping[int, Counter[Crossings]], ...]
    core: Passes
    _units: tuple[dict[int, Crossings], ...] = field(init=False)
    _ways: dict[tuple[int, Crossings, bool], Beyond] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        """Put together where each crossing gets to through any unit."""
        union = tuple({at: _union(some) for at, some in of_run.items()} for of_run in self.counts)
        object.__setattr__(self, "_units", union)

    @classmethod
    def of(cls, units: Iterable[Passes], core: Passes) -> Crossroads:
        """Put together what units do."""
        counts: tuple[dict[int, Counter[Crossings]], ...] = tuple(defaultdict(Counter) for _ in core)
        for passes in units:
            _count(counts, passes, 1)
        return cls(counts, core)

    def changed(self, units: Sequence[tuple[Passes, Passes]], core: Passes) -> Crossroads:
        """Return the same where units do something else than before, each as (before, now); itself if none does."""
        pairs = [(before, now) for before, now in units if before != now]
        if not pairs and core == self.core:
            return self
        counts = tuple(
            defaultdict(Counter, {at: Counter(some) for at, some in of_run.items()}) for of_run in self.counts
        )
        for before, now in pairs:
            _count(counts, before, -1)
            _count(counts, now, 1)
        return Crossroads(counts, core)

    def beyond(self, exits: Exits, *, of_core: bool) -> tuple[Beyond, ...]:
        """Return where data gets to, run by run.

        Parameters
        ----------
        exits
            Where it gets out of a unit, or of the core.
        """
        return tuple(self._of_run(run, some, of_core=of_core) for run, some in enumerate(exits))

    def _of_run(self, run: int, exits: Crossings, *, of_core: bool) -> Beyond:
        key = run, exits, of_core
        if key not in self._ways:
            arriving, leaving = (0, exits) if of_core else (exits, image(self.core[run], exits))
            new = leaving
            while new:
                coming = image(self._units[run], new) & ~arriving
                arriving |= coming
                new = image(self.core[run], coming) & ~leaving
                leaving |= new
            self._ways[key] = Beyond(arriving, leaving)
        return self._ways[key]


def _count(counts: Sequence[dict[int, Counter[Crossings]]], passes: Passes, number: int) -> None:
    for of_run, some in zip(counts, passes, strict=True):
        for at, out in some.items():
            of_run[at][out] += number


def _union(outs: Mapping[Crossings, int]) -> Crossings:
    found = 0
    for out, number in outs.items():
        found |= out if number > 0 else 0
    return found


def image(passes: Mapping[int, Crossings], crossings: Crossings) -> Crossings:
    """Return where some crossings that come in get out."""
    found = 0
    for crossing in bits_of(crossings):
        found |= passes.get(crossing, 0)
    return found


def crossings_of(rows: NDArray[np.uint64], width: int) -> Crossings:
    """Return the bits of an array, which has a row for each element of the border; ``width`` bits in each."""
    found = 0
    for number, words in enumerate(rows.tolist()):
        for place, word in enumerate(words):
            found |= word << number * width + place * WORD
    return found
