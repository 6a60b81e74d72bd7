"""The label files that a session edits, as its history needs them: of one robot, or of a fleet.

In: edits, the last one last. Out: what the files say with them, what follows from it, the files written.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.explorer.edits import Edit
    from rosprivacy.explorer.saving import Conflict, Saved
    from rosprivacy.system import System


class Merging(NamedTuple):
    """Label files as they were read anew.

    Attributes
    ----------
    edits
        Those of before, without what gives way to what somebody else says.
    both
        What the files now say of elements of which the session says something else that is not saved.
    """

    files: LabelFiles
    edits: list[Edit]
    both: tuple[Edit, ...]


class LabelFiles(Protocol):
    """Label files, as a session knows them."""

    @property
    def name(self) -> str:
        """By which messages call them, where they are about no one of them."""

    @property
    def digest(self) -> str:
        """Of what they hold, as the session knows it."""

    @property
    def beside(self) -> Iterable[tuple[str, str]]:
        """The other files that were read, with their hashes: all that answers do not go to."""

    def entries(self, edits: Sequence[Edit]) -> dict[tuple[str, str], Any]:
        """Return what they say with edits: (section, name) -> entry."""

    def entry(self, of: Edit, edits: Sequence[Edit]) -> Edit:
        """Return the entry that one edit is about as it is with others: where it stands, and what it says.

        Raises
        ------
        InputErrors
            If there is no such file.
        """

    def differences(self, before: Sequence[Edit], after: Sequence[Edit]) -> list[Edit]:
        """Return the edits that make of the files with some edits those with others."""

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the files on the disk do not say, as the session knows them."""

    def system(self, edits: Sequence[Edit]) -> System:
        """Return the same policies under the files with edits.

        Raises
        ------
        InputErrors
            With every problem of what they say.
        """

    def save(self, edits: Sequence[Edit]) -> Saved | Conflict:
        """Write edits into the files, if they are still what the session knows; then it knows what was written.

        Raises
        ------
        InputError
            If one cannot be written.
        """

    def save_as(self, edits: Sequence[Edit], file: str) -> Saved:
        """Write what they say with edits under another name, where there is none.

        Raises
        ------
        InputError
            If it cannot be written, or there is a file of that name.
        """

    def changed_on_disk(self) -> Conflict | None:
        """Return how they differ from what the session read or wrote; None if they do not."""

    def merged(self, edits: Sequence[Edit]) -> Merging:
        """Read them anew, and hold edits against what they say now; these here stay as they are.

        Raises
        ------
        InputErrors
            If one cannot be read.
        """
