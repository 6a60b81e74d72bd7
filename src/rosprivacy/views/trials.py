"""Whether findings are still there after a change of the policies: an analysis of what these hang on, no whole answer.

In: the enforced view as it was analysed, what reads the same policies with a change, and findings. Out: those that
stand, with their witnesses. Where a change only takes flows away, nothing is read, bound or spread anew.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import chosen_findings
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.many_flows import parted
from rosprivacy.answering import answer
from rosprivacy.ingest.policies.changed_graph import changed_graph
from rosprivacy.ingest.policies.names import is_pattern

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.findings.findings import Chosen
    from rosprivacy.analysis.model import Bound, Element
    from rosprivacy.ingest.policies.changed_policies import Change
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System


@dataclass(frozen=True)
class Trials:
    """Tries changes; what was made for one finding is not made again for another.

    Attributes
    ----------
    system, result
        Of the enforced view, without a change.
    read
        Makes the system of the policies with a change.
    question
        What was asked.
    """

    system: System
    result: Result
    read: Callable[[Change], System]
    question: Question
    nets: dict[Change, tuple[Net, Bound]] = field(default_factory=dict)
    answers: dict[Change, Mapping[str, Finding]] = field(default_factory=dict)

    @cached_property
    def vertices(self) -> Mapping[Element, int]:
        """The elements by number."""
        return _numbered(self.system.graph.elements)

    @cached_property
    def wildcards(self) -> frozenset[str]:
        """The enclaves in which somebody grants a wildcard."""
        grants = (grant for policy in self.system.policies for grant in policy.grants)
        return frozenset(grant.enclave for grant in grants if is_pattern(grant.name))

    @cached_property
    def leading_to(self) -> Mapping[int, Sequence[int]]:
        """Vertex -> those with a flow to it that everything may go along."""
        into: dict[int, list[int]] = defaultdict(list)
        spread = self.result.analysis.spread
        own, meetings = parted(spread.graph.flows, spread.told_apart)
        for index, flow in own:
            if index not in spread.flow_keeps:
                into[flow.target].append(flow.source)
        for meeting in meetings:
            for target in meeting.read:
                into[target] += meeting.written
        return into

    def channels_between(self, finding: Finding) -> int:
        """Return how many channels at least a DENY has to be about to end a finding: all that lie right between.

        Of a fleet, and where a wildcard that is denied could be about several, at least one.
        """
        nodes = {finding.source.name, finding.leak.name}
        enclaves = {profile.enclave for profile in self.system.graph.profiles if profile.node in nodes}
        if self.system.is_fleet or enclaves & self.wildcards:
            return 1
        spread, elements = self.result.analysis.spread, self.system.graph.elements
        source, bits = self.vertices[finding.source], spread.both(finding.category)
        bits &= spread.emits.get(source, 0)
        return len(
            {
                (elements[vertex].kind, elements[vertex].name)
                for vertex in self.leading_to.get(self.vertices[finding.leak], ())
                if elements[vertex].is_channel
                and bits & spread.sent.get(vertex, 0) & spread.taken(vertex)
                and source in self.leading_to[vertex]
            }
        )

    def left(self, change: Change, findings: Iterable[Finding]) -> list[Finding]:
        """Return those of some findings that still stand after a change: all where labels do not fit what it leaves."""
        findings = tuple(findings)
        try:
            there = self._whole(change) if self.system.is_fleet else self._only(change, findings)
        except InputErrors:  # such as a flow that a label names: nothing is proven then
            return list(findings)
        return [there[one.id] for one in findings if one.id in there]

    def _whole(self, change: Change) -> Mapping[str, Finding]:
        """All findings: robots of a fleet are put together first."""
        if change not in self.answers:
            found = answer(self.read(change), self.question).analysis.findings
            self.answers[change] = {one.id: one for one in found if not one.dismissed}
        return self.answers[change]

    def _only(self, change: Change, findings: Sequence[Finding]) -> Mapping[str, Finding]:
        if change not in self.nets:
            self.nets[change] = self._net(change)
        net, bound = self.nets[change]
        elements, categories = net.spread.graph.elements, net.spread.categories
        vertices = self.vertices if elements is self.system.graph.elements else _numbered(elements)
        chosen: dict[int, set[Chosen]] = defaultdict(set)
        for one in findings:
            if {one.source, one.leak} <= vertices.keys():
                number = categories.index(one.category)
                chosen[vertices[one.source]].add((one.kind, vertices[one.leak], number, one.beside))
        options = self.result.options
        assert options is not None, "an answer that was worked out here"
        options = options._replace(count_paths=False)
        found = chosen_findings(net, bound, self.system.vocabulary.hierarchy, options, chosen)
        return {one.id: one for one in found if not one.dismissed}

    def _net(self, change: Change) -> tuple[Net, Bound]:
        bound = self.result.bound
        named = bound.through or (bound.flows and change.deny)  # flows that labels name: are they still there?
        graph = None if named else changed_graph(self.system.graph, self.system.policies, change)
        if graph is not None:
            return Net.of(self.result.analysis.spread.with_fewer_flows(graph)), bound
        system = self.read(change)
        return Net.of(spread(system.graph, system.bound, system.vocabulary.hierarchy)), system.bound


def _numbered(elements: Iterable[Element]) -> dict[Element, int]:
    return {element: vertex for vertex, element in enumerate(elements)}
