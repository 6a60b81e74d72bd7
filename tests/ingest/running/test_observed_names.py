"""Names and types of discovery are those of ROS, or nobody's: DDS topics are read back as grants (rules S3, S15)."""

from __future__ import annotations

import pytest

from rosprivacy.ingest.policies.names import endpoints
from rosprivacy.ingest.running.observed_files import prepared, types_yaml
from rosprivacy.ingest.running.observed_names import ros_channel, ros_type
from tests.helpers.observed import endpoint, saw

PARTS = {"publish": "topic", "subscribe": "topic", "request": "service", "reply": "service"}


@pytest.mark.parametrize("name", ["/a", "/ns/image_raw", "/addRequest", "/x/Reply", "/spin/_action/send_goal"])
@pytest.mark.parametrize("role", PARTS)
def test_what_a_grant_opens_is_read_back_as_that_grant(role: str, name: str) -> None:
    for end in endpoints(role, PARTS[role], name):
        assert ros_channel(end.dds, end.writes) == (role, name)


@pytest.mark.parametrize("topic", ["ros_discovery_info", "DCPSParticipant", "rt", "rt/", "rq/add", "rr/addRequest", ""])
def test_other_topics_are_no_channels(topic: str) -> None:
    assert ros_channel(topic, writes=True) is None


@pytest.mark.parametrize("name", ["", "Image_", "a::b", "a::msg::dds_::Image", "a::msg::Image_", "a::b::c::d::e"])
def test_other_types_are_none_of_ros(name: str) -> None:
    assert ros_type(name) == ""


def test_a_message_that_is_called_request_keeps_its_name() -> None:
    assert ros_type("a_msgs::msg::dds_::Print_Request_") == "a_msgs/msg/Print_Request"


def test_who_also_writes_what_is_not_known_is_no_known_writer() -> None:
    """A limit holds only where the type of every writer is known; a type that is none is not known."""
    writers = [
        endpoint("/good", "publish", "/x", "std_msgs/msg/Bool"),
        endpoint("/odd", "publish", "/x", "std_msgs/msg/Bool"),
        endpoint("/odd", "publish", "/x", "<script>"),
        endpoint("/untold", "publish", "/x"),
    ]
    text = types_yaml(prepared(saw(*writers)).observation)
    assert "writers: [/good]" in text
    assert "/odd" not in text
    assert "/untold" not in text
