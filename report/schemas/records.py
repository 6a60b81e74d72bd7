"""What stands in the rows of a document: elements, files, lines, findings, decisions, open questions, the ledger."""

from typing import Annotated

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import (
    Always,
    Article9,
    Context,
    ContextVerdict,
    Count,
    Day,
    ElementKind,
    GdprScope,
    Id,
    Keywords,
    LawVerdict,
    Leg,
    NotStated,
    Positive,
    Severity,
    Sha256,
    closed,
    one_of,
)


@closed
class ElementEntry(TypedDict):
    """An element."""

    robot: str
    kind: ElementKind
    name: str
    leg: Annotated[NotRequired[Leg], "Of a service or action."]
    pattern: Annotated[NotRequired[Always], "The name is a wildcard expression."]


class FileEntry(TypedDict):
    """A file that was read."""

    file: str
    sha256: Sha256


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
    """A line that allows or denies something; where it was seen in use, when; of a scan, the line of the code."""

    seen: Annotated[
        NotRequired[SeenEntry], "Of an observed policy: through which doors, and from when to when, it was seen in use."
    ]
    basis: Annotated[
        NotRequired[str],
        "Of a scanned policy: how the code at this line fixes the name (literal, description, launch, default, "
        "package, guessed).",
    ]


@closed
class Reached(TypedDict):
    """An element, and the categories there."""

    element: ElementEntry
    categories: list[str]


@closed
class Stopped(Reached):
    """A channel that a shipped file takes as mundane, what stops there, and the nearest leak that it keeps it from."""

    keeps_from: Annotated[
        NotRequired[ElementEntry],
        "The nearest labelled leak, storage or element outside ROS that nothing else keeps this data from.",
    ]


class StepEntry(TypedDict):
    """A step of a witness."""

    role: Annotated[str, one_of("publish", "subscribe", "request", "reply", "call", "execute", "matches", "flow")]
    category: Annotated[str, "What goes along this step."]
    pseudonymised: bool
    policy: Annotated[list[GrantEntry], "The grants behind it; none where a wildcard covers a name."]


class ChangedSince(TypedDict):
    """What is not as it was when a decision was made: view, path, disjoint_paths, robots, or what is stated."""

    what: Annotated[str, one_of("view", "path", "disjoint_paths", "robots", "stated")]
    before: str
    now: str


LegalBasis = Annotated[
    str,
    Keywords(
        pattern=r"^(6\(1\)\([a-f]\)|6\(4\)|9\(2\)\([a-j]\)|9\(3\)|10|45|46\(2\)\([a-f]\)|46\(3\)|47"
        r"|49\(1\)\([a-g]\))$"
    ),
]


Answers = Annotated[
    dict[str, str],
    "To the legal questions of the row: assessment (of the transfer), occasional (Article 49), processor (28), joint "
    "(26), unencrypted (32), criminal (10), special (9(2)).",
]


class LoggedEntry(TypedDict):
    """One entry of a log of decisions."""

    hash: Annotated[str, "Of the entry; the next one names it."]
    when: Annotated[str, "When it was written, in UTC."]
    account: Annotated[str, "Who wrote it, as the system and git know them."]
    decision: Annotated[
        str,
        one_of("accept", "accept-on-condition", "mitigate", "delegate", "avoid", "confirm", "withdraw"),
        "A choice; confirm: the condition is met; withdraw: it is not decided any more.",
    ]
    owner: Annotated[str, "Who answers for it, as they stated."]
    reason: str
    expires: Day | None
    answers: NotRequired[Answers]


class DecisionEntry(TypedDict):
    """What was decided."""

    choice: Annotated[
        str,
        one_of("accept", "accept-on-condition", "mitigate", "delegate", "avoid"),
        "accept-on-condition counts as nothing until a person confirms the condition; then it is accept.",
    ]
    state: Annotated[
        str, one_of("valid", "expired", "orphaned"), "orphaned: it is about no finding. An expired one decides nothing."
    ]
    reason: str
    owner: str
    legal_basis: list[LegalBasis]
    date: Day | None
    expires: Day | None
    ticket: str | None
    file: str
    line: Positive
    condition: Annotated[NotRequired[str], "What has to be so before it counts, or had to be."]
    answers: NotRequired[Answers]
    history: Annotated[
        NotRequired[list[LoggedEntry]],
        Keywords(minItems=1),
        "Of a log: what was decided about the same target, the latest last.",
    ]
    changed: Annotated[
        NotRequired[list[ChangedSince]],
        Keywords(minItems=1),
        "What is not as it was when it was decided, where the decision remembers it (made_about of the decisions "
        "file). The decision still counts; but a robot that was not there is not decided about.",
    ]


