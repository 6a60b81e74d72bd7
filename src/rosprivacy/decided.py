"""Decisions taken into account: the file is read, and joined to what was found.

On a fleet a decision is about patterns, or about robots by name: what a robot stands for is decided as it is.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.decisions import Case, decided
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS, pattern_of
from rosprivacy.clock import judged_on, today

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.decisions import Decided, Decisions
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


def decisions_of(settings: Settings, vocabulary: Vocabulary) -> Decisions | None:
    """Read the decisions file, if one is named."""
    if settings.decisions is None:
        return None
    from rosprivacy.ingest.decisions.decisions_file import read_decisions  # noqa: PLC0415 - only where there are some

    found = read_decisions(settings.decisions, vocabulary, settings.today or today(os.environ), settings.bounds)
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
    vocabulary: Vocabulary,
    asked: Collection[str] | None,
    likeness: Likeness = NO_ROBOTS,
    contexts: Contexts | None = None,
) -> Decided | None:
    """Join decisions to findings; where only some categories were asked for, none is called orphaned.

    Parameters
    ----------
    contexts
        Of the sources: what data may reveal there needs a ground as what they may reveal anywhere.
    """
    if decisions is None:
        return None
    said = {name: list(vocabulary.categories[name].law) for name in analysis.emitted}
    for finding in analysis.findings if contexts else ():
        said[finding.category] += contexts.revealed(finding) if contexts else ()
    law = {name: tuple(dict.fromkeys((one.name, one.verdict) for one in several)) for name, several in said.items()}

    def case_of(finding: Finding) -> Case:
        return in_fleet(Case.of(finding), likeness)

    return decided(decisions, analysis.findings, law, everything=asked is None, case_of=case_of)


def accepts(decisions: Decisions | None, likeness: Likeness = NO_ROBOTS) -> Callable[[Case], bool] | None:
    """Return the test whether a case is accepted; None where nobody decided anything."""
    if decisions is None:
        return None
    return lambda case: decisions.accepts(in_fleet(case, likeness))


def in_fleet(case: Case, likeness: Likeness) -> Case:
    """Return a case with its pattern and robots; where it stands for more than itself it has no id of its own."""
    ends = case.source, case.leak
    pattern = pattern_of(case.kind, case.category, *ends, likeness, beside=case.beside)
    source, leak = (end.robot if likeness.is_robot(end.robot) else "" for end in ends)
    own = case.id if likeness.alone(*ends) else ""
    return replace(case, id=own, pattern=pattern, robots=(source, leak))
