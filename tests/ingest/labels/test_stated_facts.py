"""What several statements say of one thing comes to one, in whatever order they are read (rules S7, S14)."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import Place, Processing, Surroundings
from rosprivacy.ingest.labels.stated_facts import joined, over, united
from tests.helpers.label_files import read

if TYPE_CHECKING:
    from pathlib import Path

LOW = Processing("Firm", "officer@low", (("", ("low",)),), (("Video", ("6(1)(a)",)),), Place("low.yaml", 1))
HIGH = Processing("Town", "", (("Voice", ("b",)),), (), Place("high.yaml", 2))
BESIDE = Processing("", "", (("Video", ("c",)), ("Voice", ("a",))), (), Place("high.yaml", 3))
RANKED = [((1, 0), LOW), ((2, 0), HIGH), ((2, 0), BESIDE)]


def test_of_each_fact_those_of_the_highest_rank_count() -> None:
    for order in permutations(RANKED):
        one = united(order)
        assert (one.controller, one.dpo, one.bases, one.place) == ("Town", "officer@low", LOW.bases, LOW.place)
        assert one.purposes == (("Video", ("c",)), ("Voice", ("a", "b")))
    assert over(HIGH, LOW).controller == over(BESIDE, HIGH).controller == "Town"


def test_two_controllers_of_one_rank_are_told_and_no_others() -> None:
    told = []
    again = HIGH._replace(place=Place("again.yaml", 4))
    other = HIGH._replace(controller="Club", place=Place("other.yaml", 5))
    united([*RANKED, ((2, 0), again), ((2, 0), other)], lambda *two: told.append(two))
    assert told == [("controller", HIGH, other)]


def test_contexts_stand_in_one_order() -> None:
    some = [Surroundings((name,)) for name in ("school", "care", "work", "home")]
    assert {joined(order).contexts for order in permutations(some)} == {("care", "home", "school", "work")}


def test_a_name_may_be_as_long_as_it_is_said_and_no_longer(tmp_path: Path) -> None:
    longest, bounds = "x" * 100, replace(BOUNDS, name=10)
    text = f"labels: 1\nnodes: {{/a: {{leak: [Video], author: {longest}, subjects: [{longest}]}}}}\n"
    (entry,) = read(tmp_path, text).entries
    assert entry.statements[0].author == longest
    for section in ("nodes: {/NAME: conduit}", "pins: {nodes: {/NAME: [Video]}}"):
        read(tmp_path, f"labels: 1\n{section.replace('NAME', 'n' * 9)}", bounds=bounds)
        with pytest.raises(InputErrors, match="bound"):
            read(tmp_path, f"labels: 1\n{section.replace('NAME', 'n' * 10)}", bounds=bounds)
