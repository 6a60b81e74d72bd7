"""The conversation of ``suggest --ask`` about the robot of a session: the same screens, order, ticks and label file.

In: a session, and one key after the other. Out: the screen in hand; the label file with each answer, written at once
as in the terminal, and the session with what the file says then. It knows nothing of the web.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError
from rosprivacy.labelling.answered_file import AnsweredFile
from rosprivacy.labelling.conversation import NO, UNDO
from rosprivacy.labelling.screen_conversation import ALL, BACK, ENTER, ScreenSteps
from rosprivacy.labelling.suggested_lines import who_says
from rosprivacy.labelling.suggesting import suggested_by

if TYPE_CHECKING:
    from rosprivacy.explorer.session import Session
    from rosprivacy.labelling.knowledge import KnownOfSystem
    from rosprivacy.labelling.screen_conversation import ScreenInHand
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.settings import Settings

WRITING = (ENTER, ALL, NO)  # keys that somebody answers by
KEYS = (*WRITING, BACK, UNDO)


class SuggestionScreens:
    """One conversation; it lasts as long as the session.

    Answers that are not saved wait for that: an answer here is written on what the file says, and would not know them.

    Attributes
    ----------
    file
        The label file that answers go into.
    remarks
        What became of the last key.
    turn
        Grows with every key: a key of who saw an earlier screen is told by it.
    """

    def __init__(self, session: Session, knowledge: KnownOfSystem, settings: Settings) -> None:
        self.file = Path(session.history.files.file)
        self.remarks: list[str] = []
        self.turn = 0
        self._session, self._knowledge = session, knowledge
        self._answered = answered = AnsweredFile(self.file, self._suggested, "", settings, self.remark)
        self._steps = ScreenSteps(
            answered.screens,
            answered.keep_lines,
            answered.refuse_lines,
            self,
            answered.typed,
            answered.undo,
            answered.rest,
        )
        self._version = session.version

    @staticmethod
    def fit(session: Session) -> bool:
        """Return whether there is such a conversation: about one robot, with a label file on the disk."""
        return not session.is_fleet and not session.is_stored and bool(session.history.files.file)

    @property
    def waits(self) -> bool:
        """Whether answers elsewhere have to be saved first."""
        return self._session.unsaved > 0

    @property
    def begun(self) -> bool:
        """Whether there is a screen to go back to."""
        return bool(self._steps.steps)

    @property
    def author(self) -> str:
        """Whose name answers bear if nobody says who answers; empty if the file names none."""
        with suppress(InputError):
            return who_says(str(self.file), None)
        return ""

    @property
    def rest(self) -> int:
        """How many elements are asked about elsewhere, and are on no screen."""
        return self._answered.rest()

    def look(self) -> ScreenInHand | None:
        """Return the screen in hand; nothing if none is left."""
        if self._session.version != self._version:
            self._steps.renew()
            self._version = self._session.version
        return self._steps.look()

    def tick(self, at: int) -> None:
        """Tick a line of the screen in hand, or untick it."""
        self._begin_turn()
        self._steps.tick(at)

    def press(self, key: str, by: str = "") -> bool:
        """Do what one of ``KEYS`` says; return whether the file is another one then.

        Parameters
        ----------
        by
            Who answers; by default the author of the file.

        Raises
        ------
        InputError
            If nobody is named who answers, or the file cannot be written.
        InputErrors
            If what the file says then contradicts itself: it can be taken back.
        """
        self._begin_turn()
        elsewhere = False
        if key in WRITING:
            self._answered.person = who_says(str(self.file), by, "answers")
            elsewhere = self._read()
        self._steps.press(key)
        if elsewhere:
            self._steps.renew()
        changed = self._read()
        self._version = self._session.version
        self._steps.look()
        return changed

    def remark(self, remark: str) -> None:
        """Hear what became of an answer."""
        self.remarks.append(remark)

    def _begin_turn(self) -> None:
        self.remarks.clear()
        self.turn += 1

    def _read(self) -> bool:
        """Have the session read the file if it is another one; return whether it is."""
        changed = self._session.changed_on_disk() is not None
        if changed:
            self._session.merge()
        return changed

    def _suggested(self) -> Suggested:
        return suggested_by(self._knowledge, self._session.uncounted)
