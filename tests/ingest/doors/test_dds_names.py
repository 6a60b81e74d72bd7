"""DDS topics stand for channels of ROS in one way: what a grant opens is read back as that grant (rule S3)."""

from __future__ import annotations

import pytest

from rosprivacy.ingest.doors.dds_names import ros_channel, ros_type
from rosprivacy.ingest.policies.names import endpoints

PARTS = {"publish": "topic", "subscribe": "topic", "request": "service", "reply": "service"}


@pytest.mark.parametrize("name", ["/a", "/ns/image_raw", "/addRequest", "/x/Reply", "/spin/_action/send_goal"])
@pytest.mark.parametrize("role", PARTS)
def test_what_a_grant_opens_is_read_back_as_that_grant(role: str, name: str) -> None:
    for endpoint in endpoints(role, PARTS[role], name):
        assert ros_channel(endpoint.dds, endpoint.writes) == (role, name)


@pytest.mark.parametrize("topic", ["ros_discovery_info", "DCPSParticipant", "rt", "rt/", "rq/add", "rr/addRequest", ""])
def test_other_topics_are_no_channels(topic: str) -> None:
    assert ros_channel(topic, writes=True) is None


@pytest.mark.parametrize("name", ["", "Image_", "a::b", "a::msg::dds_::Image", "a::msg::Image_", "a::b::c::d::e"])
def test_other_types_are_none_of_ros(name: str) -> None:
    assert ros_type(name) == ""


def test_a_message_that_is_called_request_keeps_its_name() -> None:
    assert ros_type("a_msgs::msg::dds_::Print_Request_") == "a_msgs/msg/Print_Request"
