"""What the parts of a fleet say of sources and leaks -> patterns, as ``fleet/patterns_of_pairs.py`` makes them of one
graph (rule S10).

In: pairs within units; and between units, which class of sources gets how to which leak, so that pairs are counted and
not made one by one. Out: groups with one pair each to show, and how each robot takes part.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.fleet.patterns import Count, Form, Pair, Tallies
from rosprivacy.parts.border import forms_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Element

CORE = ""  # in place of the name of a unit


@dataclass(frozen=True, slots=True)
class Within:
    """A pair of one unit; ``how`` is a code of ``border.py``, of one finding or of two that stand beside each other."""

    kind: str
    category: str
    source: Element
    leak: Element
    how: int


@dataclass(frozen=True, slots=True)
class PartSource:
    """A source with its unit, and the number of its class among those of the category."""

    category: str
    element: Element
    unit: str
    number: int


@dataclass(frozen=True, slots=True)
class PartEnd:
    """A leak or the like with its unit, and how each class of the category gets there from the border."""

    kind: str
    category: str
    element: Element
    unit: str
    how: bytes


@dataclass(slots=True)
class _Many:
    """Elements of one name on many robots, in order."""

    elements: list[tuple[Element, str]] = field(default_factory=list)
    weights: Counter[str] = field(default_factory=Counter)  # by unit

    def add(self, element: Element, unit: str, weight: int) -> None:
        self.elements.append((element, unit))
        self.weights[unit] += weight

    def apart_from(self, other: _Many) -> Iterator[tuple[Element, str]]:
        """Those that have one of another unit in ``other``; the core is beside itself."""
        several, only = len(other.weights) > 1, next(iter(other.weights), None)
        return (
            (e, unit) for e, unit in self.elements if unit == CORE or several or (only is not None and unit != only)
        )


class Crossed:
    """Puts together what parts say.

    Attributes
    ----------
    examples
        Units: for each class of sources and all leaks of one name the first two, so that each source has one of them
        beside its own.
    tallies
        What is counted.
    """

    def __init__(self, likeness: Likeness) -> None:
        self._likeness = likeness
        self.tallies = Tallies(likeness)
        self.examples: set[str] = set()

    def within(self, pairs: Iterable[Within]) -> None:
        """Take the pairs of units."""
        likeness = self._likeness
        for pair in pairs:
            source, leak = pair.source, pair.leak
            if count := likeness.between(source.robot, leak.robot):
                across = likeness.apart(source, leak)
                for form, beside in _forms(pair.how):
                    some = Pair(pair.kind, pair.category, source, leak, beside)
                    key = self.tallies.add(some, form, Count.of(count, form))
                    self.tallies.share(key, (source.robot,), (leak.robot,), form, across=across)

    def between(self, sources: Iterable[PartSource], ends: Iterable[PartEnd]) -> None:
        """Take all sources and ends, and count the pairs of different units, and those of the core."""
        likeness = self._likeness
        by_class: dict[tuple[str, int], dict[Element, _Many]] = defaultdict(lambda: defaultdict(_Many))
        for source in sorted(sources, key=lambda source: source.element.sort_key()):
            if weight := likeness.weight(source.element.robot):
                many = by_class[source.category, source.number][likeness.alike(source.element)]
                many.add(source.element, source.unit, weight)
        by_end: dict[tuple[str, str, Element, bytes], _Many] = defaultdict(_Many)
        for end in sorted(ends, key=lambda end: end.element.sort_key()):
            if weight := likeness.weight(end.element.robot):
                by_end[end.kind, end.category, likeness.alike(end.element), end.how].add(end.element, end.unit, weight)
        for (kind, category, _, codes), leaks in by_end.items():
            for number, how in enumerate(codes):
                for some in by_class.get((category, number), {}).values() if how else ():
                    for form, beside in _forms(how):
                        self._between(kind, category, form, some, leaks, second=beside)

    def _between(self, kind: str, category: str, form: Form, sources: _Many, leaks: _Many, *, second: bool) -> None:
        both = sum(weight * leaks.weights[unit] for unit, weight in sources.weights.items() if unit != CORE)
        count = sources.weights.total() * leaks.weights.total() - both
        if not count:
            return
        begin, end = list(sources.apart_from(leaks)), list(leaks.apart_from(sources))
        self.examples |= {*list(dict.fromkeys(unit for _, unit in end))[:2]} - {CORE}
        source, unit = begin[0]
        leak = next(element for element, other in end if other != unit or unit == CORE)
        across = self._likeness.is_robot(source.robot) and self._likeness.is_robot(leak.robot)
        pair = Pair(kind, category, source, leak, second)
        where = {element.robot for element, _ in (begin if self._likeness.is_robot(source.robot) else end)}
        key = self.tallies.add(pair, form, Count.of(count, form), where)
        self.tallies.share(key, {e.robot for e, _ in begin}, {e.robot for e, _ in end}, form, across=across)


def _forms(how: int) -> Iterator[tuple[Form, bool]]:
    """The findings that a code means: their form, and whether they stand beside another; nothing is accepted here."""
    for dismissed, pseudonymised, beside in forms_of(how):
        yield Form(dismissed, accepted=False, pseudonymised=pseudonymised), beside
