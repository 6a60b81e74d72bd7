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
from tests.helpers.asked_by_keys import robot_of
from tests.helpers.command import cli, refused
from tests.helpers.little_robots import HOSTILE, Nodes, policy_of
from tests.helpers.model_server import answer, elements, said
from tests.helpers.paths import ROOT
from tests.helpers.planted_leaks import planted

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from tests.helpers.command import Cli, Done

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
    return robot_of(tmp_path, ROBOT, typed(a=IMAGE, b=CLOUD, c=IDS, d=TWIST))


def document_of(cli: Cli, folder: Path, *more: str) -> Any:
    document = json.loads(cli("suggest", "p.xml", "-l", "l.yaml", "-f", "json", *more, cwd=folder).stdout)
    jsonschema.validate(document, SCHEMA)
    return document


def rows(cli: Cli, folder: Path, *more: str) -> list[tuple[str, str, str, str]]:
    """(name, role, kind and what is made of it, confidence)."""
    return [
        (one["name"], one["role"], " ".join([one["kind"], *(d["to"] for d in one["label"].get("derives", ()))]),
         one["confidence"])
        for one in document_of(cli, folder, *more)["suggestions"]
    ]  # fmt: skip


def accept(cli: Cli, folder: Path, *names: str, policies: Sequence[str] = ()) -> Done:
    options = [word for name in names for word in ("--accept", name)]
    return cli("labels", *policies, *options, "--by", "Ada", "-l", "l.yaml", cwd=folder, SOURCE_DATE_EPOCH=DAY)


def suggestion(section: str, name: str, label: dict[str, Any], sure: str = "likely") -> str:
    return f"# suggest: {sure} {json.dumps({section: {name: label}})} because x\n"


def text_of(folder: Path) -> str:
    return (folder / "l.yaml").read_text("utf-8")


def write(folder: Path, text: str) -> None:
    (folder / "l.yaml").write_text(text, "utf-8")


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
    robot_of(tmp_path, {"a": (["/x"], []), "b": (["/y"], ["/x"])}, typed(x=IMAGE, y="sensor_msgs/msg/CompressedImage"))
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
    robot_of(tmp_path, {node: ([f"/{topic}"], [])}, typed(**{topic: type_}))
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
    robot_of(
        tmp_path,
        {"n": ([f"/{written}"], [f"/{read}"])},
        typed(**{written.replace("/", "__"): type_}).replace("__", "/"),
    )
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
    robot_of(tmp_path, {node: (["/x"], [f"/{read}"])}, typed(**{read: type_}))
    found = rows(cli, tmp_path)
    assert (f"/{node}", "derivation", expected, "may") in found
    assert not [row for row in found if row[:2] == (f"/{node}", "source")]


@pytest.mark.parametrize("type_", [TWIST, "std_msgs/msg/Bool"])
def test_a_type_that_carries_nothing_outweighs_a_name(cli: Cli, tmp_path: Path, type_: str) -> None:
    robot_of(tmp_path, {"door_camera": (["/camera/image"], [])}, typed(**{"camera/image": type_}))
    assert rows(cli, tmp_path) == []


FILMED = "labels: 1\nauthor: Ada\nnodes:\n  /camera: {source: [Video]}\n"


def test_open_elements_come_first_with_their_neighbours(cli: Cli, robot: Path) -> None:
    robot_of(robot, ROBOT, typed(b=CLOUD) + "nodes:\n  /camera: {source: [Video]}\n")
    text = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    assert text.index("/finder") < text.index("/mover")
    assert text.index("node    /finder") < text.index("topic   /b")
    assert "neighbour of /camera, which Video reaches" in text
    suggested = rows(cli, robot)
    assert ("/finder", "conduit", "Video", "may") in suggested
    assert ("/a", "sensitive", "Video", "may") in suggested
    assert not [row for row in suggested if row[0] == "/camera" and row[2] == "Video"]  # a person has spoken of it


@pytest.mark.parametrize(
    ("labels", "node", "expected"),
    [
        ("", "/customer_bridge", ["leak PersonalData"]),  # S7: a conduit of a narrower kind would outrank the leak
        ("  /mover: {leak: [Voice]}\n", "/mover", ["leak Video"]),
        ("  /customer_bridge: {leak: [Voice]}\n", "/customer_bridge", ["leak Video", "leak PersonalData"]),
    ],
)
def test_of_an_open_node_that_lets_data_out_a_leak_is_suggested_and_no_conduit(
    cli: Cli, robot: Path, labels: str, node: str, expected: list[str]
) -> None:
    write(robot, FILMED + labels)
    assert [f"{role} {kind}" for name, role, kind, _ in rows(cli, robot) if name == node] == expected


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
    labels = f'{FILMED}  "/*": conduit\n{entry}topics:\n  /image: sensitive\n'
    robot_of(tmp_path, {"camera": (["/image"], []), "cloud_uploader": ([], ["/image"])}, labels)
    suggested = [one for one in document_of(cli, tmp_path)["suggestions"] if one["name"] == "/cloud_uploader"]
    assert [(one["role"], one["confidence"]) for one in suggested] == ([("leak", "may")] if asked else [])
    for one in suggested:
        glob, name, *_ = one["evidence"]
        assert (glob["ground"], glob["file"], glob["line"], name["ground"]) == ("glob", "l.yaml", 5, "name")
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=tmp_path)
    accept(cli, tmp_path, "/cloud_uploader")
    findings = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml").findings
    assert [one.leak.name for one in findings] == (["/cloud_uploader"] if asked else [])


