"""Findings -> what to change so that they go: proposals, each proven by a new analysis (rules S8, S10).

In: an analysis and what it was made of, the limits that the user sets. Out: ``Proposal``s, for each category with an
open finding and for all together. What is proposed is taken from a network of the paths to be cut; whether it is right
is decided by the real fixpoint, with the changes applied: a proposal that this does not bear out has no steps.

Source: the paper, section II-C, for the kinds of change and for naming who would get filtered data.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.mitigation.affected import affected
from rosprivacy.analysis.mitigation.candidates import candidates, uncut
from rosprivacy.analysis.mitigation.changed_system import ChangeSites, opened, with_changes
from rosprivacy.analysis.mitigation.cut_network import CutGroup, a_path, cut_network, open_ends
from rosprivacy.analysis.mitigation.limits import DENY, FILTER, REVIEW, Limits
from rosprivacy.analysis.mitigation.min_cut import BUDGET, cheapest
from rosprivacy.analysis.mitigation.proposals import ITSELF, NOT_ALLOWED, Kept, Proposal, ProposedStep, Protect
from rosprivacy.analysis.model import DISCLOSURE, UNPROTECTED

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.mitigation.candidates import Candidate, Denial
    from rosprivacy.analysis.mitigation.cut_network import Arc, At, CutNetwork
    from rosprivacy.analysis.mitigation.min_cut import ChangeSet
    from rosprivacy.analysis.model import Bound, Element, Exposure, FlowGraph, Grant


@dataclass(frozen=True, slots=True)
class MitigatedSystem:
    """What an analysis was made of, and how it is made anew with changes.

    Attributes
    ----------
    denials
        Says of flows what grants would have to be set to DENY for each to go, and what would go with them.
    deny
        Makes the graph and its statements anew with some grants set to DENY.
    open_ended
        Says of a graph, per kind of channel, which wildcards cover a channel whatever it is called.
    judge
        Gives an analysis of it the verdict that its doubts leave (rule S11).
    """

    graph: FlowGraph
    bound: Bound
    hierarchy: Hierarchy
    options: Options
    denials: Callable[[Collection[int]], Sequence[Denial]]
    deny: Callable[[Collection[Grant]], tuple[FlowGraph, Bound]]
    open_ended: Callable[[FlowGraph], Mapping[str, frozenset[int]]] = lambda _: {}
    judge: Callable[[Analysis], Analysis] = lambda analysis: analysis


def open_findings(analysis: Analysis) -> tuple[Finding, ...]:
    """Return the findings that are neither dismissed nor accepted.

    >>> from rosprivacy.analysis.example import factory
    >>> [(finding.category, finding.leak.name) for finding in open_findings(analyse(*factory()))]
    [('FaceTemplate', '/archive'), ('FaceTemplate', 'disk'), ('Video', '/archive'), ('Video', 'disk')]
    """
    return tuple(finding for finding in analysis.findings if finding.stands)


def mitigate(
    system: MitigatedSystem, analysis: Analysis, limits: Limits | None = None, budget: int = BUDGET
) -> tuple[Proposal, ...]:
    """Return a proposal per category with an open finding, in order, and one for all together where there are several.

    Parameters
    ----------
    analysis
        Of the system, by its options.
    budget
        Steps of the search for the cheapest set, see ``cuts``.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> graph, bound, hierarchy = factory()
    >>> analysis = analyse(graph, bound, hierarchy)
    >>> system = MitigatedSystem(graph, bound, hierarchy, Options(), lambda flows: (), lambda grants: (graph, bound))
    >>> for proposal in mitigate(system, analysis):
    ...     print(*proposal.categories, [(step.kind, step.channel.name, step.cost) for step in proposal.steps])
    FaceTemplate [('review', '/video', 1)]
    Video [('review', '/filtered', 1)]
    FaceTemplate Video [('review', '/video', 1)]
    """
    limits = limits or Limits()
    names = list(dict.fromkeys(finding.category for finding in open_findings(analysis)))
    wanted = [(name,) for name in names] + ([tuple(names)] if len(names) > 1 else [])
    return tuple(_Work(system, analysis, limits, some).proposal(budget) for some in wanted)


class _Work:
    """How one proposal is made."""

    def __init__(self, system: MitigatedSystem, analysis: Analysis, limits: Limits, names: tuple[str, ...]) -> None:
        self.system = system
        self.analysis = analysis
        self.names = names
        self.net = Net.cached(analysis.spread)
        self.elements = analysis.graph.elements
        self.number = {name: i for i, name in enumerate(analysis.spread.categories)}
        self.categories = frozenset(self.number[name] for name in names)
        self.vertex = {element: v for v, element in enumerate(self.elements)}
        mine = [f for f in open_findings(analysis) if f.category in names]
        self.findings = [f for f in mine if f.kind != UNPROTECTED]
        self.protect = _protect(system.bound, self.vertex, [f for f in mine if f.kind == UNPROTECTED])
        self.wild = system.open_ended(analysis.graph)
        self.places = ChangeSites(analysis, limits, {self.vertex[f.leak] for f in self.findings}, self.wild)

    def proposal(self, budget: int) -> Proposal:
        """Find what to cut, cut it, and prove it; what a governance leaves in the open is no matter of cuts."""
        sources = sorted({self.vertex[finding.source] for finding in self.findings})
        groups = [self._group(source) for source in sources]
        everything = cut_network(self.net, groups, self.categories)
        options = candidates(self.places, everything.arcs, self.system.denials)
        kept = [kept for group in groups for kept in self._remaining_of_source(group, options)]
        stays = {kept.finding.id for kept in kept}
        removed = tuple(finding for finding in self.findings if finding.id not in stays)
        left = cut_network(self.net, self._grouped(groups, kept), self.categories)
        plain = Proposal(
            self.names, removed, tuple(kept), (), 0, proven=not removed, verdict=self.analysis.verdict,
            protect=self.protect,
        )  # fmt: skip
        if not removed:
            return replace(plain, verdict=self._analysed(()).verdict) if self.protect else plain
        lower = 0
        for cut, network in self._cuts(left, options, groups, kept, budget):
            lower = lower or cut.lower  # that of the first, in which no wildcard gets past a filter
            chosen = [(change, change.categories) for change in (options[n] for n in cut.chosen)]
            proposal = self._proven(replace(plain, lower=lower), _lean(network, chosen) if cut.sure else chosen)
            if proposal.proven:
                return proposal
        return replace(plain, lower=lower)

    def _cuts(
        self,
        narrowed: CutNetwork,
        options: Sequence[Candidate],
        groups: Sequence[CutGroup],
        remaining: Sequence[Kept],
        budget: int,
    ) -> Iterator[tuple[ChangeSet, CutNetwork]]:
        """Cuts to try, the cheapest first: without regard to wildcards that get past filters, then with."""
        yield from ((cut, narrowed) for cut in cheapest(narrowed, options, budget))
        if all(change.private for change in options):
            return
        later: list[tuple[ChangeSet, CutNetwork]] = []
        private = [n for n, change in enumerate(options) if change.private]
        for network, numbers in ((narrowed, private), (self._opened(options, groups, remaining), range(len(options)))):
            some = [options[n] for n in numbers]
            if a_path(network, uncut(some)) is None:
                cuts = cheapest(network, some, budget)
                later += [(replace(cut, chosen=tuple(numbers[n] for n in cut.chosen)), network) for cut in cuts]
        yield from sorted(later, key=lambda pair: pair[0].cost)

    def _opened(
        self, options: Iterable[Candidate], groups: Iterable[CutGroup], remaining: Iterable[Kept]
    ) -> CutNetwork:
        """The paths that there are when wildcards get past all filters that could be made."""
        graph, bound = self.system.graph, self.system.bound
        filtered = sorted({flow for change in options if not change.private for flow in change.flows})
        grown = spread(*opened(graph, bound, filtered, self.wild, bound), self.system.hierarchy)
        known = {group.sources for group in groups}
        others = [self._group(v) for v in grown.facts if grown.begins(v) and (v,) not in known]
        return cut_network(Net.of(grown), self._grouped([*groups, *others], remaining), self.categories)

    def _group(self, source: int) -> CutGroup:
        """What is decided of one source."""
        accepted: set[At] = set()
        others: set[At] = set()
        for finding in self.analysis.findings:
            at = self._at(finding)
            elsewhere = self.vertex[finding.source] != source or at[1] not in self.categories
            if elsewhere or finding.kind == UNPROTECTED:
                continue
            if finding.kind != DISCLOSURE:
                others |= {at} if not finding.accepted and len(finding.witness) > 1 else set()
            elif finding.accepted:
                accepted.add(at)
        begun = self.analysis.spread.bits.merged(self.analysis.spread.begins(source))
        itself = {(source, i) for i in bits_of(begun) if self._leaks((source, i))}
        return CutGroup((source,), frozenset(accepted), frozenset(itself), frozenset(others))

    def _leaks(self, at: At) -> bool:
        return bool(self.analysis.spread.leaks.get(at[0], 0) & self.analysis.spread.bits.pair(at[1]))

    def _remaining_of_source(self, group: CutGroup, options: Sequence[Candidate]) -> Iterable[Kept]:
        """The findings of one source that no change removes, with a path on which none can be made."""
        (source,) = group.sources
        mine: dict[tuple[At, bool], list[Finding]] = defaultdict(list)
        for finding in (f for f in self.findings if self.vertex[f.source] == source):
            if len(finding.witness) == 1:
                yield Kept(finding, ITSELF, (finding.source,))
            else:
                mine[self._at(finding), finding.kind != DISCLOSURE].append(finding)
        network = cut_network(self.net, [group], self.categories)
        for at, past, path in open_ends(network, uncut(options)):
            for finding in mine[at, past]:
                yield Kept(finding, NOT_ALLOWED, self._shown(source, network, path))

    def _at(self, finding: Finding) -> At:
        return (self.vertex[finding.leak], self.number[finding.category])

    def _shown(self, source: int, network: CutNetwork, path: Iterable[Arc]) -> tuple[Element, ...]:
        shown = [self.elements[source]]
        for arc in path:
            element = self.elements[network.at[arc.head][0]] if arc.head in network.at else shown[-1]
            if element.shown_as != shown[-1].shown_as:
                shown.append(element)
        return tuple(shown)

    def _grouped(self, groups: Iterable[CutGroup], remaining: Iterable[Kept]) -> list[CutGroup]:
        """Sources of which the same is decided together: in one network, each flow is one arc."""
        stays: dict[tuple[int, bool], set[At]] = defaultdict(set)
        for one in remaining:
            stays[self.vertex[one.finding.source], one.finding.kind == DISCLOSURE].add(self._at(one.finding))
        together: dict[tuple[frozenset[At], ...], list[int]] = defaultdict(list)
        for group in groups:
            (source,) = group.sources
            leaks, others = stays[source, True], stays[source, False]
            together[group.accepted, group.remaining | leaks, group.other_kinds - others].append(source)
        return [CutGroup(tuple(sources), *decided) for decided, sources in together.items()]

    def _proven(self, plain: Proposal, chosen: Sequence[tuple[Candidate, frozenset[int]]]) -> Proposal:
        """Apply the changes, analyse anew, and take the proposal only if nothing is left but what is kept."""
        steps = tuple(self._step(change, categories) for change, categories in chosen)
        after = self._analysed(steps)
        before = {finding.id for finding in open_findings(self.analysis)}
        stays = {kept.finding.id for kept in plain.remaining}
        left = {finding.id for finding in open_findings(after) if finding.category in self.names}
        if not left <= stays or not {finding.id for finding in open_findings(after)} <= before:
            return plain
        reviews = [step for step in steps if step.kind == REVIEW]
        reviewed = self._analysed(reviews) if len(reviews) < len(steps) else after
        return replace(plain, steps=steps, proven=True, verdict=after.verdict, affected=affected(reviewed, after))

    def _step(self, change: Candidate, categories: frozenset[int]) -> ProposedStep:
        flows = [self.analysis.graph.flows[f] for f in sorted(change.flows)]
        if change.kind == DENY:
            return ProposedStep(DENY, change.cost, grants=change.grants, readers=self._elements_of(change.readers))
        names = tuple(self.analysis.spread.categories[i] for i in sorted(categories))
        if change.kind == REVIEW:
            part = self.elements[min(change.channels)]
            return ProposedStep(REVIEW, change.cost, names, channel=replace(part, leg=""))
        bits = sum(1 << i for i in categories)
        readers = {reader for f in change.flows for reader in self.places.readers(f, bits)}
        read = {f for flow in flows for f in self.places.out[flow.source] if self.elements[flow.source].is_channel}
        others = {reader for f in read - change.flows for reader in self.places.readers(f, bits)} - readers
        between = dict.fromkeys((self.elements[flow.source], self.elements[flow.target]) for flow in flows)
        return ProposedStep(
            FILTER, change.cost, names, tuple(between), readers=self._elements_of(readers),
            spared=self._elements_of(others),
            grants=tuple(dict.fromkeys(grant for flow in flows for grant in flow.grants)),
        )  # fmt: skip

    def _elements_of(self, vertices: Iterable[int]) -> tuple[Element, ...]:
        return tuple(self.elements[vertex] for vertex in sorted(vertices))

    def _analysed(self, steps: Iterable[ProposedStep]) -> Analysis:
        """Analyse the system with some steps applied."""
        steps = list(steps)
        if not steps and not self.protect:
            return self.analysis
        grants = [grant for step in steps if step.kind == DENY for grant in step.grants]
        graph, bound = self.system.deny(grants) if grants else (self.system.graph, self.system.bound)
        changed_lines = {one.exposure for one in self.protect}
        exposed = {v: tuple(one for one in some if one not in changed_lines) for v, some in bound.exposed.items()}
        bound = replace(bound, exposed=exposed)
        changed = with_changes(graph, bound, steps, self.system.open_ended(graph))
        return self.system.judge(analyse(*changed, self.system.hierarchy, self.system.options))


def _protect(bound: Bound, vertex: Mapping[Element, int], findings: Iterable[Finding]) -> tuple[Protect, ...]:
    """The lines of governances behind some findings, in the order of their files."""
    by_line: dict[Exposure, list[Finding]] = defaultdict(list)
    for finding in findings:
        for exposure in bound.exposed[vertex[finding.leak]]:
            by_line[exposure].append(finding)
    rows = []
    for exposure, some in sorted(by_line.items(), key=lambda row: (row[0].place, row[0].cause)):
        channels = {vertex[f.leak]: f.leak for f in some}
        rows.append(Protect(exposure, tuple(channels[v] for v in sorted(channels)), tuple(some)))
    return tuple(rows)


def _lean(
    network: CutNetwork, chosen: Sequence[tuple[Candidate, frozenset[int]]]
) -> list[tuple[Candidate, frozenset[int]]]:
    """The same changes, filters and reviews about no more categories than they have to be."""
    lean = list(chosen)
    for place, (change, categories) in enumerate(lean):
        for i in sorted(categories) if change.kind != DENY else ():
            less = lean[place][1] - {i}
            tried = [*lean[:place], (change, less), *lean[place + 1 :]]
            if less and a_path(network, uncut([replace(one, categories=some) for one, some in tried])) is None:
                lean = tried
    return lean
