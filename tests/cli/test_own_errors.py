"""An error that nobody foresaw ends with 70, says what to send, and looks like no finding (DESIGN.md, exit codes).

A defect is made here, since none is known.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.helpers.policies import everything, policy

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.helpers.command import Cli

NAME = "/bedroom_of_mrs_smith"
ERRORS = [KeyError, RecursionError, MemoryError, EOFError, ValueError, OSError, StopIteration, NotImplementedError]
LINE = re.compile(
    r"rosprivacy: an error of the program itself, and no answer: (\w+) in cli/answer_command\.py:\d+; "
    r"please send us (\S+), which has no text of your files, and, if you may, what was read: p\.xml\n"
)


def raising(error: type[BaseException]) -> Callable[..., object]:
    def defect(*_: object, **__: object) -> object:
        raise error(NAME)

    return defect


@pytest.fixture
def system(tmp_path: Path) -> Path:
    folder = tmp_path / "system"
    folder.mkdir()
    (folder / "p.xml").write_text(policy('<topics publish="ALLOW"><topic>t</topic></topics>'), "utf-8")
    return folder


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the report of an error goes."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    return folder


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: str(error.__name__))
def test_it_is_told_in_one_line_that_names_the_file_to_send(
    cli: Cli, system: Path, temporary: Path, monkeypatch: pytest.MonkeyPatch, error: type[Exception]
) -> None:
    there = everything(system)
    monkeypatch.setattr("rosprivacy.cli.answer_command.in_pieces", raising(error))
    done = cli("analyze", "p.xml", "-f", "json", "-o", "out.json", "--save-graph", "g.json", cwd=system)
    assert (done.returncode, done.stdout) == (70, "")
    line = LINE.fullmatch(done.stderr)
    assert line, done.stderr
    assert line[1] == error.__name__
    assert everything(system) == there
    (report,) = temporary.iterdir()
    assert line[2] == str(report)
    text = report.read_text("utf-8")
    assert error.__name__ in text
    assert "in defect" in text
    assert NAME not in text + done.stderr
    assert report.stat().st_mode & 0o077 == 0


def test_where_no_report_can_be_written_the_line_has_to_do(
    cli: Cli, system: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(system / "absent"))
    monkeypatch.setattr("rosprivacy.cli.answer_command.exit_code", raising(ZeroDivisionError))
    done = cli("analyze", "p.xml", "-q", cwd=system)
    assert done.returncode == 70
    assert "ZeroDivisionError in cli/answer_command.py:" in done.stderr
    assert done.stderr.endswith("; please send us this line, and, if you may, what was read: p.xml\n")


@pytest.mark.parametrize(("error", "code"), [(KeyboardInterrupt, 130), (BrokenPipeError, 141)])
def test_who_ends_it_is_no_finding_either(
    cli: Cli, system: Path, monkeypatch: pytest.MonkeyPatch, error: type[BaseException], code: int
) -> None:
    """The library of the command line ends with 1 where a pipe is closed: that says 'leak'."""
    monkeypatch.setattr("rosprivacy.cli.answer_command.in_pieces", raising(error))
    done = cli("analyze", "p.xml", cwd=system)
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")


@pytest.mark.skipif(os.name == "nt", reason="pipes of POSIX")
@pytest.mark.parametrize(("file", "code"), [("p.xml", 141), ("absent.xml", 2)])
def test_pipes_that_are_gone_are_no_finding(system: Path, file: str, code: int) -> None:
    """Standard error too: `2>&1 | head -0`."""
    gone, end = os.pipe()
    os.close(gone)
    command = [sys.executable, "-m", "rosprivacy", "analyze", file]
    assert subprocess.run(command, cwd=system, stdout=end, stderr=end, check=False).returncode == code
    os.close(end)


def test_the_library_raises_a_defect_as_it_is(system: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An error of ours is no InputError: who catches those would take it for one of theirs."""
    import rosprivacy

    monkeypatch.setattr("rosprivacy.systems.robot_system.answer", raising(KeyError))
    with pytest.raises(KeyError):
        rosprivacy.analyze(system / "p.xml")
