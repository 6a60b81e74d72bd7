"""What is tried on the page, kept by name: trials of a session, and how it would stand under each.

In: a session, names and what is tried. Out: a ``Standing`` of each. A trial is made anew once the session has changed,
so that it is always compared with how it stands now.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.explorer.scenarios import together, told
from rosprivacy.explorer.web.forms import FormError
from rosprivacy.explorer.web.standing import Standing
from rosprivacy.explorer.web.trials.trial_forms import Tried

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.explorer.scenarios import Scenario, WhatIf
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.forms import Form
    from rosprivacy.labelling.suggesting_on_demand import Suggester

MOST = 20  # each keeps a whole answer


class Trials:
    """The trials of one session.

    Parameters
    ----------
    known
        What suggestions are made by.
    """

    def __init__(self, session: Session, known: Suggester) -> None:
        self._session, self._known = session, known
        self._says: dict[str, tuple[str, ...]] = {}
        self._standing: Standing | None = None  # of the one that was looked at last

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, in the order in which they were made."""
        return tuple(self._session.scenarios)

    def keep(self, name: str, what: WhatIf, says: tuple[str, ...]) -> None:
        """Try something, and keep it under a name; another of that name is replaced.

        Parameters
        ----------
        says
            What is tried, in sentences.

        Raises
        ------
        FormError
            If there are too many.
        InputErrors
            If it names what is not there.
        """
        if name not in self.names and len(self.names) >= MOST:
            raise FormError(f"There are {MOST} trials already: forget one.")
        self._session.scenario(name, what)
        self._says[name] = says

    def together(self, form: Form) -> Tried:
        """Return what two trials that a form names try, as one, and what a person is told of it.

        Raises
        ------
        FormError
            If one of them is not kept.
        """
        names = form.choice("first", self.names), form.choice("second", self.names)
        first, second = (self._session.scenarios[name].what for name in names)
        return Tried(together(first, second), tuple(dict.fromkeys(said for name in names for said in self.says(name))))

    def beside(self, name: str) -> Iterator[str]:
        """Yield the others that can be tried together with one: on the same robots."""
        kept = self._session.scenarios
        yield from (one for one in kept if one != name and kept[one].what.robots == kept[name].what.robots)

    def drop(self, name: str) -> None:
        """Forget one."""
        self._session.drop_scenario(name)
        self._says.pop(name, None)

    def says(self, name: str) -> tuple[str, ...]:
        """Return what is tried, in sentences."""
        return self._says.get(name) or (told(self._session.scenarios[name].what),)

    def scenario(self, name: str) -> Scenario:
        """Return what follows, compared with how it stands now.

        Raises
        ------
        InputErrors
            If what is tried is not there any more.
        """
        found = self._session.scenarios[name]
        return found if found.version == self._session.version else self._session.scenario(name, found.what)

    def standing(self, name: str) -> Standing:
        """Return how the session would stand.

        Raises
        ------
        InputErrors
            If what is tried is not there any more.
        """
        found = self.scenario(name)
        if self._standing is None or self._standing.result is not found.result:
            self._standing = Standing(self._session, self._known, found.result)
        return self._standing
