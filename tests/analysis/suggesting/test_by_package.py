"""Nodes of well-known packages in policies: the name and half of the interfaces, or the name alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.packages import nodes_of_packages, package_evidence
from rosprivacy.ingest.known_packages.package_folders import catalogue
from rosprivacy.ontology.vocabulary import load
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_system
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from rosprivacy.analysis.suggesting.evidence import Evidence

LIKELY, MAY = Confidence.LIKELY, Confidence.MAY


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def evidence(text: str, labels: str = "labels: 1\n") -> tuple[Evidence, ...]:
    Path("p.xml").write_text(text, "utf-8")
    Path("l.yaml").write_text(labels, "utf-8")
    return evidence_of("p.xml", "l.yaml")


def evidence_of(policy_file: str, *labels: str) -> tuple[Evidence, ...]:
    system = robot_system((policy_file,), labels, question_of(Settings()))
    of_packages = nodes_of_packages(system.graph, system.bound.types, catalogue(load()))
    return tuple(package_evidence(system.graph, of_packages))


def told(found: tuple[Evidence, ...], role: str, kind: str) -> list[tuple[str, Confidence, str]]:
    return [
        (one.label.element.name, one.confidence, one.reason.rpartition(" (")[2][:-1])
        for one in found
        if (one.label.role, one.label.kind) == (role, kind)
    ]


def test_the_name_and_half_of_the_interfaces_are_likely_in_any_namespace() -> None:
    found = evidence(policy("/robot1/usb_cam>/robot1/image_raw,/robot1/camera_info", "/v/usb_cam>/v/image_raw"))
    assert told(found, "source", "Video") == [
        ("/robot1/usb_cam", LIKELY, "its name, 2 of 3 of its interfaces"),
        ("/v/usb_cam", MAY, "its name, 1 of 3 of its interfaces"),
    ]
    assert all(one.reason.startswith("package usb_cam 0.8.1: it publishes what the camera films") for one in found)
    assert {str(one.place) for one in found} == {"rosprivacy:packages/usb_cam.yaml:19"}


HALF, THIRD = "its name, 2 of 3 of its interfaces", "its name, 1 of 3 of its interfaces"
TYPED = "labels: 1\nchannels:\n  {}: {{types: [{}]}}\n"
NAME = "its name alone"


@pytest.mark.parametrize(
    ("profile", "labels", "expected"),
    [
        ("/usb_cam>/else", "", (MAY, NAME)),
        ("/camera_2>/image_raw,/camera_info", "", ()),  # another name
        ("/usb_cam</image_raw,/camera_info", "", (MAY, NAME)),  # the direction counts
        ("/usb_cam>/*", "", (MAY, NAME)),  # a wildcard confirms nothing
        ("/usb_cam>/*/image_raw,/*/camera_info", "", (MAY, NAME)),
        ("/usb_cam>/image_raw,/camera_info", TYPED.format("/image_raw", "sensor_msgs/msg/Image"), (LIKELY, HALF)),
        ("/usb_cam>/image_raw,/camera_info", TYPED.format("/image_raw", "std_msgs/msg/Bool"), (MAY, THIRD)),
        ("/usb_cam>/move", TYPED.format("/move", "geometry_msgs/msg/Twist"), ()),  # of known types: another node
        ("/usb_cam>/move,/more", TYPED.format("/move", "geometry_msgs/msg/Twist"), (MAY, NAME)),  # one is not known
    ],
)
def test_what_confirms_that_a_node_is_that_of_a_package(
    profile: str, labels: str, expected: tuple[Confidence, str] | tuple[()]
) -> None:
    found = told(evidence(policy(profile), labels or "labels: 1\n"), "source", "Video")
    assert [(confidence, reason) for _, confidence, reason in found] == ([expected] if expected else [])


def test_exactly_half_is_enough() -> None:
    found = evidence(policy("/teleop_twist_joy_node>/cmd_vel", "/n/teleop_twist_joy_node>/else"))
    assert told(found, "conduit", "") == [
        ("/n/teleop_twist_joy_node", MAY, NAME),
        ("/teleop_twist_joy_node", LIKELY, "its name, 1 of 2 of its interfaces"),
    ]


def test_a_private_name_follows_the_node() -> None:
    names = ("color/image_raw", "color/camera_info", "depth/image_rect_raw")
    (seen,) = [
        one
        for one in told(
            evidence(policy("/x/camera>" + ",".join(f"/x/camera/{n}" for n in names))), "source", "DepthImage"
        )
        if "3 of 5" in one[2]
    ]
    assert seen[:2] == ("/x/camera", LIKELY)
    other = told(evidence(policy("/x/camera>" + ",".join(f"/y/{n}" for n in names))), "source", "DepthImage")
    assert {confidence for _, confidence, _ in other} == {MAY}


def test_a_node_of_known_types_without_the_interfaces_may_let_out_all_the_same() -> None:
    typed = TYPED.format("/move", "geometry_msgs/msg/Twist")
    assert told(evidence(policy("/rviz2</move"), typed), "leak", "PersonalData") == [("/rviz2", MAY, NAME)]
    assert told(evidence(policy("/camera>/move"), typed), "leak", "Video") == [], "it is no camera"


def test_the_name_alone_is_evidence_of_a_name() -> None:
    grounds = {
        one.confidence: one.ground for one in evidence(policy("/usb_cam>/x", "/n/usb_cam>/image_raw,/camera_info"))
    }
    assert grounds == {MAY: "name", LIKELY: "package"}


def test_a_made_up_end_of_a_name_is_no_part_of_it() -> None:
    found = evidence(policy("/rqt_gui_py_node_4711</image", "/xrqt_gui_py_node_1</image"))
    assert told(found, "leak", "PersonalData") == [("/rqt_gui_py_node_4711", MAY, "its name alone")]


def test_services_and_actions_confirm_too() -> None:
    text = policy("/slam_toolbox>/map</scan").replace(
        "</profile>",
        '<services reply="ALLOW"><service>/slam_toolbox/save_map</service>'
        "<service>/slam_toolbox/dynamic_map</service></services></profile>",
    )
    found = evidence(text)
    assert told(found, "leak", "HomeMap") == [("/slam_toolbox", MAY, "its name, 4 of 7 of its interfaces")]
    assert told(found, "derivation", "LaserScan")[0][1] is LIKELY


def test_nothing_is_certain_and_each_reason_quotes_its_package() -> None:
    text = policy(
        *(f"/{node.names[0].replace('*', 'x')}>/out" for package in catalogue(load()) for node in package.nodes)
    )
    found = evidence(text)
    assert len(found) >= sum(len(node.claims) for package in catalogue(load()) for node in package.nodes) - 20
    assert {one.confidence for one in found} <= {LIKELY, MAY}
    names = {package.name for package in catalogue(load())}
    assert {one.reason.split()[1].rstrip(":") for one in found} == names


def labels_of(found: tuple[Evidence, ...]) -> str:
    """A label file that accepts every word of the catalogue."""
    said: dict[str, dict[str, list[str]]] = {}
    for one in found:
        entry = said.setdefault(one.label.element.name, {})
        kind = f"{{from: {one.label.kind}, to: {one.label.to}}}" if one.label.to else one.label.kind or "PersonalData"
        key = "derives" if one.label.to else one.label.role
        if kind not in entry.setdefault(key, []):
            entry[key].append(kind)
    lines = []
    for name, entry in said.items():
        stated = ", ".join(f"{key}: [{', '.join(kinds)}]" for key, kinds in entry.items())
        lines.append(f"  {name}: {{{stated}}}")
    return "\n".join(lines)


def test_accepting_all_of_it_hides_no_planted_leak() -> None:
    """Through a node of the catalogue, whatever it calls it, data still get to a leak: that node or the next."""
    nodes = [node.names[0].replace("*", "x") for package in catalogue(load()) for node in package.nodes]
    chains = [(f"/n{at}/planted", f"/n{at}/{name}", f"/n{at}/thief") for at, name in enumerate(nodes)]
    text = policy(*(p for a, b, c in chains for p in (f"{a}>{a}/in", f"{b}>{b}/out<{a}/in", f"{c}<{b}/out")))
    kinds = ("Video", "Voice", "PersonName", "HomeMap")
    planted = "".join(
        f"  {a}: {{source: [{', '.join(kinds)}]}}\n  {c}: {{leak: [{', '.join(kinds)}]}}\n" for a, _, c in chains
    )
    Path("all.yaml").write_text(f"labels: 1\nnodes:\n{planted}{labels_of(evidence(text))}\n", "utf-8")
    analysis = rosprivacy.analyze("p.xml", "all.yaml").analysis
    found = {(one.category, one.source.name, one.leak.name) for one in analysis.findings}
    for source, node, thief in chains:
        for kind in kinds:
            assert {(kind, source, thief), (kind, source, node)} & found, (node, kind)


@pytest.mark.parametrize(
    ("file", "source", "leak"),
    [
        ("ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml", "/turtlebot3_laserscan", "/rviz2"),
        ("open-rmf__rmf_demos/rmf_demos/sros2/policies/office.policy.xml", "/slotcar", "/rviz"),
    ],
)
def test_in_public_policies_a_planted_leak_stays_one(corpus: Path, file: str, source: str, leak: str) -> None:
    there = str(corpus / "policies" / file)
    found = evidence_of(there)
    accepted = labels_of(tuple(one for one in found if one.label.element.name not in (source, leak)))
    planted = f"  {source}: {{source: [LaserScan, Video]}}\n  {leak}: {{leak: [LaserScan, Video]}}\n"
    for labels in (planted, f"{planted}{accepted}\n"):
        Path("all.yaml").write_text(f"labels: 1\nnodes:\n{labels}", "utf-8")
        assert rosprivacy.analyze(there, "all.yaml").analysis.verdict == "leak"
    assert len(found) > 5


def test_what_a_node_that_is_called_as_its_package_lets_out_is_likely_where_nothing_else_could_be_looked_at() -> None:
    """foxglove_bridge as rosbridge_websocket. Of a source a name proves nothing; nor of another name."""
    found = evidence(policy("/foxglove_bridge</image", "/webrtc_ros_server</image"))
    assert told(found, "leak", "PersonalData") == [
        ("/foxglove_bridge", LIKELY, "its name alone"),
        ("/webrtc_ros_server", MAY, "its name alone"),  # of webrtc_ros
    ]
    assert told(found, "source", "OperatorInput") == [("/foxglove_bridge", MAY, "its name alone")]
