"""A fleet in parts against the same in one graph: whatever travels between parts, the answer is the same.

Here the parts are in a list; ``spark/test_spark.py`` has them on Spark.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.fleet_system import answer_fleet
from rosprivacy.ingest.fleet.alike_robots import alike
from rosprivacy.ingest.fleet.fleet_file import read_fleet
from rosprivacy.ontology.vocabulary import load
from rosprivacy.question import Question
from rosprivacy.settings import Settings
from rosprivacy.spark.distributed import Task, analyse_in_parts
from rosprivacy.spark.fleet_on_spark import file_reader, result
from rosprivacy.spark.shown_robots import shown
from tests.helpers.fleet_files import write
from tests.helpers.parts import FLEET, documents, fleet_file, same
from tests.helpers.paths import ROOT
from tests.helpers.random_fleets import Case, fleets

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rosprivacy.result import Result
    from rosprivacy.spark.units import Unit

__all__ = ["fleet_file"]


@dataclass(frozen=True)
class Listed:
    """Parts in a list."""

    values: tuple[Any, ...]

    def map(self, function: Callable[[Any], Any], *, keep: bool = False) -> Listed:
        del keep
        return Listed(tuple(map(function, self.values)))

    def collect(self) -> list[Any]:
        return list(self.values)


def scattered(units: Sequence[Unit], size: int = 1) -> Listed:
    return Listed(tuple(tuple(units[i : i + size]) for i in range(0, len(units), size)))


@given(fleets())
def test_in_parts_it_is_the_same(case: Case) -> None:
    same(case, scattered)


@given(fleets())
@settings(max_examples=30)
def test_several_units_are_one_part(case: Case) -> None:
    same(case, partial(scattered, size=2))
    same(case, partial(scattered, size=100))


def in_list(file: str, size: int = 1) -> Result:
    vocabulary = load()
    fleet = read_fleet(file, vocabulary)
    asked = Task(
        fleet, alike(fleet), "declared", partial(file_reader, Settings(), str(Path.cwd())), vocabulary.hierarchy
    )
    found = analyse_in_parts(asked, partial(scattered, size=size))
    return result(asked, found, shown(asked, found, "witness", 100), Question(Settings(), None, None, ""), vocabulary)


@pytest.mark.parametrize("size", [1, 3])
def test_a_fleet_of_all_sorts(fleet_file: str, size: int) -> None:
    documents(fleet_file, partial(in_list, size=size))


def test_the_example(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples" / "fleet")
    documents("fleet.yaml", in_list)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('wall_*:/receiver"', 'wall_*:/recever"'),
        ("to: cloud}", "to: clod}"),
        ("odd:/uplink", "od:/uplink"),
        ("base:/screen", "/screen"),
        ("policies: hall.xml", "policies: wall.xml"),
    ],
)
def test_bad_fleets_are_refused_alike(fleet_file: str, old: str, new: str) -> None:
    """Also what only the parts know: names that are on no robot, labels that name what is not there."""
    write(fleet_file, FLEET.replace(old, new, 1))
    problems = []
    for run in (lambda file: answer_fleet(file, Settings()), in_list):
        with pytest.raises(InputErrors) as caught:
            run(fleet_file)
        problems.append(str(caught.value))
    assert problems[0] == problems[1]


def test_labels_that_contradict_each_other_are_refused_alike(fleet_file: str) -> None:
    write("odd.yaml", "labels: 1\nnodes: {/camera: conduit}\n")
    write("eye.yaml", "labels: 1\nnodes: {/camera: {source: [Video], sanitizer: {Video: drop}}}\n")
    problems = []
    for run in (lambda file: answer_fleet(file, Settings()), in_list):
        with pytest.raises(InputErrors) as caught:
            run(fleet_file)
        problems.append(str(caught.value))
    assert problems[0] == problems[1]


def test_a_flow_that_is_stated_twice_with_different_limits_is_refused(fleet_file: str) -> None:
    """A hub would lead around what the label file says; in memory both hold."""
    write(
        "eye.yaml",
        Path("eye.yaml").read_text("utf-8")
        + "elements: {disk: {kind: storage}}\nflows: [{from: /uplink, to: disk, never: [Video]}]\n",
    )
    write(fleet_file, FLEET + '  - {from: "*:/uplink", to: "*:disk"}\n')
    with pytest.raises(InputErrors, match=r"f.yaml:25: a flow within a robot, of which a label file says more"):
        in_list(fleet_file)
