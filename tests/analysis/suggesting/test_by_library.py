"""What libraries say of nodes, by what these write and read: the rules of ``nodes.py``."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.analysis.suggesting.evidence import CODE
from rosprivacy.labelling.knowledge import UserFiles
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import policy

HEAD = (
    "import {library}\nfrom rclpy.node import Node\nfrom sensor_msgs.msg import Image\n"
    "from std_msgs.msg import Bool, String\nfrom vision_msgs.msg import Detection2DArray as Found\n"
    "from geometry_msgs.msg import Twist, Vector3\nfrom hri_msgs.msg import Skeleton2D\n"
    "class N(Node):\n    def __init__(self):\n        super().__init__('n')\n"
)
LINE = "        self.x = {}\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def said(writes: str, reads: str, *calls: str) -> set[str]:
    """What the code of a node says, with one channel of a type that it writes and one that it reads, or none."""
    libraries = {call.partition("(")[0].partition(".")[0] for call in calls} - {"open", "input"}
    code = HEAD.format(library=", ".join(sorted(libraries)) or "os")
    code += LINE.format(f"self.create_publisher({writes}, '/w', 1)") if writes else ""
    code += LINE.format(f"self.create_subscription({reads}, '/r', self.cb, 1)") if reads else ""
    code += "".join(LINE.format(call) for call in calls)
    Path("n.py").write_text(code, "utf-8")
    Path("p.xml").write_text(policy(f"/n>{'/w' if writes else ''}<{'/r' if reads else ''}", "/m>/r</w"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    return {
        " ".join(filter(None, [one.label.role, one.label.kind, one.label.to, str(reason.confidence)]))
        for one in found
        for reason in one.evidence
        if reason.ground == CODE and one.label.element.name == "/n"
    }


CAMERA, MICROPHONE, POSE = "cv2.VideoCapture(0)", "sounddevice.InputStream()", "mediapipe.solutions.pose.Pose()"
SEEN = {
    "source PersonDetection may",
    "source Location may",
    "source Behaviour may",
}  # what pictures may tell of persons
HEARD = {"source CommunicationContent may", "source Location may"}


@pytest.mark.parametrize(
    ("writes", "reads", "calls", "told"),
    [
        # 1. What it brings in, it is a source of: as the rule says, or may.
        ("Image", "", [CAMERA], {"source Video likely"}),
        ("Image", "Image", [CAMERA], {"source Video may"}),
        ("Unknown", "", [CAMERA], {"source Video may", *SEEN}),
        ("", "Bool", [CAMERA], set()),
        ("Twist", "", ["readchar.readkey()"], {"source OperatorInput may"}),  # any node may: it needs a second ground
        ("Image", "", [MICROPHONE], {"source Voice may", *HEARD}),  # no type of it is made for sound
        ("Twist", "", ["input('?')"], {"source OperatorInput may"}),  # often a question when it starts
        # 2. What never comes into ROS is told by what is made of it.
        ("Found", "", [CAMERA], {"source HouseholdObject may", *SEEN}),
        ("Skeleton2D", "", [CAMERA], {"source BodyPose may", *SEEN}),
        ("Twist", "", [CAMERA], SEEN),  # it may follow somebody
        ("Twist", "Image", [CAMERA], set()),  # that may be made of what it reads
        ("String", "", [CAMERA], {"source Video may", *SEEN}),
        ("Vector3", "", ["pynmea2.parse(x)"], {"source GnssPosition may"}),  # three numbers, of any sort
        # 3. What makes one kind of another.
        ("Skeleton2D", "Image", [POSE], {"derivation Video BodyPose may"}),  # of pictures it finds what it was taught
        ("Skeleton2D", "", [CAMERA, POSE], {"source BodyPose may", *SEEN}),
        ("Skeleton2D", "", [POSE], {"source BodyPose may"}),
        ("Skeleton2D", "Bool", [POSE], {"derivation Video BodyPose may"}),
        ("Twist", "Image", [POSE], set()),
        ("String", "", [MICROPHONE, "vosk.Model()"], {"source Voice may", *HEARD}),
        ("Skeleton2D", "Image", [CAMERA, POSE], {"derivation Video BodyPose may"}),  # and no source of it
        ("String", "Image", ["onnxruntime.InferenceSession('x')"], set()),  # may twice is nothing
        ("Bool", "Image", ["face_recognition.face_locations(x)"], {"derivation Video PersonDetection may"}),  # a flag
        ("Image", "", ["tf2_ros.Buffer().lookup_transform('x', 'y', t)"], set()),  # may, and no place is written
        # 4. What lets data out.
        ("", "Image", ["cv2.imwrite('x', y)"], {"leak Video likely"}),
        ("", "Image", ["cv2.imshow('x', y)"], {"leak Video may"}),  # often for debugging
        ("", "Image", ["requests.get('x')"], {"leak PersonalData may"}),
        ("", "Bool", ["requests.post('x')"], {"leak PersonalData may"}),
        ("", "Image", ["open('x', 'w')"], {"leak PersonalData may"}),
        ("", "Image", ["open('x')"], set()),
        ("", "", ["requests.post('x')"], {"leak PersonalData may"}),  # who knows what
        ("Twist", "", ["readchar.readkey()", "requests.post('x')"],
         {"source OperatorInput may", "leak PersonalData may"}),
        ("Image", "", [CAMERA, "requests.post('x')"], {"source Video likely", "leak PersonalData may"}),
        ("Image", "", [CAMERA, "flask.Flask('x')"],
         {"source Video likely", "source OperatorInput may", "leak PersonalData likely"}),
        ("", "Image", ["websocket.create_connection('x')"], {"leak PersonalData may"}),  # it may only listen
        ("", "Image", ["websocket.create_connection('x').send(y)"], {"leak PersonalData may"}),  # who knows what
        ("", "Image", ["websockets.serve(x, 'y', 1)"],
         {"source OperatorInput may", "leak PersonalData may"}),  # it may only get something
        ("", "Image", ["csv.writer(x)"], {"leak PersonalData may"}),  # who knows which numbers
        ("", "Image", ["sounddevice.play(x)"], {"leak PersonalData may"}),  # an alarm, or what somebody said
        ("", "Image", ["pyttsx3.init()"], {"leak PersonalData likely"}),
        ("", "Image", ["go('https://api.telegram.org/bot')"], {"leak PersonalData likely"}),
        ("", "Image", ["go('https://example.org/')"], set()),
        # 5. What it lets out itself, it need not write.
        ("", "", [CAMERA, "cv2.imwrite('x', y)"], {"source Video may", "leak Video likely"}),
        ("", "Image", [POSE, "cv2.imshow('x', y)"], {"derivation Video BodyPose may", "leak Video may"}),
        ("", "Image", [POSE], set()),
    ],
)  # fmt: skip
def test_the_rules(writes: str, reads: str, calls: list[str], told: set[str]) -> None:
    assert said(writes, reads, *calls) == told


@pytest.mark.parametrize(
    ("node", "call", "sure"),
    [
        ("gui", "tkinter.Tk()", "may"),  # a window, and a node that is called so, say one thing
        ("web", "flask.Flask('x')", "may"),
        ("teleop", "input('?')", "likely"),
    ],
)
def test_a_window_or_a_page_agrees_with_no_name(node: str, call: str, sure: str) -> None:
    """1. Somebody who looks at it may do nothing there."""
    said("Twist", "", call)
    Path("n.py").write_text(Path("n.py").read_text("utf-8").replace("'n'", f"'{node}'"), "utf-8")
    Path("p.xml").write_text(policy(f"/{node}>/w", "/m</w"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    assert [str(one.confidence) for one in found if one.label.role == "source"] == [sure]


def of_node(name: str, topic: str, *calls: str, writes: str = "String") -> dict[str, str]:
    """What a node is suggested as a source of, by everything that is looked at, with how sure."""
    said(writes, "", *calls)
    code = Path("n.py").read_text("utf-8").replace("'n'", f"'{name}'").replace("'/w'", f"'/{topic}'")
    Path("n.py").write_text(code, "utf-8")
    Path("p.xml").write_text(policy(f"/{name}>/{topic}", f"/m</{topic}"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    return {one.label.kind: str(one.confidence) for one in found if one.label.role == "source"}


def test_a_library_that_makes_one_of_two_kinds_says_the_broader_one() -> None:
    """3. A recogniser of speech writes a transcript or a command: which, its code does not say."""
    kinds = of_node("speech_recognition", "w", MICROPHONE, "vosk.Model()")
    assert kinds["CommunicationContent"] == "likely"
    assert not {"SpeechTranscript", "VoiceCommand"} & kinds.keys()


@pytest.mark.parametrize(
    ("name", "call", "sure"),
    [
        ("n", "readchar.readkey()", "may"),  # the code alone: it may be there for a test
        ("keyboard_teleop", "readchar.readkey()", "likely"),
        ("n", "mfrc522.SimpleMFRC522()", "may"),
        ("command_listener", "paho.mqtt.client.Client()", "may"),  # a network agrees with no name
    ],
)
def test_what_can_have_any_form_needs_a_second_ground(name: str, call: str, sure: str) -> None:
    """1. No type speaks for it."""
    kinds = of_node(name, "w", call, writes="Twist")
    assert kinds["PersonIdentifier" if "mfrc" in call else "OperatorInput"] == sure


def test_a_microphone_in_a_node_that_writes_text_is_a_source_of_what_was_said() -> None:
    """1, 2. The types are known and none is made for sound, so that no name makes the sound itself likely."""
    assert of_node("voice_listener", "voice_raw", MICROPHONE)["Voice"] == "may"


def test_pictures_that_are_written_beside_a_text_may_tell_of_persons_there() -> None:
    both = "create_publisher(Image, '/image', 1), self.create_publisher"
    said("String", "", CAMERA)
    Path("n.py").write_text(Path("n.py").read_text("utf-8").replace("create_publisher", both), "utf-8")
    Path("p.xml").write_text(policy("/n>/w,/image", "/m</w,/image"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    kinds = {one.label.kind for one in found if one.label.role == "source"}
    assert {"Video", "PersonDetection", "Location", "Behaviour"} <= kinds
    assert not {"Location", "Behaviour"} & of_node("n", "image", CAMERA, writes="Image").keys()


def test_where_a_model_is_asked_and_no_text_is_read_somebody_may_have_said_it() -> None:
    assert of_node("n", "w", "openai.OpenAI()", writes="Twist")["CommunicationContent"] == "may"
    assert "source CommunicationContent may" not in said("Twist", "String", "openai.OpenAI()")


def test_what_reads_ros_by_itself_makes_no_source() -> None:
    """A listener of transforms reads /tf: a place that is made of them was not brought in."""
    looked_up = "tf2_ros.Buffer().lookup_transform('map', 'base', t)"
    said("Pose", "", looked_up)
    Path("n.py").write_text(Path("n.py").read_text("utf-8").replace("'/w'", "'/robot_pose'"), "utf-8")
    Path("p.xml").write_text(policy("/n>/robot_pose", "/m</robot_pose"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    by_code = {one.label.role for one in found for reason in one.evidence if reason.ground == CODE}
    assert by_code == {"derivation"}


@pytest.mark.parametrize("call", ["publish('x')", "subscribe('x')"])
def test_of_a_broker_nobody_knows_what_it_gets(call: str) -> None:
    assert "leak PersonalData may" in said("", "Image", f"paho.mqtt.client.Client().{call}")


@pytest.mark.parametrize(("name", "sure"), [("n", "likely"), ("fake_camera", "may"), ("video_file_publisher", "may")])
def test_what_simulates_measures_nothing(name: str, sure: str) -> None:
    """1. A film that is played is taken by the same call as the pictures of a camera."""
    said("Image", "", CAMERA)
    Path("n.py").write_text(Path("n.py").read_text("utf-8").replace("'n'", f"'{name}'"), "utf-8")
    Path("p.xml").write_text(policy(f"/{name}>/w", "/m</w"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    assert [str(one.confidence) for one in found if one.label.role == "source" and one.label.kind == "Video"] == [sure]


def test_a_use_in_a_namespace_of_the_policy_is_found_by_the_own_name_of_the_node() -> None:
    said("Image", "", CAMERA)
    Path("p.xml").write_text(policy("/robot1/n>/w", "/m</w"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",)))
    reasons = [r for one in found.proposals for r in one.evidence if one.label.element.name == "/robot1/n"]
    assert [(str(r.place), r.reason.partition(":")[0]) for r in reasons if r.ground == CODE] == [
        ("n.py:12", "uses cv2.VideoCapture (n.py")
    ]
    assert not found.unplaced


def test_nothing_that_hides_a_leak_is_said_by_libraries() -> None:
    """Beside a source or a leak by code no conduit and no sanitizer is proposed for the same data."""
    said("Found", "Image", CAMERA, "requests.post('x')")
    Path("l.yaml").write_text("labels: 1\nnodes: {/m: {source: [Video]}}\n", "utf-8")
    found = suggest_labels(("p.xml",), ("l.yaml",), Settings(), UserFiles(sources=("n.py",))).proposals
    roles = {one.label.role for one in found if one.label.element.name == "/n"}
    assert "leak" in roles
    assert not roles & {"conduit", "sanitizer"}


@pytest.mark.parametrize("topic", ["detections", "person_detections", "object_poses"])
def test_a_detector_finds_what_it_was_taught(topic: str) -> None:
    """3. YOLO knows persons and pots, and cars where somebody taught it so, whatever a channel is called."""
    code = HEAD.format(library="ultralytics") + LINE.format("ultralytics.YOLO('x')")
    Path("n.py").write_text(code, "utf-8")
    Path("p.xml").write_text(policy(f"/n>/{topic}</image", f"/m>/image</{topic}"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings(), UserFiles(sources=("n.py",))).proposals
    derived = {(one.label.to, str(one.confidence)) for one in found if one.label.role == "derivation"}
    assert {("PersonDetection", "may"), ("HouseholdObject", "may")} <= derived
    assert {sure for _, sure in derived} == {"may"}
