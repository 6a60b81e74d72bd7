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

LONG = "x" * 101  # characters, one more than the name of a group has
# line, text, what the message says; below REFUSED each text stands behind "labels: 1"
WHOLE = [
    (1, "nodes: {/a: conduit}", "no 'labels: 1'"),
    (1, "labels: 2", "label format '2'; this reads 'labels: 1'"),
    (1, "labels: one", "label format 'one'"),
    (1, "labels: [1]", "label format 'list'"),
    (1, "labels:", "label format"),
    (1, "[labels, 1]", "a label file is a map, not a list; begin with 'labels: 1'"),
    (1, "labels", "a label file is a map, not a text"),
    (1, "5", "a label file is a map, not a number"),
    (1, "", "the file is empty"),
    (1, '{"source": ["/a"], "leeks": []}', "unknown key 'leeks'; did you mean 'leak'?"),
    (1, '{"source": ["/a"], "nodes": {}}', "unknown key 'nodes'"),
    (1, '{"source": "/a"}', "source takes a list, not a text"),
    (1, '{"source": {"/a": 1}}', "source takes a list, not a map"),
    (1, '{"source": ["a"]}', "'a' is not an absolute name; begin it with /"),
    (1, '{"source": [1]}', "'1' is not an absolute name"),
    (1, '{"source": [["/a"]]}', "'list' is not an absolute name"),
    (1, '{"source": [null]}', "is not an absolute name"),
]  # fmt: skip
REFUSED = [
    (2, "node: {}", "unknown key 'node'; did you mean 'nodes'?"),
    (2, "robots: {}", "unknown key 'robots'"),
    (2, "nodes: [/a]", "nodes is a map from names to labels, not a list"),
    (2, "nodes: /a", "nodes is a map from names to labels, not a text"),
    (2, "flows: {/a: /b}", "flows takes a list, not a map"),
    (2, "nodes: {a: conduit}", "name 'a' is not absolute; begin it with /"),
    (2, "nodes: {~: conduit}", "name '~' is not absolute"),
    (2, "nodes: {~/a: conduit}", "name '~/a' is not absolute"),
    (2, "nodes: {1: conduit}", "name '1' is not absolute"),
    (2, "nodes: {'': conduit}", "name '' is not absolute"),
    (2, "nodes: {/a: Conduit}", "label 'Conduit' on a node"),
    (2, "nodes: {/a: mundane}", "label 'mundane' on a node"),
    (2, "nodes: {/a: [conduit]}", "label 'list' on a node"),
    (2, "nodes: {/a: true}", "label 'true' on a node"),
    (2, "nodes: {/a: {sauce: [Video]}}", "unknown key 'sauce'; did you mean 'source'?"),
    (2, "nodes: {/a: {only: [Video]}}", "unknown key 'only'"),
    (2, "nodes: {/a: {mundane: [Video]}}", "unknown key 'mundane'"),
    (2, "nodes: {/a: {source: Video}}", "source takes a list, not a text; write […]"),
    (2, "nodes: {/a: {source: }}", "source names no category"),
    (2, "nodes: {/a: {source: []}}", "source names no category"),
    (2, "nodes: {/a: {source: {}}}", "source names no category"),
    (2, "nodes: {/a: {source: [1]}}", "a number where a category is named"),
    (2, "nodes: {/a: {source: [[Video]]}}", "a list where a category is named"),
    (2, "nodes: {/a: {source: {Video: }}}", "source of Video names no channel"),
    (2, "nodes: {/a: {source: {Video: []}}}", "source of Video names no channel"),
    (2, "nodes: {/a: {source: {Video: [image]}}}", "'image' is not an absolute name"),
    (2, "nodes: {/a: {leak: {Video: drop}}}", "leak takes a list, not a map"),
    (2, "nodes: {/a: {leak: }}", "leak names no category"),
    (2, "nodes: {/a: {conduit: []}}", "conduit names no category"),
    (2, "nodes: {/a: {sanitizer: Video}}", "sanitizer takes a list, not a text"),
    (2, "nodes: {/a: {sanitizer: {}}}", "sanitizer names no category"),
    (2, "nodes: {/a: {sanitizer: {Video: blur}}}", "sanitizer method 'blur'"),
    (2, "nodes: {/a: {sanitizer: {Video: [drop]}}}", "sanitizer method 'list'"),
    (2, "nodes: {/a: {derives: {from: Video, to: Voice}}}", "derives takes a list, not a map"),
    (2, "nodes: {/a: {derives: }}", "derives"),
    (2, "nodes: {/a: {derives: [Video]}}", "a derivation is a map, not a text"),
    (2, "nodes: {/a: {derives: [{from: Video}]}}", "a derivation needs from and to"),
    (2, "nodes: {/a: {derives: [{from: [Video], to: Voice}]}}", "a list where a category is named"),
    (2, "nodes: {/a: {derives: [{from: Video, to: Voice, by: x}]}}", "unknown key 'by'; one of from, to"),
    (2, "nodes: {/a: {note: [why]}}", "note"),
    (2, "nodes: {/a: {leak: [Video], author: LONG}}", "author takes a name"),
    (2, "channels: {/a: {note: {why: x}}}", "note"),
    (2, "channels: {/a: conduit}", "label 'conduit' on a channel; write mundane, sensitive"),
    (2, "channels: {/a: [mundane]}", "label 'list' on a channel"),
    (2, "channels: {/a: {source: [Video]}}", "unknown key 'source'"),
    (2, "channels: {/a: {only: Video}}", "only takes a list, not a text"),
    (2, "channels: {/a: {only: []}}", "only names no category"),
    (2, "channels: {/a: {never: }}", "never names no category"),
    (2, "flows: [/a]", "a flow is a map, not a text"),
    (2, "flows: [{from: /a, never: [Video]}]", "a flow needs from and to"),
    (2, "flows: [{from: /a, to: /b}]", "a flow between nodes and channels needs only or never"),
    (2, "flows: [{from: /a, to: /b, never: [Vidio]}]", "unknown category 'Vidio'"),
    (2, "flows: [{from: /a, to: /b, never: [Video], via: /c}]", "unknown key 'via'"),
    (4, "nodes:\n  /a: conduit\n  /a: conduit", "'/a' again, first in line 3; merge the two"),
    (2, "nodes: {/a: &x {leak: [Video]}, /b: *x}", "anchors and aliases are not read"),
    (2, "legal_basis: consent", "legal basis 'consent'"),
    (2, "legal_basis: []", "legal_basis says nothing; write it, or remove the key"),
    (2, "legal_basis: {Videoo: 6(1)(f)}", "unknown category 'Videoo'"),
    (2, "legal_basis: [6(1)(f), 46(2)(c)]", "a basis of a transfer for a whole system"),
    (2, "controller: [A, B]", "controller: a list"),
    (2, "controller:", "controller: nothing; write a text of one line"),
    (2, "purpose: {Video: 3}", "purpose: '3'; write a text of one line"),
    (2, 'purpose: "Video: care"', "purpose 'Video: care' begins with a kind of data"),
    (2, "nodes: {/cam: {controller: A}}", "unknown key 'controller'"),
    (2, "nodes: {/cam: {legal_basis: 6(2)}}", "legal basis '6(2)'; write such as 6(1)(f)"),
    (2, "channels: {/v: {purpose: care}}", "unknown key 'purpose'"),
    (2, "elements: {c: {kind: person, legal_basis: [46(2)(c), 47]}}", "names binding-corporate-rules and"),
    (2, "elements: {c: {kind: person, transfer: none, legal_basis: 47}}", "rules, and transfer says none"),
    (2, "elements: {c: {kind: person, legal_basis: {Video: 47}}}", "a basis of a transfer for one kind of data"),
    (2, "elements: {c: {kind: external-system, contract: [28]}}", "contract: a list; write its name"),
    (2, "nodes: {/a: {subjects: []}}", "subjects names nobody"),
    (2, "nodes: {/a: {subjects: staff}}", "subjects names nobody"),
    (2, "nodes: {/a: {subjects: ['  ']}}", "where a group of persons is named"),
    (2, "nodes: {/a: {subjects: [1]}}", "where a group of persons is named"),
    (2, "nodes: {/a: {subjects: [LONG]}}", "where a group of persons is named"),
    (2, "context: [carre]", "unknown context 'carre'; did you mean care?"),
    (2, "context: [market]", "unknown context 'market'"),
    (2, "context: []", "context names nothing; write some of care,"),
    (2, "context: {care: yes}", ""),
    (2, "country: UK", "'UK' is not an ISO 3166-1 country code; did you mean GB?"),
    (2, "nodes: {/a: {absent: }}", "absent without a reason"),
    (2, "nodes: {/a: {absent: true}}", "absent without a reason"),
    (2, "nodes: {/a: {absent: sold, leak: [Video]}}", "absent beside leak"),
    (2, "nodes: {/a: {sanitizer: {Video: absent}}}", "sanitizer method 'absent'"),
    (2, "nodes: {/a: absent}", "label 'absent' on a node"),
    (2, "topics: {/a: {sensitive: []}}", "sensitive names no category"),
    (2, "topics: {/a: {sensitive: [Vidoe]}}", "unknown category 'Vidoe'"),
    (2, "channels: {/a: {types: [Image]}}", "'Image' is not the name of a type; write it in full"),
    (2, "channels: {/a: {types: [7]}}", "'7' is not the name of a type; write it in full"),
    (2, "channels: {/a: {types: []}}", "types names no type; name one"),
    (2, "channels: {/a: {types: sensor_msgs/msg/Image}}", "types takes a list, not a text"),
    (2, "topics: {/a: {types: [a/srv/B]}}", "a/srv/B is the type of a service; move it"),
    (2, "nodes: {/cam: {types: [a/msg/B]}}", "unknown key 'types'"),
    (2, "pins: [Video]", ""),
    (2, "pins: {nodes: {/a: Vidoe}}", ""),
    (2, "pins: {nodes: {'/*': [Video]}}", ""),
    (2, "pins: {nodes: {a: [Video]}}", ""),
    (2, "pins: {nodes: {/a: []}}", ""),
    (2, "pins: {channels: {/a: [Video]}}", ""),
    (4, "pins:\n  flows:\n  - {from: /a, to: {topic: /b}, kinds: [Video]}", ""),
    (4, "pins:\n  flows:\n  - {from: {node: /a}, to: {topic: /b}}", ""),
    (4, "pins:\n  flows:\n  - /a", ""),
    (2, "elements: {bucket: {}}", "element 'bucket' has no kind"),
    (2, "elements: {bucket: storage}", "element 'bucket' has no kind"),
    (2, "elements: {bucket: {kind: database}}", "element 'bucket' of kind 'database'; write"),
    (2, "elements: {bucket: {kind: storage, retention: 30 days}}", "'30 days' is not an ISO 8601 duration; write"),
    (2, "elements: {bucket: {kind: storage, retention: 30}}", "'30' is not an ISO 8601 duration"),
    (2, "elements: {bucket: {kind: storage, retention: }}", "nothing is not an ISO 8601 duration"),
    (2, "elements: {bucket: {kind: storage, retention: P1.5M}}", "'P1.5M' is a part of a month"),
    (2, "elements: {bucket: {kind: storage, retention: {Vide: P1D}}}", "unknown category 'Vide'; did you mean"),
    (2, "elements: {bucket: {kind: storage, retention: {}}}", "retention names no category"),
    (2, "elements: {bucket: {kind: storage, backups: maybe}}", "'maybe' is not an ISO 8601 duration; write"),
    (2, "elements: {bucket: {kind: storage, encrypted: maybe}}", "encrypted: 'maybe'; write true or false"),
    (2, "elements: {bucket: {kind: storage, country: UK}}", "'UK' is not an ISO 3166-1 country code; did you mean GB?"),
    (2, "elements: {bucket: {kind: storage, country: de}}", "'de' is not an ISO 3166-1 country code; did you mean DE?"),
    (2, "elements: {bucket: {kind: storage, country: EU}}", "'EU' is not an ISO 3166-1 country code; did you mean the"),
    (2, "elements: {bucket: {kind: storage, country: XX}}", "'XX' is not an ISO 3166-1 country code; write the two"),
    (2, "elements: {bucket: {kind: storage, country: []}}", "a list is not an ISO 3166-1 country code"),
    (2, "elements: {bucket: {kind: storage, recipient: friend}}", "recipient: 'friend'; one of controller,"),
    (2, "elements: {bucket: {kind: storage, transfer: trust}}", "transfer: 'trust'; one of adequacy,"),
    (2, "elements: {bucket: {kind: storage, operator: }}", "operator: nothing; write its name"),
    (2, "elements: {bucket: {kind: storage, retentoin: P1D}}", "unknown key 'retentoin'; did you mean 'retention'?"),
    (2, "elements: {bucket: {kind: storage, between: [/a, /b]}}", "unknown key 'between'"),
    (2, "elements: {ring: {kind: shared-memory, between: [/recorder]}}", "between names at least two nodes"),
    (2, "elements: {badge: {kind: device}}", "device 'badge' does nothing; say what comes from it"),
    (2, "elements: {/bucket: {kind: storage}}", "'/bucket' cannot name an element outside ROS"),
    (2, 'elements: {"=disk": {kind: storage}}', "cannot name an element outside ROS"),
    (2, "elements: {'a:b': {kind: storage}}", "'a:b' cannot name an element outside ROS"),
    (2, "elements: {bucket: {kind: storage, source: [Vide]}}", "unknown category 'Vide'"),
    (2, "limits: {Vide: P1D}", "unknown category 'Vide'"),
    (2, "limits: {Video: soon}", "'soon' is not an ISO 8601 duration"),
    (2, "limits: [P1D]", "limits is a map, not a list"),
]  # fmt: skip


@pytest.mark.parametrize(("line", "text", "words"), WHOLE + [(at, f"labels: 1\n{text}", w) for at, text, w in REFUSED])
def test_what_is_wrong_is_told_at_its_line(tmp_path: Path, line: int, text: str, words: str) -> None:
    (problem,) = refused(tmp_path, text.replace("LONG", LONG))
    assert problem.startswith(f"l.yaml:{line}: ")
    assert words in problem


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
