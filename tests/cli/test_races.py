"""Two runs begin at one moment and write to one file: what each of them said that it did is done."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest
import yaml

from tests.helpers.factory import FACTORY
from tests.helpers.forked_runs import Forked, Run
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.helpers.forked_runs import Ended

Two = tuple[Forked, Forked]
RACES = 100
START = "labels: 1\nnodes:\n  /safety_camera: {source: [Video]}\n"
# What both keep a lost line out with: the lock, and the look at the file before it is replaced.
UNLOCKED = """
from contextlib import nullcontext
from rosprivacy.report import atomic
atomic.editing = lambda file: nullcontext()
atomic._check_edited = lambda *_: None
"""


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Two]:
    home = tmp_path_factory.mktemp("warm")
    shutil.copytree(FACTORY, home / "factory")
    (home / "l.yaml").write_text(START, "utf-8")
    warm = [decision(0), ("labels", "--next", "factory/before.policy.xml", "-l", "l.yaml")]
    with Forked(home, *warm) as one, Forked(home, *warm) as other:
        yield one, other


def decision(number: int) -> tuple[str, ...]:
    return "decide", "mitigate", f"{number:016x}", "--decisions", "d.yaml"


def race(two: Two, home: Path, commands: tuple[tuple[str, ...], tuple[str, ...]], broken: str = "") -> list[Ended]:
    for program, arguments in zip(two, commands, strict=True):
        program.begin(Run(arguments, str(home), calls=(), before=broken))
    return [program.end() for program in two]


def decided(home: Path) -> set[int]:
    return {int(str(entry["id"]), 16) for entry in yaml.safe_load((home / "d.yaml").read_text("utf-8"))["findings"]}


@pytest.mark.slow  # each day test_two_writers.py shows it, six decisions
def test_of_two_that_decide_none_is_lost(two: Two, tmp_path: Path, every: int) -> None:
    """Two decisions each time; and two about one finding each time, of which the first stays as history."""
    for number in range(0, 2 * RACES, 2 * every):
        ended = race(two, tmp_path, (decision(number), decision(number + 1)))
        assert [run.code for run in ended] == [0, 0], ended
        assert {number, number + 1} <= decided(tmp_path)
    assert decided(tmp_path) == {one for first in range(0, 2 * RACES, 2 * every) for one in (first, first + 1)}
    assert [path.name for path in tmp_path.iterdir()] == ["d.yaml"]


@pytest.mark.slow
def test_of_two_about_one_finding_the_first_is_kept_as_history(two: Two, tmp_path: Path, every: int) -> None:
    for number in range(0, RACES, every):
        accepted = ("decide", "accept", f"{number:016x}", "--reason", "r", "--owner", "o", "--legal-basis", "6(1)(f)")
        ended = race(two, tmp_path, (decision(number), (*accepted, "--decisions", "d.yaml")))
        assert [run.code for run in ended] == [0, 0], ended
        *_, entry = yaml.safe_load((tmp_path / "d.yaml").read_text("utf-8"))["findings"]
        assert {entry["decision"], *(before["decision"] for before in entry["history"])} == {"accept", "mitigate"}


@pytest.mark.slow
def test_of_two_that_write_labels_no_line_is_lost(two: Two, tmp_path: Path, every: int) -> None:
    """Each adds what is new in policies of its own; and a person's line stays."""
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    commands = tuple(
        ("labels", "--update", f"fleet/{robot}.policy.xml", "-l", "l.yaml") for robot in ("carrier", "cleaner")
    )
    alone = []
    for command in commands:
        (tmp_path / "l.yaml").write_text(START, "utf-8")
        assert two[0](Run(command, str(tmp_path))).code == 0
        alone.append(names(tmp_path))
    assert alone[0] - alone[1]
    assert alone[1] - alone[0]
    for _ in range(0, RACES, every):
        (tmp_path / "l.yaml").write_text(START, "utf-8")
        ended = race(two, tmp_path, (commands[0], commands[1]))
        assert [run.code for run in ended] == [0, 0], ended
        assert names(tmp_path) >= alone[0] | alone[1]
        assert START in (tmp_path / "l.yaml").read_text("utf-8")


def names(home: Path) -> set[str]:
    file = yaml.safe_load((home / "l.yaml").read_text("utf-8"))
    return {name for section in ("nodes", "channels") for name in file.get(section) or {}}


@pytest.mark.slow
def test_of_two_that_save_a_graph_one_is_there_whole(two: Two, tmp_path: Path, every: int) -> None:
    shutil.copytree(FACTORY, tmp_path / "factory")
    commands = tuple(
        ("analyze", f"factory/{policy}.policy.xml", "-q", "--save-graph", "g.json", "-o", "out")
        for policy in ("before", "after")
    )
    graphs = set()
    for command in commands:
        assert two[0](Run(command, str(tmp_path))).code == 4
        graphs.add((tmp_path / "g.json").read_bytes())
    assert len(graphs) == 2
    for _ in range(0, RACES, every):
        ended = race(two, tmp_path, (commands[0], commands[1]))
        assert [run.code for run in ended] == [4, 4], ended
        assert (tmp_path / "g.json").read_bytes() in graphs
    assert {path.name for path in tmp_path.iterdir()} == {"factory", "g.json", "out"}


@pytest.mark.slow
def test_without_a_lock_a_decision_is_lost(two: Two, tmp_path: Path) -> None:
    """That the tests above can fail."""
    for number in range(0, 2 * RACES, 2):
        race(two, tmp_path, (decision(number), decision(number + 1)), UNLOCKED)
        if not {number, number + 1} <= decided(tmp_path):
            return
    pytest.fail("none was lost")
