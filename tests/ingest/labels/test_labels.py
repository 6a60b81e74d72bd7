"""The label reader: the format of the design, each key; what it refuses; what labels mean beside each other.

Rows cite the rule (S7 to S13) or the sentence of the design's chapter on the label file.
"""

from __future__ import annotations

import copy
import hashlib
import json
import re
import subprocess
import sys
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from jsonschema import Draft202012Validator

import rosprivacy
from rosprivacy.analysis.errors import InputErrors, LabelError
from rosprivacy.ingest.labels.entries import specificity
from rosprivacy.ingest.labels.label_file import STANDARD, Labels, read_labels, shipped_text
from rosprivacy.ingest.labels.label_schema import label_schema
from rosprivacy.ontology.vocabulary import load
from tests.helpers.schema_places import places

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.model import Statement

LINE = re.compile(r".+:\d+: .+; .+")  # file:line: what is wrong; what to do

# /camera -> /image -> /filter -> /clean -> /viewer, and /viewer calls /snap and /spin of /camera
SYSTEM = """<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>
<profile ns="/" node="camera">
  <topics publish="ALLOW"><topic>image</topic><topic>/rosout</topic></topics>
  <services reply="ALLOW"><service>snap</service></services>
  <actions execute="ALLOW"><action>spin</action></actions>
</profile>
<profile ns="/" node="filter">
  <topics subscribe="ALLOW"><topic>image</topic></topics>
  <topics publish="ALLOW"><topic>clean</topic></topics>
</profile>
<profile ns="/" node="viewer">
  <topics subscribe="ALLOW"><topic>clean</topic></topics>
  <services request="ALLOW"><service>snap</service></services>
  <actions call="ALLOW"><action>spin</action></actions>
</profile>
</profiles></enclave></enclaves></policy>
"""


@cache
def validator() -> Any:
    schema = label_schema(load().categories.values())
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def valid(text: str) -> bool:
    return bool(validator().is_valid(yaml.safe_load(text)))


def read(folder: Path, text: str, name: str = "l.yaml", **options: Any) -> Labels:
    (folder / name).write_text(text, encoding="utf-8")
    return read_labels(str(folder / name), load(), **options)


def problems(caught: pytest.ExceptionInfo[InputErrors], folder: Path) -> list[str]:
    """The messages, each one line of the format, without the folder."""
    lines = str(caught.value).split("\n")
    assert all(LINE.fullmatch(line) for line in lines)
    assert all(isinstance(error, LabelError) for error in caught.value.errors)
    return [line.replace(f"{folder}/", "") for line in lines]


def refused(folder: Path, text: str, **options: Any) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        read(folder, text, **options)
    return problems(caught, folder)


def told(labels: Labels) -> list[str]:
    """What a file says, one line for each statement."""
    lines = []
    for entry in labels.entries:
        lines += [f"{'/'.join(entry.kinds)} {entry.name}: {_said(statement)}" for statement in entry.statements]
    for flow in labels.flows:
        lines += [f"{flow.source} -> {flow.target}: {_said(statement)}" for statement in flow.statements]
    return lines


def _said(statement: Statement) -> str:
    words = [statement.role, *statement.categories]
    words += [f"by {statement.method}" + ("" if statement.stated else "?")] if statement.method else []
    words += [f"to {statement.to}"] if statement.to else []
    words += [f"through {' '.join(statement.through)}"] if statement.through else []
    return " ".join(words)


# ---------------------------------------------------------------- the format


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
@pytest.mark.parametrize(
    ("section", "kinds"),
    [
        ("channels", "topic/service/action"),  # the section says whether it is a node or a channel
        ("topics", "topic"),
        ("services", "service"),
        ("actions", "action"),
    ],
)
def test_a_channel_may_say(tmp_path: Path, section: str, kinds: str, written: str, said: list[str]) -> None:
    text = f"labels: 1\n{section}:\n  /a: {written}\n"
    assert told(read(tmp_path, text)) == [f"{kinds} /a: {line}" for line in said]
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


# ---------------------------------------------------------------- the paper's six lists


SIX = """{
	"source": ["/a"],
	"leak": ["/b"],
	"conduit": ["/c"],
	"sanitizer": ["/d"],
	"sensitive": ["/s"],
	"mundane": ["/m"]
}"""  # with tabs, as published


