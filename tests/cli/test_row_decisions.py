"""``rosprivacy decide --row``: about the findings that end in a row of the register, those of that day and no other."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import refused
from tests.helpers.fleet_files import policy
from tests.helpers.rows import written

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

POLICY = policy("/door_camera>/a", "/hall_camera>/a", "/uplink</a")
LABELS = """labels: 1
nodes:
  /door_camera: {source: [Video]}
  /hall_camera: {%s}
  /uplink: {leak: [Video, FaceTemplate]}
"""
SIGNED = ("--reason", "agreed", "--owner", "me", "--legal-basis", "6(1)(f)", "--expires", "2999-01-01")


@pytest.fixture
def folder(cli: Cli, tmp_path: Path) -> Path:
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "l.yaml").write_text(LABELS % "source: [Video]")
    report(cli, tmp_path)
    return tmp_path


def report(cli: Cli, folder: Path) -> dict[str, Any]:
    log = ("--decisions", "decisions.jsonl") if (folder / "decisions.jsonl").exists() else ()
    done = cli("analyze", "p.xml", "-l", "l.yaml", *log, "-f", "json", "-o", "r.json", cwd=folder)
    assert done.returncode in (0, 1, 4), done.stderr
    return dict(json.loads((folder / "r.json").read_text()))


def decide(cli: Cli, folder: Path, *arguments: str) -> str:
    done = cli("decide", *arguments, *SIGNED, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stderr


def accepted(document: dict[str, Any]) -> list[bool]:
    return [finding["accepted"] for finding in document["findings"]]


def test_a_row_is_decided_with_all_findings_that_end_there(cli: Cli, folder: Path) -> None:
    (row,) = report(cli, folder)["register"]
    assert len(row["findings"]) == 2
    assert "basis" not in decide(cli, folder, "accept", "--row", row["id"][:6], "--report", "r.json")
    document = report(cli, folder)
    assert accepted(document) == [True, True]
    (listed,) = document["decisions"]
    assert listed["target"] == {"row": row["id"]}
    assert not any("changed" in finding["decision"] for finding in document["findings"])
    assert sorted(listed["findings"]) == sorted(row["findings"])
    about = json.loads((folder / "decisions.jsonl").read_text())["about"]
    assert {"row", "policies", "labels", "law"} == about.keys()


def test_a_decisions_file_holds_rows_too(cli: Cli, tmp_path: Path) -> None:
    written(tmp_path)
    yaml = ("--decisions", "d.yaml")
    analyze = ("analyze", "p.xml", "-l", "l.json", "-f", "json", "-o", "r.json")
    cli(*analyze, cwd=tmp_path)
    rows = json.loads((tmp_path / "r.json").read_text())["register"]
    row = next(row for row in rows if row["places"] and row["places"][0]["name"] == "cabin")
    decide(cli, tmp_path, "accept", "--row", row["id"], "--report", "r.json", *yaml)
    decide(
        cli, tmp_path, "accept", "--row", row["id"], "--report", "r.json", *yaml, "--ticket", "T-1"
    )  # anew, in place
    assert (tmp_path / "d.yaml").read_text("utf-8").count(f"row: {row['id']}") == 1
    cli(*analyze, *yaml, cwd=tmp_path)
    document = json.loads((tmp_path / "r.json").read_text())
    assert {finding["id"] for finding in document["findings"] if finding["accepted"]} == set(row["findings"])
    assert not any("changed" in (finding["decision"] or {}) for finding in document["findings"])


def test_a_finding_that_comes_later_is_not_decided_with_the_row(cli: Cli, folder: Path) -> None:
    (folder / "l.yaml").write_text(LABELS % "conduit: [Video]")
    (row,) = report(cli, folder)["register"]
    decide(cli, folder, "accept", "--row", row["id"], "--report", "r.json")
    assert accepted(report(cli, folder)) == [True]
    (folder / "l.yaml").write_text(LABELS % "source: [Video]")
    document = report(cli, folder)
    assert sorted(accepted(document)) == [False, True]
    assert document["verdict"] == "leak"


def test_a_finding_is_accepted_only_where_its_row_is(cli: Cli, folder: Path) -> None:
    (row,) = report(cli, folder)["register"]
    one = row["findings"][0]
    decide(cli, folder, "accept", one, "--report", "r.json")
    assert sorted(accepted(report(cli, folder))) == [False, True]
    decide(cli, folder, "reject", "--row", row["id"], "--report", "r.json")
    document = report(cli, folder)
    assert accepted(document) == [False, False]
    assert {finding["decision"]["choice"] for finding in document["findings"]} == {"mitigate"}


def test_an_acceptance_of_a_row_is_told_what_it_lacks_before_it_is_written(cli: Cli, folder: Path) -> None:
    (row,) = report(cli, folder)["register"]
    said = cli(
        "decide", "accept", "--row", row["id"], "--report", "r.json", "--reason", "x", "--owner", "y", cwd=folder
    )
    assert said.stderr.count("Article 6(1)") == 1
    assert row["id"] in said.stderr


@pytest.mark.parametrize("row", ["ffff", "f", "0123456789abcdef"])
def test_a_row_that_is_not_there_is_refused(cli: Cli, folder: Path, row: str) -> None:
    (line,) = refused(cli("decide", "accept", "--row", row, "--report", "r.json", *SIGNED, cwd=folder))
    assert "row" in line
    assert not (folder / "decisions.jsonl").exists()


def test_a_row_of_another_robot_is_orphaned(cli: Cli, folder: Path) -> None:
    said = decide(cli, folder, "accept", "--row", "0123456789abcdef")
    assert "not checked" in said
    document = report(cli, folder)
    assert accepted(document) == [False, False]
    assert any("orphaned" in one["message"] for one in document["diagnostics"])


def test_what_is_stated_of_the_place_now_is_compared_to_what_was(cli: Cli, tmp_path: Path) -> None:
    policy_file, labels = written(tmp_path)
    policy_file.rename(tmp_path / "p.xml")
    labels.rename(tmp_path / "l.yaml")
    rows = {row["places"][0]["name"]: row["id"] for row in report(cli, tmp_path)["register"] if row["findings"]}
    decide(cli, tmp_path, "accept", "--row", rows["cabin"], "--report", "r.json")
    before = {finding["id"]: finding for finding in report(cli, tmp_path)["findings"] if finding["accepted"]}
    assert not any("changed" in finding["decision"] for finding in before.values())
    text = (tmp_path / "l.yaml").read_text("utf-8")
    (tmp_path / "l.yaml").write_text(text.replace('"TN"', '"IN"'), "utf-8")
    after = [finding for finding in report(cli, tmp_path)["findings"] if finding["id"] in before]
    for finding in after:
        assert finding["accepted"]  # the kind of data and the place are the same: a person has to look again
        (change,) = finding["decision"]["changed"]
        assert change["what"] == "stated"
        assert ("country: TN" in change["before"], "country: IN" in change["now"]) == (True, True)
    assert len(after) == 2
