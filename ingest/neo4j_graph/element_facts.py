"""What is stated about an element <-> its properties in Neo4j: for each fact a writer and a reader (S7 to S10, S15).

In: facts as ``Bound`` keeps them; or properties, also those that people wrote by hand. Out: the other. What cannot be
understood is a ``ValueError`` that says which and why.
"""

from __future__ import annotations

import json
from dataclasses import astuple
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.durations import ordered, parse
from rosprivacy.analysis.model import (
    CHANNELS,
    NO_BASIS,
    UNSTATED,
    Exposure,
    MessageType,
    NonRosFacts,
    Place,
    Processing,
    kind_of_type,
)
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, STRANGERS
from rosprivacy.analysis.model.recording import Recording
from rosprivacy.analysis.non_ros import EVERY, RECIPIENTS, TRANSFERS
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ingest.labels.stated_facts import GROUNDS, surroundings_of
from rosprivacy.ingest.neo4j_graph.schema import DATABASE
from rosprivacy.ingest.reading.legal_basis import HINT, legal_basis

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.durations import Duration
    from rosprivacy.analysis.model import Bound, ByCategory, Element, Surroundings

    Row = dict[str, Any]
    Properties = Mapping[str, Any]

BAG = ("bag_bytes", "bag_topics", "bag_messages", "bag_start", "bag_end", "bag_oldest")
CAUSES = (NOT_ENCRYPTED, STRANGERS)


class ElementFact(NamedTuple):
    """A fact about an element.

    Attributes
    ----------
    field
        Of ``Bound``, where it stands by vertex.
    write
        (the fact or None, the element) -> properties; null where nothing is stated.
    read
        (properties, the element, names of categories) -> the fact; empty where nothing is stated.
    example
        How a person writes it in Cypher; empty where the documentation says it.
    """

    field: str
    write: Callable[[Any, Element], Row]
    read: Callable[[Properties, Element, Collection[str]], Any]
    example: str = ""


def stated_properties(bound: Bound, vertex: int, element: Element) -> Row:
    """Return the properties of what is stated about an element; outside ROS ``outside_properties`` are more."""
    row: Row = {}
    for fact in ELEMENT_FACTS:
        row |= fact.write(getattr(bound, fact.field).get(vertex), element)
    return row


def _texts(properties: Properties, key: str) -> list[str]:
    written = properties.get(key) or []
    if not isinstance(written, list) or not all(isinstance(text, str) for text in written):
        raise ValueError(f"{key} is not a list of texts")
    return written


def _text(properties: Properties, key: str) -> str:
    value = properties.get(key)
    if not (value is None or isinstance(value, str)):
        raise ValueError(f"{key} is not a text")
    return value or ""


def _place(properties: Properties, file: str = "file", line: str = "line") -> Place:
    return Place(_text(properties, file), int(properties.get(line) or 0))


def _surroundings_properties(where: Surroundings | None, element: Element) -> Row:
    """Where it works; the country of an element outside ROS is a fact of its own."""
    of_system = {"country": where.country} if where and where.country and element.is_node else {}
    grounds = {f"gdpr_{ground}": getattr(where, ground) if where else None for ground in GROUNDS}
    return {"context": list(where.contexts) or None if where else None, **of_system, **grounds}


def types_properties(types: Iterable[MessageType], robot: str) -> Row:
    """Return the properties of a channel of a robot with these message types; null where it has none.

    >>> seen = MessageType("a/msg/A", Place("t.yaml", 4), writers=("/a",), definition="A.msg", fields=("b/msg/B",))
    >>> types_of(types_properties([seen], ""), "") == (seen,)
    True
    """
    types = tuple(types)
    return {
        "types": sorted({each.name for each in types}) or None,
        "type_facts": [json.dumps(_type_as_json(each, robot), sort_keys=True) for each in types] or None,
    }


def _type_as_json(message_type: MessageType, robot: str) -> Row:
    facts = {
        "stated": message_type.stated,
        "hash": message_type.hash,
        "writers": list(message_type.writers),
        "readers": list(message_type.readers),
        "first": message_type.first,
        "last": message_type.last,
        "file": message_type.place.file,
        "line": message_type.place.line,
        "robot": message_type.robot if message_type.robot != robot else "",
        "definition": message_type.definition,
        "fields": list(message_type.fields),
    }
    return {"type": message_type.name, **{key: value for key, value in facts.items() if value}}


