r"""Values -> JSON for files and terminals: the one place where JSON is written for users (rule S14).

In: what JSON can say. Out: text that is the same for the same value and ends with a newline. What cannot be printed
(C1 control signs, signs that turn the direction of writing, U+2028, half characters of a file name that is no UTF-8)
is written as ``\uXXXX``: the value stays, and a terminal or an editor shows what is there.
"""

from __future__ import annotations

import json
import re
from typing import Any

_ODD = re.compile(r"[^\x20-\x7e\n]")


def as_text(value: Any) -> str:
    r"""Return a value as JSON.

    >>> print(as_text({"name": "/é" + chr(0x9B) + chr(0x202E)}), end="")
    {
      "name": "/é\u009b\u202e"
    }
    """
    text = json.dumps(value, indent=2, ensure_ascii=False)
    return _ODD.sub(_escaped, text) + "\n"


def _escaped(match: re.Match[str]) -> str:
    return match[0] if match[0].isprintable() else json.dumps(match[0])[1:-1]