def test_what_a_channel_is_not_made_for_is_a_never_and_never_sure(cli: Cli, robot: Path) -> None:
    write(robot, FILMED)
    (robot / "types.yaml").write_text(f"types: 1\ntopics:\n  /c: [{{type: {IDS}}}]\n", "utf-8")
    suggested = rows(cli, robot, "--types", "types.yaml")
    assert ("/c", "never", "Video", "may") in suggested
    assert ("/c", "sensitive", "Video", "may") not in suggested  # one answer to a question
    write(robot, f"{FILMED}topics: {{/c: mundane}}\n")
    assert not [row for row in rows(cli, robot, "--types", "types.yaml") if row[0] == "/c"]


# ---------------------------------------------------------------- what a user brings along


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
    assert ("/camera", "source", "Crate", "likely") in rows(cli, robot, "--rules", "own.yaml", "--ontology", "own.ttl")
    wrong = cli("suggest", "p.xml", "--rules", "own.yaml", cwd=robot)
    assert (wrong.returncode, wrong.stderr.partition(";")[0]) == (2, "own.yaml:3: unknown category 'Crate'")


def node_code(name: str, *lines: str, imports: str = "requests") -> str:
    """A node in Python, whose constructor runs these lines from line 8 on."""
    body = "".join(f"        {line}\n" for line in lines)
    return (
        f"import {imports}\nfrom rclpy.node import Node\nfrom sensor_msgs.msg import Image\n\n\nclass A(Node):\n"
        f"    def __init__(self):\n        super().__init__({name!r})\n{body}"
    )


def write_code(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")


def test_what_code_uses_is_shown_with_its_line_and_so_is_code_of_no_node(cli: Cli, robot: Path) -> None:
    shows = "import cv2\ncv2.imshow('x', 1)\n"
    write(robot, "labels: 1\n")
    write_code(robot, {
        "code/finder.py": node_code("finder", "requests.post('x')", "badge.show()", imports="badge, requests"),
        "code/tool.py": shows,
        "code/wrong.py": "def\n",
        "code/vendor/lib.py": shows,
        "own.yaml": "library_rules: 1\nlets_out:\n"
        "  - {python: [badge.show], kinds: [StaffBadge], where: display, confidence: likely, why: ours}\n",
    })  # fmt: skip
    own = ("--source", "code", "--libraries", "own.yaml")
    assert ("/finder", "leak", "StaffBadge", "may") in rows(cli, robot, *own)
    assert not [row for row in rows(cli, robot, *own[:2]) if row[2] == "StaffBadge"]
    text = cli("suggest", "p.xml", *own, cwd=robot).stdout
    assert "requests.post (code/finder.py:9)" in text
    assert "code/wrong.py:1: not Python" in text
    assert "cv2.imshow (code/tool.py:2)" in text
    assert "code/vendor\n" in text  # code of others is not looked at
    named = cli("suggest", "p.xml", "--source", "code/vendor", cwd=robot).stdout
    assert "code/vendor" not in named.partition("1 use")[0]
    assert refused(cli("suggest", "p.xml", "--libraries", "l.yaml", cwd=robot))[0].startswith("l.yaml:1: ")


def test_a_package_of_the_sources_that_is_called_as_a_library_is_a_notice(cli: Cli, robot: Path) -> None:
    """Which one Python imports, nobody knows here: the leak would be missed without a word."""
    write(robot, "labels: 1\n")
    write_code(robot, {
        "src/finder/finder/__init__.py": "",
        "src/finder/finder/node.py": node_code("finder", "requests.post('x')", "requests.put('x')"),
        "src/requests/requests/__init__.py": "",
    })  # fmt: skip
    text = cli("suggest", "p.xml", "--source", "src", cwd=robot).stdout
    assert "uses requests.post" not in text
    (notice,) = [line for line in text.splitlines() if "notice" in line]
    assert notice.startswith(
        "notice: src/finder/finder/node.py:9: requests.post is taken for src/requests/requests/__init__.py "
    )
    (robot / "src" / "requests").rename(robot / "src" / "other")
    (robot / "src" / "other" / "requests").rename(robot / "src" / "other" / "deeper")
    text = cli("suggest", "p.xml", "--source", "src", cwd=robot).stdout
    assert "uses requests.post (src/finder/finder/node.py:9)" in text
    assert "notice" not in text


def test_code_gives_types_with_its_line(cli: Cli, robot: Path) -> None:
    write(robot, "labels: 1\n")
    write_code(robot, {"driver.py": node_code("camera", "self.create_publisher(Image, '/a', 1)")})
    assert ("/camera", "source", "Video", "may") in rows(cli, robot)  # by its name
    assert ("/camera", "source", "Video", "likely") in rows(cli, robot, "--source", "driver.py")
    text = cli("suggest", "p.xml", "--source", "driver.py", cwd=robot).stdout
    assert "type sensor_msgs/msg/Image of /a (driver.py:9)" in text
    assert "Image" not in cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout  # nothing follows from code


@pytest.mark.parametrize("now", [IDS, STRING])
def test_a_limit_whose_type_is_another_one_now_is_a_notice(cli: Cli, robot: Path, now: str) -> None:
    """Somebody accepted it from a list, since nothing of it can be in identifiers."""
    note = f"answered by Ada on 2026-01-01 in a list of 2: type {IDS} of /c is not made for Video"
    write(robot, f'{FILMED}topics:\n  /c: {{types: [{now}], never: [Video], note: "{note}"}}\n')
    for command in ("suggest", "analyze"):
        done = cli(command, "p.xml", "-l", "l.yaml", cwd=robot)
        shown = " ".join((done.stdout + done.stderr).split())
        assert (f"its type was {IDS}; it is {now} now (l.yaml:6)" in shown) is (now != IDS), shown


def test_nothing_is_applied(cli: Cli, robot: Path) -> None:
    before = {file: file.read_bytes() for file in robot.iterdir()}
    answer = cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    done = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout  # S14
    assert {file: file.read_bytes() for file in robot.iterdir()} == before
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout == answer


def test_where_there_is_nothing_to_suggest_the_answer_says_so(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"n": (["/x"], [])}), "utf-8")
    done = cli("suggest", "p.xml", cwd=tmp_path)
    assert (done.returncode, done.stdout.partition(":")[0]) == (0, "nothing to suggest")


