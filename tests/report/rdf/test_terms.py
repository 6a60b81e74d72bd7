"""Individuals of two systems do not collide when their files are put together; the same files give the same names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from rdflib import RDF, Graph, Literal, URIRef

import rosprivacy
from rosprivacy.analysis.errors import InputError
from rosprivacy.report.rdf.terms import DPV, RP, names_of
from tests.helpers.linked_data import problems

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result
    from tests.helpers.command import Cli

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/{0}"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>{0}</topic></topics></profile></profiles></enclave></enclaves></policy>"""
LABELS = """labels: 1
nodes: {{/camera: {{source: [Video]}}}}
elements: {{cloud: {{kind: external-system, country: {0}, leak: [Video]}}}}
flows: [{{from: /camera, to: cloud}}]
"""


def robot(folder: Path, topic: str, country: str) -> Result:
    """A robot whose ``/camera`` sends to a ``cloud``, as that of another can."""
    folder.mkdir(parents=True)
    (folder / "policy.xml").write_text(POLICY.format(topic))
    (folder / "robot.labels.yaml").write_text(LABELS.format(country))
    return rosprivacy.analyze([str(folder / "policy.xml")], [str(folder / "robot.labels.yaml")])


def exported(result: Result, base: str | None = None) -> Graph:
    return Graph().parse(data=result.to("turtle", base=base), format="turtle")


def individuals(graph: Graph) -> set[URIRef]:
    """What the file describes, but for terms of ours and of DPV."""
    described = {node for node in graph.subjects() if isinstance(node, URIRef)}
    return {node for node in described if not str(node).startswith(("https://w3id.org/",))}


@pytest.mark.parametrize(
    ("topic", "country"), [("video", "CN"), ("audio", "US")], ids=["another label file", "another policy"]
)
def test_two_robots_with_a_camera_stay_two_when_their_files_are_put_together(
    tmp_path: Path, topic: str, country: str
) -> None:
    """Law review, section 4, no. 1: nothing of one is said of the other."""
    one = exported(robot(tmp_path / "one", "video", "US"))
    two = exported(robot(tmp_path / "two", topic, country))
    assert not individuals(one) & individuals(two)
    both = one + two
    for graph in (one, two):
        for node in individuals(graph):
            assert set(both.predicate_objects(node)) == set(graph.predicate_objects(node))
    cameras = set(both.subjects(RP.name, Literal("/camera")))
    clouds = {
        str(value) for cloud in both.subjects(RP.name, Literal("cloud")) for value in both.objects(cloud, RP.country)
    }
    assert len(cameras) == 2
    assert clouds == {"US", country}
    assert len(set(both.subjects(RDF.type, RP.Finding))) == len(set(both.objects(None, RP.concerns))) == 4
    assert problems(both) == ""


def test_the_same_files_have_the_same_names_wherever_they_lie(tmp_path: Path) -> None:
    first, again = (robot(tmp_path / name, "video", "US") for name in ("here", "there"))
    kinds = (RP.Finding, RP.Element, DPV.Process)
    told = [{node for kind in kinds for node in exported(one).subjects(RDF.type, kind)} for one in (first, again)]
    assert told[0] == told[1] != set()


def test_a_base_is_what_every_name_begins_with(tmp_path: Path) -> None:
    base = "https://example.org/robots/r2/"
    graph = exported(robot(tmp_path / "one", "video", "US"), base)
    assert individuals(graph)
    assert all(node.startswith(base) for node in individuals(graph))
    assert (URIRef(f"{base}element::node:/camera"), RDF.type, RP.RosNode) in graph


def test_what_rests_on_no_file_has_a_name_of_its_own() -> None:
    """A system made in memory: what is told of it tells it from others."""
    documents: list[dict[str, Any]] = [{"assumptions": {}, "verdict": verdict} for verdict in ("leak", "no-leak-found")]
    bases = {names_of(document).base for document in documents}
    assert len(bases) == 2
    assert all(base.startswith("urn:uuid:") for base in bases)


@pytest.mark.parametrize("base", ["r2/", "https://example.org", "urn:a b:", "urn:<x>#", "#", "", "urn:x:\n", "1:/"])
def test_what_is_no_base_is_refused(base: str) -> None:
    with pytest.raises(InputError, match=r"^base: .* is not a base of IRIs; give an IRI that ends in / or # or :"):
        names_of({"assumptions": {}}, base)


def test_the_command_line_takes_one_and_says_where_it_makes_no_sense(cli: Cli, tmp_path: Path) -> None:
    robot(tmp_path / "one", "video", "US")
    asked = ("analyze", tmp_path / "one" / "policy.xml", "-l", tmp_path / "one" / "robot.labels.yaml")
    assert "<urn:example:r2#element::node:/camera>" in cli(*asked, "-f", "turtle", "--base", "urn:example:r2#").stdout
    refused = cli(*asked, "-f", "turtle", "--base", "r2")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr.startswith("base: 'r2' is not a base of IRIs; give an IRI that ends in")
    assert cli(*asked, "-f", "turtle", "--base", "").returncode == 2
    other = cli(*asked, "--base", "urn:example:r2#")
    assert other.returncode == 2
    assert "--base is for --format turtle, json-ld" in other.stderr
