r"""Values -> JSON for files and terminals: the one place where JSON is written for users (rule S14).

In: what JSON can say. Out: text that is the same for the same value and ends with a newline. What cannot be printed
(C1 control signs, signs that turn the direction of writing, U+2028, half characters of a file name that is no UTF-8)
is written as ``\uXXXX``: the value stays, and a terminal or an editor shows what is there.
"""

from __future__ import annotations

import json
import re
from itertools import islice
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

PIECE = 10_000  # tokens of JSON, some 100 kB
_ODD = re.compile(r"[^\x20-\x7e\n]")


def as_text(value: Any) -> str:
    r"""Return a value as JSON.

    >>> print(as_text({"name": "/é" + chr(0x9B) + chr(0x202E)}), end="")
    {
      "name": "/é\u009b\u202e"
    }
    """
    return "".join(in_pieces(value))


def in_pieces(value: Any) -> Iterator[str]:
    """Yield the same text piece by piece: of a large document it need not be in memory as a whole.

    >>> "".join(in_pieces([1, {}])) == as_text([1, {}])
    True
    """
    tokens = json.JSONEncoder(indent=2, ensure_ascii=False).iterencode(value)
    while piece := "".join(islice(tokens, PIECE)):
        yield _ODD.sub(_escaped, piece)
    yield "\n"


def _escaped(match: re.Match[str]) -> str:
    return match[0] if match[0].isprintable() else json.dumps(match[0])[1:-1]
