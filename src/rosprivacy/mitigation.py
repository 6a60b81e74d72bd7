"""The way from findings to proposals: policies, labels and limits in, proven proposals and a patch out.

In: a ``Result`` of one robot. Out: ``Mitigation``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.findings.doubts import doubts, judged
from rosprivacy.analysis.mitigation.channel_settings import RecognisedProgram, left_out
from rosprivacy.analysis.mitigation.limits import CHANGES, DENY, Limits
from rosprivacy.analysis.mitigation.propose import MitigatedSystem, mitigate, open_findings
from rosprivacy.analysis.model import UNPROTECTED, Confidence
from rosprivacy.analysis.suggesting.packages import nodes_of_packages
from rosprivacy.documents import document_of
from rosprivacy.ingest.deployed.exposures import with_exposed
from rosprivacy.ingest.known_packages.package_folders import catalogue
from rosprivacy.ingest.known_packages.program_settings import programs
from rosprivacy.ingest.labels.binding import join
from rosprivacy.ingest.mitigation.deny_lines import Denials, open_ended, with_denied
from rosprivacy.ingest.mitigation.deny_patch import Patch, patch
from rosprivacy.ingest.mitigation.limits_file import read_limits
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.scan.reviewed_code import with_reviewed_code
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.document.contents import LEDGER
from rosprivacy.report.document.mitigation import mitigation_document

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.mitigation.channel_settings import LeftOut
    from rosprivacy.analysis.mitigation.proposals import Proposal
    from rosprivacy.analysis.model import Bound, Category, FlowGraph, Grant
    from rosprivacy.report.schemas.mitigation import MitigationDocument
    from rosprivacy.result import Result

REPORTED = 20  # findings for which a report proposes changes


@dataclass(frozen=True, slots=True)
class Mitigation:
    """Proposals for a system.

    Attributes
    ----------
    result
        The analysis that they start from.
    proposals
        Per category, and for all together, last, where there are several.
    patch
        Of the last proposal's lines to be set to DENY.
    unmatched
        What labels would then name that is no longer there.
    notes
        What else a reader has to know.
    settings
        By proposal: how a person makes bridges and recorders leave out what its findings are about. The proof does
        not rest on them.
    """

    result: Result
    limits: Limits
    proposals: tuple[Proposal, ...]
    patch: Patch
    unmatched: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    settings: tuple[tuple[LeftOut, ...], ...] = ()

    @property
    def complete(self) -> bool:
        """Whether nothing is open, or all that is open is removed by a proposal that is proven."""
        return all(proposal.proven and not proposal.remaining for proposal in self.proposals)

    def document(self) -> MitigationDocument:
        """Return the JSON document."""
        report = json_document(document_of(self.result, (LEDGER,)))
        return mitigation_document(
            report, self.result.analysis, self.limits, self.proposals, self.patch.diff, self.patch.why_not,
            self.unmatched, self.notes, self.settings,
        )  # fmt: skip


def run_mitigation(
    result: Result, limits_file: str | None = None, kinds: Collection[str] = CHANGES, bounds: Bounds = BOUNDS
) -> Mitigation:
    """Propose changes that remove the open findings of an analysis.

    Parameters
    ----------
    kinds
        Of changes that may be proposed.

    Raises
    ------
    InputErrors
        With every problem of the limits file.
    """
    graph, view = result.analysis.graph, result.analysis.graph.view
    limits = read_limits(limits_file, graph, bounds) if limits_file else Limits()
    notes: tuple[str, ...] = ()
    # What else is in the graph would be lost when built anew.
    if DENY in kinds and build(result.policies, view, bounds) != graph:
        kinds = set(kinds) - {DENY}
        notes = ("no line is proposed for DENY: the graph holds more than the policies say",)
    limits = replace(limits, kinds=limits.kinds & set(kinds))

    def deny(grants: Collection[Grant]) -> tuple[FlowGraph, Bound]:
        changed = build(with_denied(result.policies, grants), view, bounds)
        bound = join(changed, result.labels, bounds)[0]
        bound = with_reviewed_code(changed, bound, result.labels, result.policies).bound
        return changed, with_exposed(changed, bound, result.policies)

    system = MitigatedSystem(
        graph, result.bound, result.vocabulary.hierarchy, result.options,
        Denials(result.policies, graph).of, deny, open_ended, partial(_judged, result),
    )  # fmt: skip
    proposals = _by_weight(mitigate(system, result.analysis, limits), result.vocabulary.categories)
    recognised = _recognised(result) if any(proposal.removed for proposal in proposals) else ()
    settings = tuple(left_out(result.analysis, proposal.removed, recognised) for proposal in proposals)
    grants = list(_denied(proposals[-1:]))
    if not grants:
        return Mitigation(result, limits, proposals, Patch(), notes=notes, settings=settings)
    changed = build(with_denied(result.policies, grants), view, bounds)
    unmatched = tuple(str(problem) for problem in join(changed, result.labels, bounds)[1])
    return Mitigation(result, limits, proposals, patch(result.policies, grants), unmatched, notes, settings)


def _by_weight(proposals: Sequence[Proposal], categories: Mapping[str, Category]) -> tuple[Proposal, ...]:
    """What weighs most first, as everywhere; all together stays last."""
    return (*sorted(proposals[:-1], key=lambda one: categories[one.categories[0]].weight), *proposals[-1:])


def _recognised(result: Result) -> tuple[RecognisedProgram, ...]:
    """The nodes that are called like bridges and recorders of the catalogue of packages."""
    graph = result.analysis.graph
    by_node = {(one.package, one.node): one for one in programs()}
    packages = {package for package, _ in by_node}
    of_packages = nodes_of_packages(
        graph, result.bound.types, [one for one in catalogue(result.vocabulary) if one.name in packages]
    )
    rows = []
    for one in of_packages:
        program = next((by_node[key] for name in one.node.names if (key := (one.package.name, name)) in by_node), None)
        likely = one.is_exit(graph.elements[one.vertex].name)
        if program:
            sure = Confidence.LIKELY if likely else Confidence.MAY
            rows.append(RecognisedProgram(one.vertex, program, sure, one.agrees))
    return tuple(rows)


def _judged(result: Result, analysis: Analysis) -> Analysis:
    """Return an analysis with changes under its doubts: those of what was read stay, and what is accepted stays so."""
    accepted = {doubt.id: doubt.accepted for doubt in result.doubts}
    stay = (doubt for doubt in result.doubts if doubt.element is None)
    anew = (replace(doubt, accepted=accepted.get(doubt.id)) for doubt in doubts(analysis, ()))
    return judged(analysis, (*stay, *anew))


def proposed(result: Result) -> MitigationDocument | str:
    """Return what a report proposes, or ``many`` if there are too many findings.

    Notes
    -----
    On TurtleBot3, 4 findings cost 1.1 s and 16 cost 2.3 s, where the analysis takes 0.3 s: more than ``REPORTED`` are
    left to ``mitigate``.
    """
    if sum(finding.kind != UNPROTECTED for finding in open_findings(result.analysis)) > REPORTED:
        return "many"
    return run_mitigation(result, bounds=result.options.bounds).document()


def _denied(proposals: Iterable[Proposal]) -> Iterable[Grant]:
    return (g for proposal in proposals for step in proposal.steps if step.kind == DENY for g in step.grants)
