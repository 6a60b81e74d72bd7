"""The graph in Neo4j, declared once: kinds of nodes and relationships, their properties and what they mean.

In: nothing. Out: tables, from which the constraints, the statements that write rows and the tables of
``docs/database.md`` are derived. Identifiers in Cypher come from here and from the ontology only, checked and quoted;
values are always parameters.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from rosprivacy.analysis.model import CONTEXTS

SCHEMA = 5  # raised when what a load writes gains what an answer rests on, or changes its meaning; none was stored at 1
DATABASE = "the database"  # where people write by hand, as the file of a problem or a statement
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
STRING, INTEGER, BOOLEAN, STRINGS = "STRING", "INTEGER", "BOOLEAN", "LIST<STRING>"


@dataclass(frozen=True, slots=True)
class Property:
    """A property: name, type as Cypher calls it, meaning."""

    name: str
    type: str
    meaning: str


@dataclass(frozen=True, slots=True)
class NodeKind:
    """A kind of node.

    Attributes
    ----------
    label
        Its first label.
    key
        The property that identifies it; there is a uniqueness constraint on it.
    labels
        Further labels that such nodes can carry, for the documentation.
    """

    label: str
    key: str
    meaning: str
    properties: tuple[Property, ...]
    labels: str = ""


@dataclass(frozen=True, slots=True)
class RelationshipKind:
    """A kind of relationship between two kinds of nodes."""

    type: str
    source: str
    target: str
    meaning: str
    properties: tuple[Property, ...] = ()


KIND_LABELS = {
    "node": "RosNode",
    "topic": "Topic",
    "service": "Service",
    "action": "Action",
    "storage": "Storage",
    "external-system": "ExternalSystem",
    "shared-memory": "SharedMemory",
    "side-channel": "SideChannel",
    "device": "Device",
    "display": "Display",
    "participant": "Participant",
    "person": "Person",
}
LEG, WILDCARD, INTAKE = "Leg", "Wildcard", "Intake"
DOMAIN, INFRASTRUCTURE, FLEET = "domain", "infrastructure", "fleet"  # what of a fleet is no robot
CARRIES = "CARRIES_"  # and a kind of data, as `carries` writes it

_OURS = Property("robot", STRING, "whose load wrote it; absent on what people add")
_PLACE = (
    Property("file", STRING, "of the label"),
    Property("line", INTEGER, "of the label"),
    Property(
        "tier", INTEGER, "rank: 1 for a person's own label, 0 for the standard channels, -1 for proposed infrastructure"
    ),
    Property("specificity", INTEGER, "rank: the more of the name is spelt out, the higher"),
    Property("naming", STRING, "name, glob, or segment for a glob with its last segment written out"),
    Property("every", BOOLEAN, "the label names no category: it holds for every one"),
    Property("why", STRING, "the label's note; of method absent: why the node is not on the robot"),
    Property("author", STRING, "who says it, as the label file names them"),
    Property("pinned", STRINGS, "of a glob in a file with pins: kinds that a person has seen here, for which it holds"),
    _OURS,
)
_PROCESSING = (
    Property("purposes", STRINGS, "what data are processed for, as stated; `Video: …` of one kind"),
    Property("legal_bases", STRINGS, "on which legal basis, as stated: `6(1)(f)`, or `Video: 6(1)(f)` of one kind"),
    Property("stated_in", STRING, "file that states purposes and legal bases"),
    Property("stated_at", INTEGER, "line there"),
)
_BROAD = "; broader kinds are named too"

ELEMENT = NodeKind(
    "Element",
    "id",
    "Anything that data can be at.",
    (
        Property("id", STRING, "unique: robot, kind, name, leg and side"),
        Property("name", STRING, "fully qualified ROS name, or name of what lies outside ROS"),
        Property("robot", STRING, "name of its robot"),
        Property("kind", STRING, f"one of {', '.join(KIND_LABELS)}"),
        Property("leg", STRING, "of a service or action: request or response"),
        Property("side", STRING, "of a wildcard: write or read"),
        Property("without", STRINGS, "of a wildcard: DDS expressions that a DENY takes out of it"),
        Property("carries", STRINGS, f"kinds of data that get here{_BROAD}"),
        Property("pseudonymised", STRINGS, f"kinds of data that get here pseudonymised{_BROAD}"),
        Property("begins", STRINGS, "kinds that it brings in"),
        Property("subjects", STRINGS, "of a source: whom its data are about"),
        Property("types", STRINGS, "of a channel: message types, as they were observed or stated"),
        Property("type_facts", STRINGS, "JSON: each of these with who states it, or which nodes were seen with it"),
        Property(
            "unprotected", STRINGS, "of a channel: why others on the network can read it, `not-encrypted: file:line`"
        ),
        Property("context", STRINGS, f"where it works, with its system: some of {', '.join(CONTEXTS)}"),
        *_PROCESSING,
        Property("leaks", STRINGS, "kinds that it lets out, if they come"),
        Property("sanitizes", STRINGS, "kinds that it cleans, if they come"),
        Property("stops", STRINGS, "kinds that some source brings in and that do not go on from here"),
        Property(
            "seal", STRING, "of what the analysis wrote of it: a change of that by hand says nothing, and is told"
        ),
        Property("open", STRINGS, "kinds that get here and that no label covers"),
        Property("frontier", BOOLEAN, "open, and reached before any other open node: to be reviewed first"),
        Property("distance", INTEGER, "of an open element: flows from the nearest source"),
        Property("retention", STRINGS, "of a storage: how long it keeps data, `P30D`, or `Video: P30D` for one kind"),
        Property("limits", STRINGS, "of a storage: how long kinds may be kept, as above"),
        Property("backups", STRING, "of a storage: how much longer backups keep data; true where that is not known"),
        Property("encrypted", BOOLEAN, "of a storage: at rest"),
        Property("bag", STRING, "of a storage that is a recording: the bag, as the label file names it"),
        Property("bag_bytes", INTEGER, "its size"),
        Property("bag_topics", INTEGER, "how many topics are in it"),
        Property("bag_messages", INTEGER, "how many messages, where it says so"),
        Property("bag_start", INTEGER, "from when, in nanoseconds since 1970"),
        Property("bag_end", INTEGER, "to when"),
        Property("bag_oldest", INTEGER, "the earliest time that any of its bags says"),
        Property("country", STRING, "ISO 3166-1 code; of a node that of its system, where it is stated"),
        Property("operator", STRING, "outside ROS: who runs it"),
        Property("recipient", STRING, "outside ROS: controller, joint-controller, processor or third-party"),
        Property("contract", STRING, "outside ROS: on what it is operated, such as a contract under Article 28"),
        Property("transfer", STRING, "outside ROS: basis of a transfer out of the EEA; `none` if that is stated"),
        Property("file", STRING, "outside ROS: where it is stated"),
        Property("line", INTEGER, "outside ROS: where it is stated"),
    ),
    f"the kind, one of {', '.join(f'`{label}`' for label in KIND_LABELS.values())}; `{LEG}` on the request and the "
    f"response of a service or action, `{WILDCARD}` on a name with wildcards; `{INTAKE}` on what stands beside an "
    f"element at the end of `{CARRIES}…`, where what comes to it goes on another way than what begins there. And for "
    "each category, here `Biometric`: "
    "`Biometric` where it gets to, `BiometricSource` where it begins (at a source, or at a node that makes it of other "
    "data), `BiometricLeak` on what lets it out where it gets there or a label names it, `BiometricSanitizer` on what "
    "cleans it if it comes; the labels of broader categories too",
)
ROBOT = NodeKind(
    "Robot",
    "name",
    "A robot that was loaded; or, marked as shared, what the robots of a fleet have in common.",
    (
        Property("name", STRING, "unique"),
        Property("model", STRING, "of a robot of a fleet, if it has one"),
        Property("shared", BOOLEAN, "true for infrastructure, a DDS domain, or the fleet itself: no robot"),
        Property("part", STRING, "of what is shared: infrastructure, domain, or fleet for what the fleet file states"),
        Property("verdict", STRING, "leak, undetermined or no-leak-found; a DDS domain has none: data passes there"),
        Property("view", STRING, "declared or enforced"),
        Property("version", INTEGER, "how often it was written"),
        Property("schema", INTEGER, "version of this graph; a robot with another one has to be loaded again"),
        Property("digest", STRING, "of what was loaded; absent when the database was analysed since"),
        Property("elements", INTEGER, "how many were loaded"),
        Property("flows", INTEGER, "how many were loaded"),
        Property("roles", INTEGER, "how many relationships of labels were loaded"),
        Property("carried", INTEGER, "how many `CARRIES_…` were loaded"),
        Property("beyond", INTEGER, "how many `AddedFinding` it has; absent where nobody loaded it with `--view both`"),
        Property("controller", STRING, "who is responsible, as stated"),
        Property("dpo", STRING, "the data-protection officer, as stated"),
        *_PROCESSING,
        Property("assumptions", STRING, "JSON: what the answer rests on"),
        Property("diagnostics", STRING, "JSON: what its policies and labels were read with"),
        Property(
            "doubts",
            STRINGS,
            "what is not known of it, or rests on more than a person's word: `breaks unread-file: d/x.xml was not "
            "read`; with one that breaks the verdict is undetermined at best",
        ),
    ),
)
ENCLAVE = NodeKind(
    "Enclave",
    "id",
    "A security enclave: all nodes in it share one certificate.",
    (
        Property("id", STRING, "unique: robot and path"),
        Property("path", STRING, "of the SROS 2 enclave"),
        Property("robot", STRING, "name of its robot"),
    ),
)
CATEGORY = NodeKind(
    "DataCategory",
    "iri",
    "A kind of personal data.",
    (
        Property("iri", STRING, "unique"),
        Property("name", STRING, "short name, as in label files"),
        Property("label", STRING, "stem of the labels of elements"),
        Property("title", STRING, "in English"),
        Property("definition", STRING, "one sentence"),
        Property("article9", STRING, "strongest verdict under Art. 9(1): always, conditional, may-reveal, no, unknown"),
        Property("data_types", STRINGS, "how it is represented, such as video"),
        Property("identity_factors", STRINGS, "of Art. 4(1), such as economic; empty where it is not stated"),
        Property("gdpr", STRING, "short name of the provision that defines its GDPR category"),
    ),
)
PROVISION = NodeKind(
    "LegalProvision",
    "iri",
    "A provision that findings point to.",
    (
        Property("iri", STRING, "unique"),
        Property("name", STRING, "short, such as GDPR Art. 9(1) health"),
        Property("title", STRING, "its meaning in one sentence, in our words"),
        Property("as_of", STRING, "when our entry of the law was last looked at"),
        Property("applies_from", STRING, "day from which it applies, or will; absent where it simply applies"),
        Property("country", STRING, "ISO 3166-1 code of the country whose law it is; absent for law of the Union"),
    ),
)
FINDING = NodeKind(
    "Finding",
    "id",
    "A kind of data reaches a leak, or a place where it is kept too long, has left the EEA or can be read by others.",
    (
        Property("id", STRING, "unique: robot and pattern"),
        Property(
            "pattern",
            STRING,
            "made from kind, category, source, leak, and across robots or not: the same on each",
        ),
        Property("robot", STRING, "name of the robot of its source"),
        Property("leak_robot", STRING, "name of the robot of its leak, which may be another one"),
        Property("kind", STRING, "disclosure, storage-limitation, third-country-transfer or unprotected-channel"),
        Property("reason", STRING, "of other kinds than disclosure: what is wrong there"),
        Property("category", STRING, "name of the category that arrives"),
        Property("source", STRING, "name of the source"),
        Property("leak", STRING, "name of the leak"),
        Property("pseudonymised", BOOLEAN, "it arrives in pseudonymised form only"),
        Property("dismissed", BOOLEAN, "every path goes through another leak of the category"),
        Property("disjoint_paths", INTEGER, "paths that share no flow; absent from one robot to another"),
        Property("article9", STRING, "strongest verdict under Art. 9(1) where its source works"),
        Property(
            "in_context",
            STRINGS,
            "what it may reveal, or what concerns it, where its source works, `care: GDPR Art. 9(1) …`",
        ),
        Property("special_from", STRING, "element that makes a special category of other data; absent if none does"),
    ),
)
ADDED_FINDING = NodeKind(
    "AddedFinding",
    "id",
    "What the enforced view adds to the findings: data gets there only if a node goes beyond its own profile. `load "
    "--view both` writes it; it is no `Finding`, and verdicts are without it.",
    (
        *(field for field in FINDING.properties if field.name != "dismissed"),
        Property("view", STRING, "enforced"),
        Property("way", STRINGS, "names of the elements of its shortest way"),
        Property("beyond", STRINGS, "its steps that no profile of their node allows, with the policy line of another"),
        Property("enclaves", STRINGS, "whose nodes share their rights on it"),
        Property("plain", BOOLEAN, "there is a `Finding` of it, too, but in pseudonymised form only"),
        Property("opened_by", STRINGS, "file:line of a governance that asks nobody for permissions there; else absent"),
        Property("split", STRINGS, "enclaves of which splitting takes it away, proven by a new analysis"),
        Property("move", STRING, "the profile of which an enclave of its own takes it away alone; absent if none does"),
        Property("deny", STRINGS, "DENY lines that take it away, proven by a new analysis"),
        Property("loses", STRINGS, "what nodes would lose by these lines that their own profiles allow"),
    ),
)
_KINDS = Property("kinds", STRINGS, "kinds of data that can be in it, as labels and policies say")
_SUGGESTED = Property("suggested", STRINGS, "kinds that types suggest, `Video (likely)`: questions, no facts")
BAG = NodeKind(
    "Bag",
    "id",
    "A recording, with what can be in it: `rosprivacy bag --load` writes it. It takes part in no path.",
    (
        Property("id", STRING, "unique: where it is, from the root of the file system"),
        Property("path", STRING, "as it was named when it was loaded"),
        Property("robot", STRING, "name of the robot that was recorded, as it was named"),
        Property("verdict", STRING, "personal-data, undetermined or nothing-found"),
        _KINDS,
        _SUGGESTED,
        Property("open_topics", STRINGS, "topics of which nobody can say what is in them"),
        Property("gaps", STRINGS, "why topics may be missing"),
        Property("beside", STRINGS, "what is in it beside messages, and can hold anything"),
        Property("storage", STRING, "mcap, sqlite3, or what it names"),
        Property("distro", STRING, "release of ROS, where it says so"),
        Property("compression", STRING, "as it names it"),
        Property("bytes", INTEGER, "size of its files"),
        Property("topics", INTEGER, "how many are in it"),
        Property("messages", INTEGER, "how many, where it says so"),
        Property("start", INTEGER, "from when, in nanoseconds since 1970"),
        Property("end", INTEGER, "to when"),
        Property("assumptions", STRING, "JSON: what the answer rests on"),
    ),
)
RECORDED_TOPIC = NodeKind(
    "RecordedTopic",
    "id",
    "A topic of a bag.",
    (
        Property("id", STRING, "unique: that of the bag, and the name"),
        Property("name", STRING, "as the bag has it"),
        Property("types", STRINGS, "of its messages"),
        Property("messages", INTEGER, "how many, where the bag says so"),
        _KINDS,
        _SUGGESTED,
        Property("unknown", STRING, "why nobody can say what is in it; absent where that is known"),
        Property("why", STRING, "what its kinds rest on"),
    ),
)
NODES = (ELEMENT, ROBOT, ENCLAVE, CATEGORY, PROVISION, FINDING, ADDED_FINDING, BAG, RECORDED_TOPIC)

FLOWS_TO = RelationshipKind(
    "FLOWS_TO",
    "Element",
    "Element",
    "A step along which data can go.",
    (
        Property(
            "role",
            STRING,
            "publish, subscribe, request, reply, call, execute; matches for a wildcard, flow for what people state",
        ),
        Property("decision", STRING, "allow, or deny where a DENY takes an ALLOW back"),
        Property("carries", STRINGS, f"kinds of data that go along it{_BROAD}"),
        Property("passes", STRINGS, "kinds that had come to its start and go on; absent where there are none"),
        Property("begins", STRINGS, "kinds that its start brings in; absent where there are none"),
        Property("made", STRINGS, "kinds that its start makes of what comes to it; absent where there are none"),
        Property("stops", STRINGS, "kinds that some source brings in and that do not go along it; absent as above"),
        Property("file", STRING, "of the policy line behind it, or of the line that states it"),
        Property("line", INTEGER, "of the policy line behind it"),
        Property("enclave", STRING, "of the profile that the line stands in"),
        Property("profile", STRING, "node of that profile"),
        Property("seen_by", STRINGS, "of an observed policy: through which doors it was seen in use"),
        Property("first_seen", STRING, "of an observed policy: when it was first seen in use"),
        Property("last_seen", STRING, "of an observed policy: when it was last seen in use"),
        Property("further", STRINGS, "JSON: file, line, enclave and profile of further policy lines behind it"),
        Property("denied_by", STRINGS, "of a denied flow: file:line of the DENY"),
        Property("denials", STRINGS, "JSON: file, line, enclave and profile of each DENY"),
        Property("said_at", STRINGS, "file:line of the labels that say only or never of it"),
        Property("only", STRINGS, "a label: it carries these at most"),
        Property("never", STRINGS, "a label: it does not carry these"),
        Property("naming", STRING, "of the label: glob where it names no end in full; absent else"),
        Property("statements", STRINGS, "JSON: role, categories, rank, naming, file and line of each of these labels"),
        _OURS,
    ),
)
COULD_FLOW_TO = RelationshipKind(
    "COULD_FLOW_TO",
    "Element",
    "Element",
    "A step of the way of an `AddedFinding`: the enclave of its node allows it, no profile of the node does. It is no "
    "flow of the declared view.",
    (
        Property("role", STRING, "as of `FLOWS_TO`"),
        Property("file", STRING, "of the policy line of another profile"),
        Property("line", INTEGER, "of the policy line of another profile"),
        Property("enclave", STRING, "of the profile that the line stands in"),
        Property("profile", STRING, "node of that profile"),
        _OURS,
    ),
)
MADE_POSSIBLE_BY = RelationshipKind(
    "MADE_POSSIBLE_BY", "AddedFinding", "Enclave", "Its nodes share the rights that the finding needs."
)
ENDED_BY_SPLITTING = RelationshipKind(
    "ENDED_BY_SPLITTING",
    "AddedFinding",
    "Enclave",
    "With an enclave for each of its nodes, and of all others that it names so, the finding is gone.",
)
CARRIED = RelationshipKind(
    f"{CARRIES}BIOMETRIC",
    "Element",
    "Element",
    "Data of the category goes this step; one type for each category that a source brings in or a node makes, and a "
    "broader one does not stand for it. From an element to itself where it is both source and leak. Followed from a "
    "source to a leak, it finds what the analysis finds, dismissed findings included.",
)
_ROLES: tuple[tuple[str, str, str, tuple[Property, ...]], ...] = (
    (
        "source", "SOURCE_OF", "It brings the category in.",
        (Property("through", STRINGS, "only through these channels"),),
    ),
    ("leak", "LEAKS", "It lets the category out.", ()),
    ("no-source", "NO_SOURCE_OF", "Labels of lower rank do not make it a source.", ()),
    ("no-leak", "LEAKS_NOT", "Labels of lower rank do not make it a leak.", ()),
    (
        "sanitizer", "SANITIZES", "It cleans the category.",
        (
            Property("method", STRING, "anonymise, aggregate, drop, absent or pseudonymise; none counts as the last"),
            Property("stated", BOOLEAN, "whether the label states the method"),
        ),
    ),
    ("conduit", "PASSES", "Reviewed: it passes the category on.", ()),
    (
        "derivation", "DERIVES", "It makes the category of another.",
        (Property("of", STRING, "name of the category that it is made of"),),
    ),
    ("mundane", "NEVER_HAS", "A mundane channel.", ()),
    ("sensitive", "MAY_HAVE", "A channel, reviewed.", ()),
    ("only", "HAS_ONLY", "A channel carries what is named so at most.", ()),
    ("never", "HAS_NOT", "A channel does not carry the category.", ()),
)  # fmt: skip
ROLES = {
    role: RelationshipKind(type_, "Element", "DataCategory", meaning, (*_PLACE, *more))
    for role, type_, meaning, more in _ROLES
}
DERIVES_FROM = RelationshipKind(
    "DERIVES_FROM",
    "Element",
    "Element",
    "What the first makes of other data comes from the second, a source.",
    (
        Property("category", STRING, "name of the category that is made"),
        Property("way", STRINGS, "names of the elements from the source to it, both included"),
        Property("policy", STRINGS, "file:line of the policy line behind each step of the path"),
        Property("past_leak", BOOLEAN, "every path there goes through a leak of that category"),
        _OURS,
    ),
)
IN_ENCLAVE = RelationshipKind(
    "IN_ENCLAVE",
    "Element",
    "Enclave",
    "The node has a profile in the enclave.",
    (Property("file", STRING, "of the profile"), Property("line", INTEGER, "of the profile"), _OURS),
)
BROADER = RelationshipKind("BROADER", "DataCategory", "DataCategory", "The second is broader (skos:broader).")
FALLS_UNDER = RelationshipKind(
    "FALLS_UNDER",
    "DataCategory",
    "LegalProvision",
    "Data of the category can be what the provision speaks of.",
    (
        Property("verdict", STRING, "always, conditional or may-reveal"),
        Property("condition", STRING, "when, where it is not always"),
        Property("stated_of", STRING, "category, or broader or narrower ones, that the ontology says it of"),
        Property("sources", STRINGS, "what the verdict rests on"),
    ),
)
LOOK_AT = RelationshipKind(
    "LOOK_AT",
    "DataCategory",
    "LegalProvision",
    "A provision to look at beside those that data of the category fall under; it is not followed into paths.",
)
ACROSS = RelationshipKind(
    "ACROSS",
    "Finding",
    "Element",
    "An element of its shortest way.",
    (
        Property("step", INTEGER, "0 for the source"),
        Property("category", STRING, "the kind of data with which the path gets here"),
        Property("pseudonymised", BOOLEAN, "in which form"),
        Property("file", STRING, "of the policy line behind the step to here"),
        Property("line", INTEGER, "of the policy line behind the step to here"),
    ),
)
HAS_TOPIC = RelationshipKind("HAS_TOPIC", "Bag", "RecordedTopic", "The topic is in the bag.")
RECORDS = RelationshipKind(
    "RECORDS", "RecordedTopic", "Element", "Of which channel of its robot it tells, or of which leg of one."
)
RELATIONSHIPS = (
    FLOWS_TO,
    COULD_FLOW_TO,
    MADE_POSSIBLE_BY,
    ENDED_BY_SPLITTING,
    CARRIED,
    *ROLES.values(),
    DERIVES_FROM,
    RelationshipKind("OF_ROBOT", "Element", "Robot", "Whose element it is."),
    IN_ENCLAVE,
    BROADER,
    FALLS_UNDER,
    LOOK_AT,
    RelationshipKind("OF_CATEGORY", "Finding", "DataCategory", "What arrives; of an `AddedFinding` too."),
    RelationshipKind("FROM", "Finding", "Element", "The source; of an `AddedFinding` too."),
    RelationshipKind("TO", "Finding", "Element", "The leak; of an `AddedFinding` too."),
    ACROSS,
    HAS_TOPIC,
    RECORDS,
)
SUFFIXES = ("", "Source", "Leak", "Sanitizer")
RESERVED = frozenset({kind.label for kind in NODES} | set(KIND_LABELS.values()) | {LEG, WILDCARD, INTAKE})


def quoted(identifier: str) -> str:
    """Return an identifier for Cypher; only plain ones are taken, whatever the ontology says.

    >>> quoted("BiometricLeak")
    '`BiometricLeak`'
    """
    if not _IDENTIFIER.fullmatch(identifier):
        raise ValueError(f"not an identifier: {identifier!r}")
    return f"`{identifier}`"


def constraints() -> list[str]:
    """Return the statements that make keys unique and look-ups quick; they may be run again and again."""
    statements = [
        f"CREATE CONSTRAINT {quoted(f'{kind.label}_{kind.key}')} IF NOT EXISTS "
        f"FOR (n:{quoted(kind.label)}) REQUIRE n.{quoted(kind.key)} IS UNIQUE"
        for kind in NODES
    ]
    statements += [
        f"CREATE INDEX {quoted(f'{kind.label}_{key}')} IF NOT EXISTS FOR (n:{quoted(kind.label)}) ON (n.{quoted(key)})"
        for kind, key in ((ELEMENT, "robot"), (ENCLAVE, "robot"), (FINDING, "robot"), (FINDING, "leak_robot"))
    ]
    # A text index takes names of any length.
    statements.append("CREATE TEXT INDEX `Element_name` IF NOT EXISTS FOR (n:`Element`) ON (n.`name`)")
    return statements