OWN_CAMERA = """package: 1
name: usb_cam
about: Mine.
sources: [{at: https://example.org, version: "1", read: 2026-11-23}]
nodes: [{names: [usb_cam], says: [{conduit: all, why: it says so}]}]
"""


def test_a_package_in_place_of_a_shipped_one_is_a_notice_and_takes_no_source_away(cli: Cli, tmp_path: Path) -> None:
    robot_of(tmp_path, {"usb_cam": (["/x"], ["/y"])}, "labels: 1\n")
    (tmp_path / "mine.yaml").write_text(OWN_CAMERA, "utf-8")
    (notice,) = document_of(cli, tmp_path, "--packages", "mine.yaml")["notices"]
    assert (notice["file"], notice["line"]) == ("mine.yaml", 1)
    assert "source of Video at usb_cam" in notice["message"]
    shown = f"mine.yaml:1: {notice['message']}"
    done = cli("suggest", "p.xml", "--packages", "mine.yaml", cwd=tmp_path)
    assert done.stdout.splitlines()[0] == f"notice: {shown}"
    assert "source Video" in done.stdout
    assert shown in cli("suggest", "p.xml", "--packages", "mine.yaml", "--into", "l.yaml", cwd=tmp_path).stderr


# ---------------------------------------------------------------- fleets


def test_of_a_fleet_robots_that_are_alike_are_asked_about_once(cli: Cli) -> None:
    fleet = ("suggest", "--fleet", "examples/fleet/fleet.yaml")
    document = json.loads(cli(*fleet, "-f", "json", cwd=ROOT).stdout)
    jsonschema.validate(document, SCHEMA)
    asked = {one["robot"] for one in document["suggestions"]}
    assert asked == {"carrier_01", "carrier_lent", "cleaner_1", "guide_01"}
    stands = {one["robot"]: (one["model"], len(one["alike"])) for one in document["robots"]}
    assert stands["carrier_01"] == ("carrier", 23)
    assert re.search(r"(?m)^  node    cleaner_1:/lidar ", cli(*fleet, cwd=ROOT).stdout)


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


def test_a_no_is_one_of_the_robots_that_read_its_file_and_of_no_others(cli: Cli, tmp_path: Path) -> None:
    """Those of a model, or one robot of another model with a file of its own."""
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
    shown = cli("suggest", "--fleet", "fleet.yaml", cwd=tmp_path).stdout
    asked = re.findall(r"(\w+):/camera +source Video ", shown)
    assert asked
    assert not [name for name in asked if name.startswith("m")]
    assert not re.search(r"/camera +source Video ", cli("suggest", "p.xml", "-l", "own.yaml", cwd=tmp_path).stdout)


def test_suggestions_for_a_fleet_are_not_written_into_one_label_file(cli: Cli, tmp_path: Path) -> None:
    done = cli("suggest", "--fleet", str(ROOT / "examples/fleet/fleet.yaml"), "--into", "l.yaml", cwd=tmp_path)
    assert done.returncode == 2
    assert "--into" in done.stderr
    assert not (tmp_path / "l.yaml").exists()


# ---------------------------------------------------------------- written into a label file, and accepted


