"""The text of ``ros2 node info``, exactly as ros2cli prints it."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.running.node_info import MOST_PROBLEMS, read_node_info
from tests.helpers.observed import AT, node_info

TEXT = node_info(
    "/head/camera",
    subscribers="/parameter_events: rcl_interfaces/msg/ParameterEvent",
    publishers="/head/image: sensor_msgs/msg/Image; /x: a/msg/A, b/msg/B",
    service_servers="/save: t/srv/Save",
    action_clients="/spin: t/action/Spin",
)


def test_every_section_is_read() -> None:
    seen = read_node_info(TEXT, AT)
    assert {(one.role, one.name, one.type) for one in seen.endpoints} == {
        ("subscribe", "/parameter_events", "rcl_interfaces/msg/ParameterEvent"),
        ("publish", "/head/image", "sensor_msgs/msg/Image"),
        ("publish", "/x", "a/msg/A"),
        ("publish", "/x", "b/msg/B"),
        ("reply", "/save", "t/srv/Save"),
        ("call", "/spin", "t/action/Spin"),
    }
    assert seen.all_gaps == {"made-without-warnings": 1}  # no line of standard error, and nothing hidden


@pytest.mark.parametrize("text", [TEXT.replace("\n", "\r\n"), "\ufeff" + TEXT, TEXT + "\n\n" + TEXT])
def test_ends_of_lines_a_mark_and_a_node_listed_twice_change_nothing(text: str) -> None:
    said = {(one.node, one.role, one.name, one.type) for one in read_node_info(text, AT).endpoints}
    assert said == {(one.node, one.role, one.name, one.type) for one in read_node_info(TEXT, AT).endpoints}


@pytest.mark.parametrize("text", ["/a\n/b\n", TEXT[: TEXT.index("  Action Servers")]])
def test_a_cut_text_or_a_list_of_nodes_is_a_gap(text: str) -> None:
    assert read_node_info(text, AT).all_gaps["unanswered"] >= 1


def test_other_text_is_refused_with_its_first_lines() -> None:
    for text, problems in (("garbage\n" * 100, 1), ("garbage\n" * 100 + TEXT, MOST_PROBLEMS)):
        with pytest.raises(InputErrors) as refused:
            read_node_info(text, AT, "graph.txt")
        assert len(refused.value.errors) == problems  # a file of another kind is refused once
    assert str(refused.value.errors[0]).startswith("graph.txt:1: not the output of `ros2 node info`: 'garbage'; give")
