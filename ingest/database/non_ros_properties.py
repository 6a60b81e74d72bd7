"""Facts about elements outside ROS <-> properties of the graph in Neo4j (rule S9).

In: ``NonRosFacts``. Out: plain values for ``schema.py``'s properties; and back, also from what people wrote by hand.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.durations import ordered, parse
from rosprivacy.analysis.model import NO_BASIS, NonRosFacts, Place
from rosprivacy.analysis.model.recording import Recording
from rosprivacy.analysis.non_ros import EVERY, RECIPIENTS, TRANSFERS
from rosprivacy.ingest.labels.countries import countries

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.durations import Duration

NUMBERS = ("bag_bytes", "bag_topics", "bag_messages", "bag_start", "bag_end", "bag_oldest")


def properties_of(facts: NonRosFacts) -> dict[str, Any]:
    """Return the properties of an element outside ROS; absent where nothing is stated."""
    backups = facts.backups
    return {
        "retention": _texts(facts.retention),
        "limits": _texts(facts.limits),
        "backups": backups if backups is None else str(backups).lower() if isinstance(backups, bool) else str(backups),
        "encrypted": facts.encrypted,
        "country": facts.country or None,
        "operator": facts.operator or None,
        "recipient": facts.recipient or None,
        "transfer": facts.transfer or None,
        "contract": facts.contract or None,
        **_recorded(facts.recording),
        "file": facts.place.file or None,
        "line": facts.place.line or None,
    }


def facts_of(said: Mapping[str, Any], categories: Collection[str]) -> NonRosFacts:
    """Return the facts that properties state.

    Raises
    ------
    ValueError
        If one cannot be understood; the message says which and why.
    """
    country, recipient, transfer = (_text(said, key) for key in ("country", "recipient", "transfer"))
    if country and country not in countries().areas:
        raise ValueError(f"country {country!r} is not an ISO 3166-1 code; {countries().hint(country)}")
    if recipient and recipient not in RECIPIENTS:
        raise ValueError(f"recipient {recipient!r} is none of {', '.join(RECIPIENTS)}")
    if transfer and transfer not in (*TRANSFERS, NO_BASIS):
        raise ValueError(f"transfer {transfer!r} is none of {', '.join(TRANSFERS)}")
    encrypted = said.get("encrypted")
    if not (encrypted is None or isinstance(encrypted, bool)):
        raise ValueError("encrypted is not true or false")
    return NonRosFacts(
        _durations(said, "retention", categories),
        _durations(said, "limits", categories),
        _backups(said.get("backups")),
        encrypted=encrypted,
        operator=_text(said, "operator"),
        recipient=recipient,
        transfer=transfer,
        contract=_text(said, "contract"),
        place=Place(_text(said, "file"), int(said.get("line") or 0)),
        recording=_recording(said),
        **(countries().place(country) if country else {}),
    )


def _recorded(recording: Recording | None) -> dict[str, Any]:
    """The properties of a storage that is a bag; absent of others."""
    if recording is None:
        return dict.fromkeys(("bag", *NUMBERS))
    times = (recording.start, recording.end, recording.oldest)
    values = (recording.size, recording.topics, recording.messages, *times)
    return {"bag": recording.bag, **dict(zip(NUMBERS, values, strict=True))}


def _recording(said: Mapping[str, Any]) -> Recording | None:
    bag = _text(said, "bag")
    if not bag:
        return None
    numbers = [said.get(key) for key in NUMBERS]
    for key, number in zip(NUMBERS, numbers, strict=True):
        if not (number is None or (isinstance(number, int) and not isinstance(number, bool))):
            raise ValueError(f"{key} is not a whole number")
    size, topics, messages, start, end, oldest = numbers
    earliest = next((moment for moment in (oldest, start, end) if moment is not None), None)  # one of an earlier load
    return Recording(bag, size or 0, topics or 0, messages, start, end, earliest)


def _texts(stated: tuple[tuple[str, Duration], ...]) -> list[str] | None:
    """``P30D`` for every category, ``Video: P30D`` for one."""
    return [f"{category}: {duration}" if category else str(duration) for category, duration in stated] or None


def _durations(said: Mapping[str, Any], key: str, categories: Collection[str]) -> tuple[tuple[str, Duration], ...]:
    written = said.get(key) or []
    found = []
    for text in [written] if isinstance(written, str) else written:
        category, colon, duration = str(text).rpartition(": ")
        if colon and category not in categories:
            raise ValueError(f"{key} names the unknown category {category!r}")
        try:
            found.append((category or EVERY, parse(duration)))
        except ValueError as error:
            raise ValueError(f"{key} {duration!r} is {error}") from None
    return ordered(found)


def _backups(written: Any) -> Duration | bool | None:
    if written is None or isinstance(written, bool):
        return written
    if written in ("true", "false"):
        return bool(written == "true")
    try:
        return parse(str(written))
    except ValueError as error:
        raise ValueError(f"backups {written!r} is {error}") from None


def _text(said: Mapping[str, Any], key: str) -> str:
    value = said.get(key)
    if not (value is None or isinstance(value, str)):
        raise ValueError(f"{key} is not a text")
    return value or ""
