"""The figures of docs/types.md: TurtleBot3 and the live example without and with limits of types (rule S15)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.ingest.types import TABLE
from rosprivacy.report.naming import count_rows
from tests.helpers.fleet_files import policy
from tests.helpers.observed import node_info
from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import COSTMAP, TURTLEBOT3, TYPES

if TYPE_CHECKING:
    from tests.helpers.command import Cli

Figures = tuple[str, str, str, str]
PAPER = "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations/categorization_turtlebot3_step_{}.json"
# The live example: a small robot with a camera, as ``ros2 node info`` tells of it, and a person's labels.
GRAPH = (
    node_info("/head/camera_driver", publishers="/head/camera/image_raw: sensor_msgs/msg/Image")
    + node_info(
        "/face_recognizer",
        subscribers="/head/camera/image_raw: sensor_msgs/msg/Image",
        publishers="/faces: hri_msgs/msg/IdsList",
    )
    + node_info(
        "/archive",
        subscribers="/faces: hri_msgs/msg/IdsList",
        service_servers="/save_footage: std_srvs/srv/SetBool",
    )
    + node_info(
        "/navigator",
        service_clients="/save_footage: std_srvs/srv/SetBool",
        action_servers="/navigate_to_pose: nav2_msgs/action/NavigateToPose",
    )
)
ROBOT = """labels: 1
nodes:
  /archive: {leak: [Video, PersonIdentifier]}
  /face_recognizer: {source: [PersonIdentifier]}
  /head/camera_driver: {source: [Video]}
"""
MORE = "channels: {/faces: {only: [PersonIdentifier]}}\nservices: {/save_footage: mundane}\n"
LAMP = """labels: 1
nodes: {/camera: {source: [Video]}, /cloud: {leak: [Video]}}
channels: {/motion: {types: [std_msgs/msg/Bool]}}
"""


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def told() -> dict[tuple[str, str], Figures]:
    """The table of the page, by system and labels."""
    page = (ROOT / "docs" / "types.md").read_text("utf-8")
    rows = re.findall(r"\| ([^|]+) \| ([^|]+) \| (\d[^|]+) \| (\d[^|]+) \| (\d[^|]+) \| (\d+) \|\n", page)
    return {(row[0], row[1]): (row[2], row[3], row[4], row[5]) for row in rows}


def measured(policies: str, labels: list[str], **options: Any) -> Figures:
    without, under = (
        rosprivacy.analyze(policies, labels, type_limits=table, **options).document() for table in (None, TABLE)
    )
    first, second = ([(row["element"], row["categories"]) for row in one["open"]] for one in (without, under))
    assert first == second  # a type reviews nothing
    assert len(without["findings"]) == len(under["findings"]) + len(under["assumptions"]["closed_by_types"])

    def both(before: int, now: int) -> str:
        return f"{before} and {now}"

    return (
        both(len(without["findings"]), len(under["findings"])),
        both(count_rows(without["open"]).elements, count_rows(under["open"]).elements),
        both(len(without["carries"]), len(under["carries"])),
        str(under["assumptions"]["type_limits"]["flows"]),
    )


@pytest.mark.parametrize(
    ("name", "labels"),
    [
        ("sources and leaks", ROBOT),
        ("the same, with two more of a person", ROBOT + MORE),
    ],
)
def test_the_live_example(cli: Cli, name: str, labels: str) -> None:
    Path("graph.txt").write_text(GRAPH, "utf-8")
    Path("labels.yaml").write_text(labels, "utf-8")
    assert cli("observe", "--text", "graph.txt", "-o", "robot.policy.xml").returncode == 0
    figures = measured("robot.policy.xml", ["labels.yaml"], types="robot.types.yaml")
    assert figures == told()["the live example", name]


def test_a_lamp_that_follows_a_switch() -> None:
    Path("p.xml").write_text(policy("/camera>/motion", "/lamp</motion", "/cloud</motion"), "utf-8")
    Path("labels.yaml").write_text(LAMP, "utf-8")
    assert measured("p.xml", ["labels.yaml"]) == told()["a lamp that follows a switch", "sources and leaks"]


@pytest.mark.corpus
@pytest.mark.parametrize(
    ("kind", "name", "labels"),
    [
        ("Video", "the paper's first", PAPER.format(1)),
        ("Video", "the paper's fifth", PAPER.format(5)),
        ("HomeMap", "of the paper's map of costs", ""),
    ],
)
def test_turtlebot3(corpus: Path, kind: str, name: str, labels: str) -> None:
    """Its types are stated, since a profile `*` may write everything: what was seen says nothing of that one."""
    Path("types.yaml").write_text(TYPES, "utf-8")
    Path("costmap.yaml").write_text(COSTMAP, "utf-8")
    files = [str(corpus / labels) if labels else "costmap.yaml", "types.yaml"]
    figures = measured(str(corpus / TURTLEBOT3), files, **({"category": kind} if labels else {}))
    assert figures == told()[f"TurtleBot3, {kind}", name]
