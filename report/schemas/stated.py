"""What is stated, as a document tells it: of categories by the ontology, of nodes and non-ROS elements by labels."""

from typing import Annotated

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import (
    Article9,
    Context,
    ContextVerdict,
    Count,
    GdprScope,
    Keywords,
    LawVerdict,
    Method,
    NotStated,
    Term,
    Texts,
    closed,
    one_of,
    texts,
)
from rosprivacy.report.schemas.records import ElementEntry, PlaceEntry, Reached


class _Provision(TypedDict):
    """A provision, and of what it is said."""

    provision: str
    iri: str
    meaning: Annotated[str, "In our own words."]
    condition: Annotated[str, "When, where it is not always."]
    stated_of: Annotated[str, "The category, or the broader or narrower ones, that the ontology says it of."]
    sources: list[str]
    as_of: Annotated[str, "Date of the law."]
    translations: Annotated[
        Texts,
        texts("provision", "meaning", "condition", "sources"),
        "Language, and texts in it; sources stand in a row.",
    ]


@closed
class ProvisionEntry(_Provision):
    """A provision that data of a category can fall under."""

    verdict: LawVerdict


@closed
class ContextProvision(_Provision):
    """What data of a category may reveal in a context."""

    context: Context
    verdict: ContextVerdict


@closed
class ContextEntry(TypedDict):
    """A context that is stated of a source or of the system."""

    name: Context
    title: str
    definition: str
    translations: Annotated[Texts, texts("title", "definition"), "Language, and texts in it."]


@closed
class PersonGroupEntry(TypedDict):
    """A group of the closed list of persons, such as children, that words of labels stand for."""

    name: str
    title: str
    vulnerable: Annotated[bool, "Whether criterion 7 of WP 248 rev.01 names it; else a person has to say."]
    subjects: Annotated[list[str], "These words."]
    translations: Annotated[Texts, texts("title"), "Language, and texts in it."]


@closed
class PointerEntry(TypedDict):
    """A provision to look at beside what is followed into paths."""

    provision: str
    iri: str
    title: str
    meaning: Annotated[str, "In our own words."]
    as_of: Annotated[str, "The day on which the entry was last looked at; no word that the law was read in force then."]
    applies_from: Annotated[str, "The day from which it applies, or will; empty where it simply applies."]
    confirmed: Annotated[NotRequired[bool], "Whether we found that law to be published."]
    adopted: Annotated[NotRequired[str], "The day on which it was adopted, where it is not confirmed."]
    country: Annotated[str, "ISO 3166-1 alpha-2; empty for law of the Union."]
    address: str
    categories: list[str]
    contexts: list[Context]
    translations: Annotated[Texts, texts("provision", "title", "meaning"), "Language, and texts in it."]


@closed
class TypeEntry(TypedDict):
    """A message type of a channel: stated for all writers, or seen with those that are named."""

    type: Annotated[str, "pkg/msg/Name, pkg/srv/Name or pkg/action/Name."]
    stated: Annotated[bool, "Whether a person states it for all who write the channel."]
    file: str
    line: int
    hash: NotRequired[str]
    writers: Annotated[NotRequired[list[str]], "Nodes that were seen with it."]
    readers: NotRequired[list[str]]
    first: NotRequired[str]
    last: NotRequired[str]
    definition: Annotated[NotRequired[str], "The file that defines it, where its fields are known types."]


@closed
class TypesEntry(TypedDict):
    """The message types of a channel, or of a leg of one."""

    element: ElementEntry
    types: list[TypeEntry]


@closed
class SurroundingsEntry(TypedDict):
    """Where an element that brings data in works."""

    element: ElementEntry
    contexts: Annotated[list[Context], Term("context")]
    country: Annotated[NotRequired[str], Term("country"), "ISO 3166-1 alpha-2."]
    gdpr: Annotated[
        NotRequired[GdprScope],
        "Whether the GDPR applies there (Article 3), where that is outside the EEA and not affirmed.",
    ]


class CategoryEntry(TypedDict):
    """A category that is emitted."""

    in_context: Annotated[
        NotRequired[list[ContextProvision]],
        "What data of the category may reveal in a context that is stated, with the provision and why.",
    ]
    look_at: Annotated[NotRequired[list[str]], "Provisions of look_at."]
    name: str
    iri: str
    broader: Annotated[list[str], "All broader categories, nearest first."]
    title: str
    definition: str
    data_types: Annotated[list[str], "image, audio, position, …"]
    identity_factors: Annotated[
        NotRequired[list[str]],
        "What of a person's identity the data tell of, by Article 4(1): name, location, economic, …; empty where "
        "it is not stated.",
    ]
    gdpr: Annotated[str, "The provision that defines its GDPR category."]
    article9: Annotated[
        Article9, "The strongest verdict under Article 9(1) GDPR; unknown where the ontology says nothing."
    ]
    reason: Annotated[str, "Why it does not fall under Article 9(1), where the ontology says so."]
    law: Annotated[
        list[ProvisionEntry], "Provisions that data of the category can fall under; a person judges whether they do."
    ]
    translations: Annotated[
        Texts, texts("title", "definition", "reason", "gdpr"), "Language, and texts in it. English stands beside it."
    ]


class Carried(Reached):
    """An element, and what it carries."""

    pseudonymised: list[str]


class RolesEntry(TypedDict):
    """What labels say of a node and a category."""

    element: ElementEntry
    category: str
    roles: list[Annotated[str, one_of("source", "leak", "sanitizer", "conduit", "derivation")]]


class SubjectsEntry(TypedDict):
    """Whom the data of a source is about."""

    element: ElementEntry
    subjects: Annotated[list[str], Term("aboutPersons"), "Groups of persons, such as residents."]


