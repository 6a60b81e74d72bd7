"""Whether findings are still there after a change of the policies: an analysis of what these hang on, no whole answer.

In: the enforced view as it was analysed, what reads the same policies with a change, and findings. Out: those that
stand, with their witnesses. Where a change only takes flows away, nothing is read, bound or spread anew.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.findings import chosen_findings
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.modes import Paths
from rosprivacy.answering import answer
from rosprivacy.ingest.policies.changed_graph import changed_graph

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.findings.findings import Chosen
    from rosprivacy.analysis.model import Bound
    from rosprivacy.ingest.policies.changed_policies import Change
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System


@dataclass(frozen=True, slots=True)
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

    def left(self, change: Change, findings: Iterable[Finding]) -> list[Finding]:
        """Return those of some findings that still stand after a change.

        Raises
        ------
        InputErrors
            If labels do not fit what the change leaves.
        """
        findings = tuple(findings)
        there = self._whole(change) if self.system.is_fleet else self._only(change, findings)
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
        wanted = {end for finding in findings for end in (finding.source, finding.leak)}
        vertices = {element: vertex for vertex, element in enumerate(elements) if element in wanted}
        chosen: dict[int, set[Chosen]] = defaultdict(set)
        for one in findings:
            if {one.source, one.leak} <= vertices.keys():
                number = categories.index(one.category)
                chosen[vertices[one.source]].add((one.kind, vertices[one.leak], number, one.beside))
        options = self.result.options
        assert options is not None, "an answer that was worked out here"
        options = options._replace(
            choose=lambda *_: chosen, paths=Paths.witness, bounds=replace(options.bounds, path_steps=0)
        )
        found = chosen_findings(net, bound, self.system.vocabulary.hierarchy, options)
        return {one.id: one for one in found if not one.dismissed}

    def _net(self, change: Change) -> tuple[Net, Bound]:
        bound = self.result.bound
        graph = None if bound.through else changed_graph(self.system.graph, self.system.policies, change)
        if graph is not None:
            return Net.of(self.result.analysis.spread.with_fewer_flows(graph)), bound
        system = self.read(change)
        return Net.of(spread(system.graph, system.bound, system.vocabulary.hierarchy)), system.bound
