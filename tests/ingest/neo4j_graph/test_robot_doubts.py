"""The doubts of each robot in Neo4j, and what they leave of its verdict (rules S11, S12, S13)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.queries.library import find
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.fleet_files import policy, write
from tests.helpers.fleet_rows import VOCABULARY, rows

if TYPE_CHECKING:
    from neo4j import Driver


SETTLED = """labels: 1
nodes: {/camera: {source: [Video]}, /screen: conduit, /uplink: {leak: [Video]}}
channels: {/image: sensitive, /shout: sensitive}
"""


@pytest.fixture
def fleet_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Robots that are settled, two that are alike with a file that nobody read, one with a clock out of place.

    All write a channel that nobody known reads, three of them in one domain.
    """
    monkeypatch.chdir(tmp_path)
    for name, profiles in {
        "plain": ("/camera>/image,/shout", "/screen</image"),
        "lost/robot.policy": ("/camera>/image,/shout", "/screen</image"),
        "clock": ("/camera>/image,/shout,/x/clock", "/screen</image", "/uplink</x/clock"),
    }.items():
        write(f"{name}.xml", policy(*profiles))
    write("lost/part.xml", policy("/camera>/more").partition("<enclaves>")[2].partition("</enclaves>")[0])
    write("some.yaml", SETTLED.replace(", /uplink: {leak: [Video]}", ""))
    write("clock.yaml", SETTLED)
    write(
        "f.yaml",
        "fleet: 1\nname: f\nrobots:\n"
        "  plain: {policies: plain.xml, labels: some.yaml, domain: lab}\n"
        "  lost1: {policies: lost, labels: some.yaml, domain: lab}\n"
        "  lost2: {policies: lost, labels: some.yaml, domain: lab}\n"
        "  clock: {policies: clock.xml, labels: clock.yaml}\n",
    )
    return "f.yaml"


def told(file: str) -> dict[str, tuple[Any, list[str]]]:
    return {one.robot: (one.properties.get("verdict"), one.properties["doubts"]) for one in rows(file)}


SHOUT = "rides no-reader: domain lab:/shout ends at no known reader"
LOST = ("undetermined", ["breaks unread-file: lost/part.xml was not read", SHOUT])
PLACE = "at /x/clock, which is not a standard channel in its place"
EACH = {
    "plain": ("no-leak-found", [SHOUT]),
    "lost1": LOST,
    "lost2": LOST,
    "clock": (
        "undetermined",
        [
            f"breaks standard-closes: only the standard file closes a way out {PLACE}",
            "rides no-reader: /shout ends at no known reader",
        ],
    ),
    "domain lab": (None, [SHOUT]),
}


def test_a_doubt_is_about_the_robots_that_it_concerns(fleet_file: str) -> None:
    assert told(fleet_file) == EACH


def test_what_is_about_the_whole_fleet_is_a_doubt_of_each_robot(fleet_file: str) -> None:
    """A part that joins nothing lets data out: what gets there of a robot is known of none."""
    write("up.xml", policy("/lost>/note", "/uplink</note"))
    write("up.yaml", "labels: 1\nnodes: {/uplink: {leak: [Video]}}\n")
    write(
        fleet_file, Path(fleet_file).read_text("utf-8") + "infrastructure: {up: {policies: up.xml, labels: up.yaml}}\n"
    )
    line = (
        "breaks leak-joins-nothing: a domain or infrastructure in f.yaml that lets data out or keeps it joins nothing"
    )
    found = told(fleet_file)
    assert all(line in doubts for _, doubts in found.values())
    assert {verdict for verdict, _ in found.values()} == {"undetermined", None}


@pytest.mark.slow
@pytest.mark.database
def test_the_database_tells_them(fleet_file: str, driver: Driver) -> None:
    def stored(driver: Driver) -> dict[str, tuple[Any, list[str]]]:
        found = driver.execute_query("MATCH (r:Robot) RETURN r.name, r.verdict, r.doubts").records
        return {name: (verdict, doubts) for name, verdict, doubts in found}

    both = sorted([*EACH["clock"][1], *LOST[1]])
    rows_told = [
        ["no-leak-found", ["plain"], [SHOUT], 1],
        ["undetermined", ["clock", "lost1", "lost2"], both, 4],
    ]
    load(driver, rows(fleet_file), VOCABULARY)
    assert stored(driver) == EACH
    asked = driver.execute_query(find("verdicts").text).records
    columns = ("verdict", "some_robots", "doubts", "number_of_doubts")
    assert [[record[column] for column in columns] for record in asked] == rows_told
    answer_stored(driver, Settings())
    assert stored(driver) == EACH


@pytest.mark.database
def test_a_single_robot_has_all_doubts_of_its_answer(fleet_file: str, driver: Driver) -> None:
    del fleet_file
    load(driver, [robot_of("r", rosprivacy.analyze("lost", "some.yaml"))], VOCABULARY)
    for _ in range(2):
        (record,) = driver.execute_query("MATCH (r:Robot) RETURN r.verdict, r.doubts").records
        assert list(record) == ["undetermined", [LOST[1][0], "rides no-reader: /shout ends at no known reader"]]
        answer_stored(driver, Settings())
