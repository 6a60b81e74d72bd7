"""The document ``rosprivacy.analysis/1``, and what the answer rests on."""

from __future__ import annotations

from typing import TYPE_CHECKING, NotRequired, TypedDict

from rosprivacy.report.contract.records import FileEntry

if TYPE_CHECKING:
    from rosprivacy.report.contract.fleet import FleetEntry
    from rosprivacy.report.contract.records import (
        DeniedEntry,
        DiagnosticEntry,
        DoubtEntry,
        ElementEntry,
        EnclaveEntry,
        FindingEntry,
        GlobEntry,
        LedgerRow,
        ListedDecision,
        OpenEntry,
        PlaceEntry,
        Reached,
        RelianceEntry,
        Stopped,
        UnknownEnd,
    )
    from rosprivacy.report.contract.stated import (
        Carried,
        CategoryEntry,
        ContextEntry,
        DerivationEntry,
        NonRosEntry,
        OverruledEntry,
        PointerEntry,
        ProcessedEntry,
        ProcessingEntry,
        RolesEntry,
        SanitizerEntry,
        SubjectsEntry,
        SurroundingsEntry,
        TypesEntry,
        WaysEntry,
    )


class NoMethod(TypedDict):
    """A sanitizer whose method nobody states."""

    element: ElementEntry
    category: str
    taken_as: str


class AbsentEntry(TypedDict):
    """A node that has a profile and is not on the robot, on a person's word."""

    element: ElementEntry
    why: str


class DatabaseEntry(TypedDict):
    """The database that was read."""

    robots: int


class StandardFile(FileEntry):
    """The file of standard channels, and how many it takes as mundane."""

    taken: int


ObservedEntry = TypedDict("ObservedEntry", {"from": str, "to": str, "by": list[str]})  # empty where a file does not say


class TypesFileEntry(FileEntry):
    """A file of observed message types, and when they were observed."""

    observed: ObservedEntry


class TypeLimitsFile(FileEntry):
    """The table of what message types cannot carry, and how many flows it closes."""

    flows: int


class ClosedEntry(TypedDict):
    """A finding that there would be if types limited nothing."""

    id: str
    kind: str
    category: str
    source: ElementEntry
    leak: ElementEntry
    dismissed: bool


class DecisionsFile(FileEntry):
    """The file of decisions, and the day that they are looked at."""

    today: str


class Given(TypedDict):
    """What an answer rests on, as far as it comes from the files and the question."""

    rosprivacy: str
    view: str
    ontologies: list[FileEntry]
    law_as_of: str
    unlabelled_node: str
    unlabelled_channel: str
    categories_asked: str | list[str]
    article9_only: bool
    article9_level: NotRequired[str]
    data_types_asked: str | list[str]
    identity_factors_asked: NotRequired[list[str]]
    may_be_asked: NotRequired[dict[str, list[str]]]
    paths: str
    max_paths: int
    countries_as_of: NotRequired[str]
    policies: list[FileEntry]
    labels: list[FileEntry]
    fleet: NotRequired[list[FileEntry]]
    types: NotRequired[list[TypesFileEntry]]
    type_limits: NotRequired[TypeLimitsFile | None]
    type_limits_reached: NotRequired[list[Reached]]
    closed_by_types: NotRequired[list[ClosedEntry]]
    standard_channels: StandardFile | None
    database: NotRequired[DatabaseEntry]
    decisions: NotRequired[DecisionsFile]
    engine: NotRequired[str]


class Assumptions(Given):
    """What an answer rests on."""

    taken_away_by: NotRequired[dict[str, int]]
    taken_by_kind: dict[str, str]
    backups_taken_as_none: NotRequired[list[ElementEntry]]
    sanitizers_without_method: list[NoMethod]
    standard_channels_reached: NotRequired[list[Stopped]]
    standard_channels_unchanged: NotRequired[list[ElementEntry]]
    overruled: NotRequired[list[OverruledEntry]]
    absent: NotRequired[list[AbsentEntry]]
    globs: NotRequired[list[GlobEntry]]


class MoveEntry(TypedDict):
    """A profile that would get an enclave of its own."""

    enclave: str
    profile: str


class DenyEntry(TypedDict):
    """A DENY line that nobody has written yet, and where it would stand; it holds for the whole enclave."""

    file: str
    enclave: str
    profile: str
    role: str
    channel: ElementEntry


class LostEntry(TypedDict):
    """What a node could no longer do that its own profile allows."""

    node: ElementEntry
    role: str
    channel: ElementEntry


class AddedEntry(TypedDict):
    """A finding that only the enforced view has, the enclaves that make it possible, and what ends it."""

    finding: FindingEntry
    beyond: NotRequired[list[int]]
    enclaves: list[str]
    split: list[str]
    move: NotRequired[MoveEntry | None]
    deny: NotRequired[list[DenyEntry]]
    loses: NotRequired[list[LostEntry]]
    robots: NotRequired[list[str]]
    opened_by: NotRequired[list[PlaceEntry]]
    plain: NotRequired[bool]


class EnforcedEntry(TypedDict):
    """What the enforced view adds to the declared one (rule S6)."""

    verdict: str
    unreviewed: NotRequired[int]
    open: NotRequired[list[ElementEntry]]
    added: list[AddedEntry]


class NotAsked(TypedDict):
    """A key that is not there because nobody asked for it, and the option that asks."""

    key: str
    option: str


class HangsOn(TypedDict):
    """What the answer hangs on, or that it was not asked for."""

    hangs_on: NotRequired[list[RelianceEntry]]
    not_asked: NotRequired[list[NotAsked]]


class AnalysisDocument(HangsOn):
    """``rosprivacy.analysis/1``."""

    format: str
    verdict: str
    view: str
    categories: list[CategoryEntry]
    findings: list[FindingEntry]
    open: list[OpenEntry]
    unknown_ends: NotRequired[list[UnknownEnd]]
    doubts: NotRequired[list[DoubtEntry]]
    sentence: NotRequired[str]
    taken_away: NotRequired[list[LedgerRow]]
    carries: list[Carried]
    roles: NotRequired[list[RolesEntry]]
    outside: list[NonRosEntry]
    subjects: list[SubjectsEntry]
    ways: NotRequired[list[WaysEntry]]
    surroundings: NotRequired[list[SurroundingsEntry]]
    types: NotRequired[list[TypesEntry]]
    contexts: NotRequired[list[ContextEntry]]
    look_at: NotRequired[list[PointerEntry]]
    processing: NotRequired[list[ProcessingEntry]]
    processed_for: NotRequired[list[ProcessedEntry]]
    sanitizers: list[SanitizerEntry]
    derivations: list[DerivationEntry]
    unreached: list[ElementEntry]
    enclaves: list[EnclaveEntry]
    flows: int
    denied_flows: NotRequired[int]
    denied: NotRequired[list[DeniedEntry]]
    elements: int
    standard_channels: int
    diagnostics: list[DiagnosticEntry]
    assumptions: Assumptions
    decisions: NotRequired[list[ListedDecision]]
    fleet: NotRequired[FleetEntry]
    enforced: NotRequired[EnforcedEntry]
