"""The report as text: no name can break it, no width loses a word; what it says is in the golden set."""

from __future__ import annotations

from functools import cache
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from rich.console import Console

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.report.text.analysis import print_report, report_text, verdict_line
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from tests.helpers.command import Cli

WIDTHS = (80, 120)
HOME = ("care-home/care-home.policy.xml", "care-home/care-home.labels.yaml")
SYSTEMS = {
    "factory-run1": ("factory/before.policy.xml", "factory/run1.labels.yaml"),
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


def printed(report: dict[str, Any], width: int | None, **options: Any) -> str:
    text = StringIO()
    print_report(Console(file=text, highlight=False, emoji=False), report, width=width, **options)
    return text.getvalue()


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_file_gets_what_a_console_that_is_no_terminal_prints(name: str) -> None:
    report = document(name)
    for verbose, quiet in ((False, False), (True, False), (False, True)):
        text = report_text(report, verbose=verbose, quiet=quiet)
        assert text == printed(report, None, verbose=verbose, quiet=quiet)
    assert report_text(report, quiet=True) == f"{verdict_line(report)[0]}\n"
    assert len(report_text(report, verbose=True)) > len(report_text(report))


@pytest.mark.parametrize("name", SYSTEMS)
def test_no_line_is_wider_than_the_terminal_but_for_one_long_name_and_no_word_is_lost(name: str) -> None:
    report = document(name)
    for width in WIDTHS:
        text = printed(report, width)
        assert text.split() == printed(report, None).split()
        for line in text.splitlines():
            assert len(line) <= width or len(line.split()) == 1, line
            assert line == line.rstrip()


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_verdict_stands_first_and_last_and_then_the_next_step(name: str) -> None:
    report = document(name)
    lines = printed(report, None).splitlines()
    last = lines[-2:] if lines[-1].startswith("Next: ") else lines[-1:]
    assert lines[0] == last[0] == verdict_line(report)[0]
    assert (len(last) == 2) == (report["verdict"] != "no-leak-found")


def test_the_channels_of_the_infrastructure_file_are_not_said_to_be_the_standard_files() -> None:
    """S13: what was taken away is told with whose word it was."""
    with chdir(ROOT / "examples" / "factory"):
        result = rosprivacy.analyze("before.policy.xml", ["run1.labels.yaml", "rosprivacy:infrastructure"])
    for form in ("text", "markdown"):
        assert ", or by rosprivacy:infrastructure" in result.to(form)


def test_names_cannot_break_the_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Control characters, rich's markup, line ends, right-to-left marks, 4,000 characters."""
    name = "/[bold]x[/bold]&#10;leak: &#x202E;" + "a" * 4000
    profile = f'<profile ns="/" node="a"><topics publish="ALLOW"><topic>{name}</topic></topics></profile>'
    monkeypatch.chdir(tmp_path)  # files have short names
    policy = Path("p.xml")
    enclave = f'<enclave path="/"><profiles>{profile}</profiles></enclave>'
    policy.write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>')
    labels = Path("l.yaml")
    labels.write_text("labels: 1\nnodes: {/a: {source: [Video]}}\n")
    lines = printed(rosprivacy.analyze([str(policy)], [str(labels)]).document(), None, verbose=True).splitlines()
    named = [line for line in lines if "[bold]" in line]
    assert named
    for shown in named:
        assert shown.isprintable()
        assert "\\n" in shown
        assert len(shown) < 400
    assert not any(line.startswith("leak:") for line in lines)


def test_show_takes_the_id_of_a_pattern_and_names_the_nearest_id(cli: Cli) -> None:
    pattern = document("fleet")["fleet"]["patterns"][0]
    done = cli("show", pattern["id"], "--fleet", "fleet/fleet.yaml", "-f", "json", cwd=ROOT / "examples")
    assert done.returncode == 0
    assert f'"id": "{pattern["finding"]}"' in done.stdout
    done = cli("show", "59dc667b0ca44e00", HOME[0], "-l", HOME[1], cwd=ROOT / "examples")
    assert done.returncode == 2
    assert "59dc667b0ca44e0f" in done.stderr
