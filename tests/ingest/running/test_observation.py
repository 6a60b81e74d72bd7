"""Rule S16: observation only adds."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations
from time import process_time

import pytest

from rosprivacy.ingest.policies.observed_metadata import NO_NODE, STILL_CHANGING
from rosprivacy.ingest.running.observation import Span, added_up, continued
from rosprivacy.ingest.running.observed_files import policy_xml, prepared
from rosprivacy.ingest.running.observed_names import with_folded_names, with_good_names
from tests.helpers.observed import at, endpoint, looked, saw


def test_what_was_seen_once_stays_and_times_add_up_in_any_order() -> None:
    several = [
        looked("/a", "/b", first=0, last=5),
        looked("/b", first=7, last=9, door="dds"),
        looked("/c", first=3, last=4),
    ]
    sums = {str(added_up(order)) for order in permutations(several)}
    assert len(sums) == 1
    whole = added_up(several)
    assert [(node.name, node.span) for node in whole.nodes] == [
        ("/a", Span(at(0), at(5))),
        ("/b", Span(at(0), at(9))),
        ("/c", Span(at(3), at(4))),
    ]
    assert whole.doors == ("dds", "text")
    assert whole.span == Span(at(0), at(9))


def test_an_endpoint_of_no_node_gets_its_node_when_that_is_told_later() -> None:
    """The first match of ``ros_discovery_info`` takes seconds: the endpoint is there before its node."""
    early = saw(endpoint("", "publish", "/x", key="g1", participant="p1"), endpoint("", "publish", "/y", key="g2"))
    late = saw(endpoint("/cam", "publish", "/x", key="g1"))
    whole = continued(early, late)
    assert [(one.node, one.name) for one in whole.endpoints] == [("", "/y"), ("/cam", "/x")]
    assert whole.all_gaps == {NO_NODE: 1}


def test_gaps_stay_but_only_the_end_says_whether_it_still_changed() -> None:
    early, late = saw(still_changing=1, refused=2), saw(refused=1)
    assert continued(early, late).all_gaps == {"refused": 2}
    assert continued(late, early).all_gaps == {"refused": 2, STILL_CHANGING: 1}
    assert added_up([early, late]).all_gaps == {"refused": 2, STILL_CHANGING: 1}


def test_made_up_names_are_folded_if_they_did_not_live_at_one_time() -> None:
    one, two = "/transform_listener_impl_55aa01", "/transform_listener_impl_77bb02"
    apart, folded = with_folded_names(added_up([looked(one, first=0, last=1), looked(two, first=2, last=3)]))
    assert [node.name for node in apart.nodes] == ["/transform_listener_impl"]
    assert folded[0].names == (one, two)
    assert folded[0].rule == "transform_listener_impl_<address>"
    together = added_up([looked(one, first=0, last=2), looked(two, first=2, last=3)])
    assert with_folded_names(together) == (together, ())


def test_cam_1_and_cam_2_stay_two() -> None:
    """Rule S16: only listed generators; nobody lists what made these."""
    whole = added_up([looked("/cam_1", first=0, last=1), looked("/cam_2", first=2, last=3)])
    assert with_folded_names(whole) == (whole, ())


def test_a_name_is_not_folded_into_a_node_that_lives_at_the_same_time() -> None:
    whole = looked("/launch_ros", "/launch_ros_4711")
    assert with_folded_names(whole) == (whole, ())


def test_a_folded_node_takes_its_own_channels_with_it() -> None:
    seen = saw(endpoint("/launch_ros_4711", "reply", "/launch_ros_4711/get_parameters"))
    whole, _ = with_folded_names(replace(seen, nodes=looked("/launch_ros_4711").nodes))
    assert [(one.node, one.name) for one in whole.endpoints] == [("/launch_ros", "/launch_ros/get_parameters")]


def test_hostile_names_are_left_out_counted_and_told_in_one_line_each() -> None:
    bad = ["/a\nb", "/<b>&", "/" + "x" * 4000, "/a/*", "/../../etc", "no_slash", "/\x1b[31m", "/ä"]
    seen = saw(
        *(endpoint("/n", "publish", name, "std_msgs/msg/String") for name in bad), endpoint("/n", "publish", "/ok")
    )
    kept = with_good_names(seen)
    assert [one.name for one in kept.endpoints] == ["/ok"]
    assert kept.all_gaps == {"refused": len(bad)}
    assert len(kept.remarks) == len(bad)
    assert all(remark.isprintable() and len(remark) < 400 for remark in kept.remarks)


def test_a_type_that_is_none_is_not_known_and_the_channel_stays() -> None:
    kept = with_good_names(saw(endpoint("/n", "publish", "/ok", "<script>", hash="RIHS01_zz")))
    assert [(one.name, one.type, one.hash) for one in kept.endpoints] == [("/ok", "", "")]
    assert "is no type" in kept.remarks[0]


def test_parts_of_an_action_are_one_action_for_who_sends_or_takes_goals() -> None:
    """Rule S3; who only listens is no client of the action."""
    parts = [
        endpoint("/ui", "request", "/spin/_action/send_goal", "t/action/Spin_SendGoal"),
        endpoint("/ui", "request", "/spin/_action/get_result", "t/action/Spin_GetResult"),
        endpoint("/ui", "subscribe", "/spin/_action/feedback", "t/action/Spin_FeedbackMessage"),
        endpoint("/nav", "reply", "/spin/_action/send_goal", "t/action/Spin_SendGoal"),
        endpoint("/nav", "publish", "/spin/_action/status", "action_msgs/msg/GoalStatusArray"),
        endpoint("/log", "subscribe", "/spin/_action/status", "action_msgs/msg/GoalStatusArray"),
    ]
    made = prepared(saw(*parts)).observation.endpoints
    assert {(one.node, one.role, one.name, one.type) for one in made} == {
        ("/ui", "call", "/spin", "t/action/Spin"),
        ("/nav", "execute", "/spin", "t/action/Spin"),
        ("/log", "subscribe", "/spin/_action/status", "action_msgs/msg/GoalStatusArray"),
    }


def test_endpoints_of_no_node_stand_under_a_name_of_their_own_and_are_a_gap() -> None:
    """Data is followed through them, so nothing is lost (rule S16)."""
    ready = prepared(saw(endpoint("", "subscribe", "/image", key="k", participant="01:0f/../x")))
    assert ready.enclaves == {"/_no_node/participant_01_0f_x": ("/_no_node/participant_01_0f_x",)}
    assert ready.observation.all_gaps == {NO_NODE: 1}
    text = policy_xml(ready)
    assert b'gaps="no-node:1"' in text
    assert b'ns="/_no_node" node="participant_01_0f_x"' in text
    assert b'<participant node="/_no_node/participant_01_0f_x"/>' in text


@pytest.mark.slow
def test_thousands_of_topics_take_time_in_proportion() -> None:
    """Ten times as many take about ten times as long, not a hundred; made-up nodes too. By the processor."""

    def seconds(number: int) -> float:
        topics = [
            endpoint(f"/launch_ros_{n}", "publish", f"/launch_ros_{n}/topic_{n}", "t/msg/T") for n in range(number)
        ]
        start = process_time()
        policy_xml(prepared(saw(*topics)))
        return process_time() - start

    seconds(50)
    assert min(seconds(4_000) for _ in range(2)) < 40 * min(seconds(400) for _ in range(3))
