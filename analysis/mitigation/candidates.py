"""What could be changed so that data no longer gets there: filters, reviews, grants set to DENY, each with its cost.

In: an analysis, the places on the paths to its open findings, the limits that the user sets. Out: ``Candidate``s. What
is on a path to a time-critical node is never filtered nor cut.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.mitigation.limits import DENY, FILTER, REVIEW

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.mitigation.changed_system import ChangeSites
    from rosprivacy.analysis.mitigation.cut_network import Arc, At
    from rosprivacy.analysis.model import FlowGraph, Grant


@dataclass(frozen=True, slots=True)
class Denial:
    """What goes when some grants are set to DENY (rule S5).

    Attributes
    ----------
    flows
        That are gone.
    touched
        Further flows of which a part goes: another grant, or other names of a wildcard, still allow the rest.
    """

    grants: tuple[Grant, ...]
    flows: frozenset[int]
    touched: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class Candidate:
    """One change that could be made.

    Attributes
    ----------
    flows
        Along which a filter would end the data, or that a DENY takes away.
    channels
        Vertices of the channel to review.
    categories
        Numbers of those that a filter could end, or that a review could find are not carried.
    touched
        See ``Denial``.
    readers
        Vertices that get what went along the flows directly: filtered, or no longer.
    private
        Of a filter: whether no wildcard gets past it, see ``applied``.
    """

    kind: str
    cost: int
    flows: frozenset[int] = frozenset()
    channels: frozenset[int] = frozenset()
    categories: frozenset[int] = frozenset()
    grants: tuple[Grant, ...] = ()
    touched: frozenset[int] = frozenset()
    readers: tuple[int, ...] = ()
    private: bool = True

    def cuts(self, arc: Arc) -> bool:
        """Whether no data goes along an arc after this change."""
        if self.kind == DENY:
            return arc.flow in self.flows
        return arc.category in self.categories and (arc.flow in self.flows or arc.channel in self.channels)

    def may_cut(self, arc: Arc) -> bool:
        """Whether it cuts an arc, or may do so: certain to be true of all that it cuts."""
        return self.cuts(arc) or arc.flow in self.touched


def uncut(changes: Iterable[Candidate]) -> Callable[[Arc], bool]:
    """Return the test whether an arc is cut by none of some changes, made once for many arcs.

    >>> from rosprivacy.analysis.mitigation.cut_network import Arc
    >>> passes = uncut([Candidate(FILTER, 10, flows=frozenset({7}), categories=frozenset({1}))])
    >>> [passes(Arc(2, 3, category, flow)) for category, flow in ((1, 7), (0, 7), (1, 8))]
    [False, True, True]
    """
    flows: set[int] = set()
    filtered: set[At] = set()
    reviewed: set[At] = set()
    for change in changes:
        if change.kind == DENY:
            flows.update(change.flows)
        filtered.update((flow, i) for flow in change.flows for i in change.categories)
        reviewed.update((channel, i) for channel in change.channels for i in change.categories)
    return lambda arc: (
        not (arc.flow in flows or (arc.flow, arc.category) in filtered or (arc.channel, arc.category) in reviewed)
    )


def candidates(
    places: ChangeSites, arcs: Sequence[Arc], denials: Callable[[Collection[int]], Sequence[Denial]]
) -> tuple[Candidate, ...]:
    """Return the changes that could be made on some paths, in a stable order: reviews, filters, denials.

    Parameters
    ----------
    denials
        Says of flows what grants would have to be set to DENY for each to go, and what else would go with it.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, NAMES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> from rosprivacy.analysis.mitigation.changed_system import ChangeSites
    >>> from rosprivacy.analysis.mitigation.cut_network import CutGroup, cut_network
    >>> from rosprivacy.analysis.mitigation.limits import Limits
    >>> analysis = analyse(*factory())
    >>> net = Net.of(analysis.spread)
    >>> network = cut_network(net, [CutGroup((CAMERA,))], [net.spread.categories.index("FaceTemplate")])
    >>> changes = candidates(ChangeSites(analysis, Limits(), {ARCHIVE}, {}), network.arcs, lambda flows: ())
    >>> [(change.kind, change.cost, [NAMES[v] for v in (*change.channels, *change.readers)]) for change in changes[:3]]
    [('review', 1, ['/video']), ('filter', 30, ['/face_id', '/filter']), ('filter', 10, ['/archive'])]
    """
    by_flow: dict[int, set[int]] = defaultdict(set)
    by_channel: dict[int, set[int]] = defaultdict(set)
    for arc in arcs:
        if arc.flow >= 0:
            by_flow[arc.flow].add(arc.category)
        if arc.channel >= 0:
            by_channel[arc.channel].add(arc.category)
    changes = [*_reviews(places, by_channel), *_filters(places, by_flow)]
    if DENY in places.limits.kinds:
        changes += _denied(places, denials(sorted(by_flow)))
    return tuple(changes)


def _reviews(places: ChangeSites, by_channel: Mapping[int, set[int]]) -> Iterator[Candidate]:
    """A channel on a path that nobody has reviewed may turn out to carry none; a wildcard is not one channel."""
    elements, spread = places.graph.elements, places.spread
    parts: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    for vertex, element in enumerate(elements):
        if element.is_channel and not element.pattern:
            parts[element.identity].append(vertex)
    for identity in dict.fromkeys(elements[v].identity for v in sorted(by_channel) if not elements[v].pattern):
        vertices = parts[identity]
        covered = [spread.bits.merged(spread.covered.get(v, 0) | spread.channel_sources.get(v, 0)) for v in vertices]
        passed = {i for v in vertices for i in by_channel.get(v, ())}
        open_ = frozenset(i for i in passed if not any(bits >> i & 1 for bits in covered))
        factor = places.factor(REVIEW, frozenset(), frozenset(vertices))
        if open_ and factor is not None:
            cost = places.cost(places.limits.weights.review, factor, ())
            yield Candidate(REVIEW, cost, channels=frozenset(vertices), categories=open_)


def _filters(places: ChangeSites, by_flow: Mapping[int, set[int]]) -> Iterator[Candidate]:
    """A sanitizer between two elements; on what a wildcard covers there is no place for one."""
    wanted = [f for f in sorted(by_flow) if places.graph.flows[f].role != "matches"]
    for flows in dict.fromkeys(_together(places.graph, wanted)):
        categories = frozenset(i for f in flows for i in by_flow.get(f, ()))
        factor = places.factor(FILTER, flows)
        if factor is None or any(places.delays(f) for f in flows):
            continue
        bits = sum(1 << i for i in categories)
        readers = {reader for f in flows for reader in places.readers(f, bits)}
        cost = places.cost(places.limits.weights.filter, factor, readers)
        private = all(places.private(f) for f in flows)
        yield Candidate(FILTER, cost, flows, categories=categories, readers=tuple(sorted(readers)), private=private)


def _together(graph: FlowGraph, bits: Iterable[int]) -> Iterator[frozenset[int]]:
    """For each flow, those that a filter in its place takes in: all between the same two elements.

    Under the enforced view a right is the enclave's (rule S6), so a filter only helps where the whole enclave gets
    filtered data: then these are all flows at the channel whose grants stand in the same enclaves.
    """
    by_ends: dict[tuple[object, ...], set[int]] = defaultdict(set)
    by_channel: dict[tuple[object, ...], set[int]] = defaultdict(set)
    for index, flow in enumerate(graph.flows):
        by_ends[_ends(graph, index)].add(index)
        if flow.grants:
            by_channel[_channel(graph, index)].add(index)
    for index in bits:
        flows, more = set[int](), by_ends[_ends(graph, index)]
        while more - flows:
            flows |= more
            enclaves = {grant.enclave for f in flows for grant in graph.flows[f].grants}
            near = by_channel[_channel(graph, index)] if graph.view == "enforced" and enclaves else ()
            more = {f for f in near if {grant.enclave for grant in graph.flows[f].grants} <= enclaves}
            more = {other for f in more for other in by_ends[_ends(graph, f)]}
        yield frozenset(flows)


def _ends(graph: FlowGraph, index: int) -> tuple[object, ...]:
    flow = graph.flows[index]
    return (graph.elements[flow.source].shown_as, graph.elements[flow.target].shown_as)


def _channel(graph: FlowGraph, index: int) -> tuple[object, ...]:
    """The channel of a granted flow, and the direction."""
    flow = graph.flows[index]
    writes = graph.elements[flow.target].is_channel
    return (writes, graph.elements[flow.target if writes else flow.source].shown_as)


def _denied(places: ChangeSites, denials: Iterable[Denial]) -> Iterator[Candidate]:
    """Grants set to DENY; not where a time-critical node would lose something."""
    flows, limits = places.graph.flows, places.limits
    for denial in denials:
        gone = denial.flows | denial.touched
        factor = places.factor(DENY, gone)
        late = any(places.delays(f) or {flows[f].source, flows[f].target} & limits.critical for f in gone)
        if factor is None or late or not denial.flows:
            continue
        readers = {reader for f in denial.flows for reader in places.readers(f)}
        lines = len({(grant.place, grant.role, grant.name) for grant in denial.grants})
        cost = places.cost(limits.weights.deny * lines, factor, readers)
        yield Candidate(
            DENY, cost, denial.flows, grants=denial.grants, touched=denial.touched, readers=tuple(sorted(readers))
        )
