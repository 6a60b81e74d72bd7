"""What message types suggest: each family of rules, the format of the table, and that nothing is applied by it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.ontology.vocabulary import load
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

VOCABULARY = load()
SHIPPED = read_table(TABLE, VOCABULARY)
STORES = ("ROS2_FOXY", "ROS2_HUMBLE", "ROS2_IRON", "ROS2_JAZZY", "ROS2_KILTED", "ROS2_LYRICAL")


def suggested(name: str) -> list[str]:
    return [f"{rule.confidence} {' '.join(rule.kinds)}" for rule in SHIPPED.suggested(name)]


@pytest.mark.parametrize(
    ("name", "rules"),
    [
        ("sensor_msgs/msg/Image", ["likely Video", "may DepthImage ThermalImage"]),
        ("sensor_msgs/msg/CompressedImage", ["likely Video", "may DepthImage ThermalImage"]),
        ("stereo_msgs/msg/DisparityImage", ["likely DepthImage"]),
        ("sensor_msgs/msg/CameraInfo", []),
        ("sensor_msgs/msg/PointCloud2", ["may PersonPointCloud"]),
        ("sensor_msgs/msg/LaserScan", ["likely LaserScan"]),
        ("radar_msgs/msg/RadarTracks", ["may PersonTrack"]),
        ("audio_common_msgs/msg/AudioData", ["likely Voice"]),
        ("audio_common_msgs/msg/AudioStamped", ["likely Voice"]),
        ("audio_common_msgs/msg/AudioInfo", []),
        ("audio_common_msgs/action/TTS", ["may CommunicationContent"]),
        ("hri_msgs/msg/LiveSpeech", ["certain SpeechTranscript", "likely Language"]),
        ("hri_msgs/msg/SoftBiometrics", ["certain Age Gender"]),
        ("hri_msgs/msg/IdsList", ["certain PersonIdentifier"]),
        ("people_msgs/msg/People", ["certain PersonTrack"]),
        ("vision_msgs/msg/Detection3DArray", ["may PersonDetection", "may HouseholdObject"]),
        ("nav_msgs/msg/OccupancyGrid", ["may HomeMap"]),
        ("nav_msgs/srv/GetMap", ["may HomeMap"]),
        ("nav2_msgs/msg/Costmap", ["may HomeMap"]),
        ("nav2_msgs/action/NavigateToPose", ["may RobotPosition"]),
        ("nav2_msgs/action/NavigateToPose_FeedbackMessage", ["may RobotPosition"]),
        ("nav2_msgs/action/FollowObject", ["may PersonTrack"]),
        ("nav2_msgs/action/FollowGPSWaypoints", ["may GnssPosition"]),
        ("sensor_msgs/msg/NavSatFix", ["likely GnssPosition"]),
        ("geographic_msgs/msg/GeoPoseStamped", ["may GnssPosition"]),
        ("geographic_msgs/msg/RoutePath", ["may Trajectory"]),
        ("geometry_msgs/msg/PoseStamped", ["may RobotPosition PersonTrack"]),
        ("geometry_msgs/msg/Twist", []),
        ("tf2_msgs/msg/TFMessage", ["may RobotPosition BodyPose"]),
        ("moveit_msgs/msg/PlanningScene", ["may PersonPointCloud", "may HouseholdObject"]),
        ("moveit_msgs/msg/RobotTrajectory", []),
        ("visualization_msgs/msg/MarkerArray", ["may PersonalData"]),
        ("sensor_msgs/msg/Joy", ["likely OperatorInput"]),
        ("rcl_interfaces/msg/Log", ["may PersonalData"]),
        ("std_msgs/msg/String", ["may PersonalData"]),
        ("std_msgs/msg/UInt8MultiArray", ["may PersonalData"]),
        ("diagnostic_msgs/msg/DiagnosticArray", ["may PersonalData"]),
        ("rmf_fleet_msgs/msg/FleetState", ["may RobotPosition"]),
        ("rmf_traffic_msgs/msg/ItineraryReached", ["may RobotPosition"]),
        ("rmf_traffic_msgs/msg/NegotiationAck", []),
        ("rmf_task_msgs/msg/Delivery", ["may DeliveryOrder", "may RobotPosition"]),
        ("rmf_task_msgs/msg/ApiRequest", ["may PersonalData"]),
        ("rmf_door_msgs/msg/DoorRequest", ["may RobotPosition"]),
        ("rmf_door_msgs/msg/DoorState", ["may Presence SmartHomeSensorData"]),
        ("rmf_fleet_msgs/msg/LaneRequest", []),
        ("rmf_building_map_msgs/msg/BuildingMap", ["may AnnotatedMap"]),
        ("rmf_obstacle_msgs/msg/Obstacles", ["may PersonDetection"]),
        ("std_msgs/msg/Bool", []),
        ("lifecycle_msgs/srv/ChangeState", []),
    ],
)
def test_what_each_family_of_types_suggests(name: str, rules: list[str]) -> None:
    assert SHIPPED.knows(name)
    assert suggested(name) == rules


def test_a_type_that_is_not_in_the_table_suggests_nothing_and_is_not_known() -> None:
    """Silence of the table is no statement (S11)."""
    for name in ("own_msgs/msg/Image", "sensor_msgs/msg/Picture", "no type at all", ""):
        assert (SHIPPED.knows(name), suggested(name)) == (False, [])


def test_every_message_of_six_releases_of_ros_was_looked_at() -> None:
    """Foreign definitions (rosbags): nothing of common_interfaces and what comes with ROS itself is left out."""
    from rosbags.typesys import Stores, get_typestore

    names = {name for store in STORES for name in get_typestore(Stores[store]).fielddefs}
    assert len(names) > 170
    assert {name for name in names if not SHIPPED.knows(name)} == set()


def test_certain_is_only_what_is_made_for_persons() -> None:
    """A type that is used for other things, too, is at most likely."""
    rules = [rule for rules in SHIPPED.suggestions.values() for rule in rules]
    assert {rule.type.split("/")[0] for rule in rules if rule.confidence == "certain"} == {"hri_msgs", "people_msgs"}
    assert all(rule.why and rule.source and rule.kinds and rule.place.line for rule in rules)


def test_all_of_ros4hri_is_personal() -> None:
    """REP 155: a package about persons; none of its types goes by without a question."""
    types = {name for name, _ in SHIPPED.suggestions if name.startswith("hri_msgs/")}
    assert len(types) == 17  # as the package has it since 2023
    assert all(suggested(name) for name in types)


def test_both_legs_of_a_service_unless_the_rule_names_one() -> None:
    assert SHIPPED.suggestions["nav_msgs/srv/GetMap", "response"]
    assert ("nav_msgs/srv/GetMap", "request") not in SHIPPED.suggestions
    assert (
        SHIPPED.suggestions["nav_msgs/srv/GetPlan", "request"]
        == SHIPPED.suggestions["nav_msgs/srv/GetPlan", "response"]
    )


def test_rules_that_cannot_be_read_are_refused_with_all_their_lines(tmp_path: Path) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text(
        "type_table: 1\ncannot:\n  - {types: [a/msg/A], kinds: [PersonImage], why: x, source: y}\nsuggests:\n"
        "  - {types: [a/msg/A], kinds: [Video], confidence: may, why: x, source: y}\n"
        "  - {types: [a/msg/B], kinds: [Video], why: x, source: y}\n"
        "  - {types: [a/msg/C], kinds: [Vidoe], confidence: sure, why: x, source: y}\n"
        "  - {types: [a/msg/D], kinds: [Voice], confidence: may, why: x, source: y}\n"
        "  - {types: [a/msg/D], kinds: [Voice], confidence: likely, why: x, source: y}\n"
        "  - {types: [a/msg/D], kinds: [], why: x, source: y}\n"
        "  - {types: [a/msg/E], kinds: [], confidence: may, why: x, source: y}\n"
        "  - {types: [a/srv/F], leg: answer, kinds: [Voice], confidence: may, why: x, source: y}\n"
        "  - {types: ['a/msg/*'], kinds: [Voice], confidence: may, why: x}\n"
        "  - {types: [a/msg/E], kinds: [Voice], confidence: may, why: x, source: y, sure: yes}\n"
    )
    with pytest.raises(rosprivacy.InputErrors) as refused:
        read_table(str(file), VOCABULARY)
    assert [line.removeprefix(f"{tmp_path}/") for line in str(refused.value).splitlines()] == [
        "bad.yaml:5: it suggests Video, which line 3 says it cannot carry; correct one of the two",
        "bad.yaml:6: a suggestion without confidence; write certain, likely or may",
        "bad.yaml:7: confidence 'sure'; write certain, likely or may",
        "bad.yaml:7: unknown category 'Vidoe'; did you mean Video or Voice?",
        "bad.yaml:9: a/msg/D again, first in line 8; say each kind once",
        "bad.yaml:10: a/msg/D again, first in line 8; say each kind once",
        "bad.yaml:11: a confidence, and no kind; remove it, or name a kind",
        "bad.yaml:12: a/srv/F is the type of a service; write leg: request or response",
        "bad.yaml:13: 'a/msg/*' is not the name of a type; write pkg/msg/Name",
        "bad.yaml:13: an entry without source; write {types: […], kinds: […], why: …, source: …}",
        "bad.yaml:14: a/msg/E again, first in line 11; say each kind once",
        "bad.yaml:14: unknown key 'sure'; did you mean 'source'?",
    ]


def test_a_suggestion_of_one_leg_is_no_contradiction_of_what_the_other_cannot_carry(tmp_path: Path) -> None:
    file = tmp_path / "table.yaml"
    cannot = "cannot: [{types: [a/srv/A], leg: request, kinds: [Voice], why: x, source: y}]\n"
    rule = "suggests: [{{types: [a/srv/A], {leg}kinds: [Voice], confidence: may, why: x, source: y}}]\n"
    for leg, fits in (("", True), ("leg: response, ", True), ("leg: request, ", False)):
        file.write_text(f"type_table: 1\n{cannot}{rule.format(leg=leg)}")
        if fits:
            assert len(read_table(str(file), VOCABULARY).suggested("a/srv/A_Event")) == 1
        else:
            with pytest.raises(rosprivacy.InputErrors):
                read_table(str(file), VOCABULARY)


def test_nothing_is_applied_by_a_suggestion(tmp_path: Path) -> None:
    """A type that suggests Video makes no source, reviews nothing and closes nothing."""
    (tmp_path / "p.xml").write_text(policy("/cam>/a", "/sink</a"))
    answers = []
    for type_name in ("sensor_msgs/msg/Image", "own_msgs/msg/Unknown"):
        labels = tmp_path / "l.yaml"
        labels.write_text(
            "labels: 1\nnodes: {/cam: {source: [Voice]}, /sink: {leak: [Video]}}\n"
            f"channels: {{/a: {{types: [{type_name}]}}}}\n"
        )
        result = rosprivacy.analyze(tmp_path / "p.xml", labels)
        answers.append((result.analysis.verdict, len(result.findings), result.analysis.open))
    assert answers[0] == answers[1]
    assert answers[0][1] == 0
