"""Files of packages: what is read, and each problem at its line."""

from __future__ import annotations

import hashlib
import json
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest
import yaml

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import Confidence, Method
from rosprivacy.analysis.suggesting.packages import Interface
from rosprivacy.ingest.known_packages.package_file import read_package
from rosprivacy.ontology.vocabulary import load

GOOD = """package: 1
name: face_blur
about: Blurs faces.
sources:
  - {at: https://example.org/face_blur, version: "2.1", read: 2026-11-23}
nodes:
  - names: [face_blur, face_blur_*]
    executables: [blur_node]
    subscribes: {image_raw: sensor_msgs/msg/Image, anything: null}
    publishes: {~/image: sensor_msgs/msg/Image}
    replies: {~/reset: std_srvs/srv/Empty}
    says:
      - sanitizer: {FaceImage: anonymise}
        why: it blurs each face that it finds
      - leak: [Video]
        to: file
        confidence: may
        why: it keeps pictures without faces if debug is set
      - derives: [{from: Video, to: Presence}, {from: Video, to: PersonDetection}]
        why: it counts faces
      - conduit: all
        why: it passes everything else on
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def problems(text: str) -> list[str]:
    Path("p.yaml").write_text(text, "utf-8")
    with pytest.raises(InputErrors) as refused:
        read_package("p.yaml", load())
    return str(refused.value).splitlines()


def test_a_file_says_what_its_nodes_do() -> None:
    Path("p.yaml").write_text(GOOD, "utf-8")
    package = read_package("p.yaml", load())
    assert (package.name, package.version) == ("face_blur", "2.1")
    assert package.sha256 == hashlib.sha256(Path("p.yaml").read_bytes()).hexdigest()
    (node,) = package.nodes
    assert node.names == ("face_blur", "face_blur_*", "blur_node")
    assert node.interfaces == (
        Interface("publishes", "~/image", "sensor_msgs/msg/Image"),
        Interface("subscribes", "image_raw", "sensor_msgs/msg/Image"),
        Interface("subscribes", "anything"),
        Interface("replies", "~/reset", "std_srvs/srv/Empty"),
    )
    said = [(c.role, c.kind, c.to, c.method, c.where, c.confidence, c.place.line) for c in node.claims]
    likely, may = Confidence.LIKELY, Confidence.MAY
    assert said == [
        ("sanitizer", "FaceImage", "", Method.ANONYMISE, "", likely, 13),
        ("leak", "Video", "", None, "file", may, 15),
        ("derivation", "Video", "Presence", None, "", likely, 19),
        ("derivation", "Video", "PersonDetection", None, "", likely, 19),
        ("conduit", "", "", None, "", likely, 21),
    ]


SCANNED = GOOD.replace(
    "    says:",
    """    components: ["face_blur::Blur"]
    further: {publishes: {~/faces: null, ../mask: sensor_msgs/msg/Image}}
    parameters: {image_topic: image_raw, "in?.topic": {subscribes: {"*": sensor_msgs/msg/Image}}}
    rest: the formats of its pictures
    makes: [inner/face_blur]
    says:""",
).replace("about: Blurs faces.", "about: Blurs faces.\npackages: [face_blur_ros]")


def test_a_file_says_what_a_scan_needs_of_a_node_whose_code_is_not_there() -> None:
    Path("p.yaml").write_text(SCANNED, "utf-8")
    package = read_package("p.yaml", load())
    (node,) = package.nodes
    assert package.packages == ("face_blur_ros",)
    assert [(one.name, one.parameter) for one in node.interfaces if one.parameter] == [("image_raw", "image_topic")]
    assert node.further == (
        Interface("publishes", "~/faces"),
        Interface("publishes", "../mask", "sensor_msgs/msg/Image"),
        Interface("subscribes", "*", "sensor_msgs/msg/Image", "in?.topic"),
    )
    assert (node.rest, node.makes) == ("the formats of its pictures", ("inner/face_blur",))
    assert node.components == ("face_blur::Blur",)
    assert "face_blur::Blur" not in node.names  # no node of a graph is called so


def test_all_problems_are_told_at_their_lines() -> None:
    text = GOOD.replace("face_blur, face_blur_*", "/ns/face_blur").replace("FaceImage: anonymise", "FaceImage: hide")
    text = text.replace("image_raw: sensor_msgs/msg/Image", "image_raw: std_srvs/srv/Empty")
    text = text.replace("to: file", "to: cloud").replace("confidence: may", "confidence: certain")
    text = text.replace("to: Presence", "to: Presense").replace(
        "- conduit: all", "- conduit: all\n        source: [Video]"
    )
    text = text.replace('version: "2.1", ', "").replace("about: Blurs faces.", "about: Blurs faces.\nowner: me")
    expected = {
        4: "unknown key 'owner'", 6: "does not say where, when and which version", 8: "'/ns/face_blur'",
        10: "'std_srvs/srv/Empty' is not the type of a topic", 14: "method 'hide'", 17: "to 'cloud'",
        18: "confidence 'certain'", 20: "unknown category 'Presense'", 22: "not of one role, with its reason",
    }  # fmt: skip
    lines = problems(text)
    assert [line.partition(": ")[0] for line in lines] == [f"p.yaml:{at}" for at in expected]
    assert all(words in line for line, words in zip(lines, expected.values(), strict=True))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "p.yaml:1: the file is empty"),
        ("[]", "p.yaml:1: a file of a package is a map"),
        ("x: 1", "p.yaml:1: no 'package: 1'"),
        ("labels: 1", "p.yaml:1: this is a label file"),
        ("package: 2", "p.yaml:1: package format '2'"),
        ("package: 1", "p.yaml:1: no 'about'"),
        (GOOD.replace("[face_blur, face_blur_*]", "[]"), "p.yaml:7: names is empty"),
        (GOOD.replace("about: Blurs faces.", "about: |\n  two\n  lines"), "p.yaml:3: about takes one line"),
        (GOOD.replace("why: it counts faces", "note: x"), "p.yaml:20: unknown key 'note'"),
        (GOOD.replace("        to: file\n", ""), "p.yaml:15: to belongs to a leak"),
        (GOOD.replace("{FaceImage: anonymise}", "[FaceImage]"), "p.yaml:13: a sanitizer states its method"),
        (GOOD.replace("{from: Video, to: Presence}", "{from: Video}"), "p.yaml:19: a derivation without from or to"),
        (GOOD.replace("sources:\n  - {", "sources: []\nx:\n  - {"), "p.yaml:4: sources is empty"),
        (SCANNED.replace("image_topic: image_raw", "image_topic: nope"), "p.yaml:15: 'nope' is no channel of the node"),
        (SCANNED.replace("image_topic: image", "image topic: image"), "p.yaml:15: 'image topic' is not the name of a"),
        (SCANNED.replace("inner/face_blur", "inner/mask"), "p.yaml:8: inner/mask is made and not described"),
        (SCANNED.replace("face_blur::Blur", "face blur"), "p.yaml:13: a component cannot be 'face blur'"),
        (SCANNED.replace("further: {publishes", "further: {shows"), "p.yaml:14: unknown key 'shows'"),
    ],
)
def test_what_is_wrong_is_refused(text: str, told: str) -> None:
    assert [line for line in problems(text) if line.startswith(told)]


def test_hostile_text_stays_on_one_line() -> None:
    told = problems(GOOD.replace("name: face_blur", 'name: "a\\e[31m\\nb"'))
    assert len(told) == 1
    assert told[0].isprintable()


def test_the_schema_takes_what_the_reader_takes_and_refuses_the_rest() -> None:
    schema = json.loads(
        files("rosprivacy.ingest.known_packages").joinpath("package_file.schema.json").read_text("utf-8")
    )
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for text in (SCANNED, GOOD):
        good = yaml.load(text.replace("anything: null", "anything: "), yaml.BaseLoader)  # noqa: S506 - plain values only
        good |= {"package": 1}
        good["nodes"][0]["subscribes"]["anything"] = None
        good["nodes"][0].get("further", {}).get("publishes", {}).update({"~/faces": None})
        validator.validate(good)
    for key in ("name", "about", "sources", "nodes"):
        assert not validator.is_valid({name: value for name, value in good.items() if name != key})
    claims = [{"conduit": "all"}, {"leak": ["Video"], "why": "x"}, {"source": ["Video"], "conduit": "all", "why": "x"}]
    for claim in (*claims, {"source": ["Video"], "confidence": "certain", "why": "x"}, {"mundane": "all", "why": "x"}):
        wrong = good | {"nodes": [good["nodes"][0] | {"says": [claim]}]}
        assert not validator.is_valid(wrong), claim
