"""Bytes of anybody -> the JSON that they hold, or the one problem that they have.

In: what stands in a file. Out: plain values, of which no reader has to fear anything but their shape: no key stands
twice, every text can be written as UTF-8, every number fits into 64 bits, and nothing is nested without end.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NoReturn

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.errors import RosPrivacyError

DEEPEST = 64
LARGEST = 2**63  # what databases and Parquet hold
GZIP, UTF_16 = b"\x1f\x8b", (b"\xff\xfe", b"\xfe\xff")


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
