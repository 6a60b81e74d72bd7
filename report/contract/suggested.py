"""The document ``rosprivacy.suggestions/1``."""

from __future__ import annotations

from typing import Any, NotRequired, TypedDict


class EvidenceEntry(TypedDict):
    """One reason: where it comes from, how sure that is, and the rule or line behind it; line 0 for no line."""

    ground: str
    confidence: str
    reason: str
    file: str
    line: int


class ProposalEntry(TypedDict):
    """A label that a person is asked about; ``label`` is what would be written under ``section`` and ``name``.

    ``robot`` is empty where there is only one, ``kind`` where it is every kind; ``hides`` says whether a wrong one
    could hide a leak; ``by_hand`` that it would take away data of a finding: it is not written into a label file.
    """

    robot: str
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


class ModelEntry(TypedDict):
    """What was asked of a language model: where, and how many of its answers were left out, by reason.

    ``unread`` counts requests without an answer that can be read; ``masked`` says whether names were masked,
    ``recorded`` when the answers were recorded; it is empty if the model was asked in this run.
    """

    name: str
    url: str
    masked: bool
    recorded: str
    requests: int
    unread: dict[str, int]
    dropped: dict[str, int]


class UnplacedUse(TypedDict):
    """What source code uses of a library, where nobody knows of which node."""

    uses: str
    file: str
    line: int


class UnreadCode(TypedDict):
    """Source code that could not be read; line 0 for no line."""

    file: str
    line: int
    problem: str


class RobotEntry(TypedDict):
    """A robot of a fleet that is asked about, and all that are alike, itself first; ``model`` is empty without one."""

    robot: str
    model: str
    alike: list[str]


class NoticeEntry(TypedDict):
    """What a reader has to know of a file."""

    file: str
    line: int
    message: str


class SuggestionsDocument(TypedDict):
    """What a person is asked, in review order; nothing follows from it.

    ``verdict`` is that of the answer under the labels that there are; ``model`` is there only if one was asked.
    """

    format: str
    suggestions: list[ProposalEntry]
    unplaced: list[UnplacedUse]
    unread: list[UnreadCode]
    of_others: list[str]
    verdict: str
    rules: list[FileOfRun]
    files: list[FileOfRun]
    model: NotRequired[ModelEntry]
    robots: list[RobotEntry]
    notices: list[NoticeEntry]
    rosprivacy: str
