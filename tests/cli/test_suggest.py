"""``rosprivacy suggest`` and ``labels --accept``: questions, and nothing that nobody accepted."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.labelling.model_interview import Asking, Interview
from rosprivacy.labelling.suggested_lines import with_accepted, with_suggestions
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.command import LINE, cli, refused
from tests.helpers.little_robots import HOSTILE, Nodes, policy_of
from tests.helpers.model_server import answer, elements, said
from tests.helpers.paths import ROOT
from tests.helpers.planted_leaks import planted

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

CARE = ROOT / "examples" / "care-home" / "care-home.policy.xml"
SCHEMA = json.loads((ROOT / "docs" / "suggestions.schema.json").read_text("utf-8"))
IMAGE, IDS, STRING = "sensor_msgs/msg/Image", "hri_msgs/msg/IdsList", "std_msgs/msg/String"
POSE, TWIST, CLOUD = "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/Twist", "sensor_msgs/msg/PointCloud2"
DAY = "1767225600"
ROBOT: Nodes = {
    "camera": (["/a", "/b"], []),
    "finder": (["/c"], ["/a"]),
    "mover": (["/d"], ["/c"]),
    "customer_bridge": ([], ["/c", "/d"]),
}


def typed(**types: str) -> str:
    lines = "".join(f"  /{name}: {{types: [{said}]}}\n" for name, said in types.items())
    return f"labels: 1\ntopics:\n{lines}"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "p.xml").write_text(policy_of(ROBOT), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(a=IMAGE, b=CLOUD, c=IDS, d=TWIST), "utf-8")
    return tmp_path


def rows(cli: Cli, folder: Path, *more: str) -> list[tuple[str, str, str, str]]:
    """(name, role, kind and what is made of it, confidence)."""
    document = json.loads(cli("suggest", "p.xml", "-l", "l.yaml", "-f", "json", *more, cwd=folder).stdout)
    jsonschema.validate(document, SCHEMA)
    return [
        (one["name"], one["role"], " ".join([one["kind"], *(d["to"] for d in one["label"].get("derives", ()))]),
         one["confidence"])
        for one in document["suggestions"]
    ]  # fmt: skip


# ---------------------------------------------------------------- what is suggested


def test_types_tell_sources_derivations_and_what_drops_data(cli: Cli, robot: Path) -> None:
    found = rows(cli, robot)
    assert ("/camera", "source", "Video", "likely") in found
    assert ("/camera", "source", "PersonPointCloud", "may") in found
    assert ("/finder", "derivation", "Video PersonIdentifier", "likely") in found
    assert ("/finder", "sanitizer", "Video", "may") in found
    assert ("/mover", "sanitizer", "PersonIdentifier", "may") in found
    assert ("/customer_bridge", "leak", "PersonalData", "may") in found
    assert not [row for row in found if row[:2] == ("/finder", "source")]  # it reads images


def test_a_node_that_reads_what_it_writes_brings_nothing_in(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"a": (["/x"], []), "b": (["/y"], ["/x"])}), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(x=IMAGE, y="sensor_msgs/msg/CompressedImage"), "utf-8")
    assert {row[0] for row in rows(cli, tmp_path) if row[1] == "source"} == {"/a"}


@pytest.mark.parametrize(
    ("name", "type_", "expected", "node"),
    [
        ("person_pose", POSE, ("PersonTrack", "may"), "n"),  # both say may; but programs work it out
        (
            "pose",
            POSE,
            ("RobotPosition", "may"),
            "n",
        ),  # programs work it out: who writes it is seldom where it comes from
        ("x", POSE, ("RobotPosition", "may"), "n"),
        ("person", "", ("PersonTrack", "may"), "n"),  # a name alone
        ("depth/image", IMAGE, ("DepthImage", "may"), "n"),  # both speak of the channel, and not of who writes it
        ("image", IMAGE, ("Video", "may"), "n"),
        ("speech", STRING, ("SpeechTranscript", "may"), "n"),  # a type that can carry anything agrees with nothing
        ("image", IMAGE, ("Video", "likely"), "camera"),
        ("x", IMAGE, ("Video", "likely"), "camera"),
        ("image", IMAGE, ("Video", "may"), "gps"),  # it speaks of something else
    ],
)
def test_a_type_makes_a_likely_source_only_of_a_node_whose_own_name_agrees(
    cli: Cli, tmp_path: Path, name: str, type_: str, expected: tuple[str, str], node: str
) -> None:
    (tmp_path / "p.xml").write_text(policy_of({node: ([f"/{name}"], [])}), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(**{name: type_}) if type_ else "labels: 1\n", "utf-8")
    assert (f"/{node}", "source", *expected) in rows(cli, tmp_path)


def test_who_asks_for_a_place_is_no_source_of_it(cli: Cli, tmp_path: Path) -> None:
    profile = '<profile ns="/" node="n"><actions call="ALLOW"><action>navigate_to_pose</action></actions></profile>'
    enclave = f'<enclave path="/n"><profiles>{profile}</profiles></enclave>'
    (tmp_path / "p.xml").write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>', "utf-8")
    labels = "labels: 1\nactions: {/navigate_to_pose: {types: [nav2_msgs/action/NavigateToPose]}}\n"
    (tmp_path / "l.yaml").write_text(labels, "utf-8")
    sources = [row for row in rows(cli, tmp_path) if row[1] == "source"]
    assert sources == [("/n", "source", "OperatorInput", "may")]  # somebody may have told it where to go


@pytest.mark.parametrize(
    ("node", "topic", "type_", "expected"),
    [
        ("camera", "image", IMAGE, ["Video likely"]),
        ("gazebo_camera", "image", IMAGE, ["Video may"]),  # nobody measured it
        ("person_detector", "image", IMAGE, ["Video may"]),  # of what others film
        ("camera", "image_ground_truth", IMAGE, ["Video may"]),  # only who simulates knows it
        ("mic_listener", "voice_text", STRING, ["Voice may", "SpeechTranscript may"]),
        ("n", "debug_image", IMAGE, ["Video may"]),
        ("n", "map", "nav_msgs/msg/OccupancyGrid", ["HomeMap may"]),  # worked out of other data
        ("n", "odom", "nav_msgs/msg/Odometry", ["RobotPosition may"]),
        ("n", "goal_pose", POSE, ["OperatorInput may"]),  # somebody may want it there
        ("n", "pose", POSE, ["RobotPosition may"]),
        ("n", "goal_markers", "visualization_msgs/msg/MarkerArray", ["OperatorInput may"]),  # no PersonTrack
        ("n", "people_markers", "visualization_msgs/msg/MarkerArray", ["PersonTrack may"]),
        ("n", "imu", "sensor_msgs/msg/Imu", []),  # of the machine
        ("keyboard_teleop", "cmd_vel", TWIST, ["OperatorInput may"]),  # what an operator does can have any type
        ("planner", "cmd_vel", TWIST, ["OperatorInput may"]),  # it reads nothing that it could be made of
        ("camera", "cmd_vel", TWIST, ["OperatorInput may"]),  # and no Video
        ("n", "pir", "std_msgs/msg/Bool", ["Presence may"]),
        ("n", "face", "std_msgs/msg/Bool", []),
        ("demo_camera", "image", IMAGE, ["Video may"]),  # nobody measured it either
        ("n", "fire_alarm", "std_msgs/msg/Bool", ["SmartHomeSensorData may"]),
    ],
)
def test_what_puts_a_source_in_doubt(
    cli: Cli, tmp_path: Path, node: str, topic: str, type_: str, expected: list[str]
) -> None:
    (tmp_path / "p.xml").write_text(policy_of({node: ([f"/{topic}"], [])}), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(**{topic: type_}), "utf-8")
    found = [f"{kind} {sure}" for _, role, kind, sure in rows(cli, tmp_path) if role == "source"]
    assert [one for one in found if not one.startswith(("DepthImage", "ThermalImage"))] == expected


@pytest.mark.parametrize(
    ("read", "written", "type_", "expected"),
    [
        ("transcript", "agent/commands", STRING, True),
        ("transcript", "planned_tasks", "a/msg/Tasks", True),
        ("transcript", "cmd_vel", TWIST, False),
        ("transcript", "command", TWIST, False),  # that type cannot be it
        ("transcript", "status", STRING, False),
        ("odom", "agent/commands", STRING, False),
    ],
)
def test_what_somebody_said_becomes_a_command(
    cli: Cli, tmp_path: Path, read: str, written: str, type_: str, *, expected: bool
) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"n": ([f"/{written}"], [f"/{read}"])}), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(**{written.replace("/", "__"): type_}).replace("__", "/"), "utf-8")
    assert (("/n", "derivation", "SpeechTranscript VoiceCommand", "may") in rows(cli, tmp_path)) is expected


@pytest.mark.parametrize(
    ("node", "read", "type_", "expected"),
    [
        ("stt_node", "microphone", "audio_common_msgs/msg/AudioData", "Voice CommunicationContent"),
        ("person_detector", "image", IMAGE, "Video PersonDetection"),
    ],
)
def test_a_node_whose_name_says_what_it_makes_derives_it(
    cli: Cli, tmp_path: Path, node: str, read: str, type_: str, expected: str
) -> None:
    (tmp_path / "p.xml").write_text(policy_of({node: (["/x"], [f"/{read}"])}), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(**{read: type_}), "utf-8")
    found = rows(cli, tmp_path)
    assert (f"/{node}", "derivation", expected, "may") in found
    assert not [row for row in found if row[:2] == (f"/{node}", "source")]


@pytest.mark.parametrize("type_", [TWIST, "std_msgs/msg/Bool"])
def test_a_type_that_carries_nothing_outweighs_a_name(cli: Cli, tmp_path: Path, type_: str) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"door_camera": (["/camera/image"], [])}), "utf-8")
    (tmp_path / "l.yaml").write_text(typed(**{"camera/image": type_}), "utf-8")
    assert rows(cli, tmp_path) == []


def test_open_elements_come_first_with_their_neighbours(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text(typed(b=CLOUD) + "nodes:\n  /camera: {source: [Video]}\n", "utf-8")
    text = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    first = text.index("Open elements, in review order:")
    assert first < text.index("/finder") < text.index("/mover")
    assert text.index("node    /finder") < text.index("topic   /b")
    assert "neighbour of /camera, which Video reaches" in text
    assert "it gets Video, which can go on to /c" in text
    said = rows(cli, robot)
    assert ("/finder", "conduit", "Video", "may") in said
    assert ("/a", "sensitive", "Video", "may") in said
    assert not [row for row in said if row[0] == "/camera" and row[2] == "Video"]  # a person has spoken of it


def test_where_data_end_it_is_asked_what_a_conduit_there_means(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"eye": (["/a"], []), "unknown": ([], ["/a"])}), "utf-8")
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes:\n  /eye: {source: [Video]}\n", "utf-8")
    text = cli("suggest", "p.xml", "-l", "l.yaml", cwd=tmp_path).stdout
    assert "a leak if the node keeps it, shows it, or sends it elsewhere, else a conduit" in text
    assert [row[1:] for row in rows(cli, tmp_path) if row[0] == "/unknown"] == [
        ("leak", "Video", "may"), ("conduit", "Video", "may"),
    ]  # fmt: skip


def test_of_a_leak_and_a_conduit_neither_is_accepted_before_a_person_says_which(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"eye": (["/a"], []), "unknown": ([], ["/a"])}), "utf-8")
    (tmp_path / "l.yaml").write_text("labels: 1\nauthor: Ada\nnodes:\n  /eye: {source: [Video]}\n", "utf-8")
    cli("suggest", "p.xml", "--into", "l.yaml", cwd=tmp_path)
    by_word = cli("labels", "--accept", "may", "-l", "l.yaml", cwd=tmp_path)
    assert "2 suggestions could hide a leak or what nobody looked at" in by_word.stderr
    before = (tmp_path / "l.yaml").read_text("utf-8")
    assert "/unknown:" not in before
    by_name = cli("labels", "--accept", "/unknown", "-l", "l.yaml", cwd=tmp_path)
    assert by_name.returncode == 2
    assert re.fullmatch(
        r"l.yaml: of /unknown alternatives are suggested: leak Video \(line \d+\), conduit Video \(line \d+\); "
        r"say which, such as --accept /unknown=leak, or remove the lines that are wrong\n",
        by_name.stderr,
    )
    assert (tmp_path / "l.yaml").read_text("utf-8") == before
    assert cli("labels", "--accept", "/unknown=leak", "-l", "l.yaml", cwd=tmp_path).returncode == 0
    assert "/unknown: {leak: [Video]" in (tmp_path / "l.yaml").read_text("utf-8")


def test_of_what_a_camera_could_be_a_person_says_which(cli: Cli, robot: Path) -> None:
    lines = [suggestion("nodes", "/camera", {"source": [kind]}) for kind in ("DepthImage", "ThermalImage")]
    (robot / "l.yaml").write_text("labels: 1\nauthor: Ada\n" + "".join(lines), "utf-8")
    refused = cli("labels", "--accept", "/camera", "-l", "l.yaml", cwd=robot)
    assert (refused.returncode, refused.stderr) == (
        2,
        (
            "l.yaml: of /camera alternatives are suggested: source DepthImage (line 3), source ThermalImage (line 4); "
            "say which, such as --accept /camera=DepthImage, or remove the lines that are wrong\n"
        ),
    )
    unknown = cli("labels", "--accept", "/camera=Voice", "-l", "l.yaml", cwd=robot)
    assert (unknown.returncode, unknown.stderr.partition(";")[0]) == (2, "l.yaml: 'Voice' is not suggested of /camera")
    assert cli("labels", "--accept", "/camera=ThermalImage", "-l", "l.yaml", cwd=robot).returncode == 0
    text = (robot / "l.yaml").read_text("utf-8")
    assert "source: [ThermalImage]" in text
    assert text.endswith(lines[0])
    assert cli("labels", "--accept", "/camera=*", "-l", "l.yaml", cwd=robot).returncode == 0
    assert "source: [ThermalImage, DepthImage]" in (robot / "l.yaml").read_text("utf-8")


def test_of_an_open_node_that_lets_data_out_no_conduit_is_suggested(cli: Cli, robot: Path) -> None:
    """A conduit of a narrower kind would outrank the leak (rule S7)."""
    (robot / "l.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n", "utf-8")
    assert [row[1:] for row in rows(cli, robot) if row[0] == "/customer_bridge"] == [("leak", "PersonalData", "may")]


def test_of_a_node_that_lets_another_kind_out_a_leak_is_suggested(cli: Cli, robot: Path) -> None:
    said = "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /mover: {leak: [Voice]}\n"
    (robot / "l.yaml").write_text(said + "  /customer_bridge: {leak: [Voice]}\n", "utf-8")
    found = rows(cli, robot)
    assert [row[1:] for row in found if row[0] == "/mover"] == [("leak", "Video", "may")]
    assert [row[1:] for row in found if row[0] == "/customer_bridge"] == [
        ("leak", "Video", "may"), ("leak", "PersonalData", "may"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("entry", "asked"),
    [
        ("", True),
        ("  /cloud_uploader: conduit\n", False),
        ("  /cloud_uploader: {leak: none}\n", False),
        ('  "*_uploader": {leak: none}\n', False),  # a glob that speaks of letting out
    ],
)
def test_a_leak_is_suggested_although_a_glob_calls_the_node_a_conduit(
    cli: Cli, tmp_path: Path, entry: str, *, asked: bool
) -> None:
    """S11: what only a glob answers for nobody has seen; a full name still silences it."""
    (tmp_path / "p.xml").write_text(
        policy_of({"camera": (["/image"], []), "cloud_uploader": ([], ["/image"])}), "utf-8"
    )
    said = f'labels: 1\nnodes:\n  /camera: {{source: [Video]}}\n  "/*": conduit\n{entry}topics:\n  /image: sensitive\n'
    (tmp_path / "l.yaml").write_text(said, "utf-8")
    document = json.loads(cli("suggest", "p.xml", "-l", "l.yaml", "-f", "json", cwd=tmp_path).stdout)
    jsonschema.validate(document, SCHEMA)
    told = [one for one in document["suggestions"] if one["name"] == "/cloud_uploader"]
    assert [(one["role"], one["confidence"]) for one in told] == ([("leak", "may")] if asked else [])
    for one in told:
        glob, name, *_ = one["evidence"]
        assert (glob["ground"], glob["file"], glob["line"]) == ("glob", "l.yaml", 4)
        assert name["ground"] == "name"
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=tmp_path)
    cli("labels", "-l", "l.yaml", "--accept", "/cloud_uploader", "--by", "Ada", cwd=tmp_path)
    found = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml").findings
    assert [one.leak.name for one in found] == (["/cloud_uploader"] if asked else [])


def test_what_a_channel_is_not_made_for_is_a_never_and_never_sure(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n", "utf-8")
    (robot / "types.yaml").write_text(f"types: 1\ntopics:\n  /c: [{{type: {IDS}}}]\n", "utf-8")
    found = rows(cli, robot, "--types", "types.yaml")
    assert ("/c", "never", "Video", "may") in found
    assert ("/c", "sensitive", "Video", "may") not in found  # one answer to a question
    (robot / "l.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\ntopics: {/c: mundane}\n", "utf-8")
    assert not [row for row in rows(cli, robot, "--types", "types.yaml") if row[0] == "/c"]


def test_users_rules_and_kinds_take_part(cli: Cli, robot: Path) -> None:
    (robot / "own.ttl").write_text(
        "@prefix : <urn:example:> . @prefix rp: <https://w3id.org/rosprivacy#> .\n"
        "@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n"
        ':Crate a skos:Concept ; rp:label "Crate" ; skos:broader rp:Video ; rp:dataType "video" ;\n'
        '  skos:prefLabel "crate"@en ; skos:definition "Pictures of a crate."@en .\n',
        "utf-8",
    )
    (robot / "own.yaml").write_text(
        "name_rules: 1\ncarries:\n  - {words: [a], kinds: [Crate], confidence: likely, why: ours}\n", "utf-8"
    )
    found = rows(cli, robot, "--rules", "own.yaml", "--ontology", "own.ttl")
    assert ("/camera", "source", "Crate", "likely") in found
    wrong = cli("suggest", "p.xml", "--rules", "own.yaml", cwd=robot)
    assert (wrong.returncode, wrong.stderr.partition(";")[0]) == (2, "own.yaml:3: unknown category 'Crate'")


def test_packages_take_part_and_a_users_own(cli: Cli, tmp_path: Path) -> None:
    nodes: Nodes = {"usb_cam": (["/image_raw", "/camera_info"], []), "badge": (["/b"], [])}
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    (tmp_path / "l.yaml").write_text("labels: 1\n", "utf-8")
    assert ("/usb_cam", "source", "Video", "likely") in rows(cli, tmp_path)
    (tmp_path / "own.yaml").write_text(PACKAGE, "utf-8")
    assert ("/badge", "source", "StaffBadge", "likely") in rows(cli, tmp_path, "--packages", "own.yaml")
    text = cli("suggest", "p.xml", "--packages", "own.yaml", cwd=tmp_path).stdout
    assert "package badges" in text
    assert cli("suggest", "p.xml", "--packages", "nope.yaml", cwd=tmp_path).returncode == 2


def test_what_code_uses_is_told_with_its_line_and_what_is_nobodys_too(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text("labels: 1\n", "utf-8")
    (robot / "code").mkdir()
    (robot / "code" / "finder.py").write_text(
        "import badge, requests\nfrom rclpy.node import Node\n\n\nclass Finder(Node):\n    def __init__(self):\n"
        "        super().__init__('finder')\n        requests.post('x')\n        badge.show()\n",
        "utf-8",
    )
    (robot / "code" / "tool.py").write_text("import cv2\ncv2.imshow('x', 1)\n", "utf-8")
    (robot / "code" / "wrong.py").write_text("def\n", "utf-8")
    (robot / "code" / "vendor").mkdir()
    (robot / "code" / "vendor" / "lib.py").write_text("import cv2\ncv2.imshow('x', 1)\n", "utf-8")
    (robot / "own.yaml").write_text(
        "library_rules: 1\nlets_out:\n"
        "  - {python: [badge.show], kinds: [StaffBadge], where: display, confidence: likely, why: ours}\n",
        "utf-8",
    )
    own = ("--source", "code", "--libraries", "own.yaml")
    assert ("/finder", "leak", "StaffBadge", "may") in rows(cli, robot, *own)
    assert not [row for row in rows(cli, robot, *own[:2]) if row[2] == "StaffBadge"]
    text = cli("suggest", "p.xml", *own, cwd=robot).stdout
    assert "uses requests.post (code/finder.py:8): it talks to a server" in text
    assert "1 problem of source code that could not be read: code/wrong.py:1: not Python" in text
    assert "1 use of libraries in code that belongs to no node that is known here: cv2.imshow (code/tool.py:2)" in text
    assert "1 folder with code of others that is not looked at" in text
    assert "code/vendor\n" in text
    assert (
        "code/vendor" not in cli("suggest", "p.xml", "--source", "code/vendor", cwd=robot).stdout.partition("1 use")[0]
    )
    wrong = cli("suggest", "p.xml", "--libraries", "l.yaml", cwd=robot)
    assert (wrong.returncode, wrong.stderr) == (
        2, "l.yaml:1: no 'library_rules: 1'; say so on the first line: it is the format's version\n"
    )  # fmt: skip


def test_a_package_of_the_sources_that_is_called_as_a_library_is_told(cli: Cli, robot: Path) -> None:
    """Which one Python imports, nobody knows here: the leak would be missed without a word."""
    (robot / "l.yaml").write_text("labels: 1\n", "utf-8")
    for name in ("finder/finder", "requests/requests"):
        (robot / "src" / name).mkdir(parents=True)
        (robot / "src" / name / "__init__.py").write_text("\n", "utf-8")
    (robot / "src" / "finder" / "finder" / "node.py").write_text(
        "import requests, ours\nfrom rclpy.node import Node\n\n\nclass Finder(Node):\n    def __init__(self):\n"
        "        super().__init__('finder')\n        requests.post('x')\n        requests.put('x')\n",
        "utf-8",
    )
    text = cli("suggest", "p.xml", "--source", "src", cwd=robot).stdout
    assert "uses requests.post" not in text
    (told,) = [line for line in text.splitlines() if "notice" in line]
    assert told == (
        "notice: src/finder/finder/node.py:8: requests.post is taken for src/requests/requests/__init__.py of these "
        "sources, so no library of that name suggests anything; label the node by hand if the library is meant"
    )
    (robot / "src" / "requests" / "requests" / "__init__.py").rename(robot / "src" / "requests" / "__init__.py")
    (robot / "src" / "requests").rename(robot / "src" / "other")
    text = cli("suggest", "p.xml", "--source", "src", cwd=robot).stdout
    assert "uses requests.post (src/finder/finder/node.py:8): it talks to a server" in text
    assert "notice" not in text


@pytest.mark.parametrize("now", [IDS, STRING])
def test_a_limit_whose_type_is_another_one_now_is_told(cli: Cli, robot: Path, now: str) -> None:
    """Somebody accepted it from a list, since nothing of it can be in identifiers."""
    note = "answered by Ada on 2026-01-01 in a list of 2: type hri_msgs/msg/IdsList of /c is not made for Video"
    (robot / "l.yaml").write_text(
        "labels: 1\nnodes:\n  /camera: {source: [Video]}\ntopics:\n"
        f'  /c: {{types: [{now}], never: [Video], note: "{note}"}}\n',
        "utf-8",
    )
    told = (
        f"never of /c was accepted since its type was hri_msgs/msg/IdsList; it is {now} now (l.yaml:5): look at it anew"
    )
    for command in ("suggest", "analyze"):
        done = cli(command, "p.xml", "-l", "l.yaml", cwd=robot)
        shown = " ".join((done.stdout + done.stderr).split())
        assert (told in shown) is (now != IDS), shown


def test_code_tells_types_with_its_line(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text("labels: 1\n", "utf-8")
    (robot / "driver.py").write_text(
        "from rclpy.node import Node\nfrom sensor_msgs.msg import Image\n\n\nclass Driver(Node):\n"
        "    def __init__(self):\n        super().__init__('camera')\n"
        "        self.out = self.create_publisher(Image, '/a', 1)\n",
        "utf-8",
    )
    assert ("/camera", "source", "Video", "may") in rows(cli, robot)  # by its name
    assert ("/camera", "source", "Video", "likely") in rows(cli, robot, "--source", "driver.py")
    text = cli("suggest", "p.xml", "--source", "driver.py", cwd=robot).stdout
    assert "type sensor_msgs/msg/Image of /a (driver.py:8): a picture of" in text
    answer = cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    assert "Image" not in answer  # nothing follows from code


PACKAGE = """package: 1
name: badges
about: Reads badges.
sources:
  - {at: "https://example.org/badges", version: "1.0", commit: 772b25f, files: [README.md], read: 2026-11-23}
