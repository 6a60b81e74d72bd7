"""The readers under what the grammars make, what was found before, and a bounded exploration; and the net itself."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputError
from tests.fuzzing import judge, record, seeds, watch
from tests.fuzzing.choices import Choices
from tests.fuzzing.record import Counts
from tests.fuzzing.targets import TARGETS, Target
from tests.fuzzing.watch import Watch
from tests.helpers.paths import ROOT, TESTS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

CASES = sorted(path for path in (TESTS / "fuzzing" / "cases").glob("*/*") if path.is_dir())
HEAVY = {"ontology"}  # a quarter of a second for each input
LIGHT = [pytest.param(name, marks=[pytest.mark.slow] if name in HEAVY else []) for name in TARGETS]
TRIED = 45


@pytest.fixture
def watched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Watch]:
    """The folder in which inputs are read is the current one, and is watched."""
    outside = judge.prepare(tmp_path / "root")
    monkeypatch.chdir(tmp_path / "root")
    watched = Watch(tmp_path / "root", outside, Path(os.environ["XDG_CACHE_HOME"]))
    with watched.guard:
        yield watched


def reading(target: Target, data: bytes, watched: Watch) -> judge.Outcome:
    judge.write(judge.files_of(target, data, Path(watched.guard.folder)))
    outcome = judge.judge_reading(target, watched)
    assert not outcome.fault, f"{data.hex()}: {outcome.fault}\n{outcome.trace}"
    return outcome


# ---------------------------------------------------------------- what was found


@pytest.mark.parametrize("case", CASES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_what_was_a_fault_is_none(case: Path, watched: Watch) -> None:
    target = TARGETS[case.parent.name]
    files = {file.relative_to(case).as_posix(): file.read_bytes() for file in case.rglob("*") if file.is_file()}
    expected = files.pop("expected.txt").decode().strip()
    judge.write(files)
    outcomes = [judge.judge_reading(target, watched)]
    assert outcomes[0].kind == expected
    if expected == "accepted" and target.analyse:
        outcomes.append(judge.judge_whole(target, watched, twice=True))
    if target.arguments:
        outcomes.append(judge.judge_command(target, watched, expected))
    assert [outcome.fault for outcome in outcomes] == [""] * len(outcomes)


@pytest.mark.slow
@pytest.mark.parametrize("name", LIGHT)
def test_a_kept_seed_is_read_or_refused(name: str, watched: Watch) -> None:
    assert seeds.kept(name)
    for data in seeds.kept(name):
        reading(TARGETS[name], data, watched)


# ---------------------------------------------------------------- what is made


@pytest.mark.slow
@pytest.mark.parametrize("name", LIGHT)
def test_at_least_a_third_of_what_is_made_is_accepted(name: str, watched: Watch) -> None:
    random = Random(16)  # noqa: S311 - repeatable
    tried = TRIED // 3 if name in HEAVY else TRIED
    kinds = [reading(TARGETS[name], random.randbytes(60), watched).kind for _ in range(tried)]
    assert kinds.count("accepted") >= tried / 3


@pytest.mark.slow
@pytest.mark.parametrize("name", TARGETS)
def test_thousands_of_inputs_are_read_or_refused(name: str, watched: Watch) -> None:
    """As many as an exploration gives each reader in a few minutes, most of which it takes to begin."""
    random = Random(5)  # noqa: S311 - repeatable
    for _ in range(5 * TARGETS[name].share):
        reading(TARGETS[name], random.randbytes(random.randrange(4, 120)), watched)


DAILY = {"policy", "analysis"}  # a second or two each
WHOLE = [name for name, target in TARGETS.items() if target.analyse]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in DAILY else [pytest.mark.slow]) for name in WHOLE]
)
def test_what_is_accepted_is_reported_whole(name: str, watched: Watch) -> None:
    """One input that both the reader and the analysis take, in every format, twice; and the command on it."""
    random = Random(4)  # noqa: S311 - repeatable
    target = TARGETS[name]
    for _ in range(TRIED):
        if reading(target, random.randbytes(60), watched).kind == "accepted":
            whole = judge.judge_whole(target, watched, twice=True)
            assert not whole.fault, whole.fault + whole.trace
            if whole.kind == "accepted":
                break
    else:
        pytest.fail("nothing was analysed")
    command = judge.judge_command(target, watched, "accepted")
    assert not command.fault, command.trace


def test_the_same_bytes_make_the_same_files() -> None:
    for target in TARGETS.values():
        if target.name not in {"analysis", "parquet"}:  # made of an analysis
            assert target.make(Choices(b"seeds and choices")) == target.make(Choices(b"seeds and choices"))


# ---------------------------------------------------------------- the net has no holes


def _opens_outside() -> None:
    Path("link.xml").read_bytes()


def _opens_elsewhere() -> None:
    with Path("/etc/hostname").open("rb"):
        pass


def _asks_the_network() -> None:
    with socket.socket() as asked, pytest.raises(OSError, match="refused"):
        asked.connect(("127.0.0.1", 9))


def _starts_a_process() -> None:
    subprocess.run(["true"], check=True)


def _crashes() -> None:
    raise ZeroDivisionError


def _speaks_in_colours() -> None:
    raise InputError("f", 1, "it is \x1b[31mred", "do")


@pytest.mark.parametrize(
    ("act", "fault"),
    [
        (_opens_outside, "opened .*secret.xml"),
        (_opens_elsewhere, "opened .*etc/hostname"),
        (_asks_the_network, "socket.connect"),
        (_starts_a_process, "subprocess.Popen"),
        (_crashes, "ZeroDivisionError"),
        (_speaks_in_colours, "unprintable"),
    ],
)
def test_a_fault_is_seen(act: Callable[[], None], fault: str, watched: Watch) -> None:
    target = replace(TARGETS["policy"], read=act)
    outcome = judge.judge_reading(target, watched)
    assert outcome.kind == "fault"
    assert re.search(fault, outcome.fault)


@pytest.mark.slow
def test_a_hang_and_growth_are_seen(watched: Watch, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watch, "SECONDS", 0.2)
    monkeypatch.setattr(watch, "GROWTH", 2**26)

    def endless() -> None:
        while True:
            pass

    assert judge.judge_reading(replace(TARGETS["policy"], read=endless), watched).fault.startswith("hang in")
    held = partial(bytearray, watch.peak() + 2**28)
    assert "grew by" in judge.judge_reading(replace(TARGETS["policy"], read=lambda: len(held())), watched).fault


def test_a_wrong_exit_code_is_seen(watched: Watch) -> None:
    """The reader is said to have refused what the command takes."""
    judge.write({"labels.yaml": b"labels: 1\nnodes: {/n0: {source: [Video]}, /n1: {leak: [Video]}}\n"})
    target = TARGETS["labels"]
    assert judge.judge_command(target, watched, "accepted").fault == ""
    assert "AssertionError" in judge.judge_command(target, watched, "refused").fault


# ---------------------------------------------------------------- a run


def test_a_record_adds_up() -> None:
    counts = Counts(inputs=2, accepted=1, slowest=0.5, cpu=1, coverage=7)
    counts.fault("x", "boom")
    whole = Counts()
    for _ in range(2):
        whole.add(counts)
    assert (whole.inputs, whole.accepted, whole.slowest, whole.cpu, whole.coverage) == (4, 2, 0.5, 2, 7)
    assert whole.faults == {"x": {"fault": "boom", "times": 2}}
    told = record.document({"commit": "c"}, {"policy": whole})
    assert "| policy | 4 | 50 % |" in record.table(json.loads(json.dumps(told)))


@pytest.mark.slow
def test_a_bounded_exploration_finds_nothing(tmp_path: Path, thorough: bool) -> None:  # noqa: FBT001 - a fixture
    """The same inputs in every run of the same code: seed and number are given. For each change of one reader."""
    pytest.importorskip("atheris", reason="no atheris: pip install '.[fuzz]'")
    inputs, whole = (20_000, 40) if thorough else (300, 4)
    command = [sys.executable, "-m", "tests.fuzzing", "run", "--inputs", str(inputs), "--whole", str(whole)]
    command += [] if thorough else ["--only", "labels"]
    done = subprocess.run([*command, "--folder", tmp_path], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    told = json.loads((tmp_path / "record.json").read_text("utf-8"))
    assert told["totals"]["inputs"] >= 0.99 * inputs
    assert told["totals"]["whole"] >= 0.75 * whole
    few = 10  # inputs, after which no coverage is told yet
    assert all(counts["coverage"] for counts in told["targets"].values() if counts["inputs"] > few)