def test_suggestions_are_comments_that_change_no_answer(cli: Cli, robot: Path) -> None:
    text = "labels: 1  # mine\n# kept\ntopics:\n  /a: {types: [sensor_msgs/msg/Image]}\n"
    write(robot, text)
    before = cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout.partition("labels l")[0]
    for named in (("-l", "l.yaml"), ()):  # those of an earlier run are replaced; the file is read without being named
        done = cli("suggest", "p.xml", *named, "--into", "l.yaml", cwd=robot)
        assert (done.returncode, done.stdout) == (0, "")
        assert text_of(robot).startswith(text)
        lines = text_of(robot).removeprefix(text).splitlines()
        assert all(line.startswith("# suggest: ") for line in lines)
        assert done.stderr.startswith(f"l.yaml: {len(lines)} suggestions")
    assert before
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout.startswith(before)


def test_the_file_that_is_written_into_is_read_without_being_named(cli: Cli, robot: Path) -> None:
    write(robot, LEAKS)
    cli("suggest", "p.xml", "--into", "l.yaml", cwd=robot)
    assert '"/finder"' in text_of(robot)
    assert '{"/camera": {"source": ["Video"]}}' not in text_of(robot)


def test_one_element_is_accepted_with_who_when_and_why(cli: Cli, robot: Path) -> None:
    labels = text_of(robot)
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
    comments = text_of(robot).removeprefix(labels).splitlines()
    done = accept(cli, robot, "/camera")
    assert (done.returncode, done.stderr) == (0, "l.yaml: 1 suggestion accepted\n")
    assert text_of(robot).startswith(labels)
    (line,) = [line for line in text_of(robot).splitlines() if line.startswith("  /camera:")]
    assert line.startswith("  /camera: {source: [Video]")
    assert "accepted by Ada on 2026-01-01 (likely): type sensor_msgs/msg/Image of /a" in line
    left = [line for line in comments if '{"/camera": {"source": ["Video"]' not in line]
    assert [line for line in text_of(robot).splitlines() if line.startswith("# suggest")] == left
    roles = rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml")).document()["roles"]
    stated = [(one["element"]["name"], *one["roles"], one["category"]) for one in roles]
    assert stated == [("/camera", "source", "Video")]


def test_no_reason_is_cut(cli: Cli, tmp_path: Path) -> None:
    cli("suggest", str(CARE), "--into", "l.yaml", cwd=tmp_path)
    reason = re.search(r'(?m)^# suggest: \w+ .*"/face_recognizer".*FaceImage.* because (.*)$', text_of(tmp_path))
    assert reason
    accept(cli, tmp_path, "/face_recognizer=FaceImage")
    assert "…" not in text_of(tmp_path)
    note = text_of(tmp_path).partition("# suggest")[0]
    assert reason[1].partition(": ")[0].partition("; ")[0] in note


def test_all_of_a_confidence_are_accepted_but_what_could_hide_a_leak(cli: Cli, robot: Path) -> None:
    cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.yaml", cwd=robot)
    assert accept(cli, robot, "likely").returncode == 0
    text = text_of(robot)
    assert "# suggest: likely" not in text
    assert "could hide a leak" in accept(cli, robot, "may").stderr
    left = [line for line in text_of(robot).splitlines() if line.startswith("# suggest")]
    assert left
    assert all(re.search(r'"(sanitizer|conduit|never)"', line) for line in left)
    write(robot, re.sub(r"^  /customer_bridge: .*\n", "", text, flags=re.MULTILINE))
    assert accept(cli, robot, "/finder", policies=["p.xml"]).returncode == 0
    assert "sanitizer: {Video: drop}" in text_of(robot)


def test_of_alternatives_a_person_says_which(cli: Cli, tmp_path: Path) -> None:
    """Where data end a node lets them out or is a conduit: neither is accepted by a word, or by the node's name."""
    robot_of(tmp_path, {"camera": (["/a"], []), "unknown": ([], ["/a"])}, FILMED)
    assert [row[1:] for row in rows(cli, tmp_path) if row[0] == "/unknown"] == [
        ("leak", "Video", "may"), ("conduit", "Video", "may"),
    ]  # fmt: skip
    cli("suggest", "p.xml", "--into", "l.yaml", cwd=tmp_path)
    assert "2 suggestions could hide a leak" in accept(cli, tmp_path, "may").stderr
    before = text_of(tmp_path)
    assert "/unknown:" not in before
    (line,) = refused(accept(cli, tmp_path, "/unknown"))
    assert re.search(r"leak Video \(line \d+\), conduit Video \(line \d+\); say which", line)
    assert text_of(tmp_path) == before
    assert accept(cli, tmp_path, "/unknown=leak").returncode == 0
    assert "/unknown: {leak: [Video]" in text_of(tmp_path)


def test_of_what_a_camera_could_be_a_person_says_which(cli: Cli, robot: Path) -> None:
    lines = [suggestion("nodes", "/camera", {"source": [kind]}) for kind in ("DepthImage", "ThermalImage")]
    write(robot, "labels: 1\nauthor: Ada\n" + "".join(lines))
    assert "DepthImage (line 3), source ThermalImage (line 4)" in refused(accept(cli, robot, "/camera"))[0]
    assert "'Voice' is not suggested of /camera" in refused(accept(cli, robot, "/camera=Voice"))[0]
    assert accept(cli, robot, "/camera=ThermalImage").returncode == 0
    assert "source: [ThermalImage]" in text_of(robot)
    assert text_of(robot).endswith(lines[0])
    assert accept(cli, robot, "/camera=*").returncode == 0
    assert "source: [ThermalImage, DepthImage]" in text_of(robot)


