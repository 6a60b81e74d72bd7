"""The label files of a fleet that a session edits: each that the fleet file leads to, and no other.

In: a fleet that was read; edits that name their file. Out: as of ``LabelFiles``.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError
from rosprivacy.explorer.edits import Edit, place_of
from rosprivacy.explorer.effects import differences, merged
from rosprivacy.explorer.fleet_labels import FleetLabels, read_fleet_labels
from rosprivacy.explorer.label_files import Merging
from rosprivacy.explorer.label_targets import Targets
from rosprivacy.explorer.own_file import read_own
from rosprivacy.explorer.saving import Conflict, Saved

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from typing import Any

    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question as Asked
    from rosprivacy.reading.fleet_system import FleetRead, FleetSystem
    from rosprivacy.reading.robot_reader import Tried


class FleetFiles:
    """The label files of a fleet; each is read again as a text when an answer first goes to it.

    Attributes
    ----------
    read
        The fleet, with the robots that are alike by what the files held last.
    targets
        The label files, with the robots that read them.
    """

    def __init__(
        self, read: FleetRead, asked: Asked, edited: Mapping[str, FleetLabels] = {}, digests: Mapping[str, str] = {}
    ) -> None:
        self.read, self._asked = read, asked
        self.targets = Targets(read.fleet)
        self._edited = dict(edited)  # those that were looked into, by the first of their names
        self._digests = dict(digests)  # of label files, as they were read
        self._said: dict[str, Mapping[tuple[str, str], Any]] = {}  # of others, that were asked for

    @property
    def name(self) -> str:
        """The fleet file."""
        return self.read.fleet.sources[0][0]

    @property
    def digest(self) -> str:
        """Of what all label files hold, as the session knows it."""
        known = {name: one.last[0] for one in self._edited.values() for name, _ in one.read if name in self._digests}
        held = sorted({**self._digests, **known}.items())
        return hashlib.sha256(repr(held).encode("utf-8", "surrogatepass")).hexdigest()

    @property
    def beside(self) -> list[tuple[str, str]]:
        """The other files that were read, with their hashes: all that no answer went to.

        Of files that are alike one was read, in the place of all.
        """
        edited = {name for one in self._edited.values() for name, _ in one.read}
        return [*self.read.fleet.sources, *(one for one in self._read_so() if one[0] not in edited)]

    def _read_so(self) -> set[tuple[str, str]]:
        """What robots are read from, also those for which others are read."""
        last = {name: one.last[0] for one in self._edited.values() for name, _ in one.read}
        read = {(file, digest) for file, digest in self.read.reader.read if file not in last} | set(last.items())
        known = dict(read)
        for group in self.read.groups:
            first = group.robots[0].files
            for robot in group.robots[1:]:
                alike = zip(robot.files, first, strict=True)
                read |= {(mine, known[its]) for mine, its in alike if mine not in known and its in known}
        return read

    def entries(self, edits: Sequence[Edit]) -> dict[tuple[str, str], Any]:
        """Return what those that were looked into say with edits: (section, file and name) -> entry."""
        return {
            (section, f"{file}: {name}"): value
            for file, labels in self._edited.items()
            for (section, name), value in labels.entries(_of(file, edits)).items()
        }

    def entry(self, of: Edit, edits: Sequence[Edit]) -> Edit:
        """Return the entry that one edit is about as it is with others."""
        labels = self._labels(of.file)
        entries = labels.entries(_of(labels.file, edits))
        place = place_of(of.section, of.name, entries)
        return Edit(*place, entries.get(place), labels.file)

    def _labels(self, file: str) -> FleetLabels:
        """A label file that the fleet file leads to, read when it is first asked for."""
        names = self.targets.called(file)
        if not names:
            what = "is no label file of the fleet"
            raise InputErrors([LabelError(file, 0, what, "name it in the fleet file")])
        first = names[0][0]
        if first not in self._edited:
            labels = read_fleet_labels(names, self._asked, self.read.fleet.root)
            if dict(self._read_so()).get(first, labels.own.digest) != labels.own.digest:
                what = "was changed since the fleet was read"
                raise InputErrors([LabelError(file, 0, what, "save what is said, and begin again")])
            self._edited[first] = labels
        return self._edited[first]

    def says(self, file: str, edits: Sequence[Edit]) -> dict[tuple[str, str], Any]:
        """Return what one of them says with edits: (section, name) -> entry; to know it, no text has to be kept."""
        first = self.targets.called(file)[0][0]
        if first in self._edited:
            return self._edited[first].entries(_of(first, edits))
        if first not in self._said:
            settings = replace(self._asked.settings, include_root=self.read.fleet.root)
            self._said[first] = read_own(file, self._asked.vocabulary, settings).says
        return dict(self._said[first])

    def differences(self, before: Sequence[Edit], after: Sequence[Edit]) -> list[Edit]:
        """Return the edits that make of the files with some edits those with others."""
        return [
            edit._replace(file=file)
            for file, labels in self._edited.items()
            for edit in differences(labels.entries(_of(file, before)), labels.entries(_of(file, after)))
        ]

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the files on the disk do not say, as the session knows them."""
        return [edit for file, labels in self._edited.items() for edit in labels.unsaved(_of(file, edits))]

    def system(self, edits: Sequence[Edit]) -> FleetSystem:
        """Return the fleet under the label files with edits."""
        system = self.read.under(*self._with(edits))
        for (name, _), there in self.read.reader.labels.items():
            self._digests.setdefault(name, there.sha256)
        return system

    def tried(
        self, edits: Sequence[Edit], robots: Collection[str], tried: Tried
    ) -> tuple[FleetSystem, list[InputError]]:
        """Return the fleet under them with edits, if something were otherwise on some robots; and what is missing."""
        return self.read.tried(*self._with(edits), robots, tried)

    def _with(self, edits: Sequence[Edit]) -> tuple[dict[tuple[str, bool], Labels], set[str]]:
        """What those that were looked into mean with edits, and the names of those that are not as on the disk."""
        labels = {}
        for file, one in self._edited.items():
            labels.update(one.labels(_of(file, edits)))
        other = [one for file, one in self._edited.items() if one.unsaved(_of(file, edits))]
        return labels, {name for one in other for name, _ in one.read}

    # --- the files ----------------------------------------------------------------------------------------------

    def save(self, edits: Sequence[Edit]) -> Saved | Conflict:
        """Write edits into their files; if one of them was changed by somebody else, nothing is written."""
        edited = {file: one for file, one in self._edited.items() if one.unsaved(_of(file, edits))}
        changed = _joint([one.changed_on_disk() for one in edited.values()])
        if changed:
            return changed
        saved: list[Saved] = []
        try:
            for file, one in edited.items():
                self._edited[file], done = one.saved(_of(file, edits), self._asked, self.read.fleet.root)
                if isinstance(done, Conflict):
                    return done
                saved.append(done)
        finally:
            if saved:
                self.read = self._compared_anew(edits)
        remarks = tuple(remark for one in saved for remark in one.remarks)
        names = ", ".join(one.file for one in saved)
        return Saved(names or "no label file", sum(one.lines for one in saved), "", remarks)

    def save_as(self, edits: Sequence[Edit], file: str) -> Saved:  # noqa: ARG002 - as of one file
        """Refuse: the label files of a fleet have names already.

        Raises
        ------
        InputError
            Always.
        """
        hint = "save() writes each where the fleet file names it"
        raise InputError(file, 0, "cannot take the labels of a fleet", hint)

    def changed_on_disk(self) -> Conflict | None:
        """Return how those that were looked into differ from what the session read or wrote."""
        return _joint([one.changed_on_disk() for one in self._edited.values()])

    def merged(self, edits: Sequence[Edit]) -> Merging:
        """Read those anew that somebody else changed, and hold edits against what they say now."""
        edited, kept, both = dict(self._edited), list(edits), list[Edit]()
        for file, one in self._edited.items():
            if one.changed_on_disk():
                now = read_fleet_labels(tuple(one.read), self._asked, self.read.fleet.root)
                found = merged(one.says, now.says, one.entries(_of(file, edits)))
                gone = {(file, edit.section, edit.name) for edit in found.theirs}
                kept = [edit for edit in kept if (edit.file, edit.section, edit.name) not in gone]
                both += [edit._replace(file=file) for edit in found.both]
                edited[file] = now
        there = FleetFiles(self._compared_anew(edits), self._asked, edited, self._digests)
        return Merging(there, kept, tuple(both))

    def ask(self, asked: Asked, edits: Sequence[Edit]) -> None:
        """Compare robots anew: those about which somebody decided are alike only to each other."""
        self.read = replace(self.read, question=asked)
        self.read = self._compared_anew(edits)

    def _compared_anew(self, edits: Sequence[Edit]) -> FleetRead:
        """The fleet with robots compared by what their files hold now; what was said or written here is known."""
        self.read.reader.relabel(self._with(edits)[0])  # another answer, or what was taken back, may have been last
        return self.read.again()


def _of(file: str, edits: Sequence[Edit]) -> list[Edit]:
    return [edit for edit in edits if edit.file == file]


def _joint(changed: Sequence[Conflict | None]) -> Conflict | None:
    there = [one for one in changed if one]
    return Conflict(", ".join(one.file for one in there), "".join(one.diff for one in there)) if there else None
