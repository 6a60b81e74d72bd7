"""The live example: a small robot with a camera, as ``ros2 node info`` tells of it, and a person's labels."""

from __future__ import annotations

from tests.helpers.observed import node_info

GRAPH = (
    node_info("/head/camera_driver", publishers="/head/camera/image_raw: sensor_msgs/msg/Image")
    + node_info(
        "/face_recognizer",
        subscribers="/head/camera/image_raw: sensor_msgs/msg/Image",
        publishers="/faces: hri_msgs/msg/IdsList",
    )
    + node_info(
        "/archive",
        subscribers="/faces: hri_msgs/msg/IdsList",
        service_servers="/save_footage: std_srvs/srv/SetBool",
    )
    + node_info(
        "/navigator",
        service_clients="/save_footage: std_srvs/srv/SetBool",
        action_servers="/navigate_to_pose: nav2_msgs/action/NavigateToPose",
    )
)
LABELS = """labels: 1
nodes:
  /archive: {leak: [Video, PersonIdentifier]}
  /face_recognizer: {source: [PersonIdentifier]}
  /head/camera_driver: {source: [Video]}
"""
