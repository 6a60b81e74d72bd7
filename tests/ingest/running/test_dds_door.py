"""A DDS domain on loopback with participants of another implementation (Fast DDS): what they say is what is seen.

Both lengths of GIDs, endpoints of no node, participants that hide their endpoints, hostile names, 2,000 topics, who
comes and who leaves; and nobody sees a ROS node of ours.
"""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.policies.observed_metadata import HIDDEN, NO_NODE, REFUSED, STILL_CHANGING
from rosprivacy.ingest.running.dds_door import DdsDoor
from rosprivacy.ingest.running.observation import DDS_TYPE, Declared
from rosprivacy.observing import now

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.ingest.running.observation import Observation
    from tests.helpers.fastdds import Peer

pytestmark = pytest.mark.slow
SLACK = 20.0  # seconds; a loaded machine may take some
IMAGE, TEXT = "sensor_msgs::msg::dds_::Image_", "std_msgs::msg::dds_::String_"
DOMAINS = iter(range(101 + os.getpid() % 60, 232))


@pytest.fixture
def domain() -> int:
    return next(DOMAINS)


def looked(domain: int, holds: Callable[[Observation], bool], seconds: float = 40) -> Observation:
    """What is seen when it is as it should be, or at the end of a look; a loaded machine may need longer."""
    for seen in DdsDoor(now, domain, interface="lo").looks(seconds):
        if holds(seen):
            return seen
    return seen


def has(nodes: int, endpoints: int) -> Callable[[Observation], bool]:
    """As many nodes and endpoints, and nothing that is still to come."""

    def holds(seen: Observation) -> bool:
        distinct = {one.identity for one in seen.endpoints}
        return (len(seen.nodes), len(distinct)) == (nodes, endpoints) and HIDDEN not in seen.all_gaps

    return holds


def robot(peer: Peer, domain: int, gid_bytes: int = 16, enclave: str = "/robot/head") -> None:
    """Two nodes with a topic, a service and an action between them, as rmw_fastrtps would say it."""
    goal, result = ("nav2_msgs::action::dds_::Spin_SendGoal_", "nav2_msgs::action::dds_::Spin_GetResult_")
    trigger = "std_srvs::srv::dds_::Trigger_"
    peer.does("participant", domain, enclave, gid_bytes)
    peer.does("node", "/", "camera")
    peer.does("writer", "rt/camera/image_raw", IMAGE, "RIHS01_" + "ab" * 32)
    peer.does("reader", "rq/saveRequest", f"{trigger}Request_")
    peer.does("writer", "rr/saveReply", f"{trigger}Response_", "")
    peer.node(
        "/ui",
        "viewer",
        ("reader", "rt/camera/image_raw", IMAGE),
        ("writer", "rq/saveRequest", f"{trigger}Request_"),
        ("reader", "rr/saveReply", f"{trigger}Response_"),
        ("writer", "rq/spin/_action/send_goalRequest", f"{goal}Request_"),
        ("reader", "rr/spin/_action/get_resultReply", f"{result}Response_"),
        ("reader", "rt/spin/_action/feedback", "nav2_msgs::action::dds_::Spin_FeedbackMessage_"),
    )
    peer.does("announce")


@pytest.mark.parametrize("gid_bytes", [16, 24], ids=["Iron and later", "Humble"])
def test_what_peers_declare_is_what_is_seen(peer: Peer, domain: int, gid_bytes: int) -> None:
    robot(peer, domain, gid_bytes)
    seen = looked(domain, has(2, 7))
    assert {(node.name, node.enclave) for node in seen.nodes} == {
        ("/camera", "/robot/head"),
        ("/ui/viewer", "/robot/head"),
    }
    assert {(one.node, one.role, one.name, one.type, one.hash) for one in seen.endpoints} == {
        ("/camera", "publish", "/camera/image_raw", "sensor_msgs/msg/Image", "RIHS01_" + "ab" * 32),
        ("/camera", "reply", "/save", "std_srvs/srv/Trigger", ""),
        ("/ui/viewer", "subscribe", "/camera/image_raw", "sensor_msgs/msg/Image", ""),
        ("/ui/viewer", "request", "/save", "std_srvs/srv/Trigger", ""),
        ("/ui/viewer", "request", "/spin/_action/send_goal", "nav2_msgs/action/Spin_SendGoal", ""),
        ("/ui/viewer", "request", "/spin/_action/get_result", "nav2_msgs/action/Spin_GetResult", ""),
        ("/ui/viewer", "subscribe", "/spin/_action/feedback", "nav2_msgs/action/Spin_FeedbackMessage", ""),
    }
    assert (seen.doors, seen.domains, seen.all_gaps, seen.remarks) == (("dds",), (domain,), {}, ())


def test_peers_see_one_more_participant_and_no_ros_node(peer: Peer, domain: int) -> None:
    robot(peer, domain)
    told = [peer.does("seen") for _ in DdsDoor(now, domain, interface="lo").looks(12)]
    assert "1 0" in told  # participants beside itself, writers of ros_discovery_info beside its own
    assert not [line for line in told if not line.endswith(" 0")]


