"""Two runs that edit one file at once: nothing is lost, and nothing of a person's is written over."""

from __future__ import annotations

import os
import subprocess
import sys
from threading import Thread
from typing import TYPE_CHECKING

import pytest
import yaml

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.files_read import one_run
from rosprivacy.ingest.reading.bounded_file import contents
from rosprivacy.report import atomic
from rosprivacy.report.atomic import editing, write_texts
from tests.helpers.command import Cli, refused, run
from tests.helpers.factory import BEFORE

if TYPE_CHECKING:
    from pathlib import Path

DECIDES = """
import sys
from rosprivacy.cli.app import main
_, file, *ids = sys.argv
for one in ids:
    sys.argv = ["rosprivacy", "decide", "mitigate", one, "--decisions", file]
    try:
        main()
    except SystemExit as ended:
        assert not ended.code
"""


def deciding(file: Path, ids: range) -> subprocess.Popen[bytes]:
    """A process that makes one decision after the other."""
    command = [sys.executable, "-c", DECIDES, str(file), *(f"{one:016x}" for one in ids)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)


def decided(file: Path) -> set[int]:
    return {int(str(entry["id"]), 16) for entry in yaml.safe_load(file.read_text("utf-8"))["findings"]}


@pytest.mark.slow
def test_no_decision_of_two_that_decide_at_once_is_lost(tmp_path: Path) -> None:
    """Real processes; ``test_races.py`` has hundreds of rounds, ``test_killed_writers.py`` kills them."""
    each = 3
    file = tmp_path / "decisions.yaml"
    processes = [deciding(file, range(first, first + each)) for first in (1, 1 + each)]
    assert [process.communicate(timeout=240) and process.returncode for process in processes] == [0, 0]
    assert decided(file) == set(range(1, 1 + 2 * each))
    assert [path.name for path in tmp_path.iterdir()] == ["decisions.yaml"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["labels.yaml", "link.yaml"])
def test_a_second_edit_waits_for_the_first(cli: Cli, tmp_path: Path, name: str) -> None:
    file = tmp_path / "labels.yaml"
    file.write_text("labels: 1\nnodes:\n  /safety_camera: {source: [Video]}\n", "utf-8")
    (tmp_path / "link.yaml").symlink_to(file)
    done = []
    with editing(file):
        second = Thread(target=lambda: done.append(cli("labels", "--next", BEFORE, "-l", tmp_path / name)))
        second.start()
        second.join(1)
        assert not done
        file.write_text(file.read_text("utf-8") + "  /robot_camera: {source: [Video]}  # said meanwhile\n", "utf-8")
    second.join(60)
    assert done[0].returncode == 0
    assert "/robot_camera: {source: [Video]}  # said meanwhile\n" in file.read_text("utf-8")
    assert "/emergency_stop" in file.read_text("utf-8")


def test_who_waits_too_long_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(atomic, "LOCK_LIMIT", 0.1)
    file = tmp_path / "labels.yaml"
    told = pytest.raises(InputError, match=r"another rosprivacy has been editing it for 0 s; wait")
    with editing(file), told, editing(file):
        pass


def test_a_lock_that_is_closed_to_us_is_named(cli: Cli, tmp_path: Path) -> None:
    """As one that another user left: it is in the way, not the file."""
    (tmp_path / ".d.yaml.lock").mkdir()
    (line,) = refused(cli("decide", "mitigate", "7ac677bf059b5beb", "--decisions", tmp_path / "d.yaml"))
    assert line.startswith(f"{tmp_path / '.d.yaml.lock'}: cannot be written: ")


def test_a_link_in_the_place_of_the_lock_is_named_and_not_followed(cli: Cli, tmp_path: Path) -> None:
    """A checkout may bring one along."""
    victim, link = tmp_path / "victim", tmp_path / ".decisions.yaml.lock"
    victim.write_text("theirs")
    link.symlink_to(victim)
    done = cli("decide", "mitigate", "0" * 16, "--decisions", "decisions.yaml", cwd=tmp_path)
    assert done.returncode == 2
    assert f"{link} is a link" in done.stderr
    assert "remove that link" in done.stderr
    assert victim.read_text() == "theirs"
    link.unlink()
    assert cli("decide", "mitigate", "0" * 16, "--decisions", "decisions.yaml", cwd=tmp_path).returncode == 0


