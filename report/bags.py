"""Bags with what can be in them -> the JSON document ``rosprivacy.bags/1``, which is a contract; lines; a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model.recording import BagVerdict, iso
from rosprivacy.analysis.text import counted, printable
from rosprivacy.report.spreadsheet import as_csv

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Suggestion
    from rosprivacy.analysis.model.recording import JudgedBag, TopicKinds
    from rosprivacy.report.schemas.bags import BagEntry, BagsDocument, BagTopicEntry, SuggestionEntry

FORMAT = "rosprivacy.bags/1"
WORST_FIRST = tuple(BagVerdict)
HEAD = (
    "bag", "verdict", "kinds", "open_topics", "complete", "storage", "distro", "compression", "bytes", "start", "end",
    "messages", "topics", "not_known", "suggested",
)  # fmt: skip
VERDICT_TEXTS = {
    BagVerdict.PERSONAL_DATA: "kinds of personal data can be in {}",
    BagVerdict.UNDETERMINED: "of {} nobody can say what is in it",
    BagVerdict.NOTHING_FOUND: "by the labels no kind of personal data is in {}",
}
HINT = "label the open topics (docs/bags.md), or name the policies of the system with --policy"


def bags_document(bags: Sequence[JudgedBag], assumptions: Mapping[str, Any]) -> BagsDocument:
    """Return the document of some bags, with what it rests on (S12)."""
    verdict = min((bag.verdict for bag in bags), key=WORST_FIRST.index, default=BagVerdict.UNDETERMINED)
    return {
        "format": FORMAT,
        "verdict": str(verdict),
        "bags": [_bag(bag) for bag in bags],
        "assumptions": dict(assumptions),
    }


def _bag(judged: JudgedBag) -> BagEntry:
    bag = judged.bag
    return {
        "bag": bag.path,
        "verdict": str(judged.verdict),
        "storage": bag.storage,
        "distro": bag.distro,
        "compression": bag.compression,
        "complete": bag.complete,
        "files": list(bag.files),
        "bytes": bag.size,
        "start": iso(bag.start) or None,
        "end": iso(bag.end) or None,
        "messages": bag.messages,
        "kinds": list(judged.kinds),
        "suggested": [{"kind": kind, "confidence": str(sure)} for kind, sure in judged.suggested.items()],
        "open_topics": list(judged.open_topics),
        "topics": [_topic(topic) for topic in judged.topics],
        "gaps": list(bag.gaps),
        "beside": list(bag.extras),
        "notes": list(bag.notes),
    }


def _topic(judged: TopicKinds) -> BagTopicEntry:
    topic = judged.topic
    entry: BagTopicEntry = {
        "topic": topic.name,
        "types": list(topic.types),
        "type_hashes": list(topic.hashes),
        "messages": topic.messages,
        "kinds": list(judged.kinds),
        "suggested": [suggestion_entry(rule) for rule in judged.suggested],
    }
    if judged.unknown:
        entry["unknown"] = judged.unknown
    if judged.why:
        entry["why"] = judged.why
    return entry


def suggestion_entry(rule: Suggestion) -> SuggestionEntry:
    """Return what a rule about a type suggests."""
    return {
        "kinds": list(rule.kinds),
        "confidence": str(rule.confidence),
        "type": rule.type,
        "why": rule.why,
        "source": rule.source,
    }


def bag_lines(document: BagsDocument) -> Iterator[str]:
    """Yield the lines of an answer about bags."""
    bags = document["bags"]
    verdicts = [bag["verdict"] for bag in bags]
    said = [
        words.format(counted(verdicts.count(verdict), "bag"))
        for verdict, words in VERDICT_TEXTS.items()
        if verdict in verdicts
    ]
    yield f"{document['verdict']}: {'; '.join(said)}"
    for bag in bags:
        yield ""
        yield from _bag_lines(bag)
    if any(bag["open_topics"] for bag in bags):
        yield ""
        yield f"Next: {HINT}"


def _bag_lines(bag: BagEntry) -> Iterator[str]:
    yield f"{bag['verdict']}: {shown(bag['bag'])}"
    about = [bag["storage"], f"{bag['bytes']:,} bytes", bag["distro"], bag["compression"]]
    if bag["start"] and bag["end"]:
        about.append(f"{bag['start']} to {bag['end']}")
    about.append(_messages(bag["messages"]))
    yield f"  {', '.join(shown(one) for one in about if one)}"
    width = max((len(shown(topic["topic"])) for topic in bag["topics"]), default=0)
    for topic in bag["topics"]:
        yield f"  {shown(topic['topic']):{width}}  {_topic_line(topic)}"
        for rule in topic["suggested"]:
            yield f"    {rule['type']} suggests {', '.join(rule['kinds'])} ({rule['confidence']}): {shown(rule['why'])}"
    if bag["suggested"]:
        kinds = ", ".join(f"{one['kind']} ({one['confidence']})" for one in bag["suggested"])
        yield f"  suggested by its types, as questions: {kinds}"
    for what in bag["gaps"]:
        yield f"  not complete: {what}"
    for what in bag["beside"]:
        yield f"  not known: {what} can hold anything"
    for what in bag["notes"]:
        yield f"  note: {what}"


def _topic_line(topic: BagTopicEntry) -> str:
    types = ", ".join(map(shown, topic["types"])) or "no type"
    kinds = ", ".join(topic["kinds"]) or ("open: " + topic["unknown"] if "unknown" in topic else "nothing found")
    return f"{kinds}  ({types}, {_messages(topic['messages'])})"


def _messages(count: int | None) -> str:
    return "messages not counted" if count is None else counted(count, "message")


def bag_table(document: BagsDocument) -> str:
    """Return the table; several values in a cell are separated by spaces, sentences by semicolons."""
    return as_csv(HEAD, (_row(bag) for bag in document["bags"]))


def _row(bag: BagEntry) -> tuple[str | float, ...]:
    return (
        printable(bag["bag"]),
        bag["verdict"],
        " ".join(bag["kinds"]),
        " ".join(map(printable, bag["open_topics"])),
        "yes" if bag["complete"] else "no",
        printable(bag["storage"]),
        printable(bag["distro"]),
        bag["compression"],
        bag["bytes"],
        bag["start"] or "",
        bag["end"] or "",
        "" if bag["messages"] is None else bag["messages"],
        len(bag["topics"]),
        "; ".join([*bag["gaps"], *bag["beside"]]),
        "; ".join(f"{one['kind']} ({one['confidence']})" for one in bag["suggested"]),
    )
