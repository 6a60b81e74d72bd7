"""Who commands the robot and is told nothing: somebody may act on it (issue 21)."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import policy


@pytest.mark.parametrize(
    ("node", "operated"),
    [
        ("/n>/cmd_vel", True),
        ("/n>/base/cmd_vel", True),
        ("/n>/cmd_vel</scan", False),  # it may make them of that
        ("/n>/chatter", False),
        ("/fake_n>/cmd_vel", False),  # it simulates
    ],
)
def test_velocities_come_from_somewhere(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    node: str,
    operated: bool,  # noqa: FBT001 - a row of the table
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy(node, "/m>/scan</cmd_vel,/base/cmd_vel,/chatter"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings()).proposals
    said = {(one.label.kind, str(one.confidence)) for one in found if one.label.role == "source"}
    assert (("OperatorInput", "may") in said) == operated