@pytest.mark.parametrize("category", ["PersonalData", "Video"])
def test_the_papers_six_lists_are_read(tmp_path: Path, category: str) -> None:
    labels = read(tmp_path, SIX, "l.json", category=category)
    assert told(labels) == [
        f"node /a: source {category}",
        f"node /b: leak {category}",
        f"node /c: conduit {category}",
        f"node /d: sanitizer {category} by anonymise",  # S8: there a bare sanitizer ends the category …
        f"topic/service/action /s: sensitive {category}",
        f"topic/service/action /m: mundane {category}",
    ]
    ((severity, line),) = [(str(d.severity), d.place.line) for d in labels.diagnostics]
    assert (severity, line) == ("notice", 5)  # … with a notice
    assert [entry.place.line for entry in labels.entries] == [2, 3, 4, 5, 6, 7]


@pytest.mark.parametrize(
    "text", ['{"source": ["/a"]}', "source: [/a]", '{"source": ["/a"], "leak": [], "mundane": null}']
)
def test_lists_that_are_missing_or_empty_say_nothing(tmp_path: Path, text: str) -> None:
    labels = read(tmp_path, text)
    assert told(labels) == ["node /a: source PersonalData"]
    assert labels.diagnostics == ()


def test_six_lists_are_about_personal_data_if_nothing_else_is_said(tmp_path: Path) -> None:
    assert told(read(tmp_path, '{"leak": ["/a"]}')) == ["node /a: leak PersonalData"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"source": ["/a"], "leeks": []}', "unknown key 'leeks'; did you mean 'leak'?"),
        ('{"source": ["/a"], "nodes": {}}', "unknown key 'nodes'"),
        ('{"source": "/a"}', "source takes a list, not a text"),
        ('{"source": {"/a": 1}}', "source takes a list, not a map"),
        ('{"source": ["a"]}', "'a' is not an absolute name; begin it with /"),
        ('{"source": [1]}', "'1' is not an absolute name"),
        ('{"source": [["/a"]]}', "'list' is not an absolute name"),
        ('{"source": [null]}', "is not an absolute name"),
    ],
)
def test_six_lists_are_checked(tmp_path: Path, text: str, message: str) -> None:
    (line,) = refused(tmp_path, text)
    assert line.startswith("l.yaml:1: ")
    assert message in line


def test_the_category_of_six_lists_has_to_exist(tmp_path: Path) -> None:
    (line,) = refused(tmp_path, SIX, category="Vidio")
    assert "unknown category 'Vidio'; did you mean Video" in line


