"""What stands in the rows of a document: elements, files, lines, findings, decisions, open questions, the ledger."""

from __future__ import annotations

from typing import NotRequired, TypedDict


class ElementEntry(TypedDict):
    """An element."""

    robot: str
    kind: str
    name: str
    leg: NotRequired[str]
    pattern: NotRequired[bool]


class FileEntry(TypedDict):
    """A file that was read."""

    file: str
    sha256: str


class PlaceEntry(TypedDict):
    """A line of a file."""

    file: str
    line: int


class SeenEntry(TypedDict):
    """When a grant of an observed policy was seen in use, and through which doors (rule S16)."""

    by: list[str]
    first: str
    last: str


class LineEntry(PlaceEntry):
    """A line of a policy."""

    enclave: str
    profile: str


class GrantEntry(LineEntry):
    """A line that allows or denies something; where it was seen in use, when."""

    seen: NotRequired[SeenEntry]


class Reached(TypedDict):
    """An element, and the categories there."""

    element: ElementEntry
    categories: list[str]


class Stopped(Reached):
    """A channel that a shipped file takes as mundane, what stops there, and the nearest leak that it keeps it from."""

    keeps_from: NotRequired[ElementEntry]


class StepEntry(TypedDict):
    """A step of a witness."""

    role: str
    category: str
    pseudonymised: bool
    policy: list[GrantEntry]


class ChangedSince(TypedDict):
    """What is not as it was when a decision was made: view, path, disjoint_paths or robots."""

    what: str
    before: str
    now: str


class DecisionEntry(TypedDict):
    """What was decided."""

    choice: str
    state: str
    reason: str
    owner: str
    legal_basis: list[str]
    date: str | None
    expires: str | None
    ticket: str | None
    file: str
    line: int
    changed: NotRequired[list[ChangedSince]]


class LawEntry(TypedDict):
    """A provision that a finding's data can fall under."""

    provision: str
    verdict: str
    condition: str


class ContextLaw(LawEntry):
    """What a finding's data may reveal in a context."""

    context: str


class WhyEntry(TypedDict):
    """A reason as a key and values, for words of any language."""

    key: str
    values: dict[str, str]


class FindingMore(TypedDict, total=False):
    """What only some findings have."""

    in_context: list[ContextLaw]  # absent in earlier versions

    reason: str
    because: WhyEntry
    beside_pseudonymised: bool
    paths: list[list[ElementEntry]]
    paths_bounded: bool
    decision: DecisionEntry | None


class FindingEntry(FindingMore):
    """A finding."""

    id: str
    kind: str
    category: str
    pseudonymised: bool
    source: ElementEntry
    leak: ElementEntry
    witness: list[ElementEntry]
    steps: NotRequired[list[StepEntry]]
    disjoint_paths: int | None
    through: list[ElementEntry]
    dismissed: bool
    article9: str
    special_from: ElementEntry | None
    law: list[LawEntry]
    accepted: bool


class Target(TypedDict, total=False):
    """What a decision says that it is about."""

    id: str
    category: str
    source: str
    leak: str
    robot: str
    from_robot: str
    robots: list[str]
    from_robots: list[str]
    kind: str
    pseudonymised: bool


class ListedDecision(DecisionEntry):
    """An entry of the decisions file, and the findings that it is about."""

    target: Target
    findings: list[str]


class LabelKey(TypedDict):
    """Where a label file says something of an element, and under which name."""

    section: str
    name: str


class OpenEntry(TypedDict):
    """An element that nobody has reviewed."""

    element: ElementEntry
    categories: list[str]
    distance: int
    frontier: bool
    label: NotRequired[LabelKey]
    through: NotRequired[ElementEntry | None]
    closes: NotRequired[int]
    leaks: NotRequired[int]
    waits: NotRequired[bool]
    infrastructure: NotRequired[bool]
    missing: NotRequired[list[str]]


class UnknownEnd(TypedDict):
    """An end where nobody is known."""

    element: ElementEntry
    unknown: str
    categories: list[str]


class DiagnosticEntry(PlaceEntry):
    """A problem of an input."""

    severity: str
    message: str
    code: NotRequired[str]


class AcceptedDoubt(PlaceEntry):
    """Who accepted a doubt, why, and until when; the line of the decisions file."""

    reason: str
    owner: str
    expires: str
    ticket: str


class DoubtEntry(PlaceEntry):
    """Something that is not known, or rests on more than a person's word (rule S11)."""

    id: str
    doubt: str
    rank: str
    element: ElementEntry | None
    categories: list[str]
    count: int
    message: str
    accepted: AcceptedDoubt | None


class EnclaveEntry(TypedDict):
    """An enclave of the policies."""

    enclave: str
    nodes: list[str]


class DeniedEntry(TypedDict):
    """A flow that one line allows and another denies."""

    source: ElementEntry
    target: ElementEntry
    role: str
    allowed_by: list[GrantEntry]
    denied_by: list[GrantEntry]


class GlobEntry(PlaceEntry):
    """What a glob of a label file decides and closes."""

    says: list[str]
    elements: int
    closed: int
    reviewed: int
    flows: NotRequired[int]
    flows_closed: NotRequired[int]
    leak: ElementEntry | None
    open: ElementEntry | None
    warning: str


class OpeningEntry(TypedDict):
    """A finding that there would be, or would be worse, if a statement were wrong."""

    kind: str
    category: str
    source: ElementEntry
    leak: ElementEntry
    dismissed: bool
    pseudonymised: bool
    new: bool


class OpenedEntry(TypedDict):
    """An element that would be open if a statement were wrong."""

    element: ElementEntry
    categories: list[str]


class RelianceEntry(TypedDict):
    """What hangs on one statement of a label file."""

    role: str
    method: str
    categories: list[str]
    file: str
    line: int
    glob: bool
    shipped: bool
    why: str
    author: str
    elements: list[ElementEntry]
    to: list[ElementEntry]
    findings: list[OpeningEntry]
    questions: list[OpenedEntry]
    refused: str
    perhaps: bool


class LedgerRow(TypedDict):
    """What was taken away, and on whose word."""

    by: str
    element: ElementEntry | None
    to: ElementEntry | None
    categories: list[str]
    places: list[PlaceEntry]
    glob: bool
    leak: ElementEntry | None
    open: ElementEntry | None
    itself: bool
    perhaps: bool
    note: str