# ---------------------------------------------------------------- a limit on the way of what is accepted


SOURCE = '# suggest: likely {"nodes": {"/camera": {"source": ["Video"]}}} because x\n'
ACCEPTED = "l.yaml: 1 suggestion accepted\n"
TAKEN = "never of topic /front takes Video away, which is accepted now"


@pytest.fixture
def limited(tmp_path: Path) -> Path:
    """Somebody said ``never`` of /front, when no source was known."""
    nodes: Nodes = {"camera": (["/front", "/side"], []), "box": ([], ["/front"]), "other": ([], ["/side"])}
    leak = suggestion("nodes", "/box", {"leak": ["Video"]}, "may")
    limit = "labels: 1\nauthor: Ada\ntopics:\n  /front: {never: [Video]}\n"
    return robot_of(tmp_path, nodes, f"{limit}{SOURCE}{leak}")


def test_a_limit_on_the_way_of_data_that_are_accepted_later_is_told(cli: Cli, limited: Path) -> None:
    source = accept(cli, limited, "likely", policies=["p.xml"])
    assert (source.returncode, source.stderr.count("\n")) == (0, 2)
    assert TAKEN in source.stderr
    assert source.stderr.endswith(ACCEPTED)
    leak = accept(cli, limited, "/box", policies=["p.xml"])
    assert f"{TAKEN}; behind it lies the leak /box" in leak.stderr


def test_a_limit_is_told_of_each_source_of_the_same_kind(cli: Cli, limited: Path) -> None:
    """The line took the pictures of one camera away already; that it takes those of another one, too, nobody knew."""
    nodes: Nodes = {"camera": (["/front", "/side"], []), "second": (["/front"], []), "third": (["/side"], [])}
    nodes |= {"box": ([], ["/front"]), "other": ([], ["/side"])}
    (limited / "p.xml").write_text(policy_of(nodes), "utf-8")
    accept(cli, limited, "/camera", policies=["p.xml"])
    for name, limit in (("/second", True), ("/third", False)):
        write(limited, text_of(limited) + suggestion("nodes", name, {"source": ["Video"]}))
        done = accept(cli, limited, name, policies=["p.xml"])
        assert done.stderr.endswith(ACCEPTED)
        assert (TAKEN in done.stderr) is limit


@pytest.mark.parametrize(
    ("entry", "limit"),
    [
        ("/front: {never: [Video]}", True),
        ("/front: {never: [Voice]}", False),
        ("/front: {never: [PersonImage]}", True),
        ("/front: mundane", True),
        ("/front: {only: [Voice]}", True),
        ("/front: {only: [PersonImage]}", False),
        ("/front: sensitive", False),
    ],
)
def test_a_limit_of_these_data_is_told_and_without_policies_as_one_that_may_be_on_the_way(
    cli: Cli, limited: Path, *, entry: str, limit: bool
) -> None:
    for policies in ([], ["p.xml"]):
        write(limited, f"labels: 1\nauthor: Ada\ntopics:\n  {entry}\n{SOURCE}")
        done = accept(cli, limited, "likely", policies=policies)
        assert (done.returncode, done.stderr.endswith(ACCEPTED)) == (0, True)
        assert ("/front" in done.stderr) is limit
        assert ("name the policies" in done.stderr) is (limit and not policies)


def test_a_limit_elsewhere_is_not_on_the_way(cli: Cli, limited: Path) -> None:
    nodes: Nodes = {"camera": (["/front"], []), "box": (["/other"], [])}
    robot_of(limited, nodes, f"labels: 1\nauthor: Ada\ntopics:\n  /other: {{never: [Video]}}\n{SOURCE}")
    assert accept(cli, limited, "likely", policies=["p.xml"]).stderr == ACCEPTED


def test_what_is_accepted_in_one_go_is_known_before_data_are_taken_away(cli: Cli, tmp_path: Path) -> None:
    """The source makes a finding, which the channel would close: both stand in one command."""
    never = suggestion("topics", "/front", {"never": ["Video"]})
    labels = f"labels: 1\nauthor: Ada\nnodes:\n  /box: {{leak: [Video]}}\n{SOURCE}{never}"
    robot_of(tmp_path, {"camera": (["/front"], []), "box": ([], ["/front"])}, labels)
    done = cli("labels", "p.xml", "-l", "l.yaml", "--accept", "likely", "--accept", "/front", cwd=tmp_path)
    assert "(Video: /camera -> /box" in done.stderr
    assert done.stderr.endswith(ACCEPTED)
    assert text_of(tmp_path).endswith(never)
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path).returncode == 1


# ---------------------------------------------------------------- into an entry that is there


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


