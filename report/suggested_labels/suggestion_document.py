"""Proposals of labels -> the JSON document ``rosprivacy.suggestions/1``, which is a contract."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.suggesting.evidence import HIDING, written

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Diagnostic
    from rosprivacy.analysis.suggesting.evidence import Evidence, LabelProposal, SuggestedLabel
    from rosprivacy.analysis.suggesting.library_rules import NodeUse
    from rosprivacy.report.schemas.suggested import EvidenceEntry, ModelEntry, ProposalEntry, SuggestionsDocument

FORMAT = "rosprivacy.suggestions/1"


def suggestions_document(
    proposals: Iterable[LabelProposal],
    open_elements: Collection[tuple[str, str, str]],
    by_hand: Collection[SuggestedLabel],
    verdict: str,
    rests_on: Mapping[str, Any],
    likeness: Likeness,
    rules: Iterable[tuple[str, str]],
    model: ModelEntry | None = None,
    unplaced: Iterable[NodeUse] = (),
    unread: Iterable[InputError] = (),
    of_others: Iterable[str] = (),
    notices: Iterable[Diagnostic] = (),
) -> SuggestionsDocument:
    """Return the document.

    Parameters
    ----------
    open_elements
        Identities of the elements that are open.
    by_hand
        Labels that would take away data of which a finding is known.
    verdict, rests_on
        Of the answer under the labels that there are, with its assumptions; suggestions change nothing of it.
    likeness
        Which robots stand for which.
    rules
        (file, SHA-256) of the rules.
    model
        What was asked of a language model.
    unplaced
        Uses of libraries that a rule speaks about, and that belong to no node that is known here.
    unread
        What source code could not be read.
    of_others
        Folders with code of others that were left out.
    notices
        What a reader has to know of the packages.
    """
    read = [one for key in ("policies", "labels", "types") for one in rests_on.get(key, ())]
    document: SuggestionsDocument = {
        "format": FORMAT,
        "suggestions": [
            _proposal(one, is_open=one.label.element.identity in open_elements, by_hand=one.label in by_hand)
            for one in proposals
        ],
        "unplaced": [{"uses": one.name, "file": one.place.file, "line": one.place.line} for one in unplaced],
        "unread": [{"file": one.file, "line": one.line, "problem": one.problem} for one in unread],
        "of_others": [*of_others],
        "verdict": verdict,
        "rules": [{"file": file, "sha256": digest} for file, digest in rules],
        "files": [{"file": one["file"], "sha256": one["sha256"]} for one in read],
        "robots": [
            {"robot": name, "model": likeness.models.get(name, ""), "alike": list(alike)}
            for name, alike in sorted(likeness.members.items())
        ],
        "notices": [{"file": one.place.file, "line": one.place.line, "message": one.message} for one in notices],
        "rosprivacy": rests_on["rosprivacy"],
    }
    if model:
        document["model"] = model
    return document


def _proposal(proposal: LabelProposal, *, is_open: bool, by_hand: bool) -> ProposalEntry:
    at = written(proposal.label)
    return {
        "robot": proposal.label.element.robot,
        "section": at.section,
        "name": at.name,
        "role": proposal.label.role,
        "kind": proposal.label.kind,
        "confidence": str(proposal.confidence),
        "open": is_open,
        "hides": proposal.label.role in HIDING,
        "by_hand": by_hand,
        "label": at.roles,
        "evidence": [_evidence(reason) for reason in proposal.evidence],
    }


def _evidence(reason: Evidence) -> EvidenceEntry:
    return {
        "ground": reason.ground,
        "confidence": str(reason.confidence),
        "reason": reason.reason,
        "file": reason.place.file,
        "line": reason.place.line,
    }
