"""The conversation of ``suggest --ask``: questions are printed, keys are read, and each answer is written at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.evidence import WrittenLabel
from rosprivacy.analysis.suggesting.label_questions import LISTED, TYPED_AS
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import listed
from rosprivacy.cli.asking.screen_dialogue import screen_conversation
from rosprivacy.cli.asking.single_keys import (
    DIGITS,
    HELP,
    at_terminal,
    number_of,
    pressed,
    rest_of_line,
    say,
    typed_line,
)
from rosprivacy.labelling.answered_file import AnsweredFile
from rosprivacy.labelling.asking import unanswered_sources, without_channels
from rosprivacy.labelling.conversation import AND, BEGINS, QUIT, Conversation, allowed, keys_of, lines_of, takes_away
from rosprivacy.labelling.screen_conversation import LISTS
from rosprivacy.labelling.suggested_lines import who_says
from rosprivacy.report.suggested_labels.question_lines import help_lines, keys_line, question_lines
from rosprivacy.report.suggested_labels.trial_lines import ALL_OF_A_ROBOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.settings import Settings

OUT_OF_STEP = "the keys are out of step with the questions, and no more are read"
BY_LINE = "takes data away; where no terminal is, a line says it, and no more keys are read"


def ask(file: Path, progress: Callable[[], Suggested], by: str | None, settings: Settings) -> None:
    """Ask until nothing is left to ask, or the person stops: at a terminal a screen for each element, then lists.

    Raises
    ------
    InputErrors
        With every problem of the input; what was answered before is kept.
    """
    answered = AnsweredFile(file, progress, who_says(str(file), by, "answers"), settings, typer.echo)
    answers, end = 0, LISTS
    if at_terminal():
        screens = screen_conversation(answered)
        end, answers = screens.run(), screens.answers
        end = end if end or screens.steps else LISTS  # no element had a screen
    if end == LISTS:
        person, now, keep = _Terminal(answered.label_of), answered.questions, answered.keep
        lists = Conversation(now, keep, person, answered.closing, answered.typed, answered.undo)
        end = "" if lists.run() else QUIT
        answers += lists.answers
    suggestions = answered.look() if end else answered.last
    analysis = suggestions.result.analysis
    then = "the same command goes on from here" if end else "nothing is left to ask"
    typer.echo(f"{counted(answers, 'answer')} in {file}; {then}")
    if nodes := unanswered_sources(suggestions):
        typer.echo(f"not in this answer: data that perhaps comes from {listed(nodes, ALL_OF_A_ROBOT)}")
    if nodes := without_channels(suggestions.result):
        typer.echo(f"not asked about, since no channel of their own is known: {listed(nodes, ALL_OF_A_ROBOT)}")
    typer.echo(f"{analysis.verdict}; {counted(len(analysis.open), 'open element')} ('rosprivacy analyze' tells all)")


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
            say(question_lines(question))
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
            say(help_lines(question, allowed(question, picked)))

    def _next(self, question: LabelQuestion, picked: frozenset[int]) -> str | WrittenLabel | None:
        """The next key, or a label typed as a line; nothing if there is no more, None for what is neither."""
        if self.next:
            return self.next.pop(0)
        key = pressed()
        if key.startswith(BEGINS):
            return self._line(typed_line(key) if at_terminal() else key + rest_of_line(), question, picked)
        if not at_terminal():
            return self._piped(key, question, picked)
        number = key.rstrip("\r\n")  # a slow line gives a number and Enter at once
        if question.about != LISTED or not number or not DIGITS.issuperset(number):
            return key
        return number if number != key else number_of(key)

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
