"""What a page shows of a terminal: each command, the lines that are shown of what it prints, and its exit code.

``…`` stands for lines that are left out, or for a part of a line.
"""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.helpers.command import Cli

Shown = tuple[str, list[str], int | None]


def commands(block: str) -> Iterator[Shown]:
    """Each command of a block, the lines that are shown of what it prints, and its exit code where that is shown."""
    parts = [part.splitlines() for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]]
    for part, after in zip(parts, [*parts[1:], [""]], strict=True):
        if part[0] != "echo $?":
            yield part[0], part[1:], int(after[1]) if after[0] == "echo $?" else None


def shown_in(lines: list[str], printed: str) -> str | None:
    """The first line that is not printed behind those before it; None if all are."""
    left = iter(printed.splitlines())
    for line in lines:
        pattern = ".*".join(map(re.escape, line.split("…")))
        if line != "…" and not any(re.fullmatch(pattern, one) for one in left):
            return line
    return None


def check(cli: Cli, command: str, lines: list[str], code: int | None, cwd: Path | None = None) -> None:
    """Run a command; what is shown of it is what it prints."""
    program, *arguments = shlex.split(command)
    assert program == "rosprivacy"
    done = cli(*arguments, cwd=cwd)
    printed = done.stdout + done.stderr
    missing = shown_in(lines, printed)
    assert missing is None, f"{missing!r} is not in:\n{printed}"
    assert code in (None, done.returncode), printed
