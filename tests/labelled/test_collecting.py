"""The collecting script reads literal names, constants, and defaults of parameters; nothing is run (issue 21)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.labelled.collecting import read_nodes

if TYPE_CHECKING:
    from pathlib import Path

CODE = """
import rclpy
from rclpy.node import Node
from rclpy.action import ActionClient
from sensor_msgs.msg import Image as Picture
from nav2_msgs.action import NavigateToPose
import std_srvs.srv
import std_msgs.msg as words

TOPIC = "said"
raise SystemExit("this is never run")

class Listening(Node):
    PREFIX = "/robot"

    def __init__(self, name="listening"):
        super().__init__(name)
        self.declare_parameter("camera", "/camera/image")
        camera = self.get_parameter("camera").get_parameter_value().string_value
        self.create_subscription(Picture, camera, self.seen, 10)
        self.create_publisher(words.String, TOPIC, 10)
        self.create_publisher(words.String, f"{self.PREFIX}/state", qos_profile=10)
        self.create_publisher(words.String, unknown(), 10)
        self.create_service(std_srvs.srv.Trigger, srv_name="~/stop", callback=self.stop)
        self.client = ActionClient(self, NavigateToPose, "navigate_to_pose")

def main():
    node = rclpy.create_node("beside")
    node.create_publisher(Other, "/beside", 1)
    name = read_name()
    Node(name).create_publisher(Picture, "/nobody", 1)

class Silent(Node):
    def __init__(self):
        super().__init__("silent")
"""


def test_names_and_types_that_stand_there_are_read(tmp_path: Path) -> None:
    (tmp_path / "listening.py").write_text(CODE, "utf-8")
    nodes = read_nodes(tmp_path)
    assert {name: read.channels for name, read in nodes.items()} == {
        "/beside": {"publishes": {"/beside": ""}},
        "/listening": {
            "publishes": {"/robot/state": "std_msgs/msg/String", "/said": "std_msgs/msg/String"},
            "subscribes": {"/camera/image": "sensor_msgs/msg/Image"},
            "serves": {"/listening/stop": "std_srvs/srv/Trigger"},
            "calls": {"/navigate_to_pose": "nav2_msgs/action/NavigateToPose"},
        },
    }
    assert nodes["/beside"].file == "listening.py"


@pytest.mark.parametrize("path", ["build/listening.py", "pkg/test/listening.py", "test_listening.py"])
def test_copies_and_tests_are_no_nodes(tmp_path: Path, path: str) -> None:
    file = tmp_path / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(CODE, "utf-8")
    assert not read_nodes(tmp_path)


def test_a_name_that_is_given_two_values_is_not_literal(tmp_path: Path) -> None:
    code = CODE.replace("TOPIC = ", 'TOPIC = "other"\nTOPIC = ')
    (tmp_path / "listening.py").write_text(code, "utf-8")
    assert set(read_nodes(tmp_path)["/listening"].channels["publishes"]) == {"/robot/state"}


def test_what_is_no_python_is_passed_over(tmp_path: Path) -> None:
    (tmp_path / "old.py").write_text("print 'a'", "utf-8")
    (tmp_path / "bytes.py").write_bytes(b"\0\xff")
    assert not read_nodes(tmp_path)
