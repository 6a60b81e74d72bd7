"""A system with changes applied, so that it can be analysed anew; and the places where changes can be made.

In: graph, statements, steps; an analysis and limits. Out: graph and statements; ``ChangeSites``, which answers who
reads what goes through a flow or channel, what comes late, what the limits say (rules S2, S6, S8). A review says that a
channel carries none of some categories, a filter that none of them goes on between two elements. A filter needs a
channel of its own: before a channel one for what is not cleaned yet, behind it one for what is. Wildcards that cover
such a channel whatever it is called read what is not cleaned, and write past the filter: these flows come to be with
the filter.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.states import back
from rosprivacy.analysis.model import CHANGED, Bound, Flow, Place, Statement

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.mitigation.cut_network import At
    from rosprivacy.analysis.mitigation.limits import Limits
    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.analysis.model import FlowGraph


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


def with_changes(
    graph: FlowGraph, bound: Bound, steps: Iterable[ProposedStep], wild: Mapping[str, frozenset[int]]
) -> tuple[FlowGraph, Bound]:
    """Return the system after reviews and filters; what is set to DENY is not in the graph already.

    Parameters
    ----------
    wild
        Per kind of channel, the wildcards that cover a channel whatever it is called.

    Examples
    --------
    >>> from rosprivacy.analysis.example import VIDEO, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.mitigation.proposals import ProposedStep
    >>> graph, bound, hierarchy = factory()
    >>> review = ProposedStep("review", 1, ("Video",), channel=graph.elements[VIDEO])
    >>> changed = with_changes(graph, bound, [review], {})
    >>> len(analyse(graph, bound, hierarchy).findings), len(analyse(*changed, hierarchy).findings)
    (4, 0)
    """
    elements, flows = dict(bound.elements), dict(bound.flows)
    filtered: list[int] = []
    for step in steps:
        never = Statement("never", step.categories, (CHANGED, 0), Place("proposal", 0))
        ends = {(source.shown_as, target.shown_as) for source, target in step.between}
        for index, flow in enumerate(graph.flows if ends else ()):
            if (graph.elements[flow.source].shown_as, graph.elements[flow.target].shown_as) in ends:
                flows[index] = (*flows.get(index, ()), never)
                filtered.append(index)
        for vertex, element in enumerate(graph.elements if step.channel else ()):
            if step.channel and element.identity == step.channel.identity:
                elements[vertex] = (*elements.get(vertex, ()), never)
    changed = replace(bound, elements=dict(sorted(elements.items())), flows=dict(sorted(flows.items())))
    return opened(graph, bound, filtered, wild, changed)


def opens(graph: FlowGraph, flow: int, wild: Mapping[str, frozenset[int]]) -> Iterator[tuple[int, int]]:
    """Yield (from, to), vertices, of the flows that come to be with a filter in a flow.

    >>> from rosprivacy.analysis.example import FILTER, factory
    >>> from rosprivacy.analysis.model import Element
    >>> graph, _, _ = factory()
    >>> graph = replace(graph, elements=(*graph.elements, Element("topic", "/*", side="read")))
    >>> list(opens(graph, 4, {"topic": frozenset({9})})) == [(FILTER, 9)]
    True
    """
    source, target = graph.flows[flow].source, graph.flows[flow].target
    before = graph.elements[target].is_channel
    channel = graph.elements[target if before else source]
    for vertex in sorted(wild.get(channel.kind, ())):
        pattern = graph.elements[vertex]
        if pattern.leg in ("", channel.leg):
            if before and pattern.side == "read":
                yield source, vertex
            if not before and channel.is_channel and pattern.side == "write":
                yield vertex, target


def opened(
    graph: FlowGraph, bound: Bound, filtered: Iterable[int], wild: Mapping[str, frozenset[int]], changed: Bound
) -> tuple[FlowGraph, Bound]:
    """Return a graph with the flows that come to be with filters, after all others.

    Parameters
    ----------
    filtered
        Flows with a filter in them.
    changed
        The statements to add to; ``bound`` are those before the filters.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Element
    >>> graph, bound, _ = factory()
    >>> graph = replace(graph, elements=(*graph.elements, Element("topic", "/*", side="read")))
    >>> grown, _ = opened(graph, bound, [4], {"topic": frozenset({9})}, bound)
    >>> grown.flows[len(graph.flows):]
    (Flow(source=3, target=9, role='matches', grants=(), denials=()),)
    """
    more: list[Flow] = []
    flows, through = dict(changed.flows), {key: list(indices) for key, indices in changed.through.items()}
    for index in dict.fromkeys(filtered):
        flow = graph.flows[index]
        for source, target in opens(graph, index, wild):
            here = len(graph.flows) + len(more)
            more.append(Flow(source, target, "matches"))
            if source == flow.source:  # it emits there what it emitted here, less what was never in the channel
                said = (*bound.flows.get(index, ()), *bound.elements.get(flow.target, ()))
                flows |= {here: said} if said else {}
                for key, indices in through.items():
                    if key[0] == source and index in indices:
                        indices.append(here)
    if not more:
        return graph, changed
    grown = replace(graph, flows=(*graph.flows, *more))
    return grown, replace(changed, flows=flows, through={key: tuple(indices) for key, indices in through.items()})
