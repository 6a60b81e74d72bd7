"""``rosprivacy decide --row`` on a fleet: about the robots of the row, or those that are named, and none that joins."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import refused
from tests.helpers.fleet_files import MODELS, policy, write

if TYPE_CHECKING:
    from tests.helpers.command import Cli

SIGNED = ("--reason", "agreed", "--owner", "me", "--legal-basis", "6(1)(f)", "--expires", "2999-01-01")
LOG = Path("decisions.jsonl")
FLEET = "fleet: 1\n" + MODELS + "groups: [{robots: 3, model: eye}]\nrobots: {odd: {model: eye%s}}\n"
JOINED = (
    "elements: {base: {kind: external-system, country: DE}}\n"
    "flows: [{from: '*:/uplink', to: base}, {from: base, to: '*:/uplink'}]\n"
)
EYE = (
    "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n"
    "elements: {disk: {kind: storage, country: DE, operator: Us, recipient: %s}}\n"
    "flows: [{from: /uplink, to: disk}]\n"
)
OWN = "labels: 1\nelements: {disk: {kind: storage, country: FR}}\n"
EYES = ["eye_1", "eye_2", "eye_3"]


@pytest.fixture(autouse=True)
def _four(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Four robots that are alike."""
    monkeypatch.chdir(tmp_path)
    write("eye.xml", policy("/camera>/image", "/uplink</image"))
    write("eye.yaml", EYE % "controller")
    write("wall.xml", policy("/receiver>/picture"))
    write("wall.yaml", "labels: 1\n")
    write("own.yaml", OWN)
    write("f.yaml", FLEET % "")


def report(cli: Cli, decisions: Path = LOG) -> dict[str, Any]:
    log = ("--decisions", decisions) if decisions.exists() else ()
    done = cli("analyze", "--fleet", "f.yaml", *log, "-f", "json", "-o", "r.json")
    assert done.returncode in (0, 1, 4), done.stderr
    return dict(json.loads(Path("r.json").read_text("utf-8")))


def decide(cli: Cli, *arguments: str) -> str:
    done = cli("decide", *arguments, *SIGNED)
    assert done.returncode == 0, done.stderr
    return done.stderr


def row_at(document: dict[str, Any], name: str, robot: str = "eye_1") -> dict[str, Any]:
    """The row of a place, on a robot."""
    return next(
        row
        for row in document["register"]
        if any(place["name"] == name for place in row["places"]) and robot in row["fleet"]["robots"]
    )


def accepted(document: dict[str, Any]) -> dict[tuple[str, bool], int]:
    """(name of the leak, whether from another robot) -> how many findings are accepted."""
    by_id = {finding["id"]: finding for finding in document["findings"]}
    patterns = document["fleet"]["patterns"]
    return {(by_id[p["finding"]]["leak"]["name"], p["across"]): p["accepted"] for p in patterns if p["accepted"]}


@pytest.mark.parametrize("file", ["decisions.jsonl", "d.yaml"])
def test_a_row_is_decided_on_all_its_robots_and_what_joins_stays_open(cli: Cli, file: str) -> None:
    named = ("--report", "r.json", "--decisions", file)
    row = row_at(report(cli), "disk")
    assert row["fleet"]["robots"] == [*EYES, "odd"]
    for written in (row["id"], row["fleet"]["pattern"][:8]):  # the second one says the same anew
        decide(cli, "accept", "--row", written, *named)
        document = report(cli, Path(file))
        assert accepted(document) == {("disk", False): 4}
        assert (row_at(document, "disk")["state"], row_at(document, "/uplink")["state"]) == ("accepted", "open")
    (entry,) = document["decisions"]
    assert entry["target"] == {"row": row["fleet"]["pattern"]}
    assert "changed" not in entry
    write("f.yaml", (FLEET % "").replace("robots: 3", "robots: 4"))
    document = report(cli, Path(file))
    assert accepted(document) == {("disk", False): 4}
    assert row_at(document, "disk")["state"] == "open"
    assert document["decisions"][0]["changed"] == [{"what": "robots", "before": "4", "now": "5, +eye_4"}]
    decide(cli, "accept", "--row", row_at(document, "disk")["id"], *named)
    assert accepted(report(cli, Path(file))) == {("disk", False): 5}


def test_what_comes_from_other_robots_is_part_of_the_row(cli: Cli) -> None:
    write("f.yaml", FLEET % "" + JOINED)
    row = row_at(report(cli), "/uplink")
    assert row["fleet"]["from_robots"] == [*EYES, "odd"]
    decide(cli, "accept", "--row", row["id"], "--report", "r.json")
    assert accepted(report(cli)) == {("/uplink", False): 4, ("/uplink", True): 12}
    write("f.yaml", (FLEET % "").replace("robots: 3", "robots: 4") + JOINED)
    assert accepted(report(cli)) == {("/uplink", False): 4, ("/uplink", True): 12}