@pytest.mark.parametrize(
    ("name", "label", "entry"),
    [
        ("/camera", {"source": ["Video"]}, "/camera: {source: [Video], leak: [Voice], note: "),
        ("/camera", {"leak": ["Video"]}, "/camera: {leak: [Voice, Video], note: "),
        ("/camera", {"conduit": ["Video"]}, "/camera: {conduit: [Video], leak: [Voice], note: "),
        ("/empty", {"source": ["Video"]}, "/empty: {source: [Video], note: "),
        ("/t", {"sensitive": ["Video"]}, "/t: {sensitive: [Video], never: [Voice], note: "),
    ],
)
def test_a_suggestion_joins_what_an_entry_says(
    cli: Cli, tmp_path: Path, name: str, label: dict[str, Any], entry: str
) -> None:
    """One line changes; a note and a comment by hand stay."""
    write(tmp_path, BY_HAND + suggestion("topics" if name == "/t" else "nodes", name, label))
    assert accept(cli, tmp_path, name).returncode == 0
    pairs = zip(BY_HAND.splitlines(), text_of(tmp_path).splitlines(), strict=True)
    ((before, after),) = [(old, new) for old, new in pairs if old != new]
    assert entry in after
    assert "accepted by Ada on 2026-01-01 (likely): x" in after
    assert ("mine; accepted" in after) == ("note: mine" in before)
    assert ("# at the door" in after) == ("# at the door" in before)


@pytest.mark.parametrize(
    ("name", "label", "why"),
    [
        ("/relay", {"source": ["Voice"]}, "another form"),
        ("/camera", {"conduit": ["Voice"]}, "is a leak"),
        ("/camera", {"conduit": ["PersonalData"]}, "is a leak"),
        ("/camera", {"sanitizer": {"Voice": "drop"}}, "would take data away"),
        ("/relay", {"sanitizer": {"Video": "drop"}}, "would take data away"),
        ("/passes", {"leak": ["PersonalData"]}, "is a conduit"),
    ],
)
def test_what_does_not_go_with_an_entry_leaves_it_as_it_is(
    cli: Cli, tmp_path: Path, name: str, label: dict[str, Any], why: str
) -> None:
    line = suggestion("nodes", name, label)
    write(tmp_path, BY_HAND + line)
    done = accept(cli, tmp_path, name)
    assert (done.returncode, text_of(tmp_path)) == (0, BY_HAND + line)
    assert f"{name} " in done.stderr
    assert why in done.stderr


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        ("labels: 1\n", ["--accept", "/x", "--by", "A"], "l.yaml: nothing is suggested of /x"),
        ("labels: 1\n", ["--accept", "may"], "l.yaml: nobody says who accepts"),
        ("labels: 1\n# suggest: x\n", ["--accept", "may", "--by", "A"], "l.yaml:2: "),
        ("labels: 1\n" + suggestion("nodes", "/x", {"source": ["Vidoe"]}), ["--accept", "/x", "--by", "A"],
         "l.yaml: a suggestion makes no label: unknown category 'Vidoe'"),
        ("labels: 1\n" + suggestion("nodes", "/x", {"surce": ["Video"]}), ["--accept", "/x", "--by", "A"],
         "l.yaml: a suggestion makes no label: unknown key 'surce'"),
        ('labels: 1\nauthor: "A\n' + suggestion("nodes", "/x", {"source": ["Video"]}).strip() + '"\n',
         ["--accept", "/x"], "l.yaml"),
        ("labels: 1\nauthor: Jos\xe9\n", ["--accept", "may"], "l.yaml:2: not UTF-8"),
    ],
)  # fmt: skip
def test_what_cannot_be_accepted_leaves_the_file_as_it_is(
    cli: Cli, tmp_path: Path, text: str, arguments: list[str], message: str
) -> None:
    (tmp_path / "l.yaml").write_bytes(text.encode("latin-1"))
    assert refused(cli("labels", *arguments, "-l", "l.yaml", cwd=tmp_path))[0].startswith(message)
    assert (tmp_path / "l.yaml").read_bytes() == text.encode("latin-1")


def test_of_a_file_that_is_not_there_nothing_is_accepted(cli: Cli, robot: Path) -> None:
    (line,) = refused(cli("labels", "--accept", "may", "--by", "A", "-l", "ll.yaml", cwd=robot))
    assert line == "ll.yaml: file not found; did you mean l.yaml?"
    assert not (robot / "ll.yaml").exists()


def test_where_nothing_is_suggested_nothing_is_accepted_and_that_is_no_error(cli: Cli, robot: Path) -> None:
    write(robot, BY_HAND)
    done = accept(cli, robot, "may")
    assert (done.returncode, text_of(robot)) == (0, BY_HAND)
    assert done.stderr.endswith("\nl.yaml: 0 suggestions accepted\n")


