"""A JSON value and a JSON Schema -> where the value is not as the schema says, in words of ours.

In: values, and a schema of the program. Out: lines, each with its place; never what stands there, which may come from
another file than ours. The library ``jsonschema`` checks; it is imported where a file is checked.
"""

from __future__ import annotations

import json
from itertools import islice
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.json_values import place

if TYPE_CHECKING:
    from collections.abc import Mapping

    from jsonschema.exceptions import ValidationError
    from jsonschema.protocols import Validator

BOUND = 20  # problems of one value
KINDS = {dict: "an object", list: "a list", str: "text", bool: "true or false", type(None): "null"}
TYPE_NAMES = {
    "object": "an object", "array": "a list", "string": "text", "boolean": "true or false", "null": "null",
    "integer": "a whole number", "number": "a number",
}  # fmt: skip


def validator(schema: Mapping[str, Any]) -> Validator:
    """Return what checks values; 1.0 is no whole number here, though it is one in JSON Schema.

    >>> check = validator({"type": "integer"})
    >>> check.is_valid(1), check.is_valid(1.0)
    (True, False)
    """
    from jsonschema import Draft202012Validator, validators  # noqa: PLC0415 - light start

    whole = Draft202012Validator.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int)
    extend: Any = validators.extend  # has no types
    made: Validator = extend(Draft202012Validator, type_checker=whole)(schema)
    return made


def misfits(check: Validator, value: Any) -> list[str]:
    """Return where a value is not as it should be, and how; no more than ``MOST``.

    Complexity: O(its size).

    Examples
    --------
    >>> misfits(validator({"required": ["id"], "properties": {"n": {"type": "integer"}}}), {"n": 1.0})
    ['n is a number, not a whole number', 'the document lacks id']
    """
    found = (f"{_place(error)} {_wrong(error)}" for error in islice(check.iter_errors(value), BOUND))
    return sorted(set(found))


def _place(error: ValidationError) -> str:
    return place("".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in error.absolute_path))


def _wrong(error: ValidationError) -> str:
    wanted: Any = error.validator_value
    found: Any = error.instance
    if error.validator == "required":
        return f"lacks {', '.join(key for key in wanted if key not in found)}"
    if error.validator == "type":
        kinds = wanted if isinstance(wanted, list) else [wanted]
        return f"is {KINDS.get(type(found), 'a number')}, not {' or '.join(TYPE_NAMES[kind] for kind in kinds)}"
    if error.validator in ("enum", "const"):
        values = wanted if isinstance(wanted, list) else [wanted]
        return f"is not {' or '.join(json.dumps(value) for value in values)}"
    if error.validator == "minItems":
        return "is empty"
    if error.validator == "additionalProperties":
        return "has a key that the format does not know"
    return "is not what the format says"
