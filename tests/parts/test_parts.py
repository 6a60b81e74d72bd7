"""A fleet in parts against the same in one graph: whatever travels between parts, the answer is the same.

Here the parts are in a list; ``test_spark.py`` has them on Spark.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.parts import distributed
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.fleet_files import policy, write
from tests.helpers.joined_fleets import JoinedFleet, joined_fleets
from tests.helpers.parts import FLEET, documents, fleet_file, fleet_of_two, in_list, same, scattered
from tests.helpers.paths import ROOT
from tests.helpers.random_fleets import Case, fleets
from tests.helpers.written_systems import Written, written

if TYPE_CHECKING:
    from rosprivacy.result import Result

__all__ = ["fleet_file"]


@given(fleets())
def test_in_parts_it_is_the_same(case: Case) -> None:
    same(case, scattered)


@given(fleets())
def test_several_units_are_one_part(case: Case) -> None:
    same(case, partial(scattered, size=2))
    same(case, partial(scattered, size=100))


@given(fleets())
def test_however_few_robots_are_shown_all_are_counted(case: Case) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distributed, "MOST_SHOWN", 1)
        same(case, scattered)


@pytest.mark.parametrize("size", [1, 3])
def test_a_fleet_of_all_sorts(fleet_file: str, size: int) -> None:
    documents(fleet_file, partial(in_list, size=size))


def test_the_example(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples" / "fleet")
    documents("fleet.yaml", in_list)


@given(written(), written())
def test_the_document_of_random_fleets(tmp_path_factory: pytest.TempPathFactory, one: Written, two: Written) -> None:
    """Findings, patterns, assumptions, diagnostics and verdict are those in memory."""
    with fleet_of_two(tmp_path_factory, one, two) as file:
        if file:
            documents(file, in_list)


@given(joined_fleets())
def test_the_document_of_random_fleets_of_all_sorts(
    tmp_path_factory: pytest.TempPathFactory, fleet: JoinedFleet
) -> None:
    """Alone, alike, in one domain, as infrastructure; joined by what they share, and from robot to robot."""
    with chdir(tmp_path_factory.mktemp("fleet")):
        file = fleet.write(Path())
        try:
            answer_fleet(file, Settings())
        except InputErrors:
            return
        documents(file, in_list)
        documents(file, partial(in_list, size=3))


def test_no_flow_is_missed_that_begins_or_ends_on_robots_that_are_not_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of what all share, and of robots that are shown, nobody reads that no flow leads there, or that nobody reads."""
    monkeypatch.chdir(tmp_path)
    write("eye.xml", policy("camera>/image", "uplink></image", "out<x"))
    write("plain.xml", policy("node>/state"))
    write("eye.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: conduit, /out: {leak: [Video]}}\n")
    write("plain.yaml", "labels: 1\nelements: {disk: {kind: storage, country: DE, retention: P3D}}\n")
    write(
        "f.yaml",
        "fleet: 1\nrobots:\n  eye: {policies: eye.xml, labels: eye.yaml}\n"
        "  plain: {policies: plain.xml, labels: plain.yaml}\n"
        "  zoo: {policies: plain.xml, labels: plain.yaml, domain: zoo}\n"
        "elements: {bucket: {kind: storage, country: DE, retention: P3D}}\n"
        'flows: [{from: "zoo:/node", to: bucket}, {from: "zoo:/node", to: "*:disk"}, '
        '{from: "eye:/uplink", to: "eye:/out"}]\n',
    )
    documents("f.yaml", in_list)
    monkeypatch.setattr(distributed, "MOST_WHOLE", 0)
    assert [row for row in in_list("f.yaml").document()["unknown_ends"] if row["unknown"] == "flow"] == []


