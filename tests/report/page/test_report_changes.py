"""What the report tells of an earlier analysis."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputError
from rosprivacy.report.compare.changes import changes
from rosprivacy.report.compare.earlier import read_earlier
from tests.helpers.reports import care

if TYPE_CHECKING:
    from pathlib import Path
from tests.helpers.pages import earlier, texts, told


def test_nothing_changed_is_said_so() -> None:
    differ = changes(care(), care())
    assert differ.nothing
    for text in texts(care(), earlier=earlier(care())):
        assert "Nothing changed in what was found" in text


def test_new_gone_and_changed_ways_are_told() -> None:
    old, new = care(), care()
    new["findings"][1]["witness"].insert(1, {"robot": "", "kind": "topic", "name": "/detour"})
    new["findings"][1]["steps"].insert(1, new["findings"][1]["steps"][0])
    gone = new["findings"].pop(0)
    old["findings"].pop(2)
    differ = changes(old, new)
    assert [finding["id"] for finding in differ.removed] == [gone["id"]]
    assert differ.new == (new["findings"][1]["id"],)
    assert differ.changed == {new["findings"][0]["id"]: ("witness",)}
    report = told(new, earlier=earlier(old))
    assert [entry.mark for entry in report.entries] == ["new", "changed"]  # unpseudonymised data first
    for text in texts(new, earlier=earlier(old)):
        assert gone["id"] in text
        assert "another shortest path" in text


def test_a_line_that_only_moved_is_no_change() -> None:
    new = care()
    for step in new["findings"][0]["steps"]:
        step["policy"][0]["line"] += 7
    assert changes(care(), new).nothing


def test_a_way_that_is_gone_because_less_was_asked_is_no_answer() -> None:
    new = care()
    new["findings"] = []
    new["verdict"] = "no-leak-found"
    new["assumptions"] |= {"categories_asked": ["Voice"], "view": "enforced"}
    for text in texts(new, earlier=earlier(care())):
        assert "were not made in the same way. A path that is new or gone can come from that alone" in text
        assert "view: 'declared', now 'enforced'" in text
        assert "kinds asked for: all, now Voice" in text


def test_how_many_channels_the_standard_file_took_is_no_other_way_of_asking() -> None:
    new = care()
    new["assumptions"]["standard_channels"]["taken"] = 3
    assert changes(care(), new).scope == ()


def test_files_that_differ_are_named() -> None:
    new = care()
    new["assumptions"]["policies"][0]["sha256"] = "1" * 64
    assert changes(care(), new).files == (new["assumptions"]["policies"][0]["file"],)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ": the file is empty; give what"),
        ("[]", ": is not a document of the format rosprivacy.analysis/1"),
        ('{"format": "rosprivacy.analysis/3"}', ": is of the format rosprivacy.analysis/3, and this"),
        ('{"format": "rosprivacy.analysis/1"}', ": damaged or changed: the document lacks verdict, view, categories,"),
        ("[" * 100_000, ": nested too deeply"),
        ("\ud800", None),
    ],
)
def test_what_is_no_document_is_refused_in_one_line(tmp_path: Path, text: str, message: str | None) -> None:
    file = tmp_path / "old.json"
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(InputError) as caught:
        read_earlier(str(file))
    assert str(caught.value).startswith(str(file))
    assert "\n" not in str(caught.value)
    assert message is None or message in str(caught.value)


@pytest.mark.parametrize(
    "way", [("findings", 0, "witness", 0, "name"), ("open",), ("findings", 0, "id"), ("categories",)]
)
def test_a_damaged_document_is_refused_with_the_place(tmp_path: Path, way: tuple[Any, ...]) -> None:
    document: Any = care()
    inside = document
    for key in way[:-1]:
        inside = inside[key]
    inside[way[-1]] = 7
    file = tmp_path / "old.json"
    file.write_text(json.dumps(document))
    with pytest.raises(InputError, match=re.escape(str(way[-1]))):
        read_earlier(str(file))
