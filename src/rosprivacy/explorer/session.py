"""A session: policies that were read once, label files that are edited, and what follows at once.

In: policies and label files, a fleet, or what is in a database; settings; then edits. Out: a ``Result`` after each
edit, and the label files when they are saved. The state is a function of what was read and of the edits. Nothing here
knows of the web.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import FleetError, InputErrors, LabelError, shown
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS
from rosprivacy.decided import judged
from rosprivacy.explorer import questions
from rosprivacy.explorer.deciding import Ruling, Scope, record, record_row, scopes
from rosprivacy.explorer.edits import Edit, entry_of, place_of, section_of
from rosprivacy.explorer.effects import Change, compared
from rosprivacy.explorer.fleet_files import FleetFiles
from rosprivacy.explorer.history import History
from rosprivacy.explorer.label_files import RobotFiles
from rosprivacy.explorer.scenarios import Scenario, WhatIf
from rosprivacy.ingest.decisions.decision_writer import text_in
from rosprivacy.question import question_of
from rosprivacy.report.document.analysis import label_key
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import read_once

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from neo4j import Driver

    from rosprivacy.analysis.answer import Finding, Verdict
    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.python_311 import Unpack
    from rosprivacy.explorer.deciding import How
    from rosprivacy.explorer.edited_file import Conflict, SavedFile
    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.history import LabelFiles
    from rosprivacy.explorer.label_files import LabelTarget
    from rosprivacy.explorer.questions import RankedQuestion
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.outputs import Findings
    from rosprivacy.question import Question
    from rosprivacy.report.pictures.page_pictures import AlonePicture
    from rosprivacy.result import Result
    from rosprivacy.system import System

OF_QUESTION = ("ontologies", "type_limits", "decisions")  # files that the answer rests on, whatever system it is about


class AnsweredEntry(NamedTuple):
    """What a label file says of an element or a glob."""

    section: str
    name: str
    value: Any
    target: LabelTarget


class Session:
    """Labelling with the effect of each label at once; made by ``open``, ``open_fleet`` or ``open_database``.

    Every method may be called from several threads. Elements of a fleet are named with a robot: ``carrier_01:/blur``.
    What is in a database is shown, and each change is refused.

    Attributes
    ----------
    version
        Grows with every change of the state.
    decisions_file
        Where decisions about findings are written; None where none was named.
    """

    def __init__(
        self, files: LabelFiles, system: System, question: Question, decisions_file: str | None = None
    ) -> None:
        self.history = History(files, system, question)
        self.decisions_file = decisions_file
        self._scenarios: dict[str, Scenario] = {}

    @classmethod
    def open(
        cls,
        policies: Sequence[str],
        labels: Sequence[str | Labels] = (),
        settings: Settings | None = None,
        *,
        journal: Path | None = None,
        resume: bool = False,
    ) -> Session:
        """Read policies and label files, once.

        Parameters
        ----------
        policies
            Files, folders and globs.
        labels
            Label files; edits go to the first of them that is a person's (and not the paper's six lists). It need not
            be there yet.
        settings
            How to read, and what to ask. A decisions file need not be there yet.
        journal
            Folder in which each edit is written down at once, such as ``journal_folder()``; None for no journal.
        resume
            Make the edits again that a session before left, if policies and label file are as they were then; else they
            are offered in ``history.unsaved_from_before``, as always without this.

        Raises
        ------
        InputErrors
            With every problem of the input.
        """
        settings = settings or Settings()
        question = question_of(_with_decisions_there(settings))
        files = RobotFiles.begin(policies, labels, question)
        session = cls(files, files.read, question, settings.decisions)
        return session._journalled(journal, tuple(policies), resume=resume)

    @classmethod
    def open_fleet(
        cls, file: str, settings: Settings | None = None, *, journal: Path | None = None, resume: bool = False
    ) -> Session:
        """Read a fleet file and what it names, once; parameters and errors as of ``open``.

        Every label file that the fleet file leads to can be edited, and no other.

        Examples
        --------
        >>> session = Session.open_fleet("examples/fleet/fleet.yaml")
        >>> change = session.label("carrier_01:/blur", conduit=True)
        >>> session.target("carrier_01").models, len(session.target("carrier_01").robots)
        (('carrier',), 24)
        """
        settings = settings or Settings()
        question = question_of(_with_decisions_there(settings))
        # what can be decided about is more than is shown
        question = question._replace(every=settings.decisions is not None)
        files = FleetFiles(read_once(file, question), question)
        session = cls(files, files.system(()), question, settings.decisions)
        return session._journalled(journal, (file,), resume=resume)

    @classmethod
    def open_database(cls, driver: Driver, settings: Settings | None = None) -> Session:
        """Read everything that is in a database, once; nothing is written there.

        Raises
        ------
        InputErrors
            With every element, flow and role that cannot be understood.
        DatabaseError
            If the server refuses.
        """
        from rosprivacy.systems.stored_system import stored_system  # noqa: PLC0415 - light start

        question = question_of(settings or Settings())._replace(every=True)
        return cls.of_stored(stored_system(driver, question.vocabulary), question)

    @classmethod
    def of_stored(cls, system: System, question: Question) -> Session:
        """Return a session with what was read from a database."""
        return cls(RobotFiles.stored(system, question), system, question)

    def _journalled(self, folder: Path | None, named_files: tuple[str, ...], *, resume: bool) -> Session:
        if folder is not None:
            self.history.remember(folder, named_files, resume=resume)
        return self

    # --- what is so now -----------------------------------------------------------------------------------------

    @property
    def version(self) -> int:
        """Grows with every change of the state."""
        return self.history.version

    @property
    def uncounted(self) -> Result:
        """The answer of now, but for how many paths of a finding share no flow: what each edit shows at once."""
        return self.history.uncounted

    @property
    def result(self) -> Result:
        """The whole answer of now; of each version it is made once, when somebody asks."""
        return self.history.result

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
        return self.history.edits

    @property
    def entries(self) -> dict[tuple[str, str], Any]:
        """What the label file says with the edits: (section, name) -> entry; of a fleet with the file in the name."""
        return self.history.entries

    @property
    def unsaved(self) -> int:
        """How many entries say something else than the file on the disk, as this session knows it."""
        return self.history.unsaved

    @property
    def changed_inputs(self) -> tuple[str, ...]:
        """Files beside those that answers go to that are not what was read (rule S12); gone is changed, too."""
        return self.history.changed_inputs

    @property
    def _files(self) -> LabelFiles:
        return self.history.files

    @property
    def is_stored(self) -> bool:
        """Whether it is what is in a database: nothing can be changed or tried."""
        return bool(self._files.refusal)

    @property
    def can_mitigate(self) -> bool:
        """Whether the policies of one robot are at hand, so that it can be asked what closes a finding."""
        return self.history.system.under is not None

    # --- elements and robots ------------------------------------------------------------------------------------

    def entry_of(self, element: Element) -> tuple[str, str]:
        """Return section and name of an element, as ``label`` takes them: of a fleet with its robot."""
        key = label_key(element)
        return key["section"], f"{element.robot}:{key['name']}" if self._files.fleet else key["name"]

    def entry_for(self, element: Element, *, only_this_robot: bool = False) -> Any:
        """Return what the label file of an answer says of an element; None for nothing, and where there is no file."""
        target = self._target(element.robot, only_this_robot=only_this_robot)
        if target is None:
            return None
        entries, key = self._files.says(target.file, self.history.edits), label_key(element)
        return entries.get(place_of(key["section"], key["name"], entries))

    def entries_for(self, robot: str) -> Mapping[tuple[str, str], Any]:
        """Return what label files that can be edited say of a robot, with the edits; its own before its model's."""
        entries = [self._files.says(target.file, self.history.edits) for target in self._files.targets(robot)]
        return {place: value for each in entries for place, value in each.items() if value is not None}

    @property
    def answers(self) -> tuple[AnsweredEntry, ...]:
        """All that the label files say, with the edits: of robots that are alike, those of the first one."""
        return tuple(
            AnsweredEntry(*place, value, target)
            for target in self._files.answered(self.history.edits)
            for place, value in self._files.says(target.file, self.history.edits).items()
            if value is not None
        )

    def targets_of(self, element: Element) -> tuple[LabelTarget, ...]:
        """Return the label files that an answer can go to: that of the model, and the robot's own."""
        return self._files.targets(element.robot)

    def target(self, robot: str, *, only_this_robot: bool = False) -> LabelTarget:
        """Return the label file that an answer about a robot goes to.

        Raises
        ------
        InputErrors
            If the fleet file names none.
        """
        target = self._target(robot, only_this_robot=only_this_robot)
        if target is None:
            whose = "of its own" if only_this_robot else "for it"
            name = robot or (self._files.fleet.name if self._files.fleet else "")
            what = f"names no label file {whose}: {shown(name)}"
            hint = "what the fleet file states is changed there; for a robot or its model write labels: [FILE]"
            raise InputErrors([FleetError(self._files.name, 0, what, hint)])
        return target

    def _target(self, robot: str, *, only_this_robot: bool) -> LabelTarget | None:
        targets = [target for target in self._files.targets(robot) if target.alone or not only_this_robot]
        return targets[-1 if only_this_robot else 0] if targets else None

    def stands_for(self, robot: str) -> tuple[str, ...]:
        """Return the robots that are alike to one, itself first; none for what is shared, and where there is one."""
        return self.history.system.likeness.placed(robot)

    @property
    def is_fleet(self) -> bool:
        """Whether it is one with a fleet file."""
        return self._files.fleet is not None

    @property
    def outliers(self) -> frozenset[str]:
        """Robots of a fleet that are not read as most robots of their model are."""
        return self._files.outliers

    def robots_like(self, robot: str, *, only_this_robot: bool = False) -> tuple[str, ...]:
        """Return the robots of the model of one, or this one only; none for what belongs to no robot of a fleet.

        >>> session = Session.open_fleet("examples/fleet/fleet.yaml")
        >>> len(session.robots_like("carrier_01")), session.robots_like("carrier_01", only_this_robot=True)
        (24, ('carrier_01',))
        """
        fleet = self._files.fleet
        everything = (*fleet.robots, *fleet.infrastructure) if fleet else ()
        model = next((each.model for each in everything if each.id == robot), None)
        if fleet is None or model is None:
            return ()
        alone = only_this_robot or not model
        return (robot,) if alone else tuple(each.id for each in fleet.robots if each.model == model)

    def model_of(self, robot: str) -> str:
        """Return the model of a robot; empty where there is none."""
        fleet = self._files.fleet
        return next((each.model for each in fleet.robots if each.id == robot), "") if fleet else ""

    def questions(self) -> tuple[RankedQuestion, ...]:
        """Return what is left to decide, in the order of review (rule S11); robots unlike their model first."""
        return questions.questions(self.uncounted, self.outliers)

    def picture(
        self, name: str = "", kinds: Collection[str] | None = None, *, everything: bool = False
    ) -> AlonePicture:
        """Return what matters of the system as it is labelled now, seen from an element; a notebook shows it.

        Parameters
        ----------
        name
            Of the element; by default that of the first question, or none where nothing is left to decide.
        kinds
            Names of emitted kinds of data that are shown; by default all.
        everything
            Draw the whole system, above some 150 boxes in groups.

        Raises
        ------
        InputError
            If nothing is called so.

        Examples
        --------
        >>> import rosprivacy
        >>> session = rosprivacy.explore("examples/factory/before.policy.xml", "examples/factory/run2.labels.yaml")
        >>> session.picture("/navigator").title
        'How Video gets to /navigator, and where it can go from there'
        """
        from rosprivacy.outputs import vertices_called  # noqa: PLC0415 - light start
        from rosprivacy.report.pictures.page_pictures import picture_alone  # noqa: PLC0415 - light start

        analysis = self.uncounted.shown
        focus = next((question.element.identity for question in self.questions()), None)
        if name:
            focus = analysis.graph.elements[vertices_called(analysis, name, "picture")[0]].identity
        return picture_alone(analysis, focus, kinds, everything=everything)

    def _repr_svg_(self) -> str:
        return self.picture().svg

    # --- labels --------------------------------------------------------------------------------------------------

    def label(self, name: str, *, kind: str = "node", only_this_robot: bool = False, **label: Unpack[Label]) -> Change:
        """Say what an element does, in place of what the label file says of it.

        What data does there is said anew as a whole; what else the entry states (note, author, subjects, legal basis,
        types) stays, if the label does not say it too.

        Parameters
        ----------
        name
            As a label file writes it: a glob stands for the entry of that glob. Of a fleet with its robot.
        kind
            Of the element (``node``, ``topic``, ``storage``, …), ``channel`` for any of the three, ``non_ros`` for what
            is outside ROS, or the section of label files.
        only_this_robot
            Say it in the robot's own label file, and not in that of its model.
        **label
            See ``Label``.

        Raises
        ------
        InputErrors
            If the label is wrong, names what is not there, or contradicts another one, or if the fleet file names no
            such label file; nothing is changed then.

        Examples
        --------
        >>> session = Session.open(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
        >>> change = session.label("/robot_camera", conduit=True)
        >>> len(change.closed), len(session.findings), session.undo(), len(session.findings)
        (1, 1, True, 2)
        """
        with self.history.lock:
            edit = self._entry_called(name, kind, only_this_robot=only_this_robot)
            return self.history.do(edit._replace(value=entry_of(label, edit.value, self.history.question.vocabulary)))

    def unlabel(self, name: str, *, kind: str = "node", only_this_robot: bool = False) -> Change:
        """Take away what the label file says of an element, and what was said of it here; parameters as of ``label``.

        Raises
        ------
        InputErrors
            If neither says anything of it, or another label needs it.
        """
        with self.history.lock:
            edit = self._entry_called(name, kind, only_this_robot=only_this_robot)
            if edit.value is None:
                what = f"says nothing of {shown(edit.name)!r} under {edit.section}"
                raise InputErrors([LabelError(edit.file or self._files.name, 0, what, "there is nothing to take away")])
            return self.history.do(edit._replace(value=None))

    def _entry_called(self, name: str, kind: str, *, only_this_robot: bool) -> Edit:
        """The entry of an element, as it is now, in the label file that an answer goes to."""
        file = ""
        if self._files.fleet:
            robot, _, name = name.partition(":")
            file = self.target(robot, only_this_robot=only_this_robot).file
        edit = Edit(section_of(kind, name, file or self._files.name), name, None, file)
        return self._files.entry(edit, self.history.edits)

    def answer_for(self, element: Element, label: Label | None, *, only_this_robot: bool = False) -> Change:
        """Label an element, or take its label away; see ``label`` and ``unlabel``."""
        section, name = self.entry_of(element)
        if label is None:
            return self.unlabel(name, kind=section, only_this_robot=only_this_robot)
        return self.label(name, kind=section, only_this_robot=only_this_robot, **label)

    # --- the history; see there ---------------------------------------------------------------------------------

    def undo(self) -> bool:
        """Take the last edit back; return whether there was one."""
        return self.history.undo()

    def redo(self) -> bool:
        """Make the edit again that was taken back last; return whether there was one."""
        return self.history.redo()

    def save(self) -> SavedFile | Conflict:
        """Write the edits into the label file: only the lines that they are about, and only over what was read."""
        return self.history.save()

    def save_as(self, file: str) -> SavedFile:
        """Write the label file with the edits under another name, where there is none; the session goes on with it."""
        return self.history.save_as(file)

    def merge(self) -> tuple[Edit, ...]:
        """Read the label file anew, and make the edits again on what it says now; return what it says otherwise."""
        return self.history.merge()

    def changed_on_disk(self) -> Conflict | None:
        """Return how the label file differs from what this session read or wrote; None if it does not."""
        return self.history.changed_on_disk()

    def close(self) -> None:
        """Let go of the journal; what is not saved stays in it."""
        self.history.close()

    # --- what is tried ------------------------------------------------------------------------------------------

    def scenario(self, name: str, what_if: WhatIf) -> Scenario:
        """Try something that is no edit, and compare it with now; it is kept by its name.

        Raises
        ------
        InputErrors
            If it names what is not there.

        Examples
        --------
        >>> session = Session.open(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
        >>> filtered = WhatIf(filters=(("/robot_camera", "/robot_video", ("Video",)),))
        >>> session.scenario("a filter", filtered).difference.closed, len(session.findings)
        (('dc5715a35ba5591a',), 2)
        """
        with self.history.lock:
            self.history.check_that_it_changes(name)
            result, remarks = self._files.tried(self.history.system, self.history.question, what_if, self.history.edits)
            scenario = Scenario(name, what_if, self.version, result, compared(self.uncounted, result), remarks)
            self._scenarios[name] = scenario
            return scenario

    @property
    def scenarios(self) -> Mapping[str, Scenario]:
        """What was tried, by name; each is compared with the answer of now when it is asked for by ``scenario``."""
        return dict(self._scenarios)

    def drop_scenario(self, name: str) -> None:
        """Forget what was tried under a name."""
        with self.history.lock:
            self._scenarios.pop(name, None)

    # --- decisions ----------------------------------------------------------------------------------------------

    def decide(
        self,
        finding: str,
        choice: str,
        *,
        robots: Collection[str] | None = None,
        to_robots: Collection[str] | None = None,
        **how: Unpack[How],
    ) -> None:
        """Write a decision about a finding into the decisions file, at once; what it changes is seen at once.

        Parameters
        ----------
        finding
            Its id.
        choice
            ``accept``, ``mitigate``, ``delegate`` or ``avoid``.
        robots
            Of a fleet: the robots that it is about, by id; they have to be alike. By default all that are alike to that
            of the finding. Where data gets from one robot to another, those where it begins.
        to_robots
            Of such data: the robots that it gets to; by default all that are alike to that of the finding.
        **how
            As of ``Ruling``: ``reason``, ``owner``, ``expires``, …; an acceptance needs the first two.

        Raises
        ------
        InputErrors
            If there is no decisions file or no such finding on these robots, if the decision is none, or if another
            entry of the file decides it, too; nothing is written then.
        InputError
            If the file cannot be written; then it is as it was.
        """
        with self.history.lock, self.history.undone_if_it_fails():
            ruling = Ruling(choice, **how)
            record(self.decisions_file, self.result, finding, ruling, (robots, to_robots), self._judge)

    def decide_row(self, row: str, choice: str, *, robots: Collection[str] | None = None, **how: Unpack[How]) -> None:
        """Write a decision about a row of the register: about the findings that end there now.

        Parameters
        ----------
        row
            Its id.
        robots
            Of a fleet: some of the robots of the row; by default all of them.
        choice, **how
            As of ``decide``.

        Raises
        ------
        InputErrors
            As of ``decide``; and if the row is not on these robots.
        """
        with self.history.lock, self.history.undone_if_it_fails():
            record_row(self.decisions_file, self.result, row, Ruling(choice, **how), robots or (), self._judge)

    def scopes(self, finding: Finding) -> tuple[Scope, ...]:
        """Return what can be decided about at once, of a fleet: the robots of a finding, and others that have it."""
        fleet = self.uncounted.fleet
        return scopes(self.uncounted.analysis.findings, fleet.likeness if fleet else NO_ROBOTS, finding)

    def _judge(self, decisions: Decisions) -> None:
        """Have the answer under what people decided."""
        question = self.history.question
        settings = replace(question.settings, decisions=self.decisions_file)
        self.history.ask(question._replace(settings=settings, decisions=judged(decisions, settings)))


FleetSession = Session  # the public name of one with a fleet


def _with_decisions_there(settings: Settings) -> Settings:
    """Return settings without a decisions file that is not there yet."""
    there = settings.decisions is None or text_in(Path(settings.decisions)) is not None
    return settings if there else replace(settings, decisions=None)
