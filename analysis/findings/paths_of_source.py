"""Further paths of the findings of one source (the paper, section II-B; rule S10).

In: the source's searches. Out: ``FurtherPaths`` to each leak. Where they are only counted, one walk serves all
categories that nothing is made into: each step is looked at once, with the categories that take it.
"""

from __future__ import annotations

from collections import OrderedDict, defaultdict
from functools import cache
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.disjoint_in_groups import number_in_groups
from rosprivacy.analysis.findings.further_paths import Between, FurtherPaths, further, number_disjoint
from rosprivacy.analysis.kernel.states import States
from rosprivacy.analysis.modes import Paths

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping
    from typing import Any

    from rosprivacy.analysis.bounds import Tally
    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.states import Net
    from rosprivacy.analysis.many_flows import Meeting

Kinds = tuple[tuple[int, ...], tuple[tuple[tuple[int, ...], tuple[int, ...]], ...]]  # of steps; of groups
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

    def __init__(self, net: Net, source: int, memory: dict[Any, Any], detail: str, bound: int, work: Tally) -> None:
        self._net, self._source, self._memory = net, source, memory
        self._detail, self._bound, self._work = detail, bound, work
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
        made = category in spread.made_categories
        if self._detail == Paths.witness and not made:
            if id(reach) not in self._counted:
                self._counted[id(reach)] = NumberOfPaths(self._net, reach, self._source, stop, self._work)
            return FurtherPaths(self._counted[id(reach)].to(leak, category))
        if (id(reach), category) not in self._between:
            relevant = spread.all_bits if made else spread.bits.pair(category)  # all, for simplicity
            between = Between(self._net, reach, self._source, category, relevant, stop)
            self._between[id(reach), category] = between
        return further(self._between[id(reach), category], leak, self._memory, self._detail, self._bound, self._work)


