"""What is stated, as a document tells it: of categories by the ontology, of nodes and non-ROS elements by labels."""

from __future__ import annotations

from typing import NotRequired, TypedDict

from rosprivacy.report.contract.records import ElementEntry, LawEntry, PlaceEntry, Reached

Texts = dict[str, dict[str, str]]  # language -> what -> text


class ProvisionEntry(LawEntry):
    """A provision that data of a category can fall under."""

    iri: str
    meaning: str
    stated_of: str
    sources: list[str]
    as_of: str
    translations: Texts


class ContextProvision(ProvisionEntry):
    """What data of a category may reveal in a context."""

    context: str


class ContextEntry(TypedDict):
    """A context that is stated of a source or of the system."""

    name: str
    title: str
    definition: str
    translations: Texts


class PointerEntry(TypedDict):
    """A provision to look at beside what is followed into paths."""

    provision: str
    iri: str
    title: str
    meaning: str
    as_of: str
    applies_from: str
    confirmed: NotRequired[bool]
    adopted: NotRequired[str]
    country: str
    address: str
    categories: list[str]
    contexts: list[str]
    translations: Texts


class TypeEntry(TypedDict):
    """A message type of a channel: stated for all writers, or seen with those that are named."""

    type: str
    stated: bool
    file: str
    line: int
    hash: NotRequired[str]
    writers: NotRequired[list[str]]
    readers: NotRequired[list[str]]
    first: NotRequired[str]
    last: NotRequired[str]


class TypesEntry(TypedDict):
    """The message types of a channel, or of a leg of one."""

    element: ElementEntry
    types: list[TypeEntry]


class SurroundingsEntry(TypedDict):
    """Where an element that brings data in works."""

    element: ElementEntry
    contexts: list[str]
    country: NotRequired[str]


class CategoryEntry(TypedDict):
    """A category that is emitted."""

    in_context: NotRequired[list[ContextProvision]]
    look_at: NotRequired[list[str]]

    name: str
    iri: str
    broader: list[str]
    title: str
    definition: str
    data_types: list[str]
    identity_factors: NotRequired[list[str]]  # not in documents of earlier versions
    gdpr: str
    article9: str
    reason: str
    law: list[ProvisionEntry]
    translations: Texts


class Carried(Reached):
    """An element, and what it carries."""

    pseudonymised: list[str]


class RolesEntry(TypedDict):
    """What labels say of a node and a category."""

    element: ElementEntry
    category: str
    roles: list[str]


class SubjectsEntry(TypedDict):
    """Whom the data of a source is about."""

    element: ElementEntry
    subjects: list[str]


class ProcessingEntry(TypedDict, total=False):
    """What people state of a robot or an element: who is responsible, what for, on which basis."""

    robot: str
    element: ElementEntry
    file: str
    line: int
    controller: str
    dpo: str
    purposes: dict[str, list[str]]
    legal_bases: dict[str, list[str]]


class ProcessedEntry(TypedDict):
    """What a kind of data is processed for where it begins or ends, as stated there or nearest to it."""

    element: ElementEntry
    category: str
    controllers: list[str]
    officers: list[str]
    purposes: list[str]
    legal_bases: list[str]
    missing: list[str]


class ProtectionEntry(TypedDict):
    """Who cleans data on the way, of which kind; whether the data get there in no other form."""

    element: ElementEntry
    category: str
    method: str
    stated: bool
    everywhere: bool


class WaysEntry(TypedDict):
    """Whose data of a kind get to a place, what protects them before; without an element: wherever the kind is."""

    element: NotRequired[ElementEntry]
    category: str
    subjects: list[str]
    subjects_missing: bool
    protections: list[ProtectionEntry]


class SanitizerEntry(TypedDict):
    """Who cleans a category, and what passes all the same."""

    element: ElementEntry
    category: str
    method: str
    stated: bool
    reached: bool
    leaves: list[str]
    leaves_pseudonymised: list[str]
    beside: list[ElementEntry]
    cleaning_beside: NotRequired[list[ElementEntry]]
    places: NotRequired[list[PlaceEntry]]
    recognises: NotRequired[list[str]]


DerivationEntry = TypedDict(
    "DerivationEntry", {"element": ElementEntry, "from": str, "to": str, "reached": bool}
)  # 'from' is a word of Python


class NonRosNotKnown(TypedDict, total=False):
    """What could not be judged of a non-ROS element."""

    missing: list[str]
    without_limit: list[str]


class RecordingEntry(TypedDict):
    """What the bag that a storage is says of itself."""

    bag: str
    bytes: int
    topics: int
    messages: NotRequired[int]
    start: NotRequired[str]
    end: NotRequired[str]
    oldest: NotRequired[str]


class NonRosStated(TypedDict, total=False):
    """What is stated of a non-ROS element."""

    retention: dict[str, str]
    backups: bool | str
    encrypted: bool
    country: str
    area: str
    operator: str
    recipient: str
    transfer: str
    contract: str
    recording: RecordingEntry


class NonRosEntry(NonRosStated, NonRosNotKnown):
    """A non-ROS element."""

    element: ElementEntry
    file: str
    line: int
    holds: list[str]


class OverruledBy(PlaceEntry):
    """The label that takes a source or leak away, and what it says."""

    says: str


class OverruledEntry(PlaceEntry):
    """A source or leak that another label takes away."""

    role: str
    categories: list[str]
    elements: list[str]
    by: OverruledBy