def test_the_category_of_six_lists_has_no_effect_on_other_files(tmp_path: Path) -> None:
    assert told(read(tmp_path, "labels: 1\nnodes: {/a: conduit}", category="Vidio")) == ["node /a: conduit"]


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        ("nodes: {/a: conduit}", ["1: no 'labels: 1'; "]),
        ("labels: 2", ["1: label format '2'; this reads 'labels: 1'"]),
        ("labels: one", ["1: label format 'one'"]),
        ("labels: [1]", ["1: label format 'list'"]),
        ("labels:", ["1: label format"]),
        ("[labels, 1]", ["1: a label file is a map, not a list; begin with 'labels: 1'"]),
        ("labels", ["1: a label file is a map, not a text"]),
        ("5", ["1: a label file is a map, not a number"]),
        ("labels: 1\nnode: {}", ["2: unknown key 'node'; did you mean 'nodes'?"]),
        ("labels: 1\nrobots: {}", ["2: unknown key 'robots'; "]),
        ("labels: 1\nnodes: [/a]", ["2: nodes is a map from names to labels, not a list"]),
        ("labels: 1\nnodes: /a", ["2: nodes is a map from names to labels, not a text"]),
        ("labels: 1\nflows: {/a: /b}", ["2: flows takes a list, not a map"]),
        ("labels: 1\nnodes: {a: conduit}", ["2: name 'a' is not absolute; begin it with /"]),
        ("labels: 1\nnodes: {~: conduit}", ["2: name '~' is not absolute"]),
        ("labels: 1\nnodes: {~/a: conduit}", ["2: name '~/a' is not absolute"]),
        ("labels: 1\nnodes: {1: conduit}", ["2: name '1' is not absolute"]),
        ("labels: 1\nnodes: {'': conduit}", ["2: name '' is not absolute"]),
        ("labels: 1\nnodes: {/a: Conduit}", ["2: label 'Conduit' on a node; write conduit, or {source: [Video]}"]),
        ("labels: 1\nnodes: {/a: mundane}", ["2: label 'mundane' on a node"]),
        ("labels: 1\nnodes: {/a: [conduit]}", ["2: label 'list' on a node"]),
        ("labels: 1\nnodes: {/a: true}", ["2: label 'true' on a node"]),
        ("labels: 1\nnodes: {/a: {sauce: [Video]}}", ["2: unknown key 'sauce'; did you mean 'source'?"]),
        ("labels: 1\nnodes: {/a: {only: [Video]}}", ["2: unknown key 'only'; "]),
        ("labels: 1\nnodes: {/a: {mundane: [Video]}}", ["2: unknown key 'mundane'; "]),
        ("labels: 1\nnodes: {/a: {source: Video}}", ["2: source takes a list, not a text; write […]"]),
        ("labels: 1\nnodes: {/a: {source: }}", ["2: source names no category"]),
        ("labels: 1\nnodes: {/a: {source: []}}", ["2: source names no category"]),
        ("labels: 1\nnodes: {/a: {source: {}}}", ["2: source names no category"]),
        ("labels: 1\nnodes: {/a: {source: [1]}}", ["2: a number where a category is named"]),
        ("labels: 1\nnodes: {/a: {source: [[Video]]}}", ["2: a list where a category is named"]),
        ("labels: 1\nnodes: {/a: {source: {Video: }}}", ["2: source of Video names no channel"]),
        ("labels: 1\nnodes: {/a: {source: {Video: []}}}", ["2: source of Video names no channel"]),
        ("labels: 1\nnodes: {/a: {source: {Video: [image]}}}", ["2: 'image' is not an absolute name"]),
        ("labels: 1\nnodes: {/a: {leak: {Video: drop}}}", ["2: leak takes a list, not a map"]),
        ("labels: 1\nnodes: {/a: {leak: }}", ["2: leak names no category"]),
        ("labels: 1\nnodes: {/a: {conduit: []}}", ["2: conduit names no category"]),
        ("labels: 1\nnodes: {/a: {sanitizer: Video}}", ["2: sanitizer takes a list, not a text"]),
        ("labels: 1\nnodes: {/a: {sanitizer: {}}}", ["2: sanitizer names no category"]),
        (
            "labels: 1\nnodes: {/a: {sanitizer: {Video: blur}}}",
            ["2: sanitizer method 'blur'; one of anonymise, aggregate, drop, pseudonymise"],
        ),
        ("labels: 1\nnodes: {/a: {sanitizer: {Video: [drop]}}}", ["2: sanitizer method 'list'"]),
        ("labels: 1\nnodes: {/a: {derives: {from: Video, to: Voice}}}", ["2: derives takes a list, not a map"]),
        ("labels: 1\nnodes: {/a: {derives: }}", ["2: derives "]),
        ("labels: 1\nnodes: {/a: {derives: [Video]}}", ["2: a derivation is a map, not a text"]),
        ("labels: 1\nnodes: {/a: {derives: [{from: Video}]}}", ["2: a derivation needs from and to"]),
        ("labels: 1\nnodes: {/a: {derives: [{from: [Video], to: Voice}]}}", ["2: a list where a category is named"]),
        (
            "labels: 1\nnodes: {/a: {derives: [{from: Video, to: Voice, by: x}]}}",
            ["2: unknown key 'by'; one of from, to"],
        ),
        ("labels: 1\nnodes: {/a: {note: [why]}}", ["2: note "]),
        ("labels: 1\nchannels: {/a: {note: {why: x}}}", ["2: note "]),
        ("labels: 1\nchannels: {/a: conduit}", ["2: label 'conduit' on a channel; write mundane, sensitive"]),
        ("labels: 1\nchannels: {/a: [mundane]}", ["2: label 'list' on a channel"]),
        ("labels: 1\nchannels: {/a: {source: [Video]}}", ["2: unknown key 'source'; "]),
        ("labels: 1\nchannels: {/a: {only: Video}}", ["2: only takes a list, not a text"]),
        ("labels: 1\nchannels: {/a: {only: []}}", ["2: only names no category"]),
        ("labels: 1\nchannels: {/a: {never: }}", ["2: never names no category"]),
        ("labels: 1\nflows: [/a]", ["2: a flow is a map, not a text"]),
        ("labels: 1\nflows: [{from: /a, never: [Video]}]", ["2: a flow needs from and to"]),
        ("labels: 1\nflows: [{from: /a, to: /b}]", ["2: a flow between nodes and channels needs only or never"]),
        ("labels: 1\nflows: [{from: /a, to: /b, never: [Vidio]}]", ["2: unknown category 'Vidio'"]),
        ("labels: 1\nflows: [{from: /a, to: /b, never: [Video], via: /c}]", ["2: unknown key 'via'"]),
        ("labels: 1\nnodes:\n  /a: conduit\n  /a: conduit", ["4: '/a' again, first in line 3; merge the two"]),
        ("labels: 1\nnodes: {/a: &x {leak: [Video]}, /b: *x}", ["2: anchors and aliases are not read"]),
        ("", ["1: the file is empty; "]),
    ],
)
def test_what_is_wrong_is_said_at_its_line(tmp_path: Path, text: str, messages: list[str]) -> None:
    found = refused(tmp_path, text)
    assert len(found) == len(messages)
    for line, message in zip(found, messages, strict=True):
        assert line.startswith(f"l.yaml:{message}")


