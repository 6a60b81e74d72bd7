"""Linked data has the types of channels, and what only they close, apart from findings (rule S15)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from rdflib import RDF, Graph

import rosprivacy
from rosprivacy.formats import Style, written
from rosprivacy.report.rdf.terms import RP
from tests.helpers.fleet_files import policy
from tests.helpers.linked_data import problems

if TYPE_CHECKING:
    from rdflib.term import Node

LABELS = """labels: 1
nodes: {/cam: {source: [Video]}, /sink: {leak: [Video]}}
channels: {/b: {types: [sensor_msgs/msg/Image]}}
"""
SEEN = "types: 1\ntopics: {/a: [{type: std_msgs/msg/Bool, writers: [/cam]}], /b: [{type: own_msgs/msg/B}]}\n"
FLEET = (
    "fleet: 1\nrobots: {r1: {policies: p.xml, labels: l.yaml, types: t.yaml}, r2: {policies: p.xml, labels: m.yaml}}\n"
)


@pytest.fixture(autouse=True)
def a_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy("/cam>/a,/b", "/sink</a", "/other</b"), "utf-8")
    Path("l.yaml").write_text(LABELS, "utf-8")
    Path("m.yaml").write_text(LABELS.replace("/sink: {leak: [Video]}", "/sink: "), "utf-8")
    Path("t.yaml").write_text(SEEN, "utf-8")
    Path("f.yaml").write_text(FLEET, "utf-8")


def graph_of(result: Any, **how: Any) -> Graph:
    made = Graph().parse(data=written(result, "turtle", **how), format="turtle")
    assert problems(made) == ""
    return made


def told(graph: Graph, of: Node | None, *terms: Node) -> tuple[str, ...]:
    return tuple(str(graph.value(of, term)).rpartition("#")[2] for term in terms)


def test_each_channel_has_its_types_with_the_file_that_says_so() -> None:
    graph = graph_of(rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml"))
    found = {
        (str(graph.value(channel, RP.name)), *told(graph, one, RP.messageType, RP.stated, RP.file, RP.line))
        for channel, one in graph.subject_objects(RP.hasType)
    }
    assert found == {
        ("/a", "std_msgs/msg/Bool", "false", "t.yaml", "2"),
        ("/b", "own_msgs/msg/B", "false", "t.yaml", "2"),
        ("/b", "sensor_msgs/msg/Image", "true", "l.yaml", "3"),
    }
    for one in graph.subjects(RDF.type, RP.ChannelType):
        assert told(graph, graph.value(one, RP.inFile), RP.file) == told(graph, one, RP.file)


def test_what_only_types_close_is_told_and_is_no_finding() -> None:
    result = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml")
    graph, (closed,) = graph_of(result), result.document()["assumptions"]["closed_by_types"]
    (answer,) = graph.subjects(RDF.type, RP.Analysis)
    (limit,) = graph.objects(answer, RP.limitedBy)
    assert told(graph, graph.value(limit, RP.element), RP.name) == ("/a",)
    assert told(graph, limit, RP.cannotCarry) == ("Video",)
    (one,) = graph.objects(answer, RP.closedByTypes)
    assert told(graph, one, RP.id, RP.category) == (closed["id"], "Video")
    assert told(graph, graph.value(one, RP.leak), RP.name) == ("/sink",)
    assert not list(graph.subjects(RDF.type, RP.Finding))
    unlimited = graph_of(rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits=None))
    assert not list(unlimited.subjects(RDF.type, RP.ClosedFinding))
    assert told(unlimited, next(unlimited.subjects(RDF.type, RP.Finding)), RP.id) == (closed["id"],)


def test_a_fleet_has_them_for_the_robot_that_stands_for_all() -> None:
    graph = graph_of(rosprivacy.analyze_fleet("f.yaml"))
    found = {told(graph, channel, RP.robot, RP.name) for channel, _ in graph.subject_objects(RP.hasType)}
    assert found == {("r1", "/a"), ("r1", "/b"), ("r2", "/b")}
    (closed,) = graph.subjects(RDF.type, RP.ClosedFinding)
    assert told(graph, graph.value(closed, RP.dataSource), RP.robot) == ("r1",)


def test_a_copy_without_names_says_as_much_and_names_no_type() -> None:
    """What a type is called can name a maker: the redacted document leaves it out too."""
    result = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml")
    whole, copy = graph_of(result), graph_of(result, style=Style(redact=True))
    assert len(whole) == len(copy)
    for word in ("own_msgs", "sensor_msgs", "t.yaml", "/cam", "/sink"):
        assert [word in str(value) for value in whole.objects()].count(True)
        assert not [value for value in copy.objects() if word in str(value)]


def test_without_types_nothing_is_said_of_them() -> None:
    Path("plain.yaml").write_text("labels: 1\nnodes: {/cam: {source: [Video]}}\n", "utf-8")
    graph = graph_of(rosprivacy.analyze("p.xml", "plain.yaml"))
    assert not list(graph.subject_objects(RP.hasType))
