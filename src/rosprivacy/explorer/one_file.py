"""The label file of one robot that a session edits, among all that its policies are under.

In: policies that were read, label files, and which of them is edited. Out: as of ``LabelFiles``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.explorer.edits import Edit, place_of
from rosprivacy.explorer.effects import differences, merged
from rosprivacy.explorer.label_files import Merging
from rosprivacy.explorer.own_file import chosen, read_own
from rosprivacy.explorer.saving import Conflict, Saved, difference, digest_of, on_disk, save, save_as
from rosprivacy.explorer.watched_files import files_in
from rosprivacy.ingest.labels.label_file import Labels
from rosprivacy.reading.robot_system import read_label_files, robot_system

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from rosprivacy.explorer.own_file import OwnFile
    from rosprivacy.question import Question as Asked
    from rosprivacy.system import System


class OneFile:
    """A label file that is edited; others stay as they were read.

    Attributes
    ----------
    read
        The policies as they were read, under the label files as they were.
    own
        The label file that is edited, as it was read.
    beside
        The other files that were read, with their hashes.
    """

    def __init__(
        self, read: System, asked: Asked, files: Sequence[Labels], own: OwnFile, at: int = 0,
        beside: Collection[tuple[str, str]] = (),
    ) -> None:  # fmt: skip
        self.read, self.own, self.beside, self._asked = read, own, beside, asked
        self._files, self._at = tuple(files), at
        self._last = (own.digest, own.text or "")
        self._saved: tuple[dict[tuple[str, str], Any], Labels] | None = None  # what was written, and what it means

    @property
    def name(self) -> str:
        """By which messages call it."""
        return self.own.name

    @property
    def digest(self) -> str:
        """Of what it holds, as the session knows it."""
        return self._last[0]

    def entries(self, edits: Sequence[Edit]) -> dict[tuple[str, str], Any]:
        """Return what it says with edits: (section, name) -> entry."""
        return {**self.own.says, **{(edit.section, edit.name): edit.value for edit in edits}}

    def entry(self, of: Edit, edits: Sequence[Edit]) -> Edit:
        """Return the entry that one edit is about as it is with others."""
        entries = self.entries(edits)
        place = place_of(of.section, of.name, entries)
        return Edit(*place, entries.get(place))

    def differences(self, before: Sequence[Edit], after: Sequence[Edit]) -> list[Edit]:
        """Return the edits that make of the file with some edits that with others."""
        return differences(self.entries(before), self.entries(after))

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the file on the disk does not say, as the session knows it."""
        return differences(self._known, self.entries(edits))

    @property
    def _known(self) -> Any:
        return self._saved[0] if self._saved else self.own.says

    def system(self, edits: Sequence[Edit]) -> System:
        """Return the same policies under the label files with edits."""
        files = list(self._files)
        saved = self._saved and self.entries(edits) == self._saved[0]
        files[self._at] = self._saved[1] if self._saved and saved else self.own.with_edits(edits)
        assert self.read.under is not None, "of one robot"
        return self.read.under(tuple(files))

    # --- the file -----------------------------------------------------------------------------------------------

    def save(self, edits: Sequence[Edit]) -> Saved | Conflict:
        """Write edits into it: only the lines that they are about, and only over what was read."""
        done = save(self.own, edits, self._last)
        if isinstance(done, Saved):
            self._keep(done, edits)
        return done

    def save_as(self, edits: Sequence[Edit], file: str) -> Saved:
        """Write it with edits under another name, where there is none; labels that had no file have this one then."""
        done = save_as(self.own, edits, file)
        if not self.own.file:
            self.own = replace(self.own, file=file, how=self.own.how._replace(file=file))
            self._keep(done, edits)
        return done

    def _keep(self, done: Saved, edits: Sequence[Edit]) -> None:
        """Know what was written: what it means is read from there, so that lines and hash are those of the file."""
        there = read_own(self.own.file, self._asked.vocabulary, self._asked.settings)
        self._last = (there.digest, there.text or "")
        if there.digest != done.digest:  # somebody else was quicker
            self._last = (done.digest, "")
        self._saved = (self.entries(edits), there.labels)

    def changed_on_disk(self) -> Conflict | None:
        """Return how it differs from what the session read or wrote; None if it does not."""
        if not self.own.file:
            return None
        there = on_disk(self.own.file)
        if digest_of(there) == self._last[0]:  # also of a file that is not there yet
            return None
        diff = difference(self.own.file, self._last[1], there)
        return Conflict(self.own.file, diff) if diff else None

    def merged(self, edits: Sequence[Edit]) -> Merging:
        """Read it anew, and hold edits against what it says now."""
        own = read_own(self.own.file or None, self._asked.vocabulary, self._asked.settings)
        found = merged(self._known, own.says, self.entries(edits))
        gone = {(edit.section, edit.name) for edit in found.theirs}
        there = OneFile(self.read, self._asked, self._files, own, self._at, self.beside)
        return Merging(there, [edit for edit in edits if (edit.section, edit.name) not in gone], found.both)


def opened(policies: Sequence[str], labels: Sequence[str | Labels], asked: Asked) -> OneFile:
    """Read policies and label files; the first of these that is a person's is edited. It need not be there yet.

    Raises
    ------
    InputErrors
        With every problem of the input.
    """
    where = chosen(labels)
    own = read_own(None if where is None else labels[where], asked.vocabulary, asked.settings)
    named = list(labels)
    if where is None:
        named.append(own.labels)
    else:
        named[where] = own.labels
    files = read_label_files(tuple(named), asked.vocabulary, asked.settings)
    at = next(i for i, file in enumerate(files) if file is own.labels)
    read = robot_system(tuple(policies), tuple(files), asked)
    elsewhere = {(one.file, one.sha256) for one in named if isinstance(one, Labels)}  # the edited one, and from memory
    beside = [one for one in files_in(read.rests_on) if one not in elsewhere]
    return OneFile(read, asked, files, own, at, beside)
