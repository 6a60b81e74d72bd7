"""What weighs most is told and asked first, everywhere that people read: suggestions, questions, findings, reports."""

from __future__ import annotations

import json
import re
from html import unescape
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.model import FORMS
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE
from rosprivacy.explorer.session import Session
from rosprivacy.ontology.vocabulary import load
from tests.helpers.asked_by_keys import ask, robot_of
from tests.helpers.command import cli

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from tests.helpers.command import Cli
    from tests.helpers.little_robots import Nodes

__all__ = ["cli"]

NODES: Nodes = {
    "amcl": (["/particle_cloud"], ["/scan"]),
    "audio_capture": (["/audio"], []),
    "camera": (["/camera/image_raw", "/camera/depth/image", "/tf_static"], []),
    "lidar": (["/scan"], []),
    "map_server": (["/map"], []),
    "viewer": ([], ["/map", "/scan", "/audio", "/camera/image_raw"]),
}
TYPES = """labels: 1
author: Ada
topics:
  /particle_cloud: {types: [nav2_msgs/msg/ParticleCloud]}
  /audio: {types: [audio_common_msgs/msg/AudioStamped]}
  /camera/image_raw: {types: [sensor_msgs/msg/Image]}
  /camera/depth/image: {types: [sensor_msgs/msg/Image]}
  /tf_static: {types: [tf2_msgs/msg/TFMessage]}
  /scan: {types: [sensor_msgs/msg/LaserScan]}
  /map: {types: [nav_msgs/msg/OccupancyGrid]}
"""
FIRST = [("/camera", "Video"), ("/audio_capture", "Voice"), ("/lidar", "LaserScan")]  # what is likely
LABELLED = """labels: 1
nodes:
  /camera: {source: [Video, BodyPose]}
  /audio_capture: {source: [Voice]}
  /map_server: {source: [HomeMap]}
  /badge_reader: {source: [StaffBadge]}
  /scale: {source: [VitalSign]}
  /finder: {source: [FaceTemplate]}
  /viewer: {leak: [PersonalData]}
flows:
  - {from: /camera, to: disk}
  - {from: /camera, to: cloud}
elements:
  cloud: {kind: external-system, country: DE}
  disk: {kind: storage, country: DE, retention: P1D, leak: [Video]}
"""
WORKERS = ("camera", "audio_capture", "map_server", "badge_reader", "scale", "finder")
FOUND = [  # by Article 9, then from what a sensor sees or hears to what is worked out; others before a file
    ("VitalSign", "/viewer"),
    ("FaceTemplate", "/viewer"),
    ("Video", "cloud"),
    ("Video", "/viewer"),
    ("Video", "disk"),
    ("Voice", "/viewer"),
    ("HomeMap", "/viewer"),
    ("BodyPose", "cloud"),
    ("BodyPose", "/viewer"),
    ("StaffBadge", "/viewer"),
]


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, TYPES)


@pytest.fixture
def leaking(tmp_path: Path) -> Path:
    nodes: Nodes = {name: ([f"/{name}/out"], []) for name in WORKERS}
    return robot_of(tmp_path, {**nodes, "viewer": ([], [f"/{name}/out" for name in WORKERS])}, LABELLED)


def places(text: str, names: Sequence[str]) -> list[int]:
    return [text.index(name) for name in names]


def test_every_data_type_of_the_ontology_has_a_place_in_the_order() -> None:
    forms = load().categories["PersonalData"].data_types
    assert sorted(FORMS) == sorted(forms)


def test_the_order_of_kinds_follows_from_the_law_and_from_what_a_sensor_sees_or_hears() -> None:
    kinds = load().categories
    wanted = ["Health", "FaceTemplate", "Video", "Voice", "FaceImage", "SpeechTranscript", "HomeMap", "BodyPose"]
    wanted += ["StaffBadge"]
    weights = [kinds[name].weight for name in wanted]
    assert weights == sorted(set(weights))
    assert kinds["CriminalConviction"].weight < kinds["FaceTemplate"].weight, "Article 10 counts as Article 9"