def test_a_look_that_is_too_short_says_so(peer: Peer, domain: int) -> None:
    robot(peer, domain)
    *_, seen = DdsDoor(now, domain, interface="lo").looks(2)
    assert STILL_CHANGING in seen.all_gaps


def test_endpoints_without_nodes_are_kept_with_their_participant(peer: Peer, domain: int) -> None:
    peer.does("participant", domain, "", 16)
    peer.does("loose-writer", "rt/scan", "sensor_msgs::msg::dds_::LaserScan_", "")
    peer.does("loose-writer", "Square", "ShapeType", "")
    seen = looked(domain, has(0, 1))
    (one,) = seen.endpoints
    assert (one.node, one.role, one.name, one.type) == ("", "publish", "/scan", "sensor_msgs/msg/LaserScan")
    assert len(one.participant) == 24
    assert seen.all_gaps == {NO_NODE: 1, REFUSED: 1}


def test_hostile_names_arrive_as_they_are_and_nothing_else_is_lost(peer: Peer, domain: int) -> None:
    hostile = ["</topic>", "a\x1b[31m\x07b", "../../etc/passwd", "$(reboot)", "x" * 240, "é\u202e", "a b", "&amp;"]
    peer.does("participant", domain, "/../..", 16)
    peer.does("node", "/", "good")
    for name in hostile:
        peer.does("writer", f"rt/{name}", TEXT, "")
    peer.node("/'\"><x", "bad\x00name", ("writer", "rt/plain", TEXT))
    peer.does("announce")
    seen = looked(domain, has(2, len(hostile) + 1))
    assert {one.name for one in seen.endpoints} >= {f"/{name}" for name in hostile}
    assert "/good" in {node.name for node in seen.nodes}


def test_a_peer_cannot_give_itself_what_another_has(peer: Peer, other: Peer, domain: int) -> None:
    robot(peer, domain)
    other.does("participant", domain, "/robot/head", 16)  # says it is in the same enclave, and has a node of that name
    other.node("/", "camera", ("writer", "rt/uplink", TEXT))
    other.does("announce")
    seen = looked(domain, has(3, 8))
    assert {one.name for one in seen.endpoints if one.node == "/camera"} == {"/camera/image_raw", "/save", "/uplink"}


def test_two_thousand_topics_are_all_seen(peer: Peer, domain: int) -> None:
    peer.does("participant", domain, "", 16)
    peer.does("node", "/", "many")
    for number in range(2_000):
        peer.does("writer", f"rt/part{number}/value", TEXT, "")
    peer.does("announce")
    seen = looked(domain, has(1, 2_000), 60)
    assert {one.name for one in seen.endpoints if one.node == "/many"} == {f"/part{n}/value" for n in range(2_000)}
    assert seen.all_gaps == {}


def test_who_comes_and_who_leaves_is_told(peer: Peer, other: Peer, domain: int) -> None:
    robot(peer, domain)
    looks = DdsDoor(now, domain, interface="lo").looks(60)
    _until(looks, lambda seen: {node.name for node in seen.nodes} == {"/camera", "/ui/viewer"})
    other.does("participant", domain, "", 16)
    other.node("/", "uplink", ("reader", "rt/camera/image_raw", IMAGE))
    other.does("announce")
    begun = time.monotonic()
    _until(looks, lambda seen: "/uplink" in {node.name for node in seen.nodes})
    assert time.monotonic() - begun < SLACK
    other.does("leave")
    begun = time.monotonic()
    _until(looks, lambda seen: {node.name for node in seen.nodes} == {"/camera", "/ui/viewer"})
    assert time.monotonic() - begun < SLACK


def _until(looks: Iterator[Observation], holds: Callable[[Observation], bool]) -> None:
    assert any(holds(seen) for seen in looks)


def test_what_nodes_declare_of_themselves_is_heard_and_no_other_message(peer: Peer, domain: int) -> None:
    texts = ("/head/camera", "the camera in the head", "to greet people by name", "/var/faces.db")
    peer.does("participant", domain, "", 16)
    peer.does("node", "/", "greeter")
    peer.does("declare", "rt/greeter/processing", DDS_TYPE, *texts)
    peer.does("declare", "rt/greeter/log", TEXT, "secret", "", "", "")
    peer.does("announce")
    seen = looked(domain, lambda seen: bool(seen.declared) and has(1, 2)(seen))
    assert seen.declared == (Declared("/greeter/processing", *texts),)


def test_a_participant_that_shows_nothing_of_itself_is_told(peer: Peer, other: Peer, domain: int) -> None:
    """What a secured domain looks like to somebody outside: participants without endpoints."""
    peer.does("participant", domain, "/robot/head", 16)
    robot(other, domain)
    seen = looked(domain, lambda seen: len(seen.nodes) == 2 and seen.all_gaps == {HIDDEN: 1})
    assert seen.all_gaps == {HIDDEN: 1}
    assert seen.remarks[0].startswith("participants that show none of their endpoints: 1; the domain looks secured")
