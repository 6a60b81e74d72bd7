"""The history of a session: edits one after another, the answer that follows from them, and the files they go to.

In: label files, edits. Out: a ``Result`` after each edit; a journal of what is not saved; the files, saved. The state
is a function of what was read and of the edits; undo takes the last edit away.
"""

from __future__ import annotations

from contextlib import contextmanager
from threading import RLock
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.answering import answer
from rosprivacy.explorer.edits import copied
from rosprivacy.explorer.effects import Change, compared
from rosprivacy.explorer.journal import Journal
from rosprivacy.explorer.watched_files import WatchedFiles, files_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from rosprivacy.explorer.edited_file import Conflict, SavedFile
    from rosprivacy.explorer.edits import Edit
    from rosprivacy.explorer.fleet_files import FleetFiles
    from rosprivacy.explorer.journal import Unsaved
    from rosprivacy.explorer.label_files import RobotFiles
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System

    LabelFiles = RobotFiles | FleetFiles

OF_QUESTION = ("ontologies", "type_limits", "decisions")  # files that the answer rests on, whatever system it is about


class _Answered(NamedTuple):
    """A system, and what follows: without the number of paths, and, once somebody asked, whole."""

    system: System
    uncounted: Result
    whole: Result | None = None


class History:
    """Edits of label files with undo, redo, journal and saving, and the answer after each.

    Every method may be called from several threads.

    Attributes
    ----------
    version
        Grows with every change of the state.
    """

    def __init__(self, files: LabelFiles, system: System, question: Question) -> None:
        self.lock = RLock()
        self.files, self.question = files, question
        self.version = 0
        self._edits_made: list[Edit] = []
        self._undone: list[Edit] = []
        self._now = _Answered(system, answer(system, question, count_paths=False))
        self._last: tuple[str, _Answered] | None = None  # edits, as text, before the last edit, undo or redo
        self._journal = Journal()
        self._watched = WatchedFiles()
        self._watched.changed(self._other_files())

    def remember(self, folder: Path, named_files: tuple[str, ...], *, resume: bool) -> None:
        """Begin a journal; make the edits again that a session before left, if that is wanted and still the same."""
        self._journal = Journal.begin(folder, self.files.file, self.files.digest, named_files, self.system)
        offered = self._journal.offered
        if resume and offered and not offered.changed:
            self.resume()

    # --- what is so now -----------------------------------------------------------------------------------------

    @property
    def system(self) -> System:
        """The system of now, under the label files with the edits."""
        return self._now.system

    @property
    def uncounted(self) -> Result:
        """The answer of now, but for how many paths of a finding share no flow: what each edit shows at once."""
        return self._now.uncounted

    @property
    def result(self) -> Result:
        """The whole answer of now; of each version it is made once, when somebody asks.

        Until edits are saved, the label file has a name and a hash that say so, and a new entry is told with a line
        below the last one.
        """
        with self.lock:
            if self._now.whole is None:
                uncounted = self._now.uncounted
                whole = uncounted if uncounted.options.count_paths else answer(self._now.system, self.question)
                self._now = self._now._replace(whole=whole)
            assert self._now.whole is not None
            return self._now.whole

    @property
    def edits(self) -> tuple[Edit, ...]:
        """What was done and not undone, the last one last."""
        return tuple(self._edits_made)

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to take back."""
        return bool(self._edits_made)

    @property
    def can_redo(self) -> bool:
        """Whether an edit was taken back, and none was made since."""
        return bool(self._undone)

    @property
    def unsaved(self) -> int:
        """How many entries say something else than the file on the disk, as this session knows it."""
        return len(self.files.unsaved(self._edits_made))

    @property
    def unsaved_from_before(self) -> Unsaved | None:
        """What a session left that ended before it was saved, the newest first; None if there is nothing."""
        return self._journal.offered

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a person has to know of the session itself, the newest last."""
        if self.files.refusal:
            problem, hint = self.files.refusal
            return (f"{problem[0].upper()}{problem[1:]}: {hint}.",)
        return tuple(self._journal.remarks)

    @property
    def entries(self) -> dict[tuple[str, str], Any]:
        """What the label file says with the edits: (section, name) -> entry; of a fleet with the file in the name."""
        return self.files.entries(self._edits_made)

    # --- edits --------------------------------------------------------------------------------------------------

    def do(self, edit: Edit) -> Change:
        """Make an edit that is whole already, such as one that was written down; errors as of ``label``."""
        with self.lock:
            self.check_that_it_changes(edit.name)
            before = self.uncounted
            edit = self.files.entry(edit, self._edits_made)._replace(value=copied(edit.value))
            self._go([*self._edits_made, edit], [])
            return Change(edit, self.version, *compared(before, self.uncounted))

    def undo(self) -> bool:
        """Take the last edit back; return whether there was one.

        Raises
        ------
        InputErrors
            If the label file, merged meanwhile, does not allow it; nothing is changed then.
        """
        with self.lock:
            if self._edits_made:
                self._go(self._edits_made[:-1], [*self._undone, self._edits_made[-1]])
                return True
            return False

    def redo(self) -> bool:
        """Make the edit again that was taken back last; return whether there was one; errors as of ``undo``."""
        with self.lock:
            if self._undone:
                self._go([*self._edits_made, self._undone[-1]], self._undone[:-1])
                return True
            return False

    def _go(self, edits: list[Edit], undone: list[Edit]) -> None:
        """Be where these edits are made and those are taken back."""
        changed = self.files.differences(self._edits_made, edits)
        here = repr(self._edits_made), self._now  # as text: 1 is no True there, nor a list what it becomes later
        if self._last is not None and self._last[0] == repr(edits):  # as undo has it, and redo after it
            self._now = self._last[1]
        else:
            self._analyse(edits)
        self._edits_made, self._undone, self._last = edits, undone, here
        self.version += 1
        self._journal.note(changed, self.files.unsaved(edits))

    def _analyse(self, edits: Sequence[Edit]) -> None:
        """Have the answer after edits; if they are wrong, that of before is kept."""
        system = self.files.system(edits)
        self._now = _Answered(system, answer(system, self.question, count_paths=False, before=self.uncounted))
        self._last = None

    def check_that_it_changes(self, place: str, *, file: bool = False) -> None:
        """Refuse where nothing can be changed: an edit, or a file to be written."""
        if self.files.refusal:
            error = InputError(place, 0, *self.files.refusal)
            raise error if file else InputErrors([error])

    # --- what a session before left -----------------------------------------------------------------------------

    def resume(self) -> tuple[str, ...]:
        """Make the edits again that a session before left; each can be undone.

        Returns
        -------
        tuple of str
            Why some cannot be made: these stay offered.
        """
        with self.lock:
            offered = self._journal.offered
            refused: list[Edit] = []
            why: list[str] = []
            for edit in offered.edits if offered else ():
                try:
                    if self.files.entry(edit, self._edits_made).value != edit.value:
                        self.do(edit)
                except InputErrors as error:
                    refused.append(edit)
                    why += map(str, error.errors)
            self._journal.settle(refused)
            return tuple(why)

    def forget(self) -> None:
        """Throw away what a session before left."""
        with self.lock:
            self._journal.settle()

    def close(self) -> None:
        """Let go of the journal; what is not saved stays in it."""
        self._journal.close()

    # --- the files ----------------------------------------------------------------------------------------------

    def save(self) -> SavedFile | Conflict:
        """Write the edits into the label file: only the lines that they are about, and only over what was read.

        Returns
        -------
        SavedFile or Conflict
            The latter if the file, or one of several, was changed by somebody else: then nothing is written; see
            ``merge``.

        Raises
        ------
        InputError
            If it cannot be written, or there is no file; nothing is lost then.
        """
        with self.lock:
            self.check_that_it_changes(self.files.name, file=True)
            known = self.files.digest
            try:
                return self.files.save(self._edits_made)
            finally:
                self._go_on_with_written(known)

    def save_as(self, file: str) -> SavedFile:
        """Write the label file with the edits under another name, where there is none; the session goes on with it.

        Raises
        ------
        InputError
            If it cannot be written, or there is a file of that name; and always of a fleet.
        """
        with self.lock:
            self.check_that_it_changes(file, file=True)
            known = self.files.digest
            try:
                return self.files.save_as(self._edits_made, file)
            finally:
                self._go_on_with_written(known)

    def _go_on_with_written(self, digest: str) -> None:
        """Go on with what was written, also where one of several files could not be."""
        unsaved = self.files.unsaved(self._edits_made)
        # an edit and its undoing write nothing, and are saved all the same: the answer is that of the file then
        if self.files.digest != digest or not unsaved:
            self._journal.begin_anew(self.files.digest, unsaved)
            self._analyse(self._edits_made)
            self.version += 1

    def changed_on_disk(self) -> Conflict | None:
        """Return how the label file differs from what this session read or wrote; None if it does not."""
        with self.lock:
            return self.files.changed_on_disk()

    @property
    def changed_inputs(self) -> tuple[str, ...]:
        """The other files that the answer rests on (rule S12) and that are not what was read; gone is changed, too.

        The answer stays one about what was read. Label files that answers went to are told by ``changed_on_disk``.
        """
        with self.lock:
            return self._watched.changed(self._other_files())

    def _other_files(self) -> list[tuple[str, str]]:
        """The files that the answer rests on and that answers do not go to, with their hashes."""
        assumed = {key: self.uncounted.assumptions.get(key) for key in OF_QUESTION}
        return [*self.files.other_files, *files_in(assumed)]

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
        with self.lock:
            self.check_that_it_changes(self.files.name, file=True)
            before = self.files
            self.files, edits, both = before.merged(self._edits_made)
            try:
                self._analyse(edits)
            except BaseException:
                self.files = before
                raise
            self._edits_made = edits
            self.version += 1
            self._journal.begin_anew(self.files.digest, self.files.unsaved(self._edits_made))
            return both

    # --- another question ---------------------------------------------------------------------------------------

    def ask(self, question: Question) -> None:
        """Have the answer to another question, such as one with other decisions."""
        self._ask(question)
        self._analyse(self._edits_made)

    def _ask(self, question: Question) -> None:
        self.question = question
        self.files.ask(question, self._edits_made)

    @contextmanager
    def undone_if_it_fails(self) -> Iterator[None]:
        """Go back to the question and the answer of before, if something fails; else it is a new version."""
        question, now = self.question, self._now
        try:
            yield
        except BaseException:
            if question is not self.question:
                self._ask(question)
            self._now = now
            raise
        self.version += 1
