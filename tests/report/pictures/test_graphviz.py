"""Graphviz in a process of its own: limits, what is said when they are met, and what is left running: nothing."""

from __future__ import annotations

import os
import signal
import struct
from dataclasses import replace
from importlib.machinery import EXTENSION_SUFFIXES
from itertools import islice, pairwise
from math import inf
from typing import TYPE_CHECKING

import pytest
from lxml import etree

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.report.pictures import graphviz as module
from rosprivacy.report.pictures import views
from rosprivacy.report.pictures.graphviz import WAYS, Graphviz, Job, TooLongError, Way, crossings, drawn, way_of
from rosprivacy.report.pictures.picture import ROS, Box, Picture, PictureLine, sorted_boxes, sorted_lines
from tests.helpers.graphs import factory
from tests.helpers.pictures import hostile

if TYPE_CHECKING:
    from pathlib import Path

AT_ONCE = 1e-9
SMALL = Job("digraph { a -> b }")


@pytest.fixture
def picture() -> Picture:
    return views.privacy_view(PathsToLeaks(factory(2).analysis))


def test_one_process_draws_one_picture_after_the_other() -> None:
    with Graphviz() as graphviz:
        first, second = graphviz.draw(SMALL, 30), graphviz.draw(SMALL, 30)
    assert first == second
    assert b"<svg" in first


@pytest.mark.slow
def test_what_takes_too_long_is_ended_and_the_next_picture_is_drawn() -> None:
    """A layout that would take hours: nothing of it is left."""
    ends = [(i, j) for i in range(400) for j in range(0, 400, 3) if i != j]
    endless = Job("digraph { " + "; ".join(f"n{i} -> n{j}" for i, j in ends) + " }")
    with Graphviz() as graphviz:
        graphviz.draw(SMALL, 30)
        process = graphviz._process
        assert process is not None
        with pytest.raises(TooLongError):
            graphviz.draw(endless, 0.5)
        assert process.returncode == -signal.SIGKILL
        assert b"<svg" in graphviz.draw(SMALL, 30)


def test_nothing_is_left_running() -> None:
    with Graphviz() as graphviz:
        graphviz.draw(SMALL, 30)
        process = graphviz._process
        assert process is not None
        assert process.poll() is None
    assert process.poll() is not None


def test_a_crash_is_one_line_and_no_more() -> None:
    with Graphviz() as graphviz:
        graphviz.draw(SMALL, 30)
        assert graphviz._process is not None
        os.kill(graphviz._process.pid, signal.SIGKILL)
        graphviz._process.wait()
        with pytest.raises(DrawingError, match=r"^graph: Graphviz ended while it drew; "):
            graphviz.draw(SMALL, 30)
        assert b"<svg" in graphviz.draw(SMALL, 30)


@pytest.mark.parametrize(
    "job", [Job("no graph {"), Job("digraph {}", "no-engine"), Job("digraph {}", "dot", "no-format")]
)
def test_what_graphviz_refuses_is_one_line(job: Job) -> None:
    with Graphviz() as graphviz:
        with pytest.raises(DrawingError, match=r"^graph: Graphviz .*; .*$"):
            graphviz.draw(job, 30)
        assert b"<svg" in graphviz.draw(SMALL, 30)


def test_without_graphviz_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch, picture: Picture) -> None:
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    with pytest.raises(
        DrawingError, match=r"^graph: Graphviz is not installed.*; take --format dot.*pygraphviz.*libgraphviz-dev\)$"
    ):
        drawn(picture, "svg")


def test_where_a_library_of_the_system_is_missing_it_says_which(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, picture: Picture
) -> None:
    """Graphviz is installed, and the loader refuses it: here since its own library is an empty file."""
    (tmp_path / f"pygraphviz{EXTENSION_SUFFIXES[0]}").touch()
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(DrawingError, match=r"^graph: .*file too short; .*libglib.*, or take --format dot$"):
        drawn(picture, "svg")


def test_a_layout_that_is_done_in_time_needs_no_words(picture: Picture) -> None:
    assert drawn(picture, "svg").remarks == ()


def test_a_large_picture_has_a_simpler_layout_that_is_said_in_words_and_in_the_picture(picture: Picture) -> None:
    done = drawn(picture, "svg", ways=(Way("dot", {}, 10), *WAYS[1:]))
    (said,) = done.remarks
    assert said == (
        "Laid out by Graphviz's sfdp, since it is large: boxes stand near what they are joined to, unordered; "
        "--finding, --around, --most and --fold draw less"
    )
    (description,) = etree.fromstring(done.data).findall("{*}desc")
    assert said in str(description.text)


