"""Rules about names: each family of the shipped file, the format, and a user's own file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.name_rules import has_word, of_node, of_topic, of_topic_nothing
from rosprivacy.ingest.suggestion_rules.rule_files import read_name_rules
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from rosprivacy.analysis.suggesting.name_rules import Spoken

VOCABULARY = load()
SHIPPED, FILES = read_name_rules((), VOCABULARY)
OWN = "name_rules: 1\ncarries:\n  - {words: [%s], kinds: [Gesture], why: ours}\n"
NO_WORD = "write words of letters with _ between them, at most 4; quote no, on and yes"
OWN_KIND = """@prefix : <http://example.org/> . @prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix rp: <https://w3id.org/rosprivacy#> .
:Crate a skos:Concept ; rp:label "Crate" ; skos:broader rp:Video ; rp:dataType "video" ;
  skos:prefLabel "crate"@en ; skos:definition "Pictures of a crate."@en .
"""


# What names say -> the names; text is no sound, what is followed is no robot, whole words only, the last one first.
TOPICS = {
    "Video": "/camera/image_raw /camera/image_raw/compressed /camera1/rgb/image_rect_color /front/webcam /camera/*",
    "DepthImage": "/camera/depth/image_rect_raw /aligned_depth_to_color/image_raw",
    "ThermalImage": "/thermal/image_raw",
    "FaceImage": "/humans/faces/tracked /face/image",
    "PersonPointCloud": "/camera/depth/points /velodyne/pointcloud",
    "LaserScan": "/scan /robot1/laserScan",
    "DocumentImage": "/scanned_document",
    "Voice": "/audio/raw /mic",
    "SpeechTranscript": "/humans/voices/speech /voice_text /asr/text",
    "VoiceCommand": "/voice_commands",
    "ConversationWithModel": "/dialogue /llm_response",
    "PersonTrack": "/people /detected/persons /object_tracker/current_position /person_positions_map",
    "BodyPose": "/humans/bodies/tracked",
    "EyeGaze": "/gaze",
    "Gesture": "/hand_gesture",
    "EmotionEstimate": "/emotion",
    "PersonIdentifier": "/face_id",
    "LicencePlate": "/license_plate /carplate/ocr_text",
    "VitalSign": "/heart_rate",
    "FallEvent": "/fall_detection",
    "DriverOrOperatorState": "/driver_state",
    "Presence": "/presence /pir",
    "PersonDetection HouseholdObject": "/yolo/detections /detected_object",
    "GnssPosition": "/gps/fix",
    "HomeMap": "/map /global_costmap/costmap_raw",
    "RobotPosition": "/amcl_pose /odom /position",
    "OperatorInput": "/joy /cmd_vel_teleop",
    "WirelessDeviceId": "/ble/beacons",
    "StaffBadge DeviceIdentifier": "/rfid",
    "PersonName": "/visitor_name",
    "": "/gripper_position /camera/camera_info /camera/parameter_events /face_detector/status "
    "/cmd_vel /camera/imu /video/cmd_vel /surface /mapping_mode / /*",
    "HouseholdObject": "/detect/object_map_coordinates",
    "PersonDetection": "/person_detected",
    "DeliveryOrder": "/delivery_order",
}
NODES = {
    "Video": "/usb_cam /front/realsense2_camera_node /v4l2_camera",
    "Voice": "/audio_capture /audio_input_node",
    "LaserScan": "/rplidarNode /velodyne_driver",
    "GnssPosition": "/nmea_navsat_driver",
    "OperatorInput": "/joy_node /keyboard_driver /web_gui /mqtt_transport_node",
    "ThermalImage": "/thermal_camera",
    "HomeMap": "/map_server",
    "CommunicationContent": "/stt_node /whisper /voice_node",
    "VoiceCommand": "/voice_command /hotword_detector",
    "ConversationWithModel": "/chat_gpt_node",
    "PersonIdentifier PersonName": "/face_recognition_node",
    "PersonDetection": "/person_detector /yolo_node /leg_detector",
    "PersonTrack": "/people_tracker",
    "Presence": "/pir_node",
    "StaffBadge DeviceIdentifier": "/rfid_reader",
    "HouseholdObject PersonDetection": "/object_detector_node",
    "": "/get_camera_params /camera/controller /planner_server",
}
IN_DOUBT = {
    "simulated": "/gazebo_driver /fake_camera /person_ground_truth",
    "": "/image_rect_color /pose /similar_camera /image_converter",
}
LEAKS = {
    "leak": "/rosbridge_websocket /foxglove_bridge /web_video_server /cloud_uploader /rosbag2_recorder "
    "/rviz2 /tts /email_notifier /fleet_adapter /vlm_controller /asr_server /scada_node /map_saver "
    "/data_collector /image_capture /text_to_speech /cloud_bridge",
    "": "/point_cloud_filter /controller_server /bridge/planner",
}
FOR_THE_MACHINE = {
    "nothing": "/cmd_vel /robot_description /face/cmd_vel /joint_states",
    "": "/battery_face /vel",
}


def kinds(spoken: Spoken | None) -> str:
    return " ".join(spoken.rule.kinds) if spoken else ""


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (TOPICS, lambda name: kinds(of_topic(name, SHIPPED))),
        (NODES, lambda name: kinds(of_node(name, SHIPPED.brings_in, SHIPPED.silent))),
        (IN_DOUBT, lambda name: "simulated" if has_word(name, SHIPPED.simulated) else ""),
        (LEAKS, lambda name: "leak" if of_node(name, SHIPPED.lets_out) else ""),
        (FOR_THE_MACHINE, lambda name: "nothing" if of_topic_nothing(name, SHIPPED) else ""),
    ],
)
def test_what_names_say(table: Mapping[str, str], says: Callable[[str], str]) -> None:
    expected = {name: what for what, names in table.items() for name in names.split()}
    assert {name: says(name) for name in expected} == expected


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
        (OWN % "a, A", "f.yaml:3: A again, first in line 3; say each once in a section"),
        (OWN % "12", f"f.yaml:3: '12' is no word of a name; {NO_WORD}"),
        ("name_rules: 1\ncarries:\n- {words: [a], kinds: [Vidoe], why: x}\n",
         "f.yaml:3: unknown category 'Vidoe'; did you mean Video or Voice?"),
        ("name_rules: 1\ncarries:\n- {words: [a], kinds: [Video]}\n",
         "f.yaml:3: a rule without why; write words, why, kinds"),
        ("name_rules: 1\nlets_out:\n- {words: [a], kinds: [Video], why: x}\n",
         "f.yaml:3: unknown key 'kinds'; one of words, why, where, confidence, source"),
        ("name_rules: 1\nnothing:\n- {words: [a], why: x, confidence: certain}\n",
         "f.yaml:3: confidence 'certain'; write likely or may"),
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
