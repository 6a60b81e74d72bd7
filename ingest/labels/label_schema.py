"""The JSON Schema of label files, for editors: the format of ``label_file.py`` as data.

In: the categories. Out: a schema (draft 2020-12) that completes their names and accepts every name that finds one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CLEANS, CONTEXTS, NO_BASIS, NON_ROS
from rosprivacy.analysis.non_ros import RECIPIENTS, TRANSFERS
from rosprivacy.ingest.labels.label_reader import LONGEST_GROUP, NONE, SAYS_NOTHING
from rosprivacy.ingest.labels.name_reader import END_KINDS
from rosprivacy.ingest.labels.non_ros_reader import BAG, CARRIERS
from rosprivacy.ingest.labels.pins import PINS, SECTION_OF
from rosprivacy.ingest.labels.stated_processing import LONGEST

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Category

_TEXT = {"type": "string", "pattern": "\\S", "maxLength": LONGEST}
BASIS = {"type": ["string", "integer"], "description": "Such as 6(1)(f), 9(2)(h), 46(2)(c)."}
END = {"type": "string", "minLength": 1}
TYPES = {
    "type": "array",
    "minItems": 1,
    "items": {"type": "string", "pattern": "^[A-Za-z]\\w*/(msg|srv|action)/[A-Za-z]\\w*$"},
    "description": "Message types of all who write it, such as sensor_msgs/msg/Image.",
}
END_OF_KIND = {
    "type": "object",
    "additionalProperties": False,
    "minProperties": 1,
    "maxProperties": 1,
    "properties": dict.fromkeys(END_KINDS, END),
    "description": "Which of several of that name: {topic: /map} or {node: /map}.",
}
AUTHOR = {
    "type": "string",
    "pattern": "\\S",
    "maxLength": LONGEST_GROUP,
    "description": "Who says it; of a file, of all that names nobody else.",
}
CONTEXT = {"anyOf": [{"enum": list(CONTEXTS)}, {"type": "array", "minItems": 1, "items": {"enum": list(CONTEXTS)}}]}
SURROUNDINGS = {
    "context": {**CONTEXT, "description": "Where the system works: what its data may reveal depends on it."},
    "country": {"type": "string", "pattern": "^[A-Z]{2}$", "description": "Where it runs, ISO 3166-1; quote NO."},
}
OUTSIDE_NAME = {"type": "string", "pattern": r"^[^/=*?\[:][^:]*$", "maxLength": 200}
FULL_NAME = {"type": "string", "pattern": r"^(=|/[^*?\[]*$)", "description": "A name in full; = before glob signs."}
NAME = {"type": "string", "pattern": r"^[/=*?\[]", "description": "A name, a glob, or = and a name with glob signs."}


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
            "author": AUTHOR,
            **processing_of_system(),
            "nodes": _section("node", "Labels of nodes, by absolute name or glob."),
            "channels": _section("channel", "Labels of topics, services and actions, by absolute name or glob."),
            "topics": _section("channel", "As channels, for topics only."),
            "services": _section("channel", "As channels, for services only."),
            "actions": _section("channel", "As channels, for actions only."),
            **SURROUNDINGS,
            **non_ros_sections(),
            PINS: _pins(),
        },
        "$defs": _definitions(list(categories)),
    }


def processing_of_system() -> dict[str, Any]:
    """Return what the tops of label and fleet files say of the whole system."""
    return {
        "controller": {**_TEXT, "description": "Who is responsible (GDPR, Article 4(7)); of joint controllers all."},
        "dpo": {**_TEXT, "description": "The data-protection officer, and how to reach them."},
        **_processing(),
    }


def _processing() -> dict[str, Any]:
    """What data are processed for, and on which basis: for all kinds of data, or for each."""
    kinds = {"purpose": _TEXT, "legal_basis": BASIS}
    words = {"purpose": "What data are processed for.", "legal_basis": "Such as 6(1)(f), 9(2)(h), 10."}
    some = {key: {"anyOf": [one, {"type": "array", "minItems": 1, "items": one}]} for key, one in kinds.items()}
    return {
        key: {"description": f"{words[key]} By kind of data where it differs.", "anyOf": [one, _by_category(one)]}
        for key, one in some.items()
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
            **_by_category({"$ref": "#/$defs/duration"}),
            "type": ["object", "null"],
            "minProperties": 0,
            "description": "How long kinds of data may be kept at most.",
        },
        "flows": {"type": ["array", "null"], "items": {"$ref": "#/$defs/flow"}},
    }


def _pins() -> dict[str, Any]:
    """What a person has seen where globs decide: names in full, and kinds as they are emitted."""
    kinds = {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/category"}}
    end = {"anyOf": [OUTSIDE_NAME, {**END_OF_KIND, "properties": dict.fromkeys(END_KINDS, FULL_NAME)}]}
    ends = {"from": end, "to": end, "kinds": kinds}
    of_kind = {"type": ["object", "null"], "propertyNames": FULL_NAME, "additionalProperties": kinds}
    return {
        "type": ["object", "null"],
        "description": "Written by 'labels --pin': which kinds reached the elements that globs of this file decide.",
        "additionalProperties": False,
        "properties": {
            **dict.fromkeys(SECTION_OF.values(), of_kind),
            "flows": {"type": ["array", "null"], "items": {**_object(ends), "required": [*ends]}},
        },
    }


def _either(name: dict[str, Any]) -> dict[str, Any]:
    """An end of a flow: a name, or a name with its kind."""
    return {"anyOf": [name, END_OF_KIND]}


def _section(kind: str, description: str) -> dict[str, Any]:
    return {
        "type": ["object", "null"],
        "description": description,
        "propertyNames": NAME,
        "additionalProperties": {"$ref": f"#/$defs/{kind}"},
    }


def _definitions(categories: list[Category]) -> dict[str, Any]:
    one = {"$ref": "#/$defs/category"}
    some = {"type": "array", "minItems": 1, "items": one}
    said = {
        "note": {"type": "string", "description": "Why; stands in the report where the answer hangs on it."},
        "author": AUTHOR,
    }
    reviewed = {**some, "description": "Reviewed: may carry these."}
    restrictions = {
        "only": {**some, "description": "Carries these at most."},
        "never": {**some, "description": "Does not carry these."},
    }
    return {
        "category": {
            "anyOf": [
                {"oneOf": [{"const": c.name, "description": c.definition} for c in categories]},
                {"type": "string", "minLength": 1, "description": "Another name, a synonym or the IRI of one."},
            ]
        },
        "node": {"anyOf": [{"type": "null"}, {"const": "conduit"}, _node(one, some, said)]},
        "channel": {
            "anyOf": [
                {"type": "null"},
                {"enum": ["mundane", "sensitive"]},
                _object({"sensitive": reviewed, **restrictions, "types": TYPES, **said}),
            ]
        },
        "duration": {"type": "string", "pattern": "^P", "description": "ISO 8601, such as P30D."},
        "element": {"oneOf": [_element(kind, _node(one, some, said)) for kind in NON_ROS]},
        "flow": {
            **_object({"from": _either(END), "to": _either(END), **restrictions, **said}),
            "required": ["from", "to"],
            "anyOf": [  # what policies know can only be restricted
                {"required": ["only"]},
                {"required": ["never"]},
                {"properties": {"from": OUTSIDE_NAME}},
                {"properties": {"to": OUTSIDE_NAME}},
            ],
        },
    }


def _element(kind: str, labels: dict[str, Any]) -> dict[str, Any]:
    """An element outside ROS of one kind: its facts, and labels as of nodes."""
    duration = {"$ref": "#/$defs/duration"}
    facts: dict[str, Any] = {
        "kind": {"const": kind},
        "country": {"type": "string", "pattern": "^[A-Z]{2}$", "description": "ISO 3166-1; quote NO."},
        "operator": {"type": "string", "minLength": 1, "description": "Who runs it."},
        "recipient": {"enum": list(RECIPIENTS)},
        "contract": {"type": "string", "pattern": "\\S", "description": "Such as Article 28, with its date."},
        "transfer": {"enum": [*TRANSFERS, NO_BASIS], "description": "Basis of a transfer out of the EEA."},
    }
    if kind == "storage":
        facts |= {
            "retention": {"anyOf": [duration, _by_category(duration)], "description": "How long data is kept."},
            "backups": {"anyOf": [duration, {"type": "boolean"}], "description": "How much longer backups keep it."},
            "encrypted": {"type": "boolean", "description": "At rest."},
            BAG: {"type": "string", "minLength": 1, "description": "The recording that it is, relative to this file."},
        }
    if kind in CARRIERS:
        facts["between"] = {
            "type": "array",
            "minItems": 2,
            "items": _either(NAME),
            "description": "Nodes that it joins.",
        }
    element = {**_object(facts | labels["properties"]), "required": ["kind"]}
    if kind == "device":
        element["anyOf"] = [{"required": [key]} for key in labels["properties"] if key not in SAYS_NOTHING]
    return element


def _node(one: dict[str, Any], some: dict[str, Any], said: dict[str, Any]) -> dict[str, Any]:
    channels = {"type": "array", "minItems": 1, "items": NAME}
    none = {"const": NONE}
    nothing = {"type": "object", "required": [NONE], "additionalProperties": False, "properties": {NONE: some}}
    through = _by_category(channels)
    return _object(
        {
            "source": {
                "description": "Brings these in; as a map, only through the channels named; none takes labels back.",
                "anyOf": [some, {**through, "properties": {NONE: some}}, none],
            },
            "leak": {
                "anyOf": [some, none, nothing],
                "description": "Lets these out; none takes labels of lower rank back, of all kinds or of some.",
            },
            "conduit": {**some, "description": "Reviewed: passes these on."},
            "sanitizer": {
                "description": "Cleans these; a method that is not stated counts as pseudonymise.",
                "anyOf": [some, _by_category({"enum": [*map(str, CLEANS), None]})],
            },
            "derives": {
                "type": "array",
                "items": {**_object({"from": one, "to": one}), "required": ["from", "to"]},
                "description": "Makes one kind of data of another.",
            },
            "subjects": {
                "type": "array",
                "minItems": 1,
                "items": {"type": "string", "pattern": "\\S", "maxLength": LONGEST_GROUP},
                "description": "Of a source: whom its data are about, such as residents or staff.",
            },
            "context": {**CONTEXT, "description": "Of a source: where it works, beside what is said of its system."},
            **_processing(),
            "absent": {"type": "string", "minLength": 1, "description": "Why it is not on this robot; stands alone."},
            **said,
        }
    )


def _by_category(value: dict[str, Any]) -> dict[str, Any]:
    """A map whose keys are categories."""
    names = {"$ref": "#/$defs/category"}
    return {"type": "object", "minProperties": 1, "propertyNames": names, "additionalProperties": value}


def _object(properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "additionalProperties": False, "properties": properties}
