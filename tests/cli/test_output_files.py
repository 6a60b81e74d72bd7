"""Files that a command writes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.policies import everything, policy

if TYPE_CHECKING:
    from tests.helpers.command import Cli


def test_output_goes_to_a_file_and_nothing_to_standard_output(
    cli: Cli, before: Path, runs: list[Path], tmp_path: Path
) -> None:
    shown = cli("analyze", before, "-l", runs[1], "-f", "json").stdout
    done = cli("analyze", before, "-l", runs[1], "-f", "json", "--output", tmp_path / "r.json")
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "")
    assert everything(tmp_path) == {"r.json": shown.encode()}  # and no temporary file is left


def test_output_replaces_a_file_and_keeps_its_rights_and_its_link(cli: Cli, before: Path, tmp_path: Path) -> None:
    real, link = tmp_path / "real.txt", tmp_path / "link.txt"
    real.write_text("old" * 10_000)
    real.chmod(0o640)
    link.symlink_to(real)
    cli("analyze", before, "-q", "-o", link)
    assert link.is_symlink()
    assert real.read_text().startswith("undetermined")
    assert real.stat().st_mode & 0o777 == 0o640


@pytest.mark.parametrize(
    ("file", "begins"),
    [("r.docx", b"PK\x03\x04"), ("r.DOCX", b"PK\x03\x04"), ("r.html", b"<!doctype html>"), ("r", b"<!doctype html>"),
     ("r.md", b"# "), ("r.csv", b"\xef\xbb\xbf")],
)  # fmt: skip
def test_a_report_is_what_its_name_ends_in(cli: Cli, before: Path, tmp_path: Path, file: str, begins: bytes) -> None:
    """A page in r.docx is opened by nothing. What is asked for by name is written under any name."""
    assert cli("report", before, "-o", file, cwd=tmp_path).returncode == 0
    assert (tmp_path / file).read_bytes().startswith(begins)
    assert cli("report", before, "-f", "markdown", "-o", file, cwd=tmp_path).returncode == 0
    assert (tmp_path / file).read_bytes().startswith(b"# ")


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["report", "-o", "r.pdf"], "--format"),
        (["analyze", "-c", "Vidio", "-o", "r.txt"], "unknown category"),
        (["analyze", "-c", "Vidio", "-o", "new.txt", "--save-graph", "g.json"], "unknown category"),
        (["analyze", "none.xml", "-o", "new.txt"], "none.xml: file not found"),
        (["analyze", "-q", "--save-graph", "g.json", "-o", "none/r.txt"], "cannot be written"),
        (["analyze", "-q", "-o", "folder"], "cannot be written"),
        (["analyze", "-q", "-o", "r.txt/r.txt"], "cannot be written"),
        (["analyze", "-q", "-o", "a" * 300], "cannot be written"),
    ],
    ids=lambda value: " ".join(value)[:40] if isinstance(value, list) else "",
)
def test_a_run_that_is_refused_writes_nothing(
    cli: Cli, before: Path, tmp_path: Path, arguments: list[str], problem: str
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "r.txt").write_text("old")
    command, *options = arguments
    done = cli(command, before, *options, cwd=tmp_path)
    assert (done.returncode, done.stdout, problem in done.stderr) == (2, "", True), done.stderr
    assert everything(tmp_path) == {"r.txt": b"old"}


def test_output_to_a_pipe_is_written_into_it(cli: Cli, before: Path, tmp_path: Path) -> None:
    # as -o >(gzip …), -o /dev/stdout; and -o /dev/null by root must not replace the device
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    try:
        done = cli("analyze", before, "-q", "-o", tmp_path / "pipe")
        assert (tmp_path / "pipe").is_fifo()
        assert os.read(reader, 1000).startswith(b"undetermined")
    finally:
        os.close(reader)
    assert done.returncode == 4


def test_a_full_disk_is_an_error_not_a_leak(before: Path) -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "rosprivacy", "analyze", str(before), "-q"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    assert done.returncode not in (0, 1, 3, 4)
    assert "Traceback" not in done.stderr


def test_a_reader_that_stops_reading_is_no_leak(before: Path) -> None:  # rosprivacy analyze … | head -1
    command = [sys.executable, "-m", "rosprivacy", "analyze", str(before), "-f", "json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        said = process.stderr.read().decode()
        assert process.wait(60) != 1  # 1 says that there is a leak
    assert "Traceback" not in said


ASCII = {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
LATIN = os.fsdecode(b"caf\xe9.xml")  # as old systems wrote it
JSON = ["analyze", "-f", "json"]
UNLIKE = (["analyze", "-q", "--save-graph", "g.json"], [*JSON, "-o", "r.json"], ["labels", "--init"])


@pytest.mark.parametrize(("name", "variables"), [("p.xml", ASCII), (LATIN, {})], ids=["ascii", "not UTF-8"])
@pytest.mark.parametrize("words", [JSON, *(pytest.param(words, marks=pytest.mark.slow) for words in UNLIKE)])
def test_names_that_a_terminal_or_utf_8_does_not_know_do_not_end_the_program(
    tmp_path: Path, words: list[str], name: str, variables: dict[str, str]
) -> None:
    body = '<topics publish="ALLOW"><topic>é\U0001f600</topic></topics>'
    (tmp_path / name).write_text(policy(body), "utf-8")
    command = [sys.executable, "-m", "rosprivacy", *words, name]
    environment = os.environ | variables
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, env=environment, timeout=60, check=False)
    assert b"Traceback" not in done.stderr
    assert done.returncode == (0 if words[0] == "labels" else 4) or (name == LATIN and done.returncode == 2)
