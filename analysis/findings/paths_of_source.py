"""Further paths of the findings of one source (the paper, section II-B; rule S10).

In: the source's searches. Out: ``FurtherPaths`` to each leak. Where they are only counted, one walk serves all
categories that nothing is made into: each step is looked at once, with the categories that take it.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.further_paths import Between, FurtherPaths, further, number_disjoint
from rosprivacy.analysis.kernel.states import States
from rosprivacy.analysis.modes import Paths

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from typing import Any

    from rosprivacy.analysis.bounds import Tally
    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.states import Net

BEGIN = -1  # in place of the source's vertex, for what it emits


class PathsOfSource:
    """The further paths of one source's findings.

    Parameters
    ----------
    memory
        Answers for equal graphs.
    asked, most, work
        As of ``further``.
    """

    def __init__(self, net: Net, source: int, memory: dict[Any, Any], asked: str, most: int, work: Tally) -> None:
        self._net, self._source, self._memory = net, source, memory
        self._asked, self._most, self._work = asked, most, work
        self._counted: dict[int, NumberOfPaths] = {}  # by search
        self._between: dict[tuple[int, int], Between] = {}  # by search and category

    def to(self, leak: int, category: int, reach: Search, stop: Mapping[int, int]) -> FurtherPaths:
        """Return those to a leak.

        Parameters
        ----------
        category
            Its number.
        reach, stop
            The search that they lie in, which is kept as long as this is, and what it did not follow.
        """
        spread = self._net.spread
        made = category in spread.made
        if self._asked == Paths.witness and not made and not self._net.meetings:
            if id(reach) not in self._counted:
                self._counted[id(reach)] = NumberOfPaths(self._net, reach, self._source, stop, self._work)
            return FurtherPaths(self._counted[id(reach)].to(leak, category))
        if (id(reach), category) not in self._between:
            relevant = spread.all_bits if made else spread.bits.both(category)  # all, for simplicity
            between = Between(self._net, reach, self._source, category, relevant, stop)
            self._between[id(reach), category] = between
        return further(self._between[id(reach), category], leak, self._memory, self._asked, self._most, self._work)


class NumberOfPaths:
    """How many paths share no flow, of all categories that nothing is made into; no two wildcards meet.

    Parameters
    ----------
    reach
        A search from the source.
    stop
        Vertex -> bits that it did not follow from there.
    work
        Counts the steps.

    Examples
    --------
    >>> from rosprivacy.analysis.bounds import BOUNDS, Tally
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
    >>> from rosprivacy.analysis.kernel.search import search
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> reach, work = search(net, [CAMERA], net.spread.all_bits, {}), Tally(BOUNDS, "path_steps")
    >>> NumberOfPaths(net, reach, CAMERA, {}, work).to(ARCHIVE, net.spread.categories.index("Video"))
    1
    """

    def __init__(self, net: Net, reach: Search, source: int, stop: Mapping[int, int], work: Tally) -> None:
        self._work = work
        self._into: dict[int, dict[int, int]] = defaultdict(dict)  # vertex -> the one before -> categories
        self._led: tuple[int, dict[int, list[tuple[int, int]]]] = BEGIN, {}  # the last leak; categories -> their steps
        self._known: dict[tuple[int, ...], int] = {}
        merged = net.spread.bits.merged
        for before, after, bits in _steps(net, reach, source, stop):
            befores = self._into[after]
            befores[before] = befores.get(before, 0) | merged(bits)
            work.count += 1
        self._first = [befores[BEGIN] for befores in self._into.values() if BEGIN in befores]

    def to(self, leak: int, category: int) -> int:
        """Return how many of a category get to a leak, by its number; at least one does."""
        ends = self._first, self._into[leak].values()
        self._work.count += sum(map(len, ends))
        if 1 in (sum(categories >> category & 1 for categories in end) for end in ends):
            return 1  # a step that all share
        if self._led[0] != leak:
            self._led = leak, self._leading_to(leak)
            self._work.count += sum(map(len, self._led[1].values()))
        some = self._led[1]
        alike = tuple(categories for categories in some if categories >> category & 1)
        if (leak, *alike) not in self._known:
            steps = [step for categories in alike for step in some[categories]]
            self._work.count += len(steps)
            self._known[leak, *alike] = number_disjoint(steps, BEGIN, leak, self._work)
        return self._known[leak, *alike]

    def _leading_to(self, leak: int) -> dict[int, list[tuple[int, int]]]:
        """The steps from which a leak can be reached, by the categories that do."""
        led = {leak: -1}  # vertex -> categories that get on to the leak
        waiting = {leak: -1}
        while waiting:
            vertex = next(iter(waiting))
            new = waiting.pop(vertex)
            for before, categories in self._into.get(vertex, {}).items():
                if more := categories & new & ~led.get(before, 0):
                    led[before] = led.get(before, 0) | more
                    waiting[before] = waiting.get(before, 0) | more
        steps: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for vertex, on in led.items():
            for before, categories in self._into.get(vertex, {}).items():
                if categories & on:
                    steps[categories & on].append((before, vertex))
        return steps


def _steps(net: Net, reach: Search, source: int, stop: Mapping[int, int]) -> Iterator[tuple[int, int, int]]:
    """The steps of data, with its bits; what comes back to the source as what it emits anyway ends there."""
    spread = net.spread
    allowed = spread.all_bits & ~sum(map(spread.bits.both, spread.made))
    states = States(net, allowed, stop)
    begun = spread.bits.in_both_forms(states.emitted(source) & spread.bits.planes(allowed)[0])
    for _, target, bits in (*states.after_alone(source, states.emitted(source)), *states.single(source)):
        yield BEGIN, target, bits
    for vertex, seen in reach.seen.items():
        new, single = (seen & ~begun, spread.flow_emits) if vertex == source else (seen, {})
        leaving = states.leaving(vertex, new & allowed)
        for index, target, passing in net.flows.get(vertex, ()) if leaving else ():
            # what a source emits along a flow does not go there a second time
            if bits := leaving & passing & ~single.get(index, 0):
                yield vertex, target, bits
