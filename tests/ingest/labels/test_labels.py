"""Label files: every way to say something, the files that come with the program, whom data are about."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

import pytest
import yaml

import rosprivacy
from rosprivacy.ingest.labels.entries import SECTIONS
from rosprivacy.ingest.labels.label_file import STANDARD, read_labels, shipped_text
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

from tests.helpers.label_files import SYSTEM, read, told, validator


def valid(text: str) -> bool:
    return bool(validator().is_valid(yaml.safe_load(text)))


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("{source: [Video]}", ["source Video"]),
        ("{source: [Video, Voice]}", ["source Video", "source Voice"]),
        ("{source: {Video: [/image]}}", ["source Video through /image"]),  # only through these channels
        ("{source: {Video: [/b, /a*], Voice: [/c]}}", ["source Video through /a* /b", "source Voice through /c"]),
        ("{derives: [{from: Video, to: FaceTemplate}]}", ["derivation Video to FaceTemplate"]),
        ("{sanitizer: {Video: anonymise}}", ["sanitizer Video by anonymise"]),  # S8: it states its method
        ("{sanitizer: {Video: aggregate, Voice: drop}}", ["sanitizer Video by aggregate", "sanitizer Voice by drop"]),
        ("{sanitizer: {Video: pseudonymise}}", ["sanitizer Video by pseudonymise"]),
        ("{sanitizer: [Video]}", ["sanitizer Video by pseudonymise?"]),  # S8: not stated counts as pseudonymise
        ("{sanitizer: {Video: }}", ["sanitizer Video by pseudonymise?"]),
        (
            "{leak: [Voice], sanitizer: {Video: drop}, note: why}",
            ["leak Voice", "sanitizer Video by drop"],
        ),  # a note says nothing to the program
        ("conduit", ["conduit"]),  # reviewed, for every category
        ("{conduit: [Location]}", ["conduit Location"]),  # reviewed for this one
        ("{note: nothing known}", []),
        ("", []),  # a line of --init that nobody has filled in
        ("{}", []),
    ],
)
def test_a_node_may_say(tmp_path: Path, written: str, said: list[str]) -> None:
    text = f"labels: 1\nnodes:\n  /a: {written}\n"
    assert told(read(tmp_path, text)) == [f"node /a: {line}" for line in said]
    assert valid(text)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("mundane", ["mundane"]),
        ("sensitive", ["sensitive"]),  # reviewed
        ("{only: [HomeMap]}", ["only HomeMap"]),  # carries these at most
        ("{only: [HomeMap, Video]}", ["only HomeMap Video"]),
        ("{never: [Location]}", ["never Location"]),
        ("{only: [Video], never: [Voice], note: why}", ["only Video", "never Voice"]),
        ("{note: nothing known}", []),
        ("", []),
    ],
)
def test_a_channel_may_say(tmp_path: Path, written: str, said: list[str]) -> None:
    for section, kinds in SECTIONS.items():
        text = f"labels: 1\n{section}:\n  /a: {written}\n"
        if section != "nodes":  # the section says whether it is a node or a channel
            assert told(read(tmp_path, text)) == [f"{'/'.join(kinds)} /a: {line}" for line in said]
            assert valid(text)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("{from: /nav, to: /plan, never: [Video]}", ["/nav -> /plan: never Video"]),
        ("{from: /nav, to: /plan, only: [Video], note: x}", ["/nav -> /plan: only Video"]),
        ("{from: '*', to: '/p*', only: [Video], never: [Voice]}", ["* -> /p*: only Video", "* -> /p*: never Voice"]),
    ],
)
def test_a_flow_may_say(tmp_path: Path, written: str, said: list[str]) -> None:
    text = f"labels: 1\nflows:\n  - {written}\n"
    assert told(read(tmp_path, text)) == said
    assert valid(text)


@pytest.mark.parametrize(
    "name", ["/a", "/", "/a/b", "'*'", "'*/rosout'", "'?a'", "'[a-z]*'", "/a b", "/é", "'/\U0001f600'"]
)
def test_a_name_may_be_absolute_or_a_glob(tmp_path: Path, name: str) -> None:
    text = f"labels: 1\nnodes: {{{name}: conduit}}"
    (entry,) = read(tmp_path, text).entries
    assert entry.name == name.strip("'")
    assert valid(text)


@pytest.mark.parametrize("name", ["Video", "video", "urn:x-rosprivacy:Video", "video of persons", "camera stream"])
def test_a_category_may_be_named_as_people_know_it(tmp_path: Path, name: str) -> None:
    text = f"labels: 1\nnodes: {{/a: {{leak: ['{name}']}}}}"
    assert told(read(tmp_path, text)) == ["node /a: leak Video"]
    assert valid(text)


@pytest.mark.parametrize(
    "text",
    [
        "labels: 1",
        "{labels: 1}",
        '{"labels": 1, "nodes": {"/a": "conduit"}}',
        "labels: 1\nnodes:\nchannels:\ntopics:\nservices:\nactions:\n",  # sections of --init, emptied
        "labels: 1\nflows:\n",
        "labels: 1\nflows: []\n",
        "# yaml-language-server: $schema=labels.schema.json\n---\nlabels: 1\n...\n",
    ],
)
def test_a_file_may_say_little(tmp_path: Path, text: str) -> None:
    read(tmp_path, text)
    assert valid(text)


def test_every_statement_knows_its_line(tmp_path: Path) -> None:
    text = """labels: 1
