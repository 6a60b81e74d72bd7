"""Which findings the data of some sources makes, told apart by source: no paths (rules S8, S10).

In: a ``Spread`` and where findings can be. Out: ``Reach``, which can be taken further where more passes.
"""

from __future__ import annotations

from collections import Counter
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.findings.findings import finding_id
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.lanes import Doing, Flood
from rosprivacy.analysis.model import DISCLOSURE

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.kernel.spread import Spread

Key = tuple[str, int, int, int]  # kind, number of the category, source, leak
State = tuple[bool, bool]  # of a finding that is not accepted: whether it stands, whether plain data is in it
Run = tuple[int, int]  # (categories in both forms, all that is followed), to see what gets past no other leak of them


class PlacesOfFindings(NamedTuple):
    """Where each kind of finding can be, and what people accepted there; ``question_bits``: what is asked about."""

    spread: Spread
    concerns: tuple[Concern, ...]
    question_bits: int
    accepts: Callable[[Case], bool] | None

    def vertices(self) -> set[int]:
        """Return all of them."""
        return {
            vertex for concern in self.concerns for vertex, bits in concern.bits.items() if bits & self.question_bits
        }

    def accepted(self, kind: str, source: int, leak: int, bit: int) -> bool:
        """Return whether a person has accepted that a source's data gets there in this form."""
        if self.accepts is None:
            return False
        spread, elements = self.spread, self.spread.graph.elements
        name, from_, to = spread.categories[spread.bits.category(bit)], elements[source], elements[leak]
        form = spread.bits.is_pseudonymised(bit)
        return self.accepts(Case(finding_id(name, from_, to, kind), kind, name, from_, to, form))


class Reach(NamedTuple):
    """What some sources' data gets to, told apart by source: which findings there are, and no paths.

    Attributes
    ----------
    flood
        Wherever it gets.
    past
        (Categories in both forms; where these get past no other leak of them), for what more than one leak lets out.
    """

    places: PlacesOfFindings
    flood: Flood
    past: tuple[tuple[int, Flood], ...]

    @classmethod
    def of(cls, places: PlacesOfFindings, sources: Sequence[int]) -> Reach:
        """Follow the data of some sources."""
        return cls.along(places, Doing.of(places.spread, sources), _runs(places.spread))

    @classmethod
    def along(cls, places: PlacesOfFindings, doing: Doing, runs: Iterable[Run]) -> Reach:
        """Follow what begins anywhere, once for all and once for each run."""
        past = [(own, Flood.of(doing.stopped(_stop(places, doing, own), every))) for own, every in _laned(doing, runs)]
        return cls(places, Flood.of(doing), tuple(past))

    def further(self, now: Spread, vertices: Collection[int], flows: Collection[tuple[int, int, int]]) -> Reach:
        """Return it where some elements and flows let more pass, as another spread says, and nothing lets less."""

        def extended(flood: Flood) -> Flood:
            return flood.further(flood.doing.changed(now), vertices, flows)

        return self._replace(flood=extended(self.flood), past=tuple((own, extended(flood)) for own, flood in self.past))

    @property
    def touched(self) -> set[int]:
        """Where something is new, of one that was taken further."""
        floods = (self.flood, *(flood for _, flood in self.past))
        return {*chain.from_iterable((*flood.arrives, *flood.leaves) for flood in floods)}

    def new(self) -> dict[int, int]:
        """Return what there is at elements to which more gets, or from which it leaves, of one taken further."""
        elements, merged = self.places.spread.graph.elements, self.flood.doing.lanes.merged
        there = {v: merged(bits) for v, bits in self.flood.leaves.items()}
        for vertex, bits in self.flood.arrives.items():
            if not elements[vertex].is_channel:
                there[vertex] = there.get(vertex, 0) | merged(bits)
        return there

    def states(self, vertex: int) -> dict[Key, State]:
        """Return the findings that end at an element."""
        states: dict[Key, State] = {}
        spread, lanes = self.places.spread, self.flood.doing.lanes
        begun = lanes.lane_of(vertex, spread.begins(vertex))
        for concern in self.places.concerns:
            bits = concern.bits.get(vertex, 0) & self.places.question_bits & ~spread.absent_bits.get(vertex, 0)
            if not bits:
                continue
            is_channel = spread.graph.elements[vertex].is_channel  # it takes up only what it carries
            present = self.flood.leaving(vertex) if is_channel else self.flood.present(vertex, begun)
            there = present & lanes.every(bits)
            past = self._past(vertex, begun, there) if concern.kind == DISCLOSURE else there
            for source, arriving in lanes.apart(there):
                standing = past >> lanes.width * lanes.number[source]
                for i in bits_of(spread.bits.merged(arriving)):
                    plain, hidden = spread.bits.forms(i)
                    stands = standing >> plain & 1 or standing >> hidden & 1
                    first = standing if stands else arriving
                    shown = plain if first >> plain & 1 else hidden
                    if not self.places.accepted(concern.kind, source, vertex, shown):
                        states[concern.kind, i, source, vertex] = bool(stands), bool(arriving >> plain & 1)
        return states

    def _past(self, vertex: int, begun: int, arriving: int) -> int:
        """What of the data at a leak got there past no other leak of its category."""
        every = self.flood.doing.lanes.every
        result = arriving
        for own, flood in self.past:
            result &= ~every(own) | flood.present(vertex, begun)
        return result


def _runs(spread: Spread) -> list[Run]:
    """As for findings: once for what nothing makes, of what more than one leak lets out."""
    number = Counter(i for bits in spread.leaks.values() for i in bits_of(spread.bits.merged(bits)))
    return runs_of(spread, (i for i in sorted(number) if number[i] > 1), spread.made_categories)


def runs_of(spread: Spread, categories: Iterable[int], made_categories: Collection[int]) -> list[Run]:
    """Return the runs for some categories: once for all that nothing makes, once for each that something makes.

    Parameters
    ----------
    categories, made_categories
        Numbers of categories; those that others are made into anywhere.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> [tuple(map(carried.planes, run)) for run in runs_of(carried, [0, 1], {0})][0][0]
    (('Video',), ('Video',))
    """
    pair, several = spread.bits.pair, tuple(categories)
    unmade = sum(pair(i) for i in several if i not in made_categories)
    return [
        *([(unmade, unmade)] if unmade else []),
        *((pair(i), spread.all_bits) for i in several if i in made_categories),
    ]


def _laned(doing: Doing, runs: Iterable[Run]) -> Iterator[Run]:
    return ((own, doing.lanes.every(allowed)) for own, allowed in runs)


def _stop(places: PlacesOfFindings, doing: Doing, own: int) -> dict[int, int]:
    """Leak -> what of some categories is not followed on from there, in lanes."""
    leaks = {v: bits & own for v, bits in places.spread.leaks.items() if bits}
    return {v: doing.lanes.every(bits) & ~_accepted(places, doing, v, bits) for v, bits in leaks.items()}


def _accepted(places: PlacesOfFindings, doing: Doing, leak: int, bits: int) -> int:
    """What is accepted at a leak, in the lanes of the sources: it hides nothing behind it (rule S10)."""
    if places.accepts is None:
        return 0
    return sum(
        doing.lanes.lane_of(source, 1 << bit)
        for source in doing.lanes.number
        for bit in bits_of(bits)
        if places.accepted(DISCLOSURE, source, leak, bit)
    )