def types_of(properties: Properties, robot: str) -> tuple[MessageType, ...]:
    """Return the types that properties state; one without facts is a person's word in the database, for all writers.

    Parameters
    ----------
    robot
        Of the channel: whose writers and readers are meant where nothing else is said.
    """
    names = _texts(properties, "types")
    try:
        stored = [_type_of_json(json.loads(text), robot) for text in properties.get("type_facts") or []]
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"type_facts are not what was loaded: {error}") from None
    by_hand = [name for name in names if name not in {each.name for each in stored}]
    for name in by_hand:
        if not kind_of_type(name):
            raise ValueError(f"{name!r} is not the name of a type")
    return (*stored, *(MessageType(name, Place(DATABASE, 0), stated=True, robot=robot) for name in by_hand))


def _type_of_json(properties: Properties, robot: str) -> MessageType:
    return MessageType(
        str(properties["type"]),
        Place(str(properties.get("file") or DATABASE), int(properties.get("line") or 0)),
        stated=bool(properties.get("stated")),
        hash=str(properties.get("hash") or ""),
        writers=tuple(map(str, properties.get("writers") or ())),
        readers=tuple(map(str, properties.get("readers") or ())),
        first=str(properties.get("first") or ""),
        last=str(properties.get("last") or ""),
        robot=str(properties.get("robot") or robot),
        definition=str(properties.get("definition") or ""),
        fields=tuple(map(str, properties.get("fields") or ())),
    )


def exposure_properties(exposures: Iterable[Exposure]) -> Row:
    """Return why others on the network can read a channel (rule S10); null where they cannot.

    >>> exposures_of(exposure_properties([Exposure("strangers", Place("g.p7s", 4))]))
    (Exposure(cause='strangers', place=Place(file='g.p7s', line=4)),)
    """
    return {"unprotected": [f"{each.cause}: {each.place.file}:{each.place.line}" for each in exposures] or None}


def exposures_of(properties: Properties) -> tuple[Exposure, ...]:
    """Return the exposures that properties state, sorted; a cause alone is a person's word in the database."""
    exposures = set()
    for text in _texts(properties, "unprotected"):
        cause, _, place = text.partition(": ")
        file, _, line = place.rpartition(":")
        if cause not in CAUSES or (place and not line.isdecimal()):
            raise ValueError(f"unprotected {text!r} is none of {', '.join(CAUSES)}, with the file and line that say so")
        exposures.add(Exposure(cause, Place(file, int(line)) if place else Place(DATABASE, 0)))
    return tuple(sorted(exposures))


def processing_properties(stated: Processing) -> Row:
    """Return what data are processed for, on which basis and by whom (Article 30(1)); null where nothing is stated.

    >>> set(processing_properties(UNSTATED).values())
    {None}
    """
    return {
        "controller": stated.controller or None,
        "dpo": stated.dpo or None,
        "purposes": list(_prefixed(stated.purposes)) or None,
        "legal_bases": list(_prefixed(stated.bases)) or None,
        "stated_in": stated.place.file if stated else None,
        "stated_at": stated.place.line if stated else None,
    }


def _of_element(stated: Processing | None) -> Row:
    """Only a robot has a controller and an officer."""
    row = processing_properties(stated or UNSTATED)
    return {key: value for key, value in row.items() if key not in ("controller", "dpo")}


def processing_of(properties: Properties, categories: Collection[str]) -> Processing:
    """Return what properties of an element or a robot state."""
    controller, dpo = _text(properties, "controller"), _text(properties, "dpo")
    purposes = _by_category(properties, "purposes", categories)
    bases = tuple(
        (category, tuple(map(_basis, texts))) for category, texts in _by_category(properties, "legal_bases", categories)
    )
    stated = Processing(controller, dpo, purposes, bases)
    place = _place(properties, "stated_in", "stated_at")
    return Processing(controller, dpo, purposes, bases, place) if stated else stated


def _prefixed(stated: ByCategory) -> Iterator[str]:
    """``6(1)(f)`` for every category, ``Video: 6(1)(f)`` for one."""
    yield from (f"{category}: {text}" if category else text for category, texts in stated for text in texts)


def _by_category(properties: Properties, key: str, categories: Collection[str]) -> ByCategory:
    by_category: dict[str, set[str]] = {}
    for written in _texts(properties, key):
        category, colon, text = written.partition(": ")
        of, what = (category, text) if colon and category in categories else (EVERY, written)
        by_category.setdefault(of, set()).add(what)
    return tuple(sorted((category, tuple(sorted(texts))) for category, texts in by_category.items()))


def _basis(written: str) -> str:
    basis = legal_basis(written)
    if basis is None:
        raise ValueError(f"legal basis {written!r}; {HINT}")
    return basis