@pytest.mark.parametrize(
    ("written", "near"),
    [
        ("Vidio", "Video"),
        ("video streem", "Video"),
        ("Biometrik", "Biometric"),
        ("face", None),  # a synonym is a name
        ("xyz", "rosprivacy categories lists all of them"),  # nothing near
    ],
)
def test_an_unknown_category_is_refused_with_the_nearest_names(tmp_path: Path, written: str, near: str | None) -> None:
    text = f"labels: 1\nnodes:\n  /a:\n    leak:\n      - {written}"
    if near is None:
        read(tmp_path, text)
        return
    (line,) = refused(tmp_path, text)
    assert line.startswith(f"l.yaml:5: unknown category '{written}'; ")
    assert near in line


def test_every_problem_of_a_file_is_reported_at_once(tmp_path: Path) -> None:
    text = """labels: 2
node: {}
nodes:
  a: conduit
  /b: {source: [Vidio], leak: Voice}
channels:
  /c: safe
flows:
  - {from: /a}
"""
    assert [line.split(": ")[0] for line in refused(tmp_path, text)] == [
        f"l.yaml:{line}" for line in (1, 2, 4, 5, 5, 7, 9)
    ]


def test_a_message_is_one_line_whatever_the_file_says(tmp_path: Path) -> None:
    evil = json.dumps("a\nl.yaml:1: fake; error\x85\u2028" + "x" * 800)
    found = refused(tmp_path, f"labels: 1\nnodes:\n  {evil}: conduit\n  /a: {{leak: [{evil}]}}\n{evil}: 1")
    assert len(found) == 3
    assert all(len(line) < 500 for line in found)


def test_a_file_that_is_not_utf8_is_refused(tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_bytes("labels: 1\nnodes: {/caf\xe9: conduit}".encode("latin-1"))
    with pytest.raises(InputErrors) as caught:
        read_labels(str(tmp_path / "l.yaml"), load())
    assert problems(caught, tmp_path) == ["l.yaml:2: not UTF-8; save the file as UTF-8"]


@pytest.mark.parametrize("file", ["none.yaml", "rosprivacy:none", "rosprivacy:../labels", "rosprivacy:/etc/passwd", ""])
def test_a_file_that_is_not_there_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputErrors) as caught:
        read_labels(file, load())
    assert ": " in problems(caught, tmp_path)[0]


# ---------------------------------------------------------------- the schema


FULL: dict[str, Any] = {
    "labels": 1,
    "nodes": {
        "/a": "conduit",
        "/b": {"source": ["Video"], "leak": ["Voice"], "conduit": ["Location"], "subjects": ["staff"], "note": "x"},
        "/c": {"source": {"Video": ["/t"]}, "sanitizer": {"Voice": "drop", "Health": None}},
        "/d": {"sanitizer": ["Video"], "derives": [{"from": "Video", "to": "FaceTemplate"}]},
        "/e": None,
    },
    "channels": {"/t": "mundane", "/u": {"only": ["Video"], "never": ["Voice"], "note": "x"}, "/v": None},
    "topics": {"/t": "sensitive"},
    "services": {"*": {"never": ["Video"]}},
    "actions": {},
    "limits": {"Video": "P30D"},
    "elements": {
        "bucket": {
            "kind": "storage", "retention": "P30D", "backups": "P7D", "encrypted": True, "country": "DE",
            "operator": "x", "recipient": "processor", "transfer": "adequacy", "conduit": ["Video"], "note": "x",
        },
        "disk": {"kind": "storage", "retention": {"Video": "P1Y"}, "backups": False, "leak": ["Voice"]},
        "ring": {"kind": "shared-memory", "between": ["/a", "/b"]},
        "cloud": {"kind": "external-system", "sanitizer": {"Video": "drop"}},
        "microphone": {"kind": "device", "source": ["Voice"]},
    },
    "flows": [
        {"from": "/a", "to": "/b", "only": ["Video"], "never": ["Voice"], "note": "x"},
        {"from": "/a", "to": "bucket"},
    ],
}  # fmt: skip
OTHERS: tuple[Any, ...] = (
    None, 0, 1, 2, 1.5, True, "", "1", "x", "Video", "/x", "conduit", "mundane", "drop", [], {}, [None], [1], [[]],
    [{}], ["Video"], ["/x"], {"Video": None}, {"Video": ["/x"]}, {"Video": "drop"}, {"Video": []}, {"/x": None},
    {"/x": "conduit"}, {"/x": "mundane"}, {"x": 1}, {"from": "Video", "to": "Voice"},
    [{"from": "Video", "to": "Voice"}], {"from": "/a", "to": "/b", "only": ["Video"]}, {"only": ["Video"]},
    {"leak": ["Video"]}, {"leak": []}, {"note": "x"},
)  # fmt: skip


