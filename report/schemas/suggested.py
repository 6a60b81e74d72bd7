"""The documents of suggestions: ``rosprivacy.suggestions/1`` and ``rosprivacy.model-exchanges/1``."""

from typing import Annotated, Any

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import SHA256, Confidence, Count, Keywords, Positive, Sha256, Verdict, one_of
from rosprivacy.report.schemas.records import FileEntry


class EvidenceEntry(TypedDict):
    """One reason: where it comes from, how sure that is, and the rule or line behind it; line 0 for no line."""

    ground: Annotated[
        str,
        one_of("glob", "code", "package", "type", "name", "data-flow", "neighbour", "model"),
        "What the reason comes from; glob is a label of yours that says otherwise and names no element; model is "
        "a language model, which makes nothing surer than may.",
    ]
    confidence: Confidence
    reason: str
    file: Annotated[str, "Of the rule, or of the line of code; model:NAME for a language model."]
    line: Annotated[Count, "0 where there is none."]


class ProposalEntry(TypedDict):
    """A label that a person is asked about; nothing follows from it."""

    robot: Annotated[str, "Of a fleet: which one, in whose label files it belongs; empty where there is only one."]
    section: Annotated[str, one_of("nodes", "topics", "services", "actions"), "Of the label file."]
    name: Annotated[str, "As a label file writes it: = stands before a name with glob signs."]
    role: Annotated[
        str, one_of("source", "leak", "derivation", "sensitive", "sanitizer", "conduit", "mundane", "never")
    ]
    kind: Annotated[str, "Name of the category; empty for every one."]
    confidence: Confidence
    open: Annotated[bool, "Whether the answer waits for the element (an open question)."]
    hides: Annotated[bool, "Whether a wrong one could hide a leak, or that nobody has looked."]
    by_hand: Annotated[
        bool, "Whether it would take away data of which a finding is known: it is not written into a label file."
    ]
    label: Annotated[dict[str, Any], "What would stand in the label file under section and name."]
    evidence: Annotated[list[EvidenceEntry], Keywords(minItems=1), "The surest first."]


class ModelEntry(TypedDict):
    """What was asked of a language model."""

    name: str
    url: Annotated[str, "Where it was asked."]
    masked: Annotated[bool, "Whether names were masked."]
    recorded: Annotated[str, "When the answers were recorded, YYYY-MM-DD; empty if the model was asked in this run."]
    requests: Count
    unread: Annotated[dict[str, Positive], "Requests without an answer that can be read, by reason."]
    dropped: Annotated[dict[str, Positive], "Answers that were left out, by reason."]


class UnplacedUse(TypedDict):
    """What source code uses of a library, where nobody knows of which node."""

    uses: Annotated[str, "A name of a library, or $ and a program that is started."]
    file: str
    line: Positive


class UnreadCode(TypedDict):
    """Source code that could not be read; line 0 for no line."""

    file: str
    line: Annotated[Count, "0 where there is none."]
    problem: str


class RobotEntry(TypedDict):
    """A robot of a fleet that is asked about, and all that are alike, itself first; ``model`` is empty without one."""

    robot: str
    model: Annotated[str, "Empty without one."]
    alike: Annotated[list[str], Keywords(minItems=1), "All for which it stands, itself first."]


class NoticeEntry(TypedDict):
    """What a reader has to know of a file."""

    file: str
    line: Count
    message: str


class SuggestionsDocument(TypedDict):
    """What elements could be labelled as, in review order: rosprivacy suggest --format json. Questions, no facts."""

    format: Annotated[str, Keywords(const="rosprivacy.suggestions/1")]
    suggestions: list[ProposalEntry]
    unplaced: Annotated[
        list[UnplacedUse],
        "What source code uses of libraries that a rule speaks about, and that belongs to no node that is known here.",
    ]
    unread: Annotated[list[UnreadCode], "Source code that could not be read, so that it suggests nothing."]
    of_others: Annotated[
        list[str],
        "Folders with code of others (third_party, build …), or that is not built (COLCON_IGNORE), below what was "
        "named: they are not looked at.",
    ]
    verdict: Annotated[Verdict, "Under the labels that there are."]
    rules: Annotated[
        list[FileEntry], "The tables and rules that were asked, and a file with recorded answers of a language model."
    ]
    files: Annotated[list[FileEntry], "Policies, label files and files of types."]
    model: Annotated[NotRequired[ModelEntry], "What was asked of a language model; only there if one was asked."]
    robots: Annotated[
        list[RobotEntry], "Of a fleet: the robots that are asked about; robots that are alike are asked about once."
    ]
    notices: Annotated[list[NoticeEntry], "What a reader has to know of the packages that were read."]
    rosprivacy: str


class ExchangeEntry(TypedDict):
    """A question to a language model, and its answer."""

    question: Annotated[str, "The body of the request, byte by byte; it is ASCII."]
    question_sha256: Sha256
    answer: Annotated[
        str | None,
        Keywords(type=["string", "null"]),
        "The body of the answer, with [key] in place of the key; null where there was none.",
    ]
    answer_sha256: Annotated[str | None, Keywords(type=["string", "null"], pattern=SHA256)]


class ExchangesDocument(TypedDict):
    """What was sent to a language model and what it answered: rosprivacy suggest --model … --record FILE. No key is in
    it.
    """

    format: Annotated[str, Keywords(const="rosprivacy.model-exchanges/1")]
    model: Annotated[str, "Its name, as its server knows it."]
    url: Annotated[str, "Where the questions were sent."]
    masked: Annotated[bool, "Whether names were masked."]
    date: Annotated[
        str, Keywords(pattern="^[0-9]{4}-[0-9]{2}-[0-9]{2}$"), "When, in UTC; or the day of SOURCE_DATE_EPOCH."
    ]
    exchanges: list[ExchangeEntry]