ELEMENT_FACTS = (
    ElementFact(
        "subjects",
        lambda groups, _: {"subjects": list(groups or ())},
        lambda properties, *_: tuple(sorted(set(_texts(properties, "subjects")))),
        "SET n.subjects = ['residents', 'staff']",
    ),
    ElementFact(
        "surroundings",
        _surroundings_properties,
        lambda properties, element, _: surroundings_of(properties, ros=element.is_node),
        "SET n.context = ['care'], n.country = 'DE', n.gdpr_targeted = false",
    ),
    ElementFact(
        "types",
        lambda types, element: types_properties(types or (), element.robot),
        lambda properties, element, _: () if element.is_node else types_of(properties, element.robot),
    ),
    ElementFact(
        "exposed",
        lambda exposures, _: exposure_properties(exposures or ()),
        lambda properties, element, _: exposures_of(properties) if element.kind in CHANNELS else (),
    ),
    ElementFact(
        "processing",
        lambda stated, _: _of_element(stated),
        lambda properties, _, categories: processing_of(properties, categories),
    ),
)


def outside_properties(facts: NonRosFacts) -> Row:
    """Return the properties of an element outside ROS (rule S9); null where nothing is stated."""
    backups, recording = facts.backups, facts.recording
    return {
        "retention": _durations_written(facts.retention),
        "limits": _durations_written(facts.limits),
        "backups": backups if backups is None else str(backups).lower() if isinstance(backups, bool) else str(backups),
        "encrypted": facts.encrypted,
        "country": facts.country or None,
        "operator": facts.operator or None,
        "recipient": facts.recipient or None,
        "transfer": facts.transfer or None,
        "contract": facts.contract or None,
        "bag": recording.bag if recording else None,
        **dict(zip(BAG, astuple(recording)[1:] if recording else (None,) * len(BAG), strict=True)),
        "file": facts.place.file or None,
        "line": facts.place.line or None,
    }


def outside_facts(properties: Properties, categories: Collection[str]) -> NonRosFacts:
    """Return the facts about an element outside ROS that properties state."""
    country, recipient, transfer = (_text(properties, key) for key in ("country", "recipient", "transfer"))
    if country and country not in countries().areas:
        raise ValueError(f"country {country!r} is not an ISO 3166-1 code; {countries().hint(country)}")
    if recipient and recipient not in RECIPIENTS:
        raise ValueError(f"recipient {recipient!r} is none of {', '.join(RECIPIENTS)}")
    if transfer and transfer not in (*TRANSFERS, NO_BASIS):
        raise ValueError(f"transfer {transfer!r} is none of {', '.join(TRANSFERS)}")
    encrypted = properties.get("encrypted")
    if not (encrypted is None or isinstance(encrypted, bool)):
        raise ValueError("encrypted is not true or false")
    return NonRosFacts(
        _durations(properties, "retention", categories),
        _durations(properties, "limits", categories),
        _backups(properties.get("backups")),
        encrypted=encrypted,
        operator=_text(properties, "operator"),
        recipient=recipient,
        transfer=transfer,
        contract=_text(properties, "contract"),
        place=_place(properties),
        recording=_recording(properties),
        **(countries().place(country) if country else {}),
    )


def _recording(properties: Properties) -> Recording | None:
    bag = _text(properties, "bag")
    if not bag:
        return None
    numbers = [properties.get(key) for key in BAG]
    for key, number in zip(BAG, numbers, strict=True):
        if not (number is None or (isinstance(number, int) and not isinstance(number, bool))):
            raise ValueError(f"{key} is not a whole number")
    size, topics, messages, start, end, oldest = numbers
    earliest = next((moment for moment in (oldest, start, end) if moment is not None), None)  # of an earlier load
    return Recording(bag, size or 0, topics or 0, messages, start, end, earliest)


def _durations_written(stated: tuple[tuple[str, Duration], ...]) -> list[str] | None:
    """``P30D`` for every category, ``Video: P30D`` for one."""
    return [f"{category}: {duration}" if category else str(duration) for category, duration in stated] or None


def _durations(properties: Properties, key: str, categories: Collection[str]) -> tuple[tuple[str, Duration], ...]:
    written = properties.get(key) or []
    stated = []
    for text in [written] if isinstance(written, str) else written:
        category, colon, duration = str(text).rpartition(": ")
        if colon and category not in categories:
            raise ValueError(f"{key} names the unknown category {category!r}")
        stated.append((category or EVERY, _duration(f"{key} {duration!r}", duration)))
    return ordered(stated)


def _backups(written: Any) -> Duration | bool | None:
    if written is None or isinstance(written, bool):
        return written
    if written in ("true", "false"):
        return bool(written == "true")
    return _duration(f"backups {written!r}", str(written))


def _duration(name: str, text: str) -> Duration:
    try:
        return parse(text)
    except ValueError as error:
        raise ValueError(f"{name} is {error}") from None
