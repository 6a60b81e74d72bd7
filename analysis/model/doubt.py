"""A doubt: something that is not known, or that rests on more than a person's word about it (rule S11)."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model.diagnostic import GAPS, RIDES, Place
from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from rosprivacy.analysis.model.element import Element

NO_PLACE = Place("", 0)


class Rank(StrEnum):
    """What a doubt does to the verdict."""

    BREAKS = "breaks"  # no more than 'undetermined'
    RIDES = "rides"  # it is named in the verdict's sentence


NO_READER = "no-reader"  # a channel with data that nobody known reads
NO_FLOW = "no-flow"  # an element outside ROS that no flow reaches
BACKUPS_NOT_STATED = "backups-not-stated"
RESTRICTED = "restricted"  # the answer is about some kinds of data only
BY_GLOBS = "by-globs"  # only a glob answers for what gets to an element, in a file without pins
STANDARD_CLOSES = "standard-closes"  # only the standard file does, of a channel that is not in its standard place (S13)
INFRASTRUCTURE_CLOSES = "infrastructure-closes"  # only the file of infrastructure does
BY_TYPE_CLOSES = "by-type-closes"  # only a line 'only: by-type' does, of a way to a leak or to what nobody reviewed
TYPE_CLOSES = "type-closes"  # only what a message type cannot carry closes a path to a leak

RANKS = {  # each sort of doubts, what breaks first (rule S11)
    **dict.fromkeys((*GAPS, STANDARD_CLOSES), Rank.BREAKS),
    **dict.fromkeys((*RIDES, NO_READER, NO_FLOW, BACKUPS_NOT_STATED, RESTRICTED), Rank.RIDES),
    **dict.fromkeys((BY_GLOBS, INFRASTRUCTURE_CLOSES, TYPE_CLOSES, BY_TYPE_CLOSES), Rank.RIDES),
}


class Acceptance(NamedTuple):
    """A person's word that a doubt may be, with an end: one entry of a decisions file.

    Attributes
    ----------
    id
        Of a doubt; empty where names and globs say which.
    name
        Of a sort of doubts.
    element, robot, file
        Names or globs of what they are about; after ``=`` a name with glob signs.
    expires
        ISO date; it is valid to the end of this day.
    """

    place: Place
    id: str = ""
    name: str = ""
    element: str = ""
    robot: str = ""
    file: str = ""
    reason: str = ""
    owner: str = ""
    date: str = ""
    expires: str = ""
    ticket: str = ""


@dataclass(frozen=True, slots=True)
class Doubt:
    """One of the list of doubts (rule S11).

    Attributes
    ----------
    name
        Of its sort, for programs: one of ``RANKS``.
    element
        What it is about; None of a file, or of the whole answer.
    place
        A line of a file to look at; ``NO_PLACE`` where none speaks of it.
    categories
        The kinds of data that are in doubt, sorted; empty for any.
    count
        How many elements it stands for: of robots that are alike one is named.
    message
        Of a file: what is wrong and what to do, in English, as its reader reported it.
    accepted
        What a person has decided, if it is accepted; then it neither breaks the verdict nor fails in CI.
    """

    name: str
    element: Element | None = None
    place: Place = NO_PLACE
    categories: tuple[str, ...] = ()
    count: int = 1
    message: str = ""
    accepted: Acceptance | None = None

    @property
    def rank(self) -> Rank:
        """What it does to the verdict."""
        return RANKS[self.name]

    @property
    def id(self) -> str:
        r"""16 hexadecimal digits, the same as long as it is about the same: its name, and its element or file.

        A line may move; a file's message is part of what it is about, so that no acceptance covers another problem.

        >>> Doubt("unread-file", place=Place("a.xml", 3), message="not read").id
        '4777f4f0fece49e1'

        A file's name need not be UTF-8.

        >>> len(Doubt("unread-file", place=Place("caf\udce9.xml", 3)).id)
        16
        """
        about = self.element.identity if self.element else (self.place.file, self.message)
        leg = (self.element.leg,) if self.element and self.element.leg else ()
        parts = "\0".join(("doubt", self.name, *about, *leg))
        return hashlib.sha256(parts.encode("utf-8", "surrogateescape")).hexdigest()[:16]

    @property
    def breaks(self) -> bool:
        """Whether the verdict is undetermined at best because of it."""
        return self.rank is Rank.BREAKS and self.accepted is None
