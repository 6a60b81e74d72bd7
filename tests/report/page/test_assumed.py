"""The report has a table of the types of channels with data, and of what only they close (rules S15, S16)."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any

import pytest

import rosprivacy
from rosprivacy.formats import Style, written
from rosprivacy.report.catalogs import LANGUAGES
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.page.outline import outline
from tests.helpers.bags import rosbag2
from tests.helpers.fleet_files import policy

SEEN = """types: 1
observed: {from: 2026-11-22T10:00:00Z, to: 2026-11-22T10:10:00Z, by: [dds]}
topics:
  /a: [{type: std_msgs/msg/Bool, writers: [/cam]}]
  /b: [{type: own_msgs/msg/B, writers: [/cam]}]
  /quiet: [{type: own_msgs/msg/Q, writers: [/more]}]
"""
LABELS = """labels: 1
nodes: {/cam: {source: [Video]}, /sink: {leak: [Video]}}
channels: {/b: {types: [sensor_msgs/msg/Image]}}
"""


@pytest.fixture(autouse=True)
def a_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy("/cam>/a,/b", "/sink</a", "/other</b", "/more>/quiet"), "utf-8")
    Path("l.yaml").write_text(LABELS, "utf-8")
    Path("t.yaml").write_text(SEEN, "utf-8")


def told(**more: Any) -> Any:
    return rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", **more)


def test_channels_with_data_have_a_row_with_types_and_from_where_each_is_known() -> None:
    rows = {row.name: row for row in outline(told().document(), "en").grounds.typed}
    assert list(rows) == ["/a", "/b"]  # no data gets to /quiet
    assert rows["/a"].types == (("std_msgs/msg/Bool", "observed, t.yaml:4"),)
    assert (rows["/a"].data, rows["/a"].closed) == ("", "video of persons")
    assert rows["/b"].types == (
        ("own_msgs/msg/B", "observed, t.yaml:5"),
        ("sensor_msgs/msg/Image", "stated, l.yaml:3"),
    )
    assert (rows["/b"].data, rows["/b"].closed) == ("video of persons", "")


def test_what_only_a_type_closes_stands_there_and_not_without_limits() -> None:
    assert outline(told().document(), "en").grounds.only_by_types == (("video of persons", "/cam to /sink"),)
    assert outline(told(type_limits=None).document(), "en").grounds.only_by_types == ()


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("form", ["html", "markdown", "docx"])
def test_every_report_has_it_in_every_language(language: str, form: str, tmp_path: Path) -> None:
    made = written(told(), form, Style(language=language))
    if isinstance(made, bytes):
        import docx

        (tmp_path / "r.docx").write_bytes(made)
        document = docx.Document(str(tmp_path / "r.docx"))
        made = "\n".join(
            [p.text for p in document.paragraphs]
            + [cell.text for table in document.tables for row in table.rows for cell in row.cells]
        )
    words = Words(language)
    for text in (
        words("heading.types"),
        words("column.cannot"),
        words("table.only_types"),
        words("channel_type.stated", place="l.yaml:3"),
    ):
        assert text.replace("\u00a0", " ") in html.unescape(made).replace("\u00a0", " ")
    assert "sensor_msgs/msg/Image" in made


def test_without_types_there_is_no_such_section() -> None:
    plain = rosprivacy.analyze("p.xml").document()
    assert "types" not in [anchor for anchor, _ in outline(plain, "en").sections]


def test_robots_that_are_alike_in_this_are_one_row() -> None:
    robots = ", ".join(f"r{n}: {{policies: p.xml, labels: l{n}.yaml, types: t.yaml}}" for n in (1, 2))
    for n in (1, 2):
        Path(f"l{n}.yaml").write_text(f"{LABELS}# robot {n}\n", "utf-8")
    Path("f.yaml").write_text(f"fleet: 1\nrobots: {{{robots}}}\n", "utf-8")
    (first, *_) = outline(rosprivacy.analyze_fleet("f.yaml").document(), "en").grounds.typed
    assert first.name == "/a (2 robots)"


def test_a_bag_tells_types_of_which_nobody_is_known_to_be_the_writer() -> None:
    """S15: it is one more type of the channel, so it can only lift a limit."""
    closed = told()
    assert not closed.findings
    rosbag2(Path("run1"), topics={"/a": ("sensor_msgs/msg/Image", 1)})
    Path("l.yaml").write_text(f"{LABELS}elements: {{run: {{kind: storage, bag: run1, retention: P1D}}}}\n", "utf-8")
    result = told()
    row = next(row for row in outline(result.document(), "en").grounds.typed if row.name == "/a")
    assert row.types == (
        ("sensor_msgs/msg/Image", "in a recording, l.yaml:4"),
        ("std_msgs/msg/Bool", "observed, t.yaml:4"),
    )
    assert [finding.leak.name for finding in result.analysis.findings if finding.kind == "disclosure"] == ["/sink"]
    Path("t.yaml").write_text("types: 1\n", "utf-8")
    rosbag2(Path("run2"), topics={"/a": ("std_msgs/msg/Bool", 1)})
    Path("l.yaml").write_text(Path("l.yaml").read_text("utf-8").replace("run1", "run2"), "utf-8")
    assert [f.leak.name for f in told().analysis.findings if f.kind == "disclosure"] == ["/sink"]