nodes:
  /a:
    source: [Video]
    leak:
      - Voice
  /b: conduit
flows:
  - from: /a
    to: /b
    never: [Video]
"""
    labels = read(tmp_path, text)
    assert [s.place.line for entry in labels.entries for s in entry.statements] == [4, 5, 7]
    assert [entry.place.line for entry in labels.entries] == [3, 7]
    assert [(flow.place.line, flow.statements[0].place.line) for flow in labels.flows] == [(9, 11)]


def test_json_says_the_same_as_yaml(tmp_path: Path) -> None:
    text = "labels: 1\nnodes: {/a: {source: {Video: [/b]}, sanitizer: {Voice: drop}}}\nchannels: {/b: {only: [Video]}}"
    as_json = json.dumps(yaml.safe_load(text), indent="\t")
    assert told(read(tmp_path, as_json, "l.json")) == told(read(tmp_path, text))


def test_json_may_write_a_character_as_a_surrogate_pair(tmp_path: Path) -> None:
    text = json.dumps({"labels": 1, "nodes": {"/\U0001f600": "conduit"}})
    assert "\\ud83d\\ude00" in text
    assert told(read(tmp_path, text)) == ["node /\U0001f600: conduit"]


def test_the_bytes_that_were_read_are_known_by_their_hash(tmp_path: Path) -> None:  # S12: label files with their hashes
    labels = read(tmp_path, "labels: 1\n# é\n")
    assert labels.sha256 == hashlib.sha256((tmp_path / "l.yaml").read_bytes()).hexdigest()


@pytest.mark.parametrize("name", ["standard", "infrastructure"])
def test_a_shipped_file_is_a_valid_label_file_of_lower_rank(tmp_path: Path, name: str) -> None:
    labels = read_labels(f"rosprivacy:{name}", load())
    assert labels.shipped
    assert labels.file == f"rosprivacy:{name}"
    assert {statement.role for entry in labels.entries for statement in entry.statements} == {"mundane"}
    tiers = {statement.rank[0] for entry in labels.entries for statement in entry.statements}
    assert tiers == {0 if name == "standard" else -1}  # S13: the proposal yields to every label of a user
    assert valid(shipped_text(name))
    assert not read(tmp_path, shipped_text(name)).shipped  # a copy is the user's own


def test_the_standard_channels_are_these_and_nothing_else() -> None:  # S13
    labels = read_labels(STANDARD, load())
    names = {(entry.kinds, entry.name.removeprefix("*/")) for entry in labels.entries}
    services = ("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters", "set_parameters",
                "set_parameters_atomically", "get_type_description")  # fmt: skip
    topics = ("rosout", "parameter_events", "clock")
    assert names == {(("service",), name) for name in services} | {(("topic",), name) for name in topics}


def test_the_proposal_leaves_tf_and_diagnostics_to_a_person() -> None:  # S13
    labels = read_labels("rosprivacy:infrastructure", load())
    assert not {"*/tf", "*/diagnostics"} & {entry.name for entry in labels.entries}


def test_a_users_file_may_stand_in_for_a_shipped_one(tmp_path: Path) -> None:
    assert read(tmp_path, "labels: 1\ntopics: {'*/x': mundane}", shipped=True).shipped


def test_a_source_may_say_whom_its_data_are_about(tmp_path: Path) -> None:
    text = "labels: 1\nnodes:\n  /a: {source: [Video], subjects: [visitors, ' staff ', staff]}\n  /b: conduit\n"
    assert [entry.subjects for entry in read(tmp_path, text).entries] == [("staff", "visitors"), ()]


def test_a_file_may_say_it_for_another_files_source_and_for_many_at_once(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(SYSTEM)
    (tmp_path / "a.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video], subjects: [staff]}}\n")
    (tmp_path / "b.yaml").write_text("labels: 1\nnodes: {'/cam*': {subjects: [visitors]}}\n")
    result = rosprivacy.analyze([str(tmp_path / "p.xml")], [str(tmp_path / "a.yaml"), str(tmp_path / "b.yaml")])
    camera = {"robot": "", "kind": "node", "name": "/camera"}
    assert result.document()["subjects"] == [{"element": camera, "subjects": ["staff", "visitors"]}]
