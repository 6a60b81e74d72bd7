"""The document ``rosprivacy.mitigation/1``."""

from typing import Annotated, Any

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.analysis import Assumptions
from rosprivacy.report.schemas.notation import (
    Always,
    Cause,
    Change,
    Count,
    Id,
    Keywords,
    Leg,
    Positive,
    Verdict,
    View,
    closed,
    one_of,
    without_keys_of,
)
from rosprivacy.report.schemas.records import DiagnosticEntry, DoubtEntry, LineEntry


@closed
class NamedElement(TypedDict):
    """An element, or one of many with its name."""

    robot: str
    kind: str
    name: str
    leg: NotRequired[Leg]


@closed
class PlainElement(NamedElement):
    """An element; of what kinds there are is said by ``ElementEntry``."""

    pattern: NotRequired[Always]


class Marks(TypedDict, total=False):
    """Whether an element is the leak of a finding that a proposal removes, and whether it is time-critical."""

    leak: Annotated[Always, "Of a finding that the proposal removes."]
    time_critical: Always


@closed
class MarkedElement(PlainElement, Marks):
    """An element with its marks."""


Between = TypedDict("Between", {"from": MarkedElement, "to": MarkedElement})
Filtered = TypedDict("Filtered", {"from": NamedElement, "categories": list[str]})


class ChangedGrant(LineEntry):
    """A line of a policy that a proposal changes."""

    role: str
    kind: str
    name: str


class KeptEntry(TypedDict):
    """A finding that a proposal does not remove."""

    finding: Id
    kind: Annotated[str, one_of("disclosure", "storage-limitation", "third-country-transfer")]
    category: str
    reason: Annotated[
        str,
        one_of("itself", "not-allowed"),
        "itself: the source is the leak. not-allowed: no change is allowed on the way.",
    ]
    way: list[PlainElement]


SettingEntry = TypedDict(
    "SettingEntry",
    {
        "channels": Annotated[str, one_of("topic", "service", "action")],
        "in": Annotated[str, one_of("parameter", "configuration file", "command line")],
        "do": Annotated[str, one_of("set", "take out"), "Set it so, or take what is written out of it."],
        "text": str,
        "note": str,
    },
)


class SettingSourceEntry(TypedDict):
    """What a setting was read in."""

    at: str
    commit: str
    files: list[str]
    read: Annotated[str, "The day."]


class LeftOutEntry(TypedDict):
    """How a person makes a bridge or a recorder leave channels out."""

    node: MarkedElement
    program: Annotated[str, one_of("bridge", "recorder")]
    package: str
    confidence: Annotated[str, one_of("likely", "may"), "How sure it is that the node is of the package."]
    agrees: Annotated[str, "By what it is recognised."]
    channels: Annotated[list[PlainElement], "To be left out: the data of the findings gets to the node through them."]
    write: Annotated[list[SettingEntry], "What to write; of one kind of channel any one of them."]
    sources: list[SettingSourceEntry]


class ProposedStepEntry(TypedDict):
    """A step of a proposal."""

    kind: Change
    cost: Positive
    categories: Annotated[
        list[str], "That a filter has to end, or a review has to find are not carried; empty for deny."
    ]
    between: Annotated[list[Between], "Of a filter; several under the enforced view."]
    channel: Annotated[MarkedElement | None, "To review."]
    label: Annotated[dict[str, Any] | None, "What a label file says if the review finds none."]
    policy: list[ChangedGrant]
    reaches: Annotated[list[MarkedElement], "Who gets filtered data, or loses data, directly."]
    spares: Annotated[
        list[MarkedElement], "Who would get filtered data from a filter on the other side of the channel."
    ]


@closed
class StatementEntry(TypedDict):
    """What could be stated or arranged instead of a change."""

    finding: Id
    kind: Annotated[str, one_of("storage-limitation", "third-country-transfer")]
    element: PlainElement
    category: str
    reason: Annotated[str, "Why it is a finding."]


@closed
class ProtectEntry(TypedDict):
    """A line of a governance to change."""

    file: str
    line: Count
    cause: Annotated[
        Cause,
        "not-encrypted: the topic rule there encrypts nothing, and nor does its domain. strangers: the domain "
        "rule there lets a participant without a certificate join.",
    ]
    channels: list[PlainElement]
    findings: list[Id]


class AffectedEntry(TypedDict):
    """An element that gets less."""

    element: MarkedElement
    filtered: list[Filtered]
    unread: list[NamedElement]
    unwritten: list[NamedElement]
    narrowed: Annotated[list[NamedElement], "Wildcards that give fewer names."]


class ProposalEntry(TypedDict):
    """A proposal."""

    categories: list[str]
    removes: Annotated[list[Id], "Findings."]
    keeps: list[KeptEntry]
    settings: Annotated[
        list[LeftOutEntry],
        "What a person would set first, of bridges, then of recorders that the removed findings are about. The program "
        "keeps to it, not DDS security: what the policy grants stays granted. The steps and the proof know nothing of "
        "it.",
    ]
    steps: Annotated[list[ProposedStepEntry], "Empty if nothing can be removed or no proposal could be proven."]
    statements: Annotated[
        list[StatementEntry],
        "What could be stated instead, of findings about storages and transfers, if it is so or can be arranged.",
    ]
    protect: Annotated[
        list[ProtectEntry],
        "Lines of governances to change, for findings of unprotected channels: no flow changes with them. When "
        "all are changed, these findings end; verdict_then is about that.",
    ]
    cost: Count
    no_cheaper_than: Annotated[Count, "No set of such changes costs less."]
    cheapest: Annotated[bool, "Whether the cost is that bound."]
    proven: Annotated[
        bool, "A new analysis with the steps applied has no open finding of the categories but those kept."
    ]
    verdict_then: Verdict
    affected: Annotated[list[AffectedEntry], "What gets less, once the reviews are done."]


class Weights(TypedDict):
    """What a change of each kind costs."""

    review: Positive
    filter: Positive
    node: Positive
    deny: Positive


@without_keys_of(Assumptions)
class MitigationAssumptions(Assumptions):
    """What proposals rest on."""

    kinds_of_change: list[Change]
    weights: Weights
    time_critical: list[PlainElement]


class MitigationDocument(TypedDict):
    """What `rosprivacy mitigate --format json` prints. Keys that are listed here stay; more may be added."""

    format: Annotated[str, Keywords(const="rosprivacy.mitigation/1")]
    verdict: Annotated[Verdict, "Of the system as it is."]
    doubts: Annotated[
        NotRequired[list[DoubtEntry]], Keywords(items=True), "As in rosprivacy.analysis/1: of the system as it is."
    ]
    view: View
    proposals: Annotated[
        list[ProposalEntry], "Per category with an open finding, and for all together, last, where there are several."
    ]
    patch: Annotated[str, "Unified diff that sets the last proposal's lines to DENY; empty if there are none."]
    why_no_patch: Annotated[str, "Why none could be made; else empty."]
    labels_without_element: Annotated[list[str], "Labels that name nothing any more once the patch is applied."]
    notes: list[str]
    diagnostics: Annotated[list[DiagnosticEntry], Keywords(items=True), "As in rosprivacy.analysis/1."]
    assumptions: Annotated[MitigationAssumptions, "Those of rosprivacy.analysis/1, and these."]