def test_what_lies_behind_on_a_robot_that_is_not_shown_is_not_worked_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Voice that the desk drops would get by the hub to other robots, of which one is shown, where all is reviewed."""
    monkeypatch.chdir(tmp_path)
    write("one.xml", policy("mic>/sound<", "desk></sound"))
    write("two.xml", policy("inbox>/mail<", "printer></mail"))
    write("one.yaml", "labels: 1\nnodes: {/mic: {source: [Voice]}, /desk: {sanitizer: {Voice: drop}}}\n")
    write("two.yaml", "labels: 1\nnodes: {/inbox: conduit, /printer: conduit}\nchannels: {/mail: sensitive}\n")
    write("zwei.yaml", "labels: 1\n")
    write(
        "f.yaml",
        "fleet: 1\nrobots:\n  one: {policies: one.xml, labels: one.yaml}\n"
        "  two: {policies: two.xml, labels: two.yaml}\n  zwei: {policies: two.xml, labels: zwei.yaml}\n"
        "elements: {hub: {kind: side-channel, conduit: [PersonalData]}}\n"
        'flows: [{from: "one:/desk", to: hub}, {from: hub, to: "*:/inbox"}]\n',
    )
    documents("f.yaml", in_list)

    def dropped(answer: Result) -> Any:
        (row,) = (row for row in answer.document()["taken_away"] if row["by"] == "sanitizer")
        return row["leak"], row["open"] and row["open"]["name"], row["perhaps"]

    assert dropped(answer_fleet("f.yaml", Settings())) == (None, "/inbox", False)
    monkeypatch.setattr(distributed, "MOST_WHOLE", 0)
    assert dropped(in_list("f.yaml")) == (None, None, True)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('wall_*:/receiver"', 'wall_*:/recever"'),
        ("to: cloud}", "to: clod}"),
        ("odd:/uplink", "od:/uplink"),
        ("base:/screen", "/screen"),
        ("policies: hall.xml", "policies: wall.xml"),
    ],
)
def test_bad_fleets_are_refused_alike(fleet_file: str, old: str, new: str) -> None:
    """Also what only the parts know: names that are on no robot, labels that name what is not there."""
    write(fleet_file, FLEET.replace(old, new, 1))
    refused_alike(fleet_file)


def refused_alike(file: str) -> None:
    problems = []
    for run in (lambda name: answer_fleet(name, Settings()), in_list):
        with pytest.raises(InputErrors) as caught:
            run(file)
        problems.append(str(caught.value))
    assert problems[0] == problems[1]


def test_labels_that_contradict_each_other_are_refused_alike(fleet_file: str) -> None:
    write("odd.yaml", "labels: 1\nnodes: {/camera: conduit}\n")
    write("eye.yaml", "labels: 1\nnodes: {/camera: {source: [Video], sanitizer: {Video: drop}}}\n")
    refused_alike(fleet_file)


def test_a_flow_that_is_stated_twice_with_different_limits_is_refused(fleet_file: str) -> None:
    """A hub would lead around what the label file says; in memory both hold."""
    write(
        "eye.yaml",
        Path("eye.yaml").read_text("utf-8")
        + "elements: {disk: {kind: storage}}\nflows: [{from: /uplink, to: disk, never: [Video]}]\n",
    )
    write(fleet_file, FLEET + '  - {from: "*:/uplink", to: "*:disk"}\n')
    with pytest.raises(InputErrors, match=r"f.yaml:25: a flow within a robot, of which a label file says more"):
        in_list(fleet_file)


OUTSIDE = "/x/clock"  # a standard channel that is not in its standard place


@pytest.mark.parametrize("size", [1, 3])
@pytest.mark.parametrize("channel", [OUTSIDE, "/clock"])
@pytest.mark.parametrize("place", ["robot", "element", "other robot"])
def test_what_a_shipped_file_closes_breaks_the_verdict_in_parts_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, channel: str, size: int
) -> None:
    """Rules S11 and S13: of whatever robot it is, and wherever the leak lies behind it."""
    monkeypatch.chdir(tmp_path)
    labels = "labels: 1\nnodes: {/camera: {source: [Video]}, /viewer: conduit, /uplink: {leak: LEAK}}\n"
    labels += "channels: {/video: sensitive}\n"
    write("plain.xml", policy("/camera>/video", "/viewer</video", "/uplink<x"))
    write("clock.xml", policy(f"/camera>/video,{channel}", "/viewer</video", f"/uplink<{channel}"))
    write("out.xml", policy("/out<x"))
    write("leak.yaml", labels.replace("LEAK", "[Video]"))
    write("none.yaml", labels.replace("{leak: LEAK}", "conduit"))
    write("out.yaml", "labels: 1\nnodes: {/out: {leak: [Video]}}\n")
    last = "leak" if place == "robot" else "none"
    robots = (
        "  z1: {policies: clock.xml, labels: LAST.yaml}\n  z2: {policies: clock.xml, labels: [LAST.yaml, own.yaml]}\n"
    )
    write("own.yaml", "labels: 1\nlimits: {Video: P7D}\n")
    text = f"fleet: 1\nrobots:\n  a: {{policies: plain.xml, labels: leak.yaml}}\n{robots.replace('LAST', last)}"
    text += "  y: {policies: out.xml, labels: out.yaml}\n"
    if place == "element":
        text += 'elements: {cloud: {kind: external-system, country: DE}}\nflows: [{from: "z*:/uplink", to: cloud}]\n'
    elif place == "other robot":
        text += 'flows: [{from: "z*:/uplink", to: "y:/out"}]\n'
    write("f.yaml", text)
    expected = Verdict.UNDETERMINED if channel == OUTSIDE else Verdict.NO_LEAK_FOUND
    for result in (answer_fleet("f.yaml", Settings()), in_list("f.yaml", size)):
        assert result.analysis.verdict is expected
        found = [doubt for doubt in result.doubts if doubt.breaks]
        assert {doubt.name for doubt in found} == ({"standard-closes"} if channel == OUTSIDE else set())
        assert {doubt.element.name for doubt in found if doubt.element} <= {channel}