class NumberOfPaths:
    """How many paths share no flow, of all categories that nothing is made into.

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
        self._led: tuple[int, _Led] = BEGIN, _Led({}, [])  # the last leak, and what leads to it
        self._counts: dict[tuple[int, Kinds], int] = {}
        self._steps = cache(lambda vertex: net.spread.bits.merged(net.spread.absorbed(vertex)))
        merged = net.spread.bits.merged
        groups: dict[int, tuple[Meeting, dict[int, int]]] = {}  # by meeting: who sends which categories there
        for before, after, bits in _steps(net, reach, source, stop, groups):
            befores = self._into[after]
            befores[before] = befores.get(before, 0) | merged(bits)
            work.count += 1
        self._first = {after: befores[BEGIN] for after, befores in self._into.items() if BEGIN in befores}
        self._senders = [befores for _, befores in groups.values()]
        self._groups: dict[int, list[int]] = defaultdict(list)  # vertex -> those that it is read from
        for number, (meeting, befores) in enumerate(groups.values()):
            work.count += len(befores) + len(meeting.read)
            for vertex in meeting.read:
                self._groups[vertex].append(number)

    def to(self, leak: int, category: int) -> int:
        """Return how many of a category get to a leak, by its number; at least one does."""
        last = self._last(leak)
        self._work.count += len(self._first) + len(last)
        begun, ended = ({v for v, some in ends.items() if some >> category & 1} for ends in (self._first, last))
        if 1 in (len(begun), len(ended)):
            return 1  # a step that all share
        # some paths of the most that share no step are those of two steps: another one can be led along each instead
        direct = begun & ended
        if len(direct) in (len(begun), len(ended)):
            return len(direct)
        if self._led[0] != leak:
            self._led = leak, self._leading_to(leak, last)
            self._work.count += self._led[1].size
        led = self._led[1].of(category)
        if (leak, led.kinds) not in self._counts:
            self._counts[leak, led.kinds] = len(direct) + self._longer(direct, leak, led)
        return self._counts[leak, led.kinds]

    def _longer(self, direct: Collection[int], leak: int, led: _Led) -> int:
        """How many paths there are beside those of two steps."""
        gone = {*((BEGIN, vertex) for vertex in direct), *((vertex, leak) for vertex in direct)}
        steps = [step for some in led.steps.values() for step in some if step not in gone]
        pairs = (([*chain(*befores.values())], [*chain(*afters.values())]) for befores, afters in led.groups)
        groups = [(befores, afters) for befores, afters in pairs if befores and afters]
        self._work.count += len(steps) + sum(len(befores) + len(afters) for befores, afters in groups)
        if groups:
            return number_in_groups(steps, groups, BEGIN, leak, self._work)
        return number_disjoint(steps, BEGIN, leak, self._work)

    def _last(self, leak: int) -> dict[int, int]:
        """The vertices before a leak, with the categories that come from each."""
        last = dict(self._into.get(leak, {}))
        for number in self._groups.get(leak, ()):
            for vertex, categories in self._senders[number].items():
                if some := categories & self._steps(leak):
                    last[vertex] = last.get(vertex, 0) | some
        return last

    def _leading_to(self, leak: int, last: Mapping[int, int]) -> _Led:
        """The steps from which a leak can be reached, by the categories that do."""
        led = {leak: -1}  # vertex -> categories that get on to the leak
        waiting = OrderedDict({leak: -1})  # the first key of a dict is found past all that were taken out
        met: dict[int, int] = defaultdict(int)  # group -> categories of which all that send them are found

        def add_found(befores: Mapping[int, int], new: int) -> None:
            for before, categories in befores.items():
                if more := categories & new & ~led.get(before, 0):
                    led[before] = led.get(before, 0) | more
                    waiting[before] = waiting.get(before, 0) | more

        while waiting:
            vertex, new = waiting.popitem(last=False)
            add_found(last if vertex == leak else self._into.get(vertex, {}), new)
            for number in self._groups.get(vertex, ()) if vertex != leak else ():
                more = new & self._steps(vertex) & ~met[number]
                met[number] |= more
                add_found(self._senders[number] if more else {}, more)
        steps: dict[int, list[tuple[int, int]]] = defaultdict(list)
        afters: dict[int, dict[int, list[int]]] = defaultdict(lambda: defaultdict(list))
        for vertex, on in led.items():
            for before, categories in (last if vertex == leak else self._into.get(vertex, {})).items():
                if categories & on:
                    steps[categories & on].append((before, vertex))
            for number in self._groups.get(vertex, ()) if vertex != leak else ():
                if some := on & self._steps(vertex):
                    afters[number][some].append(vertex)
        return _Led(steps, [(_by_value(self._senders[number]), of) for number, of in afters.items()])


class _Led(NamedTuple):
    """What leads to a leak: by the categories, steps, and groups of all before with all after."""

    steps: Mapping[int, list[tuple[int, int]]]
    groups: list[tuple[Mapping[int, list[int]], Mapping[int, list[int]]]]

    @property
    def size(self) -> int:
        """How many there are of steps, and of members of groups."""
        members = (vertices for pair in self.groups for of in pair for vertices in of.values())
        return sum(map(len, self.steps.values())) + sum(map(len, members))

    @property
    def kinds(self) -> Kinds:
        """The sets of categories: two categories in the same ones take the same paths."""
        return tuple(self.steps), tuple((tuple(befores), tuple(afters)) for befores, afters in self.groups)

    def of(self, category: int) -> _Led:
        """Return what one category takes."""

        def of_category(by_categories: Mapping[int, list[Any]]) -> dict[int, list[Any]]:
            return {some: of for some, of in by_categories.items() if some >> category & 1}

        return _Led(
            of_category(self.steps), [(of_category(befores), of_category(afters)) for befores, afters in self.groups]
        )


def _by_value(categories: Mapping[int, int]) -> dict[int, list[int]]:
    vertices: dict[int, list[int]] = defaultdict(list)
    for vertex, some in categories.items():
        vertices[some].append(vertex)
    return vertices


def _steps(
    net: Net, reach: Search, source: int, stop: Mapping[int, int], groups: dict[int, tuple[Meeting, dict[int, int]]]
) -> Iterator[tuple[int, int, int]]:
    """The steps of data, with its bits; what comes back to the source as what it emits anyway ends there.

    What is sent to all that a meeting reads is put into the groups; but for what the source emits.
    """
    spread = net.spread
    allowed = spread.all_bits & ~sum(map(spread.bits.pair, spread.made_categories))
    states = States(net, allowed, stop)
    emitted = states.emitted(source)
    begun = spread.bits.in_both_forms(emitted & spread.bits.planes(allowed)[0])
    for _, target, bits in (*states.after_alone(source, emitted), *states.single(source)):
        yield BEGIN, target, bits
    for meeting in net.meetings.get(source, ()) if emitted else ():
        yield from ((BEGIN, target, bits) for target in meeting.read if (bits := emitted & spread.absorbed(target)))
    for vertex, seen in reach.arrived_bits.items():
        new, single = (seen & ~begun, spread.flow_emits) if vertex == source else (seen, {})
        leaving = states.leaving(vertex, new & allowed)
        for index, target, passing in net.flows.get(vertex, ()) if leaving else ():
            # what a source emits along a flow does not go there a second time
            if bits := leaving & passing & ~single.get(index, 0):
                yield vertex, target, bits
        for meeting in net.meetings.get(vertex, ()) if leaving else ():
            groups.setdefault(id(meeting), (meeting, {}))[1][vertex] = spread.bits.merged(leaving)