def test_the_layout_is_chosen_by_size_alone_and_time_changes_no_picture(picture: Picture) -> None:
    """Rule S14: whatever the machine's load, the same picture or none, and a line that says what to do."""
    met = crossings(len(picture.boxes), len(picture.lines))
    assert [way_of(picture, (Way("a", {}, most), Way("b", {}))).engine for most in (met - 1, met)] == ["b", "a"]
    assert drawn(picture, "svg", seconds=30).data == drawn(picture, "svg", seconds=600).data
    for direction in ("LR", ""):
        with pytest.raises(DrawingError, match=r"^graph: the layout of 11 boxes takes more than 1e-09 seconds; draw"):
            drawn(picture, "svg", seconds=AT_ONCE, direction=direction)


def pipeline(boxes: int, lines: int, prefix: str = "/element") -> Picture:
    """A picture of some boxes, each joined to those that come next, in steps that grow."""
    made = [Box(("", kind, f"{prefix}_{i:04}"), (f"{prefix}_{i:04}",), kind) for i, kind in _kinds(boxes)]
    ends = ((made[i], made[i + step]) for step in range(1, boxes) for i in range(boxes - step))
    drawn_lines = tuple(PictureLine(a.key, b.key, "data") for a, b in islice(ends, lines))
    return Picture(ROS, "pipeline", sorted_boxes(made), sorted_lines(drawn_lines))


def _kinds(count: int) -> list[tuple[int, str]]:
    return [(i, ("node", "topic")[i % 2]) for i in range(count)]


def test_dot_stops_before_it_takes_long() -> None:
    """As measured in ``layout.WAYS``: half a second is taken for it, half a minute is not."""
    sizes = {(450, 673): "dot", (190, 659): "dot", (520, 953): "sfdp", (540, 1_100): "sfdp", (1_900, 5_215): "sfdp"}
    for prefix in ("/element", "/another/name"):
        assert {size: way_of(pipeline(*size, prefix)).engine for size in sizes} == sizes


@pytest.mark.slow
def test_a_large_picture_is_the_same_bytes_each_time() -> None:
    """Rule S14, in a process of its own each time."""
    picture = pipeline(520, 953)
    first, second = (drawn(picture, "svg", direction="", seconds=seconds) for seconds in (600, 300))
    assert first == second
    assert "sfdp" in first.remarks[0]


def test_without_a_direction_it_is_the_one_that_can_be_drawn_larger_on_a_page() -> None:
    """A long chain goes down, a fan of many channels goes to the right."""
    chain = [("node", "topic")[i % 2] for i in range(30)]
    boxes = tuple(
        Box(("", kind, f"/element_{i:02}"), (f"/element_{i:02}",), "reviewed") for i, kind in enumerate(chain)
    )
    lines = tuple(PictureLine(a.key, b.key, "data") for a, b in pairwise(boxes))
    long = Picture("privacy", "long", sorted_boxes(boxes), sorted_lines(lines))
    wide = views.privacy_view(PathsToLeaks(hostile([f"/t{i}" for i in range(30)])))
    for picture, direction, other in ((long, "TB", "LR"), (wide, "LR", "TB")):
        by_shape = drawn(picture, "svg", direction="").data
        assert by_shape == drawn(picture, "svg", direction=direction).data
        assert by_shape != drawn(picture, "svg", direction=other).data


@pytest.mark.parametrize(
    "way", [replace(way, max_crossings=inf) for way in WAYS], ids=lambda way: "-".join(way.attributes)
)
def test_every_layout_draws_every_box(way: Way) -> None:
    picture = views.privacy_view(PathsToLeaks(hostile([f"/t{i}" for i in range(60)])))
    text = drawn(picture, "svg", ways=(way,)).data.decode()
    assert all(f'id="{key}"' in text for key in picture.keys.values())


@pytest.mark.slow
def test_a_png_is_of_a_bounded_size_and_says_when_it_was_made_smaller() -> None:
    """A memory of some gigabytes would be what Graphviz takes otherwise."""
    picture = views.privacy_view(PathsToLeaks(hostile([f"/topic_number_{i}" for i in range(400)])))
    done = drawn(picture, "png")
    assert max(struct.unpack(">II", done.data[16:24])) <= 7200
    assert any("made smaller" in said for said in done.remarks)