nodes:
  - names: [badge]
    executables: [badge]
    publishes: {b: std_msgs/msg/String}
    says:
      - source: [StaffBadge]
        why: it reads badges
"""


def test_nothing_is_applied(cli: Cli, robot: Path) -> None:
    before = {file: file.read_bytes() for file in robot.iterdir()}
    answer = cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    done = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout  # S14
    assert {file: file.read_bytes() for file in robot.iterdir()} == before
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout == answer


def test_nothing_to_suggest_is_said(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"n": (["/x"], [])}), "utf-8")
    done = cli("suggest", "p.xml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "nothing to suggest: no rule speaks of what nobody has labelled\n")


OWN_CAMERA = """package: 1
name: usb_cam
about: Mine.
sources: [{at: https://example.org, version: "1", read: 2026-11-23}]
nodes: [{names: [usb_cam], says: [{conduit: all, why: it says so}]}]
"""


def test_a_package_in_place_of_a_shipped_one_is_told_and_takes_no_source_away(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"usb_cam": (["/x"], ["/y"])}), "utf-8")
    (tmp_path / "mine.yaml").write_text(OWN_CAMERA, "utf-8")
    told = (
        "mine.yaml:1: it stands in place of the shipped package usb_cam; what it does not state of that is asked all "
        "the same: source of Video at usb_cam, source of Video at usb_cam_node_exe"
    )
    done = cli("suggest", "p.xml", "--packages", "mine.yaml", cwd=tmp_path)
    assert done.stdout.splitlines()[0] == f"notice: {told}"
    assert "source Video" in done.stdout
    assert told in cli("suggest", "p.xml", "--packages", "mine.yaml", "--into", "l.yaml", cwd=tmp_path).stderr
    document = json.loads(cli("suggest", "p.xml", "--packages", "mine.yaml", "-f", "json", cwd=tmp_path).stdout)
    jsonschema.validate(document, SCHEMA)
    assert [f"{one['file']}:{one['line']}: {one['message']}" for one in document["notices"]] == [told]


# ---------------------------------------------------------------- fleets and databases


def test_of_a_fleet_robots_that_are_alike_are_asked_about_once(cli: Cli) -> None:
    done = cli("suggest", "--fleet", "examples/fleet/fleet.yaml", "-f", "json", cwd=ROOT)
    document = json.loads(done.stdout)
    jsonschema.validate(document, SCHEMA)
    asked = {one["robot"] for one in document["suggestions"]}
    assert asked == {"carrier_01", "carrier_lent", "cleaner_1", "guide_01"}
    stands = {one["robot"]: (one["model"], len(one["alike"])) for one in document["robots"]}
    assert stands["carrier_01"] == ("carrier", 23)
    lines = cli("suggest", "--fleet", "examples/fleet/fleet.yaml", cwd=ROOT).stdout.splitlines()
    assert "carrier_01 is a robot of model carrier, which stands for 23 that are alike." in lines
    assert [line for line in lines if line.startswith("  node    cleaner_1:/lidar ")]


def test_of_each_robot_of_a_fleet_the_same_is_suggested_as_of_it_alone(cli: Cli, robot: Path) -> None:
    """Two robots that share nothing with each other; differential."""
    (robot / "f.yaml").write_text(
        "fleet: 1\nmodels: {m: {policies: [p.xml], labels: [l.yaml]}}\ngroups: [{robots: 2, model: m}]\n"
    )
    alone, fleet = (
        json.loads(cli("suggest", *named, "-f", "json", cwd=robot).stdout)["suggestions"]
        for named in (("p.xml", "-l", "l.yaml"), ("--fleet", "f.yaml"))
    )
    assert alone
    assert [one | {"robot": ""} for one in fleet] == alone


def test_a_no_of_one_robot_of_a_fleet_is_none_of_another(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"camera": (["/front"], []), "box": ([], ["/front"])}), "utf-8")
    no = '# not: {"nodes": {"/camera": {"source": ["Video"]}}} by Ada on 2026-01-01\n'
    (tmp_path / "two.yaml").write_text(f"labels: 1\nnodes:\n  /box: conduit\n{no}", "utf-8")
    (tmp_path / "fleet.yaml").write_text(
        "fleet: 1\nmodels:\n  m: {policies: [p.xml]}\nrobots:\n  one: {model: m}\n"
        "  two: {model: m, labels: [two.yaml]}\n",
        "utf-8",
    )
    told = cli("suggest", "--fleet", "fleet.yaml", cwd=tmp_path).stdout
    assert re.search(r"one:/camera +source Video ", told)
    alone = cli("suggest", "p.xml", "-l", "two.yaml", cwd=tmp_path).stdout
    assert not re.search(r"/camera +source Video ", alone)


def test_a_no_in_a_models_file_is_one_of_its_robots_and_of_no_others(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"camera": (["/front"], []), "box": ([], ["/front"])}), "utf-8")
    no = '# not: {"nodes": {"/camera": {"source": ["Video"]}}} by Ada on 2026-01-01\n'
    for name, more in (("m", no), ("n", ""), ("own", no)):
        (tmp_path / f"{name}.yaml").write_text(f"labels: 1\nnodes:\n  /box: conduit\n{more}", "utf-8")
    (tmp_path / "fleet.yaml").write_text(
        "fleet: 1\nmodels:\n  m: {policies: [p.xml], labels: [m.yaml]}\n  n: {policies: [p.xml], labels: [n.yaml]}\n"
        "groups: [{robots: 2, model: m}, {robots: 2, model: n}]\n"
        "robots:\n  mine: {model: n, labels: [own.yaml]}\n  theirs: {model: n}\n",
        "utf-8",
    )
    told = cli("suggest", "--fleet", "fleet.yaml", cwd=tmp_path).stdout
    asked = re.findall(r"(\w+):/camera +source Video ", told)
    assert "mine" not in asked
    assert asked
    assert not [name for name in asked if name.startswith("m")]


def test_suggestions_for_a_fleet_are_not_written_into_one_label_file(cli: Cli, tmp_path: Path) -> None:
    done = cli("suggest", "--fleet", str(ROOT / "examples/fleet/fleet.yaml"), "--into", "l.yaml", cwd=tmp_path)
    assert done.returncode == 2
    assert "--into takes the label file of one robot" in " ".join(done.stderr.replace("│", " ").split())
    assert not (tmp_path / "l.yaml").exists()


# ---------------------------------------------------------------- written into a label file, and accepted


def test_suggestions_are_comments_that_change_no_answer(cli: Cli, robot: Path) -> None:
    text = "labels: 1  # mine\n# kept\ntopics:\n  /a: {types: [sensor_msgs/msg/Image]}\n"
    (robot / "l.yaml").write_text(text, "utf-8")
    before = cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout.partition("labels l")[0]
    for _ in range(2):  # those of an earlier run are replaced
        done = cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
        assert (done.returncode, done.stdout) == (0, "")
        new = (robot / "l.yaml").read_text("utf-8")
        assert new.startswith(text)
        lines = new.removeprefix(text).splitlines()
        assert all(line.startswith("# suggest: ") for line in lines)
        assert done.stderr == f"l.yaml: {len(lines)} suggestions, as comments\n"
    assert before
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout.startswith(before)


def test_one_element_is_accepted_with_who_when_and_why(cli: Cli, robot: Path) -> None:
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
    text = (robot / "l.yaml").read_text("utf-8")
    done = cli("labels", "--accept", "/camera", "--by", "Ada", "-l", "l.yaml", cwd=robot, SOURCE_DATE_EPOCH=DAY)
    assert (done.returncode, done.stderr) == (0, "l.yaml: 1 suggestion accepted\n")
    new = (robot / "l.yaml").read_text("utf-8")
    labels = text.partition("# suggest")[0]
    (line,) = [line for line in new.removeprefix(labels).splitlines() if line.startswith("  /camera:")]
    assert line.startswith("  /camera: {")
    assert "source: [Video]" in line
    assert "accepted by Ada on 2026-01-01 (likely): type sensor_msgs/msg/Image of /a" in line
    assert [one for one in new.splitlines() if one.startswith("# suggest")] == [
        one
        for one in text.splitlines()
        if one.startswith("# suggest") and '{"/camera": {"source": ["Video"]' not in one
    ]
    assert new.startswith(labels)
    roles = rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml")).document()["roles"]
    assert [(one["element"]["name"], *one["roles"], one["category"]) for one in roles] == [
        ("/camera", "source", "Video")
    ]


def test_no_reason_is_cut(cli: Cli, tmp_path: Path) -> None:
    cli("suggest", str(CARE), "--into", "l.yaml", cwd=tmp_path)
    cli("labels", "--accept", "/face_recognizer=FaceImage", "--by", "Ada", "-l", "l.yaml", cwd=tmp_path)
    text = (tmp_path / "l.yaml").read_text("utf-8")
    assert "…" not in text
    assert "trackers and models that describe what they see make it of pictures" in text.partition("# suggest")[0]


def test_all_of_a_confidence_are_accepted_but_what_could_hide_a_leak(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text(typed(a=IMAGE, b=CLOUD, c=IDS, d=TWIST) + "author: Ada\n", "utf-8")
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
    likely = cli("labels", "--accept", "likely", "-l", "l.yaml", cwd=robot)
    assert likely.returncode == 0
    text = (robot / "l.yaml").read_text("utf-8")
    assert "likely" not in "".join(line for line in text.splitlines() if line.startswith("# suggest"))
    everything = cli("labels", "--accept", "may", "-l", "l.yaml", cwd=robot)
    assert re.search(r"^l.yaml: \d+ suggestions could hide a leak or what nobody looked at", everything.stderr)
    left = [line for line in (robot / "l.yaml").read_text("utf-8").splitlines() if line.startswith("# suggest")]
    assert left
    assert all(re.search(r'"(sanitizer|conduit|never)"', line) for line in left)
    (robot / "l.yaml").write_text(re.sub(r"^  /customer_bridge: .*\n", "", text, flags=re.MULTILINE), "utf-8")
    assert cli("labels", "--accept", "/finder", "p.xml", "-l", "l.yaml", cwd=robot).returncode == 0
    assert "sanitizer: {Video: drop}" in (robot / "l.yaml").read_text("utf-8")


def test_a_comment_that_is_older_than_a_finding_does_not_close_it(cli: Cli, robot: Path) -> None:
    """Written when no leak was known; without the policies nobody knows, with them the finding is told."""
    old = suggestion("nodes", "/finder", {"sanitizer": {"Video": "drop"}}, "may")
    (robot / "l.yaml").write_text(LEAKS + old, "utf-8")
    alone = cli("labels", "--accept", "/finder", "-l", "l.yaml", cwd=robot)
    assert alone.stderr.startswith("l.yaml:9: /finder would take data away; name the policies as well")
    told = cli("labels", "--accept", "/finder", "p.xml", "-l", "l.yaml", cwd=robot)
    assert re.match(
        r"l.yaml:9: /finder would take data away of which a finding is known "
        r"\(Video: /camera -> /customer_bridge \[[0-9a-f]{16}\]\); write it by hand if it is so\n",
        told.stderr,
    )
    assert (robot / "l.yaml").read_text("utf-8") == LEAKS + old


@pytest.fixture
def limited(cli: Cli, tmp_path: Path) -> Path:
    """Somebody accepted ``never`` for /front, when no source was known."""
    (tmp_path / "p.xml").write_text(
        policy_of({"camera": (["/front", "/side"], []), "box": ([], ["/front"]), "other": ([], ["/side"])}), "utf-8"
    )
    lines = [
        suggestion("nodes", "/camera", {"source": ["Video"]}),
        suggestion("topics", "/front", {"never": ["Video"]}, "may"),
        suggestion("nodes", "/box", {"leak": ["Video"]}, "may"),
    ]
    (tmp_path / "l.yaml").write_text(f"labels: 1\nauthor: Ada\n{''.join(lines)}", "utf-8")
    done = cli("labels", "p.xml", "-l", "l.yaml", "--accept", "/front", cwd=tmp_path)
    assert done.stderr == "l.yaml: 1 suggestion accepted\n"
    return tmp_path


def test_a_limit_on_the_way_of_data_that_are_accepted_later_is_told(cli: Cli, limited: Path) -> None:
    done = cli("labels", "p.xml", "-l", "l.yaml", "--accept", "likely", cwd=limited)
    assert (done.returncode, done.stderr) == (
        0,
        (
            "l.yaml:4: never of topic /front takes Video away, which is accepted now; see whether it is still so\n"
            "l.yaml: 1 suggestion accepted\n"
        ),
    )
    leak = cli("labels", "p.xml", "-l", "l.yaml", "--accept", "/box", cwd=limited)
    assert leak.stderr == (
        "l.yaml:4: never of topic /front takes Video away, which is accepted now; behind it lies the leak /box; "
        "see whether it is still so\nl.yaml: 1 suggestion accepted\n"
    )


def test_a_limit_is_told_of_each_source_of_the_same_kind(cli: Cli, limited: Path) -> None:
    """The line took the pictures of one camera away already; that it takes those of another one, too, nobody knew."""
    rights = {"camera": (["/front", "/side"], []), "second": (["/front"], []), "box": ([], ["/front"])}
    (limited / "p.xml").write_text(policy_of(rights | {"third": (["/side"], []), "other": ([], ["/side"])}), "utf-8")
    cli("labels", "p.xml", "-l", "l.yaml", "--accept", "/camera", cwd=limited)
    for name, told in (("/second", True), ("/third", False)):
        text = (limited / "l.yaml").read_text("utf-8")
        (limited / "l.yaml").write_text(f"{text}{suggestion('nodes', name, {'source': ['Video']})}", "utf-8")
        done = cli("labels", "p.xml", "-l", "l.yaml", "--accept", name, cwd=limited)
        assert done.stderr.endswith("l.yaml: 1 suggestion accepted\n")
        assert (": never of topic /front takes Video away, which is accepted now" in done.stderr) is told


def test_without_policies_a_limit_that_may_be_on_the_way_is_told(cli: Cli, limited: Path) -> None:
    done = cli("labels", "-l", "l.yaml", "--accept", "likely", cwd=limited)
    assert (done.returncode, done.stderr) == (
        0,
        (
            "l.yaml: Video is accepted, and such data may be taken away by never of /front (line 4); name the policies "
            "as well, and what of it is on the way is told\nl.yaml: 1 suggestion accepted\n"
        ),
    )


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("{never: [Voice]}", False),
        ("{never: [PersonImage]}", True),
        ("mundane", True),
        ("{only: [Voice]}", True),
        ("{only: [PersonImage]}", False),
        ("sensitive", False),
    ],
)
def test_what_takes_away_other_data_is_no_limit_of_these(cli: Cli, limited: Path, *, said: str, told: bool) -> None:
    source = suggestion("nodes", "/camera", {"source": ["Video"]})
    (limited / "l.yaml").write_text(f"labels: 1\nauthor: Ada\ntopics:\n  /front: {said}\n{source}", "utf-8")
    text = (limited / "l.yaml").read_text("utf-8")
    for policies in ([], ["p.xml"]):
        (limited / "l.yaml").write_text(text, "utf-8")
        done = cli("labels", *policies, "-l", "l.yaml", "--accept", "likely", cwd=limited)
        assert ("/front" in done.stderr) is told


def test_a_limit_elsewhere_is_not_on_the_way(cli: Cli, limited: Path) -> None:
    source = suggestion("nodes", "/camera", {"source": ["Video"]})
    (limited / "l.yaml").write_text(f"labels: 1\nauthor: Ada\ntopics:\n  /other: {{never: [Video]}}\n{source}", "utf-8")
    (limited / "p.xml").write_text(policy_of({"camera": (["/front"], []), "box": (["/other"], [])}), "utf-8")
    done = cli("labels", "p.xml", "-l", "l.yaml", "--accept", "likely", cwd=limited)
    assert done.stderr == "l.yaml: 1 suggestion accepted\n"


def test_what_is_accepted_in_one_go_is_known_before_data_are_taken_away(cli: Cli, tmp_path: Path) -> None:
    """The source makes a finding, which the channel would close: both stand in one command."""
    (tmp_path / "p.xml").write_text(policy_of({"camera": (["/front"], []), "box": ([], ["/front"])}), "utf-8")
    source = suggestion("nodes", "/camera", {"source": ["Video"]})
    never = suggestion("topics", "/front", {"never": ["Video"]})
    (tmp_path / "l.yaml").write_text(
        f"labels: 1\nauthor: Ada\nnodes:\n  /box: {{leak: [Video]}}\n{source}{never}", "utf-8"
    )
    done = cli("labels", "p.xml", "-l", "l.yaml", "--accept", "likely", "--accept", "/front", cwd=tmp_path)
    assert "/front would take data away of which a finding is known (Video: /camera -> /box" in done.stderr
    assert "1 suggestion accepted" in done.stderr
    assert (tmp_path / "l.yaml").read_text("utf-8").endswith(never)
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path).returncode == 1


BY_HAND = """labels: 1
nodes:
  # the camera
  /camera: {leak: [Voice], note: mine}  # at the door
  /relay:
    source:
      Video: [/x]

  # what follows
  /passes: {conduit: [Video]}
  /empty:
topics:
  /t: {never: [Voice]}
"""


def suggestion(section: str, name: str, said: dict[str, Any], sure: str = "likely") -> str:
    return f"# suggest: {sure} {json.dumps({section: {name: said}})} because x\n"


@pytest.mark.parametrize(
    ("line", "expected", "remark"),
    [
        (suggestion("nodes", "/camera", {"source": ["Video"]}), "/camera: {source: [Video], leak: [Voice], note: ", ""),
        (suggestion("nodes", "/camera", {"leak": ["Video"]}), "/camera: {leak: [Voice, Video], note: ", ""),
        (suggestion("nodes", "/empty", {"source": ["Video"]}), "/empty: {source: [Video], note: ", ""),
        (suggestion("topics", "/t", {"sensitive": ["Video"]}), "/t: {sensitive: [Video], never: [Voice], note: ", ""),
        (suggestion("nodes", "/relay", {"source": ["Voice"]}), "", "says source in another form already"),
        (suggestion("nodes", "/camera", {"conduit": ["Voice"]}), "", "is a leak of such data already"),
        (suggestion("nodes", "/camera", {"conduit": ["PersonalData"]}), "", "is a leak of such data already"),
        (suggestion("nodes", "/camera", {"sanitizer": {"Voice": "drop"}}), "", "would take data away; name"),
        (suggestion("nodes", "/relay", {"sanitizer": {"Video": "drop"}}), "", "would take data away; name"),
        (suggestion("nodes", "/passes", {"leak": ["PersonalData"]}), "", "is a conduit of such data already"),
        (
            suggestion("nodes", "/camera", {"conduit": ["Video"]}),
            "/camera: {conduit: [Video], leak: [Voice], note: ",
            "",
        ),
    ],
)
def test_a_suggestion_joins_what_an_entry_says(cli: Cli, tmp_path: Path, line: str, expected: str, remark: str) -> None:
    file = tmp_path / "l.yaml"
    file.write_text(BY_HAND + line, "utf-8")
    name = json.loads(line.partition("likely ")[2].partition(" because")[0])
    ((_, names),) = name.items()
    done = cli(
        "labels", "--accept", next(iter(names)), "--by", "Ada", "-l", "l.yaml", cwd=tmp_path, SOURCE_DATE_EPOCH=DAY
    )
    new = file.read_text("utf-8")
    assert done.returncode == 0
    if remark:
        assert remark in done.stderr
        assert new == BY_HAND + line
        return
    assert expected in new
    before, after = BY_HAND.splitlines(), new.splitlines()
    changed = [(a, b) for a, b in zip(before, after, strict=True) if a != b]
    assert len(changed) == 1
    assert "accepted by Ada on 2026-01-01 (likely): x" in changed[0][1]
    assert ("mine; accepted" in changed[0][1]) == ("note: mine" in changed[0][0])
    assert ("# at the door" in changed[0][1]) == ("# at the door" in changed[0][0])


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        ("labels: 1\n", ["--accept", "/x", "--by", "A"], "l.yaml: nothing is suggested of /x; name an element"),
        ("labels: 1\n", ["--accept", "may"], "l.yaml: nobody says who accepts; add --by NAME"),
        ("labels: 1\n# suggest: x\n", ["--accept", "may", "--by", "A"],
         "l.yaml:2: '# suggest: x' is no suggestion; write it as"),
        ("labels: 1\n" + suggestion("nodes", "/x", {"source": ["Vidoe"]}), ["--accept", "/x", "--by", "A"],
         "l.yaml: a suggestion makes no label: unknown category 'Vidoe'; write the labels by hand"),
        ("labels: 1\n" + suggestion("nodes", "/x", {"surce": ["Video"]}), ["--accept", "/x", "--by", "A"],
         "l.yaml: a suggestion makes no label: unknown key 'surce'; write the labels by hand"),
        ('labels: 1\nauthor: "A\n' + suggestion("nodes", "/x", {"source": ["Video"]}).strip() + '"\n',
         ["--accept", "/x"], "l.yaml"),
    ],
)  # fmt: skip
def test_what_cannot_be_accepted_leaves_the_file_as_it_is(
    cli: Cli, tmp_path: Path, text: str, arguments: list[str], message: str
) -> None:
    file = tmp_path / "l.yaml"
    file.write_text(text, "utf-8")
    done = cli("labels", *arguments, "-l", "l.yaml", cwd=tmp_path)
    assert (done.returncode, file.read_text("utf-8")) == (2, text)
    assert done.stderr.startswith(message)
    assert all(LINE.match(line) for line in done.stderr.splitlines())


def test_of_a_file_that_is_not_there_nothing_is_accepted(cli: Cli, robot: Path) -> None:
    (robot / "robot.labels.yaml").write_text(BY_HAND, "utf-8")
    (line,) = refused(cli("labels", "--accept", "may", "--by", "A", "-l", "robt.labels.yaml", cwd=robot))
    assert line == "robt.labels.yaml: file not found; did you mean robot.labels.yaml?"
    assert not (robot / "robt.labels.yaml").exists()


def test_a_file_without_suggestions_is_told(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text(BY_HAND, "utf-8")
    done = cli("labels", "--accept", "may", "--by", "A", "-l", "l.yaml", cwd=robot)
    assert (done.returncode, (robot / "l.yaml").read_text("utf-8")) == (0, BY_HAND)
    assert done.stderr.splitlines() == [
        "l.yaml: it has no '# suggest:' line; rosprivacy suggest POLICY --into FILE writes them",
        "l.yaml: 0 suggestions accepted",
    ]


def test_json_has_no_room_for_comments(cli: Cli, robot: Path) -> None:
    (robot / "l.json").write_text('{"labels": 1}', "utf-8")
    done = cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.json", cwd=robot)
    assert (done.returncode, (robot / "l.json").read_text("utf-8")) == (2, '{"labels": 1}')


# ---------------------------------------------------------------- hostile names


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_name_gets_into_neither_the_file_nor_the_terminal(cli: Cli, tmp_path: Path, name: str) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"n": ([name], []), "up": ([], [name])}), "utf-8")
    if cli("analyze", "p.xml", cwd=tmp_path).returncode == 2:
        pytest.skip("the policy's reader refuses such a name")
    shown = cli("suggest", "p.xml", cwd=tmp_path).stdout
    assert all(character.isprintable() or character == "\n" for character in shown)
    done = cli("suggest", "p.xml", "--into", "l.yaml", cwd=tmp_path)
    assert done.returncode == 0
    text = (tmp_path / "l.yaml").read_text("utf-8")
    assert all(line.startswith(("labels: 1", "# suggest: ")) for line in text.splitlines())
    assert cli("labels", "--accept", "may", "--by", 'A"\n- x: y', "-l", "l.yaml", cwd=tmp_path).returncode == 0
    said = rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).document()
    assert {one["element"]["name"] for one in said["roles"]} <= {"/n"}


# ---------------------------------------------------------------- what takes data away


LEAKS = """labels: 1
author: Ada
nodes:
  /camera: {source: [Video]}
  /customer*: {leak: [Video]}
topics:
  /a: sensitive
  /c: sensitive
"""


@pytest.mark.parametrize(
    "line",
    [
        suggestion("topics", "/a", {"never": ["Video"]}),
        suggestion("topics", "/a", {"only": ["HomeMap"]}, "certain"),
        suggestion("nodes", "/finder", {"sanitizer": {"Video": "drop"}}, "certain"),
    ],
)
def test_what_takes_data_away_is_accepted_by_name_only_however_sure(cli: Cli, robot: Path, line: str) -> None:
    """Rule S7, taking away is never silent; a package of a user's or an old suggestion may call it likely."""
    (robot / "l.yaml").write_text(LEAKS + line, "utf-8")
    done = cli("labels", "--accept", "likely", "-l", "l.yaml", cwd=robot)
    assert "1 suggestion could hide a leak" in done.stderr
    assert (robot / "l.yaml").read_text("utf-8") == LEAKS + line
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout.startswith("leak: ")


def test_by_its_name_too_what_takes_data_away_comes_last(cli: Cli, robot: Path) -> None:
    drop = suggestion("nodes", "/finder", {"sanitizer": {"Video": "drop"}}, "may")
    derives = suggestion("nodes", "/finder", {"derives": [{"from": "Video", "to": "FaceImage"}]}, "may")
    (robot / "l.yaml").write_text(LEAKS.replace("leak:", "conduit:") + drop + derives, "utf-8")
    assert "1 suggestion accepted" in cli("labels", "--accept", "/finder", "p.xml", "-l", "l.yaml", cwd=robot).stderr
    assert (robot / "l.yaml").read_text("utf-8").endswith(drop)
    assert "1 suggestion accepted" in cli("labels", "--accept", "/finder", "p.xml", "-l", "l.yaml", cwd=robot).stderr


@pytest.mark.parametrize(
    ("said", "remark"),
    [
        ({"conduit": ["Video"]}, "is a leak of such data already, by line 5; change it by hand"),
        ({"sanitizer": {"PersonImage": "drop"}}, "would take data away of which a finding is known"),
    ],
)
def test_nothing_that_hides_is_put_beside_a_leak_that_a_glob_says(
    cli: Cli, robot: Path, said: dict[str, Any], remark: str
) -> None:
    text = LEAKS + suggestion("nodes", "/customer_bridge", said, "may")
    (robot / "l.yaml").write_text(text, "utf-8")
    done = cli("labels", "--accept", "/customer_bridge", "p.xml", "-l", "l.yaml", cwd=robot)
    assert f"l.yaml:9: /customer_bridge {remark}" in done.stderr
    assert (robot / "l.yaml").read_text("utf-8") == text


def test_the_file_that_is_written_into_is_read_without_being_named(cli: Cli, robot: Path) -> None:
    (robot / "l.yaml").write_text(LEAKS, "utf-8")
    cli("suggest", "p.xml", "--into", "l.yaml", cwd=robot)
    alone = (robot / "l.yaml").read_text("utf-8")
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
    assert (robot / "l.yaml").read_text("utf-8") == alone
    assert '"/finder"' in alone
    assert '{"/camera": {"source": ["Video"]}}' not in alone


def test_the_last_line_says_what_can_be_accepted(cli: Cli, robot: Path) -> None:
    likely = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout.splitlines()[-1]
    assert likely.endswith("rosprivacy labels --accept likely --by 'YOUR NAME' -l labels.yaml")
    names_only = cli("suggest", str(CARE), cwd=robot).stdout.splitlines()[-1]
    assert names_only.endswith("rosprivacy labels --accept NAME --by 'YOUR NAME' -l labels.yaml")


def test_a_file_that_is_no_utf_8_is_told_with_its_line(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_bytes(b"labels: 1\nauthor: Jos\xe9\n")
    done = cli("labels", "--accept", "may", "-l", "l.yaml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, "l.yaml:2: not UTF-8; save the file as UTF-8\n")


# ---------------------------------------------------------------- planted leaks


NAMED = re.compile(r'^# suggest: \w+ \{"\w+": \{("(?:[^"\\]|\\.)*")', re.MULTILINE)


def hostile(kinds: Sequence[str], roles: Sequence[str]) -> Interview:
    """A language model that says some roles of everything for some kinds, each with a quote."""

    def reply(body: bytes) -> bytes:
        return said(
            *(
                answer(one["id"], role, kind, one["name"], to="Voice")
                for one in elements(body)
                for kind in kinds
                for role in roles
            )
        ).body

    return Interview(Asking("m", "http://localhost/v1", masked=False, most=10_000), reply, lambda _: None)


def accept_everything(policy: str, file: Path, model: Sequence[str] = ()) -> None:
    """All of a confidence, and then each by its name, of alternatives first what hides more.

    A model, if there is one, says these roles of everything.
    """
    for _ in range(2):
        interview = hostile(["Video", "PersonalData"], model) if model else None
        asked = suggest_labels((policy,), (str(file),), Settings(), interview=interview)
        write(file, with_suggestions(str(file), asked).text)
        write(file, with_accepted((str(file),), ["may"], "anybody", Settings()).text)
        for line, what in (('"conduit"', "=conduit"), ("# suggest", "=*")):
            left = [one for one in file.read_text("utf-8").splitlines() if one.startswith("# suggest") and line in one]
            names = [f"{json.loads(name)}{what}" for name in dict.fromkeys(NAMED.findall("\n".join(left)))]
            write(file, with_accepted((str(file),), names, "anybody", Settings(), (policy,)).text)


def accept_without_looking(policy: str, file: Path) -> None:
    """By a word and by bare names, as far as the program takes it: what a person does who reads nothing."""
    for _ in range(3):
        text = with_suggestions(str(file), suggest_labels((policy,), (str(file),), Settings())).text
        write(file, text)
        for what in ("may", *map(json.loads, dict.fromkeys(NAMED.findall(text)))):
            with suppress(InputErrors):  # alternatives, or nothing is suggested of it any more
                write(file, with_accepted((str(file),), [what], "anybody", Settings(), (policy,)).text)


def write(file: Path, text: str) -> None:
    file.write_text(text, "utf-8")


def test_accepting_every_suggestion_hides_no_planted_leak(tmp_path: Path) -> None:
    """Of an example with types, so that sanitizers and nevers are suggested too."""
    (tmp_path / "p.xml").write_text(policy_of(ROBOT), "utf-8")
    (tmp_path / "l.yaml").write_text(
        typed(a=IMAGE, b=CLOUD, c=IDS, d=TWIST)
        + "nodes:\n  /camera: {source: [Video]}\n  /customer_bridge: {leak: [Video]}\n",
        "utf-8",
    )
    policy = str(tmp_path / "p.xml")
    assert rosprivacy.analyze(policy, str(tmp_path / "l.yaml"), type_limits=None).analysis.verdict == "leak"
    accept_everything(policy, tmp_path / "l.yaml")
    assert "sanitizer" not in (tmp_path / "l.yaml").read_text("utf-8")
    assert rosprivacy.analyze(policy, str(tmp_path / "l.yaml"), type_limits=None).analysis.verdict == "leak"


HIDES = ("never", "mundane", "sanitizer", "conduit")
ADDS = ("derivation", "sensitive", "source", "leak")


@pytest.mark.parametrize("roles", [HIDES, ADDS, (*HIDES, *ADDS)])
def test_a_hostile_model_hides_no_planted_leak(tmp_path: Path, roles: Sequence[str]) -> None:
    """Whatever it says of everything, with a quote, and whatever of that a person accepts."""
    (tmp_path / "p.xml").write_text(policy_of(ROBOT), "utf-8")
    file = tmp_path / "l.yaml"
    file.write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /customer_bridge: {leak: [Video]}\n", "utf-8")
    accept_everything(str(tmp_path / "p.xml"), file, roles)
    assert ("language model" in file.read_text("utf-8")) == (roles != HIDES)
    assert rosprivacy.analyze(str(tmp_path / "p.xml"), str(file), type_limits=None).analysis.verdict == "leak"


def test_a_leak_that_nobody_has_labelled_is_not_accepted_away_without_looking(tmp_path: Path) -> None:
    """At an end of data, and at one behind a node that passes them on."""
    nodes: Nodes = {"eye": (["/a"], []), "middle": (["/b"], ["/a"]), "here": ([], ["/a"]), "there": ([], ["/b"])}
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes:\n  /eye: {source: [Video]}\n", "utf-8")
    accept_without_looking(str(tmp_path / "p.xml"), tmp_path / "l.yaml")
    assert "/middle: {conduit: [Video]" in (tmp_path / "l.yaml").read_text("utf-8")
    analysis = rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).analysis
    assert analysis.verdict == "undetermined"
    assert {one.element.name for one in analysis.open} == {"/here", "/there"}


def test_at_care_home_the_uplink_is_a_leak_or_a_conduit_and_nobody_says_which(tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes:\n  /microphone: {source: [Voice]}\n", "utf-8")
    (tmp_path / "p.xml").write_text(policy_of({"microphone": (["/audio"], []), "uplink": ([], ["/audio"])}), "utf-8")
    accept_without_looking(str(tmp_path / "p.xml"), tmp_path / "l.yaml")
    assert rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).analysis.verdict != "no-leak-found"


@pytest.mark.corpus
@pytest.mark.parametrize("model", [(), pytest.param((*HIDES, *ADDS), marks=pytest.mark.slow)])
def test_accepting_every_suggestion_hides_no_planted_leak_of_the_corpus(
    corpus: Path, tmp_path: Path, model: Sequence[str], *, thorough: bool
) -> None:
    """Also with a language model that says of everything all that it can, 'never' first."""
    tried = 0
    for file in sorted((corpus / "policies").rglob("*.xml")):
        try:
            rosprivacy.analyze(str(file))
        except InputErrors:
            continue
        for labels, path in planted(str(file), tmp_path, *((2, 2) if thorough else (1000, 1))):
            assert rosprivacy.analyze(str(file), str(labels)).analysis.verdict == "leak"
            accept_everything(str(file), labels, model)
            verdict = rosprivacy.analyze(str(file), str(labels)).analysis.verdict
            assert verdict != "no-leak-found", f"{file}: {path}"
            tried += 1
    assert tried > 5