def changed(way: tuple[Any, ...], other: Any) -> Any:
    """``FULL`` with another value at one place."""
    document = copy.deepcopy(FULL)
    inside: Any = document
    for key in way[:-1]:
        inside = inside[key]
    inside[way[-1]] = other
    return document


def test_the_schema_accepts_what_uses_every_key(tmp_path: Path) -> None:
    assert len(told(read(tmp_path, json.dumps(FULL)))) == 20
    assert validator().is_valid(FULL)


# What no schema says: it takes every word as a category, since synonyms are many, and compares no two lists.
BEYOND = ("unknown category", "is under only and under never")


@pytest.mark.slow
@pytest.mark.parametrize("way", list(places(FULL)), ids=lambda way: ".".join(map(str, way)))
def test_the_reader_and_the_schema_agree_on_a_wrong_type_anywhere(tmp_path: Path, way: tuple[Any, ...]) -> None:
    for other in OTHERS:
        document = changed(way, other)
        shown = f"{'.'.join(map(str, way))} = {json.dumps(other)}"
        try:
            read(tmp_path, json.dumps(document))
            unknown = accepted = True
        except InputErrors as error:
            accepted = False
            unknown = all(any(word in problem.problem for word in BEYOND) for problem in error.errors)
        if accepted:
            assert validator().is_valid(document), f"read, but not valid: {shown}"
        elif not unknown:
            assert not validator().is_valid(document), f"valid, but not read: {shown}"


@pytest.mark.parametrize("key", ["labels", "nodes", "channels", "topics", "services", "actions", "limits", "flows"])
def test_only_the_version_is_required(tmp_path: Path, key: str) -> None:
    document = {name: value for name, value in FULL.items() if name != key}
    assert validator().is_valid(document) == (key != "labels")
    if key != "labels":
        read(tmp_path, json.dumps(document))


def test_the_schema_offers_every_category_with_its_definition() -> None:
    offered = json.dumps(validator().schema)
    for category in load().categories.values():
        assert json.dumps(category.name) in offered
        assert json.dumps(category.definition) in offered


# ---------------------------------------------------------------- the files that come with the program


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


# ---------------------------------------------------------------- labels and a system


def analyse(folder: Path, *texts: str, **options: Any) -> Any:
    """Analyse the system under label files 1.yaml, 2.yaml, …"""
    (folder / "p.xml").write_text(SYSTEM)
    files = []
    for number, text in enumerate(texts, 1):
        (folder / f"{number}.yaml").write_text(text)
        files.append(str(folder / f"{number}.yaml"))
    return rosprivacy.analyze([str(folder / "p.xml")], files, **options).analysis


def wrong(folder: Path, *texts: str, **options: Any) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        analyse(folder, *texts, **options)
    return problems(caught, folder)


def roles(analysis: Any, name: str, category: str = "Video") -> set[str]:
    """The roles that hold of an element, its legs put together."""
    return {role for element, said in analysis.roles.items() if element.name == name for role in said.get(category, ())}


@pytest.mark.parametrize(
    ("section", "name", "message"),
    [
        ("nodes", "/camara", "matches no node of the policies; did you mean /camera?"),
        ("nodes", "/Camera", "did you mean /camera?"),
        ("nodes", "/cam", "did you mean /camera?"),
        ("nodes", "/camara*", "did you mean /camera?"),
        ("nodes", "/qqqqqqqqqqqqq", "see the names with rosprivacy labels --init"),
        ("channels", "/imaeg", "matches no topic or service or action of the policies; did you mean /image"),
        ("topics", "/claen", "matches no topic of the policies; did you mean /clean"),
        # a name in the wrong section: say which is the right one
        ("nodes", "/image", "there is a topic of that name: move it to the section for it"),
        ("nodes", "/snap", "there is a service of that name"),
        ("channels", "/camera", "there is a node of that name"),
        ("topics", "/snap", "there is a service of that name"),
        ("services", "/spin", "action of that name: move it"),
    ],
)
def test_a_name_that_matches_nothing_is_refused_with_the_nearest(
    tmp_path: Path, section: str, name: str, message: str
) -> None:  # S11: never silence
    (line,) = wrong(tmp_path, f"labels: 1\n{section}:\n  {json.dumps(name)}:\n")
    assert line.startswith(f"1.yaml:3: {name!r} ")
    assert message in line