def test_a_first_label_file_replaces_none_that_appears_meanwhile(tmp_path: Path) -> None:
    """What a person saves while the policies are read, which takes a second or two."""
    file = tmp_path / "l.yaml"
    with subprocess.Popen(
        [sys.executable, "-m", "rosprivacy", "labels", "--init", str(BEFORE), "-o", str(file)],
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        while not (tmp_path / ".l.yaml.lock").exists():
            assert process.poll() is None
        file.write_text("labels: 1\n", "utf-8")
        _, error = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "is there already" in error or "was changed meanwhile" in error
    assert file.read_text("utf-8") == "labels: 1\n"


def test_of_two_first_label_files_one_is_refused(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "rosprivacy", "labels", "--init", str(BEFORE), "-o", "l.yaml"]
    both = [
        subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    said = sorted((process.communicate(timeout=60)[1], process.returncode) for process in both)
    assert [code for _, code in said] == [0, 2]
    assert "is there already" in said[1][0]


@pytest.mark.slow
def test_an_answer_to_a_pipe_takes_no_lock(tmp_path: Path) -> None:
    labels = tmp_path / "l.yaml"
    labels.write_text("labels: 1\nnodes:\n  /safety_camera: {source: [Video]}\n", "utf-8")
    for command in (["--next", "-l", str(labels)], ["--init"]):
        done = run("labels", *command, BEFORE, "-o", "/dev/stdout")
        assert (done.returncode, "/emergency_stop" in done.stdout) == (0, True), done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["l.yaml"]


@pytest.mark.slow
def test_where_the_file_system_has_no_locks(tmp_path: Path) -> None:
    """The lock then names its process; one that a killed run left stands in nobody's way, and nothing more is said."""
    code = (
        "import errno, fcntl, os, sys\n"
        "from rosprivacy.report import atomic\n"
        "from rosprivacy.cli.app import main\n"
        "def flock(*_): raise OSError(errno.ENOSYS, 'Function not implemented')\n"
        "fcntl.flock = flock\n"
        "if sys.argv.pop(): atomic._stage = lambda *_: os.kill(os.getpid(), 9)\n"
        "main()\n"
    )
    for number, kill in ((1, ""), (2, "kill"), (2, "")):
        arguments = ["decide", "mitigate", f"{number:016x}", "--decisions", "d.yaml", kill]
        command = [sys.executable, "-c", code, *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == (-9 if kill else 0), done.stderr
        assert (tmp_path / ".d.yaml.lock").exists() == bool(kill)
        assert kill or done.stderr.startswith("the ids were not checked; ")
    assert decided(tmp_path / "d.yaml") == {1, 2}


WORDS, OTHERS = "labels: 1\n", "labels: 1\nnodes: {}\n"


@pytest.mark.parametrize("name", ["labels.yaml", "link.yaml"])
@pytest.mark.parametrize(("before", "after"), [(WORDS, OTHERS), (WORDS, WORDS), (WORDS, None), (None, OTHERS)])
def test_what_was_done_to_a_file_since_it_was_read_is_not_written_over(
    tmp_path: Path, before: str | None, after: str | None, name: str
) -> None:
    """Other words in it, another file of the same words, none any more, or one where there was none."""
    file = tmp_path / "labels.yaml"
    (tmp_path / "link.yaml").symlink_to(file)
    with one_run():
        if before:
            file.write_text(before, "utf-8")
            contents(tmp_path / name)
        if before and after != OTHERS:
            file.unlink()
        if after:
            file.write_text(after, "utf-8")
            os.utime(file, ns=(1, 1))
        with pytest.raises(InputError, match="was changed meanwhile, so nothing is written; run the command again"):
            write_texts([(tmp_path / name, WORDS)], edited=tmp_path / name)
    assert file.exists() == bool(after)
    assert not after or file.read_text("utf-8") == after
    assert {path.name for path in tmp_path.iterdir()} <= {"labels.yaml", "link.yaml"}


def test_a_folder_that_cannot_be_written_is_one_line(cli: Cli, tmp_path: Path) -> None:
    done = cli("decide", "mitigate", "7ac677bf059b5beb", "--decisions", tmp_path / "nowhere" / "decisions.yaml")
    assert len(refused(done)) == 1
    assert "cannot be written" in done.stderr
