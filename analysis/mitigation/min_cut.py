"""The cheapest set of changes that cuts every path of a network, and how certain it is that none is cheaper.

In: ``CutNetwork`` and ``Candidate``s. Out: ``ChangeSet``s. networkx's minimum cut gives a set of changes, and with the
cost of a change shared among the arcs that it cuts a bound that no set undercuts. Where every change cuts one arc the
two meet: the set is a minimum cut and exact. Where they do not meet (a change that cuts several arcs makes the problem
NP-hard: minimum label cut), a search by hitting sets closes the gap as long as it stays within its budget of steps.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.mitigation.cut_network import BEGIN, END

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    import networkx as nx

    from rosprivacy.analysis.mitigation.candidates import Candidate
    from rosprivacy.analysis.mitigation.cut_network import Arc, CutNetwork

BUDGET = 50_000  # steps of the search, each a choice of one change
DEEPEST = 200  # changes that a search may choose
COMMON_MULTIPLE = 720_720  # parts of a cost; many numbers divide it


@dataclass(frozen=True, slots=True)
class ChangeSet:
    """Some changes that cut every path.

    Attributes
    ----------
    chosen
        Numbers of changes, sorted.
    lower
        No set of the changes that cuts every path costs less.
    sure
        Whether it cuts them by what is certain of the changes; else only a new analysis can tell.
    """

    chosen: tuple[int, ...]
    cost: int
    lower: int
    sure: bool


def cheapest(network: CutNetwork, changes: Sequence[Candidate], budget: int = BUDGET) -> tuple[ChangeSet, ...]:
    """Return cuts, the one to try first coming first; the last is sure. Every path must have an arc that can be cut.

    Notes
    -----
    networkx's maximum flow on the network, twice; then at most ``budget`` steps, each O(arcs) at worst.

    Examples
    --------
    >>> from rosprivacy.analysis.mitigation.candidates import Candidate
    >>> from rosprivacy.analysis.mitigation.cut_network import Arc, CutNetwork
    >>> network = CutNetwork([Arc(BEGIN, 2, 0, flow=5), Arc(BEGIN, 2, 0, flow=6), Arc(2, END, 0, flow=7)])
    >>> changes = [Candidate("deny", cost, flows=frozenset({flow})) for flow, cost in ((5, 10), (6, 10), (7, 15))]
    >>> cheapest(network, changes)
    (ChangeSet(chosen=(2,), cost=15, lower=15, sure=True),)
    """
    if not network.arcs:
        return (ChangeSet((), 0, 0, sure=True),)
    sure = maybe = _Network.of(network.arcs, changes, lambda change, arc: change.cuts(arc))
    if any(change.touched for change in changes):
        maybe = _Network.of(network.arcs, changes, lambda change, arc: change.may_cut(arc))
    certain = sure.without_the_needless(sure.minimum_cut())
    lower = maybe.bound()
    if lower < sure.cost(certain):
        hitting, least = maybe.search(budget)
        lower = max(lower, least)
        if hitting is not None and sure.cuts(hitting):
            certain = hitting
        elif hitting is not None:
            other, _ = sure.search(budget)
            certain = other if other is not None else certain
            if sure.cost(hitting) < sure.cost(certain):
                return tuple(sure.cut(chosen, lower) for chosen in (hitting, certain))
    return (sure.cut(certain, lower),)


@dataclass(slots=True)
class _Network:
    """A network whose arcs know which changes cut them.

    Attributes
    ----------
    arcs
        (tail, head, numbers of the changes that cut it).
    """

    arcs: list[tuple[int, int, tuple[int, ...]]]
    costs: list[int]
    arcs_of: dict[int, int] = field(default_factory=dict)

    @classmethod
    def of(cls, arcs: Iterable[Arc], changes: Sequence[Candidate], cuts: Callable[[Candidate, Arc], bool]) -> _Network:
        by_flow: dict[int, list[int]] = defaultdict(list)
        by_channel: dict[int, list[int]] = defaultdict(list)
        for number, change in enumerate(changes):
            for flow in change.flows | change.touched:
                by_flow[flow].append(number)
            for channel in change.channels:
                by_channel[channel].append(number)
        network = cls([], [change.cost for change in changes])
        for arc in arcs:
            near = (*by_flow.get(arc.flow, ()), *by_channel.get(arc.channel, ()))
            numbers = tuple(number for number in near if cuts(changes[number], arc))
            network.arcs.append((arc.tail, arc.head, numbers))
            for number in numbers:
                network.arcs_of[number] = network.arcs_of.get(number, 0) + 1
        return network

    def cut(self, chosen: frozenset[int], lower: int) -> ChangeSet:
        return ChangeSet(tuple(sorted(chosen)), self.cost(chosen), lower, sure=self.cuts(chosen))

    def cost(self, chosen: Iterable[int]) -> int:
        return sum(self.costs[number] for number in chosen)

    def cuts(self, chosen: frozenset[int]) -> bool:
        """Whether no path is left."""
        return self.cutters(chosen) is None

    def cutters(self, chosen: frozenset[int]) -> frozenset[int] | None:
        """The changes that would cut a path that is left, one with the fewest arcs to cut; None if none is left."""
        ahead: dict[int, list[tuple[int, tuple[int, ...]]]] = defaultdict(list)
        for tail, head, numbers in self.arcs:
            if chosen.isdisjoint(numbers):
                ahead[tail].append((head, numbers))
        came: dict[int, tuple[int, tuple[int, ...]]] = {}
        done: set[int] = set()
        waiting: deque[tuple[int, int, tuple[int, ...]]] = deque([(BEGIN, BEGIN, ())])
        while waiting:
            here, before, numbers = waiting.popleft()
            if here in done:
                continue
            done.add(here)
            came[here] = (before, numbers)
            if here == END:
                return self._on(came)
            for head, cutters in ahead[here]:
                if head not in done:
                    (waiting.append if cutters else waiting.appendleft)((head, here, cutters))
        return None

    def _on(self, came: Mapping[int, tuple[int, tuple[int, ...]]]) -> frozenset[int]:
        cutters: set[int] = set()
        at = END
        while at != BEGIN:
            at, numbers = came[at]
            cutters.update(numbers)
        return frozenset(cutters)

    def without_the_needless(self, chosen: Iterable[int]) -> frozenset[int]:
        """Some changes less those that are not needed, the dearest first."""
        left = frozenset(chosen)
        for number in sorted(left, key=lambda n: (-self.costs[n], n)):
            if self.cuts(left - {number}):
                left -= {number}
        return left

    def minimum_cut(self) -> set[int]:
        """The changes of a minimum cut, each arc of a change costing as much as the change."""
        import networkx as nx  # noqa: PLC0415 - heavy, and only needed where there is something to cut

        graph, named = self._graph(dict.fromkeys(range(len(self.costs)), 1), 1)
        _, (near, _) = nx.minimum_cut(graph, BEGIN, END)
        return {number for (tail, head), number in named.items() if tail in near and head not in near}

    def bound(self) -> int:
        """A bound that no set of changes undercuts: each change shares its cost among the arcs that it cuts."""
        import networkx as nx  # noqa: PLC0415 - as above

        graph, _ = self._graph(self.arcs_of, COMMON_MULTIPLE)
        return -(-int(nx.minimum_cut_value(graph, BEGIN, END)) // COMMON_MULTIPLE)

    def _graph(self, parts: Mapping[int, int], total: int) -> tuple[nx.DiGraph[int], dict[tuple[int, int], int]]:
        """The network for networkx: an arc that several changes cut is as many in a row."""
        import networkx as nx  # noqa: PLC0415 - as above

        graph: nx.DiGraph[int] = nx.DiGraph()
        named: dict[tuple[int, int], int] = {}
        fresh = max(max(tail, head) for tail, head, _ in self.arcs) + 1
        for tail, head, numbers in self.arcs:
            here = tail
            for number in numbers:
                graph.add_edge(here, fresh, capacity=self.costs[number] * total // parts[number])
                named[here, fresh] = number
                here, fresh = fresh, fresh + 1
            graph.add_edge(here, head)  # without a capacity: it cannot be cut
        return graph, named

    def search(self, budget: int) -> tuple[frozenset[int] | None, int]:
        """The cheapest set, and a bound that no set undercuts; None if the budget was spent before it was found."""
        sets: list[frozenset[int]] = []
        least = 0
        while True:
            hitting, budget = _Hitting(sets, self.costs, budget).best()
            if hitting is None:
                return None, least
            least = self.cost(hitting)
            chosen = hitting
            while (cutters := self.cutters(chosen)) is not None:  # as many paths at once as share no change
                sets.append(cutters)
                chosen |= cutters
            if chosen == hitting:
                return hitting, least


class _Hitting:
    """The cheapest set that has a member in each of some sets, by branch and bound."""

    def __init__(self, sets: Sequence[frozenset[int]], costs: Sequence[int], budget: int) -> None:
        self.sets = sorted(set(sets), key=lambda one: (len(one), sorted(one)))
        self.costs = costs
        self.budget = budget
        self.chosen: frozenset[int] | None = None
        self.lowest = sum(costs) + 1

    def best(self) -> tuple[frozenset[int] | None, int]:
        """The set, and what is left of the budget; None if that was spent."""
        self._choose(frozenset(), frozenset(), 0)
        return (self.chosen if self.budget > 0 else None), self.budget

    def _choose(self, chosen: frozenset[int], refused: frozenset[int], cost: int) -> None:
        self.budget -= 1
        left = [one - refused for one in self.sets if chosen.isdisjoint(one)]
        if self.budget <= 0 or len(chosen) > DEEPEST:
            self.budget = 0
            return
        if not left:
            if cost < self.lowest:
                self.chosen, self.lowest = chosen, cost
            return
        if not all(left) or cost + self._at_least(left) >= self.lowest:
            return
        branch = min(left, key=len)
        for number in sorted(branch, key=lambda n: (self.costs[n], n)):
            self._choose(chosen | {number}, refused, cost + self.costs[number])
            refused |= {number}

    def _at_least(self, sets: Iterable[frozenset[int]]) -> int:
        """What sets that share nothing cost at least."""
        used: set[int] = set()
        total = 0
        for one in sets:
            if used.isdisjoint(one):
                used |= one
                total += min(self.costs[number] for number in one)
        return total
