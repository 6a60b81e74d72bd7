"""Robots that meet others at what a fleet shares only: which of them a search from one robot has to look at.

In: a ``Net`` of a fleet, and the names under which the fleet files what no robot has. Out: for a source, a ``Net`` of
its own robot, of what is shared, and of the few robots through which data gets from one shared element to another.

A *unit* is all robots that are joined by more than shared elements outside ROS: by flows from one to another, or by a
DDS domain. What a source brings to a shared element goes on from there as anybody's does, so the ways from there are
searched once for all sources, and a search from one robot does not go through all others. A fleet of n robots joined
by a cloud takes n searches of one robot each, not n of the fleet.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.search import path_to, present, search
from rosprivacy.analysis.model import NON_ROS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.states import Move, Net

    Stops = Sequence[tuple[int, Mapping[int, int]]]  # of the searches to come: allowed bits, and where which stop

SHARED = -1  # in place of the unit of an element that is shared


class Units:
    """The units of a fleet.

    Parameters
    ----------
    shared
        Names under which elements are filed that no robot has.
    stops
        Of all searches that will be made: a net holds a shortest way of each.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))  # one robot, which shares nothing
    >>> near = Units(net, frozenset(), [(net.spread.all_bits, {})]).near(CAMERA, ())
    >>> near.flows == dict(net.flows)
    True
    """

    def __init__(self, net: Net, shared: AbstractSet[str], stops: Stops) -> None:
        self._net, self._stops = net, stops
        self._unit = _units(net, shared)
        self._borders = [vertex for vertex, unit in enumerate(self._unit) if unit == SHARED]
        self._by_unit: dict[int, list[int]] = defaultdict(list)  # unit -> its vertices that anything leaves
        for vertex in net.flows:
            if self._unit[vertex] != SHARED:
                self._by_unit[self._unit[vertex]].append(vertex)
        self._onward: dict[int, dict[int, list[Move]]] = {}  # shared element -> unit -> its flows there
        for border in self._borders:
            to_units: dict[int, list[Move]] = defaultdict(list)
            for move in net.flows.get(border, ()):
                to_units[self._unit[move[1]]].append(move)
            self._onward[border] = to_units
        self._mixed = _mixed(net)
        self._searches: dict[tuple[int, int, int], Search] = {}  # by place in ``stops``, shared element and bits
        self._between: dict[tuple[int, int], frozenset[int]] = {}  # by shared element and bit

    def near(self, source: int, leaks: Iterable[int]) -> Net:
        """Return a net that has a shortest way from a source to each of some leaks, if the whole net has one.

        Notes
        -----
        O(flows of the unit, of those of the leaks and of those between shared elements); and once for each shared
        element and bit O(flows).
        """
        units = {self._unit[vertex] for vertex in (source, *leaks)}
        local = self._net_of(units)
        allowed, stop = self._stops[0]
        reach = search(local, [source], allowed, stop)
        further: set[int] = set()
        for border in self._borders:
            for bit in bits_of(reach.left_bits.get(border, 0)):
                further |= self._units_between(border, bit)
        return local if further <= units else self._net_of(units | further)

    def _net_of(self, units: AbstractSet[int]) -> Net:
        """The part of the net that some units and what is shared are."""
        flows = {vertex: self._net.flows[vertex] for unit in sorted(units) for vertex in self._by_unit.get(unit, ())}
        for border in self._borders:
            onward = self._onward[border]
            some = [move for unit in {SHARED, *units} & onward.keys() for move in onward[unit]]
            if some:
                flows[border] = sorted(some)
        return self._net._replace(flows=flows)

    def _units_between(self, border: int, bit: int) -> frozenset[int]:
        """The units on a shortest way from a shared element, where a bit leaves it, to each other, in each form."""
        if (border, bit) not in self._between:
            units: set[int] = set()
            for number in range(len(self._stops)):
                reach = self._from_border(number, border, bit)
                follows = self._mixed.get(bit, 1 << bit)
                for other in self._borders:
                    for there in bits_of(present(reach, other) & follows):
                        way = path_to(self._net, reach, other, there)
                        units.update(self._unit[vertex] for _, vertex, _ in way)
            self._between[border, bit] = frozenset(units - {SHARED})
        return self._between[border, bit]

    def _from_border(self, number: int, border: int, bit: int) -> Search:
        """The search from a shared element; one for all bits that turn into no other."""
        spread = self._net.spread
        bits = 1 << bit if bit in self._mixed else spread.all_bits & ~sum(1 << mixed for mixed in self._mixed)
        key = number, border, bits
        if key not in self._searches:
            allowed, stop = self._stops[number]
            self._searches[key] = search(self._net, [border], allowed, stop, {border: bits & allowed})
        return self._searches[key]


def _mixed(net: Net) -> dict[int, int]:
    """Bit -> the bits that it can turn into, itself too; of bits that turn into others, or are made of others."""
    steps = {step for steps in net.spread.derives.values() for step in steps}
    mixed = {bit: 1 << bit for step in steps for bit in step}
    grown = True
    while grown:
        grown = False
        for before, after in steps:
            if mixed[after] & ~mixed[before]:
                mixed[before] |= mixed[after]
                grown = True
    return mixed


def _units(net: Net, shared: AbstractSet[str]) -> list[int]:
    """The unit of each vertex."""
    elements = net.spread.graph.elements
    is_shared = [element.robot in shared and element.kind in NON_ROS for element in elements]
    first: dict[str, str] = {}

    def root(name: str) -> str:
        while (above := first.setdefault(name, name)) != name:
            first[name] = first[above]
            name = above
        return name

    def join(vertices: Iterable[int]) -> None:
        names = {elements[vertex].robot for vertex in vertices if not is_shared[vertex]}
        roots = sorted(map(root, names))
        first.update(dict.fromkeys(roots, roots[0]) if roots else {})

    for vertex, moves in net.flows.items():
        if not is_shared[vertex]:
            here = elements[vertex].robot
            for _, target, _ in moves:
                if elements[target].robot != here:
                    join((vertex, target))
    for meeting in {id(one): one for some in net.meetings.values() for one in some}.values():
        join((*meeting.written, *meeting.read))
    numbers: dict[str, int] = {}
    return [
        SHARED if flag else numbers.setdefault(root(element.robot), len(numbers))
        for element, flag in zip(elements, is_shared, strict=True)
    ]
