"""A system with changes applied, so that it can be analysed anew (rules S2, S6, S8).

In: graph, statements, steps. Out: graph and statements. A review says that a channel carries none of some categories,
a filter that none of them goes on between two elements. A filter needs a channel of its own: before a channel one for
what is not cleaned yet, behind it one for what is. Wildcards that cover such a channel whatever it is called read what
is not cleaned, and write past the filter: these flows come to be with the filter.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import CHANGED, Bound, Flow, Place, Statement

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.analysis.model import FlowGraph


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
