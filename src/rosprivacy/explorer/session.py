"""A session: policies that were read once, a label file that is edited, and what follows at once (issue 22).

In: policies, label files, settings; then edits. Out: a ``Result`` after each edit, and the label file when it is saved.
The history of edits is ``History``'s, what is tried ``Trying``'s; here elements get their names, and what else can be
asked. Nothing here knows of the web.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.decided import judged
from rosprivacy.explorer.deciding import Robots, Ruling, record
from rosprivacy.explorer.decision_scope import Scope, scopes
from rosprivacy.explorer.edits import Edit, entry_of, section_of
from rosprivacy.explorer.label_targets import Entry
from rosprivacy.explorer.one_file import opened
from rosprivacy.explorer.questions import questions
from rosprivacy.explorer.trying import Trying
from rosprivacy.ingest.decisions.decision_writer import text_in
from rosprivacy.question import question_of
from rosprivacy.report.document.analysis import label_key
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from typing import Any, Unpack

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.deciding import How
    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.effects import Change
    from rosprivacy.explorer.label_files import LabelFiles
    from rosprivacy.explorer.label_targets import Target
    from rosprivacy.explorer.questions import Question
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question as Asked
    from rosprivacy.report.explorer.pictures import AlonePicture
    from rosprivacy.system import System


class Session(Trying):
    """Labelling with the effect of each label at once; made by ``Session.open``.

    Attributes
    ----------
    decisions_file
        Where decisions about findings are written; None where none was named.
    of_one_robot
        Whether the policies of one robot are at hand, so that it can be asked what closes a finding.
    """

    of_one_robot = True

    def __init__(self, files: LabelFiles, system: System, asked: Asked) -> None:
        super().__init__(files, system, asked)
        self.decisions_file: str | None = None

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
            are offered in ``unsaved_from_before``, as always without this.

        Raises
        ------
        InputErrors
            With every problem of the input.
        """
        settings = settings or Settings()
        asked = question_of(with_decisions_there(settings))
        files = opened(policies, labels, asked)
        session = cls(files, files.read, asked)
        session.decisions_file = settings.decisions
        if journal is not None:
            session._remember(journal, files.own.file, tuple(policies), resume=resume)
        return session

    # --- elements -----------------------------------------------------------------------------------------------

    def called(self, element: Element) -> tuple[str, str]:
        """Return section and name of an element, as ``label`` takes them."""
        key = label_key(element)
        return key["section"], key["name"]

    def said_of(self, element: Element, *, only_this_robot: bool = False) -> Any:  # noqa: ARG002 - of a fleet
        """Return what the label file, with the edits, says of an element; None for nothing."""
        return self._files.entry(Edit(*self.called(element), None), self._done).value

    def answer_for(self, element: Element, label: Label | None, *, only_this_robot: bool = False) -> Change:  # noqa: ARG002 - of a fleet
        """Label an element, or take its label away; see ``label`` and ``unlabel``."""
        section, name = self.called(element)
        return self.unlabel(name, kind=section) if label is None else self.label(name, kind=section, **label)

    def speaks_of(self, robot: str) -> Mapping[tuple[str, str], Any]:  # noqa: ARG002 - of a fleet
        """Return what label files that can be edited say of a robot, with the edits; one of its own before others."""
        return self.entries

    @property
    def answers(self) -> tuple[Entry, ...]:
        """All that the label file says, with the edits; of a fleet all that its label files say."""
        return tuple(Entry(*place, value) for place, value in self.entries.items() if value is not None)

    def is_about(self, edit: Edit, element: Element) -> bool:  # noqa: ARG002 - of a fleet
        """Return whether the label file of an edit is one that speaks of an element."""
        return True

    def can_answer(self, element: Element) -> bool:  # noqa: ARG002 - of a fleet
        """Return whether there is a label file that can say something of an element."""
        return True

    def targets_of(self, element: Element) -> tuple[Target, ...]:  # noqa: ARG002 - of a fleet
        """Return the label files that an answer can go to, where there are several robots."""
        return ()

    def stands_for(self, robot: str) -> tuple[str, ...]:  # noqa: ARG002 - of a fleet
        """Return the robots that are alike to one, itself first, where there are several."""
        return ()

    def robots_like(self, robot: str, *, only_this_robot: bool = False) -> tuple[str, ...]:  # noqa: ARG002 - of a fleet
        """Return the robots on which something is tried, where there are several: those of the model, or one."""
        return ()

    def model_of(self, robot: str) -> str:  # noqa: ARG002 - of a fleet
        """Return the model of a robot; empty where there is none."""
        return ""

    @property
    def outliers(self) -> frozenset[str]:
        """Robots of a fleet that are not read as most robots of their model are."""
        return frozenset()

    def questions(self) -> tuple[Question, ...]:
        """Return what is left to decide, in the order of review (rule S11)."""
        return questions(self.uncounted)

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
        from rosprivacy.report.explorer.pictures import picture_alone  # noqa: PLC0415 - light start

        shown = self.uncounted.shown
        focus = next((question.element.identity for question in self.questions()), None)
        if name:
            focus = shown.graph.elements[vertices_called(shown, name, "picture")[0]].identity
        return picture_alone(shown, focus, kinds, everything=everything)

    def _repr_svg_(self) -> str:
        return self.picture().svg

    # --- labels --------------------------------------------------------------------------------------------------

    def label(self, name: str, *, kind: str = "node", **label: Unpack[Label]) -> Change:
        """Say what an element does, in place of what the label file says of it.

        What data does there is said anew as a whole; what else the entry states (note, author, subjects, legal basis,
        types) stays, if the label does not say it too.

        Parameters
        ----------
        name
            As a label file writes it: a glob stands for the entry of that glob.
        kind
            Of the element (``node``, ``topic``, ``storage``, …), ``channel`` for any of the three, ``non_ros`` for what
            is outside ROS, or the section of label files.
        **label
            See ``Label``.

        Raises
        ------
        InputErrors
            If the label is wrong, names what is not there, or contradicts another one; nothing is changed then.

        Examples
        --------
        >>> session = Session.open(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
        >>> change = session.label("/robot_camera", conduit=True)
        >>> len(change.closed), len(session.findings), session.undo(), len(session.findings)
        (1, 1, True, 2)
        """
        with self._lock:
            return self._label(self._spot(name, kind), label)

    def unlabel(self, name: str, *, kind: str = "node") -> Change:
        """Take away what the label file says of an element, and what was said of it here.

        Raises
        ------
        InputErrors
            If neither says anything of it, or another label needs it.
        """
        with self._lock:
            return self._unlabel(self._spot(name, kind))

    def _spot(self, name: str, kind: str) -> Edit:
        """The entry of an element, as it is now."""
        of = Edit(section_of(kind, name, self._files.name), name, None)
        return self._files.entry(of, self._done)

    def _label(self, there: Edit, label: Label) -> Change:
        return self.do(there._replace(value=entry_of(label, there.value, self._asked.vocabulary)))

    def _unlabel(self, there: Edit) -> Change:
        if there.value is None:
            what = f"says nothing of {shown(there.name)!r} under {there.section}"
            raise InputErrors([LabelError(there.file or self._files.name, 0, what, "there is nothing to take away")])
        return self.do(there._replace(value=None))

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
            ``reason``, ``owner``, ``expires``, ``ticket``, ``legal_basis``; an acceptance needs the first two.

        Raises
        ------
        InputErrors
            If there is no decisions file or no such finding on these robots, if the decision is none, or if another
            entry of the file decides it, too; nothing is written then.
        InputError
            If the file cannot be written; then it is as it was.
        """
        with self._lock:
            before = self._asked, self._system, self.uncounted, self._whole
            try:
                said = Ruling(choice, **how)
                record(self.decisions_file, self.result, finding, said, Robots(robots, to_robots), self._judge)
            except BaseException:
                self._ask(before[0])
                _, self._system, self.uncounted, self._whole = before
                raise
            self.version += 1

    def scopes(self, finding: Finding) -> tuple[Scope, ...]:
        """Return what can be decided about at once, of a fleet: the robots of a finding, and others that have it."""
        fleet = self.uncounted.fleet
        return scopes(self.uncounted.analysis.findings, fleet.likeness, finding) if fleet else (Scope(finding),)

    def _judge(self, decisions: Decisions) -> None:
        """Have the answer under what people decided."""
        settings = replace(self._asked.settings, decisions=self.decisions_file)
        self._ask(self._asked._replace(settings=settings, decisions=judged(decisions, settings)))
        self._analyse(self._done)

    def _ask(self, asked: Asked) -> None:
        self._asked = asked


def with_decisions_there(settings: Settings) -> Settings:
    """Return settings without a decisions file that is not there yet."""
    there = settings.decisions is None or text_in(Path(settings.decisions)) is not None
    return settings if there else replace(settings, decisions=None)
