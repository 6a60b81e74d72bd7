"""The history of a session: edits one after another, the answer that follows from them, and the files they go to.

In: label files, edits. Out: a ``Result`` after each edit; a journal of what is not saved; the files, saved. The state
is a function of what was read and of the edits; undo takes the last edit away.
"""

from __future__ import annotations

from threading import RLock
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.answering import answer
from rosprivacy.explorer.edits import copied
from rosprivacy.explorer.effects import Change, compared
from rosprivacy.explorer.remembering import Remembering, remembering
from rosprivacy.explorer.watched_files import WatchedFiles, files_in

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rosprivacy.analysis.answer import Verdict
    from rosprivacy.explorer.edits import Edit
    from rosprivacy.explorer.label_files import LabelFiles
    from rosprivacy.explorer.remembering import Unsaved
    from rosprivacy.explorer.saving import Conflict, Saved
    from rosprivacy.outputs import Findings
    from rosprivacy.question import Question as Asked
    from rosprivacy.result import Result
    from rosprivacy.system import System

OF_QUESTION = ("ontologies", "type_limits", "decisions")  # files that the answer rests on, whatever system it is about


class _State(NamedTuple):
    """Where a session was: the edits that were made, and what followed from them."""

    said: str  # the edits, as text: 1 is no True there, nor a list what it becomes later
    system: System
    uncounted: Result
    whole: Result | None


