"""The document of bags -> lines for the terminal: the verdict first, then each bag with its topics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model.recording import BagVerdict
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.contract.bags import BagEntry, BagsDocument, BagTopicEntry

FOUND = {
    BagVerdict.PERSONAL_DATA: "kinds of personal data can be in {}",
    BagVerdict.UNDETERMINED: "of {} nobody can say what is in it",
    BagVerdict.NOTHING_FOUND: "by the labels no kind of personal data is in {}",
}
HINT = "label the open topics (docs/bags.md), or name the policies of the system with --policy"


def bag_lines(document: BagsDocument) -> Iterator[str]:
    """Yield the lines of an answer about bags."""
    bags = document["bags"]
    verdicts = [bag["verdict"] for bag in bags]
    said = [
        words.format(counted(verdicts.count(verdict), "bag")) for verdict, words in FOUND.items() if verdict in verdicts
    ]
    yield f"{document['verdict']}: {'; '.join(said)}"
    for bag in bags:
        yield ""
        yield from _bag(bag)
    if any(bag["open_topics"] for bag in bags):
        yield ""
        yield f"Next: {HINT}"


def _bag(bag: BagEntry) -> Iterator[str]:
    yield f"{bag['verdict']}: {shown(bag['bag'])}"
    about = [bag["storage"], f"{bag['bytes']:,} bytes", bag["distro"], bag["compression"]]
    if bag["start"] and bag["end"]:
        about.append(f"{bag['start']} to {bag['end']}")
    about.append(_messages(bag["messages"]))
    yield f"  {', '.join(shown(one) for one in about if one)}"
    width = max((len(shown(topic["topic"])) for topic in bag["topics"]), default=0)
    for topic in bag["topics"]:
        yield f"  {shown(topic['topic']):{width}}  {_topic(topic)}"
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


def _topic(topic: BagTopicEntry) -> str:
    types = ", ".join(map(shown, topic["types"])) or "no type"
    kinds = ", ".join(topic["kinds"]) or ("open: " + topic["unknown"] if "unknown" in topic else "nothing found")
    return f"{kinds}  ({types}, {_messages(topic['messages'])})"


def _messages(count: int | None) -> str:
    return "messages not counted" if count is None else counted(count, "message")
