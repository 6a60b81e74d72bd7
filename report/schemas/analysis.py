"""The document ``rosprivacy.analysis/1``, what its answer rests on, and what it tells of a fleet."""

from typing import Annotated

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import (
    Count,
    Day,
    Id,
    Keywords,
    LawVerdict,
    Positive,
    Verdict,
    View,
    closed,
    one_of,
)
from rosprivacy.report.schemas.records import (
    DeniedEntry,
    DiagnosticEntry,
    DoubtEntry,
    ElementEntry,
    EnclaveEntry,
    FileEntry,
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
from rosprivacy.report.schemas.register import RegisterEntry
from rosprivacy.report.schemas.stated import (
    Carried,
    CategoryEntry,
    ContextEntry,
    DerivationEntry,
    FactsOfElements,
    NonRosEntry,
    OverruledEntry,
    PersonGroupEntry,
    PointerEntry,
    RolesEntry,
    SanitizerEntry,
    SubjectsEntry,
    SurroundingsEntry,
)


class AlikeEntry(TypedDict):
    """Robots that differ in nothing but their names."""

    robot: str
    model: str
    robots: list[str]


class FormEntry(TypedDict):
    """Robots of a pattern, and how their finding stands."""

    robots: list[str]
    dismissed: bool
    accepted: bool
    pseudonymised: bool


class PatternEntry(TypedDict):
    """Findings that differ only in the robot."""

    id: Id
    finding: Annotated[str, "Id of the one that is shown."]
    across: Annotated[bool, "From one robot to another."]
    findings: Annotated[Positive, "How many there are."]
    dismissed: Annotated[Count, "How many of them are."]
    pseudonymised: Annotated[Count, "How many of them are."]
    robots: Annotated[list[str], "Where they begin, or end if they begin on no robot."]
    accepted: Annotated[Count, "How many of them a valid decision accepts."]
    forms: Annotated[
        NotRequired[list[FormEntry]],
        "The same robots by how their finding stands: what stands most first; a robot with several is under the "
        "one that stands most.",
    ]


class ShareEntry(TypedDict):
    """What a robot has of a pattern."""

    pattern: str
    ends: Annotated[bool, "Data gets here from another robot."]
    dismissed: bool
    pseudonymised: bool
    accepted: bool


class DeviantEntry(TypedDict):
    """Robots whose result is not that of most robots of their model."""

    robots: list[str]
    model: str
    more: list[ShareEntry]
    fewer: list[ShareEntry]
    more_open: list[ElementEntry]
    fewer_open: list[ElementEntry]


class FleetEntry(TypedDict):
    """What is said of a fleet."""

    robots: Annotated[Count, "How many there are; infrastructure does not count."]
    models: Annotated[dict[str, int], "Robots of each model; the empty name for those without one."]
    alike: Annotated[list[AlikeEntry], "Robots that differ in nothing but their names, and the one that is shown."]
    patterns: Annotated[list[PatternEntry], "Findings that differ only in the robot, in the order of the findings."]
    deviants: Annotated[list[DeviantEntry], "Robots whose result is not that of most robots of their model."]


class NoMethod(TypedDict):
    """A sanitizer whose method nobody states."""

    element: ElementEntry
    category: str
    taken_as: Annotated[str, Keywords(const="pseudonymise")]


@closed
class AbsentEntry(TypedDict):
    """A node that has a profile and is not on the robot, on a person's word."""

    element: ElementEntry
    why: str


class DatabaseEntry(TypedDict):
    """The database that was read."""

    robots: int


class StandardFile(TypedDict):
    """The file of standard channels, and how many it takes as mundane."""

    file: str
    sha256: str
    taken: int


ObservedEntry = TypedDict("ObservedEntry", {"from": str, "to": str, "by": list[str]})  # empty where a file does not say


class TypesFileEntry(TypedDict):
    """A file of observed message types, and when they were observed."""

    file: str
    sha256: str
    observed: ObservedEntry


class TypeLimitsFile(TypedDict):
    """The table of what message types cannot carry, and how many flows it closes."""

    file: str
    sha256: str
    flows: Annotated[int, "Flows that end where the type of a channel cannot carry what comes along them."]


@closed
class ClosedEntry(TypedDict):
    """A finding that there would be if types limited nothing."""

    id: str
    kind: str
    category: str
    source: ElementEntry
    leak: ElementEntry
    dismissed: bool


class DecisionsFile(FileEntry):
    """The log or file of decisions, and the day that they are looked at."""

    today: Day
    head: Annotated[NotRequired[str], "Of a log: the hash of its last entry. A file has no chain."]


class Assumptions(TypedDict):
    """What an answer rests on."""

    rosprivacy: Annotated[str, "Version."]
    view: str
    policies: list[FileEntry]
    labels: list[FileEntry]
    fleet: Annotated[NotRequired[list[FileEntry]], "Fleet file and its includes."]
    project: Annotated[NotRequired[list[FileEntry]], "The project file that names what was read; one at most."]
    standard_channels: StandardFile | None
    unlabelled_node: str
    unlabelled_channel: str
    categories_asked: Annotated[str, Keywords(const="all")] | list[str]
    may_be_asked: Annotated[
        NotRequired[dict[str, list[str]]],
        "Broader and overlapping categories that the answer is about since data of them may be of a kind that was "
        "asked for -> which kinds.",
    ]
    paths: Annotated[str, one_of("witness", "disjoint", "all")]
    max_paths: Positive
    database: Annotated[
        NotRequired[DatabaseEntry],
        "With --from-database: what was there, and changes that people made there, took the place of files.",
    ]
    engine: Annotated[NotRequired[str], Keywords(enum=["parts", "spark"]), "With --engine: analysed in parts."]
    sanitizers_without_method: list[NoMethod]
    ontologies: Annotated[list[FileEntry], "Users' own, beside the shipped one."]
    law_as_of: Annotated[str, "Date of the newest law that the ontology knows."]
    article9_only: bool
    article9_level: Annotated[
        NotRequired[LawVerdict],
        "How far data have to fall under Article 9(1) to be asked for; only where article9_only is true.",
    ]
    data_types_asked: Annotated[str, Keywords(const="all")] | list[str]
    identity_factors_asked: Annotated[
        NotRequired[list[str]], "The identity factors of Article 4(1) that were asked for; left out if all were."
    ]
    taken_by_kind: Annotated[
        dict[str, Annotated[str, one_of("conduit", "leak")]],
        "What each kind of element outside ROS does with every category unless a label says otherwise.",
    ]
    taken_away_by: Annotated[NotRequired[dict[str, int]], "How many rows of taken_away there are of each kind."]
    backups_taken_as_none: Annotated[
        NotRequired[list[ElementEntry]], "Storages of whose backups nothing is stated: taken to have none."
    ]
    countries_as_of: Annotated[
        NotRequired[str], "Date of the list of EEA members and adequacy decisions, where a country is stated."
    ]
    decisions: Annotated[NotRequired[DecisionsFile], "With --decisions."]
    standard_channels_reached: Annotated[
        NotRequired[list[Stopped]],
        "Standard channels that an emitted category gets to and at which it stops, since a shipped file calls "
        "them mundane.",
    ]
    standard_channels_unchanged: Annotated[
        NotRequired[list[ElementEntry]],
        "Standard channels of which a glob of a user's label file says otherwise; it does not count, since its "
        "last name segment is not written out.",
    ]
    overruled: Annotated[
        NotRequired[list[OverruledEntry]], "Sources and leaks that one label says and another takes away."
    ]
    absent: Annotated[
        NotRequired[list[AbsentEntry]],
        "Nodes of which a label says that they are not on the robot: nothing gets to them, and nothing comes from "
        "them.",
    ]
    globs: Annotated[
        NotRequired[list[GlobEntry]],
        "Lines of a user's label files that name elements, or the ends of flows, by a glob, with what they decide "
        "and close.",
    ]
    types: Annotated[NotRequired[list[TypesFileEntry]], "Files of observed message types."]
    type_limits: Annotated[
        NotRequired[TypeLimitsFile | None],
        "The table of what message types cannot carry; null where types limit nothing. Only where types are known.",
    ]
    type_limits_reached: Annotated[
        NotRequired[list[Reached]], "Channels, and legs of them, at which data stops for their type alone."
    ]
    closed_by_types: Annotated[NotRequired[list[ClosedEntry]], "Findings that there would be if types limited nothing."]


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
    beyond: Annotated[
        NotRequired[list[int]], "Steps of the witness, from 0, that the profile of their node does not allow."
    ]
    enclaves: Annotated[list[str], "They allow these steps, since their nodes share their rights."]
    split: Annotated[
        list[str], "Enclaves of which splitting ends the finding, proven by a new analysis; empty if none was found."
    ]
    move: Annotated[
        NotRequired[MoveEntry | None],
        "A profile of which an enclave of its own ends the finding alone, proven by a new analysis; null if none "
        "was found.",
    ]
    deny: Annotated[
        NotRequired[list[DenyEntry]],
        "DENY lines that end the finding, proven by a new analysis; empty if none were found. Each holds for its "
        "whole enclave.",
    ]
    loses: Annotated[
        NotRequired[list[LostEntry]],
        "What nodes could no longer do that their own profiles allow, if these lines were there.",
    ]
    robots: Annotated[NotRequired[list[str]], "Of a fleet: the robots on which the enforced view adds it."]
    opened_by: Annotated[
        NotRequired[list[PlaceEntry]],
        "Lines of a governance that make it possible, since they ask nobody for permissions.",
    ]
    plain: Annotated[
        NotRequired[bool],
        "True: the declared view has the finding, too, but in pseudonymised form only; this is about the plain data.",
    ]


class EnforcedEntry(TypedDict):
    """What the enforced view adds to the declared one (rule S6)."""

    verdict: Annotated[str, "Of the enforced view."]
    unreviewed: Annotated[
        NotRequired[int], "How many elements only the enforced view leaves open, or for more categories."
    ]
    open: Annotated[NotRequired[list[ElementEntry]], "These elements, those outside ROS first."]
    added: Annotated[list[AddedEntry], "Findings that only the enforced view has."]


@closed
class NotAsked(TypedDict):
    """A key that is not there because nobody asked for it, and the option that asks."""

    key: Annotated[str, one_of("hangs_on")]
    option: str


class HangsOn(TypedDict):
    """What the answer hangs on, or that it was not asked for."""

    hangs_on: Annotated[
        NotRequired[list[RelianceEntry]],
        "What the answer hangs on: for each statement of a label file that takes data or a question away, the "
        "findings and the open questions that there would be if that one statement were wrong, as if the system "
        "were analysed without it. A user's statements first, those on which most hangs before others. Of a fleet "
        "it is told for one robot of those that are alike, and only where it was asked for: else it is not "
        "there, and 'not_asked' names it.",
    ]
    not_asked: Annotated[
        NotRequired[list[NotAsked]],
        "What is not in this document because nobody asked for it, which is not the same as nothing: the key, and "
        "the option that asks. Of a fleet this is what the answer hangs on, which takes longer than the "
        "analysis.",
    ]


class Answered(HangsOn, FactsOfElements):
    """What both forms of the document hold."""

    verdict: Annotated[
        Verdict,
        "leak: a finding that is not dismissed. undetermined: none, but open elements, or no source. "
        "no-leak-found: none, and nothing open. Never a legal verdict.",
    ]
    view: Annotated[View, "declared: each node does what its own profile says. enforced: what DDS lets its enclave do."]
    categories: Annotated[list[CategoryEntry], "Emitted by a source or a derivation, sorted."]
    findings: Annotated[list[FindingEntry], "One per (category, source, leak), sorted by these."]
    open: Annotated[
        list[OpenEntry],
        "Elements that a category reaches and no label covers for it: frontier first, then by distance.",
    ]
    unknown_ends: Annotated[
        NotRequired[list[UnknownEnd]],
        "Where data's way ends without anybody known: channels with data that nobody known reads, elements "
        "outside ROS that no flow reaches. They change no verdict. Of a fleet they are told for one robot of "
        "those that are alike.",
    ]
    doubts: Annotated[
        NotRequired[list[DoubtEntry]],
        "One list of all that is not known, or that rests on more than a person's word (rule S11): what breaks "
        "the verdict first, then by name. Documents of earlier versions have none.",
    ]
    sentence: Annotated[
        NotRequired[str],
        "The verdict in one English sentence, with its doubts by name and what the answer is restricted to; the "
        "same sentence stands in every output (rule S12).",
    ]
    carries: Annotated[
        list[Carried], "Every element that data arrives at or starts from, with the most specific categories."
    ]
    roles: Annotated[NotRequired[list[RolesEntry]], "What labels say of nodes, per category."]
    subjects: Annotated[list[SubjectsEntry], "Whom the data of sources are about, as labels say."]
    persons: Annotated[
        NotRequired[list[PersonGroupEntry]],
        "The groups of the closed list that these words stand for; other words stand for none of it.",
    ]
    register: Annotated[
        NotRequired[list[RegisterEntry]],
        "The register of processing: each kind of data at each place where it leaves or rests, whether that is a "
        "finding or not, then what leaves nowhere. What lies on no way of a row does not stand in it.",
    ]
    surroundings: Annotated[
        NotRequired[list[SurroundingsEntry]],
        "Where the elements that bring data in work, as label and fleet files state it of them or of their system.",
    ]
    contexts: Annotated[NotRequired[list[ContextEntry]], "The contexts that are stated."]
    sanitizers: Annotated[list[SanitizerEntry], "Who cleans which category, and what passes all the same."]
    derivations: Annotated[list[DerivationEntry], "Who makes one category of another."]
    enclaves: Annotated[list[EnclaveEntry], "Of the policies, with the nodes in each."]
    flows: Annotated[Count, "Allowed flows of the graph."]
    denied_flows: Annotated[NotRequired[Count], "Flows that a DENY takes back from an ALLOW."]
    denied: Annotated[NotRequired[list[DeniedEntry]], "These flows, with the policy lines on both sides."]
    elements: Annotated[Count, "Nodes and channels; the legs of a service are one element."]
    standard_channels: Annotated[Count, "Channels taken as mundane by the standard file."]
    diagnostics: list[DiagnosticEntry]
    assumptions: Assumptions
    outside: Annotated[list[NonRosEntry], "Elements outside ROS with what is stated about them."]
    decisions: Annotated[NotRequired[list[ListedDecision]], "With --decisions: every entry of the file, in its order."]
    fleet: Annotated[
        NotRequired[FleetEntry],
        "Of a fleet. Findings, open elements and what is carried are then shown for one robot of those that are "
        "alike; counts are of the whole fleet.",
    ]
    enforced: Annotated[
        NotRequired[EnforcedEntry],
        "With --view both: what the enforced view adds to the declared one, which is the answer of record.",
    ]


class AnalysisDocument(Answered):
    """What `rosprivacy analyze --format json1` prints. Keys that are listed here stay; more may be added."""

    format: Annotated[str, Keywords(const="rosprivacy.analysis/1")]
    taken_away: Annotated[
        NotRequired[list[LedgerRow]],
        "The ledger: what keeps data from going on, or an element from being asked about, and on whose word. Of a "
        "fleet it is told for one robot of those that are alike.",
    ]
    look_at: Annotated[
        NotRequired[list[PointerEntry]],
        "Provisions to look at that are not followed into paths; no verdict. National law stands there with its "
        "country; those without categories and contexts concern every system.",
    ]
    unreached: Annotated[
        list[ElementEntry], "Elements that no data of these categories gets to; with carries, all that there is."
    ]


class ShortDocument(Answered):
    """What `rosprivacy analyze --format json` prints: rosprivacy.analysis/1 without what few read of it."""

    format: Annotated[str, Keywords(const="rosprivacy.analysis/2")]
    left_out: Annotated[
        list[str],
        "Keys of rosprivacy.analysis/1 that are not in this document, which is not the same as nothing; "
        "`--format json` writes them, and `--hangs-on` adds what the answer hangs on.",
    ]
