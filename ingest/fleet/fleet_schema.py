"""The JSON Schema of fleet files, for editors: the format of ``fleet_file.py`` as data.

In: the categories. Out: a schema (draft 2020-12); the sections that label files have too are those of their schema.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.ingest.fleet.fleet_reader import ID, NAMESPACE
from rosprivacy.ingest.labels.keywords import END, END_OF_KIND
from rosprivacy.ingest.labels.label_schema import SURROUNDINGS, label_schema, non_ros_sections, processing_of_system

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Category

NAME = {"type": "string", "pattern": f"^{ID.pattern}$"}
WORD = {"anyOf": [NAME, {"type": "integer", "minimum": 0}]}


def fleet_schema(categories: Iterable[Category]) -> dict[str, Any]:
    """Return the schema.

    Parameters
    ----------
    categories
        Whose names and definitions an editor offers.
    """
    labels = label_schema(categories)
    definitions = {**labels["$defs"], **_definitions()}
    flow = definitions["flow"]
    flow = {key: value for key, value in flow.items() if key != "anyOf"}  # no policy knows of these
    flow["properties"] = {**flow["properties"], "from": _end("From"), "to": _end("To")}
    return {
        "$schema": labels["$schema"],
        "title": "rosprivacy fleet file",
        "description": "Which robots there are, what they run, and what they share.",
        "type": "object",
        "required": ["fleet"],
        "additionalProperties": False,
        "properties": {
            "fleet": {"const": 1, "description": "Version of the format."},
            "name": {**WORD, "description": "What is shared is filed under it; shared by default."},
            "include": {**_files(), "description": "Other fleet files, relative to this one."},
            "models": _section("spec", "What robots of a model have in common."),
            "robots": _section("robot", "Robots by id; what they name is added to their model's."),
            "infrastructure": _section("robot", "What has policies and is not a robot, such as a base station."),
            "groups": {"type": ["array", "null"], "items": {"$ref": "#/$defs/group"}},
            **processing_of_system(),
            **non_ros_sections(),
            **SURROUNDINGS,
            "note": {"type": "string"},
        },
        "$defs": {**definitions, "flow": flow},
    }


def _end(word: str) -> dict[str, Any]:
    what = "an element of this file by its name, or an element of robots: carrier_*:/uplink"
    return {"anyOf": [END, END_OF_KIND], "description": f"{word} {what}."}


def _files() -> dict[str, Any]:
    file = {"type": "string", "minLength": 1}
    return {"anyOf": [file, {"type": "array", "items": file}]}


def _section(kind: str, description: str) -> dict[str, Any]:
    return {
        "type": ["object", "null"],
        "description": description,
        "propertyNames": NAME,
        "additionalProperties": {"anyOf": [{"type": "null"}, {"$ref": f"#/$defs/{kind}"}]},
    }


def _definitions() -> dict[str, Any]:
    space = {"type": "string", "pattern": f"^{NAMESPACE.pattern}$"}
    spec = {
        "policies": {**_files(), "description": "SROS 2 policies: files, folders or globs, relative to this file."},
        "labels": {**_files(), "description": "Label files; those of a robot outrank those of its model."},
        "types": {**_files(), "description": "Message types that were observed; those of a robot and its model hold."},
        "domain": {**WORD, "description": "DDS domain that it shares with others; by default it has its own."},
        **SURROUNDINGS,
        "namespace": {
            "description": "Of a robot, in which * is its id: what its policies have before names, or lack.",
            "oneOf": [_object({key: space}, [key]) for key in ("strip", "add")],
        },
    }
    robot = {"model": {**WORD, "description": "Name of its model."}, **spec, "note": {"type": "string"}}
    group = {
        "robots": {"type": "integer", "minimum": 1, "maximum": 1_000_000, "description": "How many there are."},
        "id": {"type": "string", "description": "Of each, with a * for its number; MODEL_* by default."},
        **robot,
    }
    return {"spec": _object(spec), "robot": _object(robot), "group": _object(group)}


def _object(properties: dict[str, Any], required: list[str] | None = None) -> dict[str, Any]:
    return {
        "type": "object",
        "additionalProperties": False,
        "properties": properties,
        **({"required": required} if required else {}),
    }
