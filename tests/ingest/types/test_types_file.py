"""Files of observed message types: what is read, what is refused, what matches nothing (rules S15, S16)."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest
import yaml

import rosprivacy
from rosprivacy.ingest.policies.saved_graph import as_dict
from rosprivacy.ingest.types.types_file import read_types
from rosprivacy.report.json_text import as_text
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from tests.helpers.command import Cli

SEEN = """types: 1
observed: {from: 2026-11-22T10:00:00Z, to: 2026-11-22T10:10:00Z, by: [dds]}
topics:
  /camera/image:
    - {type: sensor_msgs/msg/Image, hash: RIHS01_ab, writers: [/cam], readers: [/face], first: 2026-11-22T10:00:01Z,
       last: 2026-11-22T10:09:59Z}
    - {type: "{HelloWorld}", writers: [/ghost]}
services:
  /save: [{type: footage_msgs/srv/Save, servers: [/archive], clients: [/face]}]
actions:
  /go: [{type: nav2_msgs/action/NavigateToPose, servers: [/cam], clients: []}]
"""
SYSTEM = policy("/cam>/camera/image", "/face</camera/image", "/archive").replace(
    'node="archive">', 'node="archive"><services reply="ALLOW"><service>/save</service></services>'
).replace(
    'node="face">', 'node="face"><services request="ALLOW"><service>/save</service></services>'
)  # fmt: skip


@pytest.fixture(autouse=True)
def files_of_a_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(SYSTEM, "utf-8")
    Path("t.yaml").write_text(SEEN, "utf-8")
    Path("l.yaml").write_text("labels: 1\nnodes: {/cam: {source: [Video]}, /archive: {leak: [Video]}}\n", "utf-8")


def by_name(document: dict[str, Any]) -> dict[tuple[str, str], list[dict[str, Any]]]:
    return {(row["element"]["name"], row["element"].get("leg", "")): row["types"] for row in document["types"]}


def test_what_was_seen_stands_at_its_channel_and_at_both_legs_of_a_service() -> None:
    document = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml").document()
    found = by_name(document)
    image = found["/camera/image", ""]
    assert [one["type"] for one in image] == ["sensor_msgs/msg/Image", "{HelloWorld}"]
    assert image[0] == {
        "type": "sensor_msgs/msg/Image", "hash": "RIHS01_ab", "stated": False, "file": "t.yaml", "line": 5,
        "writers": ["/cam"], "readers": ["/face"], "first": "2026-11-22T10:00:01Z", "last": "2026-11-22T10:09:59Z",
    }  # fmt: skip
    (request,), (response,) = found["/save", "request"], found["/save", "response"]
    assert (request["writers"], request["readers"]) == (["/face"], ["/archive"])
    assert (response["writers"], response["readers"]) == (["/archive"], ["/face"])
    (file,) = document["assumptions"]["types"]
    assert file["file"] == "t.yaml"
    assert file["observed"] == {"from": "2026-11-22T10:00:00Z", "to": "2026-11-22T10:10:00Z", "by": ["dds"]}


def test_names_that_match_nothing_are_counted_and_named_and_no_error() -> None:
    document = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml").document()
    (said,) = [row for row in document["diagnostics"] if row.get("code") == "types-of-nothing"]
    assert said["message"] == "2 names of observed types that nothing of the system is called: action /go, node /ghost"


def test_a_file_is_read_only_where_it_is_named() -> None:
    assert "types" not in rosprivacy.analyze("p.xml", "l.yaml").document()


def test_types_change_no_flow_and_no_finding_where_nothing_limits_them() -> None:
    plain, seen = rosprivacy.analyze("p.xml", "l.yaml"), rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml")
    assert seen.analysis.findings == plain.analysis.findings != ()
    assert seen.analysis.open == plain.analysis.open


def test_a_saved_graph_keeps_them_and_a_file_that_is_named_is_read_anew() -> None:
    result = rosprivacy.analyze("p.xml", types="t.yaml")
    Path("g.json").write_text(as_text(as_dict(result.policies, result.diagnostics, result.types)), "utf-8")
    expected = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml").document()
    assert rosprivacy.analyze(labels="l.yaml", add="g.json").document() == expected
    Path("t.yaml").write_text("types: 1\n", "utf-8")
    assert "types" not in rosprivacy.analyze(labels="l.yaml", add="g.json", types="t.yaml").document()


def test_what_is_no_such_file_is_refused_with_all_its_lines() -> None:
    Path("bad.yaml").write_text(
        "types: 1\nobserved: {from: yesterday}\ntopics:\n  image: []\n  /a: [{hash: x}]\n  /b: {type: x}\n"
        "  /c: [{type: 7, writer: [/a]}]\nservices: {/d: [{type: x, writers: [/a]}]}\n",
        "utf-8",
    )
    with pytest.raises(rosprivacy.InputErrors) as refused:
        rosprivacy.analyze("p.xml", types=["bad.yaml", "none.yaml"])
    assert str(refused.value).splitlines() == [
        "bad.yaml:2: from takes a time, not 'yesterday'; write it as 2026-11-22T10:00:00Z",
        "bad.yaml:4: 'image' is not the name of a channel; begin it with /",
        "bad.yaml:5: what was seen needs a type; write {type: sensor_msgs/msg/Image}",
        "bad.yaml:6: /b takes a list, not a map; write [{type: …}]",
        "bad.yaml:7: type takes text of at most 500 characters, not '7'; observe again, or correct it",
        "bad.yaml:7: unknown key 'writer'; did you mean 'writers'?",
        (
            "bad.yaml:8: unknown key 'writers'; one of type, hash, servers, clients, first, last, definition, request, "
            "response"
        ),
        "none.yaml: file not found; correct the path",
    ]


@pytest.mark.parametrize("text", ["", "types: 2\n", "topics: {}\n", "[]\n", "types: 1\nextra: 1\n", "\0"])
def test_what_is_of_another_format_is_refused(text: str) -> None:
    Path("bad.yaml").write_text(text, "utf-8")
    with pytest.raises(rosprivacy.InputErrors, match=r"bad\.yaml"):
        read_types("bad.yaml")


def test_the_schema_takes_what_the_reader_takes_and_refuses_unknown_keys() -> None:
    schema = json.loads(files("rosprivacy.ingest.types").joinpath("types_file.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    times = yaml.load(SEEN, yaml.BaseLoader)  # noqa: S506 - it makes plain values only, and keeps times as text
    validator.validate(times | {"types": 1})
    for wrong in ({"types": 2}, {"types": 1, "topics": {"a": []}}, {"types": 1, "topics": {"/a": [{"hash": "x"}]}}):
        assert not validator.is_valid(wrong)


def test_a_fleet_takes_none(cli: Cli) -> None:
    done = cli("analyze", "--fleet", "f.yaml", "--types", "t.yaml")
    assert done.returncode == 2
    assert "no --types" in done.stderr
