"""The benchmarks guard: every script is run by the one command, and a bound missed twice in a row fails it.

In the form for CI only a bound on a count does: a busy machine makes no number of calls larger.
"""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING

import pytest

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

FOLDER = ROOT / "benchmarks"
PARTS = {  # scripts that declare no rows, and who has need of them
    "all": "runs the others",
    "measure": "all",
    "paper_method": "turtlebot",
    "more_categories": "turtlebot",
    "neo4j_fleet": "graph_database",
    "vehicle": "views",
    "labelled_systems": "explorer",
}
MADE_UP = """
from measure import Measured, NotMeasured, Row

RATIOS = iter({ratios})


def rows(*, quick):
    yield Row("good", "a bound", lambda: Measured("1 s", "1 s", 1.0), bound=1)
    measure = lambda: Measured("1 s", "1 s", next(RATIOS), "a note")
    yield Row("ours", "theirs", measure, bound={bound}, goal={goal}, counts={counts})
    yield Row("no bound", "theirs", lambda: Measured("1 s", "1 s", 1.0))
    raise NotMeasured("no corpus here")
"""


def run(*arguments: str, modules: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(FOLDER / "all.py"), *arguments]
    env = os.environ | ({"PYTHONPATH": str(modules)} if modules else {})
    return subprocess.run(command, env=env, capture_output=True, text=True, check=False)


def made_up(
    folder: Path,
    *ratios: float,
    bound: float | None = 1,
    goal: bool = False,
    counts: bool = True,
    form: str = "--quick",
) -> subprocess.CompletedProcess[str]:
    """Run rows of which the second has these ratios, one measurement after the other."""
    (folder / "made_up.py").write_text(MADE_UP.format(ratios=ratios, bound=bound, goal=goal, counts=counts), "utf-8")
    return run(*filter(None, [form]), "made_up", modules=folder)


def test_every_script_is_run_or_is_part_of_one() -> None:
    tree = ast.parse((FOLDER / "all.py").read_text("utf-8"))
    (given,) = (node.value for node in tree.body if isinstance(node, ast.Assign) and "BENCHMARKS" in ast.unparse(node))
    listed = ast.literal_eval(given)
    scripts = {file.stem for file in FOLDER.glob("*.py")}
    assert set(listed) == scripts - set(PARTS)
    assert len(listed) == len(set(listed))
    for name in listed:
        assert "\ndef rows(*, quick: bool) -> Iterator[Row]:" in (FOLDER / f"{name}.py").read_text("utf-8"), name


def test_a_bound_missed_twice_fails_and_is_named(tmp_path: Path) -> None:
    done = made_up(tmp_path, 1.5, 1.4)
    assert done.returncode == 1, done.stderr
    assert done.stdout.splitlines()[-1] == "missed twice: made_up: ours / theirs"
    (line,) = (line for line in done.stdout.splitlines() if "ours / theirs" in line and "MISSED" in line)
    assert line.split()[-5:] == ["1.4", "at", "most", "1", "MISSED"]
    assert "measured twice: 1.5 before" in done.stdout


@pytest.mark.parametrize("ratios", [(1.5, 0.9), (1.0,)], ids=["missed once", "met at once"])
def test_a_bound_missed_once_does_not(tmp_path: Path, ratios: tuple[float, ...]) -> None:
    done = made_up(tmp_path, *ratios)
    assert done.returncode == 0, done.stdout + done.stderr
    (line,) = (line for line in done.stdout.splitlines() if "ours / theirs" in line)
    assert line.endswith("held")
    assert ("measured twice" in done.stdout) is (len(ratios) > 1)
    assert done.stdout.splitlines()[-1] == "all bounds held"


def test_a_goal_is_told_and_not_demanded(tmp_path: Path) -> None:
    done = made_up(tmp_path, 1.5, goal=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "not reached" in done.stdout


@pytest.mark.slow
def test_a_time_is_told_in_the_quick_form_and_demanded_in_the_full_one(tmp_path: Path) -> None:
    quick, full = (made_up(tmp_path, 2.5, 2.5, counts=False, form=form) for form in ("--quick", ""))
    assert quick.returncode == 0, quick.stdout + quick.stderr
    (line,) = (line for line in quick.stdout.splitlines() if "ours / theirs" in line)
    assert line.split()[-5:] == ["2.5", "told", "1", "not", "reached"]
    assert full.returncode == 1, full.stdout + full.stderr


@pytest.mark.slow
def test_calls_are_the_same_each_time_and_grow_with_the_work() -> None:
    """Of a fresh process, and here; what two processes remember of each other is no part."""
    sys.path.insert(0, str(FOLDER))
    try:
        measure = import_module("measure")
    finally:
        sys.path.remove(str(FOLDER))
    few, again, many = (measure.calls(partial(list, map(abs, range(number)))) for number in (100, 100, 1_000))
    assert (many - few, again) == (0, few)  # what is called within C is not seen
    few, again, many = (measure.calls(lambda n=n: [abs(-one) for one in range(n)]) for n in (100, 100, 1_000))
    assert (many - few, again) == (900, few)
    assert measure.calls_of("categories") == measure.calls_of("categories") > 1_000


def test_the_tests_run_whatever_the_benchmarks_say(tmp_path: Path) -> None:
    """The end of .ci/run, from where it runs the tests: with what fails in their place, or in that of the tests."""
    script = (ROOT / ".ci" / "run").read_text("utf-8")
    for code, tests in ((0, 0), (1, 0), (0, 2), (1, 2)):
        end = script[script.index("missed=0") :].replace("make test", "make_test")
        made = f"make_test() {{ echo the tests ran; return {tests}; }}"
        text = f"set -euo pipefail\nform=some\n{made}\n(exit {code}) & speed=$!\n{end}"
        done = subprocess.run(["bash", "-c", text], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert "the tests ran" in done.stdout
        assert done.returncode == (tests or code)
        assert ("ended with 1" in done.stdout) is bool(code)


@pytest.mark.slow
def test_what_cannot_be_measured_is_told(tmp_path: Path) -> None:
    assert "made_up        not measured: no corpus here" in made_up(tmp_path, 1.0).stdout.splitlines()
    (tmp_path / "needy.py").write_text("import nothing_of_that_name\n", "utf-8")
    done = run("needy", modules=tmp_path)
    assert done.returncode == 0
    assert "not measured: nothing_of_that_name is missing" in done.stdout


@pytest.mark.slow
def test_the_quick_form_leaves_out_what_has_no_bound_and_counts_what_is_timed(tmp_path: Path) -> None:
    assert "no bound / theirs" not in made_up(tmp_path, 1.0).stdout
    assert "no bound / theirs" in run("made_up", modules=tmp_path).stdout
    counted = run("--counts", "made_up", modules=tmp_path).stdout
    assert "ours / theirs" in counted
    assert "good / a bound" not in counted
    assert "no bound / theirs" not in counted


def test_a_count_missed_twice_fails_where_nothing_else_is_measured(tmp_path: Path) -> None:
    assert made_up(tmp_path, 1.5, 1.4, form="--counts").returncode == 1


@pytest.mark.slow
def test_real_rows_are_measured() -> None:
    """What CI runs, in its smallest part: the start of the command, in fresh processes."""
    done = run("--quick", "startup")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "rosprivacy --version / a bare typer program" in done.stdout
