"""Every example of ``docs/labels.md`` is run, and what the page says of it holds."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml

import rosprivacy
from tests.helpers.command import cli
from tests.helpers.fleet_files import policy
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from rosprivacy.result import Result
    from tests.helpers.command import Cli

__all__ = ["cli"]

PAGE = (ROOT / "docs" / "labels.md").read_text("utf-8")
TITLE, BLOCKS = "", dict[str, str]()
for part in re.split(r"^(?=#+ )", PAGE, flags=re.MULTILINE):
    TITLE = part.partition("\n")[0].lstrip("# ")
    for number, text in enumerate(re.findall(r"^```yaml\n(.*?)^```", part, re.MULTILINE | re.DOTALL)):
        BLOCKS[f"{TITLE} {number}" if number else TITLE] = text
ROWS = re.findall(r"^\| `(\{?nodes: .+)` \| ([a-z-]+) \|$", PAGE, re.MULTILINE)
MORE_ROWS = [
    ("nodes: {/uplink: {leak: [Video]}}", "leak"),
    ('nodes: {"/up*": {leak: [Video]}, /uplink: {conduit: [PersonalData]}}', "leak"),
    ('nodes: {"/up*": {leak: [PersonalData]}, /uplink: {leak: {none: [Video]}, conduit: [Video]}}', "no-leak-found"),
    ("nodes: {/uplink: {leak: [PersonalData], conduit: [Video]}}", "leak"),
    ("nodes: {/uplink: {leak: [Video], conduit: [Video]}}", "error"),
    ('{nodes: {/uplink: {leak: [Video]}}, channels: {"/vid*": mundane, /video: {only: [Video]}}}', "leak"),
    (
        "{nodes: {/camera: {source: {Video: [/video]}}, /uplink: {leak: [Video]}}, channels: {/video: mundane}}",
        "error",
    ),
    ("nodes: {/camera: {source: [ContactData]}, /uplink: {leak: [Location], conduit: [ContactData]}}", "leak"),
    ('nodes: {/camera: {source: [Video]}, "/cam*": {sanitizer: {Video: drop}}, /uplink: {leak: [Video]}}', "leak"),
    ('{nodes: {/uplink: {leak: [Video]}}, channels: {"/vid*": sensitive, "*ideo": {sensitive: [Video]}}}', "leak"),
    ("{nodes: {/uplink: {leak: [Video]}}, channels: {/video: {only: [PersonImage], never: [Video]}}}", "no-leak-found"),
    ("{nodes: {/uplink: {leak: [Video]}}, channels: {/video: {only: [Video], never: [PersonImage]}}}", "error"),
]
CODES = {"leak": 1, "no-leak-found": 0, "undetermined": 4, "error": 2}


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def run(block: str, *profiles: str, more: dict[str, Any] | None = None) -> Result:
    """The labels of a block on a system that has its names, with what the block leaves to others."""
    Path("p.xml").write_text(policy(*profiles), "utf-8")
    Path("l.yaml").write_text(BLOCKS[block], "utf-8")
    Path("more.yaml").write_text(json.dumps({"labels": 1, **(more or {})}), "utf-8")
    return rosprivacy.analyze("p.xml", ["l.yaml", "more.yaml"], categories=())


def carried(result: Result) -> dict[str, set[str]]:
    return {one.element.name: {*one.categories, *one.pseudonymised} for one in result.analysis.carried}


def test_each_block_has_a_test() -> None:
    assert set(BLOCKS) == {
        "Label files", "Where the system works", "Outside ROS", "Who, why, on which basis",
        "A glob answers for what you have seen", "A label ages", "By type",
    }  # fmt: skip
    assert len(ROWS) == PAGE.count("| no-leak-found |") + PAGE.count("| leak |\n") + PAGE.count("| error |")


@pytest.mark.parametrize(("labels", "answer"), [*ROWS, *MORE_ROWS])
def test_a_row_of_which_label_wins(cli: Cli, labels: str, answer: str) -> None:
    Path("p.xml").write_text(policy("/camera>/video", "/uplink</video"), "utf-8")
    said = {"labels": 1, "channels": {"/video": "sensitive"}, **yaml.safe_load(labels)}
    said["nodes"] = said["nodes"] if "source" in labels else {"/camera": {"source": ["Video"]}, **said["nodes"]}
    Path("l.yaml").write_text(json.dumps(said), "utf-8")
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert done.returncode == CODES[answer]
    assert answer == "error" or done.stdout.startswith(f"{answer}: ")


def test_the_first_file() -> None:
    result = run(
        "Label files", "/safety_camera>/safety_video,/faces_in", "/robot_camera>/robot_video,/robot_status",
        "/face_id>/faces</faces_in", "/blur>/clean</robot_video", "/mic>/voice,/map,/joy,/new_pose,/door_open",
        "/uplink>/out</voice,/safety_video", "/navigator</map", "/planner</voice,/map",
        "/nav>/plan,/other</safety_video",
        "/reader</map,/joy,/new_pose,/plan,/other,/out,/clean,/robot_status",
        more={"nodes": {"/mic": {"source": ["Voice", "Location", "HomeMap"]}}},
    )  # fmt: skip
    there = carried(result)
    assert "/robot_video" in there
    assert "/robot_status" not in there  # only through these channels
    assert there["/faces"] == {"Video", "FaceTemplate"}
    assert "/clean" not in there  # the blur ends it
    assert there["/out"] == there["/voice"]  # the uplink drops video
    assert {(f.category, f.leak.name) for f in result.analysis.findings} == {("Voice", "/uplink")}
    assert "/new_pose" not in there  # mundane
    assert there["/map"] == {"HomeMap"}  # these at most
    assert there["/joy"] == {"Voice", "HomeMap"}  # never Location
    assert "/plan" not in there  # the flow carries no video
    assert there["/other"] == {"Video"}
    asked = {question.element.name: set(question.categories) for question in result.analysis.open}
    assert "/safety_video" not in asked  # reviewed
    assert "/navigator" not in asked  # for every category
    assert asked["/planner"] == {"Voice", "HomeMap"}  # but not Location
    assert "std_msgs/msg/Bool" in str(result.analysis.types)


def test_where_the_system_works() -> None:
    result = run("Where the system works", "/camera>/video", "/viewer</video")
    (where,) = [row for row in result.document()["surroundings"] if row["element"]["name"] == "/camera"]
    assert set(where["contexts"]) == {"care", "school", "workplace"}
    assert where["country"] == "DE"


def test_what_a_type_is_made_for() -> None:
    nodes = {
        "/camera": {"source": ["Video"]},
        "/planner": "conduit",
        "/base": "conduit",
        "/uplink": {"leak": ["Video"]},
    }
    stated = {"/cmd_vel": {"types": ["geometry_msgs/msg/Twist"]}, "/image": "sensitive"}
    profiles = ["/camera>/image", "/planner>/cmd_vel</image", "/base>/odom</cmd_vel", "/uplink</odom"]
    result = run("By type", *profiles, more={"nodes": nodes, "channels": stated})
    assert "/cmd_vel" not in carried(result)
    assert ("by-type-closes", "/cmd_vel") in [(one.name, one.element and one.element.name) for one in result.doubts]
    result = run("By type", *profiles, "/joystick>/cmd_vel", more={"nodes": nodes, "channels": stated})
    assert "by-type-lapsed" in {one.name for one in result.doubts}  # another writer than when it was pinned


def test_what_lies_outside_ros() -> None:
    result = run(
        "Outside ROS", "/camera_driver>/image", "/detector>/boxes", "/recorder</image", "/door_opener>/door",
        more={"nodes": {"/camera_driver": {"source": ["Video"]}}},
    )  # fmt: skip
    there = carried(result)
    assert "Video" in there["/detector"]  # through the ring that both share
    assert there["/door_opener"] == {"Location"}  # what the badge reader brings in
    assert there["footage"] == {"Video"}
    found = {(f.kind, f.category, f.leak.name) for f in result.analysis.findings}
    assert ("storage-limitation", "Video", "footage") in found  # retention and backups are more than the limit
    assert ("disclosure", "Video", "fleet cloud") in found  # another system is a leak unless a label says otherwise
    assert not any(kind == "third-country-transfer" for kind, *_ in found)  # on standard clauses


@pytest.mark.parametrize("country", ["CA", "JP", "US", "KR", "CN"])
def test_decisions_that_cover_some_recipients_only_need_an_adequacy_that_is_stated(country: str) -> None:
    partly = re.search(r"cover some recipients only \(([A-Z, ]+)\)", PAGE)
    assert partly
    for transfer in ("", ", transfer: adequacy"):
        outside = f"elements: {{out: {{kind: external-system, country: {country}{transfer}}}}}\n"
        Path("p.xml").write_text(policy("/camera>/video", "/uplink</video"), "utf-8")
        nodes = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: conduit}\nflows: [{from: /uplink, to: out}]\n"
        Path("l.yaml").write_text(nodes + outside, "utf-8")
        kinds = {f.kind for f in rosprivacy.analyze("p.xml", "l.yaml").analysis.findings}
        needs = country in partly[1].split(", ") and not transfer
        assert ("third-country-transfer" in kinds) == (needs or country == "CN"), transfer


@pytest.mark.parametrize(("more", "asked"), [((), set()), (("/uploader</image",), {"/uploader"})])
def test_a_glob_answers_for_what_somebody_has_seen(more: tuple[str, ...], asked: set[str]) -> None:
    system = ("/camera>/image", "/planner>/cmd</image", "/recorder</image", *more)
    result = run("A glob answers for what you have seen", *system)
    assert {question.element.name for question in result.analysis.open} == asked


def test_who_why_and_on_which_basis() -> None:
    result = run("Who, why, on which basis", "/microphone>/audio", "/speech</audio")
    said = {row["element"]["name"]: row for row in result.document()["processing"] if row.get("element")}
    assert "calls for help" in str(said["/microphone"])
    assert "6(1)(d)" in str(said["/microphone"])
    assert "standard-clauses" in str([facts.transfer for facts in result.analysis.outside.values()])
    assert "Haven Care Home gGmbH" in json.dumps(result.document(), ensure_ascii=False)


def test_a_label_ages() -> None:
    Path("p.xml").write_text(policy("/camera>/image", "/blur>/clean</image", "/uplink</clean"), "utf-8")
    nodes = {
        "/camera": {"source": ["Video"]},
        "/blur": {"sanitizer": {"Video": "anonymise"}},
        "/uplink": {"leak": ["Video"]},
    }
    pins = yaml.safe_load(BLOCKS["A label ages"])
    Path("l.yaml").write_text(json.dumps({"labels": 1, "nodes": nodes, **pins}), "utf-8")
    result = rosprivacy.analyze("p.xml", ["l.yaml"], categories=())
    assert "code-not-read" in {doubt.name for doubt in result.doubts}
