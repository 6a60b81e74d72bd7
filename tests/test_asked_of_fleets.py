"""What a fleet's answer says of what costs more than the analysis: worked out where asked, and told where not (S11)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.helpers.command import Cli

FLEET = ("--fleet", "examples/fleet/fleet.yaml")
ROBOT = ("examples/factory/before.policy.xml", "-l", "examples/factory/run2.labels.yaml")


def analysed(cli: Cli, *arguments: str) -> dict[str, Any]:
    told: dict[str, Any] = json.loads(cli("analyze", *arguments, "-f", "json1", cwd=ROOT).stdout)
    return told


def test_a_fleet_does_not_say_that_its_answer_hangs_on_nothing(cli: Cli) -> None:
    told = analysed(cli, *FLEET)
    assert "hangs_on" not in told
    assert told["not_asked"] == [{"key": "hangs_on", "option": "--hangs-on"}]
    assert rosprivacy.analyze_fleet(ROOT / FLEET[1]).hangs_on is None


def test_where_it_is_asked_for_a_fleet_says_what_its_answer_hangs_on(cli: Cli) -> None:
    told = analysed(cli, *FLEET, "--hangs-on")
    assert told["hangs_on"]
    assert "not_asked" not in told
    assert rosprivacy.analyze_fleet(ROOT / FLEET[1], hangs_on=True).hangs_on


@pytest.mark.parametrize("more", [(), ("--hangs-on",)])
def test_a_robot_says_so_in_any_case(cli: Cli, more: Sequence[str]) -> None:
    told = analysed(cli, *ROBOT, *more)
    assert told["hangs_on"]
    assert "not_asked" not in told


@pytest.mark.slow
@pytest.mark.parametrize("command", [("analyze",), ("report", "-f", "markdown"), ("report", "-f", "html")])
@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_people_read_which_option_asks(cli: Cli, command: Sequence[str], language: str) -> None:
    asked, told = (cli(*command, *FLEET, "--lang", language, *more, cwd=ROOT).stdout for more in (("--hangs-on",), ()))
    assert "--hangs-on" in told
    assert "--hangs-on" not in asked
