"""Files that a command writes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.helpers.command import Cli, refused, run
from tests.helpers.policies import everything, policy


def test_output_goes_to_a_file_and_nothing_to_standard_output(
    cli: Cli, before: Path, runs: list[Path], tmp_path: Path
) -> None:
    shown = cli("analyze", before, "-l", runs[1], "-f", "json").stdout
    done = cli("analyze", before, "-l", runs[1], "-f", "json", "--output", tmp_path / "r.json")
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "")
    assert everything(tmp_path) == {"r.json": shown.encode()}  # and no temporary file is left


def test_output_replaces_a_file_and_keeps_its_rights(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "r.txt").write_text("old" * 10_000)
    (tmp_path / "r.txt").chmod(0o640)
    cli("analyze", before, "-q", "-o", tmp_path / "r.txt")
    assert (tmp_path / "r.txt").read_text().startswith("undetermined")
    assert (tmp_path / "r.txt").stat().st_mode & 0o777 == 0o640


@pytest.mark.parametrize(
    ("file", "begins"),
    [
        ("r.docx", b"PK\x03\x04"),
        ("r.DOCX", b"PK\x03\x04"),
        ("r.html", b"<!doctype html>"),
        ("r", b"<!doctype html>"),
        ("r.md", b"# "),
        ("r.csv", b"\xef\xbb\xbf"),
        ("r.pdf", b""),
    ],
)
def test_a_report_is_what_its_name_ends_in(cli: Cli, before: Path, tmp_path: Path, file: str, begins: bytes) -> None:
    """A page in r.docx is opened by nothing. What is asked for by name is written under any name."""
    done = cli("report", before, "-o", file, cwd=tmp_path)
    assert done.returncode == (0 if begins else 2)
    if begins:
        assert (tmp_path / file).read_bytes().startswith(begins)
    else:
        assert "--format" in done.stderr
        assert not (tmp_path / file).exists()
    assert cli("report", before, "-f", "markdown", "-o", file, cwd=tmp_path).returncode == 0
    assert (tmp_path / file).read_bytes().startswith(b"# ")


def test_output_of_a_refused_run_is_not_written(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "r.txt").write_text("old")
    for options in (["-o", "r.txt"], ["-o", "new.txt"], ["-o", "new.txt", "--save-graph", "g.json"]):
        refused(cli("analyze", before, "-c", "Vidio", *options, cwd=tmp_path))
        refused(cli("analyze", "none.xml", *options, cwd=tmp_path))
    assert everything(tmp_path) == {"r.txt": b"old"}


@pytest.mark.parametrize("output", ["none/r.txt", "folder", "file/r.txt", "a" * 300])
def test_output_to_a_place_that_cannot_be_written_is_refused(
    cli: Cli, before: Path, tmp_path: Path, output: str
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    (line,) = refused(cli("analyze", before, "-q", "-o", output, cwd=tmp_path))
    assert "cannot be written" in line
    assert everything(tmp_path) == {"file": b""}


def test_a_graph_is_not_saved_if_the_report_cannot_be_written(cli: Cli, before: Path, tmp_path: Path) -> None:
    refused(cli("analyze", before, "-q", "--save-graph", "g.json", "-o", "none/r.txt", cwd=tmp_path))
    assert everything(tmp_path) == {}


def test_output_through_a_link_writes_the_file_behind_it(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "real.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("real.txt")
    cli("analyze", before, "-q", "-o", tmp_path / "link.txt")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text().startswith("undetermined")


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


@pytest.mark.parametrize(
    "arguments",
    [
        ["analyze", "p.xml"],
        pytest.param(["analyze", "p.xml", "-f", "json"], marks=pytest.mark.slow),
        pytest.param(["labels", "--init", "p.xml"], marks=pytest.mark.slow),
    ],
)
def test_a_terminal_that_knows_ascii_only_does_not_end_the_program(tmp_path: Path, arguments: list[str]) -> None:
    (tmp_path / "p.xml").write_text(policy('<topics publish="ALLOW"><topic>é\U0001f600</topic></topics>'), "utf-8")
    done = run(*arguments, cwd=tmp_path, PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert (done.returncode, done.stderr) == (4 if arguments[0] == "analyze" else 0, "")


UNLIKE = (["-f", "text"], ["-q", "--save-graph", "g.json"], ["-f", "json", "-o", "r.json"])


@pytest.mark.parametrize(
    "options", [["-f", "json"], *(pytest.param(options, marks=pytest.mark.slow) for options in UNLIKE)]
)
def test_a_file_name_that_is_not_utf8_does_not_end_the_program(tmp_path: Path, options: list[str]) -> None:
    name = os.fsdecode(b"caf\xe9.xml")  # Latin-1, as old systems wrote it
    (tmp_path / name).write_text(policy(""))
    command = [sys.executable, "-m", "rosprivacy", "analyze", name, *options]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=60, check=False)
    assert b"Traceback" not in done.stderr
    assert done.returncode in (2, 4)
