"""Message types of channels as properties of elements, and back (rule S15)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import MessageType, Place, kind_of_type
from rosprivacy.ingest.database.flow_statements import DATABASE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def type_properties(types: Iterable[MessageType], robot: str) -> dict[str, Any]:
    """Return the properties of a channel of a robot with these types; null where it has none.

    >>> seen = MessageType("std_msgs/msg/Bool", Place("t.yaml", 4), writers=("/door",))
    >>> types_of(type_properties([seen], ""), "") == (seen,)
    True
    """
    types = tuple(types)
    return {
        "types": sorted({one.name for one in types}) or None,
        "type_facts": [json.dumps(_facts(one, robot), sort_keys=True) for one in types] or None,
    }


def _facts(one: MessageType, robot: str) -> dict[str, Any]:
    facts = {
        "stated": one.stated,
        "hash": one.hash,
        "writers": list(one.writers),
        "readers": list(one.readers),
        "first": one.first,
        "last": one.last,
        "file": one.place.file,
        "line": one.place.line,
        "robot": one.robot if one.robot != robot else "",
    }
    return {"type": one.name, **{key: value for key, value in facts.items() if value}}


def types_of(properties: Mapping[str, Any], robot: str) -> tuple[MessageType, ...]:
    """Return the types that properties state; one without facts is a person's word in the database, for all writers.

    Parameters
    ----------
    robot
        Of the channel: whose writers and readers are meant where nothing else is said.

    Raises
    ------
    ValueError
        If they cannot be understood.
    """
    names, facts = (properties.get(key) or [] for key in ("types", "type_facts"))
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ValueError("types is not a list of texts")
    try:
        known = [_of_facts(json.loads(text), robot) for text in facts]
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"type_facts are not what was loaded: {error}") from None
    told = {one.name for one in known}
    for name in names:
        if name not in told and not kind_of_type(name):
            raise ValueError(f"{name!r} is not the name of a type")
    by_hand = [MessageType(name, Place(DATABASE, 0), stated=True, robot=robot) for name in names if name not in told]
    return (*known, *by_hand)


def _of_facts(said: Mapping[str, Any], robot: str) -> MessageType:
    return MessageType(
        str(said["type"]),
        Place(str(said.get("file") or DATABASE), int(said.get("line") or 0)),
        stated=bool(said.get("stated")),
        hash=str(said.get("hash") or ""),
        writers=tuple(map(str, said.get("writers") or ())),
        readers=tuple(map(str, said.get("readers") or ())),
        first=str(said.get("first") or ""),
        last=str(said.get("last") or ""),
        robot=str(said.get("robot") or robot),
    )
