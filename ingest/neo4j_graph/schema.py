"""The graph in Neo4j, declared once: kinds of nodes and relationships, their properties and what they mean.

In: nothing. Out: tables, from which the constraints, the statements that write rows and
``docs/reference/graph.md`` are derived. Identifiers in Cypher come from here and from the ontology only, checked and
quoted; values are always parameters.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import CONTEXTS, TYPE_LINE

if TYPE_CHECKING:
    from collections.abc import Iterator

SCHEMA = 5  # raised when what a load writes gains what an answer rests on, or changes its meaning; none was stored at 1
DATABASE = "the database"  # where people write by hand, as the file of a problem or a statement
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
TYPES = {"STRING": "STRING", "INTEGER": "INTEGER", "BOOLEAN": "BOOLEAN", "STRINGS": "LIST<STRING>"}


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

# In the notation of `query --schema`: a kind with its key, or with the two that it joins, and what it is; below it its
# properties, each with name, type (STRINGS is a list of them) and meaning. What is indented further goes on.
_OURS = """\
    robot STRING whose load wrote it; absent on what people add"""
_LABEL = f"""\
    file STRING of the label
    line INTEGER of the label
    tier INTEGER rank: 1 for a person's own label, 0 for the standard channels, -1 for proposed infrastructure
    specificity INTEGER rank: the more of the name is spelt out, the higher
    naming STRING name, glob, or segment for a glob with its last segment written out
    every BOOLEAN the label names no category: it holds for every one
    why STRING the label's note; of method absent: why the node is not on the robot
    author STRING who says it, as the label file names them
    pinned STRINGS of a glob: kinds that a person has seen; none of other code; of HAS_BY_TYPE: types, writers
{_OURS}"""
_PROCESSING = """\
    purposes STRINGS what data are processed for, as stated; `Video: …` of one kind
    legal_bases STRINGS on which legal basis, as stated: `6(1)(f)`, or `Video: 6(1)(f)` of one kind
    stated_in STRING file that states purposes and legal bases
    stated_at INTEGER line there"""
_ARRIVES = """\
    id STRING unique: robot and pattern
    pattern STRING made from kind, category, source, leak, and across robots or not: the same on each
    robot STRING name of the robot of its source
    leak_robot STRING name of the robot of its leak, which may be another one
    kind STRING disclosure, storage-limitation, third-country-transfer or unprotected-channel
    reason STRING of other kinds than disclosure: what is wrong there
    category STRING name of the category that arrives
    source STRING name of the source
    leak STRING name of the leak
    pseudonymised BOOLEAN it arrives in pseudonymised form only"""
_WAY = """\
    disjoint_paths INTEGER paths that share no flow; of a fleet those of its robot, of what is shared and of robots
        between; absent from one robot to another
    article9 STRING strongest verdict under Art. 9(1) where its source works
    in_context STRINGS what it may reveal, or what concerns it, where its source works, `care: GDPR Art. 9(1) …`
    gdpr STRING whether the GDPR applies there (Art. 3), where that is not plain: open or denied
    special_from STRING element that makes a special category of other data; absent if none does"""
_KINDS_IN_BAGS = """\
    kinds STRINGS kinds of data that can be in it, as labels and policies say
    suggested STRINGS kinds that types suggest, `Video (likely)`: questions, no facts"""
_NODES = f"""\
(:Element {{id}}) Anything that data can be at.
    id STRING unique: robot, kind, name, leg and side
    name STRING fully qualified ROS name, or name of what lies outside ROS
    robot STRING name of its robot
    kind STRING one of {", ".join(KIND_LABELS)}
    leg STRING of a service or action: request or response
    side STRING of a wildcard: write or read
    without STRINGS of a wildcard: DDS expressions that a DENY takes out of it
    carries STRINGS kinds of data that get here; broader kinds are named too
    pseudonymised STRINGS kinds of data that get here pseudonymised; broader kinds are named too
    begins STRINGS kinds that it brings in
    subjects STRINGS of a source: whom its data are about
    types STRINGS of a channel: message types, as they were observed or stated
    type_facts STRINGS JSON: each of these with who states it, or which nodes were seen with it
    unprotected STRINGS of a channel: why others on the network can read it, `not-encrypted: file:line`
    context STRINGS where it works, with its system: some of {", ".join(CONTEXTS)}
{_PROCESSING}
    leaks STRINGS kinds that it lets out, if they come
    sanitizes STRINGS kinds that it cleans, if they come
    stops STRINGS kinds that some source brings in and that do not go on from here
    seal STRING of what the analysis wrote of it: a change of that by hand says nothing, and is told
    open STRINGS kinds that get here and that no label covers
    frontier BOOLEAN open, and reached before any other open node: to be reviewed first
    distance INTEGER of an open element: flows from the nearest source
    retention STRINGS of a storage: how long it keeps data, `P30D`, or `Video: P30D` for one kind
    limits STRINGS of a storage: how long kinds may be kept, as above
    backups STRING of a storage: how much longer backups keep data; true where that is not known
    encrypted BOOLEAN of a storage: at rest
    bag STRING of a storage that is a recording: the bag, as the label file names it
    bag_bytes INTEGER its size
    bag_topics INTEGER how many topics are in it
    bag_messages INTEGER how many messages, where it says so
    bag_start INTEGER from when, in nanoseconds since 1970
    bag_end INTEGER to when
    bag_oldest INTEGER the earliest time that any of its bags says
    country STRING ISO 3166-1 code; of a node that of its system, where it is stated
    gdpr_established BOOLEAN of a node outside the EEA: an establishment in the Union is concerned, Art. 3(1), as stated
    gdpr_targeted BOOLEAN the same: persons in the Union are offered something or monitored there, Art. 3(2), as stated
    operator STRING outside ROS: who runs it
    recipient STRING outside ROS: controller, joint-controller, processor or third-party
    contract STRING outside ROS: on what it is operated, such as a contract under Article 28
    transfer STRING outside ROS: basis of a transfer out of the EEA; `none` if that is stated
    file STRING outside ROS: where it is stated
    line INTEGER outside ROS: where it is stated
