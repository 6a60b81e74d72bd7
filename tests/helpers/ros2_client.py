"""Robots that are not ours: ros2-client, a ROS 2 in Rust, on DDS and on Zenoh, and what they declare.

The programs of ``tests/ingest/running/peers/ros2_client`` are built once, which takes minutes: for the thorough run.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.fastdds import Peer
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

SOURCE = ROOT / "tests" / "ingest" / "running" / "peers" / "ros2_client"
NODES = {"/head/camera_driver", "/face_recognizer", "/archive", "/navigator"}
ENDPOINTS = {  # what the programs state: node, role, name, type
    ("/head/camera_driver", "publish", "/head/camera/image_raw", "sensor_msgs/msg/Image"),
    ("/face_recognizer", "subscribe", "/head/camera/image_raw", "sensor_msgs/msg/Image"),
    ("/face_recognizer", "publish", "/faces", "hri_msgs/msg/IdsList"),
    ("/archive", "subscribe", "/faces", "hri_msgs/msg/IdsList"),
    ("/archive", "reply", "/save_footage", "std_srvs/srv/SetBool"),
    ("/navigator", "request", "/save_footage", "std_srvs/srv/SetBool"),
    *{
        ("/navigator", role, f"/navigate_to_pose/_action/{part}", type_)
        for role, part, type_ in [
            ("reply", "send_goal", "nav2_msgs/action/NavigateToPose_SendGoal"),
            ("reply", "get_result", "nav2_msgs/action/NavigateToPose_GetResult"),
            ("reply", "cancel_goal", "action_msgs/srv/CancelGoal"),
            ("publish", "feedback", "nav2_msgs/action/NavigateToPose_FeedbackMessage"),
            ("publish", "status", "action_msgs/msg/GoalStatusArray"),
        ]
    },
}
LOGS = {(node, "publish", "/rosout", "rcl_interfaces/msg/Log") for node in NODES}
PARAMETERS = {(node, "publish", "/parameter_events", "rcl_interfaces/msg/ParameterEvent") for node in NODES}


@contextmanager
def robot(program: Path, domain: int, **variables: str) -> Iterator[Peer]:
    """Run one; it ends with the block."""
    environment = os.environ | {"ROS_DOMAIN_ID": str(domain)} | variables
    with subprocess.Popen(
        [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            yield Peer(process)
        finally:
            process.terminate()


@pytest.fixture(scope="session")
def ros2_client() -> dict[str, Path]:
    """The programs by name; what was built stays in ``build``, or where ``CARGO_TARGET_DIR`` says."""
    if shutil.which("cargo") is None:
        pytest.skip("NO cargo (Rust 1.88 or later): observation was tested with no robot of ros2-client")
    command = ["cargo", "build", "--locked", "--quiet", "--message-format=json-render-diagnostics"]
    environment = {"CARGO_TARGET_DIR": str(ROOT / "build" / "ros2_client")} | os.environ
    done = subprocess.run(command, cwd=SOURCE, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    programs = [json.loads(line).get("executable") for line in done.stdout.splitlines()]
    return {Path(one).name: Path(one) for one in programs if one}
