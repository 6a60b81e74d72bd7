"""The JSON Schema of label files, for editors: the format of ``label_reader.py`` as data.

In: the categories. Out: a schema (draft 2020-12) that completes their names and accepts every name that finds one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import NON_ROS
from rosprivacy.ingest.labels.entries import END_KINDS, LONGEST_NAME
from rosprivacy.ingest.labels.keywords import (
    CATEGORIES,
    CHANNEL,
    CONTEXT,
    DURATION,
    END,
    END_OF_KIND,
    FLOW,
    NAME,
    NODE,
    TEXT,
    by_category,
    keywords_of,
    map_of,
    moves_data,
    words_of,
)
from rosprivacy.ingest.labels.pins import CHANNEL_KINDS, CODE, KEYS, LINES, PINS, SECTION_OF, VERSION_DIGITS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import Category

SURROUNDINGS = {
    "context": {**CONTEXT, "description": "Where the system works: what its data may reveal depends on it."},
    "country": {"type": "string", "pattern": "^[A-Z]{2}$", "description": "Where it runs, ISO 3166-1; quote NO."},
    "gdpr": {
        "type": "object",
        "description": "Outside the EEA: whether the GDPR applies (Article 3).",
        "additionalProperties": False,
        "minProperties": 1,
        "properties": {
            "established": {
                "type": "boolean",
                "description": "It belongs to an establishment of the controller or a processor in the Union (3(1)).",
            },
            "targeted": {
                "type": "boolean",
                "description": "Persons in the Union are offered goods or services, or monitored there (3(2)).",
            },
        },
    },
}
OUTSIDE_NAME = {"type": "string", "pattern": r"^[^/=*?\[:][^:]*$", "maxLength": LONGEST_NAME}
FULL_NAME = {"type": "string", "pattern": r"^(=|/[^*?\[]*$)", "description": "A name in full; = before glob signs."}
PUBLISHED = ("source", "leak", "conduit")  # first in the published schema; the others follow in the order of the table


def label_schema(categories: Iterable[Category]) -> dict[str, Any]:
    """Return the schema.

    Parameters
    ----------
    categories
        Whose names and definitions an editor offers.
    """
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "rosprivacy label file",
        "description": "Which elements of a ROS 2 system bring in, let out, clean or pass on which personal data.",
        "type": "object",
        "required": ["labels"],
        "additionalProperties": False,
        "properties": {
            "labels": {"const": 1, "description": "Version of the format."},
            "author": _keywords(NODE)["author"],
            **processing_of_system(),
            "nodes": _section(NODE, "Labels of nodes, by absolute name or glob."),
            "channels": _section(CHANNEL, "Labels of topics, services and actions, by absolute name or glob."),
            "topics": _section(CHANNEL, "As channels, for topics only."),
            "services": _section(CHANNEL, "As channels, for services only."),
            "actions": _section(CHANNEL, "As channels, for actions only."),
            **SURROUNDINGS,
            **non_ros_sections(),
            PINS: _pins(),
        },
        "$defs": {
            "category": {
                "anyOf": [
                    {"oneOf": [{"const": c.name, "description": c.definition} for c in categories]},
                    {"type": "string", "minLength": 1, "description": "Another name, a synonym or the IRI of one."},
                ]
            },
            "node": _label(NODE),
            "channel": _label(CHANNEL),
            "duration": {"type": "string", "pattern": "^P", "description": "ISO 8601, such as P30D."},
            "element": {"oneOf": [_element(kind) for kind in NON_ROS]},
            "flow": _flow(),
        },
    }


def processing_of_system() -> dict[str, Any]:
    """Return what the tops of label and fleet files say of the whole system."""
    of_node = _keywords(NODE)
    return {
        "controller": {**TEXT, "description": "Who is responsible (GDPR, Article 4(7)); of joint controllers all."},
        "dpo": {**TEXT, "description": "The data-protection officer, and how to reach them."},
        "purpose": of_node["purpose"],
        "legal_basis": of_node["legal_basis"],
    }


def non_ros_sections() -> dict[str, Any]:
    """Return the sections that fleet files have too."""
    return {
        "elements": {
            "type": ["object", "null"],
            "description": "What lies outside ROS, by name: storages, servers, side channels.",
            "propertyNames": OUTSIDE_NAME,
            "additionalProperties": {"$ref": "#/$defs/element"},
        },
        "limits": {
            **by_category(DURATION),
            "type": ["object", "null"],
            "minProperties": 0,
            "description": "How long kinds of data may be kept at most.",
        },
        "flows": {"type": ["array", "null"], "items": {"$ref": "#/$defs/flow"}},
    }


def _keywords(where: str) -> dict[str, Mapping[str, Any]]:
    """The schemas of what stands behind the keywords of a map."""
    of_map = {name: word.schema for name, word in keywords_of(where).items() if word.schema is not None}
    return {name: of_map[name] for name in dict.fromkeys([*PUBLISHED, *of_map]) if name in of_map}


def _label(where: str) -> dict[str, Any]:
    words = words_of(where)
    word = {"enum": [*words]} if len(words) > 1 else {"const": words[0]}
    return {"anyOf": [{"type": "null"}, word, map_of(_keywords(where))]}


def _element(kind: str) -> dict[str, Any]:
    """An element outside ROS of one kind: its facts, and labels as of nodes."""
    labels = _keywords(NODE)
    element = {**map_of({"kind": {"const": kind}} | _keywords(kind) | labels), "required": ["kind"]}
    if kind == "device":
        element["anyOf"] = [{"required": [key]} for key in labels if key in moves_data(NODE)]
    return element


def _flow() -> dict[str, Any]:
    end = {"anyOf": [END, END_OF_KIND]}
    return {
        **map_of({"from": end, "to": end} | _keywords(FLOW)),
        "required": ["from", "to"],
        "anyOf": [  # what policies know can only be restricted
            {"required": ["only"]},
            {"required": ["never"]},
            {"properties": {"from": OUTSIDE_NAME}},
            {"properties": {"to": OUTSIDE_NAME}},
        ],
    }


def _pins() -> dict[str, Any]:
    """What a person has seen where globs decide: names in full, and kinds as they are emitted."""
    end = {"anyOf": [OUTSIDE_NAME, {**END_OF_KIND, "properties": dict.fromkeys(END_KINDS, FULL_NAME)}]}
    ends = {"from": end, "to": end, "kinds": CATEGORIES}
    of_kind = {"type": ["object", "null"], "propertyNames": FULL_NAME, "additionalProperties": CATEGORIES}
    texts = {"type": "array", "items": {"type": "string"}}
    taken = map_of(dict.fromkeys(KEYS, texts))
    version = {"type": "string", "pattern": f"^[0-9a-f]{{{VERSION_DIGITS}}}$"}
    units = {"type": "object", "minProperties": 1, "additionalProperties": version}
    by_line = {"type": ["object", "null"], "propertyNames": FULL_NAME, "additionalProperties": taken}
    return {
        "type": ["object", "null"],
        "description": "Written by 'labels --pin': which kinds reached the elements that globs of this file decide.",
        "additionalProperties": False,
        "properties": {
            **dict.fromkeys(SECTION_OF.values(), of_kind),
            "flows": {"type": ["array", "null"], "items": {**map_of(ends), "required": [*ends]}},
            CODE: {
                "type": ["object", "null"],
                "description": "Written by 'labels --pin-code': node -> its class or file -> hash of its version.",
                "propertyNames": FULL_NAME,
                "additionalProperties": units,
            },
            LINES: {
                "type": ["object", "null"],
                "description": "With which types and writers a person took the lines 'only: by-type'.",
                "additionalProperties": False,
                "properties": dict.fromkeys(map(SECTION_OF.__getitem__, CHANNEL_KINDS), by_line),
            },
        },
    }


def _section(kind: str, description: str) -> dict[str, Any]:
    return {
        "type": ["object", "null"],
        "description": description,
        "propertyNames": NAME,
        "additionalProperties": {"$ref": f"#/$defs/{kind}"},
    }
