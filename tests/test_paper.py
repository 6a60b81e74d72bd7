"""``docs/paper.md`` says what the program prints: every command is run, every line that is shown is printed, in order.

``…`` stands for lines that are left out, or for a part of a line.
"""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

import pytest

from tests.helpers.docs import blocks
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.helpers.command import Cli

PAGE = ROOT / "docs" / "paper.md"
PUBLIC = {  # what a reader fetches, and where it is in the corpus
    "$TB3": "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml",
    "$STEPS": "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations",
}


def commands() -> Iterator[tuple[str, list[str], int | None]]:
    """Each command, the lines that are shown of what it prints, and its exit code where that is shown."""
    for block in blocks(PAGE, "console"):
        parts = [part.splitlines() for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]]
        for part, after in zip(parts, [*parts[1:], [""]], strict=True):
            if part[0] != "echo $?":
                yield part[0], part[1:], int(after[1]) if after[0] == "echo $?" else None


def shown_in(lines: list[str], printed: str) -> str | None:
    """The first line that is not printed behind those before it; None if all are."""
    left = iter(printed.splitlines())
    for line in lines:
        pattern = ".*".join(map(re.escape, line.split("…"))) if line != "…" else ".*"
        if line != "…" and not any(re.fullmatch(pattern, one) for one in left):
            return line
    return None


def check(cli: Cli, command: str, lines: list[str], code: int | None) -> None:
    program, *arguments = shlex.split(command)
    assert program == "rosprivacy"
    done = cli(*arguments)
    assert shown_in(lines, done.stdout + done.stderr) is None, done.stdout + done.stderr
    assert code in (None, done.returncode)


@pytest.mark.parametrize("number", [i for i, (command, *_) in enumerate(commands()) if "$" not in command])
def test_of_the_factory(cli: Cli, number: int) -> None:
    check(cli, *list(commands())[number])


@pytest.mark.corpus
@pytest.mark.parametrize("number", [i for i, (command, *_) in enumerate(commands()) if "$" in command])
def test_of_turtlebot3(cli: Cli, corpus: Path, number: int) -> None:
    command, lines, code = list(commands())[number]
    for name, where in PUBLIC.items():
        command = command.replace(name, str(corpus / where))
    check(cli, command, lines, code)


def test_a_line_that_is_not_printed_is_seen() -> None:
    assert shown_in(["a", "…", "c d…"], "a\nb\nc d e\n") is None
    assert shown_in(["c", "a"], "a\nc\n") == "a"
    assert shown_in(["… b …", "x…"], "a b c\nb\n") == "x…"
