"""The conversation of ``suggest --ask``: questions are printed, keys are read, and each answer is written at once."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.analysis.suggesting.evidence import WrittenLabel
from rosprivacy.analysis.suggesting.label_questions import LISTED, TYPED_AS
from rosprivacy.analysis.text import counted
from rosprivacy.cli.output import emit
from rosprivacy.clock import today
from rosprivacy.labelling.asking import asked_now, closing, contradiction, typed_label, with_answer, with_label
from rosprivacy.labelling.conversation import AND, BEGINS, Conversation, allowed, keys_of, lines_of, takes_away
from rosprivacy.labelling.suggested_lines import brings, limits_on_the_way, text_of, who_says
from rosprivacy.report.atomic import editing
from rosprivacy.report.suggested_labels.question_lines import help_lines, keys_line, question_lines

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion
    from rosprivacy.labelling.label_lines import LabelLines
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.settings import Settings

DIGITS, MOST_DIGITS, ENTER = frozenset("0123456789"), 4, ("\r", "\n", "\r\n")
HELP = "?"
UNREADABLE = (EOFError, KeyboardInterrupt, OSError, ValueError)  # ValueError: bytes that are no text, or a closed file
LONGEST_ANSWER = 100_000  # signs of a line
ENDED = "\x03\x04"  # Ctrl-C and Ctrl-D, where the terminal gives them as keys
OUT_OF_STEP = "the keys are out of step with the questions, and no more are read"
BY_LINE = "takes data away; where no terminal is, a line says it, and no more keys are read"


def ask(file: Path, progress: Callable[[], Suggested], by: str | None, settings: Settings) -> None:
    """Ask until nothing is left to ask, or the person stops.

    Raises
    ------
    InputErrors
        With every problem of the input; what was answered before is kept.
    """
    who = who_says(str(file), by, "answers")
    last: list[Suggested] = []

    def label_of(line: str) -> WrittenLabel | str:
        result = last[0].result
        label = typed_label(line, result.analysis.graph.elements, result.vocabulary)
        return label if isinstance(label, str) else contradiction(label, result) or label

    person = _Terminal(label_of)
    brought: list[WrittenLabel] = []  # since the questions were made

    def ask_again() -> None:
        before, last[:] = tuple(last), [progress()]
        if before and brought:
            for line in limits_on_the_way(before[0].result, last[0].result):
                person.remark(line)
        brought.clear()

    def now() -> tuple[LabelQuestion, ...]:
        ask_again()
        return asked_now(last[0])

    changes: list[tuple[str, str]] = []  # the text of the file before each, and after it

    def write(answered: Callable[[str], LabelLines], labels: Iterable[WrittenLabel]) -> tuple[str, ...]:
        with one_run(), editing(file):  # of its own: the file was read before, and is ours
            before = text_of(str(file))
            written = answered(today(os.environ))
            changes.append((before, written.text if written.added else before))
            if written.added:
                emit(written.text, file, edited=file)
                brought.extend(brings(labels))
        return written.remarks

    def keep(question: LabelQuestion, key: str) -> tuple[str, ...]:
        labels = (reply.label for row in question.rows if (reply := row.reply(key)))
        return write(lambda day: with_answer(str(file), question, key, who, day, settings), labels)

    def typed(label: WrittenLabel) -> tuple[str, ...]:
        return write(lambda day: with_label(str(file), label, who, day, settings), [label])

    def undo(number: int) -> str:
        with one_run(), editing(file):
            if text_of(str(file)) != changes[-1][1]:
                return "somebody has changed the file since: nothing is taken back"
            emit(changes[-number][0], file, edited=file)
        del changes[-number:]
        return ""

    conversation = Conversation(now, keep, person, lambda rows: closing(rows, last[0].result), typed, undo)
    whole = conversation.run()
    if not whole:
        ask_again()
    verdict, left = last[0].result.analysis.verdict, len(last[0].result.analysis.open)
    end = "nothing is left to ask" if whole else "the same command goes on from here"
    typer.echo(f"{counted(conversation.answers, 'answer')} in {file}; {end}")
    typer.echo(f"{verdict}; {counted(left, 'open element')} ('rosprivacy analyze' tells all)")


class _Terminal:
    """A person at a terminal; or a file of keys, in which blanks and line ends are none.

    A file of keys may have been made for other questions. So there no single key takes data away, nor a number: a line
    does, which names the element.

    Parameters
    ----------
    label_of
        The label that a line says, or in words why it says none.
    """

    def __init__(self, label_of: Callable[[str], WrittenLabel | str]) -> None:
        self.label_of = label_of
        self.last: LabelQuestion | None = None
        self.next: list[str] = []  # the rest of what a line comes to

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str | WrittenLabel:
        if question != self.last:
            _say(question_lines(question))
        self.last = question
        while True:
            typer.echo(keys_line(question, picked, allowed(question, picked)))
            typer.echo("> ", nl=False)
            key = self._next(question, picked)
            if key is None:
                continue
            if isinstance(key, WrittenLabel):
                return key
            typer.echo(shown(key))
            if key != HELP:
                return key
            _say(help_lines(question, allowed(question, picked)))

    def _next(self, question: LabelQuestion, picked: frozenset[int]) -> str | WrittenLabel | None:
        """The next key, or a label typed as a line; nothing if there is no more, None for what is neither."""
        if self.next:
            return self.next.pop(0)
        key = _pressed()
        if key.startswith(BEGINS):
            return self._line(_typed_line(key) if at_terminal() else key + _rest_of_line(), question, picked)
        if not at_terminal():
            return self._piped(key, question, picked)
        number = key.rstrip("\r\n")  # a slow line gives a number and Enter at once
        if question.about != LISTED or not number or not DIGITS.issuperset(number):
            return key
        return number if number != key else _number(key)

    def _line(self, line: str, question: LabelQuestion, picked: frozenset[int]) -> str | WrittenLabel | None:
        """The keys that a line comes to, if the question offers what it says; or the label that it is."""
        self.next = list(keys_of(line, question, picked))
        if self.next:
            return self.next.pop(0)
        label = self.label_of(line)
        if isinstance(label, WrittenLabel):
            if not at_terminal():  # which has shown it already
                typer.echo(shown(line))
            return label
        if at_terminal():
            typer.echo(f"{shown(line)!r} is no answer here: {label}")
            return None
        typer.echo(f"{shown(line)!r} is no answer here: {'' if label == TYPED_AS else f'{label}; '}{OUT_OF_STEP}")
        return ""

    def remark(self, remark: str) -> None:
        typer.echo(remark)

    def _piped(self, key: str, question: LabelQuestion, picked: frozenset[int]) -> str:
        """What a key of a file says; nothing if no more may be read."""
        whole = question.about == LISTED
        if key not in DIGITS or (key in (can := allowed(question, picked)) and not takes_away(question, key)):
            return key
        rows = tuple(row for at, row in enumerate(question.rows) if (at in picked) is not whole or not picked)
        lines = lines_of(question._replace(rows=rows), key) if whole or key in can else ()
        said = AND.join(lines) if whole else " or ".join(lines)
        problem = f"{BY_LINE}: {shown(said)}" if lines else f"is no answer here: {OUT_OF_STEP}"
        typer.echo(f"{key!r} {problem}")
        return ""


def _say(lines: Iterable[str]) -> None:
    for line in lines:
        typer.echo(line)


def at_terminal() -> bool:
    """Return whether keys come from a terminal."""
    return sys.stdin is not None and sys.stdin.isatty()


def _number(first: str) -> str:
    """A number that Enter ends; nothing if the input ends before, and with the key that is none if there is one.

    Several signs may come at once.
    """
    number = first
    while key := _read():
        if key in ENTER:
            return number
        number += key
        if key not in DIGITS or len(number) > MOST_DIGITS:
            return number
    return ""


def _rest_of_line() -> str:
    """What stands on a line of a file after its first sign; of an endless line its beginning."""
    rest = ""
    while (key := _read()) and key not in ENTER and len(rest) < LONGEST_ANSWER:
        rest += key
    return rest


def _typed_line(begun: str) -> str:
    """A line that begins with what was typed so far; the terminal shows it while it is typed."""
    typer.echo(begun, nl=False)
    try:
        return begun + sys.stdin.readline(LONGEST_ANSWER).rstrip()
    except UNREADABLE:
        return begun


def _pressed() -> str:
    """The next key; nothing if there is no more, or it cannot be read."""
    key = _read()
    while key.isspace() and not at_terminal():
        key = _read()
    return key


def _read() -> str:
    """The next key or sign, a blank too."""
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
