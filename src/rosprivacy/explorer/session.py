"""A session: policies that were read once, a label file that is edited, and what follows at once (issue 22).

In: policies, label files, settings; then edits. Out: a ``Result`` after each edit, and the label file when it is saved.
The state is a function of what was read and of the edits; undo takes the last edit away. Nothing here knows of the web.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.answering import answer
from rosprivacy.decided import decisions_of
from rosprivacy.explorer.deciding import Ruling, record
from rosprivacy.explorer.edits import Edit, entry_of, place_of, section_of
from rosprivacy.explorer.effects import Change, compared, differences, merged
from rosprivacy.explorer.own_file import chosen, read_own
from rosprivacy.explorer.questions import questions
from rosprivacy.explorer.remembering import Remembering, remembering
from rosprivacy.explorer.saving import Conflict, Saved, difference, digest_of, on_disk, save, save_as
from rosprivacy.explorer.scenarios import Scenario, WhatIf, tried
from rosprivacy.ingest.decisions.decision_writer import text_in
from rosprivacy.question import question_of
from rosprivacy.reading.robot_system import read_label_files, robot_system
from rosprivacy.report.document.analysis import label_key
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from typing import Any, Unpack

    from rosprivacy.analysis.answer import Verdict
    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.deciding import How
    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.label_targets import Target
    from rosprivacy.explorer.own_file import OwnFile
    from rosprivacy.explorer.questions import Question
    from rosprivacy.explorer.remembering import Unsaved
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.outputs.finding_table import Findings
    from rosprivacy.question import Question as Asked
    from rosprivacy.report.explorer.pictures import AlonePicture
    from rosprivacy.result import Result
    from rosprivacy.system import System


class Session:
    """Labelling with the effect of each label at once; made by ``Session.open``.

    Every method may be called from several threads.

    Attributes
    ----------
    version
        Grows with every change of the state.
    uncounted
        The answer of now, but for how many paths of a finding share no flow: what each edit shows at once.
    own
        The label file that is edited, as it was read.
    decisions_file
        Where decisions about findings are written; None where none was named.
    of_one_robot
        Whether the policies of one robot are at hand, so that something can be tried.
    """

    of_one_robot = True

    def __init__(self, system: System, asked: Asked, files: Sequence[Labels], own: OwnFile,
                 at: int) -> None:  # fmt: skip
        self._lock = RLock()
        self._asked = asked
        self._files = tuple(files)
        self._at = at
        self.own = own
        self._done: list[Edit] = []
        self._undone: list[Edit] = []
        self._last = (own.digest, own.text or "")
        self._saved: tuple[dict[tuple[str, str], Any], Labels] | None = None
        self._remembers = Remembering()
        self._scenarios: dict[str, Scenario] = {}
        self.version = 0
        self.decisions_file: str | None = None
        self._system = system
        self.uncounted = answer(system, asked, count_paths=False)
        self._whole: Result | None = None

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
        decisions = settings.decisions
        if decisions is not None and text_in(Path(decisions)) is None:
            settings = replace(settings, decisions=None)
        asked = question_of(settings)
        where = chosen(labels)
        own = read_own(None if where is None else labels[where], asked.vocabulary, settings)
        named = list(labels)
        if where is None:
            named.append(own.labels)
        else:
            named[where] = own.labels
        files = read_label_files(tuple(named), asked.vocabulary, settings)
        at = next(i for i, file in enumerate(files) if file is own.labels)
        session = cls(robot_system(tuple(policies), tuple(files), asked), asked, files, own, at)
        session.decisions_file = decisions
        if journal is not None:
            session._remembers = remembering(journal, own.file, own.digest, tuple(policies), session._system)
            offered = session.unsaved_from_before
            if resume and offered and not offered.changed:
                session.resume()
        return session

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
        return len(self._not_saved())

    def _not_saved(self) -> list[Edit]:
        return differences(self._saved[0] if self._saved else self.own.says, self.entries)

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
        """What the label file says with the edits: (section, name) -> entry."""
        return {**self.own.says, **{(edit.section, edit.name): edit.value for edit in self._done}}

    def called(self, element: Element) -> tuple[str, str]:
        """Return section and name of an element, as ``label`` takes them."""
        key = label_key(element)
        return key["section"], key["name"]

    def said_of(self, element: Element, *, only_this_robot: bool = False) -> Any:  # noqa: ARG002 - of a fleet
        """Return what the label file, with the edits, says of an element; None for nothing."""
        return self.entries.get(place_of(*self.called(element), self.entries))

    def answer_for(self, element: Element, label: Label | None, *, only_this_robot: bool = False) -> Change:  # noqa: ARG002 - of a fleet
        """Label an element, or take its label away; see ``label`` and ``unlabel``."""
        section, name = self.called(element)
        return self.unlabel(name, kind=section) if label is None else self.label(name, kind=section, **label)

    def targets_of(self, element: Element) -> tuple[Target, ...]:  # noqa: ARG002 - of a fleet
        """Return the label files that an answer can go to, where there are several robots."""
        return ()

    def stands_for(self, robot: str) -> tuple[str, ...]:  # noqa: ARG002 - of a fleet
        """Return the robots that are alike to one, itself first, where there are several."""
        return ()

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
        from rosprivacy.outputs.explanation import vertices_called  # noqa: PLC0415 - light start
        from rosprivacy.report.explorer.pictures import picture_alone  # noqa: PLC0415 - light start

        shown = self.uncounted.shown
        focus = next((question.element.identity for question in self.questions()), None)
        if name:
            focus = shown.graph.elements[vertices_called(shown, name, "picture")[0]].identity
        return picture_alone(shown, focus, kinds, everything=everything)

    def _repr_svg_(self) -> str:
        return self.picture().svg

    # --- edits --------------------------------------------------------------------------------------------------

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
            place = self._place(kind, name)
            value = entry_of(label, self.entries.get(place), self._asked.vocabulary)
            return self.do(Edit(*place, value))

    def unlabel(self, name: str, *, kind: str = "node") -> Change:
        """Take away what the label file says of an element, and what was said of it here.

        Raises
        ------
        InputErrors
            If neither says anything of it, or another label needs it.
        """
        with self._lock:
            place = self._place(kind, name)
            if self.entries.get(place) is None:
                what = f"says nothing of {shown(name)!r} under {place[0]}"
                raise InputErrors([LabelError(self.own.name, 0, what, "there is nothing to take away")])
            return self.do(Edit(*place, None))

    def do(self, edit: Edit) -> Change:
        """Make an edit that is whole already, such as one that was written down.

        Raises
        ------
        InputErrors
            As ``label``.
        """
        with self._lock:
            before = self.uncounted
            edit = Edit(*place_of(edit.section, edit.name, self.entries), edit.value)
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
        before = self.entries
        self._analyse(done)
        self._done, self._undone = done, undone
        self.version += 1
        self._remembers.note(differences(before, self.entries), self._not_saved())

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
                    if self.entries.get((edit.section, edit.name)) != edit.value:
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

    def _place(self, kind: str, name: str) -> tuple[str, str]:
        return place_of(section_of(kind, name, self.own.name), name, self.entries)

    def _analyse(self, edits: Sequence[Edit]) -> None:
        """Have the answer after edits; if they are wrong, that of before is kept."""
        system = self._under(edits)
        uncounted = answer(system, self._asked, count_paths=False, before=self.uncounted)
        self._system, self.uncounted, self._whole = system, uncounted, None

    def _under(self, edits: Sequence[Edit]) -> System:
        """The same policies under the label files with edits."""
        files = list(self._files)
        says = {**self.own.says, **{(edit.section, edit.name): edit.value for edit in edits}}
        saved = self._saved and says == self._saved[0]
        files[self._at] = self._saved[1] if self._saved and saved else self.own.with_edits(edits)
        assert self._system.under is not None, "of one robot"
        return self._system.under(tuple(files))

    # --- what if ------------------------------------------------------------------------------------------------

    def scenario(self, name: str, what: WhatIf) -> Scenario:
        """Try something that is no edit, and compare it with now; it is kept by its name.

        Raises
        ------
        InputErrors
            If it names what is not there.

        Examples
        --------
        >>> session = Session.open(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
        >>> from rosprivacy.explorer.scenarios import WhatIf
        >>> found = session.scenario("a filter", WhatIf(filters=(("/robot_camera", "/robot_video", ("Video",)),)))
        >>> found.difference.closed, len(session.findings)
        (('dc5715a35ba5591a',), 2)
        """
        with self._lock:
            result, remarks = tried(self._system, self._asked, what)
            found = Scenario(name, what, self.version, result, compared(self.uncounted, result), remarks)
            self._scenarios[name] = found
            return found

    @property
    def scenarios(self) -> Mapping[str, Scenario]:
        """What was tried, by name; each is compared with the answer of now when it is asked for by ``scenario``."""
        return dict(self._scenarios)

    def drop_scenario(self, name: str) -> None:
        """Forget what was tried under a name."""
        with self._lock:
            self._scenarios.pop(name, None)

    # --- decisions ----------------------------------------------------------------------------------------------

    def decide(self, finding: str, choice: str, **how: Unpack[How]) -> None:
        """Write a decision about a finding into the decisions file, at once; what it changes is seen at once.

        Parameters
        ----------
        finding
            Its id.
        choice
            ``accept``, ``mitigate``, ``delegate`` or ``avoid``.
        **how
            ``reason``, ``owner``, ``expires``, ``ticket``, ``legal_basis``; an acceptance needs the first two.

        Raises
        ------
        InputErrors
            If there is no decisions file or no such finding, or the decision is none; nothing is written then.
        InputError
            If the file cannot be written; then it is as it was.
        """
        with self._lock:
            record(self.decisions_file, self.result, finding, Ruling(choice, **how))
            settings = replace(self._asked.settings, decisions=self.decisions_file)
            decisions = decisions_of(settings, self._asked.vocabulary)
            self._asked = self._asked._replace(settings=settings, decisions=decisions)
            self._analyse(self._done)
            self.version += 1

    # --- the file -----------------------------------------------------------------------------------------------

    def save(self) -> Saved | Conflict:
        """Write the edits into the label file: only the lines that they are about, and only over what was read.

        Returns
        -------
        Saved or Conflict
            The latter if the file was changed by somebody else: then nothing is written; see ``merge``.

        Raises
        ------
        InputError
            If it cannot be written, or there is no file; nothing is lost then.
        """
        with self._lock:
            done = save(self.own, self._done, self._last)
            if isinstance(done, Saved):
                self._keep(done)
            return done

    def save_as(self, file: str) -> Saved:
        """Write the label file with the edits under another name, where there is none; the session goes on with it.

        Raises
        ------
        InputError
            If it cannot be written, or there is a file of that name.
        """
        with self._lock:
            done = save_as(self.own, self._done, file)
            if not self.own.file:
                how = self.own.how._replace(file=file)
                self.own = replace(self.own, file=file, how=how)
                self._keep(done)
            return done

    def _keep(self, done: Saved) -> None:
        """Know what was written: what it means is read from there, so that lines and hash are those of the file."""
        there = read_own(self.own.file, self._asked.vocabulary, self._asked.settings)
        self._last = (there.digest, there.text or "")
        if there.digest != done.digest:  # somebody else was quicker
            self._last = (done.digest, "")
        self._saved = (self.entries, there.labels)
        self._remembers.begin_anew(self._last[0])
        self._analyse(self._done)
        self.version += 1

    def changed_on_disk(self) -> Conflict | None:
        """Return how the label file differs from what this session read or wrote; None if it does not."""
        if not self.own.file:
            return None
        with self._lock:
            there = on_disk(self.own.file)
            if digest_of(there) == self._last[0]:  # also of a file that is not there yet
                return None
            diff = difference(self.own.file, self._last[1], there)
            return Conflict(self.own.file, diff) if diff else None

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
            own = read_own(self.own.file or None, self._asked.vocabulary, self._asked.settings)
            before = self.own, self._saved, self._last
            found = merged(self._saved[0] if self._saved else self.own.says, own.says, self.entries)
            gone = {(edit.section, edit.name) for edit in found.theirs}
            done = [edit for edit in self._done if (edit.section, edit.name) not in gone]
            self.own, self._saved, self._last = own, None, (own.digest, own.text or "")
            try:
                self._analyse(done)
            except BaseException:
                self.own, self._saved, self._last = before
                raise
            self._done = done
            self.version += 1
            self._remembers.begin_anew(own.digest, self._not_saved())
            return found.both