@closed
class LawEntry(TypedDict):
    """A provision that a finding's data can fall under."""

    provision: str
    verdict: LawVerdict
    condition: str


@closed
class ContextLaw(TypedDict):
    """What a finding's data may reveal in a context."""

    context: Context
    provision: str
    verdict: ContextVerdict
    condition: str


@closed
class WhyEntry(TypedDict):
    """A reason as a key and values, for words of any language."""

    key: Annotated[
        str,
        one_of(
            "no-retention",
            "no-retention-for",
            "endless-backups",
            "kept-longer",
            "kept-longer-in-backups",
            "kept-past",
            "not-adequate",
            "no-longer-adequate",
            "partly-adequate",
            "stated-not-adequate",
            "stated-no-longer-adequate",
            "not-encrypted",
            "strangers",
            "not-encrypted-nor-closed",
        ),
    ]
    values: dict[str, str]


class FindingMore(TypedDict, total=False):
    """What only some findings have."""

    in_context: Annotated[
        list[ContextLaw],
        "What the data may reveal in the context of their source, which takes part in article9; and provisions "
        "that concern them there.",
    ]
    gdpr: Annotated[
        GdprScope,
        "Whether the GDPR applies (Article 3), where the source of the data is outside the EEA and that is not "
        "affirmed: a question, or denied by a label file.",
    ]
    reason: Annotated[str, "Of other kinds than disclosure: what is wrong there, in English."]
    because: Annotated[
        WhyEntry,
        "The same as a key and values, for words of any language: categories, durations, countries, files and "
        "lines as stated.",
    ]
    beside_pseudonymised: Annotated[
        Always,
        "Data as it is, which arrives through another leak only, where pseudonymised data arrives past it: the "
        "pseudonymised finding of the same ends stands beside this one. Its id is made with the word 'plain'.",
    ]
    paths: Annotated[list[list[ElementEntry]], "With --paths disjoint or all."]
    paths_bounded: Annotated[bool, "There are more than --max-paths."]
    decision: Annotated[DecisionEntry | None, "With --decisions: what was decided about it; null where nothing was."]


class FindingEntry(FindingMore):
    """A finding."""

    id: Annotated[Id, "Made from category, source and leak."]
    kind: Annotated[
        str,
        one_of("disclosure", "storage-limitation", "third-country-transfer", "unprotected-channel"),
        "disclosure: it reaches a leak. storage-limitation: a storage that keeps it without a stated end, or "
        "longer than a label file allows. third-country-transfer: an element outside the EEA without a stated "
        "basis. unprotected-channel: a channel that others on the network can read.",
    ]
    category: str
    pseudonymised: Annotated[
        bool,
        "The data arrives in pseudonymised form only. Where data as it is arrives too, through another leak only, "
        "that is a finding of its own (beside_pseudonymised).",
    ]
    source: ElementEntry
    leak: Annotated[ElementEntry, "The leak, the storage, or the element outside the EEA."]
    witness: Annotated[list[ElementEntry], Keywords(minItems=1), "One shortest path, source first."]
    steps: Annotated[NotRequired[list[StepEntry]], "Between the elements of the witness: one fewer."]
    disjoint_paths: Annotated[
        int | None,
        Keywords(type=["integer", "null"], minimum=1),
        "Paths that share no flow; null where they were not counted: what the enforced view adds from one robot "
        "of a fleet to another.",
    ]
    through: Annotated[list[ElementEntry], "Other leaks of the category on the witness, if dismissed."]
    dismissed: Annotated[bool, "Every path goes through another leak of the category, which has a finding of its own."]
    article9: Annotated[
        Article9, "The strongest verdict under Article 9(1) GDPR; unknown where the ontology says nothing."
    ]
    special_from: Annotated[ElementEntry | None, "The element that makes a special category of data that were none."]
    law: list[LawEntry]
    accepted: Annotated[bool, "A valid decision accepts it; it then hides nothing behind it."]


@closed
class Target(TypedDict, total=False):
    """What a decision says that it is about."""

    id: str
    row: Annotated[str, "Of the register, of a fleet its pattern: the findings that end there."]
    category: str
    source: str
    leak: str
    robot: str
    from_robot: str
    robots: Annotated[list[str], "As robot: one of these, and no other."]
    from_robots: Annotated[list[str], "As from_robot: one of these, and no other."]
    kind: str
    pseudonymised: bool


