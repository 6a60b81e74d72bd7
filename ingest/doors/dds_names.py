"""DDS topics and types -> the channels, roles and types of ROS 2 that they stand for.

In: what an endpoint is called in DDS, and whether it writes. Out: what a policy would have to allow. It is the other
direction of ``ingest/policies/names.py:dds_names``.

Source: *Topic and Service name mapping to DDS* of the ROS 2 design pages; rmw_dds_common for ``ros_discovery_info``.
"""

from __future__ import annotations

import re

NODES_TOPIC = "ros_discovery_info"
_LEGS = {"rt": "", "rq": "Request", "rr": "Reply"}
_SERVICE_PART = re.compile(r"_(?:Request|Response)\Z")


def ros_channel(topic: str, writes: bool) -> tuple[str, str] | None:  # noqa: FBT001  a fact of the endpoint, not an option
    """Return the role of an endpoint and the name of its channel; None if the topic is no channel of ROS.

    A server reads requests and writes replies, a client the other way round (rule S2).

    >>> ros_channel("rt/image", writes=True), ros_channel("rr/addReply", writes=True)
    (('publish', '/image'), ('reply', '/add'))
    >>> ros_channel("Square", writes=True) is None
    True
    """
    prefix, _, rest = topic.partition("/")
    suffix = _LEGS.get(prefix)
    if suffix is None or not rest or not rest.endswith(suffix):
        return None
    name = "/" + rest.removesuffix(suffix)
    if prefix == "rt":
        return ("publish" if writes else "subscribe"), name
    return ("request" if writes == (prefix == "rq") else "reply"), name


def ros_type(dds_type: str) -> str:
    """Return a type as ROS names it; empty if it is none of ROS.

    >>> ros_type("sensor_msgs::msg::dds_::Image_"), ros_type("std_srvs::srv::dds_::Empty_Response_")
    ('sensor_msgs/msg/Image', 'std_srvs/srv/Empty')
    >>> ros_type("nav2_msgs::action::dds_::Spin_SendGoal_Request_"), ros_type("ShapeType")
    ('nav2_msgs/action/Spin_SendGoal', '')
    """
    parts = dds_type.split("::")
    if len(parts) != 4 or parts[2] != "dds_" or not parts[3].endswith("_"):  # noqa: PLR2004  package, kind, dds_, name
        return ""
    name = parts[3].removesuffix("_")
    return "/".join((parts[0], parts[1], name if parts[1] == "msg" else _SERVICE_PART.sub("", name)))


def user_data(data: bytes) -> dict[str, str]:
    """Return what participants and endpoints say beside their names: ``enclave=/path;``, ``typehash=RIHS01_…;``.

    >>> user_data(b"enclave=/robot/camera;")
    {'enclave': '/robot/camera'}
    """
    pairs = (part.partition("=") for part in data.decode(errors="replace").split(";"))
    return {key: value for key, sign, value in pairs if sign}
