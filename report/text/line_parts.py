"""Lines of a terminal: what parts of them look alike everywhere, and how they are broken at its width.

In: lines, and how wide the terminal is. Out: lines. In a file or a pipe nothing is broken, so that programs find it.
"""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style
MARGIN = 4  # of what goes on, beyond the line's own
NARROWEST = 40


def wrapped(lines: Iterable[Line], width: int | None) -> Iterator[Line]:
    """Return the lines broken at a width; a name that is longer than it stays whole.

    >>> list(wrapped([("   a channel that is not reviewed by anybody at all", "")], 40))
    [('   a channel that is not reviewed by', ''), ('       anybody at all', '')]
    """
    for text, style in lines:
        if width is None or len(text) <= max(width, NARROWEST):
            yield text, style
            continue
        indent = len(text) - len(text.lstrip()) + MARGIN
        broken = wrap(
            text,
            max(width, NARROWEST),
            subsequent_indent=" " * indent,
            break_long_words=False,
            break_on_hyphens=False,
        )
        yield from ((part, style) for part in broken)


def titled(title: str, rows: Iterable[Line]) -> Iterator[Line]:
    """Yield a part of the report: an empty line, its title, its lines."""
    yield "", ""
    yield title, "bold"
    yield from rows


def place(row: Mapping[str, Any]) -> str:
    """Return a line of a file.

    >>> place({"file": "l.yaml", "line": 3})
    'l.yaml:3'
    """
    return f"{shown(row['file'])}:{row['line']}"


def listed(texts: Sequence[str], limit: int | None, words: Words, separator: str = ", ") -> str:
    """Return the first of some texts, and how many more ``-v`` shows; all if ``limit`` is None."""
    left_out = len(texts) - limit if limit is not None else 0
    return separator.join(texts[:limit]) + (words("terminal.more.verbose", n=left_out) if left_out > 0 else "")
