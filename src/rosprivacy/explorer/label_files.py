"""The label files that a session edits: here one, of a robot; those of a fleet are ``FleetFiles``.

In: policies, label files; edits, the last one last. Out: what the files say with edits, what follows from it, the files
written. What is wrong with a file or an edit is raised as ``InputErrors``; a file that cannot be written as
``InputError``, and then it is as it was.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.explorer.edited_file import EditedFile, chosen, read_file
from rosprivacy.explorer.edits import Edit, differences, place_of
from rosprivacy.explorer.scenarios import tried
from rosprivacy.explorer.watched_files import files_in
from rosprivacy.ingest.labels.label_file import LabelErrors, Labels
from rosprivacy.systems.robot_system import read_label_files, robot_system, with_misnamed

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.python_311 import Self
    from rosprivacy.explorer.edited_file import Conflict, SavedFile
    from rosprivacy.explorer.scenarios import WhatIf
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System

    Entries = dict[tuple[str, str], Any]  # (section, name) -> what the entry says

SHOWN_ONLY = (
    "what is in the database is shown, and not changed",
    "change the label file and load the robot again, or add roles in the database, and begin again",
)


class LabelTarget(NamedTuple):
    """A label file that an answer can go to.

    Attributes
    ----------
    file
        As the fleet file leads to it; empty where a session edits one file only.
    robots
        All that read it, by id.
    models
        Of these robots; none of those without a model.
    alone
        Whether it is a file of the robot itself, and not of its model.
    """

    file: str
    robots: tuple[str, ...] = ()
    models: tuple[str, ...] = ()
    alone: bool = True


class RobotFiles:
    """The label files of one robot; one is edited, others stay as they were read.

    Parameters
    ----------
    read
        The policies as they were read, under the label files as they were.
    at
        Which of the label files is edited.
    other_files
        The other files that were read, with their hashes: all that answers do not go to.
    refusal
        Why nothing can be changed, and what to do instead; empty where it can.
    """

    fleet = None
    outliers: frozenset[str] = frozenset()  # robots that are not read as most of their model are

    def __init__(
        self, read: System, question: Question, files: Sequence[Labels], edited: EditedFile, at: int = 0,
        other_files: Iterable[tuple[str, str]] = (), refusal: tuple[str, ...] = (),
    ) -> None:  # fmt: skip
        self.read, self.question, self.other_files, self.refusal = read, question, tuple(other_files), refusal
        self._files, self._edited, self._at = tuple(files), edited, at

    @classmethod
    def begin(cls, policies: Sequence[str], labels: Sequence[str | Labels], question: Question) -> Self:
        """Read policies and label files; the first of these that is a person's is edited. It need not be there yet."""
        where = chosen(labels)
        own = read_file(None if where is None else labels[where], question.vocabulary, question.settings)
        named = list(labels)
        if where is None:
            named.append(own.labels)
        else:
            named[where] = own.labels
        files = read_label_files(tuple(named), question.vocabulary, question.settings)
        at = next(i for i, file in enumerate(files) if file is own.labels)
        read = robot_system(tuple(policies), tuple(files), question)
        elsewhere = {(file.file, file.sha256) for file in named if isinstance(file, Labels)}  # edited, or from memory
        beside = (file for file in files_in(read.rests_on) if file not in elsewhere)
        return cls(read, question, files, EditedFile.of(own), at, beside)

    @classmethod
    def stored(cls, system: System, question: Question) -> Self:
        """Return what refuses each change: no file speaks of what is in a database.

        What people say there stands in its roles, which are more than the entries of a label file and can be written by
        several people at once; so they are changed there.
        """
        own = read_file(None, question.vocabulary, question.settings)
        return cls(system, question, (), EditedFile.of(own), refusal=SHOWN_ONLY)

    @property
    def name(self) -> str:
        """By which messages call it."""
        return self._edited.own.name

    @property
    def file(self) -> str:
        """As it was named; empty for labels that have no file yet."""
        return self._edited.own.file

    @property
    def digest(self) -> str:
        """Of what it holds, as the session knows it."""
        return self._edited.last[0]

    def targets(self, robot: str) -> tuple[LabelTarget, ...]:
        """Return the file for an answer about a robot; none where nothing can be changed."""
        return () if self.refusal else (LabelTarget("", (robot,)),)

    def answered(self, _edits: Sequence[Edit]) -> tuple[LabelTarget, ...]:
        """Return the file for answers."""
        return self.targets("")

    def entries(self, edits: Sequence[Edit]) -> Entries:
        """Return what it says with edits."""
        return self._edited.entries(edits)

    def says(self, _file: str, edits: Sequence[Edit]) -> Entries:
        """Return the same: there is one file."""
        return self.entries(edits)

    def entry(self, of: Edit, edits: Sequence[Edit]) -> Edit:
        """Return the entry that one edit is about as it is with others: where it stands, and what it says."""
        entries = self.entries(edits)
        place = place_of(of.section, of.name, entries)
        return Edit(*place, entries.get(place))

    def differences(self, before: Sequence[Edit], after: Sequence[Edit]) -> list[Edit]:
        """Return the edits that make of the file with some edits that with others."""
        return differences(self.entries(before), self.entries(after))

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the file on the disk does not say, as the session knows it."""
        return self._edited.unsaved(edits)

    def system(self, edits: Sequence[Edit]) -> System:
        """Return the same policies under the label files with edits."""
        files = list(self._files)
        try:
            (files[self._at],) = self._edited.labels(edits).values()
        except LabelErrors as error:
            raise with_misnamed(error, self.read.graph) from None
        assert self.read.under is not None, "of one robot"
        return self.read.under(tuple(files))

    def tried(
        self, now: System, question: Question, trial: WhatIf, _edits: Sequence[Edit]
    ) -> tuple[Result, tuple[str, ...]]:
        """Return the answer if something were so, and what to tell of it."""
        return tried(now, question, trial)

    def ask(self, question: Question, _edits: Sequence[Edit]) -> None:
        """Go on with another question."""
        self.question = question

    def save(self, edits: Sequence[Edit]) -> SavedFile | Conflict:
        """Write edits into it: only the lines that they are about, and only over what was read."""
        self._edited, done = self._edited.saved(edits, lambda: self._read(self.file))
        return done

    def save_as(self, edits: Sequence[Edit], file: str) -> SavedFile:
        """Write it with edits under another name, where there is none; labels that had no file have this one then."""
        self._edited, done = self._edited.saved_as(edits, file, lambda: self._read(file))
        return done

    def changed_on_disk(self) -> Conflict | None:
        """Return how it differs from what the session read or wrote; None if it does not."""
        return self._edited.changed_on_disk()

    def merged(self, edits: Sequence[Edit]) -> tuple[RobotFiles, list[Edit], tuple[Edit, ...]]:
        """Read it anew, and hold edits against what it says now, as ``EditedFile.merged``; this here stays as it is."""
        now = self._read(self.file)
        left, both = self._edited.merged(now, edits)
        return RobotFiles(self.read, self.question, self._files, now, self._at, self.other_files), left, both

    def _read(self, file: str) -> EditedFile:
        return EditedFile.of(read_file(file or None, self.question.vocabulary, self.question.settings))
