"""The document ``rosprivacy.suggestions/1``."""

from __future__ import annotations

from typing import Any, TypedDict


class EvidenceEntry(TypedDict):
    """One reason: where it comes from, how sure that is, and the rule or line behind it; line 0 for no line."""

    ground: str
    confidence: str
    reason: str
    file: str
    line: int


class ProposalEntry(TypedDict):
    """A label that a person is asked about; ``label`` is what would be written under ``section`` and ``name``.

    ``kind`` is empty where it is every kind; ``hides`` says whether a wrong one could hide a leak;
    ``by_hand`` that it would take away data of a finding, so that it is not written into a label file.
    """

    section: str
    name: str
    role: str
    kind: str
    confidence: str
    open: bool
    hides: bool
    by_hand: bool
    label: dict[str, Any]
    evidence: list[EvidenceEntry]


class FileOfRun(TypedDict):
    """A file that was read."""

    file: str
    sha256: str


class SuggestionsDocument(TypedDict):
    """What a person is asked, in review order; nothing follows from it.

    ``verdict`` is that of the answer under the labels that there are.
    """

    format: str
    suggestions: list[ProposalEntry]
    verdict: str
    rules: list[FileOfRun]
    files: list[FileOfRun]
    rosprivacy: str
