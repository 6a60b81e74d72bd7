"""A session with a fleet: robots that are alike stand as one, and an answer goes to a model's label file or a robot's.

In: a fleet file, settings; then edits. Out: as of ``Session``. Every label file that the fleet file leads to can be
edited, and no other.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import FleetError, InputErrors, shown
from rosprivacy.explorer.edits import Edit, place_of, section_of
from rosprivacy.explorer.fleet_files import FleetFiles
from rosprivacy.explorer.fleet_scenarios import tried_on_robots
from rosprivacy.explorer.label_targets import Entry, Target, Targets, outliers
from rosprivacy.explorer.session import Session, with_decisions_there
from rosprivacy.question import question_of
from rosprivacy.reading.fleet_system import FleetSystem, read_once
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path
    from typing import Any, Unpack

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.effects import Change
    from rosprivacy.explorer.questions import Question
    from rosprivacy.explorer.scenarios import WhatIf
    from rosprivacy.question import Question as Asked
    from rosprivacy.result import Result


class FleetSession(Session):
    """Labelling a fleet; made by ``FleetSession.open_fleet``. Elements are named with a robot: ``carrier_01:/blur``."""

    of_one_robot = False
    _files: FleetFiles

    def __init__(self, files: FleetFiles, asked: Asked) -> None:
        super().__init__(files, files.system(()), asked)

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
        settings = settings or Settings()
        asked = question_of(with_decisions_there(settings))
        asked = asked._replace(every=settings.decisions is not None)  # what can be decided about is more than is shown
        session = cls(FleetFiles(read_once(file, asked), asked), asked)
        session.decisions_file = settings.decisions
        if journal is not None:
            session._remember(journal, file, (file,), resume=resume)
        return session

    # --- robots -------------------------------------------------------------------------------------------------

    @property
    def targets(self) -> Targets:
        """The label files, with the robots that read them."""
        return self._files.targets

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
        return outliers(self._files.read.groups)

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
        what = f"names no label file {whose}: {shown(robot or self._files.read.fleet.name)}"
        hint = "what the fleet file states is changed there; for a robot or its model write labels: [FILE]"
        raise InputErrors([FleetError(self._files.read.fleet.sources[0][0], 0, what, hint)])

    # --- elements -----------------------------------------------------------------------------------------------

    def called(self, element: Element) -> tuple[str, str]:
        """Return section and name of an element, as ``label`` takes them: with its robot."""
        section, name = super().called(element)
        return section, f"{element.robot}:{name}"

    def said_of(self, element: Element, *, only_this_robot: bool = False) -> Any:
        """Return what the label file of an answer says of an element; None for nothing, and where there is no file."""
        found = [one.file for one in self.targets_of(element) if one.alone or not only_this_robot]
        if not found:
            return None
        entries = self._files.says(found[-1] if only_this_robot else found[0], self._done)
        return entries.get(place_of(*super().called(element), entries))

    def speaks_of(self, robot: str) -> Mapping[tuple[str, str], Any]:
        """Return what label files that can be edited say of a robot, with the edits; its own before its model's."""
        says = [self._files.says(one.file, self._done) for one in self.targets.of(robot)]
        return {place: value for said in says for place, value in said.items() if value is not None}

    @property
    def answers(self) -> tuple[Entry, ...]:
        """All that the label files say, with the edits: of robots that are alike, those of the first one."""
        robots = [group.robots[0].id for group in self._files.read.groups]
        robots += [robot for edit in self._done for robot in self.targets.readers(edit.file)]
        targets = {one.file: one for robot in dict.fromkeys(robots) for one in self.targets.of(robot)}
        return tuple(
            Entry(*place, value, target)
            for file, target in targets.items()
            for place, value in self._files.says(file, self._done).items()
            if value is not None
        )

    def is_about(self, edit: Edit, element: Element) -> bool:
        """Return whether the label file of an edit is one that speaks of an element."""
        called = self.targets.called(edit.file)
        return any(self.targets.called(one.file) == called for one in self.targets_of(element))

    def can_answer(self, element: Element) -> bool:
        """Return whether there is a label file that can say something of an element."""
        return bool(self.targets_of(element))

    def answer_for(self, element: Element, label: Label | None, *, only_this_robot: bool = False) -> Change:
        """Label an element, or take its label away; see ``label`` and ``unlabel``."""
        section, name = self.called(element)
        if label is None:
            return self.unlabel(name, kind=section, only_this_robot=only_this_robot)
        return self.label(name, kind=section, only_this_robot=only_this_robot, **label)

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
            return self._label(self._spot(name, kind, only_this_robot=only_this_robot), label)

    def unlabel(self, name: str, *, kind: str = "node", only_this_robot: bool = False) -> Change:
        """Take away what a label file says of an element; parameters as of ``label``.

        Raises
        ------
        InputErrors
            As of ``Session.unlabel``.
        """
        with self._lock:
            return self._unlabel(self._spot(name, kind, only_this_robot=only_this_robot))

    def _spot(self, name: str, kind: str, *, only_this_robot: bool = False) -> Edit:
        """The entry of an element, as it is now, in the label file that an answer goes to."""
        robot, _, rest = name.partition(":")
        file = self.target(robot, only_this_robot=only_this_robot).file
        return self._files.entry(Edit(section_of(kind, rest, file), rest, None, file), self._done)

    def _ask(self, asked: Asked) -> None:
        """Robots about which a decision is made are alike only to each other, from now on."""
        if asked is not self._asked:
            super()._ask(asked)
            self._files.ask(asked, self._done)

    # --- what if ------------------------------------------------------------------------------------------------

    def robots_like(self, robot: str, *, only_this_robot: bool = False) -> tuple[str, ...]:
        """Return the robots of the model of one, or this one only; none for what belongs to no robot.

        >>> session = FleetSession.open_fleet("examples/fleet/fleet.yaml")
        >>> len(session.robots_like("carrier_01")), session.robots_like("carrier_01", only_this_robot=True)
        (24, ('carrier_01',))
        """
        fleet = self._files.read.fleet
        found = next((one for one in (*fleet.robots, *fleet.infrastructure) if one.id == robot), None)
        if found is None:
            return ()
        if only_this_robot or not found.model:
            return (robot,)
        return tuple(one.id for one in fleet.robots if one.model == found.model)

    def model_of(self, robot: str) -> str:
        """Return the model of a robot; empty where there is none."""
        return next((one.model for one in self._files.read.fleet.robots if one.id == robot), "")

    def _tried(self, what: WhatIf) -> tuple[Result, tuple[str, ...]]:
        assert isinstance(self._system, FleetSystem), "of a fleet"
        return tried_on_robots(self._system, partial(self._files.tried, self._done), self._asked, what)
