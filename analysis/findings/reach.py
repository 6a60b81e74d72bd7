"""Which findings and open questions there are, told apart by source, as sets to compare (rules S10, S11).

In: a ``Spread`` and what is asked. Out: ``Reach``, which can be taken further where a change only lets more pass. It
says of each finding whether it is there, whether it stands, and whether plain data is in it: no paths.
"""

from __future__ import annotations

from collections import Counter
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.findings.findings import finding_id
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.lanes import Doing, Flood
from rosprivacy.analysis.model import DISCLOSURE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound

Key = tuple[str, int, int, int]  # kind, number of the category, source, leak
State = tuple[bool, bool]  # of a finding that is not accepted: whether it stands, whether plain data is in it


class Places(NamedTuple):
    """Where each kind of finding can be, and what people accepted there.

    Attributes
    ----------
    asked
        Bits of the categories that the answer is about.
    """

    spread: Spread
    concerns: tuple[Concern, ...]
    asked: int
    accepts: Callable[[Case], bool] | None

    @classmethod
    def of(
        cls,
        spread: Spread,
        bound: Bound,
        hierarchy: Hierarchy,
        asked: int,
        accepts: Callable[[Case], bool] | None = None,
    ) -> Places:
        """Return where findings can be."""
        return cls(spread, tuple(concerns(spread, bound, hierarchy)), asked, accepts)

    def vertices(self) -> set[int]:
        """Return all of them."""
        return {vertex for concern in self.concerns for vertex, bits in concern.bits.items() if bits & self.asked}

    def accepted(self, kind: str, source: int, leak: int, bit: int) -> bool:
        """Return whether a person has accepted that a source's data gets there in this form."""
        if self.accepts is None:
            return False
        spread, elements = self.spread, self.spread.graph.elements
        name = spread.categories[spread.bits.category(bit)]
        from_, to = elements[source], elements[leak]
        return self.accepts(
            Case(finding_id(name, from_, to, kind), kind, name, from_, to, spread.bits.is_pseudonymised(bit))
        )


class Reach(NamedTuple):
    """What some sources' data gets to.

    Attributes
    ----------
    whole
        Wherever it gets.
    past
        (Categories in both forms; where these get past no other leak of them), for what more than one leak lets out.
    """

    places: Places
    whole: Flood
    past: tuple[tuple[int, Flood], ...]

    @classmethod
    def of(cls, places: Places, sources: Sequence[int]) -> Reach:
        """Follow the data of some sources."""
        doing = Doing.of(places.spread, sources)
        past = [(own, Flood.of(doing.stopped(stop, allowed))) for own, stop, allowed in _stops(places, doing)]
        return cls(places, Flood.of(doing), tuple(past))

    def further(self, now: Spread, vertices: Iterable[int], flows: Sequence[tuple[int, int, int]]) -> Reach:
        """Return it where some elements and flows let more pass, as another spread says, and nothing lets less."""
        opened = list(vertices)

        def more(flood: Flood) -> Flood:
            return flood.further(flood.doing.changed(now), opened, flows)

        return self._replace(whole=more(self.whole), past=tuple((own, more(flood)) for own, flood in self.past))

    @property
    def touched(self) -> set[int]:
        """Where something is new, of one that was taken further."""
        floods = (self.whole, *(flood for _, flood in self.past))
        return {*chain.from_iterable((*flood.arrives, *flood.leaves) for flood in floods)}

    def new(self) -> dict[int, int]:
        """Return what there is at elements to which more gets, or from which it leaves, of one taken further."""
        elements, merged = self.places.spread.graph.elements, self.whole.doing.lanes.merged
        there = {v: merged(bits) for v, bits in self.whole.leaves.items()}
        for vertex, bits in self.whole.arrives.items():
            if not elements[vertex].is_channel:
                there[vertex] = there.get(vertex, 0) | merged(bits)
        return there

    def states(self, vertex: int) -> dict[Key, State]:
        """Return the findings that end at an element."""
        found: dict[Key, State] = {}
        spread, lanes = self.places.spread, self.whole.doing.lanes
        begun = lanes.own(vertex, spread.begins(vertex))
        for concern in self.places.concerns:
            bits = concern.bits.get(vertex, 0) & self.places.asked & ~spread.gone.get(vertex, 0)
            if not bits:
                continue
            is_channel = spread.graph.elements[vertex].is_channel  # it takes up only what it carries
            present = self.whole.left(vertex) if is_channel else self.whole.present(vertex, begun)
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
                        found[concern.kind, i, source, vertex] = bool(stands), bool(arriving >> plain & 1)
        return found

    def _past(self, vertex: int, begun: int, there: int) -> int:
        """What of the data at a leak got there past no other leak of its category."""
        every = self.whole.doing.lanes.every
        result = there
        for own, flood in self.past:
            result &= ~every(own) | flood.present(vertex, begun)
        return result


def _stops(places: Places, doing: Doing) -> Iterator[tuple[int, dict[int, int], int]]:
    """(Categories in both forms, where they stop, what is followed): as for findings, once for what nothing makes."""
    spread, every = places.spread, doing.lanes.every
    leaks = {v: spread.bits.merged(bits) for v, bits in spread.leaks.items() if bits}
    number = Counter(i for bits in leaks.values() for i in bits_of(bits))
    several = [i for i in sorted(number) if number[i] > 1]
    unmade = sum(spread.bits.both(i) for i in several if i not in spread.made)
    runs = [(unmade, unmade)] if unmade else []
    runs += [(spread.bits.both(i), spread.all_bits) for i in several if i in spread.made]
    for own, allowed in runs:
        stop = {v: every(spread.leaks[v] & own) & ~_accepted(places, doing, v, spread.leaks[v] & own) for v in leaks}
        yield own, stop, every(allowed)


def _accepted(places: Places, doing: Doing, leak: int, bits: int) -> int:
    """What is accepted at a leak, in the lanes of the sources: it hides nothing behind it (rule S10)."""
    if places.accepts is None:
        return 0
    return sum(
        doing.lanes.own(source, 1 << bit)
        for source in doing.lanes.number
        for bit in bits_of(bits)
        if places.accepted(DISCLOSURE, source, leak, bit)
    )
