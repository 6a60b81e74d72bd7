"""No true way out of a robot is hidden by a guided way: it is a finding, or its place is named as open or not known.

The robots' true ways out are known, of three of them by somebody who did not know the program.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.guided_ways import BY_HAND, CASES, ROBOTS, WAYS, hidden, read_robot
from tests.helpers.command import cli
from tests.helpers.screens import observed_robot

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

ASKING, MOST_KEYS, MOST_BYTES = ("enter", "knowing"), 40, 12_000
SLOW = ("amr", "drone", "ward")
# Who accepts suggestions, and looks at nothing else, does not hear of a node without a channel, which reads log files.
HIDDEN = {("ward", "likely"): {"/vector_tail"}, ("ward", "all"): {"/vector_tail"}}
COUNTED = [
    pytest.param(file.stem, way, marks=[pytest.mark.slow] if file.stem in SLOW else [])
    for file in ROBOTS
    for way in WAYS
    if way != "by hand" or file.stem in BY_HAND
]


@pytest.mark.parametrize(("name", "way"), COUNTED)
def test_no_true_way_out_is_hidden(cli: Cli, tmp_path: Path, name: str, way: str) -> None:
    """Beside what is named here; and the goals of a conversation are held."""
    robot = read_robot(next(CASES.rglob(f"{name}.yaml")))
    count = WAYS[way](cli, robot, observed_robot(cli, robot.case, tmp_path))
    assert hidden(robot, count) == HIDDEN.get((name, way), set())
    if way in ASKING:
        assert count.keys <= MOST_KEYS
        assert count.label_bytes < MOST_BYTES
