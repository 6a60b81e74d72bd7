"""A DDS domain as an observation: who has which endpoint, what is hidden, and what is not believed (rule S16)."""

from __future__ import annotations

from rosprivacy.ingest.policies.observed_metadata import HIDDEN, NO_NODE, REFUSED
from rosprivacy.ingest.running.dds_graph import DdsEndpoint, DdsGraph, DdsNode, DdsParticipant, observation

IMAGE = "sensor_msgs::msg::dds_::Image_"
START, LATER, NOW = (f"2026-11-22T10:00:0{second}Z" for second in (0, 5, 9))
A, B = b"a" * 12, b"b" * 12


def writer(participant: bytes, number: int, topic: str = "rt/image", since: str = START) -> DdsEndpoint:
    return DdsEndpoint(participant + bytes([0, 0, number, 3]), True, topic, IMAGE, "", since)


def graph(*endpoints: DdsEndpoint, **nodes: tuple[bytes, tuple[bytes, ...]]) -> DdsGraph:
    whole = DdsGraph({of: DdsParticipant(of + b"\0\0\1\xc1", "/robot", START) for of in (A, B)})
    whole.endpoints = {one.guid: one for one in endpoints}
    for name, (of, guids) in nodes.items():
        whole.nodes[of] = (*whole.nodes.get(of, ()), DdsNode(of, f"/{name}", guids, START))
    return whole


def test_an_endpoint_is_of_the_node_that_its_participant_names() -> None:
    one, other = writer(A, 1), writer(B, 1)
    seen = observation(graph(one, other, cam=(A, (one.guid,))), START, NOW, 3)
    assert [(e.node, e.participant) for e in seen.endpoints] == [("/cam", ""), ("", B.hex())]
    assert (seen.all_gaps, seen.domains) == ({NO_NODE: 1}, (3,))
    assert [(node.name, node.enclave) for node in seen.nodes] == [("/cam", "/robot")]


def test_nobody_gets_an_endpoint_of_another_participant_by_claiming_it() -> None:
    one, other = writer(A, 1), writer(B, 1, "rt/secret")
    seen = observation(graph(one, other, liar=(A, (one.guid, other.guid))), START, NOW, 0)
    assert [(e.node, e.name) for e in seen.endpoints] == [("/liar", "/image"), ("", "/secret")]
    assert seen.all_gaps == {NO_NODE: 1, REFUSED: 1}
    assert seen.remarks == ("/liar claims an endpoint of another participant: not believed",)


def test_two_nodes_that_claim_one_endpoint_both_have_it() -> None:
    one, other = writer(A, 1), writer(B, 1)
    seen = observation(graph(one, other, x=(A, (one.guid,)), y=(A, (one.guid,)), z=(B, (other.guid,))), START, NOW, 0)
    assert [e.node for e in seen.endpoints] == ["/x", "/y", "/z"]


def test_a_participant_without_endpoints_and_an_endpoint_that_is_not_shown_are_hidden() -> None:
    one, unseen = writer(A, 1), writer(A, 9)
    seen = observation(graph(one, cam=(A, (one.guid, unseen.guid))), START, NOW, 0)
    assert seen.all_gaps == {HIDDEN: 2}
    assert "looks secured" in seen.remarks[0]


def test_a_topic_of_another_program_is_told() -> None:
    one, other, third = writer(A, 1), writer(B, 1), writer(B, 2, "Square")
    seen = observation(graph(one, other, third, x=(A, (one.guid,)), y=(B, (other.guid,))), START, NOW, 0)
    assert seen.all_gaps == {REFUSED: 1}
    assert seen.remarks == ("left out: the DDS topic 'Square' is no channel of ROS",)


def test_an_endpoint_waits_for_its_node_for_a_while() -> None:
    one, other = writer(A, 1), writer(B, 1, since=LATER)
    whole = graph(one, other, cam=(A, (one.guid,)))
    assert [e.node for e in observation(whole, START, NOW, 0, patience=START).endpoints] == ["/cam"]
    assert [e.node for e in observation(whole, START, NOW, 0).endpoints] == ["/cam", ""]


def test_who_left_is_there_no_more() -> None:
    one, other = writer(A, 1), writer(B, 1)
    whole = graph(one, other, x=(A, (one.guid,)), y=(B, (other.guid,)))
    whole.without(A)
    assert [e.node for e in observation(whole, START, NOW, 0).endpoints] == ["/y"]
    assert observation(whole, START, NOW, 0).all_gaps == {}
