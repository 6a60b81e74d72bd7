"""One label file of a fleet that a session edits: what it means with edits, for every way in which robots read it.

In: the names by which the fleet file leads to it. Out: ``Labels`` for each; and the file, saved.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from rosprivacy.explorer.effects import differences
from rosprivacy.explorer.own_file import OwnFile, read_own
from rosprivacy.explorer.saving import Conflict, Saved, difference, on_disk, save
from rosprivacy.ingest.labels.label_file import Labels, read_labels

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.explorer.edits import Edit
    from rosprivacy.question import Question

    Key = tuple[str, bool]  # name of the file, and whether a robot reads it as its own
    Entries = Mapping[tuple[str, str], Any]


@dataclass(frozen=True, slots=True)
class FleetLabels:
    """A label file of a fleet.

    Attributes
    ----------
    own
        As it was read.
    read
        The same for every way in which robots read it.
    last
        Digest and text of the file as this session knows it.
    says
        What stands in the file, as this session knows it.
    written
        What the file means since it was saved here, with its lines; empty before.
    """

    own: OwnFile
    read: Mapping[Key, OwnFile]
    last: tuple[str, str]
    says: Entries
    written: Mapping[Key, Labels]

    @property
    def file(self) -> str:
        """As it was named first."""
        return self.own.file

    def entries(self, edits: Sequence[Edit]) -> dict[tuple[str, str], Any]:
        """Return what it says with edits."""
        return {**self.own.says, **{(edit.section, edit.name): edit.value for edit in edits}}

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the file on the disk does not say, as this session knows it."""
        return [edit._replace(file=self.file) for edit in differences(self.says, self.entries(edits))]

    def labels(self, edits: Sequence[Edit]) -> dict[Key, Labels]:
        """Return what it means with edits.

        Raises
        ------
        InputErrors
            With every problem of what they say.
        """
        if self.written and not self.unsaved(edits):
            return dict(self.written)
        return {key: one.with_edits(edits) for key, one in self.read.items()}

    def saved(self, edits: Sequence[Edit], question: Question, root: str) -> tuple[FleetLabels, Saved | Conflict]:
        """Write edits into the file, if it is still what this session knows; return also how the session knows it then.

        Raises
        ------
        InputError
            If it cannot be written; nothing is lost then.
        """
        done = save(self.own, edits, self.last)
        if isinstance(done, Conflict):
            return self, done
        there = read_fleet_labels(tuple(self.read), question, root)
        written = {key: own.labels for key, own in there.read.items()}
        return replace(self, last=there.last, says=self.entries(edits), written=written), done

    def changed_on_disk(self) -> Conflict | None:
        """Return how the file differs from what this session read or wrote; None if it does not."""
        diff = difference(self.file, self.last[1], on_disk(self.file))
        return Conflict(self.file, diff) if diff else None


def read_fleet_labels(names: Sequence[Key], question: Question, root: str) -> FleetLabels:
    """Read a label file of a fleet.

    Parameters
    ----------
    names
        By which the fleet file leads to it, and whether as one of a robot.
    root
        The folder that its bags do not leave.

    Raises
    ------
    InputErrors
        With every problem of the file.
    """
    settings = replace(question.settings, include_root=root)
    read: dict[Key, OwnFile] = {}
    for name, alone in names:
        own = read_own(name, question.vocabulary, settings)
        if alone:
            labels = read_labels(
                name, question.vocabulary, category=settings.category, own=True, bounds=settings.bounds,
                include_root=root,
            )  # fmt: skip
            own = replace(own, labels=labels, how=own.how._replace(own=True))
        read[name, alone] = own
    name = names[0][0]
    own = read.get((name, False)) or read_own(name, question.vocabulary, settings)  # ranked as new text is
    return FleetLabels(own, read, (own.digest, own.text or ""), own.says, {})