(:Robot {{name}}) A robot that was loaded; or, marked as shared, what the robots of a fleet have in common.
    name STRING unique
    model STRING of a robot of a fleet, if it has one
    shared BOOLEAN true for infrastructure, a DDS domain, or the fleet itself: no robot
    part STRING of what is shared: infrastructure, domain, or fleet for what the fleet file states
    verdict STRING leak, undetermined or no-leak-found; a DDS domain has none: data passes there
    view STRING declared or enforced
    version INTEGER how often it was written
    schema INTEGER version of this graph; a robot with another one has to be loaded again
    digest STRING of what was loaded; absent when the database was analysed since
    elements INTEGER how many were loaded
    flows INTEGER how many were loaded
    roles INTEGER how many relationships of labels were loaded
    carried INTEGER how many `CARRIES_…` were loaded
    without_standard BOOLEAN channels that only the standard file speaks of were left out; else absent
    beyond INTEGER how many `AddedFinding` it has; absent where nobody loaded it with `--view both`
    controller STRING who is responsible, as stated
    dpo STRING the data-protection officer, as stated
{_PROCESSING}
    assumptions STRING JSON: what the answer rests on
    diagnostics STRING JSON: what its policies and labels were read with
    doubts STRINGS what is not known of it, or rests on more than a person's word: `breaks unread-file: d/x.xml was
        not read`; with one that breaks the verdict is undetermined at best
(:Enclave {{id}}) A security enclave: all nodes in it share one certificate.
    id STRING unique: robot and path
    path STRING of the SROS 2 enclave
    robot STRING name of its robot
(:DataCategory {{iri}}) A kind of personal data.
    iri STRING unique
    name STRING short name, as in label files
    label STRING stem of the labels of elements
    title STRING in English
    definition STRING one sentence
    article9 STRING strongest verdict under Art. 9(1): always, conditional, may-reveal, no, unknown
    data_types STRINGS how it is represented, such as video
    identity_factors STRINGS of Art. 4(1), such as economic; empty where it is not stated
    gdpr STRING short name of the provision that defines its GDPR category
(:LegalProvision {{iri}}) A provision that findings point to.
    iri STRING unique
    name STRING short, such as GDPR Art. 9(1) health
    title STRING its meaning in one sentence, in our words
    as_of STRING when our entry of the law was last looked at
    applies_from STRING day from which it applies, or will; absent where it simply applies
    country STRING ISO 3166-1 code of the country whose law it is; absent for law of the Union
(:Finding {{id}}) A kind of data reaches a leak, or a place where it is kept too long, has left the EEA or can be read
        by others.
{_ARRIVES}
    dismissed BOOLEAN every path goes through another leak of the category
{_WAY}
(:AddedFinding {{id}}) What the enforced view adds to the findings: data gets there only if a node goes beyond its own
        profile. `load --view both` writes it; it is no `Finding`, and verdicts are without it.
{_ARRIVES}
{_WAY}
    view STRING enforced
    way STRINGS names of the elements of its shortest way
    beyond STRINGS its steps that no profile of their node allows, with the policy line of another
    enclaves STRINGS whose nodes share their rights on it
    plain BOOLEAN there is a `Finding` of it, too, but in pseudonymised form only
    opened_by STRINGS file:line of a governance that asks nobody for permissions there; else absent
    split STRINGS enclaves of which splitting takes it away, proven by a new analysis
    move STRING the profile of which an enclave of its own takes it away alone; absent if none does
    deny STRINGS DENY lines that take it away, proven by a new analysis
    loses STRINGS what nodes would lose by these lines that their own profiles allow
(:Load {{id}}) A run of `rosprivacy load`: robots are written one after the other, each as a whole.
    id STRING unique
    at STRING when it began, in UTC: 2026-11-27T08:00:00Z
    version STRING of rosprivacy
    state STRING running until all is written, then whole; one that was cut off stays running
    written INTEGER how many robots it wrote, and what they share
    unchanged INTEGER how many were there already as they are
(:Change {{id}}) What a load brought to a robot that was there before, or took from it: findings of one pattern that
        begin there. It is no `Finding`, and no relationship leads from it to an element.
    id STRING unique: load, robot and pattern
    at STRING when the load began
    robot STRING name of the robot
    what STRING new, gone, or changed: dismissed or pseudonymised as it was not before
    pattern STRING of the findings, as theirs
    kind STRING as of `Finding`
    category STRING name of the category
    source STRING name of the source
    leak STRING name of the leak
    dismissed BOOLEAN as it is now, or was before it went
    pseudonymised BOOLEAN as it is now, or was before it went
(:Bag {{id}}) A recording, with what can be in it: `rosprivacy bag --load` writes it. It takes part in no path.
    id STRING unique: where it is, from the root of the file system
    path STRING as it was named when it was loaded
    robot STRING name of the robot that was recorded, as it was named
    verdict STRING personal-data, undetermined or nothing-found
{_KINDS_IN_BAGS}
    open_topics STRINGS topics of which nobody can say what is in them
    gaps STRINGS why topics may be missing
    beside STRINGS what is in it beside messages, and can hold anything
    storage STRING mcap, sqlite3, or what it names
    distro STRING release of ROS, where it says so
    compression STRING as it names it
    bytes INTEGER size of its files
    topics INTEGER how many are in it
    messages INTEGER how many, where it says so
    start INTEGER from when, in nanoseconds since 1970
    end INTEGER to when
    assumptions STRING JSON: what the answer rests on
(:RecordedTopic {{id}}) A topic of a bag.
    id STRING unique: that of the bag, and the name
    name STRING as the bag has it
    types STRINGS of its messages
    messages INTEGER how many, where the bag says so
{_KINDS_IN_BAGS}
    unknown STRING why nobody can say what is in it; absent where that is known
    why STRING what its kinds rest on
"""
_FURTHER_LABELS = (
    f"the kind, one of {', '.join(f'`{label}`' for label in KIND_LABELS.values())}; `{LEG}` on the request and the "
    f"response of a service or action, `{WILDCARD}` on a name with wildcards; `{INTAKE}` on what stands beside an "
    f"element at the end of `{CARRIES}…`, where what comes to it goes on another way than what begins there. And for "
    "each category, here `Biometric`: "
    "`Biometric` where it gets to, `BiometricSource` where it begins (at a source, or at a node that makes it of other "
    "data), `BiometricLeak` on what lets it out where it gets there or a label names it, `BiometricSanitizer` on what "
    "cleans it if it comes; the labels of broader categories too"
)
_RELATIONSHIPS = f"""\
(:Element)-[:FLOWS_TO]->(:Element) A step along which data can go.
    role STRING publish, subscribe, request, reply, call, execute; matches for a wildcard, flow for what people state
    decision STRING allow, or deny where a DENY takes an ALLOW back
    carries STRINGS kinds of data that go along it; broader kinds are named too
    passes STRINGS kinds that had come to its start and go on; absent where there are none
    begins STRINGS kinds that its start brings in; absent where there are none
    made STRINGS kinds that its start makes of what comes to it; absent where there are none
    stops STRINGS kinds that some source brings in and that do not go along it; absent as above
    file STRING of the policy line behind it, or of the line that states it
    line INTEGER of the policy line behind it
    enclave STRING of the profile that the line stands in
    profile STRING node of that profile
    seen_by STRINGS of an observed policy: through which doors it was seen in use
    first_seen STRING of an observed policy: when it was first seen in use
    last_seen STRING of an observed policy: when it was last seen in use
    basis STRING of a scanned policy: how the line of the code fixes the name
    further STRINGS JSON: file, line, enclave and profile of further policy lines behind it
    denied_by STRINGS of a denied flow: file:line of the DENY
    denials STRINGS JSON: file, line, enclave and profile of each DENY
    said_at STRINGS file:line of the labels that say only or never of it
    only STRINGS a label: it carries these at most
    never STRINGS a label: it does not carry these
    naming STRING of the label: glob where it names no end in full; absent else
    statements STRINGS JSON: role, categories, rank, naming, file and line of each of these labels
{_OURS}
(:Element)-[:COULD_FLOW_TO]->(:Element) A step of the way of an `AddedFinding`: the enclave of its node allows it, no
        profile of the node does. It is no flow of the declared view.
    role STRING as of `FLOWS_TO`
    file STRING of the policy line of another profile
    line INTEGER of the policy line of another profile
    enclave STRING of the profile that the line stands in
    profile STRING node of that profile
{_OURS}
(:AddedFinding)-[:MADE_POSSIBLE_BY]->(:Enclave) Its nodes share the rights that the finding needs.
(:AddedFinding)-[:ENDED_BY_SPLITTING]->(:Enclave) With an enclave for each of its nodes, and of all others that it
        names so, the finding is gone.
(:Element)-[:{CARRIES}BIOMETRIC]->(:Element) Data of the category goes this step; one type for each category that a
        source brings in or a node makes, and a broader one does not stand for it. From an element to itself where it
        is both source and leak. Followed from a source to a leak, it finds what the analysis finds, dismissed
        findings included.
(:Element)-[:SOURCE_OF]->(:DataCategory) It brings the category in.
{_LABEL}
    through STRINGS only through these channels
(:Element)-[:LEAKS]->(:DataCategory) It lets the category out.
{_LABEL}
(:Element)-[:NO_SOURCE_OF]->(:DataCategory) Labels of lower rank do not make it a source.
{_LABEL}
(:Element)-[:LEAKS_NOT]->(:DataCategory) Labels of lower rank do not make it a leak.
{_LABEL}
(:Element)-[:SANITIZES]->(:DataCategory) It cleans the category.
{_LABEL}
    method STRING anonymise, aggregate, drop, absent or pseudonymise; none counts as the last
    stated BOOLEAN whether the label states the method
(:Element)-[:PASSES]->(:DataCategory) Reviewed: it passes the category on.
{_LABEL}
(:Element)-[:DERIVES]->(:DataCategory) It makes the category of another.
{_LABEL}
    of STRING name of the category that it is made of
(:Element)-[:NEVER_HAS]->(:DataCategory) A mundane channel.
{_LABEL}
(:Element)-[:MAY_HAVE]->(:DataCategory) A channel, reviewed.
{_LABEL}
(:Element)-[:HAS_ONLY]->(:DataCategory) A channel carries what is named so at most.
{_LABEL}
(:Element)-[:HAS_BY_TYPE]->(:DataCategory) A channel carries only what its message type is made for.
{_LABEL}
(:Element)-[:HAS_NOT]->(:DataCategory) A channel does not carry the category.
{_LABEL}
(:Element)-[:DERIVES_FROM]->(:Element) What the first makes of other data comes from the second, a source.
    category STRING name of the category that is made
    way STRINGS names of the elements from the source to it, both included
    policy STRINGS file:line of the policy line behind each step of the path
    past_leak BOOLEAN every path there goes through a leak of that category
{_OURS}
(:Element)-[:OF_ROBOT]->(:Robot) Whose element it is.
(:Element)-[:IN_ENCLAVE]->(:Enclave) The node has a profile in the enclave.
    file STRING of the profile
    line INTEGER of the profile
{_OURS}
(:DataCategory)-[:BROADER]->(:DataCategory) The second is broader (skos:broader).
(:DataCategory)-[:FALLS_UNDER]->(:LegalProvision) Data of the category can be what the provision speaks of.
    verdict STRING always, conditional or may-reveal
    condition STRING when, where it is not always
    stated_of STRING category, or broader or narrower ones, that the ontology says it of
    sources STRINGS what the verdict rests on
(:DataCategory)-[:LOOK_AT]->(:LegalProvision) A provision to look at beside those that data of the category fall
        under; it is not followed into paths.
(:Finding)-[:OF_CATEGORY]->(:DataCategory) What arrives; of an `AddedFinding` too.
(:Finding)-[:FROM]->(:Element) The source; of an `AddedFinding` too.
(:Finding)-[:TO]->(:Element) The leak; of an `AddedFinding` too.
(:Finding)-[:ACROSS]->(:Element) An element of its shortest way.
    step INTEGER 0 for the source
    category STRING the kind of data with which the path gets here
    pseudonymised BOOLEAN in which form
    file STRING of the policy line behind the step to here
    line INTEGER of the policy line behind the step to here
(:Load)-[:WROTE]->(:Robot) It wrote the robot.
    version INTEGER the `version` of the robot that it wrote
(:Change)-[:CAME_WITH]->(:Load) The load that it came with.
(:Bag)-[:HAS_TOPIC]->(:RecordedTopic) The topic is in the bag.
(:RecordedTopic)-[:RECORDS]->(:Element) Of which channel of its robot it tells, or of which leg of one.
"""


def _read(text: str) -> Iterator[tuple[list[str], str, tuple[Property, ...]]]:
    """The names in the head of each kind (label and key, or label, type and label), its meaning and its properties."""
    for block in re.split(r"\n(?=\()", text.replace("\n" + " " * 8, " ").rstrip("\n")):
        head, *lines = block.split("\n")
        named, meaning = head.split(") ", maxsplit=1)
        fields = (line.split(maxsplit=2) for line in lines)
        yield (
            re.findall(r"\w+", named),
            meaning,
            tuple(Property(name, TYPES[kind], what) for name, kind, what in fields),
        )


NODES = tuple(
    NodeKind(label, key, meaning, properties, _FURTHER_LABELS if label == "Element" else "")
    for (label, key), meaning, properties in _read(_NODES)
)
ELEMENT, ROBOT, ENCLAVE, CATEGORY, PROVISION, FINDING, ADDED_FINDING, LOAD, CHANGE, BAG, RECORDED_TOPIC = NODES
RELATIONSHIPS = tuple(
    RelationshipKind(type_, source, target, meaning, properties)
    for (source, type_, target), meaning, properties in _read(_RELATIONSHIPS)
)
_BY_TYPE = {kind.type: kind for kind in RELATIONSHIPS}
FLOWS_TO, COULD_FLOW_TO = _BY_TYPE["FLOWS_TO"], _BY_TYPE["COULD_FLOW_TO"]
MADE_POSSIBLE_BY, ENDED_BY_SPLITTING = _BY_TYPE["MADE_POSSIBLE_BY"], _BY_TYPE["ENDED_BY_SPLITTING"]
CARRIED, DERIVES_FROM, IN_ENCLAVE = _BY_TYPE[f"{CARRIES}BIOMETRIC"], _BY_TYPE["DERIVES_FROM"], _BY_TYPE["IN_ENCLAVE"]
BROADER, FALLS_UNDER, LOOK_AT = _BY_TYPE["BROADER"], _BY_TYPE["FALLS_UNDER"], _BY_TYPE["LOOK_AT"]
ACROSS, CAME_WITH = _BY_TYPE["ACROSS"], _BY_TYPE["CAME_WITH"]
HAS_TOPIC, RECORDS = _BY_TYPE["HAS_TOPIC"], _BY_TYPE["RECORDS"]
ROLES = {
    "source": _BY_TYPE["SOURCE_OF"],
    "leak": _BY_TYPE["LEAKS"],
    "no-source": _BY_TYPE["NO_SOURCE_OF"],
    "no-leak": _BY_TYPE["LEAKS_NOT"],
    "sanitizer": _BY_TYPE["SANITIZES"],
    "conduit": _BY_TYPE["PASSES"],
    "derivation": _BY_TYPE["DERIVES"],
    "mundane": _BY_TYPE["NEVER_HAS"],
    "sensitive": _BY_TYPE["MAY_HAVE"],
    "only": _BY_TYPE["HAS_ONLY"],
    "never": _BY_TYPE["HAS_NOT"],
    TYPE_LINE: _BY_TYPE["HAS_BY_TYPE"],
}
SUFFIXES = ("", "Source", "Leak", "Sanitizer")
INDEXED = (
    (ELEMENT, "robot"),
    (ELEMENT, "frontier"),
    (ENCLAVE, "robot"),
    (FINDING, "robot"),
    (FINDING, "leak_robot"),
    (FINDING, "category"),
    (FINDING, "pattern"),
    (CHANGE, "at"),
)
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
        for kind, key in INDEXED
    ]
    # Of a policy line the number only: the name of its file may be longer than an index takes.
    statements += [
        f"CREATE INDEX {quoted(f'{kind.type}_line')} IF NOT EXISTS FOR ()-[r:{quoted(kind.type)}]-() ON (r.`line`)"
        for kind in (FLOWS_TO, ACROSS)
    ]
    # A text index takes names of any length.
    statements.append("CREATE TEXT INDEX `Element_name` IF NOT EXISTS FOR (n:`Element`) ON (n.`name`)")
    return statements
