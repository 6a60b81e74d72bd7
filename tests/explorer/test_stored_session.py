"""A session with what is in a database refuses each change in one line, also where the page offers none."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.explorer.edits import Edit
from rosprivacy.explorer.scenarios import WhatIf
from rosprivacy.explorer.session import Session
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_system

if TYPE_CHECKING:
    from collections.abc import Callable

CHANGES: dict[str, Callable[[Session], object]] = {
    "do": lambda session: session.history.do(Edit("nodes", "/robot_camera", "conduit")),
    "label": lambda session: session.label("/robot_camera", conduit=True),
    "merge": lambda session: session.merge(),
    "save": lambda session: session.save(),
    "save_as": lambda session: session.save_as("other.yaml"),
    "scenario": lambda session: session.scenario("a cut", WhatIf(cut=(("before.policy.xml", 3),))),
}


@pytest.mark.parametrize("change", CHANGES)
def test_no_change_is_made(change: str) -> None:
    asked = question_of(Settings())
    system = robot_system(("examples/factory/before.policy.xml",), ("examples/factory/run2.labels.yaml",), asked)
    session = Session.of_stored(
        replace(system, under=None), asked
    )  # as it is read from a database: no labels can follow
    found = session.uncounted
    with pytest.raises(RosPrivacyError, match="is shown, and not changed; change the label file"):
        CHANGES[change](session)
    assert session.uncounted is found
    assert not session.undo()
    assert not session.redo()
    assert session.unsaved == 0
