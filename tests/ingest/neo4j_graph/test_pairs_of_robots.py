"""Findings from robot to robot, which grow with the square of the robots: what is worked out and written (rule S10)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.answering import answer
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet
from tests.helpers.fleet_files import policy, write

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.neo4j_graph.fleet_rows import FleetRows
    from tests.helpers.command import Cli

ROBOTS = tuple(f"r{i}" for i in range(4))
PAIRS = len(ROBOTS) * (len(ROBOTS) - 1)
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"
ACCEPTED = "decision: accept, reason: agreed, owner: me, legal_basis: [6(1)(a)]"
REMEMBERED = "made_about: {view: declared, disjoint_paths: 7}"


@pytest.fixture(params=["different", "alike"])
def fleet(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Robots of one domain; where they differ, a camera has two ways to its own uplink and one to each other."""
    monkeypatch.chdir(tmp_path)
    write("l.yaml", LABELS)
    own = {robot: f",/of_{robot}" if request.param == "different" else "" for robot in ROBOTS}
    for robot in ROBOTS:
        write(f"{robot}.xml", policy(f"/camera>/image{own[robot]}", f"/uplink</image{own[robot]}"))
    robots = {
        robot: {"model": "m", "policies": f"{robot}.xml", "labels": "l.yaml", "domain": "lab"} for robot in ROBOTS
    }
    write("f.yaml", json.dumps({"fleet": 1, "models": {"m": {}}, "robots": robots}))
    return "f.yaml"


def made(fleet: str, most_across: int) -> FleetRows:
    question = question_of(Settings())._replace(every=True, most_across=most_across)
    system = fleet_system(fleet, question)
    return rows_of_fleet(system, question, answer(system, question))


def ends(rows: FleetRows) -> dict[tuple[str, str], int | None]:
    """(Robot of the source, of the leak) -> number of ways."""
    every = list(rows)
    robot_of = {row["id"]: one.robot for one in every for row in one.elements}
    return {
        (one.robot, robot_of[row["target"]]): row["properties"]["disjoint_paths"]
        for one in every
        for row in one.findings
    }


def told(cli: Cli, *arguments: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(cli("analyze", *arguments, "-f", "json").stdout)
    return document


def test_ways_are_counted_on_a_robot_and_not_from_robot_to_robot(fleet: str) -> None:
    rows = made(fleet, 100)
    found = ends(rows)
    assert rows.left_out == 0
    assert len(found) == PAIRS + len(ROBOTS)
    assert None not in {found[robot, robot] for robot in ROBOTS}
    assert {number for (one, other), number in found.items() if one != other} == {None}


def test_of_many_pairs_each_robot_has_one_that_begins_and_one_that_ends_there(fleet: str) -> None:
    rows = made(fleet, 3)
    across = [pair for pair in ends(rows) if pair[0] != pair[1]]
    assert rows.left_out + len(across) == PAIRS
    assert len(across) <= 2 * len(ROBOTS)
    assert {one for one, _ in across} == {other for _, other in across} == set(ROBOTS)


def test_what_a_report_shows_is_counted_whoever_decided_about_what(fleet: str, cli: Cli) -> None:
    write("d.yaml", f"decisions: 1\nfindings:\n  - {{category: Voice, {ACCEPTED}}}\n")
    plain, decided, listed = (
        {(f["leak"]["robot"] == f["source"]["robot"], f["disjoint_paths"]) for f in told(cli, *more)["findings"]}
        for more in (
            ("--fleet", fleet),
            ("--fleet", fleet, "--decisions", "d.yaml"),
            ("--fleet", fleet, "--decisions", "d.yaml", "--paths", "disjoint"),
        )
    )
    assert plain == decided == listed
    assert (False, 1) in plain


@pytest.mark.parametrize("fleet", ["different"], indirect=True)
def test_a_number_that_was_not_counted_is_no_change_of_what_was_decided_about(fleet: str, cli: Cli) -> None:
    question = question_of(Settings())._replace(every=True)
    findings = answer(fleet_system(fleet, question), question).analysis.findings
    across = [one for one in findings if one.source.robot != one.leak.robot]
    own = [one for one in findings if one.source.robot == one.leak.robot]
    assert [one.number_of_paths for one in own] == [2] * len(ROBOTS)
    for one, changed in ((across[-1], False), (own[0], True)):
        write("d.yaml", f"decisions: 1\nfindings:\n  - {{id: {one.id}, {ACCEPTED}, {REMEMBERED}}}\n")
        document = told(cli, "--fleet", fleet, "--decisions", "d.yaml")
        assert sum(pattern["accepted"] for pattern in document["fleet"]["patterns"]) == 1
        assert any("disjoint paths: 7 then, 2 now" in said["message"] for said in document["diagnostics"]) is changed
