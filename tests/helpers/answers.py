"""Answers made of an analysis, with decisions and facts as a test wants them; and what a format says of one."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.decisions import Choice, Decided, Decision, Decisions, State
from rosprivacy.analysis.model import Bound, NonRosFacts, Place
from rosprivacy.answer import Answer
from rosprivacy.formats import written

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Diagnostic, Element
    from rosprivacy.ontology.vocabulary import Vocabulary


def answer_of(
    analysis: Analysis,
    vocabulary: Vocabulary,
    assumptions: dict[str, Any],
    diagnostics: Iterable[Diagnostic] = (),
    outside: Mapping[Element, NonRosFacts] | None = None,
    bound: Bound | None = None,
) -> Answer:
    """An answer about a system that stands in no file."""
    if outside is not None:
        analysis = replace(analysis, outside=outside)
    return Answer(analysis, bound or Bound({}), vocabulary, tuple(diagnostics), assumptions)


def accepting(answer: Answer, why: Mapping[str, str]) -> Answer:
    """An answer some of whose findings a person accepts: id -> reason."""
    entries = tuple(Decision(Choice.ACCEPT, Place("decisions.yaml", 1), id=one, reason=why[one]) for one in why)
    decisions = Decisions("decisions.yaml", "0" * 64, "2026-01-01", entries, answer.vocabulary.hierarchy)
    on = dict(zip(why, entries, strict=True))
    decided = Decided(decisions, on, tuple((one,) for one in why), (State.VALID,) * len(why), ())
    findings = tuple(replace(f, accepted=f.id in why) for f in answer.analysis.findings)
    return replace(answer, analysis=replace(answer.analysis, findings=findings), decided=decided)


def as_json(answer: Answer, name: str) -> dict[str, Any]:
    """An answer in a format that is JSON."""
    read: dict[str, Any] = json.loads(written(answer, name))
    return read