class ProcessingEntry(TypedDict, total=False):
    """What people state of a robot or an element: who is responsible, what for, on which basis."""

    robot: Annotated[str, "Of whom it is stated; empty of a single robot."]
    element: ElementEntry
    file: str
    line: Count
    controller: str
    dpo: Annotated[str, "The data-protection officer."]
    purposes: Annotated[dict[str, list[str]], "Category, or every, and what its data are processed for."]
    legal_bases: Annotated[dict[str, list[str]], "Category, or every, and on which legal basis, such as 6(1)(f)."]


class ProcessedEntry(TypedDict):
    """What a kind of data is processed for where it begins or ends, as stated there or nearest to it."""

    element: ElementEntry
    category: str
    controllers: list[str]
    officers: list[str]
    purposes: list[str]
    legal_bases: list[str]
    missing: Annotated[
        list[Annotated[str, one_of("purpose", "legal_basis")]],
        "What is not stated of all data of the kind that get there.",
    ]


class SanitizerEntry(TypedDict):
    """Who cleans a category, and what passes all the same."""

    element: ElementEntry
    category: str
    method: Method
    stated: Annotated[bool, "Whether a label states the method; otherwise it is taken as pseudonymise."]
    reached: Annotated[bool, "Whether the category gets there."]
    leaves: Annotated[list[str], "Categories that leave the element all the same."]
    leaves_pseudonymised: Annotated[list[str], "Categories that leave it pseudonymised: still personal data."]
    beside: Annotated[list[ElementEntry], "Elements that read the same channels and do not clean the category."]
    cleaning_beside: Annotated[
        NotRequired[list[ElementEntry]], "Elements that read the same channels and are said to clean the category, too."
    ]
    places: Annotated[NotRequired[list[PlaceEntry]], "The lines of the labels that say so."]
    recognises: Annotated[
        NotRequired[list[str]],
        "Kinds that the element makes by which persons are recognised or judged (Articles 9 and 10 GDPR, Article "
        "5 AI Act): it protects nobody.",
    ]


DerivationEntry = TypedDict(  # 'from' is a word of Python
    "DerivationEntry",
    {"element": ElementEntry, "from": str, "to": str, "reached": Annotated[bool, "Whether the first gets there."]},
)


class NonRosNotKnown(TypedDict, total=False):
    """What could not be judged of a non-ROS element."""

    missing: list[NotStated]
    without_limit: Annotated[
        list[str], "Of a storage: categories for which no limit is stated, so that their retention was not judged."
    ]


class RecordingEntry(TypedDict):
    """What the bag that a storage is says of itself."""

    bag: str
    bytes: Count
    topics: Count
    messages: Annotated[NotRequired[Count], "Absent where the bag does not say."]
    start: Annotated[NotRequired[str], "ISO 8601, UTC."]
    end: NotRequired[str]
    oldest: Annotated[NotRequired[str], "The earliest time that any of its bags says, whatever the others do."]


class NonRosStated(TypedDict, total=False):
    """What is stated of a non-ROS element."""

    retention: Annotated[
        dict[str, str], Term("retention"), "Of a storage: category, or every, and how long it is kept (ISO 8601)."
    ]
    backups: Annotated[
        bool | str,
        Keywords(type=["boolean", "string"]),
        "How long data stays in backups after it is deleted; true where that is not known.",
    ]
    encrypted: Annotated[bool, Term("encrypted")]
    country: Annotated[str, Keywords(pattern="^[A-Z]{2}$"), Term("country"), "ISO 3166-1."]
    area: Annotated[
        str,
        one_of("eea", "adequate", "partly", "third"),
        "Where the country lies: in the EEA, outside with an adequacy decision, with one for some recipients, "
        "without one.",
    ]
    operator: Annotated[str, Term("operator")]
    recipient: Annotated[
        str, one_of("controller", "joint-controller", "processor", "third-party"), Term("operatorRole")
    ]
    transfer: Annotated[
        str,
        Term("transferBasis"),
        "Stated basis of a transfer out of the EEA; 'none' where it is stated that there is none.",
    ]
    contract: Annotated[
        str, Term("contract"), "On what it is operated, such as a contract under Article 28, in a person's words."
    ]
    recording: Annotated[
        RecordingEntry, "Of a storage that is a bag: the bag as the label file names it, and what it says of itself."
    ]


class NonRosEntry(NonRosStated, NonRosNotKnown):
    """A non-ROS element."""

    element: ElementEntry
    file: str
    line: Count
    holds: Annotated[list[str], "Categories that get there."]


@closed
class OverruledBy(TypedDict):
    """The label that takes a source or leak away, and what it says."""

    says: str
    file: str
    line: int


@closed
class OverruledEntry(TypedDict):
    """A source or leak that another label takes away."""

    role: Annotated[str, one_of("source", "leak")]
    categories: list[str]
    elements: Annotated[list[str], "Names of the elements at which it is taken away."]
    file: str
    line: int
    by: Annotated[OverruledBy, "The label that takes it away, and what that says."]


class FactsOfElements(TypedDict):
    """What is stated or seen of elements, where any of it is."""

    types: Annotated[
        NotRequired[list[TypesEntry]],
        "Message types of channels and their legs, as labels state them or as they were observed; where any are known.",
    ]
    processing: Annotated[
        NotRequired[list[ProcessingEntry]],
        "Who is responsible, what data are processed for and on which basis, as stated of a robot or an element. "
        "It changes no finding.",
    ]
    processed_for: Annotated[
        NotRequired[list[ProcessedEntry]],
        "The same for each kind of data where it begins or ends: as stated there, else of the node that makes it, "
        "of its source, of the robot.",
    ]
