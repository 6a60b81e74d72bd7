"""The JSON Schema of label files and the reader agree."""

from __future__ import annotations

import copy
import json
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ontology.vocabulary import load
from tests.helpers.daily import one_in
from tests.helpers.schema_places import places

if TYPE_CHECKING:
    from pathlib import Path

from tests.helpers.label_files import read, told, validator

FULL: dict[str, Any] = {
    "labels": 1,
    "author": "A. Person",
    "nodes": {
        "/a": "conduit",
        "/b": {"source": ["Video"], "leak": ["Voice"], "conduit": ["Location"], "subjects": ["staff"], "note": "x",
               "author": "B"},
        "/c": {"source": {"Video": ["/t"]}, "sanitizer": {"Voice": "drop", "Health": None}},
        "/d": {"sanitizer": ["Video"], "derives": [{"from": "Video", "to": "FaceTemplate"}]},
        "/e": None,
        "=/*": {"absent": "sold", "note": "in May"},
    },
    "channels": {
        "/t": "mundane",
        "/u": {"only": ["Video"], "never": ["Voice"], "note": "x", "author": "B"},
        "/v": None,
    },
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
    "pins": {
        "nodes": {"/a": ["Video"], "=/*": ["Voice", "Video"]},
        "topics": {},
        "flows": [{"from": {"node": "/a"}, "to": {"topic": "/t"}, "kinds": ["Video"]},
                  {"from": {"node": "/a"}, "to": "bucket", "kinds": ["Voice"]}],
    },
}  # fmt: skip


OTHERS: tuple[Any, ...] = (
    None, 0, 1, 2, 1.5, True, "", "1", "x", "Video", "/x", "conduit", "mundane", "drop", [], {}, [None], [1], [[]],
    [{}], ["Video"], ["/x"], {"Video": None}, {"Video": ["/x"]}, {"Video": "drop"}, {"Video": []}, {"/x": None},
    {"/x": "conduit"}, {"/x": "mundane"}, {"x": 1}, {"from": "Video", "to": "Voice"},
    [{"from": "Video", "to": "Voice"}], {"from": "/a", "to": "/b", "only": ["Video"]}, {"only": ["Video"]},
    {"leak": ["Video"]}, {"leak": []}, {"note": "x"},
    {"author": "x"}, {"author": " "}, {"author": 1},
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
    assert len(told(read(tmp_path, json.dumps(FULL)))) == 21
    assert validator().is_valid(FULL)


# What no schema says: it takes every word as a category, since synonyms are many, and compares no two lists.
BEYOND = ("unknown category", "is under only and under never")


@pytest.mark.parametrize("way", one_in(40, [(way,) for way in places(FULL)]), ids=lambda way: ".".join(map(str, way)))
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


def test_it_refuses_what_the_reader_does_of_absent_and_of_names() -> None:
    for entry, valid in (
        ({"nodes": {"/a": {"absent": "sold", "note": "in May"}}}, True),
        ({"nodes": {"/a": {"absent": ""}}}, False),
        ({"nodes": {"/a": {"sanitizer": {"Video": "absent"}}}}, False),
        ({"topics": {"=/*": "sensitive"}, "nodes": {"=/a": "conduit"}}, True),
        ({"elements": {"=disk": {"kind": "storage"}}}, False),
    ):
        assert validator().is_valid({"labels": 1, **entry}) == valid, entry


@pytest.mark.parametrize(
    "key", ["labels", "nodes", "channels", "topics", "services", "actions", "limits", "flows", "pins"]
)
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
