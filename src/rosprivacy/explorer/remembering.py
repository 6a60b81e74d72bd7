"""What a session remembers beyond its end: its own edits that are not saved, and those of sessions before it.

In: entries before and after an edit. Out: a journal that holds what is not saved; ``Unsaved`` of a session before.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.explorer.journal import Base, Journal

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.explorer.edits import Edit
    from rosprivacy.system import System


class Unsaved(NamedTuple):
    """What a session left that ended before it was saved.

    Attributes
    ----------
    changed
        Whether policies or the label file are other ones now: making the edits again is then a merge.
    torn
        How many lines of its journal cannot be read, such as one that was cut off.
    """

    edits: tuple[Edit, ...]
    changed: bool
    torn: int


class Remembering:
    """The journal of a session, where it has one."""

    def __init__(self, journal: Journal | None = None) -> None:
        self.journal = journal

    @property
    def offered(self) -> Unsaved | None:
        """What the newest of the sessions before left; None if there is nothing."""
        if self.journal is None or not self.journal.left:
            return None
        left = self.journal.left[0]
        return Unsaved(left.edits, left.base != self.journal.base, left.torn)

    @property
    def others(self) -> int:
        """How many other sessions edit the same file now."""
        return self.journal.others if self.journal else 0

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a person has to know of it."""
        return tuple(self.journal.remarks) if self.journal else ()

    def note(self, edits: Iterable[Edit], unsaved: Iterable[Edit]) -> None:
        """Remember what is said anew; and all that is not saved."""
        if self.journal:
            self.journal.note(edits, unsaved)

    def begin_anew(self, digest: str, unsaved: Iterable[Edit] = ()) -> None:
        """Remember that the label file is another one now: what was saved is forgotten."""
        if self.journal:
            self.journal.rewrite(self.journal.base._replace(labels=digest), unsaved)

    def settle(self, refused: Iterable[Edit] = ()) -> None:
        """Forget what the newest of the sessions before left, but for what could not be made again."""
        if self.journal and self.journal.left:
            self.journal.take_up(self.journal.left[0], refused)

    def close(self) -> None:
        """Let go of it; what is not saved stays."""
        if self.journal:
            self.journal.close()


def remembering(folder: Path, file: str, digest: str, named: tuple[str, ...], system: System) -> Remembering:
    """Begin a journal.

    Parameters
    ----------
    file, digest
        The label file that is edited, and of what it holds; both empty where there is none.
    named
        Policies as a user named them: what it is about where there is no label file.
    """
    read = sorted({source for policy in system.policies for source in policy.sources})
    policies = hashlib.sha256(repr(read).encode("utf-8", "surrogatepass")).hexdigest()
    about = str(Path(file).resolve()) if file else repr(named)
    return Remembering(Journal(folder, about, Base(digest, policies)))
