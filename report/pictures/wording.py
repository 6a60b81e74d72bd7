"""Names from anybody's files -> text that is fit to be drawn: printable, of a bounded length, broken into lines."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

LONGEST_LINE = 28
MOST_LINES = 3
_PARTS = re.compile(r"/?[^/]*")


def broken(name: str, width: int = LONGEST_LINE) -> tuple[str, ...]:
    """Return a name as a few lines, broken before a ``/`` where there is one.

    >>> broken("/perception/object_recognition/tracking/objects")
    ('/perception', '/object_recognition/tracking', '/objects')
    """
    text = shortened(name, width * MOST_LINES)
    lines = [""]
    for part in _PARTS.findall(text):
        if len(lines[-1]) + len(part) <= width:
            lines[-1] += part
            continue
        lines.extend(_cut(part, width))
    full = [line for line in lines if line] or [""]
    if len(full) > MOST_LINES:
        full = [*full[: MOST_LINES - 2], "…", full[-1]]
    return tuple(full)


def _cut(part: str, width: int) -> Iterator[str]:
    """Cut a part of a name that is longer than a line, after a ``_`` where there is one."""
    while len(part) > width:
        at = part.rfind("_", width // 2, width) + 1 or width
        yield part[:at]
        part = part[at:]
    yield part


def listed(names: Iterable[str], limit: int = 3, longest: int = 60, words: Words = IN_ENGLISH) -> str:
    """Return some names, and how many more there are.

    >>> listed(["a", "b", "c", "d", "e"])
    'a, b, c and 2 more'
    """
    every = [shortened(name, longest) for name in names]
    more = words("terminal.more", n=len(every) - limit) if len(every) > limit else ""
    return ", ".join(every[:limit]) + more


def sentences(texts: Sequence[str]) -> str:
    """Join sentences."""
    return " ".join(text if text.endswith((".", "…")) else f"{text}." for text in texts)


def quoted(text: str) -> str:
    r"""Return a quoted string of DOT that shows text as it is: no escape sequence, no entity.

    >>> quoted('a"b' + chr(92) + "N&amp;")
    '"a\\"b\\\\N&amp;amp;"'
    """
    return '"' + printable(text).replace("\\", "\\\\").replace('"', '\\"').replace("&", "&amp;") + '"'
