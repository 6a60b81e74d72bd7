"""Longer texts made fit to be shown: one line, nothing unprintable, not endless. Names are for ``errors.shown``."""

from __future__ import annotations

LONGEST = 2_000


def one_line(text: str, most: int = LONGEST) -> str:
    """Return text in one line; what cannot be printed is a space, and what is too long is cut.

    >>> one_line("a" + chr(10) + "b" + chr(0x202E) + "c", 4)
    'a b …'
    """
    line = "".join(character if character.isprintable() else " " for character in text[: most + 1])
    return line if len(line) <= most else f"{line[:most]}…"
