"""A session with what is in a database: it is shown as it stands there, and nothing is changed.

In: a driver, settings. Out: as of ``Session``. What people say in a database stands in its roles, which are more than
the entries of a label file and can be written by several people at once; so they are changed there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.explorer.one_file import OneFile
from rosprivacy.explorer.own_file import read_own
from rosprivacy.explorer.session import Session
from rosprivacy.question import question_of
from rosprivacy.reading.stored_system import stored_system
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from neo4j import Driver

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.edits import Edit
    from rosprivacy.explorer.effects import Change
    from rosprivacy.explorer.saving import Saved
    from rosprivacy.explorer.scenarios import Scenario, WhatIf
    from rosprivacy.question import Question as Asked
    from rosprivacy.system import System

SHOWN_ONLY = (
    "what is in the database is shown, and not changed: change the label file and load the robot again, or add roles "
    "in the database, and begin again"
)


class StoredSession(Session):
    """What is in a database, to be looked at; made by ``StoredSession.open_database``."""

    of_one_robot = can_try = False

    def __init__(self, system: System, asked: Asked) -> None:
        own = read_own(None, asked.vocabulary, asked.settings)
        super().__init__(OneFile(system, asked, (), own), system, asked)

    @classmethod
    def open_database(cls, driver: Driver, settings: Settings | None = None) -> StoredSession:
        """Read everything that is in a database, once; nothing is written there.

        Raises
        ------
        InputErrors
            With every element, flow and role that cannot be understood.
        DatabaseError
            If the server refuses.
        """
        asked = question_of(settings or Settings())._replace(every=True)
        return cls(stored_system(driver, asked.vocabulary), asked)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a person has to know of the session itself."""
        return (f"{SHOWN_ONLY[0].upper()}{SHOWN_ONLY[1:]}.",)

    def can_answer(self, element: Element) -> bool:  # noqa: ARG002 - as of one robot
        """Nothing can be said here."""
        return False

    def do(self, edit: Edit) -> Change:
        """Refuse an edit.

        Raises
        ------
        InputErrors
            Always.
        """
        raise InputErrors([InputError(edit.name, 0, *_refusal())])

    def scenario(self, name: str, what: WhatIf) -> Scenario:  # noqa: ARG002 - as of one robot
        """Refuse what is tried: the policies are not at hand.

        Raises
        ------
        InputErrors
            Always.
        """
        raise InputErrors([InputError(name, 0, *_refusal())])

    def save(self) -> Saved:
        """Refuse to write: there is no label file.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(self._files.name, 0, *_refusal())

    def merge(self) -> tuple[Edit, ...]:
        """Refuse to read anew: there is no label file.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(self._files.name, 0, *_refusal())

    def save_as(self, file: str) -> Saved:
        """Refuse to write a label file.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(file, 0, *_refusal())


def _refusal() -> tuple[str, str]:
    problem, _, hint = SHOWN_ONLY.partition(": ")
    return problem, hint
