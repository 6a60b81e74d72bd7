"""A fleet in parts by processes of this machine: the answer is that of Spark, and a run that was killed goes on."""

from __future__ import annotations

import json
import os
import pickle
import signal
import stat
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest
from hypothesis import given

from rosprivacy.analysis.errors import ClusterError, InputError, InputErrors
from rosprivacy.parts import distributed, kept_parts, processes, workers
from rosprivacy.parts.fleet_in_parts import run_in_processes, task_of
from rosprivacy.parts.units import split
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import policy, write
from tests.helpers.parts import ASKED, FLEET, documents, fleet_file, in_list, same, same_bytes
from tests.helpers.paths import ROOT
from tests.helpers.random_fleets import Case, fleets

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.parts.units import Unit
    from tests.helpers.command import Cli

__all__ = ["fleet_file"]

OWN = stat.S_IRUSR | stat.S_IWUSR | stat.S_IXUSR


@pytest.fixture(scope="module")
def pool() -> Iterator[ProcessPoolExecutor]:
    """One for all random fleets; its processes find the tests, too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "path", [str(ROOT), *sys.path])
        with ProcessPoolExecutor(2, get_context("spawn"), processes._begin, ("",)) as executor:
            yield executor


@given(case=fleets())
def test_random_fleets(pool: ProcessPoolExecutor, case: Case) -> None:
    """Verdict, patterns, deviants, counts, and what is at every element, are those in one graph."""

    def scattered(units: Sequence[Unit]) -> processes.LocalParts:
        return processes._scattered(pool, Path(folder), list, None, units)

    with pytest.MonkeyPatch.context() as patch, TemporaryDirectory() as folder:
        patch.setattr(processes, "UNITS", 1)
        same(case, scattered)


def test_the_answer_is_that_of_spark(fleet_file: str) -> None:
    """All of it: only the engine has another name. Against memory, too: but for what parts leave out, which is told."""
    mine, other = (
        json.dumps(answer.document(), sort_keys=True, default=dict)
        for answer in (run_in_processes(fleet_file, ASKED), in_list(fleet_file, engine="parts"))
    )
    assert mine == other
    documents(fleet_file, partial(run_in_processes, settings=ASKED), "parts")


def kept_in(folder: Path) -> dict[str, int]:
    """The parts that were kept, and when; a file with a dot before its name is not written to its end."""
    return {file.name: file.stat().st_mtime_ns for file in folder.iterdir() if not file.name.startswith(".")}


def test_what_was_read_is_not_read_again(fleet_file: str, tmp_path: Path) -> None:
    """Unless a file, or what is in a folder, is another one by now; the answer is always that of the files."""
    folder = tmp_path / "kept" / "parts"

    def answer() -> str:
        return run_in_processes(fleet_file, Settings(), str(folder)).to("json")

    first = answer()
    kept = kept_in(folder)
    assert kept
    assert folder.stat().st_mode & 0o777 == OWN
    assert (answer(), kept_in(folder)) == (first, kept)
    assert answer() == run_in_processes(fleet_file, Settings()).to("json")
    changes = {
        "eye.xml": policy("/camera>/image", "/uplink</image,/other"),
        "odd.yaml": "labels: 1\n",
        fleet_file: FLEET.replace("only: [Video]", "only: [Voice]"),
    }
    for name, text in changes.items():
        write(name, text)
        assert answer() == run_in_processes(fleet_file, Settings()).to("json") != first
        assert kept_in(folder) != kept
        first, kept = answer(), kept_in(folder)


def test_a_policy_that_was_put_to_a_folder_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "policies" / "empty").mkdir(parents=True)
    write("policies/a.xml", policy("/camera>/image"))
    write("l.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n")
    write("f.yaml", "fleet: 1\nmodels: {m: {policies: policies}}\ngroups: [{robots: 2, model: m}]\n")
    before = run_in_processes("f.yaml", Settings(), "kept").document()["flows"]
    write("policies/empty/b.xml", policy("/uplink</image"))
    assert run_in_processes("f.yaml", Settings(), "kept").document()["flows"] == 2 * before


class Planted:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.mkdir, ("run",)


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "another hash"),
        (b"x" * 100, "another hash"),
        (pickle.dumps(Planted()), r"posix\.mkdir is no part"),
        (pickle.dumps((ROOT, ROOT)), "is no part"),
        (pickle.dumps(1), "cannot unpack"),
    ],
)
def test_a_part_that_is_not_as_it_was_written_is_refused_and_nothing_of_it_is_run(
    fleet_file: str, tmp_path: Path, content: bytes, problem: str
) -> None:
    run_in_processes(fleet_file, Settings(), "kept")
    for file in (tmp_path / "kept").iterdir():
        file.write_bytes(sha256(content).digest() + content if problem != "another hash" else content)
    with pytest.raises(InputErrors, match=rf"^--resume: kept/[0-9a-f]+ is not as it was written: .*{problem}"):
        run_in_processes(fleet_file, Settings(), "kept")
    assert not (tmp_path / "run").exists()


def test_a_folder_of_others_is_refused(fleet_file: str, tmp_path: Path) -> None:
    (tmp_path / "open").mkdir(mode=0o755)
    (tmp_path / "own").mkdir(mode=0o700)
    (tmp_path / "link").symlink_to(tmp_path / "own")
    (tmp_path / "file").touch(mode=0o600)
    for name, problem in (
        ("open", "not a folder of yours alone"),
        ("link", "not a folder of yours alone"),
        ("file", "File exists"),
    ):
        with pytest.raises(InputErrors, match=problem):
            run_in_processes(fleet_file, Settings(), str(tmp_path / name))


def test_what_is_read_in_the_place_of_a_missing_file_is_not_kept(fleet_file: str, tmp_path: Path) -> None:
    include = '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="gone.xml"><xi:fallback/></xi:include>'
    plain = Path("eye.xml").read_text("utf-8")
    write("eye.xml", plain.replace("</profile>", f"{include}</profile>", 1))
    write(fleet_file, "fleet: 1\nmodels: {eye: {policies: eye.xml}}\ngroups: [{robots: 2, model: eye}]\n")
    run_in_processes(fleet_file, Settings(), "kept")
    assert not list((tmp_path / "kept").iterdir())


def test_a_part_of_which_a_file_changed_while_it_was_read_is_not_kept(fleet_file: str, tmp_path: Path) -> None:
    """What was read is not what its hash would say."""
    task, _ = task_of(fleet_file, Settings(), "parts")
    alone = replace(task.fleet, robots=(), infrastructure=())
    units = split(task.groups)[1]

    def build(some: Sequence[Unit], *, touch: bool) -> workers.Built:
        new = workers.built(some, alone, task.view, task.reader)
        if touch:
            Path("eye.xml").touch()
        return new

    folder = kept_parts.kept_parts("kept", Settings(), ())
    time.sleep(2 * kept_parts.TICK / 1e9)  # the files were written just now
    for touch, kept in ((True, 0), (False, 1)):
        folder.built(units, partial(build, touch=touch))
        assert len(list((tmp_path / "kept").iterdir())) == kept
        time.sleep(2 * kept_parts.TICK / 1e9)


def test_another_program_reads_again(fleet_file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run_in_processes(fleet_file, Settings(), "kept")
    monkeypatch.setattr(kept_parts, "_program", lambda: "another")
    before = kept_in(tmp_path / "kept").keys()
    run_in_processes(fleet_file, Settings(), "kept")
    assert len(kept_in(tmp_path / "kept")) == 2 * len(before)


def test_a_process_that_is_killed_is_told(fleet_file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "_value", killed)
    with pytest.raises(ClusterError, match=r"^--engine parts: a process ended before its part was done"):
        run_in_processes(fleet_file, Settings())


def killed(part: int, steps: object) -> None:
    del part, steps
    os.kill(os.getpid(), signal.SIGKILL)


MANY = 400


@pytest.mark.slow
def test_a_run_that_is_killed_goes_on_and_leaves_no_process(tmp_path: Path) -> None:
    """``kill -9`` when some parts are kept: these are not read again, and the answer is that of a run by itself."""
    (tmp_path / "p").mkdir()
    for number in range(MANY):
        (tmp_path / "p" / f"{number}.xml").write_text(policy(f"/n{number}>/t", "/uplink</t"), "utf-8")
    robots = "\n".join(f"  r{number}: {{policies: p/{number}.xml}}" for number in range(MANY))
    (tmp_path / "f.yaml").write_text(f"fleet: 1\ncontext: [workplace, care]\nrobots:\n{robots}\n", "utf-8")
    command = [sys.executable, "-m", "rosprivacy", "analyze", "--fleet", "f.yaml", "--engine", "parts", "-f", "json"]
    resuming = [*command, "--resume", "kept"]
    folder = tmp_path / "kept"
    values = tmp_path / "values"
    values.mkdir()
    environment = {**os.environ, "TMPDIR": str(values)}
    process = subprocess.Popen(
        resuming, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment
    )
    while process.poll() is None and (not folder.is_dir() or len(list(folder.iterdir())) < 2):
        time.sleep(0.01)
    started = children(process.pid)
    process.kill()
    process.wait()
    assert process.returncode == -signal.SIGKILL
    kept = kept_in(folder)
    assert 0 < len(kept) < MANY / processes.UNITS
    while any(Path("/proc", str(number)).exists() for number in started):
        time.sleep(0.05)
    assert not list(values.glob("rosprivacy-parts-*"))
    again, whole = (
        subprocess.run(each, cwd=tmp_path, stdout=subprocess.PIPE, check=False) for each in (resuming, command)
    )
    assert again.returncode == 4
    assert kept.items() <= kept_in(folder).items()
    assert again.stdout == whole.stdout


def children(parent: int) -> list[int]:
    listed = Path(f"/proc/{parent}/task/{parent}/children").read_text("ascii").split()
    return [int(number) for number in listed]


def test_nothing_of_the_current_folder_is_run(fleet_file: str, tmp_path: Path) -> None:
    """A checkout of a stranger's may hold modules of the names that a process looks for when it starts."""
    for name in ("multiprocessing", "socket", "signal", "pickle", "numpy", "rosprivacy"):
        (tmp_path / f"{name}.py").write_text("open('run', 'a').write(__file__)\n", "utf-8")
    program = str(Path(sys.executable).with_name("rosprivacy"))  # with an option such as -P its processes had that, too
    command = [program, "analyze", "--fleet", fleet_file, "--engine", "parts", "-q"]
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, env=environment)
    assert (done.returncode, done.stderr) == (1, "")
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["examples/factory/before.policy.xml", "--engine", "parts"], "--engine parts is for fleets"),
        (["--fleet", "examples/fleet/fleet.yaml", "--resume", "x"], "--resume is for --engine parts"),
        (["--fleet", "examples/fleet/fleet.yaml", "--engine", "parts", "--results", "x"], "are for --engine spark"),
    ],
)
def test_bad_usage_is_told(cli: Cli, options: list[str], problem: str) -> None:
    done = cli("analyze", *options)
    assert (done.returncode, problem in " ".join(done.stderr.split())) == (2, True)


def test_decisions_about_a_large_fleet_are_refused(fleet_file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of one that is shown as a whole they count as in memory."""
    entry = "{category: Video, leak: /uplink, robot: odd, decision: accept, reason: A glass wall., owner: Ada}"
    write("d.yaml", f"decisions: 1\nfindings:\n  - {entry}\n")
    asked = Settings(decisions="d.yaml", today="2026-11-27")
    same_bytes(fleet_file, partial(run_in_processes, settings=asked), "parts", asked)
    assert [row for row in run_in_processes(fleet_file, asked).document()["findings"] if row["accepted"]]
    monkeypatch.setattr(distributed, "MOST_WHOLE", 0)
    with pytest.raises(InputError, match=r"^--decisions: --engine parts takes no decisions about more than"):
        run_in_processes(fleet_file, asked)
