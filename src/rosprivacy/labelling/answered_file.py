"""The label file that answers about suggestions go into: each is written at once, and can be taken back.

In: answers of a person at a terminal, or on the explorer's page. Out: the file; what of it is to be told.
"""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.files_read import one_run
from rosprivacy.clock import today
from rosprivacy.labelling.asking import (
    asked_now,
    closing,
    contradiction,
    off_screens,
    screens_now,
    typed_label,
    with_answer,
    with_label,
    with_lines,
    with_refusal,
)
from rosprivacy.labelling.suggested_lines import brings, limits_on_the_way, text_of
from rosprivacy.report.atomic import editing, write_texts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from rosprivacy.analysis.suggesting.evidence import WrittenLabel
    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion, Row
    from rosprivacy.analysis.suggesting.screens import Screen, ScreenLine
    from rosprivacy.labelling.label_lines import LabelLines
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.settings import Settings

CHANGED = "somebody has changed the file since: nothing is taken back"


class AnsweredFile:
    """A label file, and what is suggested under what it says.

    Parameters
    ----------
    progress
        What is suggested under the labels as they are.
    person
        The person who answers.
    tell
        Hears what labels take away of newly accepted data.
    """

    def __init__(
        self,
        file: Path,
        progress: Callable[[], Suggested],
        person: str,
        settings: Settings,
        tell: Callable[[str], None],
    ) -> None:
        self.file, self.person, self.settings, self._progress, self._tell = file, person, settings, progress, tell
        self._last: Suggested | None = None
        self._brought: list[WrittenLabel] = []  # since the last look
        self._changes: list[tuple[str, str]] = []  # the text of the file before each, and after it

    @property
    def last(self) -> Suggested:
        """What was suggested when somebody looked last."""
        return self._last or self.look()

    def look(self) -> Suggested:
        """Return what is suggested now; what labels take away of newly accepted data is told."""
        before, self._last = self._last, self._progress()
        if before and self._brought:
            for line in limits_on_the_way(before.result, self._last.result):
                self._tell(line)
        self._brought.clear()
        return self._last

    def questions(self) -> tuple[LabelQuestion, ...]:
        """Return what is asked now."""
        return asked_now(self.look())

    def screens(self) -> tuple[Screen, ...]:
        """Return the screens that there are now."""
        return screens_now(self.look())

    def rest(self) -> int:
        """Return how many elements are asked about, and are on no screen."""
        return off_screens(self.last)

    def closing(self, rows: Sequence[Row]) -> Sequence[Row]:
        """Return the channels that would close a finding."""
        return closing(rows, self.last.result)

    def label_of(self, line: str) -> WrittenLabel | str:
        """Return the label that a line says, or in words why it says none."""
        result = self.last.result
        label = typed_label(line, result.analysis.graph.elements, result.vocabulary)
        return label if isinstance(label, str) else contradiction(label, result) or label

    def keep(self, question: LabelQuestion, key: str) -> tuple[str, ...]:
        """Write an answer to a question; return remarks."""
        labels = (reply.label for row in question.rows if (reply := row.reply(key)))
        answered = partial(with_answer, str(self.file), question, key, self.person, settings=self.settings)
        return self._write(answered, labels)

    def keep_lines(self, lines: Sequence[ScreenLine]) -> tuple[str, ...]:
        """Write the lines of a screen that are ticked; return remarks."""
        labels = (reply.label for line in lines for reply in line.replies)
        return self._write(lambda day: with_lines(str(self.file), lines, self.person, day, self.settings), labels)

    def refuse_lines(self, lines: Sequence[ScreenLine]) -> tuple[str, ...]:
        """Write a no to the lines of a screen; return remarks."""
        refused = [label for line in lines for label in line.refused]
        return self._write(lambda day: with_refusal(str(self.file), refused, self.person, day, self.settings), ())

    def typed(self, label: WrittenLabel) -> tuple[str, ...]:
        """Write a label that was typed; return remarks."""
        return self._write(lambda day: with_label(str(self.file), label, self.person, day, self.settings), [label])

    def undo(self, number: int) -> str:
        """Take the last changes back; return why not, or nothing."""
        with one_run(), editing(self.file):
            if text_of(str(self.file)) != self._changes[-1][1]:
                return CHANGED
            write_texts([(self.file, self._changes[-number][0])], edited=self.file)
        del self._changes[-number:]
        return ""

    def _write(self, answered: Callable[[str], LabelLines], labels: Iterable[WrittenLabel]) -> tuple[str, ...]:
        with one_run(), editing(self.file):  # of its own: the file was read before, and is ours
            before = text_of(str(self.file))
            written = answered(today(os.environ))
            self._changes.append((before, written.text if written.added else before))
            if written.added:
                write_texts([(self.file, written.text)], edited=self.file)
                self._brought.extend(brings(labels))
        return written.remarks
