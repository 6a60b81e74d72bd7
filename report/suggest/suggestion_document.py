"""Proposals of labels -> the JSON document ``rosprivacy.suggestions/1``, which is a contract."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.evidence import HIDING
from rosprivacy.analysis.suggesting.written import written

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from rosprivacy.analysis.suggesting.evidence import Evidence, Label, Proposal
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.suggested import EvidenceEntry, ProposalEntry, SuggestionsDocument

FORMAT = "rosprivacy.suggestions/1"


def suggestions_document(
    proposals: Iterable[Proposal],
    open_elements: Collection[tuple[str, str, str]],
    by_hand: Collection[Label],
    answer: Answer,
    rules: Iterable[tuple[str, str]],
) -> SuggestionsDocument:
    """Return the document.

    Parameters
    ----------
    open_elements
        Identities of the elements that are open.
    by_hand
        Labels that would take away data of which a finding is known.
    answer
        Under the labels that there are; suggestions change nothing of it.
    rules
        (file, SHA-256) of the rules.
    """
    rests_on = answer.assumptions
    read = [one for key in ("policies", "labels", "types") for one in rests_on.get(key, ())]
    return {
        "format": FORMAT,
        "suggestions": [
            _proposal(one, is_open=one.label.element.identity in open_elements, by_hand=one.label in by_hand)
            for one in proposals
        ],
        "verdict": str(answer.analysis.verdict),
        "rules": [{"file": file, "sha256": digest} for file, digest in rules],
        "files": [{"file": one["file"], "sha256": one["sha256"]} for one in read],
        "rosprivacy": rests_on["rosprivacy"],
    }


def _proposal(one: Proposal, *, is_open: bool, by_hand: bool) -> ProposalEntry:
    at = written(one.label)
    return {
        "section": at.section,
        "name": at.name,
        "role": one.label.role,
        "kind": one.label.kind,
        "confidence": str(one.confidence),
        "open": is_open,
        "hides": one.label.role in HIDING,
        "by_hand": by_hand,
        "label": at.said,
        "evidence": [_evidence(reason) for reason in one.evidence],
    }


def _evidence(reason: Evidence) -> EvidenceEntry:
    return {
        "ground": reason.ground,
        "confidence": str(reason.confidence),
        "reason": reason.reason,
        "file": reason.place.file,
        "line": reason.place.line,
    }
