"""Robots that all differ: on Spark, on the cores of this machine, against in memory. From files to report."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING

from fleet_robots import small_robots
from measure import Line, compared, side_by_side

from rosprivacy.fleet_system import answer_fleet
from rosprivacy.settings import Settings
from rosprivacy.spark.fleet_on_spark import run_on_spark
from rosprivacy.spark.session import session

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.result import Result


def compare(folder: Path, *, quick: bool) -> Iterator[Line]:
    """Time both, at several sizes.

    Raises
    ------
    AssertionError
        If they do not answer alike.
    """
    begin = time.perf_counter()
    with session(None) as spark:
        cores = spark.sparkContext.defaultParallelism
        yield Line("(e) starting Spark on this machine, once", f"{time.perf_counter() - begin:.1f} s")
        for robots in (50,) if quick else (100, 500, 2_000):
            file = different_robots(folder / f"different{robots}", robots)
            answers: dict[str, Result] = {}
            seconds = side_by_side(
                1,
                lambda: answers.update(spark=run_on_spark(file, Settings())),  # noqa: B023 - called within the round
                lambda: answers.update(memory=answer_fleet(file, Settings())),  # noqa: B023
            )
            ours, other = (answers[engine] for engine in ("spark", "memory"))
            assert _said(ours) == _said(other), "both engines answer alike"
            note = f"no bound; {cores} cores, the start above not counted" if robots in (50, 100) else ""
            yield compared(f"(e) {robots:,} robots that differ: Spark local / in memory", seconds, note=note)


def _said(result: Result) -> object:
    patterns = result.fleet.patterns if result.fleet else ()
    return result.analysis.verdict, [(p.id, p.count, p.dismissed, p.pseudonymised) for p in patterns]


def different_robots(folder: Path, robots: int) -> str:
    """Write a fleet of small robots, of which no two have equal policies."""
    (folder / "robots").mkdir(parents=True)
    fleet = json.loads((folder / "small1.json").read_text("utf-8")) if small_robots(folder, 1) else {}
    policy = (folder / "small.policy.xml").read_text("utf-8")
    for number in range(robots):
        own = policy.replace("/topic07", f"/own{number % 7}") + f"<!-- {number} -->"
        (folder / "robots" / f"r{number:06}.policy.xml").write_text(own, "utf-8")
    fleet["models"] = {"robot": {"labels": ["small.labels.json"]}}
    fleet["groups"] = [{"policies": "robots/*.policy.xml", "model": "robot"}]
    file = folder / "different.json"
    file.write_text(json.dumps(fleet), "utf-8")
    return str(file)
