"""A session with a fleet: robots that are alike stand as one, and an answer goes to a model's label file or a robot's.

In: a fleet file, settings; then edits. Out: as of ``Session``. Every label file that the fleet file leads to can be
edited, and no other.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import FleetError, InputError, InputErrors, LabelError, shown
from rosprivacy.explorer.edits import Edit, entry_of, place_of, section_of
from rosprivacy.explorer.effects import Change, compared, merged
from rosprivacy.explorer.fleet_labels import FleetLabels, read_fleet_labels
from rosprivacy.explorer.label_targets import Target, Targets, outliers
from rosprivacy.explorer.own_file import read_own
from rosprivacy.explorer.remembering import remembering
from rosprivacy.explorer.saving import Conflict, Saved
from rosprivacy.explorer.session import Session
from rosprivacy.question import question_of
from rosprivacy.reading.fleet_system import read_once
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path
    from typing import Any, Unpack

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.questions import Question
    from rosprivacy.explorer.scenarios import Scenario, WhatIf
    from rosprivacy.question import Question as Asked
    from rosprivacy.reading.fleet_system import FleetRead
    from rosprivacy.system import System


class FleetSession(Session):
    """Labelling a fleet; made by ``FleetSession.open_fleet``. Elements are named with a robot: ``carrier_01:/blur``.

    Attributes
    ----------
    targets
        The label files, with the robots that read them.
    """

    of_one_robot = False

    def __init__(self, read: FleetRead, asked: Asked) -> None:
        self._read = read
        self._edited: dict[str, FleetLabels] = {}  # those that were looked into, by the first of their names
        self._digests: dict[str, str] = {}  # of label files, as they were read
        self.targets = Targets(read.fleet)
        super().__init__(read.system(), asked, (), read_own(None, asked.vocabulary, asked.settings), 0)
        self._note_digests()

    @classmethod
    def open_fleet(
        cls, file: str, settings: Settings | None = None, *, journal: Path | None = None, resume: bool = False
    ) -> FleetSession:
        """Read a fleet file and what it names, once; parameters and errors as of ``Session.open``.

        Examples
        --------
        >>> session = FleetSession.open_fleet("examples/fleet/fleet.yaml")
        >>> change = session.label("carrier_01:/blur", conduit=True)
        >>> session.target("carrier_01").models, len(session.target("carrier_01").robots)
        (('carrier',), 24)
        """
        asked = question_of(settings or Settings())
        session = cls(read_once(file, asked), asked)
        if journal is not None:
            session._remembers = remembering(journal, file, session._digest(), (file,), session._system)
            offered = session.unsaved_from_before
            if resume and offered and not offered.changed:
                session.resume()
        return session

    # --- robots -------------------------------------------------------------------------------------------------

    def answer_for(self, element: Element, label: Label | None, *, only_this_robot: bool = False) -> Change:
        """Label an element, or take its label away; see ``label`` and ``unlabel``."""
        section, name = self.called(element)
        if label is None:
            return self.unlabel(name, kind=section, only_this_robot=only_this_robot)
        return self.label(name, kind=section, only_this_robot=only_this_robot, **label)

    def targets_of(self, element: Element) -> tuple[Target, ...]:
        """Return the label files that an answer can go to: that of the model, and the robot's own."""
        return self.targets.of(element.robot)

    def stands_for(self, robot: str) -> tuple[str, ...]:
        """Return the robots that are alike to one, itself first; none for what is shared."""
        likeness = self._system.likeness
        return likeness.members.get(likeness.second.get(robot, robot), ())

    @property
    def outliers(self) -> frozenset[str]:
        """Robots that are not read as most robots of their model are."""
        return outliers(self._read.groups)

    def questions(self) -> tuple[Question, ...]:
        """Return what is left to decide, as of ``Session``; robots that are not as their model first."""
        first = self.outliers
        asked = super().questions()
        return tuple(sorted(asked, key=lambda one: (one.can_wait, one.element.robot not in first)))

    def target(self, robot: str, *, only_this_robot: bool = False) -> Target:
        """Return the label file that an answer about a robot goes to.

        Raises
        ------
        InputErrors
            If the fleet file names none.
        """
        found = [one for one in self.targets.of(robot) if one.alone or not only_this_robot]
        if found:
            return found[-1] if only_this_robot else found[0]
        whose = "of its own" if only_this_robot else "for it"
        what = f"names no label file {whose}: {shown(robot or self._read.fleet.name)}"
        hint = "what the fleet file states is changed there; for a robot or its model write labels: [FILE]"
        raise InputErrors([FleetError(self._read.fleet.sources[0][0], 0, what, hint)])

    # --- what is so now -----------------------------------------------------------------------------------------

    @property
    def entries(self) -> dict[tuple[str, str], Any]:
        """What the label files that were looked into say with the edits: (section, file and name) -> entry."""
        return {
            (section, f"{file}: {name}"): value
            for file, labels in self._edited.items()
            for (section, name), value in labels.entries(self._edits_of(file)).items()
        }

    def said_of(self, element: Element, *, only_this_robot: bool = False) -> Any:
        """Return what the label file of an answer says of an element; None for nothing, and where there is no file."""
        try:
            labels = self._labels(self.target(element.robot, only_this_robot=only_this_robot).file)
        except InputErrors:
            return None
        entries = labels.entries(self._edits_of(labels.file))
        return entries.get(place_of(*super().called(element), entries))

    def called(self, element: Element) -> tuple[str, str]:
        """Return section and name of an element, as ``label`` takes them: with its robot."""
        section, name = super().called(element)
        return section, f"{element.robot}:{name}"

    def _not_saved(self) -> list[Edit]:
        return [edit for file, labels in self._edited.items() for edit in labels.unsaved(self._edits_of(file))]

    def _edits_of(self, file: str, edits: Sequence[Edit] | None = None) -> list[Edit]:
        return [edit for edit in (self._done if edits is None else edits) if edit.file == file]

    def _labels(self, file: str) -> FleetLabels:
        """A label file that the fleet file leads to, read when it is first asked for."""
        names = self.targets.called(file)
        if not names:
            what = "is no label file of the fleet"
            raise InputErrors([LabelError(file, 0, what, "name it in the fleet file")])
        first = names[0][0]
        if first not in self._edited:
            labels = read_fleet_labels(names, self._asked, self._read.fleet.root)
            if self._digests.get(first, labels.own.digest) != labels.own.digest:
                what = "was changed since the fleet was read"
                raise InputErrors([LabelError(file, 0, what, "save what is said, and begin again")])
            self._edited[first] = labels
        return self._edited[first]

    # --- edits --------------------------------------------------------------------------------------------------

    def label(self, name: str, *, kind: str = "node", only_this_robot: bool = False, **label: Unpack[Label]) -> Change:
        """Say what an element does, as of ``Session.label``.

        Parameters
        ----------
        name
            With its robot: ``carrier_01:/blur``.
        only_this_robot
            Say it in the robot's own label file, and not in that of its model.

        Raises
        ------
        InputErrors
            As of ``Session.label``, and if the fleet file names no such label file.
        """
        with self._lock:
            file, place, before = self._spot(name, kind, only_this_robot=only_this_robot)
            return self.do(Edit(*place, entry_of(label, before, self._asked.vocabulary), file))

    def unlabel(self, name: str, *, kind: str = "node", only_this_robot: bool = False) -> Change:
        """Take away what a label file says of an element; parameters as of ``label``.

        Raises
        ------
        InputErrors
            As of ``Session.unlabel``.
        """
        with self._lock:
            file, place, before = self._spot(name, kind, only_this_robot=only_this_robot)
            if before is None:
                what = f"says nothing of {shown(place[1])!r} under {place[0]}"
                raise InputErrors([LabelError(file, 0, what, "there is nothing to take away")])
            return self.do(Edit(*place, None, file))

    def _spot(self, name: str, kind: str, *, only_this_robot: bool) -> tuple[str, tuple[str, str], Any]:
        """The label file, the place in it, and what stands there."""
        robot, _, rest = name.partition(":")
        labels = self._labels(self.target(robot, only_this_robot=only_this_robot).file)
        entries = labels.entries(self._edits_of(labels.file))
        place = place_of(section_of(kind, rest, labels.file), rest, entries)
        return labels.file, place, entries.get(place)

    def do(self, edit: Edit) -> Change:
        """Make an edit that is whole already; it names a label file of the fleet.

        Raises
        ------
        InputErrors
            As ``label``.
        """
        with self._lock:
            before = self.uncounted
            labels = self._labels(edit.file)
            place = place_of(edit.section, edit.name, labels.entries(self._edits_of(labels.file)))
            edit = Edit(*place, edit.value, labels.file)
            self._go([*self._done, edit], [])
            return Change(edit, self.version, *compared(before, self.uncounted))

    def _go(self, done: list[Edit], undone: list[Edit]) -> None:
        self._analyse(done)
        self._done, self._undone = done, undone
        self.version += 1
        self._remembers.begin_anew(self._digest(), self._not_saved())

    def resume(self) -> tuple[str, ...]:
        """Make the edits again that a session before left; see ``Session.resume``."""
        with self._lock:
            offered = self._remembers.offered
            refused: list[Edit] = []
            why: list[str] = []
            for edit in offered.edits if offered else ():
                try:
                    self.do(edit)
                except InputErrors as error:
                    refused.append(edit)
                    why += map(str, error.errors)
            self._remembers.settle(refused)
            return tuple(why)

    def _under(self, edits: Sequence[Edit]) -> System:
        labels = {}
        for file, one in self._edited.items():
            labels.update(one.labels(self._edits_of(file, edits)))
        other = [one for file, one in self._edited.items() if one.unsaved(self._edits_of(file, edits))]
        return self._read.under(labels, {name for one in other for name, _ in one.read})

    def scenario(self, name: str, what: WhatIf) -> Scenario:  # noqa: ARG002 - as of one robot
        """Refuse: what would be otherwise is tried on one robot.

        Raises
        ------
        InputErrors
            Always.
        """
        hint = "open the policies and label files of one robot: rosprivacy explore POLICY -l FILE"
        raise InputErrors([InputError("what is tried", 0, "is about one robot, and not about a fleet", hint)])

    # --- the files ----------------------------------------------------------------------------------------------

    def save(self) -> Saved | Conflict:
        """Write the edits into their label files, each as of ``Session.save``.

        Returns
        -------
        Saved or Conflict
            The latter if one of the files was changed by somebody else: then nothing is written.
        """
        with self._lock:
            edited = {file: one for file, one in self._edited.items() if one.unsaved(self._edits_of(file))}
            changed = _joint([one.changed_on_disk() for one in edited.values()])
            if changed:
                return changed
            saved: list[Saved] = []
            try:
                for file, one in edited.items():
                    self._edited[file], done = one.saved(self._edits_of(file), self._asked, self._read.fleet.root)
                    if isinstance(done, Conflict):
                        return done
                    saved.append(done)
            finally:
                if saved:
                    self._anew()
            remarks = tuple(remark for one in saved for remark in one.remarks)
            names = ", ".join(one.file for one in saved)
            return Saved(names or "no label file", sum(one.lines for one in saved), "", remarks)

    def save_as(self, file: str) -> Saved:
        """Refuse: the label files of a fleet have names already.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(
            file, 0, "cannot take the labels of a fleet", "save() writes each where the fleet file names it"
        )

    def _anew(self) -> None:
        """Compare the robots by what their files hold now."""
        self._read = self._read.again()
        self._analyse(self._done)
        self.version += 1
        self._note_digests()
        self._remembers.begin_anew(self._digest(), self._not_saved())

    def changed_on_disk(self) -> Conflict | None:
        """Return how the label files that were looked into differ from what this session read or wrote."""
        with self._lock:
            return _joint([one.changed_on_disk() for one in self._edited.values()])

    def merge(self) -> tuple[Edit, ...]:
        """Read the label files anew that somebody else changed, and make the edits again on what they say now.

        Returns
        -------
        tuple of Edit
            What a file now says of elements of which this session says something else that is not saved: what is said
            here stands. What was saved here before gives way to what somebody else says.

        Raises
        ------
        InputErrors
            If one cannot be read, or the edits contradict it; nothing is changed then.
        """
        with self._lock:
            before = dict(self._edited), self._read, self._done
            both: list[Edit] = []
            try:
                for file, one in before[0].items():
                    if one.changed_on_disk():
                        there = read_fleet_labels(tuple(one.read), self._asked, self._read.fleet.root)
                        found = merged(one.says, there.says, one.entries(self._edits_of(file)))
                        gone = {(file, edit.section, edit.name) for edit in found.theirs}
                        self._done = [edit for edit in self._done if (edit.file, edit.section, edit.name) not in gone]
                        both += [edit._replace(file=file) for edit in found.both]
                        self._edited[file] = there
                self._anew()
            except BaseException:
                self._edited, self._read, self._done = before
                raise
            return tuple(both)

    def _note_digests(self) -> None:
        for (name, _), labels in self._read.reader.labels.items():
            self._digests.setdefault(name, labels.sha256)

    def _digest(self) -> str:
        """Of what all label files hold, as this session knows it."""
        self._digests |= {
            name: one.last[0] for one in self._edited.values() for name, _ in one.read if name in self._digests
        }
        return hashlib.sha256(repr(sorted(self._digests.items())).encode("utf-8", "surrogatepass")).hexdigest()


def _joint(changed: Sequence[Conflict | None]) -> Conflict | None:
    there = [one for one in changed if one]
    return Conflict(", ".join(one.file for one in there), "".join(one.diff for one in there)) if there else None
