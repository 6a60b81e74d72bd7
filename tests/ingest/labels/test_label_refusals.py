"""What a label file is refused for: every problem at once, each with its line."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

from tests.helpers.label_files import problems, read, refused


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
