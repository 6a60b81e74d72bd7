"""``rosprivacy report`` as people call it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report.compare.changes import changes
from rosprivacy.report.compare.difference import difference
from rosprivacy.report.compare.snapshot import snapshot
from tests.helpers.graphs import hospital
from tests.helpers.paths import ROOT
from tests.helpers.reports import care, run

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli


def command(*arguments: str, cwd: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[bytes]:
    inherited = {**os.environ, "SOURCE_DATE_EPOCH": "1790000000", **environment}
    full = [sys.executable, "-m", "rosprivacy", "report", *arguments]
    return subprocess.run(full, cwd=cwd, env=inherited, capture_output=True, check=False)


SYSTEM = ["examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml"]


@pytest.mark.slow
def test_the_page_is_dated_as_the_environment_says() -> None:
    assert b"Made on 2026-09-21" in command(*SYSTEM).stdout
    refused = command(*SYSTEM, SOURCE_DATE_EPOCH="yesterday")
    assert (refused.returncode, refused.stderr.count(b"\n")) == (2, 1)


def test_it_is_utf8_whatever_the_terminal_is() -> None:
    done = command(*SYSTEM, "--lang", "de", LC_ALL="C", PYTHONUTF8="0", PYTHONIOENCODING="ascii")
    assert "Wohin personenbezogene Daten gelangen können" in done.stdout.decode("utf-8")


def renamed(document: dict[str, Any], old: str, new: str) -> dict[str, Any]:
    """As after another start; ids are made from names."""
    copied: dict[str, Any] = json.loads(json.dumps(document).replace(f'"{old}"', f'"{new}"'))
    for finding in copied["findings"]:
        if new in (finding["source"]["name"], finding["leak"]["name"]):
            finding["id"] = finding["id"][::-1]
    return copied


def test_names_that_are_made_up_at_each_start_are_no_change() -> None:
    for name in ("/recorder", "/uplink"):  # leaks of ways
        old = renamed(care(), name, f"{name}_5591c2d0")
        new = renamed(care(), name, f"{name}_55a1ff00")
        assert changes(old, new).nothing
        assert not changes(old, new).marks()
        other = changes(old, renamed(care(), name, f"{name}_of_somebody_else"))
        assert other.new
        assert other.removed


def test_what_is_the_same_is_the_same_for_diff() -> None:
    """One implementation of what elements and findings are told apart by."""
    old, new = renamed(care(), "/recorder", "/recorder_10000"), renamed(run(2), "/archive_server", "/other")
    for before, now in ((old, care()), (care(), new), (run(1), run(2)), (run(2), run(1))):
        report, diff = changes(before, now), difference(snapshot(before, None), snapshot(now, None))
        assert len(report.new) == len(diff["findings"]["new"])
        assert len(report.removed) == len(diff["findings"]["gone"])


def test_a_fleet_has_the_same_ways_whichever_robot_is_shown() -> None:
    now = hospital().document()
    text = json.dumps(now).replace("carrier_01", "carrier_00")  # another robot comes first
    before = json.loads(text)
    for finding in before["findings"]:
        if finding["source"]["robot"] == "carrier_00":
            finding["id"] = finding["id"][::-1]
    ids = dict(zip([f["id"] for f in now["findings"]], [f["id"] for f in before["findings"]], strict=True))
    for pattern in before["fleet"]["patterns"]:
        pattern["finding"] = ids[pattern["finding"]]
    differ = changes(before, now)
    assert (differ.new, differ.removed, differ.opened, differ.closed) == ((), (), (), ())
    assert set(differ.changed.values()) == {("robots",)}


def test_it_is_written_to_a_file_and_compares_with_an_earlier_document(cli: Cli, tmp_path: Path) -> None:
    old = tmp_path / "old.json"
    old.write_text(json.dumps(run(3)))
    options = ("--since", old, "--title", "Care <robot>", "-o", tmp_path / "r.html")
    done = cli("report", *SYSTEM, *options, cwd=ROOT)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    text = (tmp_path / "r.html").read_text("utf-8")
    assert "Care &lt;robot&gt;" in text
    assert "What changed since the earlier report" in text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], b"name at least one policy"),
        (["--from-database", *SYSTEM], b"takes what is in the database"),
        ([*SYSTEM, "--since", "missing.json"], b"missing.json: not found; give what"),
        ([*SYSTEM, "--lang", "xx"], b"xx"),
    ],
)
def test_what_cannot_be_done_is_said(arguments: list[str], message: bytes) -> None:
    done = command(*arguments)
    assert done.returncode == 2
    assert message in done.stderr
    assert b"Traceback" not in done.stderr


@pytest.mark.slow
def test_it_is_called_as_the_policies_that_were_named_not_what_they_include(cli: Cli) -> None:
    text = cli("report", *SYSTEM, "-f", "markdown", cwd=ROOT).stdout
    assert "\nSystem: care-home.policy.xml\n" in text
    assert "node.xml" in text  # among the files that were read
    assert "\nSystem: the ward\n" in cli("report", *SYSTEM, "-f", "markdown", "--title", "the ward", cwd=ROOT).stdout
