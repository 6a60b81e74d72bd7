"""``docs/paper.md`` says what the program prints: every command is run, every line that is shown is printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers.console import check, commands, shown_in
from tests.helpers.docs import blocks
from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

COMMANDS = [shown for block in blocks(ROOT / "docs" / "paper.md", "console") for shown in commands(block)]
PUBLIC = {  # what a reader fetches, and where it is in the corpus
    "$TB3": TURTLEBOT3,
    "$STEPS": "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations",
}


@pytest.mark.parametrize("number", [i for i, (command, *_) in enumerate(COMMANDS) if "$" not in command])
def test_of_the_factory(cli: Cli, number: int) -> None:
    check(cli, *COMMANDS[number])


@pytest.mark.corpus
@pytest.mark.parametrize("number", [i for i, (command, *_) in enumerate(COMMANDS) if "$" in command])
def test_of_turtlebot3(cli: Cli, corpus: Path, number: int) -> None:
    command, lines, code = COMMANDS[number]
    for name, where in PUBLIC.items():
        command = command.replace(name, str(corpus / where))
    check(cli, command, lines, code)


def test_a_line_that_is_not_printed_is_seen() -> None:
    assert shown_in(["a", "…", "c d…"], "a\nb\nc d e\n") is None
    assert shown_in(["c", "a"], "a\nc\n") == "a"
    assert shown_in(["… b …", "x…"], "a b c\nb\n") == "x…"
