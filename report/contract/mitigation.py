"""The document ``rosprivacy.mitigation/1``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NotRequired, TypedDict

from rosprivacy.report.contract.analysis import Assumptions
from rosprivacy.report.contract.records import ElementEntry, LineEntry

if TYPE_CHECKING:
    from rosprivacy.report.contract.records import DiagnosticEntry, DoubtEntry


class Marks(TypedDict, total=False):
    """Whether an element is the leak of a finding that a proposal removes, and whether it is time-critical."""

    leak: bool
    time_critical: bool


class MarkedElement(ElementEntry, Marks):
    """An element with its marks."""


class NamedElement(TypedDict):
    """An element, or one of many with its name."""

    robot: str
    kind: str
    name: str
    leg: NotRequired[str]


Between = TypedDict("Between", {"from": MarkedElement, "to": MarkedElement})
Filtered = TypedDict("Filtered", {"from": NamedElement, "categories": list[str]})


class ChangedGrant(LineEntry):
    """A line of a policy that a proposal changes."""

    role: str
    kind: str
    name: str


class KeptEntry(TypedDict):
    """A finding that a proposal does not remove."""

    finding: str
    kind: str
    category: str
    reason: str
    way: list[ElementEntry]


class ProposedStepEntry(TypedDict):
    """A step of a proposal."""

    kind: str
    cost: int
    categories: list[str]
    between: list[Between]
    channel: MarkedElement | None
    label: dict[str, Any] | None
    policy: list[ChangedGrant]
    reaches: list[MarkedElement]
    spares: list[MarkedElement]


class StatementEntry(TypedDict):
    """What could be stated or arranged instead of a change."""

    finding: str
    kind: str
    element: ElementEntry
    category: str
    reason: str


class ProtectEntry(TypedDict):
    """A line of a governance to change."""

    file: str
    line: int
    cause: str
    channels: list[ElementEntry]
    findings: list[str]


class AffectedEntry(TypedDict):
    """An element that gets less."""

    element: MarkedElement
    filtered: list[Filtered]
    unread: list[NamedElement]
    unwritten: list[NamedElement]
    narrowed: list[NamedElement]


class ProposalEntry(TypedDict):
    """A proposal."""

    categories: list[str]
    removes: list[str]
    keeps: list[KeptEntry]
    steps: list[ProposedStepEntry]
    statements: list[StatementEntry]
    protect: list[ProtectEntry]
    cost: int
    no_cheaper_than: int
    cheapest: bool
    proven: bool
    verdict_then: str
    affected: list[AffectedEntry]


class Weights(TypedDict):
    """What a change of each kind costs."""

    review: int
    filter: int
    node: int
    deny: int


class MitigationAssumptions(Assumptions):
    """What proposals rest on."""

    kinds_of_change: list[str]
    weights: Weights
    time_critical: list[ElementEntry]


class MitigationDocument(TypedDict):
    """``rosprivacy.mitigation/1``."""

    format: str
    verdict: str
    doubts: NotRequired[list[DoubtEntry]]
    view: str
    proposals: list[ProposalEntry]
    patch: str
    why_no_patch: str
    labels_without_element: list[str]
    notes: list[str]
    diagnostics: list[DiagnosticEntry]
    assumptions: MitigationAssumptions
