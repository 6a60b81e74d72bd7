"""JSON5 from anybody -> values that know their line.

In: a path. Out: a tree of ``Value``, as of YAML. JSON5 is checked and its strings are read by the package ``json5``,
which knows no lines; these are found here.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.yaml_values import Builder

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.reading.yaml_values import Value

MAX_BYTES = 2**18
"""Of a file; ``json5`` takes some ten seconds for a megabyte."""
MISSING = "install the extra [zenoh] from where rosprivacy came from"
_TOKEN = re.compile(
    r"""//[^\n\r\u2028\u2029]* | /\*.*?(?:\*/|$) | [{}\[\]]
    | "(?:[^"\\]|\\(?:.|$))*(?:"|$) | '(?:[^'\\]|\\(?:.|$))*(?:'|$) | [^\s\ufeff{}\[\]"',:/]+""",
    re.DOTALL | re.VERBOSE,
)
_PLACE = re.compile(r"<string>:(\d+) (.*)", re.DOTALL)
_TOO_DEEP = ("nested more deeply than can be read", "write it flatter")


def read(file: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> tuple[Value, bytes]:
    """Read a file; see ``yaml_values.read``."""
    text, data = read_utf8(file, MAX_BYTES, fail)
    return parse(text, fail, bounds), data


def parse(text: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> Value:
    """Read JSON5 text; see ``yaml_values.read``."""
    try:
        import json5  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise fail(0, f"the package json5 is not there ({error})", MISSING) from error
    try:
        json5.loads(text)
    except RecursionError:
        raise fail(1, *_TOO_DEEP) from None
    except ValueError as error:
        place = _PLACE.fullmatch(str(error))
        line, what = (int(place[1]), place[2]) if place else (1, str(error))
        raise fail(line, f"not JSON5: {shown(what)}", "correct the syntax") from None
    builder = Builder(fail, bounds)
    line, at = 1, 0
    for token in _TOKEN.finditer(text):
        line += text.count("\n", at, token.start())
        at = token.start()
        word = token[0]
        if word in "{[":
            builder.begin(line, "map" if word == "{" else "list")
        elif word in "}]":
            builder.end()
        elif word[0] in "\"'":
            builder.scalar(line, "text", json5.loads(word))
        elif word[0] != "/":  # no comment
            builder.scalar(line, "empty" if word == "null" else "number", word)
    assert builder.top is not None, "json5 takes no text without a value"
    return builder.top
