"""Bytes of anybody -> the JSON that they hold, or the one problem that they have; and where it is not as a schema says.

In: what stands in a file. Out: plain values, of which no reader has to fear anything but their shape: no key stands
twice, every text can be written as UTF-8, every number fits into 64 bits, and nothing is nested without end. Of values
and a schema of the program: lines, each with its place; never what stands there, which may be of a file that is not
ours.
"""

from __future__ import annotations

import json
from itertools import islice
from typing import TYPE_CHECKING, Any, NoReturn

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from jsonschema.exceptions import ValidationError
    from jsonschema.protocols import Validator

    from rosprivacy.analysis.errors import RosPrivacyError

DEEPEST = 64
LARGEST = 2**63  # what databases and Parquet hold
GZIP, UTF_16 = b"\x1f\x8b", (b"\xff\xfe", b"\xfe\xff")
BOUND = 20  # problems of one value
KINDS = {dict: "an object", list: "a list", str: "text", bool: "true or false", type(None): "null"}
TYPE_NAMES = {
    "object": "an object", "array": "a list", "string": "text", "boolean": "true or false", "null": "null",
    "integer": "a whole number", "number": "a number",
}  # fmt: skip


class _RefusedError(ValueError):
    """What the standard library lets pass."""


def parsed(data: bytes, fail: Callable[[int, str, str], RosPrivacyError], remedy: str) -> Any:
    """Return the value that stands in a JSON file.

    Parameters
    ----------
    fail
        Makes the error of the caller's kind from line, problem and hint.
    remedy
        How to get such a file: the hint.

    Raises
    ------
    RosPrivacyError
        Of the caller's kind.

    Examples
    --------
    >>> from rosprivacy.analysis.errors import InputError
    >>> parsed(b'{"a": [1, 1e999]}', lambda line, *said: InputError("f.json", line, *said), "write it again")
    Traceback (most recent call last):
        ...
    rosprivacy.analysis.errors.InputError: f.json: a[1] is too large a number; write it again
    """
    text = _text(data, fail, remedy)
    try:
        value = json.loads(text, object_pairs_hook=_each_key_once, parse_constant=_no_number)
    except json.JSONDecodeError as error:
        raise fail(error.lineno, f"not JSON, or not to its end: {error.msg}", remedy) from None
    except _RefusedError as error:
        raise fail(0, str(error), remedy) from None
    except ValueError:
        raise fail(0, "a number of thousands of digits", remedy) from None
    except RecursionError:
        raise fail(0, "nested too deeply", remedy) from None
    wrong = _unfit(value, 0)
    if wrong:
        raise fail(0, f"{place(wrong[0])} {wrong[1]}", remedy)
    return value


def place(way: str) -> str:
    """Return where in a document something is, fit for a message.

    >>> place(".findings[3].id"), place("")
    ('findings[3].id', 'the document')
    """
    return shown(way.removeprefix(".")) or "the document"


def _text(data: bytes, fail: Callable[[int, str, str], RosPrivacyError], remedy: str) -> str:
    if not data.strip():
        raise fail(0, "the file is empty", remedy)
    if data.startswith(GZIP):
        raise fail(0, "the file is compressed", "unpack it with gunzip")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        hint = "let rosprivacy write the file with -o" if data.startswith(UTF_16) else remedy
        raise fail(data.count(b"\n", 0, error.start) + 1, "not UTF-8", hint) from None


def _each_key_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    made = dict(pairs)
    if len(made) < len(pairs):
        keys = [key for key, _ in pairs]
        raise _RefusedError(f"the key {shown(next(key for key in keys if keys.count(key) > 1))!r} stands twice")
    return made


def _no_number(word: str) -> NoReturn:
    raise _RefusedError(f"{word} is no number of JSON")


def _unfit(value: Any, depth: int) -> tuple[str, str] | None:
    """Where something is that JSON can hold and nobody can use, and what; None if nowhere."""
    if isinstance(value, str):
        return None if _written(value) else ("", "is no text: half of a surrogate pair")
    if isinstance(value, (int, float)):
        return None if -LARGEST <= value < LARGEST else ("", "is too large a number")
    if isinstance(value, (dict, list)):
        return ("", "is nested too deeply") if depth == DEEPEST else _unfit_inside(value, depth + 1)
    return None


def _unfit_inside(value: dict[str, Any] | list[Any], depth: int) -> tuple[str, str] | None:
    if isinstance(value, list):
        pairs = ((f"[{index}]", inside) for index, inside in enumerate(value))
    else:
        if not all(map(_written, value)):
            return "", "has a key that is no text: half of a surrogate pair"
        pairs = ((f".{key}", inside) for key, inside in value.items())
    for key, inside in pairs:
        wrong = _unfit(inside, depth)
        if wrong:
            return key + wrong[0], wrong[1]
    return None


def _written(text: str) -> bool:
    if text.isascii():
        return True
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


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
    """Return where a value is not as it should be, and how; no more than ``BOUND``.

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
