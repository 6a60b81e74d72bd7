"""The program as tests call it.

``run`` starts a process. ``cli`` calls the same entry point in this process, because there are many rows;
``tests/cli/test_processes.py`` holds each command and each of its endings to what a process gives.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Protocol

import pytest
import typer.main

from rosprivacy.cli.app import main

Done = subprocess.CompletedProcess[str]
LINE = re.compile(r"^.+: .+; .+$")  # file:line: what is wrong; what to do
BUILT = cache(typer.main.get_command)  # the command line is built once, not for every run
UNSET = ("FORCE_COLOR", "NO_COLOR", "CLICOLOR_FORCE", "PY_COLORS", "GITHUB_ACTIONS", "COLUMNS", "TERM")


def run(*arguments: str | Path, cwd: Path | None = None, seconds: float = 60, **variables: str) -> Done:
    """Run the program with no terminal and no colour settings of the person who runs the tests."""
    environment = {name: value for name, value in os.environ.items() if name not in UNSET} | variables
    command = [sys.executable, "-m", "rosprivacy", *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, cwd=cwd, env=environment, timeout=seconds, check=False
    )


class Cli(Protocol):
    def __call__(
        self, *arguments: str | Path, cwd: Path | None = None, seconds: float = 60, **variables: str
    ) -> Done: ...


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Cli:
    for name in UNSET:
        monkeypatch.delenv(name, raising=False)

    def here(*arguments: str | Path, cwd: Path | None = None, seconds: float = 60, **variables: str) -> Done:
        del seconds
        words = [str(argument) for argument in arguments]
        with monkeypatch.context() as patch:
            patch.setattr(sys, "argv", ["rosprivacy", *words])
            patch.setattr(typer.main, "get_command", BUILT)
            patch.chdir(cwd or Path.cwd())
            for name, value in variables.items():
                patch.setenv(name, value)
            with pytest.raises(SystemExit) as ended:
                main()
        code = ended.value.code
        assert code is None or isinstance(code, int)
        shown = capsys.readouterr()
        return Done(words, code or 0, shown.out, shown.err)

    return here


def refused(done: Done) -> list[str]:
    """The lines of standard error of a run that was refused as it should be."""
    lines = done.stderr.splitlines()
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert lines
    assert all(LINE.match(line) for line in lines), done.stderr
    return lines


XI = 'xmlns:xi="http://www.w3.org/2001/XInclude"'
