"""What a person is asked about the elements of an answer, and as JSON."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Diagnostic
    from rosprivacy.analysis.suggesting.evidence import Label, Proposal
    from rosprivacy.analysis.suggesting.library_rules import NodeUse
    from rosprivacy.report.contract.suggested import ModelEntry, SuggestionsDocument
    from rosprivacy.result import Result

Identity = tuple[str, str, str]  # identity of an element


@dataclass(frozen=True, slots=True, repr=False)
class Suggested:
    """What a person is asked.

    Attributes
    ----------
    proposals
        In review order: open elements, then sources and leaks, then the others.
    open
        Identities of the elements that are open.
    by_hand
        Labels that would take away data of which a finding is known: they are told, and not written into a label file.
    result
        The answer that they belong to.
    rules
        (file, SHA-256) of the rules.
    model
        What was asked of a language model, if one was asked.
    unplaced
        Uses of libraries in source code that a rule speaks about, and that belong to no node that is known here.
    unread
        What source code could not be read.
    of_others
        Folders with code of others that were left out.
    notices
        What a reader has to know of the packages, and of names in source code.
    """

    proposals: tuple[Proposal, ...]
    open: frozenset[Identity]
    by_hand: frozenset[Label]
    result: Result
    rules: tuple[tuple[str, str], ...]
    model: ModelEntry | None = None
    unplaced: tuple[NodeUse, ...] = ()
    unread: tuple[InputError, ...] = ()
    of_others: tuple[str, ...] = ()
    notices: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        """Tell how much is asked."""
        return f"<Suggested: {counted(len(self.proposals), 'question')}>"

    def document(self) -> SuggestionsDocument:
        """Return the JSON document ``rosprivacy.suggestions/1``."""
        from rosprivacy.report.suggest.suggestion_document import suggestions_document  # noqa: PLC0415 - light start

        return suggestions_document(
            self.proposals,
            self.open,
            self.by_hand,
            self.result,
            self.rules,
            self.model,
            self.unplaced,
            self.unread,
            self.of_others,
            self.notices,
        )
