"""What is tried in a session: answers if something were other than it is, kept by their names, beside its history.

In: ``WhatIf``. Out: ``Scenario``, compared with the answer of now. No label file and no policy changes by it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.explorer.effects import compared
from rosprivacy.explorer.history import History
from rosprivacy.explorer.scenarios import Scenario, WhatIf, tried

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.explorer.label_files import LabelFiles
    from rosprivacy.question import Question as Asked
    from rosprivacy.result import Result
    from rosprivacy.system import System


class Trying(History):
    """A history of edits, and what is tried beside it; as of any session.

    Attributes
    ----------
    can_try
        Whether policies are at hand, so that something can be tried.
    """

    can_try = True

    def __init__(self, files: LabelFiles, system: System, asked: Asked) -> None:
        super().__init__(files, system, asked)
        self._scenarios: dict[str, Scenario] = {}

    def scenario(self, name: str, what: WhatIf) -> Scenario:
        """Try something that is no edit, and compare it with now; it is kept by its name.

        Raises
        ------
        InputErrors
            If it names what is not there.

        Examples
        --------
        >>> from rosprivacy.explorer.session import Session
        >>> session = Session.open(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
        >>> from rosprivacy.explorer.scenarios import WhatIf
        >>> found = session.scenario("a filter", WhatIf(filters=(("/robot_camera", "/robot_video", ("Video",)),)))
        >>> found.difference.closed, len(session.findings)
        (('dc5715a35ba5591a',), 2)
        """
        with self._lock:
            result, remarks = self._tried(what)
            found = Scenario(name, what, self.version, result, compared(self.uncounted, result), remarks)
            self._scenarios[name] = found
            return found

    def _tried(self, what: WhatIf) -> tuple[Result, tuple[str, ...]]:
        return tried(self._system, self._asked, what)

    @property
    def scenarios(self) -> Mapping[str, Scenario]:
        """What was tried, by name; each is compared with the answer of now when it is asked for by ``scenario``."""
        return dict(self._scenarios)

    def drop_scenario(self, name: str) -> None:
        """Forget what was tried under a name."""
        with self._lock:
            self._scenarios.pop(name, None)
