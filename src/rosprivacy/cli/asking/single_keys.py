"""Single keys: how they are read of a terminal, or of a file of keys, in which blanks and line ends are none."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from collections.abc import Iterable

DIGITS, MOST_DIGITS, ENTER_KEYS = frozenset("0123456789"), 4, ("\r", "\n", "\r\n")
HELP = "?"
UNREADABLE = (EOFError, KeyboardInterrupt, OSError, ValueError)  # ValueError: bytes that are no text, or a closed file
LONGEST_ANSWER = 100_000  # signs of a line
ENDED = "\x03\x04"  # Ctrl-C and Ctrl-D, where the terminal gives them as keys


def say(lines: Iterable[str]) -> None:
    """Print lines."""
    for line in lines:
        typer.echo(line)


def at_terminal() -> bool:
    """Return whether keys come from a terminal."""
    return sys.stdin is not None and sys.stdin.isatty()


def number_of(first: str) -> str:
    """Return a number that Enter ends; nothing if the input ends before, and with the key that is none if there is one.

    Several signs may come at once.
    """
    number = first
    while key := read_key():
        if key in ENTER_KEYS:
            return number
        number += key
        if key not in DIGITS or len(number) > MOST_DIGITS:
            return number
    return ""


def rest_of_line() -> str:
    """Return what stands on a line of a file after its first sign; of an endless line its beginning."""
    rest = ""
    while (key := read_key()) and key not in ENTER_KEYS and len(rest) < LONGEST_ANSWER:
        rest += key
    return rest


def typed_line(begun: str) -> str:
    """Return a line that begins with what was typed so far; the terminal shows it while it is typed."""
    typer.echo(begun, nl=False)
    try:
        return begun + sys.stdin.readline(LONGEST_ANSWER).rstrip()
    except UNREADABLE:
        return begun


def pressed() -> str:
    """Return the next key; nothing if there is no more, or it cannot be read."""
    key = read_key()
    while key.isspace() and not at_terminal():
        key = read_key()
    return key


def read_key() -> str:
    """Return the next key or sign, a blank too."""
    if sys.stdin is None:
        return ""
    try:
        if at_terminal():
            key = typer.getchar()
            return "" if key in ENDED else key
        key = sys.stdin.read(1)
    except UNREADABLE:
        return ""
    return key
