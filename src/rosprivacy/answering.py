"""The one way from a system and a question to the answer, whatever the system was read from.

In: ``System`` and ``Question``. Out: ``Result``. Who computes the analysis elsewhere (Spark) begins at ``concluded``.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import ClosedByTypes, Verdict
from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.findings.doubts import doubts, judged
from rosprivacy.analysis.findings.findings import Options, analyse, chosen_findings
from rosprivacy.analysis.findings.processed import lacks, processed
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.model import TYPE_LINE
from rosprivacy.analysis.modes import Paths, View
from rosprivacy.analysis.whatif.answered_by_globs import answered_by_globs
from rosprivacy.assumptions import assumptions_of
from rosprivacy.decided import accepts, doubts_decided, joined_to, law_of
from rosprivacy.ingest.labels.label_file import infrastructure_of
from rosprivacy.question import in_contexts
from rosprivacy.result import Result

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.findings import Chosen
    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.fleet.patterns_of_pairs import Closed, Groups
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.system import System


def answer(system: System, question: Question, *, count_paths: bool = True, before: Result | None = None) -> Result:
    """Analyse a system and keep what the answer rests on.

    Parameters
    ----------
    count_paths
        As of ``Options``. Where people decided about findings, paths are counted in any case: a decision remembers how
        many there were.
    before
        An earlier answer about the same policies, of which all is taken over that is still so.

    Raises
    ------
    InputErrors
        If labels contradict each other.
    """
    at_sources = Contexts.of(system.graph, system.bound, system.vocabulary.categories, together=system.is_fleet)
    question = in_contexts(question, at_sources.everywhere)
    groups = _groups(system, question) if system.is_fleet else None
    options = Options(
        categories=question.categories_asked,
        paths=question.settings.paths,
        max_paths=question.settings.max_paths,
        count_paths=count_paths or question.decisions is not None,
        uncounted=system.likeness.apart if system.is_fleet and question.every_finding else None,
        accepts=accepts(question.decisions, system.likeness),
        choose=groups,
        shared=system.likeness.shared(system.graph.elements) if question.most_across is not None else None,
        today=question.today,
        bounds=question.settings.bounds,
    )
    system = _under_lines(system, question)
    limits = question.type_limits() if question.type_limits and system.bound.types else None
    bound = system.bound
    if limits is not None:
        from rosprivacy.analysis.kernel.type_limits import under_limits  # noqa: PLC0415 - light start

        bound = under_limits(system.graph, bound, system.vocabulary.hierarchy, limits)
    earlier = before.analysis.spread if before else None
    analysis = analyse(system.graph, bound, system.vocabulary.hierarchy, options, earlier)
    if bound is not system.bound:
        analysis = _under_types(system, options, analysis)
    elif limits and system.graph.view == View.declared:
        analysis = replace(analysis, closed=ClosedByTypes())
    view = _view(system, analysis, groups) if system.is_fleet else None
    if view and options.uncounted and options.count_paths:
        analysis, view = _counted(replace(system, bound=bound), options, analysis, view)
    return concluded(replace(system, bound=bound), question, analysis, view, options)


def _under_lines(system: System, question: Question) -> System:
    """A system with what its lines ``only: by-type`` close, and with what a reader has to know of them."""
    if not any(one.role == TYPE_LINE for said in system.bound.elements.values() for one in said):
        return system
    from rosprivacy.analysis.kernel.by_type import under_lines  # noqa: PLC0415 - light start

    hierarchy = system.vocabulary.hierarchy
    bound, said = under_lines(system.graph, system.bound, hierarchy, question.types() if question.types else None)
    return replace(system, bound=bound, diagnostics=(*system.diagnostics, *said))


def _under_types(system: System, options: Options, under: Analysis) -> Analysis:
    """An analysis under what types cannot carry, with what only this closes, by an analysis of the whole without it.

    A type reviews nothing: what lies behind a limit is as open as before (rule S15). The verdict follows from that.
    """
    from rosprivacy.analysis.kernel.type_limits import closed  # noqa: PLC0415 - light start

    chosen = _closed(system, under) if options.choose else None
    hierarchy = system.vocabulary.hierarchy
    without = analyse(system.graph, system.bound, hierarchy, options._replace(choose=chosen, paths=Paths.witness))
    gone = chosen.of(without.findings) if chosen else _closed_by_limits(system, under, without)
    mask = sum(under.spread.forms_of(category) for category in under.emitted)
    leak = any(finding.stands for finding in under.findings)
    return replace(
        under,
        open=without.open,
        verdict=Verdict.of(leak=leak, is_open=bool(without.open), grounded=not under.lacking),
        closed=ClosedByTypes(*closed(under.spread, mask), gone),
        closed_by_lines=without.closed_by_lines,
    )


def _closed_by_limits(system: System, under: Analysis, without: Analysis) -> tuple[Finding, ...]:
    """What only limits close, where every finding is made; of robots one of each pattern."""
    left = {finding.id for finding in under.findings}
    gone = (one for one in without.findings if one.id not in left and system.likeness.count(one))
    first: dict[str, Finding] = {}
    for finding in gone:
        first.setdefault(pattern_id(finding, system.likeness), finding)
    return tuple(first.values())


def _closed(system: System, under: Analysis) -> Closed:
    from rosprivacy.analysis.fleet.patterns_of_pairs import Closed  # noqa: PLC0415 - numpy, for fleets only

    return Closed(system.likeness, under.spread)


def _groups(system: System, question: Question) -> Groups | None:
    """What chooses findings; None where all are made: decisions are about single robots, too."""
    if question.decisions is not None or (question.every and question.most_across is None):
        return None
    from rosprivacy.analysis.fleet.patterns_of_pairs import Groups  # noqa: PLC0415 - numpy, for fleets only

    return Groups(system.likeness, question.most_across)


def _view(system: System, analysis: Analysis, groups: Groups | None) -> FleetView:
    from rosprivacy.analysis.fleet.patterns import FleetView  # noqa: PLC0415 - for fleets only

    return groups.view(analysis) if groups else FleetView.of(analysis, system.likeness)


def _counted(system: System, options: Options, analysis: Analysis, view: FleetView) -> tuple[Analysis, FleetView]:
    """Count the paths of what is shown of the patterns from robot to robot, of whose findings none are counted."""
    elements = {element: vertex for vertex, element in enumerate(analysis.graph.elements)}
    chosen: dict[int, set[Chosen]] = defaultdict(set)
    for one in (pattern.finding for pattern in view.patterns if pattern.across):
        category = analysis.spread.categories.index(one.category)
        chosen[elements[one.source]].add((one.kind, elements[one.leak], category, one.plain_also))
    options, net = options._replace(uncounted=None), Net.cached(analysis.spread)
    some = chosen_findings(net, system.bound, system.vocabulary.hierarchy, options, chosen)
    counted = {finding.id: finding for finding in some}
    findings = tuple(counted.get(finding.id, finding) for finding in analysis.findings)
    patterns = (replace(one, finding=counted.get(one.finding.id, one.finding)) for one in view.patterns)
    return replace(analysis, findings=findings), replace(view, patterns=tuple(patterns))


def concluded(
    system: System,
    question: Question,
    analysis: Analysis,
    view: FleetView | None,
    options: Options,
    counts: Counts | None = None,
) -> Result:
    """Join decisions to an analysis, and say what it rests on.

    Parameters
    ----------
    analysis, view
        Of the system, under ``options``.
    counts
        As of ``Answer``.
    """
    rows = processed(analysis, system.bound, system.vocabulary.hierarchy)
    at_sources = Contexts.of(system.graph, system.bound, system.vocabulary.categories, together=system.is_fleet)
    law = law_of(system.vocabulary, analysis.emitted, at_sources.everywhere)
    analysis = replace(analysis, diagnostics=(*analysis.diagnostics, *lacks(rows, law)))
    listed = doubts(
        analysis, system.diagnostics, system.likeness.weight, restricted=question.categories_asked is not None,
        by_globs=answered_by_globs(analysis.spread, system.bound, system.vocabulary.hierarchy),
    )  # fmt: skip
    listed, remarks = doubts_decided(question.decisions, listed, everything=question.categories_asked is None)
    analysis = judged(analysis, listed)
    joined = joined_to(question.decisions, analysis, law, question.categories_asked, system.likeness, view)
    return Result(
        analysis,
        system.bound,
        system.vocabulary,
        (*system.diagnostics, *(joined.diagnostics if joined else ()), *remarks),
        assumptions_of(system.rests_on, analysis, question, typed=bool(system.bound.types)),
        joined,
        view,
        counts,
        infrastructure_of((question.element for question in analysis.open), system.vocabulary),
        accepts=options.accepts,
        doubts=listed,
        hangs_on_asked=question.settings.hangs_on or system.likeness.robots <= 1,
        hangs_on_named=question.settings.hangs_on,
        policies=system.policies,
        labels=system.labels,
        types=system.types,
        options=options,
        reanalyse=partial(_reanalyse, system.under, question) if system.under else None,
        closes=_proposed if system.policies else None,
        label_files=system.label_files,
    )


def _proposed(result: Result) -> Mapping[str, Any] | str:
    from rosprivacy.mitigation import proposed  # noqa: PLC0415 - only where a report asks for it

    return {**document} if isinstance(document := proposed(result), dict) else document


def _reanalyse(
    under: Callable[[tuple[str | Labels, ...]], System], question: Question, labels: tuple[str | Labels, ...]
) -> Result:
    return answer(under(labels), question)