@pytest.mark.parametrize(
    ("flow", "message"),
    [
        ("from: /camera, to: /clean", "no flow goes from '/camera' to '/clean'"),
        ("from: /image, to: /camera", "no flow goes from '/image' to '/camera'"),  # in its direction
        ("from: /camara, to: /image", "/camera"),  # S11: with the nearest existing names
        ("from: /camera, to: /imaeg", "/image"),
    ],
)
def test_a_flow_that_is_not_there_is_refused_with_the_nearest(tmp_path: Path, flow: str, message: str) -> None:
    (line,) = wrong(tmp_path, f"labels: 1\nflows:\n  - {{{flow}, never: [Video]}}")
    assert line.startswith("1.yaml:3: ")
    assert message in line


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ("[/imaeg]", "'/camera' writes to no channel '/imaeg'; did you mean /image"),
        ("[/image, /clean]", "'/camera' writes to no channel '/clean'"),
        ("['/x*']", "'/camera' writes to no channel '/x*'"),
    ],
)
def test_a_source_through_a_channel_that_it_does_not_write_is_refused(
    tmp_path: Path, channels: str, message: str
) -> None:
    (line,) = wrong(tmp_path, f"labels: 1\nnodes:\n  /camera: {{source: {{Video: {channels}}}}}")
    assert line.startswith(f"1.yaml:3: {message}")


def test_problems_of_all_label_files_are_reported_at_once(tmp_path: Path) -> None:
    found = wrong(tmp_path, "labels: 1\nnodes: {/x: conduit, /y: conduit}", "labels: 1\n\nnodes: {/z: conduit}")
    assert [line.split(": ")[0] for line in found] == ["1.yaml:2", "1.yaml:2", "2.yaml:3"]
    found = wrong(tmp_path, "labels: 2", "labels: 3")
    assert [line.split(": ")[0] for line in found] == ["1.yaml:1", "2.yaml:1"]