def test_json_has_no_room_for_comments(cli: Cli, robot: Path) -> None:
    (robot / "l.json").write_text('{"labels": 1}', "utf-8")
    done = cli("suggest", "p.xml", "-l", "l.yaml", "--into", "l.json", cwd=robot)
    assert (done.returncode, (robot / "l.json").read_text("utf-8")) == (2, '{"labels": 1}')


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_name_gets_into_neither_the_file_nor_the_terminal(cli: Cli, tmp_path: Path, name: str) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"n": ([name], []), "up": ([], [name])}), "utf-8")
    if cli("analyze", "p.xml", cwd=tmp_path).returncode == 2:
        pytest.skip("the policy's reader refuses such a name")
    shown = cli("suggest", "p.xml", cwd=tmp_path).stdout
    assert all(character.isprintable() or character == "\n" for character in shown)
    assert cli("suggest", "p.xml", "--into", "l.yaml", cwd=tmp_path).returncode == 0
    assert all(line.startswith(("labels: 1", "# suggest: ")) for line in text_of(tmp_path).splitlines())
    assert cli("labels", "--accept", "may", "--by", 'A"\n- x: y', "-l", "l.yaml", cwd=tmp_path).returncode == 0
    document = rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).document()
    assert {one["element"]["name"] for one in document["roles"]} <= {"/n"}


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
DROP = suggestion("nodes", "/finder", {"sanitizer": {"Video": "drop"}}, "may")


@pytest.mark.parametrize(
    "line",
    [
        suggestion("topics", "/a", {"never": ["Video"]}),
        suggestion("topics", "/a", {"only": ["HomeMap"]}, "certain"),
        DROP.replace("may", "certain"),
    ],
)
def test_what_takes_data_away_is_accepted_by_name_only_however_sure(cli: Cli, robot: Path, line: str) -> None:
    """Rule S7, taking away is never silent; a package of a user's or an old suggestion may call it likely."""
    write(robot, LEAKS + line)
    assert "1 suggestion could hide a leak" in accept(cli, robot, "likely").stderr
    assert text_of(robot) == LEAKS + line
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=robot).stdout.startswith("leak: ")


def test_a_comment_that_is_older_than_a_finding_does_not_close_it(cli: Cli, robot: Path) -> None:
    """Written when no leak was known; without the policies nobody knows, with them the finding is told."""
    write(robot, LEAKS + DROP)
    alone = accept(cli, robot, "/finder")
    assert alone.stderr.startswith("l.yaml:9: /finder would take data away; name the policies")
    known = accept(cli, robot, "/finder", policies=["p.xml"])
    assert re.match(r"l.yaml:9: .* \(Video: /camera -> /customer_bridge \[[0-9a-f]{16}\]\); ", known.stderr)
    assert text_of(robot) == LEAKS + DROP


def test_by_its_name_too_what_takes_data_away_comes_last(cli: Cli, robot: Path) -> None:
    derives = suggestion("nodes", "/finder", {"derives": [{"from": "Video", "to": "FaceImage"}]}, "may")
    write(robot, LEAKS.replace("leak:", "conduit:") + DROP + derives)
    assert "1 suggestion accepted" in accept(cli, robot, "/finder", policies=["p.xml"]).stderr
    assert text_of(robot).endswith(DROP)
    assert "1 suggestion accepted" in accept(cli, robot, "/finder", policies=["p.xml"]).stderr


@pytest.mark.parametrize(
    ("label", "why"),
    [
        ({"conduit": ["Video"]}, "is a leak of such data already, by line 5"),
        ({"sanitizer": {"PersonImage": "drop"}}, "would take data away of which a finding is known"),
    ],
)
def test_nothing_that_hides_is_put_beside_a_leak_that_a_glob_says(
    cli: Cli, robot: Path, label: dict[str, Any], why: str
) -> None:
    text = LEAKS + suggestion("nodes", "/customer_bridge", label, "may")
    write(robot, text)
    assert f"l.yaml:9: /customer_bridge {why}" in accept(cli, robot, "/customer_bridge", policies=["p.xml"]).stderr
    assert text_of(robot) == text


def test_the_last_line_says_what_can_be_accepted(cli: Cli, robot: Path) -> None:
    for arguments, word in ((("p.xml", "-l", "l.yaml"), "likely"), ((str(CARE),), "NAME")):
        last = cli("suggest", *arguments, cwd=robot).stdout.splitlines()[-1]
        assert f"rosprivacy labels --accept {word} --by " in last


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

    return Interview(Asking("m", "http://localhost/v1", masked=False, limit=10_000), reply, lambda _: None)


def accept_everything(policy: str, file: Path, model: Sequence[str] = ()) -> None:
    """All of a confidence, and then each by its name, of alternatives first what hides more.

    A model, if there is one, says these roles of everything.
    """
    for _ in range(2):
        interview = hostile(["Video", "PersonalData"], model) if model else None
        asked = suggest_labels((policy,), (str(file),), Settings(), interview=interview)
        file.write_text(with_suggestions(str(file), asked).text, "utf-8")
        file.write_text(with_accepted((str(file),), ["may"], "anybody", Settings()).text, "utf-8")
        for line, what in (('"conduit"', "=conduit"), ("# suggest", "=*")):
            left = [one for one in file.read_text("utf-8").splitlines() if one.startswith("# suggest") and line in one]
            names = [f"{json.loads(name)}{what}" for name in dict.fromkeys(NAMED.findall("\n".join(left)))]
            file.write_text(with_accepted((str(file),), names, "anybody", Settings(), (policy,)).text, "utf-8")


