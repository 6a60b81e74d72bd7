"""The document ``rosprivacy.bags/1``."""

from __future__ import annotations

from typing import Any, NotRequired, TypedDict


class SuggestionEntry(TypedDict):
    """What the type of a topic suggests; nothing follows from it."""

    kinds: list[str]
    confidence: str
    type: str
    why: str
    source: str


class SuggestedKind(TypedDict):
    """A kind that types of a bag suggest, with the surest confidence."""

    kind: str
    confidence: str


class BagTopicEntry(TypedDict):
    """A topic of a bag, and what can be in it."""

    topic: str
    types: list[str]
    type_hashes: list[str]
    messages: int | None
    kinds: list[str]
    suggested: list[SuggestionEntry]
    unknown: NotRequired[str]
    why: NotRequired[str]


class BagEntry(TypedDict):
    """A bag, and what can be in it."""

    bag: str
    verdict: str
    storage: str
    distro: str
    compression: str
    complete: bool
    files: list[str]
    bytes: int
    start: str | None
    end: str | None
    messages: int | None
    kinds: list[str]
    suggested: list[SuggestedKind]
    open_topics: list[str]
    topics: list[BagTopicEntry]
    gaps: list[str]
    beside: list[str]
    notes: list[str]


class BagsDocument(TypedDict):
    """All bags that were read."""

    format: str
    verdict: str
    bags: list[BagEntry]
    assumptions: dict[str, Any]