def test_a_shipped_file_may_name_what_is_not_there(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("labels: 1\ntopics: {/none: mundane}")
    analyse(tmp_path, standard_channels=str(tmp_path / "s.yaml"))
    assert "matches no topic" in wrong(tmp_path, (tmp_path / "s.yaml").read_text())[0]


def test_a_label_file_of_another_system_is_refused_soon(tmp_path: Path) -> None:
    names = range(1500)
    profiles = "".join(f'<profile ns="/robot_{i:04}" node="camera_driver"/>' for i in names)
    enclave = f'<enclave path="/e"><profiles>{profiles}</profiles></enclave>'
    (tmp_path / "p.xml").write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>')
    lines = "".join(f"  /robt_{i:04}/camera_drver: conduit\n" for i in names)
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes:\n{lines}")
    command = [sys.executable, "-m", "rosprivacy", "analyze", "p.xml", "--labels", "l.yaml"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=30, check=False)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == len(names)


# ---------------------------------------------------------------- ranks


VIDEO = "labels: 1\nnodes: {/camera: {source: [Video]}}"


@pytest.mark.parametrize(
    ("labels", "role"),
    [
        (["nodes: {'*': conduit, /filter: {leak: [Video]}}"], "leak"),  # a specific name beats a glob
        (["nodes: {/filter: {leak: [Video]}}", "nodes: {'*': conduit}"], "leak"),  # in whatever file and order
        (["nodes: {'*': conduit}", "nodes: {/filter: {leak: [Video]}}"], "leak"),
        (["nodes: {'*': conduit, '/fil*': {leak: [Video]}}"], "leak"),  # the more that is spelt out
        (["nodes: {'/fil*': conduit, '*': {leak: [Video]}}"], "conduit"),
        (["nodes: {/filter: {leak: [PersonalData], conduit: [Video]}}"], "conduit"),  # S7: the nearest wins
        (["nodes: {/filter: {leak: [Video], conduit: [PersonalData]}}"], "leak"),
    ],
)
def test_the_higher_rank_wins(tmp_path: Path, labels: list[str], role: str) -> None:
    texts = [f"labels: 1\n{text}" for text in labels]
    source = "labels: 1\nnodes: {/camera: {source: [Video]}}"
    assert roles(analyse(tmp_path, source, *texts), "/filter") == {role}


@pytest.mark.parametrize(
    ("name", "role"), [("/rosout", "sensitive"), ("*/rosout", "sensitive"), ("*", "mundane"), ("/ros*", "mundane")]
)
def test_a_users_full_name_outranks_the_standard_file_and_so_does_a_glob_with_its_end_written_out(
    tmp_path: Path, name: str, role: str
) -> None:  # S13
    assert roles(analyse(tmp_path, VIDEO), "/rosout") == {"mundane"}
    assert roles(analyse(tmp_path, f"{VIDEO}\ntopics: {{'{name}': sensitive}}"), "/rosout") == {role}


def test_a_shipped_file_that_a_user_names_does_not_outrank_his_own(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(SYSTEM.replace("clean", "tf_static"))
    (tmp_path / "l.yaml").write_text(f"{VIDEO}\ntopics: {{'/*': sensitive}}")
    for files in (["l.yaml", "rosprivacy:infrastructure"], ["rosprivacy:infrastructure", "l.yaml"]):
        paths = [str(tmp_path / file) if file == "l.yaml" else file for file in files]
        result = rosprivacy.analyze([str(tmp_path / "p.xml")], paths)
        assert roles(result.analysis, "/tf_static") == {"sensitive"}


def test_a_name_outranks_every_glob() -> None:
    assert specificity("/a") > specificity("/" + "a" * 5000 + "*")


@pytest.mark.parametrize("glob", ["/[a-zA-Z0-9_]*", "/[!x]*", "/[abcdefghijk]*"])
def test_a_bracket_is_one_character_however_long_it_is_written(glob: str) -> None:  # it covers more, not less
    assert specificity(glob) < specificity("/cam*")


# ---------------------------------------------------------------- contradictions


@pytest.mark.parametrize(
    ("labels", "places"),
    [
        # in two files
        (["nodes:\n  /filter: {leak: [Video]}", "\nnodes:\n  /filter: {conduit: [Video]}"], ("1.yaml:3", "2.yaml:4")),
        # in one file, by globs of the same rank
        (["nodes:\n  '/fil*': {leak: [Video]}\n  '*lter': {conduit: [Video]}"], ("1.yaml:3", "1.yaml:4")),
        # S10: source and sanitizer of one category
        (["nodes:\n  /filter:\n    source: [Video]\n    sanitizer: {Video: drop}"], ("1.yaml:4", "1.yaml:5")),
        (["nodes:\n  /filter:\n    source: [Video]\n    conduit: [Video]"], ("1.yaml:4", "1.yaml:5")),
        (["nodes:\n  /filter:\n    sanitizer: [Video]\n    conduit: [Video]"], ("1.yaml:4", "1.yaml:5")),
        # one sanitizer, two methods
        (
            ["nodes:\n  /filter: {sanitizer: {Video: drop}}", "nodes:\n  /filter: {sanitizer: {Video: anonymise}}"],
            ("1.yaml:3", "2.yaml:3"),
        ),
        (
            ["nodes:\n  /filter: {sanitizer: {Video: drop}}", "nodes:\n  /filter: {sanitizer: [Video]}"],
            ("1.yaml:3", "2.yaml:3"),
        ),
        # one source, through one channel and through all
        (
            ["nodes:\n  /filter: {source: {Video: [/clean]}}", "nodes:\n  /filter: {source: [Video]}"],
            ("1.yaml:3", "2.yaml:3"),
        ),
        (["channels:\n  /image: {only: [Video]}", "channels:\n  /image: {only: [Voice]}"], ("1.yaml:3", "2.yaml:3")),
        (
            [
                "flows:\n  - {from: /camera, to: /image, only: [Video]}",
                "flows:\n  - {from: /camera, to: /image, only: [Voice]}",
            ],
            ("1.yaml:3", "2.yaml:3"),
        ),
    ],
)
def test_labels_of_one_rank_that_contradict_each_other_are_refused_with_both_lines(
    tmp_path: Path, labels: list[str], places: tuple[str, str]
) -> None:
    found = wrong(tmp_path, *[f"labels: 1\n{text}" for text in labels], VIDEO)
    about_video = [line for line in found if "Video" in line]
    assert about_video
    for line in about_video:
        assert line.startswith(f"{places[1]}: ")
        assert f" at {places[0]}; " in line


@pytest.mark.parametrize(
    "labels",
    [
        ["channels:\n  /image: mundane", "channels:\n  /image: sensitive"],
        ["channels:\n  /image: mundane\ntopics:\n  /image: sensitive"],
        ["channels:\n  /image: mundane", "channels:\n  /image: {only: [Video]}"],
    ],
)
def test_a_contradiction_about_every_category_is_one_problem(tmp_path: Path, labels: list[str]) -> None:
    (line,) = wrong(tmp_path, *[f"labels: 1\n{text}" for text in labels])
    first, second = ("1.yaml:3", "2.yaml:3") if len(labels) > 1 else ("1.yaml:3", "1.yaml:5")
    assert line.startswith(f"{second}: ")
    assert f" at {first}; " in line


@pytest.mark.parametrize(
    "labels",
    [
        ["nodes: {/filter: {leak: [Video]}}", "nodes: {/filter: {leak: [Video]}}"],  # the same twice
        ["nodes: {/filter: {source: [Video], leak: [Video]}}"],  # S10: a finding by itself, not a contradiction
        ["nodes: {/filter: {leak: [Video], sanitizer: {Video: drop}}}"],  # lets it out, but passes nothing on
        ["nodes: {/filter: {leak: [Video], conduit: [Voice]}}"],
        ["channels: {/image: {only: [Video], never: [Voice]}}"],
        ["nodes: {/filter: conduit}", "channels: {/clean: mundane}"],
        ["channels: {/image: sensitive, /clean: mundane}"],
        ["nodes: {/filter: conduit}", "nodes: {/filter: {leak: [Video]}}"],  # S7: the nearest in the hierarchy wins
        ["channels: {/image: sensitive}", "channels: {/image: {never: [Video]}}"],
    ],
)
def test_labels_that_agree_are_no_contradiction(tmp_path: Path, labels: list[str]) -> None:
    analyse(tmp_path, *[f"labels: 1\n{text}" for text in labels], VIDEO)


def test_every_contradiction_is_reported_at_once(tmp_path: Path) -> None:
    text = """labels: 1
nodes:
  /camera: {source: [Video], sanitizer: {Video: drop}}
  /filter: {leak: [Voice], conduit: [Voice]}
"""
    assert [line.split(": ")[0] for line in wrong(tmp_path, text)] == ["1.yaml:3", "1.yaml:4"]


def test_a_file_that_the_user_names_is_his_own_even_if_it_is_the_standard_one(tmp_path: Path) -> None:  # S11
    (tmp_path / "s.yaml").write_text("labels: 1\ntopics: {/none: mundane}")
    (tmp_path / "p.xml").write_text(SYSTEM)
    with pytest.raises(InputErrors, match="matches no topic"):
        rosprivacy.analyze(
            [str(tmp_path / "p.xml")], [str(tmp_path / "s.yaml")], standard_channels=str(tmp_path / "s.yaml")
        )


def test_the_report_lists_such_a_file_among_the_labels(tmp_path: Path) -> None:  # S12: what the answer rests on
    (tmp_path / "s.yaml").write_text("labels: 1\nnodes: {/camera: conduit}")
    (tmp_path / "p.xml").write_text(SYSTEM)
    file = str(tmp_path / "s.yaml")
    assumed = rosprivacy.analyze([str(tmp_path / "p.xml")], [file], standard_channels=file).document()["assumptions"]
    assert [label["file"] for label in assumed["labels"]] == [file]
    assert assumed["standard_channels"] is None


def test_a_former_spelling_of_dpv_is_read_with_a_notice(tmp_path: Path) -> None:
    file = tmp_path / "l.yaml"
    file.write_text("labels: 1\nnodes:\n  /a: {leak: [pd:Behavioral]}\n")
    found = read_labels(str(file), load())
    assert [s.categories for entry in found.entries for s in entry.statements] == [("Behaviour",)]
    (notice,) = found.diagnostics
    assert "pd:Behavioral is a former spelling; DPV spells it https://w3id.org/dpv/pd#Behavioural" in notice.message


# ---------------------------------------------------------------- whom the data are about


def test_a_source_may_say_whom_its_data_are_about(tmp_path: Path) -> None:
    text = "labels: 1\nnodes:\n  /a: {source: [Video], subjects: [visitors, ' staff ', staff]}\n  /b: conduit\n"
    assert [entry.subjects for entry in read(tmp_path, text).entries] == [("staff", "visitors"), ()]


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("[]", "subjects names nobody"),
        ("staff", "subjects names nobody"),
        ("['  ']", "where a group of persons is named"),
        ("[1]", "where a group of persons is named"),
        (f"[{'x' * 101}]", "where a group of persons is named"),
    ],
)
def test_whom_data_are_about_has_to_be_said_in_a_word_or_two(tmp_path: Path, written: str, message: str) -> None:
    (problem,) = refused(tmp_path, f"labels: 1\nnodes:\n  /a:\n    subjects: {written}\n")
    assert problem.startswith("l.yaml:4: ")
    assert message in problem


def test_a_file_may_say_it_for_another_files_source_and_for_many_at_once(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(SYSTEM)
    (tmp_path / "a.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video], subjects: [staff]}}\n")
    (tmp_path / "b.yaml").write_text("labels: 1\nnodes: {'/cam*': {subjects: [visitors]}}\n")
    result = rosprivacy.analyze([str(tmp_path / "p.xml")], [str(tmp_path / "a.yaml"), str(tmp_path / "b.yaml")])
    camera = {"robot": "", "kind": "node", "name": "/camera"}
    assert result.document()["subjects"] == [{"element": camera, "subjects": ["staff", "visitors"]}]
