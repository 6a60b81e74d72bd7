"""The picture of what a query gives: everything is there, with the looks of the view that it belongs to."""

from __future__ import annotations

from rosprivacy.queries.graph_values import GraphValue, Node, Path
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.pictures.graphviz import drawn
from rosprivacy.report.pictures.picture import PRIVACY, ROS, Picture
from rosprivacy.report.pictures.query_view import query_view
from tests.helpers.pictures import HOSTILE
from tests.helpers.stored import NAMES, node, relation

CAMERA = node("/camera", "RosNode", "VideoSource", begins=["Video"], leaks=[])
IMAGE = node("/image", "Topic")
BLUR = node("/blur", "RosNode", "VideoSanitizer", sanitizes=["Video"], stops=[], leaks=[])
DROP = node("/drop", "RosNode", "VideoSanitizer", sanitizes=["Video"], stops=["Video"], leaks=[])
UPLINK = node("/uplink", "RosNode", "VideoLeak", leaks=["Video", "Voice"])
VIEWER = node("/viewer", "RosNode", leaks=["Voice"], open=["Video"])
FACES = node("/faces", "RosNode", "VideoSource", begins=[], leaks=[])
VIDEO = "CARRIES_VIDEO"
STEPS = [
    relation(CAMERA, VIDEO, IMAGE), relation(IMAGE, VIDEO, BLUR), relation(BLUR, VIDEO, UPLINK),
    relation(IMAGE, VIDEO, VIEWER), relation(IMAGE, VIDEO, DROP), relation(FACES, VIDEO, UPLINK),
]  # fmt: skip


def looks(picture: Picture) -> dict[str, tuple[str, ...]]:
    return {box.names[0]: (box.look, *box.words) for box in picture.boxes}


def test_where_data_goes_elements_have_the_roles_of_the_drawn_kinds() -> None:
    """As in the privacy view; a leak of another kind is none here."""
    picture = query_view(STEPS, NAMES, "x")
    assert picture.view == PRIVACY
    assert looks(picture) == {
        "/camera": ("source", "source of Video"),
        "/image": ("reviewed",),
        "/blur": ("sanitizer", "pseudonymises Video"),
        "/drop": ("end", "ends Video"),
        "/uplink": ("leak", "leak of Video"),
        "/viewer": ("open", "not reviewed: Video"),
        "/faces": ("derivation", "makes Video"),
    }
    assert {(line.source[2], line.target[2]): line.look for line in picture.lines} == {
        ("/camera", "/image"): "way", ("/image", "/blur"): "way", ("/blur", "/uplink"): "way",
        ("/faces", "/uplink"): "way", ("/image", "/viewer"): "data", ("/image", "/drop"): "data",
    }  # fmt: skip


def test_flows_are_a_ros_graph_and_what_is_none_is_named() -> None:
    """What policies deny is drawn as such (rule S5); both legs of a service are one box (rule S2)."""
    request, response = node("/add", "Service", "Leg", leg="request"), node("/add", "Service", "Leg", leg="response")
    wild = node("/im*", "Topic", "Wildcard", side="read")
    category = Node("c", ("DataCategory",), {"name": "Video"})
    values: list[GraphValue] = [
        relation(CAMERA, "FLOWS_TO", request, role="request", file="p.xml", line=3),
        relation(response, "FLOWS_TO", CAMERA, role="request"),
        relation(CAMERA, "FLOWS_TO", IMAGE, role="publish", decision="deny"),
        relation(IMAGE, "FLOWS_TO", wild, role="matches"),
        Path((UPLINK, category), (relation(UPLINK, "LEAKS", category, file="l.yaml", line=2),)),
        relation(CAMERA, VIDEO, IMAGE),
    ]
    picture = query_view(values, NAMES, "x")
    assert picture.view == ROS
    assert looks(picture) == {
        "/camera": ("node",), "/uplink": ("node",), "/add": ("service",), "/image": ("topic",), "/im*": ("topic",),
        "Video": ("record", "DataCategory"),
    }  # fmt: skip
    assert {(line.source[2], line.target[2], line.look, line.words) for line in picture.lines} == {
        ("/camera", "/add", "allowed", ""), ("/add", "/camera", "allowed", ""), ("/camera", "/image", "denied", ""),
        ("/image", "/im*", "matches", ""), ("/uplink", "Video (DataCategory)", "other", "LEAKS"),
        ("/camera", "/image", "other", VIDEO),
    }  # fmt: skip


def test_all_of_it_is_in_the_svg_whatever_its_order_and_names() -> None:
    """Rule S14; types stand on their lines, also where Graphviz packs the legend below."""
    nodes = [node(name, "RosNode", robot="r") for name in HOSTILE]
    values = [relation(one, f"TO_{i}", nodes[i - 1]) for i, one in enumerate(nodes)]
    title = "MATCH (n) <b> \u202e RETURN n"
    assert dot(query_view(values, NAMES, title)) == dot(query_view(reversed(values), NAMES, title))
    svg = drawn(query_view(values, NAMES, title), "svg").data.decode()
    assert all(f">TO_{i}<" in svg for i in range(len(nodes)))
    assert "\u202e" not in svg
    assert "<script" not in svg


def test_one_node_alone_and_a_step_to_itself_are_drawn() -> None:
    assert looks(query_view([CAMERA], NAMES, "x")) == {"/camera": ("node",)}
    both = node("/both", "RosNode", "VideoSource", "VideoLeak", begins=["Video"], leaks=["Video"])
    picture = query_view([relation(both, VIDEO, both)], NAMES, "x")
    assert looks(picture) == {"/both": ("leak", "source of Video", "leak of Video")}
