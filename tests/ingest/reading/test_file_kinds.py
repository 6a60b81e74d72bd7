"""What a file is by its content, whatever stands before it as a comment."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.reading.file_kinds import kind_of

OF_VALUES = {
    "labels: 1\nnodes: {}\n": "a label file",
    "decisions: 1\n": "a file of decisions",
    "services:\n  web:\n    image: x\n": "a file of Docker Compose",
    "/camera:\n  ros__parameters:\n    fps: 30\n": "a file of ROS parameters",
    "/**:\n  ros__parameters:\n    fps: 30\n": "a file of ROS parameters",
    "launch:\n- node: {}\n": "a launch file",
    "rosbag2_bagfile_information:\n  version: 5\n": "a bag",
    'policies = "p.xml"\n': "a project file",
    "description: x\nnodl_version: 2\n": "a description of a node's interface (NoDL)",
    "nodes:\n- name: /a\n  publishers: []\n  subscriptions: []\n": "a message with the graph of ROS",
}
OF_XML = {
    "<robot name='r'/>": "a description of a robot's body (URDF)",
    "<interface version='1'/>": "a description of a node's interface (NoDL)",
    "<launch/>": "a launch file",
    "<policy version='0.2.0'/>": "an SROS 2 policy",
}
WORDS = st.text("abc :/<>{}=*", max_size=20)


@given(st.sampled_from(sorted(OF_VALUES.items())), st.lists(WORDS, max_size=4))
def test_comments_before_values_change_nothing(file: tuple[str, str], lines: list[str]) -> None:
    text, name = file
    kind = kind_of(("".join(f"# {line}\n" for line in lines) + text).encode())
    assert kind is not None
    assert kind.name == name


@given(st.sampled_from(sorted(OF_XML.items())), st.lists(WORDS, max_size=4))
def test_comments_before_an_element_change_nothing(file: tuple[str, str], lines: list[str]) -> None:
    text, name = file
    kind = kind_of(("".join(f"<!-- {line.replace('-', '')} -->\n" for line in lines) + text).encode())
    assert kind is not None
    assert kind.name == name


@given(st.sampled_from(["Robot", "A page", "see"]), st.lists(WORDS, max_size=6))
def test_prose_is_nothing(first: str, lines: list[str]) -> None:
    assert kind_of("\n".join([f"{first} and more", *lines]).encode()) is None


@given(st.binary(max_size=300))
def test_any_bytes_have_a_kind_or_none(data: bytes) -> None:
    kind = kind_of(data)
    assert kind is None or kind.name
