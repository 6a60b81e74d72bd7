"""Robots that all differ: in parts, by processes and by Spark here, against in memory. From files to report."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from fleet_robots import small_robots
from measure import NotMeasured, Row, compared, side_by_side, wall

from rosprivacy.parts.fleet_in_parts import run_in_processes, run_on_spark
from rosprivacy.parts.session import session
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from measure import Measured

    from rosprivacy.result import Result


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: both engines, at several sizes.

    Raises
    ------
    NotMeasured
        In the quick form: Spark takes half a minute.
    """
    if quick:
        raise NotMeasured("a server and minutes; in the full form only")
    with TemporaryDirectory() as folder, session(None) as spark:
        note = f"{spark.sparkContext.defaultParallelism} cores, the start of Spark not counted"
        for robots in (100, 500, 2_000):
            file = different_robots(Path(folder) / f"different{robots}", robots)
            here, there = partial(run_in_processes, file, Settings()), partial(run_on_spark, file, Settings())
            yield Row(f"{robots:,} robots that differ: in parts", "in memory", partial(_both, file, here, "wall"))
            yield Row(
                f"{robots:,} robots that differ: Spark on this machine", "in memory", partial(_both, file, there, note)
            )


def _both(file: str, in_parts: Callable[[], Result], note: str) -> Measured:
    """Time both.

    Raises
    ------
    AssertionError
        If they do not answer alike.
    """
    answers: dict[str, Result] = {}
    seconds = side_by_side(
        1,
        lambda: answers.update(parts=in_parts()),
        lambda: answers.update(memory=answer_fleet(file, Settings())),
        clock=wall,  # the time of other processes is not ours
    )
    ours, other = (answers[engine] for engine in ("parts", "memory"))
    assert _said(ours) == _said(other), "both engines answer alike"
    return compared(seconds, note)


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
