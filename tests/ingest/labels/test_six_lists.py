"""The paper's six lists as a label file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

from tests.helpers.label_files import read, refused, told

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


def test_the_category_of_six_lists_has_to_exist(tmp_path: Path) -> None:
    (line,) = refused(tmp_path, SIX, category="Vidio")
    assert "unknown category 'Vidio'; did you mean Video" in line


def test_the_category_of_six_lists_has_no_effect_on_other_files(tmp_path: Path) -> None:
    assert told(read(tmp_path, "labels: 1\nnodes: {/a: conduit}", category="Vidio")) == ["node /a: conduit"]
