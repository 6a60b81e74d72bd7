"""What is drawn where nobody says what: what people can read, with every omission said; and ``--all``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import networkx as nx
import pygraphviz
import pytest
from hypothesis import given

from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.report.pictures import views
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.pictures.looks import SHAPES
from rosprivacy.report.pictures.narrow import legible
from rosprivacy.report.pictures.picture import LEGIBLE, PRIVACY, ROS
from tests.helpers.graphs import care_home, factory
from tests.helpers.paths import ROOT
from tests.helpers.pictures import fleet_privacy, names_of, pictures, ros
from tests.helpers.systems import System, analysed, systems

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.report.pictures.picture import Picture
    from tests.helpers.command import Cli

FLEET = ("graph", "--fleet", ROOT / "examples" / "fleet" / "fleet.yaml", "--show", "privacy")


def test_a_small_picture_is_drawn_whole() -> None:
    for picture in (ros(factory(2)), ros(care_home()), views.privacy_view(PathsToLeaks(care_home().analysis))):
        assert legible(picture) == (picture, ())


def test_a_large_picture_says_what_it_leaves_out_and_how_to_get_it() -> None:
    whole = fleet_privacy()
    small, said = legible(whole)
    assert len(small.boxes) <= LEGIBLE < len(whole.boxes)
    assert small.notes == (*whole.notes, *said)
    gone = [box for box in whole.boxes if not set(box.names) <= names_of(small.boxes)]
    assert gone
    assert said[0].startswith("Not drawn: 29 elements beside the paths of up to ")
    assert said[1].startswith("Not drawn, of what counts: ")
    assert said[-1] == "Drawn smaller: 28 boxes for 57 elements, channels with the same ends as one; --all draws all"


@given(systems())
def test_nothing_is_hidden_in_silence_and_no_finding_at_all(system: System) -> None:
    """Every name that is gone is behind a note; the shortest path of each finding stays."""
    found = analysed(system)
    if found is None:
        return
    for whole in (views.privacy_view(PathsToLeaks(found)), views.ros_view(found)):
        small, said = legible(whole, 1)
        same = (small.boxes, small.lines) == (whole.boxes, whole.lines)
        assert same == (not said)
        gone = len(names_of(whole.boxes)) - len(names_of(small.boxes))
        assert bool(gone) <= any(note.startswith("Not drawn") for note in said)
        if whole.view == PRIVACY:
            for finding in found.findings:
                kept = {element.name for element in finding.witness} <= names_of(small.boxes)
                assert finding.dismissed or kept


def test_the_command_draws_the_legible_picture_and_all_of_it_with_all(cli: Cli) -> None:
    small, whole = cli(*FLEET), cli(*FLEET, "--all")
    assert "Drawn smaller: 28 boxes for 57 elements" in small.stderr
    assert all(line in small.stdout for line in small.stderr.splitlines())
    assert whole.stderr == ""
    assert len(re.findall(r"id=n\d+", whole.stdout)) == 57
    assert len(re.findall(r"id=n\d+", small.stdout)) == 28


@pytest.mark.parametrize("options", [["--fold"], ["--loose-ends"], ["--around", "/camera", "--steps", "90"]])
def test_what_somebody_chose_is_drawn_as_it_was(cli: Cli, options: list[str]) -> None:
    """Options keep their meaning: nothing else is taken away."""
    done = cli(*FLEET, *options)
    assert (done.returncode, done.stderr) == (0, "")
    assert "Drawn smaller" not in done.stdout


def test_data_for_other_programs_is_whole(cli: Cli) -> None:
    done = cli(*FLEET, "--format", "graphml")
    assert done.stderr == ""
    assert nx.parse_graphml(done.stdout).number_of_nodes() == 57


def test_all_and_most_are_refused_together(cli: Cli) -> None:
    done = cli(*FLEET, "--all", "--most", "5")
    assert done.returncode == 2
    assert "--all draws everything" in done.stderr


def _laid_out(picture: Picture, direction: str) -> dict[str, tuple[float, float]]:
    graph = pygraphviz.AGraph(string=dot(picture, direction=direction))
    graph.layout("dot")
    places = {str(node): tuple(map(float, node.attr["pos"].split(","))) for node in graph.nodes()}
    graph.close()
    return {name: (x, -y) for name, (x, y) in places.items()}  # y grows downwards, as people read


@pytest.mark.parametrize(("direction", "axis"), [("LR", 0), ("TB", 1)])
def test_sources_are_on_one_side_and_leaks_on_the_other(direction: str, axis: int) -> None:
    picture = views.privacy_view(PathsToLeaks(care_home().analysis))
    at = _laid_out(picture, direction)
    where = {box.key: at[picture.keys[box.key]][axis] for box in picture.boxes}
    places = {look: {where[box.key] for box in picture.boxes if box.look == look} for look in ("source", "leak")}
    assert len(places["source"]) == len(places["leak"]) == 1
    assert places["source"] == {min(where.values())}
    assert places["leak"] == {max(where.values())}


@pytest.mark.parametrize("direction", ["LR", "TB"])
@pytest.mark.parametrize("name", pictures())
def test_the_legend_stands_below_the_picture_in_the_shapes_that_it_explains(name: str, direction: str) -> None:
    picture = pictures()[name]
    at = _laid_out(picture, direction)
    drawn = [y for key, (_, y) in at.items() if key.startswith("n")]
    legend = [y for key, (_, y) in at.items() if key.startswith("l")]
    assert max(drawn) < min(legend)
    graph = pygraphviz.AGraph(string=dot(picture, direction=direction))
    shapes = {node.attr["label"]: node.attr["shape"] for node in graph.nodes() if node.startswith("l")}
    graph.close()
    for kind in {box.kind for box in picture.boxes}:
        assert shapes[kind.replace("-", " ")] == SHAPES[kind].graphviz[0]
    assert picture.view in (ROS, PRIVACY)


def test_title_and_verdict_stand_on_top(tmp_path: Path, cli: Cli) -> None:
    file = tmp_path / "picture.svg"
    cli(*FLEET, "-o", file)
    words = re.findall(r"<text[^>]* y=\"([-\d.]+)\"[^>]*>([^<]*)<", file.read_text("utf-8"))
    top = min(words, key=lambda word: float(word[0]))[1]
    assert top.replace("\xa0", " ").endswith("data can get out")
