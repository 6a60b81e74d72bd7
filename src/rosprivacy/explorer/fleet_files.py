"""The label files of a fleet that a session edits: each that the fleet file leads to, and no other (rule S10).

In: a fleet that was read; edits that name their file. Out: as of ``RobotFiles``; to which of the files an answer goes,
and about how many robots it then is.
"""

from __future__ import annotations

import hashlib
import os
from collections import defaultdict
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError
from rosprivacy.explorer.edited_file import Conflict, EditedFile, SavedFile, chosen, read_file
from rosprivacy.explorer.edits import Edit, differences, place_of
from rosprivacy.explorer.label_files import LabelTarget
from rosprivacy.explorer.scenarios import tried_on_robots
from rosprivacy.ingest.fleet.dds_domains import pseudo_robot
from rosprivacy.ingest.labels.label_file import OURS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from typing import NoReturn

    from rosprivacy.explorer.edited_file import FileText
    from rosprivacy.explorer.label_files import Entries
    from rosprivacy.explorer.scenarios import WhatIf
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.system import System
    from rosprivacy.systems.fleet_system import FleetRead, FleetSystem


class Targets:
    """The label files of a fleet, with the robots that read them."""

    def __init__(self, fleet: Fleet) -> None:
        self._robots = {robot.id: robot for robot in (*fleet.robots, *fleet.infrastructure)}
        self._readers: dict[str, dict[str, Robot]] = defaultdict(dict)
        self._names: dict[str, set[tuple[str, bool]]] = defaultdict(set)
        self._chosen: dict[tuple[str, ...], int | None] = {}
        for robot in self._robots.values():
            for files, alone in ((robot.labels, False), (robot.own, True)):
                for file in (file for file in files if not file.startswith(OURS)):
                    self._readers[os.path.realpath(file)][robot.id] = robot
                    self._names[os.path.realpath(file)].add((file, alone))

    def names_of(self, file: str) -> tuple[tuple[str, bool], ...]:
        """Return by which names the fleet file leads to a label file, and whether as one of a robot."""
        return tuple(sorted(self._names.get(os.path.realpath(file), ())))

    def readers(self, file: str) -> tuple[str, ...]:
        """Return the robots that read a label file, by id."""
        return tuple(self._readers.get(os.path.realpath(file), ()))

    def of(self, robot: str) -> tuple[LabelTarget, ...]:
        """Return the files for an element of a robot: that of its model, and its own; none where neither has one.

        For a domain these are the files of the robots in it; what the fleet file itself states has none.
        """
        targets: dict[str, LabelTarget] = {}
        for reader in self._robot_names(robot):
            for files, alone in ((reader.labels, False), (reader.own, True)):
                if files not in self._chosen:
                    self._chosen[files] = chosen(files)  # which looks into them
                at = self._chosen[files]
                if at is not None:
                    targets.setdefault(os.path.realpath(files[at]), self._target(files[at], alone=alone))
        return tuple(sorted(targets.values(), key=lambda target: target.alone))

    def _robot_names(self, robot: str) -> Iterable[Robot]:
        if robot in self._robots:
            return (self._robots[robot],)
        return (each for each in self._robots.values() if each.domain and pseudo_robot(each.domain) == robot)

    def _target(self, file: str, *, alone: bool) -> LabelTarget:
        readers = self._readers[os.path.realpath(file)]
        models = dict.fromkeys(robot.model for robot in readers.values() if robot.model)
        return LabelTarget(file, tuple(readers), tuple(models), alone)


