"""A bag with its copy that may be shared -> the JSON document ``rosprivacy.shared-bag/1``, a contract; lines."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.bags import suggestion_entry

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.model.recording import SharedBag, SharedTopic
    from rosprivacy.report.schemas.bags import SharedBagDocument, SharedTopicEntry

FORMAT = "rosprivacy.shared-bag/1"
WIDTH = 80
INDENT = "    "
ALL = "any kind of personal data"
PROOF = (
    "The copy was read again: it has these topics with these numbers of messages, and nothing else. That proves the "
    "topics, not what is in their messages: labels are a person's word, and no message was looked at."
)
HINT = "Next: label topics that were left out: mundane, or only: [KIND, …] (docs/bags.md)"


def shared_bag_document(shared: SharedBag, assumptions: Mapping[str, Any]) -> SharedBagDocument:
    """Return the document of a bag and its copy, with what that rests on (S12)."""
    return {
        "format": FORMAT,
        "bag": shared.bag,
        "copy": shared.copy or None,
        "without": list(shared.without),
        "messages": shared.messages,
        "topics": [_topic(topic) for topic in shared.topics],
        "left_out": [_topic(topic) for topic in shared.omitted],
        "extras": list(shared.extras),
        "assumptions": dict(assumptions),
    }


def _topic(shared: SharedTopic) -> SharedTopicEntry:
    judged = shared.judged
    return {
        "topic": judged.topic.name,
        "types": list(judged.topic.types),
        "messages": shared.messages,
        "kinds": list(judged.bound or judged.kinds),
        "suggested": [suggestion_entry(rule) for rule in judged.suggested],
        "why": shared.reason,
    }


def shared_bag_lines(document: SharedBagDocument, width: int = WIDTH) -> Iterator[str]:
    """Yield the lines that say what is in the copy and what is not, and why; names are never broken."""
    without = f"without {', '.join(document['without']) or ALL}"
    bag, topics, others = shown(document["bag"]), document["topics"], document["left_out"]
    if document["copy"] is None:
        head = f"nothing written: no topic of {bag} with a message is known to be {without}"
    else:
        whole = counted(len(topics) + len(others), "topic")
        messages = counted(document["messages"], "message")
        head = f"written: {shown(document['copy'])}, {len(topics)} of {whole} of {bag}, {messages}, {without}"
    yield from _wrapped(head, "", width)
    if topics:
        yield ""
        yield "in the copy:"
        for topic in topics:
            yield from _topic_lines(topic, width)
    if others or document["extras"]:
        yield ""
        yield "left out:"
        for topic in others:
            yield from _topic_lines(topic, width)
        for what in document["extras"]:
            yield from _wrapped(f"{what}: can hold anything", "  ", width)
    yield ""
    yield from _wrapped(PROOF if document["copy"] is not None else HINT, "", width)


def _topic_lines(topic: SharedTopicEntry, width: int) -> Iterator[str]:
    count = "messages not counted" if topic["messages"] is None else counted(topic["messages"], "message")
    yield from _wrapped(f"{shown(topic['topic'])}, {count}: {topic['why']}", "  ", width)


def _wrapped(text: str, indent: str, width: int) -> list[str]:
    inner = indent + INDENT if indent else ""
    return textwrap.wrap(
        text,
        width,
        initial_indent=indent,
        subsequent_indent=inner,
        break_long_words=False,
        break_on_hyphens=False,
    )
