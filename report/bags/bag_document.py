"""Bags with what can be in them -> the JSON document ``rosprivacy.bags/1``, which is a contract."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model.recording import BagVerdict, iso

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.model import Suggestion
    from rosprivacy.analysis.model.recording import JudgedBag, TopicKinds
    from rosprivacy.report.contract.bags import BagEntry, BagsDocument, BagTopicEntry, SuggestionEntry

FORMAT = "rosprivacy.bags/1"
WORST_FIRST = tuple(BagVerdict)


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
        "beside": list(bag.beside),
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
        "suggested": [_suggested(rule) for rule in judged.suggested],
    }
    if judged.unknown:
        entry["unknown"] = judged.unknown
    if judged.why:
        entry["why"] = judged.why
    return entry


def _suggested(rule: Suggestion) -> SuggestionEntry:
    return {
        "kinds": list(rule.kinds),
        "confidence": str(rule.confidence),
        "type": rule.type,
        "why": rule.why,
        "source": rule.source,
    }
