"""``rosprivacy.analysis/2``: what it leaves out it names, and who compares documents reads it as the long one."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.answer import Answer
from tests.helpers.daily import one_in
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

CARE_HOME = (
    ROOT / "examples" / "care-home" / "care-home.policy.xml",
    "-l",
    ROOT / "examples" / "care-home" / "care-home.labels.yaml",
)
SYSTEMS = {"robot": CARE_HOME, "fleet": ("--fleet", ROOT / "examples" / "fleet" / "fleet.yaml")}


@pytest.mark.parametrize("asked", [(), ("--hangs-on",)])
@pytest.mark.parametrize("system", SYSTEMS)
def test_what_is_left_out_is_named_and_the_rest_is_as_in_the_long_one(
    cli: Cli, system: str, asked: tuple[str, ...]
) -> None:
    long, short = (
        json.loads(cli("analyze", *SYSTEMS[system], *asked, "-f", form).stdout) for form in ("json1", "json")
    )
    assert ("hangs_on" in short) == bool(asked)
    assert (long.pop("format"), short.pop("format")) == ("rosprivacy.analysis/1", "rosprivacy.analysis/2")
    long.pop("not_asked", None)
    for place in short.pop("left_out"):
        *above, key = place.split(".")
        held: Any = long[above[0]] if above else long
        held.pop(key, None)
    assert short == long


@pytest.mark.parametrize("system", one_in(2, SYSTEMS, in_ci=1))
def test_diff_reads_it_as_the_long_one(cli: Cli, tmp_path: Path, system: str) -> None:
    answers = []
    for form in ("json1", "json"):
        saved = tmp_path / f"{form}.json"
        cli("analyze", *SYSTEMS[system], "-f", form, "-o", saved)
        answers.append(cli("diff", saved, *CARE_HOME, "-f", "json").stdout)
    assert answers[0]
    assert answers[0] == answers[1]
    done = cli("diff", tmp_path / "json1.json", tmp_path / "json.json", "-f", "json")
    assert not json.loads(done.stdout)["worse"]


@pytest.mark.slow
def test_a_report_tells_changes_since_it(cli: Cli, tmp_path: Path) -> None:
    pages = []
    for form in ("json1", "json"):
        saved = tmp_path / "before.json"
        cli("analyze", *CARE_HOME, "--category", "Voice", "-f", form, "-o", saved)
        pages.append(cli("report", *CARE_HOME, "--since", saved, "-f", "markdown").stdout.splitlines())
    differ = [pair for pair in zip(*pages, strict=True) if pair[0] != pair[1]]
    assert all("SHA-256" in line or "before.json" in line for pair in differ for line in pair), differ
    assert len(pages[0]) > 100


@pytest.mark.parametrize("asked", [("-q",), ("-f", "json")])
def test_what_the_answer_hangs_on_is_not_worked_out_where_it_is_not_shown(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, asked: tuple[str, ...]
) -> None:
    worked_out: list[Answer] = []
    monkeypatch.setattr(Answer, "hangs_on", property(worked_out.append))
    cli("analyze", *CARE_HOME, *asked)
    assert not worked_out
    cli("analyze", *CARE_HOME, "-f", "json1")
    assert worked_out
