"""Graphviz in a process of its own: limits, what is said when they are met, and what is left running: nothing."""

from __future__ import annotations

import os
import signal
import struct
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.report.pictures import graphviz as module
from rosprivacy.report.pictures import views
from rosprivacy.report.pictures.graphviz import Graphviz, Job, TooLongError
from rosprivacy.report.pictures.layout import WAYS, Way, drawn
from tests.helpers.graphs import factory
from tests.helpers.pictures import hostile

if TYPE_CHECKING:
    from rosprivacy.report.pictures.picture import Picture

AT_ONCE = 1e-9
SMALL = Job("digraph { a -> b }")


@pytest.fixture
def picture() -> Picture:
    return views.privacy_view(factory(2).analysis)


def test_one_process_draws_one_picture_after_the_other() -> None:
    with Graphviz() as graphviz:
        first, second = graphviz.draw(SMALL, 30), graphviz.draw(SMALL, 30)
    assert first == second
    assert b"<svg" in first


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
    with pytest.raises(DrawingError, match=r"pip install 'rosprivacy\[views\]', or take --format dot"):
        drawn(picture, "svg")


def test_a_layout_that_is_done_in_time_needs_no_words(picture: Picture) -> None:
    assert drawn(picture, "svg").said == ()


def test_when_time_runs_out_a_simpler_layout_is_taken_and_said_in_words_and_in_the_picture(picture: Picture) -> None:
    ways = (Way("dot", {}, AT_ONCE), *WAYS[1:])
    done = drawn(picture, "svg", ways=ways)
    assert done.said == (
        "Graphviz's dot did not finish in 0 seconds; --finding, --around, --most and --fold draw less",
        "Laid out by Graphviz's sfdp: boxes stand near what they are joined to, unordered",
    )
    for said in done.said:
        assert said.replace("'", "&apos;") in done.data.decode() or said in done.data.decode()


def test_when_nothing_is_done_in_time_it_says_what_to_do(picture: Picture) -> None:
    with pytest.raises(DrawingError, match=r"^graph: the layout of 11 boxes takes more than 30 seconds; draw less "):
        drawn(picture, "svg", seconds=30, ways=(Way("dot", {}, AT_ONCE), Way("sfdp", {}, AT_ONCE)))


@pytest.mark.parametrize("way", WAYS, ids=lambda way: str(way.share))
def test_every_layout_draws_every_box(way: Way) -> None:
    picture = views.privacy_view(hostile([f"/t{i}" for i in range(60)]))
    text = drawn(picture, "svg", ways=(way,)).data.decode()
    assert all(f'id="{key}"' in text for key in picture.keys.values())


def test_a_png_is_of_a_bounded_size_and_says_when_it_was_made_smaller() -> None:
    """A memory of some gigabytes would be what Graphviz takes otherwise."""
    picture = views.privacy_view(hostile([f"/topic_number_{i}" for i in range(400)]))
    done = drawn(picture, "png")
    assert max(struct.unpack(">II", done.data[16:24])) <= 7200
    assert any("made smaller" in said for said in done.said)