class ListedDecision(DecisionEntry):
    """An entry of the decisions file, and the findings that it is about."""

    target: Annotated[Target, "What the entry says that it is about."]
    findings: Annotated[list[Id], "Ids of the findings that it is about."]


@closed
class LabelKey(TypedDict):
    """Where a label file says something of an element, and under which name."""

    section: Annotated[str, one_of("nodes", "topics", "services", "actions", "elements")]
    name: str


class OpenEntry(TypedDict):
    """An element that nobody has reviewed."""

    element: ElementEntry
    categories: list[str]
    distance: Annotated[Count, "Flows from the nearest source; the two sides of a wildcard are one element."]
    frontier: Annotated[bool, "A node that a category reaches without another open node or a leak of it on the way."]
    label: Annotated[
        NotRequired[LabelKey],
        "The section and the name under which a label file says something of this element and of no other; = "
        "stands before a name with glob signs.",
    ]
    through: Annotated[
        NotRequired[ElementEntry | None], "The element that data comes from, on a shortest path; null at a source."
    ]
    closes: Annotated[
        NotRequired[Count],
        "How many other open elements data gets to past this one only, at least: what a label that ends the data "
        "here would close.",
    ]
    leaks: Annotated[NotRequired[Count], "How many leaks data gets to past this one only, at least."]
    waits: Annotated[
        NotRequired[bool], "A channel from which data gets to no open element but channels, and to no leak."
    ]
    infrastructure: Annotated[
        NotRequired[bool], "A channel that rosprivacy:infrastructure proposes to take as mundane."
    ]
    missing: Annotated[
        NotRequired[list[NotStated]],
        "What has to be known of an element outside ROS and is not stated: its country; of a transfer on a "
        "derogation (GDPR Article 49) whether it is occasional.",
    ]


class UnknownEnd(TypedDict):
    """An end where nobody is known."""

    element: ElementEntry
    unknown: Annotated[
        str,
        one_of("reader", "flow"),
        "What is not known: who reads a channel (of a service's or action's leg its server or client), or the "
        "flow that leads to an element outside ROS.",
    ]
    categories: Annotated[list[str], "What is on the channel."]


class DiagnosticEntry(TypedDict):
    """A problem of an input."""

    file: str
    line: Count
    severity: Severity
    message: str
    code: Annotated[
        NotRequired[str],
        "What it is, for programs: unread-file, dead-deny, shared-enclave, fallback-taken, empty-group, "
        "refused-name, joins-nothing, leak-joins-nothing, own-domains, observed, enclaves-made-up, folded-names, "
        "made-without-warnings, observation-gap, scanned, scan-gap, seen-although-denied, bag-gap, access-gap, "
        "recording; absent "
        "where nobody has to tell it from others.",
    ]


class AcceptedDoubt(TypedDict):
    """Who accepted a doubt, why, and until when; the line of the decisions file."""

    reason: str
    owner: str
    expires: str
    ticket: str
    file: str
    line: Count


class DoubtEntry(TypedDict):
    """Something that is not known, or rests on more than a person's word (rule S11)."""

    id: Annotated[Id, "The same as long as it is about the same element, or the same problem of a file."]
    doubt: Annotated[
        str, "The sort of doubt, such as no-reader or unread-file; docs/method.md lists them. New ones may come."
    ]
    rank: Annotated[
        str,
        one_of("breaks", "rides"),
        "breaks: the verdict is undetermined at best; rides: it is named in the sentence.",
    ]
    element: Annotated[ElementEntry | None, "What it is about; null of a file, or of the whole answer."]
    categories: Annotated[list[str], "The kinds of data that are in doubt; empty for any."]
    count: Annotated[Positive, "How many elements it stands for: of robots that are alike one is named."]
    file: Annotated[str, "A file to look at; empty where none speaks of it."]
    line: Count
    message: Annotated[str, "Of a file: what is wrong and what to do; else empty."]
    accepted: Annotated[
        AcceptedDoubt | None,
        "Who accepted it, why and until when, by the decisions file; it then neither breaks the verdict nor fails "
        "in CI.",
    ]


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


