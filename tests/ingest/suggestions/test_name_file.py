"""Rules about names: each family of the shipped file, the format, and a user's own file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.name_rules import ends_with, has_word, of_node, of_topic, of_topic_nothing
from rosprivacy.ingest.suggestions.rule_files import read_name_rules
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

VOCABULARY = load()
SHIPPED, FILES = read_name_rules((), VOCABULARY)
OWN = "name_rules: 1\ncarries:\n  - {words: [%s], kinds: [Gesture], why: ours}\n"
NO_WORD = "write words of letters with _ between them, at most 4; quote no, on and yes"
OWN_KIND = """@prefix : <http://example.org/> . @prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix rp: <https://w3id.org/rosprivacy#> .
:Crate a skos:Concept ; rp:label "Crate" ; skos:broader rp:Video ; rp:dataType "video" ;
  skos:prefLabel "crate"@en ; skos:definition "Pictures of a crate."@en .
"""


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("/camera/image_raw", "Video"),
        ("/camera/image_raw/compressed", "Video"),
        ("/camera1/rgb/image_rect_color", "Video"),
        ("/front/webcam", "Video"),
        ("/camera/depth/image_rect_raw", "DepthImage"),
        ("/aligned_depth_to_color/image_raw", "DepthImage"),
        ("/thermal/image_raw", "ThermalImage"),
        ("/humans/faces/tracked", "FaceImage"),
        ("/face/image", "FaceImage"),
        ("/camera/depth/points", "PersonPointCloud"),
        ("/velodyne/pointcloud", "PersonPointCloud"),
        ("/scan", "LaserScan"),
        ("/robot1/laserScan", "LaserScan"),
        ("/scanned_document", "DocumentImage"),
        ("/audio/raw", "Voice"),
        ("/mic", "Voice"),
        ("/humans/voices/speech", "SpeechTranscript"),
        ("/voice_commands", "VoiceCommand"),
        ("/dialogue", "ConversationWithModel"),
        ("/people", "PersonTrack"),
        ("/detected/persons", "PersonTrack"),
        ("/humans/bodies/tracked", "BodyPose"),
        ("/gaze", "EyeGaze"),
        ("/hand_gesture", "Gesture"),
        ("/emotion", "EmotionEstimate"),
        ("/face_id", "PersonIdentifier"),
        ("/license_plate", "LicencePlate"),
        ("/heart_rate", "VitalSign"),
        ("/fall_detection", "FallEvent"),
        ("/driver_state", "DriverOrOperatorState"),
        ("/presence", "Presence"),
        ("/yolo/detections", "PersonDetection HouseholdObject"),
        ("/gps/fix", "GnssPosition"),
        ("/map", "HomeMap"),
        ("/global_costmap/costmap_raw", "HomeMap"),
        ("/amcl_pose", "RobotPosition"),
        ("/odom", "RobotPosition"),
        ("/joy", "OperatorInput"),
        ("/ble/beacons", "WirelessDeviceId"),
        ("/rfid", "StaffBadge DeviceIdentifier"),
        ("/voice_text", "SpeechTranscript"),  # text is no sound
        ("/asr/text", "SpeechTranscript"),
        ("/llm_response", "ConversationWithModel"),
        ("/visitor_name", "PersonName"),
        ("/pir", "Presence"),
        ("/position", "RobotPosition"),
        ("/object_tracker/current_position", "PersonTrack"),  # of what is followed
        ("/cmd_vel_teleop", "OperatorInput"),
        ("/gripper_position", ""),
        ("/cmd_audio", ""),  # it is to play
        ("/carplate/ocr_text", "LicencePlate"),  # and not what somebody said
        ("/detect/object_map_coordinates", "HouseholdObject"),  # in the frame of a map, and no map
        ("/person_positions_map", "PersonTrack"),
        ("/detected_object", "PersonDetection HouseholdObject"),
        ("/person_detected", "PersonDetection"),
        ("/delivery_order", "DeliveryOrder"),
        ("/camera/camera_info", ""),  # the last words say what it is
        ("/camera/parameter_events", ""),
        ("/face_detector/status", ""),
        ("/cmd_vel", ""),
        ("/camera/imu", ""),  # the last part says something else
        ("/video/cmd_vel", ""),
        ("/surface", ""),  # whole words only
        ("/mapping_mode", ""),
        ("/", ""),
        ("/*", ""),
        ("/camera/*", "Video"),
    ],
)
def test_what_a_topic_carries_by_its_name(name: str, kinds: str) -> None:
    spoken = of_topic(name, SHIPPED)
    assert (" ".join(spoken.rule.kinds) if spoken else "") == kinds


@pytest.mark.parametrize(("name", "nothing"), [("/cmd_vel", 1), ("/robot_description", 1), ("/face/cmd_vel", 1),
                                               ("/joint_states", 1), ("/battery_face", 0), ("/vel", 0)])  # fmt: skip
def test_what_is_made_for_the_machine(name: str, nothing: int) -> None:
    assert (of_topic_nothing(name, SHIPPED) is not None) == bool(nothing)


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("/usb_cam", "Video"),
        ("/front/realsense2_camera_node", "Video"),
        ("/v4l2_camera", "Video"),
        ("/audio_capture", "Voice"),
        ("/rplidarNode", "LaserScan"),
        ("/velodyne_driver", "LaserScan"),
        ("/nmea_navsat_driver", "GnssPosition"),
        ("/joy_node", "OperatorInput"),
        ("/thermal_camera", "ThermalImage"),
        ("/map_server", "HomeMap"),
        ("/stt_node", "SpeechTranscript"),
        ("/whisper", "SpeechTranscript"),
        ("/voice_command", "VoiceCommand"),
        ("/chat_gpt_node", "ConversationWithModel"),
        ("/face_recognition_node", "PersonIdentifier"),
        ("/person_detector", "PersonDetection"),
        ("/people_tracker", "PersonTrack"),
        ("/pir_node", "Presence"),
        ("/rfid_reader", "StaffBadge DeviceIdentifier"),
        ("/audio_input_node", "Voice"),
        ("/keyboard_driver", "OperatorInput"),
        ("/web_gui", "OperatorInput"),
        ("/mqtt_transport_node", "OperatorInput"),  # of who sits at the other end
        ("/yolo_node", "PersonDetection"),
        ("/leg_detector", "PersonDetection"),
        ("/object_detector_node", "HouseholdObject PersonDetection"),
        ("/voice_node", "SpeechTranscript"),
        ("/hotword_detector", "VoiceCommand"),
        ("/get_camera_params", None),  # it asks for settings
        ("/camera/controller", None),
        ("/planner_server", None),
    ],
)
def test_what_a_node_brings_in_by_its_name(name: str, kinds: str | None) -> None:
    spoken = of_node(name, SHIPPED.brings_in, SHIPPED.silent)
    assert (spoken and " ".join(spoken.rule.kinds)) == kinds


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/nav/goal_pose", "wanted"),
        ("/initialpose", "wanted"),
        ("/debug_image", "reworked"),
        ("/image_annotated", "reworked"),
        ("/scan_filtered", "reworked"),
        ("/image_rect_color", ""),  # drivers of cameras rectify, too
        ("/gazebo_driver", "simulated"),
        ("/fake_camera", "simulated"),
        ("/pose", ""),
        ("/person_ground_truth", "simulated"),
        ("/people_predicted", "reworked"),
        ("/aruco_marker_detector", "reworked reworking"),
        ("/image_converter", "reworking"),
        ("/debug/image", ""),  # its last part is asked
        ("/similar_camera", ""),  # whole words only
    ],
)
def test_what_puts_a_source_in_doubt(name: str, said: str) -> None:
    found = {
        "wanted": ends_with(name, SHIPPED.wanted),
        "reworked": has_word(name, SHIPPED.reworked),
        "reworking": has_word(name, SHIPPED.reworking),
        "simulated": has_word(name, SHIPPED.simulated),
    }
    assert [one for one, is_so in found.items() if is_so] == said.split()


@pytest.mark.parametrize(
    ("name", "lets_out"),
    [
        ("/rosbridge_websocket", True),
        ("/foxglove_bridge", True),
        ("/web_video_server", True),
        ("/cloud_uploader", True),
        ("/point_cloud_filter", False),
        ("/rosbag2_recorder", True),
        ("/rviz2", True),
        ("/tts", True),
        ("/email_notifier", True),
        ("/fleet_adapter", True),
        ("/vlm_controller", True),
        ("/asr_server", True),
        ("/scada_node", True),
        ("/map_saver", True),
        ("/data_collector", True),
        ("/image_capture", True),
        ("/text_to_speech", True),
        ("/cloud_bridge", True),
        ("/controller_server", False),
        ("/bridge/planner", False),
    ],
)
def test_what_a_node_lets_out_by_its_name(name: str, lets_out: bool) -> None:  # noqa: FBT001 - a row of the table
    assert (of_node(name, SHIPPED.lets_out) is not None) == lets_out


def test_no_rule_about_a_name_is_certain_and_each_has_its_reason() -> None:
    parts = (SHIPPED.carries, SHIPPED.nothing, SHIPPED.brings_in, SHIPPED.lets_out)
    rules = [rule for part in parts for rule in part.values()]
    rules += [rule for made in SHIPPED.becomes.values() for rule in made.values()]
    assert all(rule.confidence is not Confidence.CERTAIN and rule.why for rule in rules)
    assert [file for file, _ in FILES] == ["rosprivacy:names"]


def test_a_users_rules_stand_before_ours_and_a_kind_of_their_own_takes_part(tmp_path: Path) -> None:
    (tmp_path / "own.ttl").write_text(OWN_KIND, "utf-8")
    (tmp_path / "own.yaml").write_text(OWN % "image, camera_info" + "  - {words: [crate], kinds: [Crate], why: a}\n")
    vocabulary = load(ontologies=(str(tmp_path / "own.ttl"),))
    rules, files = read_name_rules([str(tmp_path / "own.yaml")], vocabulary)
    kinds = [spoken and spoken.rule.kinds for name in ("/image", "/camera_info", "/crate", "/scan")
             for spoken in [of_topic(name, rules)]]  # fmt: skip
    assert kinds == [("Gesture",), ("Gesture",), ("Crate",), ("LaserScan",)]
    assert len(files) == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- 1\n", "f.yaml:1: rules about names are a map, not a list; begin with 'name_rules: 1'"),
        ("carries: []\n", "f.yaml:1: no 'name_rules: 1'; say so on the first line: it is the format's version"),
        ("name_rules: 2\n", "f.yaml:1: rules format '2'; this reads 'name_rules: 1'"),
        ("name_rules: 1\ncarry: []\n", "f.yaml:2: unknown key 'carry'; did you mean 'carries'?"),
        (OWN % "a, A", "f.yaml:3: a again, first in line 3; say each phrase once"),
        (OWN % "12", f"f.yaml:3: '12' is no word of a name; {NO_WORD}"),
        ("name_rules: 1\ncarries:\n- {words: [a], kinds: [Vidoe], why: x}\n",
         "f.yaml:3: unknown category 'Vidoe'; did you mean Video or Voice?"),
        ("name_rules: 1\ncarries:\n- {words: [a], kinds: [Video]}\n",
         "f.yaml:3: a rule without why; write words, why, kinds"),
        ("name_rules: 1\nlets_out:\n- {words: [a], kinds: [Video], why: x}\n",
         "f.yaml:3: unknown key 'kinds'; one of words, confidence, why, source"),
        ("name_rules: 1\nnothing:\n- {words: [a], why: x, confidence: certain}\n",
         "f.yaml:3: confidence 'certain'; write likely or may: a name proves nothing"),
        ("name_rules: 1\ncarries:\n- {words: [a], kinds: [Video], why: x, any_type: 1}\n",
         "f.yaml:3: any_type '1'; write true or leave it out"),
        ("name_rules: 1\nbecomes:\n- {from: Video, why: x}\n", "f.yaml:3: a rule without to; write from, to, why"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_line(
    text: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "f.yaml").write_text(text, "utf-8")
    with pytest.raises(InputErrors) as raised:
        read_name_rules(["f.yaml"], VOCABULARY)
    assert str(raised.value.errors[0]) == message


def test_the_longest_name_that_can_be_read_is_taken_apart_at_once() -> None:
    for name in ("/" + "aA" * 50_000, "/" + "_" * 100_000, "/raw" * 25_000, "/" + "camera_" * 15_000):
        of_topic(name, SHIPPED)
        of_node(name, SHIPPED.lets_out)
