"""The places where changes can be made: who reads what goes through them, what comes late, what the limits say.

In: an analysis and limits. Out: ``ChangeSites``, which answers for flows and channels.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.states import back
from rosprivacy.analysis.mitigation.changed_system import opens

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.mitigation.cut_network import At
    from rosprivacy.analysis.mitigation.limits import Limits


class ChangeSites:
    """The places where changes can be made, and who reads what goes through them.

    Parameters
    ----------
    leaks
        Vertices; that they get filtered data is what is wanted, and costs nothing.
    wild
        Per kind of channel the wildcards that cover a channel whatever it is called.
    """

    def __init__(
        self,
        analysis: Analysis,
        limits: Limits,
        leaks: Collection[int],
        wild: Mapping[str, frozenset[int]],
    ) -> None:
        self.wild = wild
        self.spread = analysis.spread
        self.graph = analysis.graph
        self.limits = limits
        self.leaks = frozenset(leaks)
        self.out: dict[int, list[int]] = defaultdict(list)
        for index, flow in enumerate(self.graph.flows):
            self.out[flow.source].append(index)
        self.late = self._before_critical()

    def along(self, flow: int) -> int:
        """The categories that go along a flow, its planes put together."""
        return self.spread.bits.merged(self.spread.along(flow))

    def readers(self, flow: int, categories: int | None = None) -> set[int]:
        """Who gets what goes along a flow, next after the channel: of some categories, or of all there is."""
        readers: set[int] = set()
        seen = {flow}
        waiting = [flow]
        while waiting:
            here = waiting.pop()
            if categories is not None and not self.along(here) & categories:
                continue
            target = self.graph.flows[here].target
            if not self.graph.elements[target].is_channel:
                readers |= {target} - self.spread.absent
                continue
            new = [after for after in self.out[target] if after not in seen]
            seen.update(new)
            waiting += new
        return readers

    def _before_critical(self) -> frozenset[At]:
        """Where (vertex, category) arrives and goes on to a time-critical node, not through a leak, or is at one."""
        incoming: dict[int, list[int]] = defaultdict(list)
        for index, flow in enumerate(self.graph.flows if self.limits.critical else ()):
            if self.along(index):
                incoming[flow.target].append(index)
        late = {(v, i) for v in self.limits.critical for i, _ in enumerate(self.spread.categories)}
        waiting = sorted(late)
        while waiting:
            vertex, i = waiting.pop()
            for index in incoming[vertex]:
                if self.along(index) >> i & 1:
                    before = self.graph.flows[index].source
                    new = {(before, j) for j in self._made_into(before, i)} - late
                    late |= new
                    waiting += sorted(new)
        return frozenset(late)

    def _made_into(self, vertex: int, i: int) -> Iterator[int]:
        """The categories that leave a vertex as i when they arrive there; not where it or they leak."""
        bits, leaks = self.spread.bits, self.spread.leaks.get(vertex, 0)
        if leaks & bits.pair(i):
            return
        yield from bits_of(bits.merged(back(self.spread, vertex, bits.pair(i)) & ~leaks))

    def delays(self, flow: int) -> bool:
        """Whether what goes along a flow goes on to a time-critical node."""
        target = self.graph.flows[flow].target
        return any((target, i) in self.late for i in bits_of(self.along(flow)))

    def private(self, flow: int) -> bool:
        """Whether a filter in a flow can have a channel of its own, which no wildcard reads or writes data past."""
        return not any(self.spread.leaves.get(tail) for tail, _ in opens(self.graph, flow, self.wild))

    def factor(self, kind: str, flows: frozenset[int], channels: frozenset[int] = frozenset()) -> int | None:
        """How many times as dear a change is at some places; None if it may not be made there."""
        rules = [rule for rule in self.limits.rules if rule.flows & flows or rule.vertices & channels]
        if kind not in self.limits.kinds or any(kind in rule.excluded for rule in rules):
            return None
        return max((rule.factor for rule in rules), default=1)

    def cost(self, own_cost: int, factor: int, readers: Iterable[int]) -> int:
        """The cost of a change: its own, and the nodes beside the leaks that it would reach."""
        return factor * (own_cost + self.limits.weights.node * len(set(readers) - self.leaks))