class History:
    """Edits of label files with undo, redo, journal and saving, and the answer after each; as of any session.

    Every method may be called from several threads.

    Attributes
    ----------
    version
        Grows with every change of the state.
    uncounted
        The answer of now, but for how many paths of a finding share no flow: what each edit shows at once.
    """

    def __init__(self, files: LabelFiles, system: System, asked: Asked) -> None:
        self._lock = RLock()
        self._files, self._system, self._asked = files, system, asked
        self._done: list[Edit] = []
        self._undone: list[Edit] = []
        self._remembers = Remembering()
        self._watched = WatchedFiles()
        self.version = 0
        self.uncounted = answer(system, asked, count_paths=False)
        self._whole: Result | None = None
        self._last: _State | None = None  # before the last edit, undo or redo
        self._watched.changed(self._others())

    def _remember(self, folder: Path, file: str, named: tuple[str, ...], *, resume: bool) -> None:
        """Begin a journal; make the edits again that a session before left, if that is wanted and still the same."""
        self._remembers = remembering(folder, file, self._files.digest, named, self._system)
        offered = self.unsaved_from_before
        if resume and offered and not offered.changed:
            self.resume()

    # --- what is so now -----------------------------------------------------------------------------------------

    @property
    def result(self) -> Result:
        """The whole answer of now; of each version it is made once, when somebody asks.

        Until edits are saved, the label file has a name and a hash that say so, and a new entry is told with a line
        below the last one.
        """
        with self._lock:
            if self._whole is None:
                counted = self.uncounted.options.count_paths
                self._whole = self.uncounted if counted else answer(self._system, self._asked)
            return self._whole

    @property
    def findings(self) -> Findings:
        """The findings of now."""
        return self.result.findings

    @property
    def verdict(self) -> Verdict:
        """The verdict of now (rule S12)."""
        return self.uncounted.analysis.verdict

    @property
    def edits(self) -> tuple[Edit, ...]:
        """What was done and not undone, the last one last."""
        return tuple(self._done)

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to take back."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """Whether an edit was taken back, and none was made since."""
        return bool(self._undone)

    @property
    def unsaved(self) -> int:
        """How many entries say something else than the file on the disk, as this session knows it."""
        return len(self._files.unsaved(self._done))

    @property
    def unsaved_from_before(self) -> Unsaved | None:
        """What a session left that ended before it was saved, the newest first; None if there is nothing."""
        return self._remembers.offered

    @property
    def other_sessions(self) -> int:
        """How many other sessions edit the same label file now."""
        return self._remembers.others

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a person has to know of the session itself, the newest last."""
        return self._remembers.remarks

    @property
    def entries(self) -> dict[tuple[str, str], Any]:
        """What the label file says with the edits: (section, name) -> entry; of a fleet with the file in the name."""
        return self._files.entries(self._done)

    # --- edits --------------------------------------------------------------------------------------------------

    def do(self, edit: Edit) -> Change:
        """Make an edit that is whole already, such as one that was written down.

        Raises
        ------
        InputErrors
            As ``Session.label``.
        """
        with self._lock:
            before = self.uncounted
            edit = self._files.entry(edit, self._done)._replace(value=copied(edit.value))
            self._go([*self._done, edit], [])
            return Change(edit, self.version, *compared(before, self.uncounted))

    def undo(self) -> bool:
        """Take the last edit back; return whether there was one.

        Raises
        ------
        InputErrors
            If the label file, merged meanwhile, does not allow it; nothing is changed then.
        """
        with self._lock:
            if not self._done:
                return False
            self._go(self._done[:-1], [*self._undone, self._done[-1]])
            return True

    def redo(self) -> bool:
        """Make the edit again that was taken back last; return whether there was one.

        Raises
        ------
        InputErrors
            As ``undo``.
        """
        with self._lock:
            if not self._undone:
                return False
            self._go([*self._done, self._undone[-1]], self._undone[:-1])
            return True

    def _go(self, done: list[Edit], undone: list[Edit]) -> None:
        """Be where these edits are made and those are taken back."""
        said = self._files.differences(self._done, done)
        here, last = _State(repr(self._done), self._system, self.uncounted, self._whole), self._last
        if last is not None and last.said == repr(done):  # as undo has it, and redo after it
            _, self._system, self.uncounted, self._whole = last
        else:
            self._analyse(done)
        self._done, self._undone, self._last = done, undone, here
        self.version += 1
        self._remembers.note(said, self._files.unsaved(done))

    def _analyse(self, edits: Sequence[Edit]) -> None:
        """Have the answer after edits; if they are wrong, that of before is kept."""
        system = self._files.system(edits)
        uncounted = answer(system, self._asked, count_paths=False, before=self.uncounted)
        self._system, self.uncounted, self._whole, self._last = system, uncounted, None, None

    # --- what a session before left -----------------------------------------------------------------------------

    def resume(self) -> tuple[str, ...]:
        """Make the edits again that a session before left; each can be undone.

        Returns
        -------
        tuple of str
            Why some cannot be made: these stay offered.
        """
        with self._lock:
            offered = self._remembers.offered
            if offered is None:
                return ()
            refused: list[Edit] = []
            why: list[str] = []
            for edit in offered.edits:
                try:
                    if self._files.entry(edit, self._done).value != edit.value:
                        self.do(edit)
                except InputErrors as error:
                    refused.append(edit)
                    why += map(str, error.errors)
            self._remembers.settle(refused)
            return tuple(why)

    def forget(self) -> None:
        """Throw away what a session before left."""
        with self._lock:
            self._remembers.settle()

    def close(self) -> None:
        """Let go of the journal; what is not saved stays in it."""
        self._remembers.close()

    # --- the files ----------------------------------------------------------------------------------------------

    def save(self) -> Saved | Conflict:
        """Write the edits into the label file: only the lines that they are about, and only over what was read.

        Returns
        -------
        Saved or Conflict
            The latter if the file, or one of several, was changed by somebody else: then nothing is written; see
            ``merge``.

        Raises
        ------
        InputError
            If it cannot be written, or there is no file; nothing is lost then.
        """
        with self._lock:
            known = self._files.digest
            try:
                return self._files.save(self._done)
            finally:
                self._written(known)

    def save_as(self, file: str) -> Saved:
        """Write the label file with the edits under another name, where there is none; the session goes on with it.

        Raises
        ------
        InputError
            If it cannot be written, or there is a file of that name; and always of a fleet.
        """
        with self._lock:
            known = self._files.digest
            try:
                return self._files.save_as(self._done, file)
            finally:
                self._written(known)

    def _written(self, known: str) -> None:
        """Go on with what was written, also where one of several files could not be."""
        # an edit and its undoing write nothing, and are saved all the same: the answer is that of the file then
        if self._files.digest != known or not self._files.unsaved(self._done):
            self._remembers.begin_anew(self._files.digest, self._files.unsaved(self._done))
            self._analyse(self._done)
            self.version += 1

    def changed_on_disk(self) -> Conflict | None:
        """Return how the label file differs from what this session read or wrote; None if it does not."""
        with self._lock:
            return self._files.changed_on_disk()

    @property
    def changed_inputs(self) -> tuple[str, ...]:
        """The other files that the answer rests on (rule S12) and that are not what was read; gone is changed, too.

        The answer stays one about what was read. Label files that answers went to are told by ``changed_on_disk``.
        """
        with self._lock:
            return self._watched.changed(self._others())

    def _others(self) -> list[tuple[str, str]]:
        """The files that the answer rests on and that answers do not go to, with their hashes."""
        asked = {key: self.uncounted.assumptions.get(key) for key in OF_QUESTION}
        return [*self._files.beside, *files_in(asked)]

    def merge(self) -> tuple[Edit, ...]:
        """Read the label file anew, and make the edits again on what it says now.

        Returns
        -------
        tuple of Edit
            What the file now says of elements of which this session says something else that is not saved: what is said
            here stands. What was saved here before gives way to what somebody else says.

        Raises
        ------
        InputErrors
            If it cannot be read, or the edits contradict it; nothing is changed then.
        """
        with self._lock:
            before, found = self._files, self._files.merged(self._done)
            self._files = found.files
            try:
                self._analyse(found.edits)
            except BaseException:
                self._files = before
                raise
            self._done = found.edits
            self.version += 1
            self._remembers.begin_anew(self._files.digest, self._files.unsaved(self._done))
            return found.both