def test_a_row_is_decided_on_the_robots_that_are_named(cli: Cli) -> None:
    row = row_at(report(cli), "disk")
    some = ("--row", row["id"], "--report", "r.json", "--robot", "eye_2", "--robot", "odd")
    decide(cli, "accept", *some)
    document = report(cli)
    assert document["decisions"][0]["target"] == {"row": row["fleet"]["pattern"], "robots": ["eye_2", "odd"]}
    assert accepted(document) == {("disk", False): 2}
    assert row_at(document, "disk")["state"] == "open"
    decide(cli, "accept", "--row", row["fleet"]["pattern"][:8], "--report", "r.json", "--robot", "eye_1")
    assert accepted(report(cli)) == {("disk", False): 3}
    write("f.yaml", (FLEET % "").replace("robots: 3", "robots: 4"))
    assert accepted(report(cli)) == {("disk", False): 3}


def test_what_is_stated_otherwise_of_a_place_is_a_row_of_its_own(cli: Cli) -> None:
    write("f.yaml", FLEET % ", labels: [own.yaml]")
    document = report(cli)
    here, there = row_at(document, "disk"), row_at(document, "disk", "odd")
    assert (here["fleet"]["robots"], there["fleet"]["robots"]) == (EYES, ["odd"])
    assert here["fleet"]["pattern"] == there["fleet"]["pattern"]
    (line,) = refused(cli("decide", "accept", "--row", here["fleet"]["pattern"], "--report", "r.json", *SIGNED))
    assert "2 ids of rows" in line
    decide(cli, "accept", "--row", here["id"], "--report", "r.json")
    document = report(cli)
    assert accepted(document) == {("disk", False): 3}
    assert [row_at(document, "disk", robot)["state"] for robot in ("eye_1", "odd")] == ["accepted", "open"]
    decide(cli, "accept", "--row", row_at(document, "disk", "odd")["id"], "--report", "r.json")
    assert accepted(report(cli)) == {("disk", False): 4}
    write("own.yaml", OWN.replace("FR", "ES"))
    changed = [one.get("changed") for one in report(cli)["decisions"]]
    assert changed[0] is None
    assert "country: FR" in changed[1][0]["before"]


def test_a_finding_is_accepted_only_where_every_row_of_it_is(cli: Cli) -> None:
    document = report(cli)
    row = row_at(document, "disk")
    pattern = next(p["id"] for p in document["fleet"]["patterns"] if p["finding"] in row["findings"])
    decide(cli, "accept", pattern, "--report", "r.json")
    decide(cli, "reject", "--row", row["id"], "--report", "r.json", "--robot", "eye_3")
    document = report(cli)
    assert accepted(document) == {("disk", False): 3}
    assert row_at(document, "disk")["state"] == "open"


def test_an_entry_that_would_decide_nothing_is_not_written(cli: Cli) -> None:
    row = row_at(report(cli), "disk")
    decide(cli, "accept", "--row", row["id"], "--report", "r.json", "--robot", "eye_2")
    before = LOG.read_bytes()
    (line,) = refused(cli("decide", "reject", "--row", row["id"], "--report", "r.json", *SIGNED))
    assert "line 1 decides about eye_2, too" in line
    assert LOG.read_bytes() == before
    decide(cli, "withdraw", "--row", row["fleet"]["pattern"], "--robot", "eye_2")  # as the message says
    decide(cli, "reject", "--row", row["id"], "--report", "r.json")
    assert accepted(report(cli)) == {}


@pytest.mark.parametrize("robots", [["eye_9"], ["eye_1", "wall_1"], ["eye_*", "odd"]])
def test_other_robots_are_refused(cli: Cli, robots: list[str]) -> None:
    row = row_at(report(cli), "disk")
    named = [part for robot in robots for part in ("--robot", robot)]
    done = cli("decide", "accept", "--row", row["id"], "--report", "r.json", *named, *SIGNED)
    assert done.returncode == 2
    assert not LOG.exists()


def test_questions_of_a_row_are_named_and_answers_are_kept(cli: Cli) -> None:
    write("eye.yaml", EYE % "processor")
    row = row_at(report(cli), "disk")
    target = ("--row", row["id"], "--report", "r.json")
    assert "--answer processor=TEXT" in decide(cli, "accept", *target)
    assert "--answer" not in decide(cli, "accept", *target, "--answer", "processor=DMS 12")
    (entry,) = report(cli)["decisions"]
    assert entry["answers"] == {"processor": "DMS 12"}
    assert [step.get("answers") for step in entry["history"]] == [None, {"processor": "DMS 12"}]