def test_suggestions_stand_by_confidence_and_then_by_weight(cli: Cli, robot: Path) -> None:
    """The camera's video before body pose, and before the point cloud of a node that is called earlier."""
    document = json.loads(cli("suggest", "p.xml", "-l", "l.yaml", "-f", "json", cwd=robot).stdout)
    sources = [one for one in document["suggestions"] if one["role"] == SOURCE]
    assert [(one["name"], one["kind"]) for one in sources[: len(FIRST)]] == FIRST
    sure = [one["confidence"] for one in sources]
    assert sure == sorted(sure), "likely stands before may"
    kinds = load().categories
    ends = [one for one in document["suggestions"] if one["role"] in (SOURCE, LEAK) and one["confidence"] == "may"]
    assert [kinds[one["kind"]].weight for one in ends] == sorted(kinds[one["kind"]].weight for one in ends)
    text = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    told = [re.split(r"  +", line.strip()) for line in text.splitlines() if line.startswith("  node ")]
    assert [(row[1], row[2]) for row in told if row[2].startswith("source")][:3] == [
        (name, f"source {kind}") for name, kind in FIRST
    ]
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
    comments = [line for line in (robot / "l.yaml").read_text("utf-8").splitlines() if '"source"' in line]
    assert [all(part in line for part in one) for line, one in zip(comments, FIRST, strict=False)] == [True] * 3


def test_questions_stand_so_too(cli: Cli, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = ask(cli, robot, "q", monkeypatch).stdout
    rows = re.findall(r"^  [A-Z]  node (\S+): (\w+)$", asked, re.MULTILINE)
    assert rows[: len(FIRST)] == FIRST
    assert ("/camera", "BodyPose") in rows[len(FIRST) :]


def test_findings_stand_by_weight_in_the_text_and_in_reports(cli: Cli, leaking: Path) -> None:
    findings = {(one.category, one.leak.name): one for one in _found(leaking)}
    exits = list(dict.fromkeys(leak for _, leak in FOUND))
    sources = list(dict.fromkeys(findings[one].source.name for one in FOUND))
    by_place = sorted(FOUND, key=lambda one: (exits.index(one[1]), sources.index(findings[one].source.name)))
    text = cli("analyze", "p.xml", "-l", "l.yaml", cwd=leaking).stdout
    assert re.findall(r"^ *(\d+)\. (.+?): ", text, re.MULTILINE) == [(str(n), leak) for n, leak in enumerate(exits, 1)]
    whole = cli("analyze", "p.xml", "-l", "l.yaml", "-v", cwd=leaking).stdout
    order = [findings[one].id for one in by_place]
    assert re.findall(r"\[([0-9a-f]{16})\]", text.partition("What the law")[0]) == order
    assert re.findall(r"\[([0-9a-f]{16})\]", whole.partition("What the law")[0]) == order * 2  # the list, the details
    document = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "-f", "json", cwd=leaking).stdout)
    keys = [(one["category"], one["source"]["name"], one["leak"]["name"]) for one in document["findings"]]
    assert [one[0] for one in keys] == sorted(one[0] for one in keys), "the contract: sorted by category"


@pytest.mark.parametrize("form", ["markdown", "html"])
def test_the_decisions_and_the_cards_of_a_report_stand_by_weight(cli: Cli, leaking: Path, form: str) -> None:
    page = unescape(cli("report", "p.xml", "-l", "l.yaml", "-f", form, cwd=leaking).stdout)
    kinds = load().categories
    titles = [kinds[name].text("title", "en") for name in dict.fromkeys(kind for kind, _ in FOUND)]
    cards = page[page.index("### 1" if form == "markdown" else 'class="decide"') :]  # below what is to be known first
    assert places(cards.casefold(), titles) == sorted(places(cards.casefold(), titles))
    ids = {(one.category, one.leak.name): one.id for one in _found(leaking)}
    exits = [leak for _, leak in FOUND]
    in_cards = sorted(FOUND, key=lambda one: exits.index(one[1]))  # a card for each place of exit
    named = [ids[one] for one in in_cards] if form == "html" else [f". `{exit_}`" for exit_ in dict.fromkeys(exits)]
    assert places(cards, named) == sorted(places(cards, named))


def _found(folder: Path) -> Sequence[rosprivacy.Finding]:
    return rosprivacy.analyze(folder / "p.xml", folder / "l.yaml").findings


def test_of_what_is_alike_in_the_review_the_heaviest_kind_is_asked_about_first(robot: Path, cli: Cli) -> None:
    """S11: frontier, then distance; only then the weight. Nodes that are alike but for what they get."""
    ends: Nodes = {"a_end": ([], ["/map"]), "b_end": ([], ["/camera/image_raw"])}
    begins = {name: NODES[name] for name in ("camera", "map_server")}
    robot_of(
        robot, begins | ends, "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /map_server: {source: [HomeMap]}\n"
    )
    asked = [one.name for one in Session.open([str(robot / "p.xml")], [str(robot / "l.yaml")]).questions()]
    assert asked[:2] == ["/b_end", "/a_end"]
    text = cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    assert text.index("/b_end") < text.index("/a_end")
