"""A row of the register of processing, and what lies on its ways (GDPR, Articles 5, 6, 9, 10, 26, 28, 30, 44 to 49)."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.durations import Duration
    from rosprivacy.analysis.model.element import Element


class Derivation(NamedTuple):
    """That an element on the way makes one kind of data of another."""

    element: Element
    made_of: str
    target: str


class Measure(NamedTuple):
    """That an element on the way cleans data, of this kind or of one that this kind is made of.

    Attributes
    ----------
    category
        The kind that it cleans.
    method, stated
        As of the sanitizer.
    everywhere
        Whether every way passes it, or one that differs only in the robot; else some ways lead past.
    """

    element: Element
    category: str
    method: str
    stated: bool
    everywhere: bool


class Cell(StrEnum):
    """A field of a row of which something is for a person to complete."""

    CONTROLLERS = "controllers"
    OFFICERS = "officers"
    PURPOSES = "purposes"
    SUBJECTS = "subjects"
    BASES = "bases"
    SPECIAL_BASES = "special_bases"
    CRIMINAL_BASES = "criminal_bases"
    OPERATOR = "operator"
    RECIPIENT = "recipient"
    CONTRACT = "contract"
    COUNTRY = "country"
    SAFEGUARDS = "safeguards"
    RETENTION = "retention"
    ENCRYPTED = "encrypted"


class RowState(StrEnum):
    """What is decided about the findings of a row."""

    NO_FINDING = "no-finding"
    OPEN = "open"
    ACCEPTED = "accepted"
    DISMISSED = "dismissed"


class RowRobots(NamedTuple):
    """Of a fleet: how decisions name a row, and the robots of it that decisions are about.

    Attributes
    ----------
    pattern
        Of ``row_id``, made from the kind and the place without its robot.
    robots
        Those where findings end; where the place is on no robot, those where data begin.
    from_robots
        Where some data come from another robot: those where data begin; else none.
    """

    pattern: str
    robots: tuple[str, ...]
    from_robots: tuple[str, ...] = ()


def row_id(category: str, ends: Iterable[Element]) -> str:
    """Return the id of the row of a kind of data at its places, or of its sources where there is no place.

    Returns
    -------
    16 hexadecimal digits, the same for the same kind and places, whatever is stated of them.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> row_id("Video", [Element("storage", "disk")]), row_id("Voice", [Element("storage", "disk")])
    ('d8fe0ef97d4b673d', '72e2cfb593a63be9')
    """
    identities = sorted({end.identity for end in ends})
    text = "\0".join([category, *(part for identity in identities for part in identity)])
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:16]


@dataclass(frozen=True, slots=True)
class RegisterRow:
    """A kind of data at a place where it leaves or rests.

    Attributes
    ----------
    id
        Of ``row_id``.
    places
        Elements of one kind and name, of several robots if all else is the same; none where data leave nowhere.
    pseudonymised
        Whether the kind gets there in this form only.
    article9
        The verdict under Article 9(1), where the sources work.
    sources, derivations, measures
        What lies on the ways. Who recognises persons or judges them is no measure, whatever it drops.
    subjects
        Whose data get there, as labels say of the sources.
    contexts, countries
        Where the sources work.
    purposes, controllers, officers
        As stated of the place, else of who makes the kind, of the sources, of the robot.
    bases, special_bases, criminal_bases, safeguards
        Under Articles 6, 9(2) and (3), 10, and 45 to 49; those that valid decisions record, too.
    operator, recipient, contract, country, area, transfer, backups, encrypted
        Of the place, as in ``NonRosFacts``.
    retention
        How long the place keeps the kind.
    look_at
        Names of the provisions to look at that the kind, a context or the persons call for, of the Union and of these
        countries.
    findings
        Ids of the findings that end there.
    to_complete
        The fields of which something is not known.
    fleet
        None where it is no fleet, no finding ends there, or the graph does not hold the whole fleet.
    """

    id: str
    category: str
    places: tuple[Element, ...]
    pseudonymised: bool
    article9: str
    sources: tuple[Element, ...]
    derivations: tuple[Derivation, ...]
    measures: tuple[Measure, ...]
    subjects: tuple[str, ...]
    contexts: tuple[str, ...]
    countries: tuple[str, ...]
    purposes: tuple[str, ...]
    controllers: tuple[str, ...]
    officers: tuple[str, ...]
    bases: tuple[str, ...]
    special_bases: tuple[str, ...]
    criminal_bases: tuple[str, ...]
    safeguards: tuple[str, ...]
    operator: str
    recipient: str
    contract: str
    country: str
    area: str
    transfer: str
    retention: tuple[Duration, ...]
    backups: Duration | bool | None
    encrypted: bool | None
    look_at: tuple[str, ...]
    findings: tuple[str, ...]
    state: RowState
    to_complete: tuple[Cell, ...]
    fleet: RowRobots | None = None

    def without_all_subjects(self) -> RegisterRow:
        """Return the row where data of more sources than these get to the places, or leave nowhere."""
        return replace(self, to_complete=tuple(cell for cell in Cell if cell in (*self.to_complete, Cell.SUBJECTS)))
