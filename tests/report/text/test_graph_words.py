"""Values of the graph in words, where the database of an example has none such."""

from __future__ import annotations

from itertools import pairwise

from rosprivacy.queries.graph_values import Node, Path
from rosprivacy.report.text.graph_words import GraphWords
from tests.helpers.stored import NAMES, node, relation

CAMERA = node("/camera", "RosNode")
IMAGE = node("/image", "Topic", kind="topic")
NAMED = GraphWords.for_rows(NAMES, [])


def test_a_denied_flow_is_said_to_be_denied() -> None:
    """Rule S5: it is no path."""
    denied = relation(CAMERA, "FLOWS_TO", IMAGE, role="publish", decision="deny", file="p.xml", line=3)
    assert NAMED.of(denied) == "/camera (node) | publishes (denied) p.xml:3 -> /image (topic)"


def test_what_people_add_and_what_is_no_element_is_told_too() -> None:
    bucket, enclave = node("bucket", "Storage"), Node("4:x:7", ("Enclave",), {"path": "/home", "id": "r1|/home"})
    steps = (relation(CAMERA, "FLOWS_TO", bucket), relation(bucket, "IN_ENCLAVE", enclave))
    said = "/camera (node) | goes to -> bucket (storage) | IN_ENCLAVE -> /home (Enclave)"
    assert NAMED.of(Path((CAMERA, bucket, enclave), steps)) == said
    assert NAMED.of(Node("4:x:8", (), {})) == "4:x:8 (no label)"
    assert NAMED.of(node("/tracker", "Intake", kind="node")) == "/tracker (node)"
    assert NAMED.of(node("/a*", "Topic", "Wildcard", side="write")) == "/a* (topic wildcard)"


def test_of_several_robots_each_element_is_named_with_its_own() -> None:
    """As elsewhere in the program."""
    other = node("/camera", "RosNode", robot="r2")
    assert GraphWords.for_rows(NAMES, ((CAMERA, IMAGE),)).of(CAMERA) == "/camera (node)"
    several = GraphWords.for_rows(NAMES, ((CAMERA, [{"x": other}]),))
    assert several.of(relation(CAMERA, "FLOWS_TO", other)) == "r1:/camera (node) | goes to -> r2:/camera (node)"


def test_a_path_is_never_cut() -> None:
    long = [node(f"/{'n' * 300}{i}", "RosNode") for i in range(40)]
    steps = tuple(relation(a, "CARRIES_VIDEO", b) for a, b in pairwise(long))
    said = NAMED.of(Path(tuple(long), steps))
    assert [part.split(" ")[0] for part in said.split(" -> ")] == [n.properties["name"] for n in long]
