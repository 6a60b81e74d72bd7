"""The screens of ``suggest --ask`` at a terminal: each is printed, and single keys answer it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.evidence import WrittenLabel
from rosprivacy.analysis.text import counted
from rosprivacy.cli.asking.single_keys import DIGITS, ENTER_KEYS, HELP, pressed, say, typed_line
from rosprivacy.labelling.conversation import BEGINS
from rosprivacy.labelling.screen_conversation import ENTER, ScreenConversation
from rosprivacy.report.suggested_labels.screen_lines import end_lines, keys_lines, screen_lines, why_lines

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.suggesting.screens import Screen
    from rosprivacy.labelling.answered_file import AnsweredFile


def screen_conversation(answered: AnsweredFile) -> ScreenConversation:
    """Return the conversation with a person at the terminal, whose answers go into a file."""
    return ScreenConversation(
        answered.screens,
        answered.keep_lines,
        answered.refuse_lines,
        _Viewer(answered.label_of),
        answered.typed,
        answered.undo,
        answered.rest,
    )


class _Viewer:
    """A person at a terminal.

    Parameters
    ----------
    label_of
        The label that a line says, or in words why it says none.
    """

    def __init__(self, label_of: Callable[[str], WrittenLabel | str]) -> None:
        self.label_of = label_of
        self._ahead: list[str] = []  # keys that came at once
        self._screens = 0

    def key(self, screen: Screen, ticks: frozenset[int], first: int) -> str | WrittenLabel:
        _, *lines = screen_lines(screen, ticks, first)
        say([f"-- {counted(self._screens, 'more screen')} so far" if self._screens else "", *lines])
        while True:
            say(keys_lines(screen))
            key = self._next()
            if key.startswith(BEGINS):
                label = self._label(typed_line(key))
                if label:
                    return label
            elif key == HELP:
                say(why_lines(screen, first))
            else:
                return key

    def screens_ahead(self, number: int) -> None:
        self._screens = number

    def end(self, rest: int) -> str:
        say(["", *end_lines(rest)])
        return self._next()

    def remark(self, remark: str) -> None:
        typer.echo(remark)

    def _next(self) -> str:
        """The next key; several that come at once, as over a slow line, one after the other."""
        typer.echo("> ", nl=False)
        if not self._ahead:
            key = pressed()
            several = key not in ENTER_KEYS and DIGITS.issuperset(key.rstrip("\r\n"))
            self._ahead = list(key.replace("\r\n", "\r")) if several and key else [key]
        key = self._ahead.pop(0)
        if not key.startswith(BEGINS):
            typer.echo("" if key in ENTER_KEYS else shown(key))
        return ENTER if key in ENTER_KEYS else key

    def _label(self, line: str) -> WrittenLabel | None:
        label = self.label_of(f"/{line.lstrip('/')}" if line.startswith("//") else line)
        if isinstance(label, WrittenLabel):
            return label
        typer.echo(f"{shown(line)!r} is no answer here: {label}")
        return None
