"""Decisions taken into account: the file is read, and joined to what was found."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.decisions import decided
from rosprivacy.ontology.special import special_provision

if TYPE_CHECKING:
    from rosprivacy.analysis.decisions import Decided, Decisions
    from rosprivacy.analysis.model import Analysis
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


def decisions_of(settings: Settings, vocabulary: Vocabulary) -> Decisions | None:
    """Read the decisions file, if one is named."""
    if settings.decisions is None:
        return None
    from rosprivacy.ingest.decisions import read_decisions, today  # noqa: PLC0415 - only where there are some

    return read_decisions(settings.decisions, vocabulary, settings.today or today())


def joined_to(
    decisions: Decisions | None, analysis: Analysis, vocabulary: Vocabulary, asked: set[str] | None
) -> Decided | None:
    """Join decisions to findings; where only some categories were asked for, none is called orphaned."""
    if decisions is None:
        return None
    special = {name: special_provision(vocabulary, name) for name in analysis.emitted}
    held = {name: provision for name, provision in special.items() if provision}
    return decided(decisions, analysis.findings, held, everything=asked is None)
