"""Lines -> lines that fit a terminal: broken between words, what goes on is set in.

In: lines, and how wide the terminal is. Out: lines. In a file or a pipe nothing is broken, so that programs find it.
"""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

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
