"""Decisions taken into account: the file is read, and joined to what was found.

On a fleet a decision is about patterns, or about robots by name: what a robot stands for is decided as it is.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.contexts import revealed
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS, pattern_of
from rosprivacy.clock import judged_on, today

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.decisions import Decided, Decisions
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.legal import Verdicts
    from rosprivacy.analysis.model import Diagnostic, Doubt, Element
    from rosprivacy.analysis.remembered import About
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


def decisions_of(settings: Settings, vocabulary: Vocabulary) -> Decisions | None:
    """Read the log of decisions, or the decisions file, if one is named."""
    if settings.decisions is None:
        return None
    from rosprivacy.ingest.decisions.decision_log import read_log_or_file  # noqa: PLC0415 - only where there are some

    return judged(read_log_or_file(settings.decisions, vocabulary, "", settings.bounds), settings)


def judged(decisions: Decisions, settings: Settings) -> Decisions:
    """Return decisions on the day that a user names, else on that of now (rule S14)."""
    found = replace(decisions, today=settings.today or today(os.environ))
    return found if settings.today else not_revived(found, judged_on(os.environ))


def not_revived(decisions: Decisions, latest: str) -> Decisions:
    """Return decisions on a later day if one has expired by then: no fixed date of a build revives it (S14).

    Where none has, the fixed date stays, and the answer is the same on every day.
    """
    later = replace(decisions, today=latest, instead_of=decisions.today)
    return later if any(later.state(entry) != decisions.state(entry) for entry in decisions.entries) else decisions


def joined_to(
    decisions: Decisions | None,
    analysis: Analysis,
    law: Mapping[str, Verdicts],
    asked_for: Collection[str] | None,
    likeness: Likeness = NO_ROBOTS,
    view: FleetView | None = None,
) -> Decided | None:
    """Join decisions to findings; where only some categories were asked for, none is called orphaned.

    Parameters
    ----------
    law
        Of ``law_of``.
    """
    if decisions is None:
        return None
    from rosprivacy.analysis.decisions import decided  # noqa: PLC0415 - light start

    def case_of(finding: Finding) -> Case:
        return in_fleet(Case.of(finding), likeness)

    now = about_today(analysis, view)
    return decided(decisions, analysis.findings, law, everything=asked_for is None, case_of=case_of, now=now)


def doubts_decided(
    decisions: Decisions | None, doubts: tuple[Doubt, ...], *, everything: bool
) -> tuple[tuple[Doubt, ...], tuple[Diagnostic, ...]]:
    """Return doubts with what people accepted of them, and what is to be said of such decisions (rule S11)."""
    if decisions is None or not decisions.doubts:
        return doubts, ()
    return decisions.on_doubts(doubts, everything=everything)


def about_today(analysis: Analysis, view: FleetView | None) -> dict[str, About]:
    """Return what a decision would be made about today, by id: of each finding and row, of a fleet of each pattern.

    Of a fleet what is stated of a place stands under the id of the row of its robot.
    """
    from rosprivacy.analysis.model.register_row import row_id  # noqa: PLC0415 - light start
    from rosprivacy.analysis.remembered import About, stated_of  # noqa: PLC0415

    def about(finding: Finding, robots: Iterable[str] = ()) -> About:
        path = tuple(element.name for element in finding.witness)
        return About(analysis.graph.view, path, finding.number_of_paths or 0, frozenset(robots))

    found = {finding.id: about(finding) for finding in analysis.findings}
    found |= {
        row_id(finding.category, [finding.leak]): About(stated=stated_of(_stated(analysis, finding.leak)))
        for finding in analysis.findings
    }
    if view is None:
        return found
    from rosprivacy.analysis.fleet.robots_of_rows import row_robots  # noqa: PLC0415 - for fleets only

    everywhere = {robot for robots in view.likeness.members.values() for robot in robots}
    found |= {p.id: about(p.finding, everywhere if p.across else p.robots) for p in view.patterns}
    for name, row in row_robots(view).items():
        robots, from_robots = frozenset(row.robots), frozenset(row.from_robots)
        found[name] = replace(found.get(name, About()), robots=robots, from_robots=from_robots)
    return found


def _stated(analysis: Analysis, place: Element) -> Mapping[str, object]:
    """What is stated of a place outside ROS; nothing of a node."""
    facts = analysis.outside.get(place)
    return facts._asdict() if facts else {}


def law_of(vocabulary: Vocabulary, categories: Iterable[str], contexts: Collection[str] = ()) -> dict[str, Verdicts]:
    """Return what can apply to data of some categories, in some contexts too: (provision, verdict)."""
    kinds = [vocabulary.categories[name] for name in categories]
    return {
        kind.name: tuple((legal.name, legal.verdict) for legal in (*kind.law, *revealed(kind, contexts)))
        for kind in kinds
    }


def accepts(decisions: Decisions | None, likeness: Likeness = NO_ROBOTS) -> Callable[[Case], bool] | None:
    """Return the test whether a case is accepted; None where nobody decided anything."""
    if decisions is None:
        return None
    return lambda case: decisions.accepts(in_fleet(case, likeness))


def in_fleet(case: Case, likeness: Likeness) -> Case:
    """Return a case with its pattern and robots; where it stands for more than itself it has no id of its own."""
    from rosprivacy.analysis.fleet.robots_of_rows import row_pattern  # noqa: PLC0415 - where somebody decided

    ends = case.source, case.leak
    row = row_pattern(case.category, case.leak, likeness)
    pattern = pattern_of(case.kind, case.category, *ends, likeness, plain_also=case.plain_also)
    source, leak = (end.robot if likeness.is_robot(end.robot) else "" for end in ends)
    own = case.id if likeness.alone(*ends) else ""
    return case._replace(id=own, pattern=pattern, row=row, robots=(source, leak))