@closed
class GlobEntry(PlaceEntry):
    """What a glob of a label file decides and closes."""

    says: Annotated[list[str], "The roles that it gives."]
    elements: Annotated[Count, "How many elements it decides: no label of higher rank says otherwise."]
    closed: Annotated[Count, "At how many of them data ends for it."]
    reviewed: Annotated[Count, "How many of them are not asked about for it."]
    flows: Annotated[NotRequired[Count], "How many flows between two elements it decides (only, never)."]
    flows_closed: Annotated[NotRequired[Count], "Along how many of them data ends for it."]
    leak: Annotated[ElementEntry | None, "A leak behind what it closes."]
    open: Annotated[ElementEntry | None, "An element behind what it closes that nobody has reviewed."]
    warning: Annotated[
        str,
        one_of("", "half", "last-path"),
        "last-path: without it the verdict would not be no-leak-found. half: of earlier versions, it decides more "
        "than half of what data gets to.",
    ]


class OpeningEntry(TypedDict):
    """A finding that there would be, or would be worse, if a statement were wrong."""

    kind: str
    category: str
    source: ElementEntry
    leak: ElementEntry
    dismissed: Annotated[bool, "It would be reached only through another leak."]
    pseudonymised: Annotated[bool, "Only pseudonymised data would get there."]
    new: Annotated[bool, "There is none today; else it is dismissed or pseudonymised today, and would not be."]


class OpenedEntry(TypedDict):
    """An element that would be open if a statement were wrong."""

    element: ElementEntry
    categories: list[str]


class RelianceEntry(TypedDict):
    """What hangs on one statement of a label file."""

    role: Annotated[
        str,
        one_of(
            "sanitizer", "conduit", "mundane", "sensitive", "only", "never", "by-type", "cannot", "no-source", "no-leak"
        ),
        "What the statement says; no-source and no-leak are `source: none` and `leak: none`; by-type is "
        "`only: by-type`; cannot is of the type of a channel.",
    ]
    method: Annotated[str, "Of a sanitizer; absent of a node that is said not to be there; else empty."]
    categories: Annotated[list[str], "That it names; none where it is about every kind."]
    file: str
    line: int
    glob: Annotated[bool, "It names what it is about by a glob."]
    shipped: Annotated[
        bool,
        "It stands in a file that comes with the program, or in one that takes its place: standard channels, "
        "types, infrastructure.",
    ]
    why: Annotated[str, "The label's note, or why a node is not there; empty if nobody says."]
    author: Annotated[str, "Who says it, by the label file; empty if nobody is named."]
    elements: Annotated[list[ElementEntry], "Where it is said and data is; the start of a flow."]
    to: Annotated[list[ElementEntry], "The ends of flows, for what is about these."]
    findings: Annotated[
        list[OpeningEntry], "The findings that there would be, or would be worse, those that stand first."
    ]
    questions: Annotated[
        list[OpenedEntry], "The elements that would be open, each with the kinds for which it is not today."
    ]
    refused: Annotated[
        str, "Why the system cannot be analysed without it: other labels would contradict each other. Else empty."
    ]
    perhaps: Annotated[bool, "It was not worked out: too many statements need an analysis of the whole."]


class LedgerRow(TypedDict):
    """What was taken away, and on whose word."""

    by: Annotated[
        str,
        one_of(
            "deny",
            "standard-channel",
            "type",
            "mundane",
            "only",
            "never",
            "sanitizer",
            "absent",
            "outdone",
            "review",
            "decision",
            "restriction",
            "unread-file",
            "unknown-reader",
        ),
        "What took it away: a DENY line, a channel of the standard file, a label's word, a statement of higher "
        "rank (outdone: of a source or leak), a label that answers for an element (review), an accepted finding, "
        "a restriction of the question, a file that was not read, an end where nobody is known.",
    ]
    element: Annotated[ElementEntry | None, "Where; the start of a flow."]
    to: Annotated[ElementEntry | None, "The end of a flow, for what is about one."]
    categories: Annotated[list[str], "What is there and does not go on, or is not asked about."]
    places: Annotated[list[PlaceEntry], "The lines that say so."]
    glob: Annotated[bool, "Only globs say so, no name."]
    leak: Annotated[ElementEntry | None, "The nearest leak that data would get to without it."]
    open: Annotated[ElementEntry | None, "The nearest element without a label that data would get to without it."]
    itself: Annotated[bool, "The element would be open itself."]
    perhaps: Annotated[bool, "It was not worked out what lies behind."]
    note: Annotated[str, "More in words; the id of an accepted finding."]
