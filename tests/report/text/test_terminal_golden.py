"""The report as a terminal shows it, at 80 and 120 columns, as golden files (users.md, B2, B4).

``python -m tests.report.terminal.test_terminal_golden`` writes them anew; look at the difference.
"""

from __future__ import annotations

import os
from contextlib import chdir
from functools import cache
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from rich.console import Console

import rosprivacy
from rosprivacy.report.finding_order import in_order
from rosprivacy.report.text.analysis import print_report, report_text, verdict_line
from rosprivacy.report.text.finding_lines import details, law_lines
from rosprivacy.report.text.lines import wrapped
from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import COSTMAP, MEMORY, TURTLEBOT3

if TYPE_CHECKING:
    from tests.helpers.command import Cli

GOLDEN = ROOT / "tests" / "cases" / "terminal"
WIDTHS = (80, 120)
HOME = ("care-home/care-home.policy.xml", "care-home/care-home.labels.yaml")
SYSTEMS = {
    "factory-run1": ("factory/before.policy.xml", "factory/run1.labels.yaml"),
    "factory-run2": ("factory/before.policy.xml", "factory/run2.labels.yaml"),
    "factory-run5": ("factory/after.policy.xml", "factory/run5.labels.yaml"),
    "care-home": HOME,
    "fleet": ("fleet/fleet.yaml",),
}


@cache
def document(name: str) -> dict[str, Any]:
    given = SYSTEMS[name]
    with chdir(ROOT / "examples"):
        result = rosprivacy.analyze(*given) if given[1:] else rosprivacy.analyze_fleet(given[0])
    return result.document()


@cache
def turtlebot3(corpus: Path) -> dict[str, Any]:
    with chdir(corpus):
        return rosprivacy.analyze(TURTLEBOT3, rosprivacy.parse_labels(COSTMAP + MEMORY)).document()


def printed(report: dict[str, Any], width: int | None, **options: Any) -> str:
    text = StringIO()
    print_report(Console(file=text, highlight=False, emoji=False), report, width=width, **options)
    return text.getvalue()


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", SYSTEMS)
def test_the_report_is_the_golden_one(name: str, width: int) -> None:
    assert printed(document(name), width) == (GOLDEN / f"{name}-{width}.txt").read_text("utf-8")


@pytest.mark.parametrize("width", WIDTHS)
def test_turtlebot3_is_the_golden_one(corpus: Path, width: int) -> None:
    assert printed(turtlebot3(corpus), width) == (GOLDEN / f"turtlebot3-{width}.txt").read_text("utf-8")


@pytest.mark.parametrize("options", ["", "verbose", "quiet"])
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_file_gets_what_a_console_that_is_no_terminal_prints(name: str, options: str) -> None:
    report = document(name)
    how: dict[str, Any] = {options: True} if options else {}
    assert report_text(report, **how) == printed(report, None, **how)


@pytest.mark.parametrize("name", SYSTEMS)
def test_no_line_is_wider_than_the_terminal_but_for_one_long_name(name: str) -> None:
    for width in WIDTHS:
        for line in printed(document(name), width).splitlines():
            assert len(line) <= width or len(line.split()) == 1, line
            assert line == line.rstrip()


@pytest.mark.parametrize("name", SYSTEMS)
def test_wrapping_loses_and_adds_nothing(name: str) -> None:
    report = document(name)
    assert printed(report, 80).split() == printed(report, None).split()


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_verdict_stands_first_and_last_and_then_the_next_step(name: str) -> None:
    report = document(name)
    lines = printed(report, None).splitlines()
    last = lines[-2:] if lines[-1].startswith("Next: ") else lines[-1:]
    assert lines[0] == last[0] == verdict_line(report)[0]
    assert (len(last) == 2) == (report["verdict"] != "no-leak-found")


def test_of_more_than_five_findings_there_is_a_line_each() -> None:
    report = document("fleet")
    assert len(report["findings"]) == 6
    text = printed(report, None)
    assert "\nFindings: 6\n" in text
    assert "   | publishes" not in text
    assert "1 robot unfiltered and 23 robots pseudonymised" in text
    assert "rosprivacy show ID" in text
    assert "     | publishes" in printed(report, None, verbose=True)
    assert "\nFindings:" not in printed(document("care-home"), None)


def test_what_stands_before_what_is_dismissed_and_data_as_it_is_before_pseudonymised() -> None:
    order = [
        (f["dismissed"], f["accepted"], f["pseudonymised"])
        for f in in_order(document("fleet")["findings"], document("fleet"))
    ]
    assert order == sorted(order)
    assert not order[0][0]
    assert order[-1][0]


def test_the_law_stands_once_for_each_kind() -> None:
    report = document("factory-run2")
    assert len(report["findings"]) == 2
    assert printed(report, None).count("when it is processed to deduce data of a kind") == 1


def test_services_are_told_in_words() -> None:
    text = printed(document("care-home"), None)
    assert "/care_planner  (node, conduit of FaceTemplate)\n     | asks  " in text
    assert not any(f"| {raw}" in text for raw in ("request", "reply", "call", "execute"))


def test_elements_to_review_are_counted_without_legs() -> None:
    report = document("factory-run2")
    assert len(report["open"]) == 6
    assert ", 4 elements to review (6 counting the legs of services and actions), " in printed(report, None)


# ---------------------------------------------------------------- show


def test_show_prints_one_finding_and_the_law_of_its_kind(cli: Cli) -> None:
    done = cli("show", "59dc", HOME[0], "-l", HOME[1], cwd=ROOT / "examples")
    assert (done.returncode, done.stderr) == (0, "")
    report = document("care-home")
    (finding,) = [one for one in report["findings"] if one["id"].startswith("59dc")]
    lines = wrapped([*details(report, [finding]), *law_lines(report, [finding])], None)
    assert done.stdout == "".join(f"{text}\n" for text, _ in lines)
    assert "GDPR Art. 9(1) biometric data" in done.stdout
    assert "Voice" not in done.stdout


def test_show_takes_the_id_of_a_pattern_and_writes_json(cli: Cli) -> None:
    pattern = document("fleet")["fleet"]["patterns"][0]
    done = cli("show", pattern["id"], "--fleet", "fleet/fleet.yaml", "-f", "json", cwd=ROOT / "examples")
    assert done.returncode == 0
    assert f'"id": "{pattern["finding"]}"' in done.stdout


def test_show_names_the_nearest_id(cli: Cli) -> None:
    done = cli("show", "59dc667b0ca44e00", HOME[0], "-l", HOME[1], cwd=ROOT / "examples")
    assert done.returncode == 2
    assert "did you mean 59dc667b0ca44e0f?" in done.stderr


if __name__ == "__main__":
    GOLDEN.mkdir(exist_ok=True)
    shared = Path(os.environ.get("ROSPRIVACY_CORPUS", ROOT.parent / "shared" / "corpus"))
    documents = {name: document(name) for name in SYSTEMS} | {"turtlebot3": turtlebot3(shared)}
    for called, told in documents.items():
        for columns in WIDTHS:
            (GOLDEN / f"{called}-{columns}.txt").write_text(printed(told, columns), "utf-8")