class FleetFiles:
    """The label files of a fleet; each is read again as a text when an answer first goes to it.

    Attributes
    ----------
    read
        The fleet, with the robots that are alike by what the files held last.
    """

    refusal: tuple[str, ...] = ()

    def __init__(
        self,
        read: FleetRead,
        question: Question,
        edited: Mapping[str, EditedFile] = {},
        digests: Mapping[str, str] = {},
    ) -> None:
        self.read, self.question = read, question
        self._targets = Targets(read.fleet)
        self._edited = dict(edited)  # those that were looked into, by the first of their names
        self._digests = dict(digests)  # of label files, as they were read
        self._unedited: dict[str, Entries] = {}  # what others say, that were asked for

    @property
    def fleet(self) -> Fleet:
        """As it was read."""
        return self.read.fleet

    @property
    def name(self) -> str:
        """The fleet file."""
        return self.fleet.sources[0][0]

    @property
    def file(self) -> str:
        """The fleet file: what a journal is about."""
        return self.name

    @property
    def digest(self) -> str:
        """Of what all label files hold, as the session knows it."""
        known = {name: digest for name, digest in self._last().items() if name in self._digests}
        held = sorted({**self._digests, **known}.items())
        return hashlib.sha256(repr(held).encode("utf-8", "surrogatepass")).hexdigest()

    def _last(self) -> dict[str, str]:
        """Digests of those that were looked into, by each of their names."""
        return {name: file.last[0] for file in self._edited.values() for name, _ in file.readings}

    @property
    def other_files(self) -> Iterable[tuple[str, str]]:
        """The other files that were read, with their hashes: all that no answer went to.

        Of files that are alike one was read, in the place of all.
        """
        edited = self._last()
        return [*self.fleet.sources, *(file for file in self._contents() if file[0] not in edited)]

    def _contents(self) -> set[tuple[str, str]]:
        """What robots are read from, also those for which others are read."""
        last = self._last()
        read = {(file, digest) for file, digest in self.read.reader.read if file not in last} | set(last.items())
        known = dict(read)
        for group in self.read.groups:
            first = group.robots[0].files
            for robot in group.robots[1:]:
                alike = zip(robot.files, first, strict=True)
                read |= {(mine, known[its]) for mine, its in alike if mine not in known and its in known}
        return read

    @property
    def outliers(self) -> frozenset[str]:
        """The robots that are not read as most robots of their model are: other policies, labels, or flows."""
        of_model: Mapping[str, list[Alike]] = defaultdict(list)
        for group in self.read.groups:
            if group.robots[0].model and not group.fixed:
                of_model[group.robots[0].model].append(group)
        usual = [max(groups, key=lambda group: len(group.robots)) for groups in of_model.values()]
        others = (group for groups in of_model.values() for group in groups if group not in usual)
        return frozenset(robot.id for group in others for robot in group.robots)

    # --- what they say ------------------------------------------------------------------------------------------

    def targets(self, robot: str) -> tuple[LabelTarget, ...]:
        """Return the files that an answer about a robot can go to: that of its model before its own."""
        return self._targets.of(robot)

    def answered(self, edits: Sequence[Edit]) -> tuple[LabelTarget, ...]:
        """Return all files for answers; of robots that are alike, those of the first one and those with edits."""
        robots = [group.robots[0].id for group in self.read.groups]
        robots += [robot for edit in edits for robot in self._targets.readers(edit.file)]
        targets = {target.file: target for robot in dict.fromkeys(robots) for target in self._targets.of(robot)}
        return tuple(targets.values())

    def entries(self, edits: Sequence[Edit]) -> Entries:
        """Return what those that were looked into say with edits; the file stands in the name."""
        return {
            (section, f"{name}: {entry}"): value
            for name, file in self._edited.items()
            for (section, entry), value in file.entries(_of(name, edits)).items()
        }

    def says(self, file: str, edits: Sequence[Edit]) -> Entries:
        """Return what one of them says with edits; to know it, no text has to be kept."""
        name = self._targets.names_of(file)[0][0]
        if name in self._edited:
            return self._edited[name].entries(_of(name, edits))
        if name not in self._unedited:
            self._unedited[name] = dict(self._text(file).says)
        return dict(self._unedited[name])

    def entry(self, of: Edit, edits: Sequence[Edit]) -> Edit:
        """Return the entry that one edit is about as it is with others: where it stands, and what it says."""
        names = self._targets.names_of(of.file)
        if not names:
            _refuse(of.file, "is no label file of the fleet", "name it in the fleet file")
        name = names[0][0]
        if name not in self._edited:
            file = self._read(names)
            if dict(self._contents()).get(name, file.own.digest) != file.own.digest:
                _refuse(of.file, "was changed since the fleet was read", "save what is said, and begin again")
            self._edited[name] = file
        entries = self._edited[name].entries(_of(name, edits))
        place = place_of(of.section, of.name, entries)
        return Edit(*place, entries.get(place), name)

    def _read(self, names: Iterable[tuple[str, bool]]) -> EditedFile:
        """A file by all its names, for every way in which robots read it; ranked as new text is."""
        readings = {(name, alone): self._text(name, alone=alone) for name, alone in names}
        name = next(iter(readings))[0]
        return EditedFile.of(readings.get((name, False)) or self._text(name), readings)

    def _text(self, name: str, *, alone: bool = False) -> FileText:
        settings = replace(self.question.settings, include_root=self.fleet.root)
        return read_file(name, self.question.vocabulary, settings, alone=alone)

    def differences(self, before: Sequence[Edit], after: Sequence[Edit]) -> list[Edit]:
        """Return the edits that make of the files with some edits those with others."""
        return [
            edit._replace(file=name)
            for name, file in self._edited.items()
            for edit in differences(file.entries(_of(name, before)), file.entries(_of(name, after)))
        ]

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the files on the disk do not say, as the session knows them."""
        return [
            edit._replace(file=name) for name, file in self._edited.items() for edit in file.unsaved(_of(name, edits))
        ]

    # --- what follows from it -----------------------------------------------------------------------------------

    def system(self, edits: Sequence[Edit]) -> FleetSystem:
        """Return the fleet under the label files with edits."""
        system = self.read.under(*self._meanings(edits))
        for (name, _), labels in self.read.reader.labels.items():
            self._digests.setdefault(name, labels.sha256)
        return system

    def tried(
        self, now: System, question: Question, trial: WhatIf, edits: Sequence[Edit]
    ) -> tuple[Result, tuple[str, ...]]:
        """Return the answer if something were so on some robots, and what to tell of it."""
        return tried_on_robots(now, partial(self.read.tried, *self._meanings(edits)), question, trial)

    def _meanings(self, edits: Sequence[Edit]) -> tuple[dict[tuple[str, bool], Labels], set[str]]:
        """What those that were looked into mean with edits, and the names of those that are not as on the disk."""
        labels: dict[tuple[str, bool], Labels] = {}
        for name, file in self._edited.items():
            labels.update(file.labels(_of(name, edits)))
        changed = [file for name, file in self._edited.items() if file.unsaved(_of(name, edits))]
        return labels, {name for file in changed for name, _ in file.readings}

    def ask(self, question: Question, edits: Sequence[Edit]) -> None:
        """Go on with another question: robots about which somebody decided are alike only to each other."""
        self.read = replace(self.read, question=question)
        self.read = self._compared_anew(edits)

    def _compared_anew(self, edits: Sequence[Edit]) -> FleetRead:
        """The fleet with robots compared by what their files hold now; what was said or written here is known."""
        self.read.reader.relabel(self._meanings(edits)[0])  # another answer, or what was taken back, may have been last
        return self.read.read_again()

    # --- the files ----------------------------------------------------------------------------------------------

    def save(self, edits: Sequence[Edit]) -> SavedFile | Conflict:
        """Write edits into their files; if one of them was changed by somebody else, nothing is written."""
        edited = {name: file for name, file in self._edited.items() if file.unsaved(_of(name, edits))}
        changed = _joint(file.changed_on_disk() for file in edited.values())
        if changed:
            return changed
        saved: list[SavedFile] = []
        try:
            for name, file in edited.items():
                self._edited[name], done = file.saved(_of(name, edits), partial(self._read, file.readings))
                if isinstance(done, Conflict):
                    return done
                saved.append(done)
        finally:
            if saved:
                self.read = self._compared_anew(edits)
        remarks = tuple(remark for done in saved for remark in done.remarks)
        names = ", ".join(done.file for done in saved)
        return SavedFile(names or "no label file", sum(done.lines for done in saved), "", remarks)

    def save_as(self, _edits: Sequence[Edit], file: str) -> SavedFile:
        """Refuse: the label files of a fleet have names already."""
        hint = "save() writes each where the fleet file names it"
        raise InputError(file, 0, "cannot take the labels of a fleet", hint)

    def changed_on_disk(self) -> Conflict | None:
        """Return how those that were looked into differ from what the session read or wrote."""
        return _joint(file.changed_on_disk() for file in self._edited.values())

    def merged(self, edits: Sequence[Edit]) -> tuple[FleetFiles, list[Edit], tuple[Edit, ...]]:
        """Read those anew that somebody else changed, and hold edits against what they say now."""
        edited, left, both = dict(self._edited), list(edits), list[Edit]()
        for name, file in self._edited.items():
            if file.changed_on_disk():
                edited[name] = self._read(file.readings)
                stay, theirs = file.merged(edited[name], _of(name, edits))
                left = [edit for edit in left if edit.file != name or edit in stay]
                both += [edit._replace(file=name) for edit in theirs]
        return FleetFiles(self._compared_anew(edits), self.question, edited, self._digests), left, tuple(both)


def _of(file: str, edits: Sequence[Edit]) -> list[Edit]:
    return [edit for edit in edits if edit.file == file]


def _joint(changed: Iterable[Conflict | None]) -> Conflict | None:
    conflicts = [conflict for conflict in changed if conflict]
    if not conflicts:
        return None
    return Conflict(", ".join(each.file for each in conflicts), "".join(each.diff for each in conflicts))


def _refuse(file: str, problem: str, hint: str) -> NoReturn:
    raise InputErrors([LabelError(file, 0, problem, hint)])