def accept_without_looking(policy: str, file: Path) -> None:
    """By a word and by bare names, as far as the program takes it: what a person does who reads nothing."""
    for _ in range(3):
        text = with_suggestions(str(file), suggest_labels((policy,), (str(file),), Settings())).text
        file.write_text(text, "utf-8")
        for what in ("may", *map(json.loads, dict.fromkeys(NAMED.findall(text)))):
            with suppress(InputErrors):  # alternatives, or nothing is suggested of it any more
                file.write_text(with_accepted((str(file),), [what], "anybody", Settings(), (policy,)).text, "utf-8")


PLANTED = "nodes:\n  /camera: {source: [Video]}\n  /customer_bridge: {leak: [Video]}\n"


def verdict(folder: Path) -> str:
    answer = rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml"), type_limits=None)
    return answer.analysis.verdict


def test_accepting_every_suggestion_hides_no_planted_leak(robot: Path) -> None:
    """Of an example with types, so that sanitizers and nevers are suggested too."""
    write(robot, text_of(robot) + PLANTED)
    assert verdict(robot) == "leak"
    accept_everything(str(robot / "p.xml"), robot / "l.yaml")
    assert "sanitizer" not in text_of(robot)
    assert verdict(robot) == "leak"


HIDES = ("never", "mundane", "sanitizer", "conduit")
ADDS = ("derivation", "sensitive", "source", "leak")


@pytest.mark.parametrize("roles", [HIDES, ADDS, (*HIDES, *ADDS)])
def test_a_hostile_model_hides_no_planted_leak(robot: Path, roles: Sequence[str]) -> None:
    """Whatever it says of everything, with a quote, and whatever of that a person accepts."""
    write(robot, f"labels: 1\n{PLANTED}")
    accept_everything(str(robot / "p.xml"), robot / "l.yaml", roles)
    assert ("language model" in text_of(robot)) == (roles != HIDES)
    assert verdict(robot) == "leak"


def test_a_leak_that_nobody_has_labelled_is_not_accepted_away_without_looking(tmp_path: Path) -> None:
    """At an end of data, and at one behind a node that passes them on."""
    nodes: Nodes = {"eye": (["/a"], []), "middle": (["/b"], ["/a"]), "here": ([], ["/a"]), "roof": ([], ["/b"])}
    robot_of(tmp_path, nodes, "labels: 1\nnodes:\n  /eye: {source: [Video]}\n")
    accept_without_looking(str(tmp_path / "p.xml"), tmp_path / "l.yaml")
    assert "/middle: {conduit: [Video]" in text_of(tmp_path)
    analysis = rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).analysis
    assert analysis.verdict == "undetermined"
    assert {one.element.name for one in analysis.open} == {"/here", "/roof"}


@pytest.mark.slow
@pytest.mark.corpus
@pytest.mark.parametrize("model", [pytest.param((), marks=pytest.mark.thorough), (*HIDES, *ADDS)])
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
            accepted = rosprivacy.analyze(str(file), str(labels))
            assert accepted.analysis.verdict != "no-leak-found", f"{file}: {path}"
            tried += 1
    assert tried > 5


def test_the_surest_reason_is_told_and_all_of_one_element_on_demand(cli: Cli, robot: Path) -> None:
    """What is told on demand is all that the document has, the surest first."""
    reasons = {
        (one["role"], one["kind"]): [reason["reason"] for reason in one["evidence"]]
        for one in document_of(cli, robot)["suggestions"]
        if one["name"] == "/camera"
    }
    assert max(map(len, reasons.values())) > 1
    text = cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    whole = cli("suggest", "p.xml", "-l", "l.yaml", "--why", "/camera", cwd=robot).stdout
    for some in reasons.values():
        assert some[0] in text
        assert [whole.index(reason) for reason in some] != []
    assert not [some[-1] for some in reasons.values() if len(set(some)) > 1 and f"            {some[-1]}\n" in text]
    assert ": --why /camera\n" in text
    assert "/finder" not in {line.split()[1] for line in whole.splitlines() if line.startswith("  node")}


def test_who_asks_why_of_what_nothing_is_suggested_is_told_what_is_near(cli: Cli, robot: Path) -> None:
    (line,) = refused(cli("suggest", "p.xml", "-l", "l.yaml", "--why", "/camra", cwd=robot))
    assert line.startswith("--why: nothing is suggested of /camra; did you mean /camera")
    for more in (("-f", "json"), ("--into", "l.yaml")):
        assert cli("suggest", "p.xml", "-l", "l.yaml", "--why", "/camera", *more, cwd=robot).returncode == 2


def test_lines_are_broken_at_the_width_of_a_terminal(cli: Cli, tmp_path: Path) -> None:
    robot_of(tmp_path, {"usb_cam": (["/image_raw"], []), "foxglove_bridge": ([], ["/image_raw"])}, "labels: 1\n")
    wide = cli("suggest", "p.xml", cwd=tmp_path).stdout
    shown = cli("suggest", "p.xml", cwd=tmp_path, FORCE_COLOR="1", COLUMNS="80").stdout
    assert max(map(len, wide.splitlines())) > 80 >= max(map(len, shown.splitlines()))
    assert shown.split() == wide.split()
