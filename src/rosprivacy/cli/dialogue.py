"""The conversation of ``suggest --ask``: questions are printed, keys are read, and each answer is written at once."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.analysis.suggesting.question_rows import NOTHING_THROUGH
from rosprivacy.analysis.text import counted
from rosprivacy.cli.output import emit
from rosprivacy.clock import today
from rosprivacy.labelling.asking import asked_now, with_answer
from rosprivacy.labelling.conversation import Conversation, allowed
from rosprivacy.labelling.suggested_lines import who_says
from rosprivacy.report.editing import editing
from rosprivacy.report.suggest.question_lines import keys_line, question_lines

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.analysis.suggesting.question_rows import Question
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.settings import Settings

DIGITS, MOST_DIGITS, ENTER = frozenset("0123456789"), 4, ("\r", "\n", "\r\n")
ENDED = "\x03\x04"  # Ctrl-C and Ctrl-D, where the terminal gives them as keys
# A file of keys was made for other questions, and the digits of a number for a list may take data away elsewhere.
OUT_OF_STEP = "the keys are out of step with the questions, and no more are read"


def ask(file: Path, told: Callable[[], Suggested], by: str | None, settings: Settings) -> None:
    """Ask until nothing is left to ask, or the person stops.

    Raises
    ------
    InputErrors
        With every problem of the input; what was answered before is kept.
    """
    who = who_says(str(file), by, "answers")
    last: list[Suggested] = []

    def now() -> tuple[Question, ...]:
        last[:] = [told()]
        return asked_now(last[0])

    def keep(question: Question, key: str) -> tuple[str, ...]:
        with one_run(), editing(file):  # of its own: the file was read before, and is ours
            written = with_answer(str(file), question, key, who, today(os.environ), settings)
            if written.added:
                emit(written.text, file, edited=file)
        return written.remarks

    conversation = Conversation(now, keep, _Terminal())
    whole = conversation.run()
    if not whole:
        last[:] = [told()]
    verdict, left = last[0].result.analysis.verdict, len(last[0].result.analysis.open)
    end = "nothing is left to ask" if whole else "the same command goes on from here"
    typer.echo(f"{counted(conversation.answers, 'answer')} in {file}; {end}")
    typer.echo(f"{verdict}; {counted(left, 'open element')} ('rosprivacy analyze' tells all)")


class _Terminal:
    """A person at a terminal; or a file of keys, in which blanks and line ends are none."""

    def __init__(self) -> None:
        self.last: Question | None = None

    def key(self, question: Question, picked: frozenset[int]) -> str:
        if question != self.last:
            for line in question_lines(question):
                typer.echo(line)
        self.last = question
        typer.echo(keys_line(question, picked, allowed(question, picked)))
        typer.echo("> ", nl=False)
        key = _pressed()
        if question.about == NOTHING_THROUGH and key in DIGITS:
            key = _number(key)
        elif key in DIGITS and key not in allowed(question, picked) and not sys.stdin.isatty():
            typer.echo(f"{key!r} is no answer here: {OUT_OF_STEP}")
            return ""
        typer.echo(shown(key))
        return key

    def told(self, remark: str) -> None:
        typer.echo(remark)


def _number(first: str) -> str:
    """A number that Enter ends; nothing if the input ends before, and with the key that is none if there is one."""
    number = first
    while key := _read():
        if key in ENTER:
            return number
        number += key
        if key not in DIGITS or len(number) > MOST_DIGITS:
            return number
    return ""


def _pressed() -> str:
    """The next key; nothing if there is no more, or it cannot be read."""
    key = _read()
    while key.isspace() and not sys.stdin.isatty():
        key = _read()
    return key


def _read() -> str:
    """The next key or sign, a blank too."""
    if sys.stdin is None:
        return ""
    try:
        if sys.stdin.isatty():
            key = typer.getchar()
            return "" if key in ENDED else key
        key = sys.stdin.read(1)
    except (EOFError, KeyboardInterrupt, OSError, ValueError):  # ValueError: bytes that are no text, or a closed file
        return ""
    return key
