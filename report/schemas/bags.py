"""The documents ``rosprivacy.bags/1`` and ``rosprivacy.shared-bag/1``."""

from typing import Annotated, Any

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import BagVerdict, Confidence, Count, Keywords


class SuggestionEntry(TypedDict):
    """What the type of a topic suggests; nothing follows from it."""

    kinds: Annotated[list[str], "Names of categories."]
    confidence: Annotated[
        Confidence,
        "certain: the type is made to carry it. likely: it does on most robots that work among persons. may: it "
        "depends on what is in it.",
    ]
    type: str
    why: Annotated[str, "The reason."]
    source: Annotated[str, "What the rule was read from."]


class SuggestedKind(TypedDict):
    """A kind that types of a bag suggest, with the surest confidence."""

    kind: Annotated[str, "Name of a category."]
    confidence: Annotated[Confidence, "The surest of all topics."]


class BagTopicEntry(TypedDict):
    """A topic of a bag, and what can be in it."""

    topic: Annotated[str, "Name of the topic, as the bag has it."]
    types: Annotated[list[str], "Of its messages; several where the bag names several."]
    type_hashes: list[str]
    messages: Annotated[Count | None, "How many; null where the bag does not say."]
    kinds: Annotated[list[str], "Names of categories that can be in it, sorted."]
    suggested: Annotated[
        list[SuggestionEntry], "What its types suggest, the surest first: questions for a person, no facts."
    ]
    unknown: Annotated[NotRequired[str], "Why nobody can say what is in it; absent where that is known."]
    why: Annotated[NotRequired[str], "What 'kinds' rests on."]


class BagEntry(TypedDict):
    """A bag, and what can be in it."""

    bag: Annotated[str, "Where it is: a file, or the folder of a recording."]
    verdict: Annotated[
        BagVerdict,
        "personal-data: a kind can be in it. undetermined: nobody can say. nothing-found: by the labels there is "
        "none; it is no word of law.",
    ]
    storage: Annotated[str, "mcap, sqlite3, or what the bag names; empty where nothing could be read."]
    distro: str
    compression: str
    complete: Annotated[bool, "Whether all of its topics are known."]
    files: list[str]
    bytes: Count
    start: Annotated[str | None, "ISO 8601, UTC."]
    end: str | None
    messages: Count | None
    kinds: list[str]
    suggested: Annotated[
        list[SuggestedKind], "Kinds that the types of its topics suggest, sorted: questions, no facts."
    ]
    open_topics: Annotated[list[str], "Of which nobody can say what is in them."]
    topics: list[BagTopicEntry]
    gaps: Annotated[list[str], "Why topics may be missing."]
    beside: Annotated[list[str], "What is in it beside messages, such as attachments; nobody knows what they hold."]
    notes: list[str]


class BagsDocument(TypedDict):
    """What `rosprivacy bag --format json` prints. Keys that are listed here stay; more may be added."""

    format: Annotated[str, Keywords(const="rosprivacy.bags/1")]
    verdict: Annotated[BagVerdict, "The worst of all bags."]
    bags: Annotated[list[BagEntry], "Sorted by where they are."]
    assumptions: Annotated[
        dict[str, Any],
        "What it rests on: with policies as in rosprivacy.analysis/1, else the label files with their hashes.",
    ]


class SharedTopicEntry(TypedDict):
    """A topic that is in a copy of a bag, or was left out of it."""

    topic: Annotated[str, "Name of the topic, as the bag has it."]
    types: list[str]
    messages: Annotated[Count | None, "How many were copied or left out; null where nobody counted them."]
    kinds: Annotated[list[str], "Names of categories that can be in it, sorted."]
    suggested: Annotated[list[SuggestionEntry], "What its types suggest: questions for a person, no facts."]
    why: Annotated[str, "Why it is in the copy, or was left out."]


class SharedBagDocument(TypedDict):
    """What `rosprivacy bag --without KIND --format json` prints. Keys that are listed here stay; more may be added."""

    format: Annotated[str, Keywords(const="rosprivacy.shared-bag/1")]
    bag: Annotated[str, "The bag that was copied."]
    copy: Annotated[str | None, "The file that was written; null where no topic could be copied."]
    without: Annotated[list[str], "Names of the categories that the copy is to be without; empty for all."]
    messages: Annotated[Count, "How many are in the copy."]
    topics: Annotated[list[SharedTopicEntry], "Those in the copy, sorted by name."]
    left_out: Annotated[list[SharedTopicEntry], "Those that are not, sorted by name."]
    extras: Annotated[list[str], "What else was left out, such as attachments."]
    assumptions: Annotated[dict[str, Any], "As of rosprivacy.bags/1."]
