"""The two views: what is in them, what is left out, and that what is left out is said.

``python -m tests.report.pictures.test_views`` writes the golden DOT files of ``cases/views`` anew.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import given

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.analysis.model import Element, Flow, FlowGraph, Grant, Place
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.pictures import narrow, views
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.pictures.exports import mermaid
from rosprivacy.report.pictures.views import overview
from tests.helpers.graphs import care_home, factory
from tests.helpers.paths import TESTS
from tests.helpers.pictures import hostile, names_of, pictures, ros
from tests.helpers.systems import System, analysed, index, statement, systems

if TYPE_CHECKING:
    from rosprivacy.report.pictures.picture import Picture

GOLDEN = TESTS / "cases" / "views"


def lines_of(picture: Picture) -> dict[tuple[str, str], str]:
    return {(line.source[2], line.target[2]): line.look for line in picture.lines}


@pytest.mark.parametrize("name", pictures())
def test_the_dot_is_that_of_the_golden_file(name: str) -> None:
    """Rule S14. What changed on purpose is written anew, and looked at."""
    assert dot(pictures()[name]) == (GOLDEN / f"{name}.dot").read_text("utf-8")


def test_the_ros_view_leaves_out_standard_channels_unless_they_are_asked_for() -> None:
    picture = ros(factory(2))
    assert picture.notes == ("Not drawn: 39 standard ROS channels",)
    assert len(views.ros_view(factory(2).analysis, standard=True).boxes) == len(picture.boxes) + 39


def test_the_two_sides_of_a_wildcard_are_one_box() -> None:
    sides = [Element("topic", "/*", side=side) for side in ("read", "write")]
    elements = (Element("node", "/a"), *sides, Element("topic", "/t"))
    flows = (Flow(0, 2, "publish"), Flow(1, 0, "subscribe"), Flow(2, 1, "matches"), Flow(2, 3, "matches"))
    system = System(1, 3, [], {}, {})
    system.graph = lambda: FlowGraph(elements, flows, (), ())  # type: ignore[method-assign]
    found = system.analyse()
    lines = lines_of(views.ros_view(found))
    assert lines == {
        ("/a", "/*"): "allowed",
        ("/*", "/a"): "allowed",
        ("/*", "/t"): "matches",
    }


def test_denied_lines_are_drawn_whether_or_not_something_allows_them() -> None:
    """Rule S5: a DENY that takes an ALLOW back, and one by itself."""
    care = care_home()
    lines = lines_of(ros(care))
    assert lines["/face_recognizer/faces", "/uplink"] == "denied"
    assert lines["/camera/image", "/recorder"] == "denied"
    place = Place("p.xml", 1)
    alone = Grant(False, "request", "service", "/notify_staff", "/e", "/display", place)
    both = lines_of(views.ros_view(care.analysis, [alone]))
    assert both["/display", "/notify_staff"] == both["/notify_staff", "/display"] == "denied"


def test_sanitizers_that_end_the_data_and_mundane_channels_are_gone_and_said() -> None:
    """The paper, II-B; the filter of run 5."""
    picture = views.privacy_view(PathsToLeaks(factory(5).analysis))
    assert not names_of(picture.boxes) & {"/filter", "/filtered_safety_video", "/new_pose", "/stop_arm"}
    assert any("/filter, which ends what comes to it" in note for note in picture.notes)
    assert any("carry none of it" in note for note in picture.notes)
    assert "no way out found" in picture.title


def test_what_gets_to_where_it_is_said_to_be_cleaned_is_drawn_and_ends_in_a_bar() -> None:
    """Raw video enters the node that talks to the cloud, and one label says that it stays there."""
    care = care_home().analysis
    shown = [
        views.privacy_view(PathsToLeaks(care)),
        views.finding_view(PathsToLeaks(care), care.findings[0]),
        overview(care, care.findings),
    ]
    for picture in shown:
        (line,) = (line for line in picture.lines if line.look == "cleaned")
        assert (line.source[2], line.target[2], line.carries) == ("/camera/image", "/uplink", ("Video",))
        assert [place.line for place in line.places] == [98]
        ends = f"{picture.keys[line.source]} -> {picture.keys[line.target]} "
        (drawn,) = (row for row in dot(picture).splitlines() if ends in row)
        assert "arrowhead=tee" in drawn
        assert "penwidth=0.8" in drawn
        assert "said to be cleaned there" in dot(picture)
        assert f"{picture.keys[line.source]} --x {picture.keys[line.target]}" in mermaid(picture)
    assert "cleaned" not in lines_of(views.privacy_view(PathsToLeaks(factory(2).analysis))).values()


def test_the_picture_of_a_finding_says_where_its_data_is_made() -> None:
    care = care_home().analysis
    titles = [views.finding_view(PathsToLeaks(care), finding).title for finding in care.findings]
    assert "made of Video of /camera at /face_recognizer" in titles[0]
    assert "How Voice can get from /microphone to /uplink (declared)" in titles


def test_findings_of_other_kinds_have_ways_and_words_of_their_own() -> None:
    """Rule S10: what is kept too long, what leaves the EEA; no label calls such a place a leak."""
    found = factory(2).analysis
    leak = found.findings[1]
    place = next(element for element in found.graph.elements if element.name == "/navigator")
    camera = next(element for element in found.graph.elements if element.name == "/robot_camera")
    kept = replace(leak, kind="storage-limitation", source=camera, leak=place, witness=(camera, place), steps=())
    picture = views.privacy_view(PathsToLeaks(replace(found, findings=(leak, kept))))
    box = next(box for box in picture.boxes if box.names == ("/navigator",))
    assert (box.look, box.words) == ("leak", ("kept without an end, or too long: Video",))
    assert lines_of(picture)["/robot_camera", "/robot_video"] == "way"


def test_a_denial_that_is_not_drawn_is_counted() -> None:
    alone = Grant(False, "publish", "topic", "/secret/*", "/e", "/display", Place("p.xml", 1))
    picture = views.ros_view(care_home().analysis, [alone])
    assert "Not drawn: 1 DENY without a channel of that very name" in picture.notes


def test_where_no_source_is_named_the_picture_says_that_it_says_nothing() -> None:
    system = System(2, 1, [(0, 2), (2, 1)], {1: [statement("leak", "Face")]}, {})
    picture = views.privacy_view(PathsToLeaks(system.analyse()))
    assert picture.title == IN_ENGLISH("picture.nothing")
    assert not picture.boxes


@given(systems())
def test_nothing_that_counts_is_missing_from_the_privacy_view(system: System) -> None:
    """What data goes on from or gets out at, by brute force; every open element; every step of every shortest way."""
    found = analysed(system)
    if found is None:
        return
    picture, number, brute = views.privacy_view(PathsToLeaks(found)), index(system), system.brute()
    drawn = {box.key: box for box in picture.boxes}
    present = brute.spread(brute.sources())
    expected = set()
    for element, vertex in number.items():
        here = {data for v, data in present if v == vertex}
        kept = {d for d in here if not brute.kills(vertex, d[0]) or (d[1] and brute.only_hides(vertex, d[0]))}
        goes_on = kept | {made for data in here for made in brute.made(vertex, data)} | set(brute.emitted(vertex))
        leaks = {c for c, _ in here if vertex in brute.nodes and brute.has(vertex, "leak", c)}
        if (here and goes_on) or leaks or element in {finding.leak for finding in found.findings}:
            expected.add(element.identity)
    assert set(drawn) == expected | {question.element.identity for question in found.open}
    for question in found.open:
        assert drawn[question.element.identity].open
    looks = {(line.source, line.target): line for line in picture.lines}
    for finding in found.findings:
        assert drawn[finding.leak.identity].look == "leak"
        for step in finding.steps:
            line = looks[step.source.identity, step.target.identity]
            assert finding.dismissed or line.look == "shortest"
            assert step.category in line.carries
    assert all(line.length for line in picture.lines if line.look in ("way", "shortest"))


@given(systems())
def test_every_step_of_a_finding_is_in_its_picture_however_small(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    made = views.FindingViews(PathsToLeaks(found))
    for finding in found.findings:
        whole = made.of(finding)
        small = views.bounded(narrow.folded(whole), 1)
        steps = {(step.source.name, step.target.name) for step in finding.steps}
        for picture in (whole, small):
            names = {box.key: box.names for box in picture.boxes}
            drawn = {(a, b) for line in picture.lines for a in names[line.source] for b in names[line.target]}
            assert steps <= drawn
        left = [note for note in small.notes if note.startswith("Not drawn")]
        before = narrow.folded(whole)
        assert bool(left) == ((small.boxes, small.lines) != (before.boxes, before.lines))
        assert {element.identity for element in finding.witness} <= {box.key for box in whole.boxes}
        assert {finding.source.name, finding.leak.name} <= names_of(small.boxes)


def test_channels_with_the_same_ends_are_one_box_that_keeps_all_names() -> None:
    whole = views.privacy_view(PathsToLeaks(hostile([f"/t{i}" for i in range(9)])))
    small = narrow.folded(whole)
    assert len(small.boxes) == 4  # the shortest way stays by itself
    assert names_of(small.boxes) == names_of(whole.boxes)
    assert "and 5 more" in dot(small)


def test_a_folded_wildcard_says_how_much_it_covers() -> None:
    picture = narrow.folded(ros(care_home()))
    box = next(box for box in picture.boxes if box.names == ("/camera/*",))
    assert box.words == ("covers 1 name",)
    assert not [line for line in picture.lines if line.look == "matches"]
    assert picture.notes[-1] == "Not drawn: lines from wildcards to what they cover"


def test_loose_ends_are_left_out_and_counted_but_never_a_wildcard() -> None:
    picture = narrow.without_loose_ends(ros(care_home()))
    assert "/camera/get_parameters" not in names_of(picture.boxes)
    assert "/camera/*" in names_of(picture.boxes)
    assert "Not drawn: 1 channel that no more than one node names, wildcards apart" in picture.notes


def test_a_neighbourhood_is_what_is_within_some_lines() -> None:
    picture = narrow.around(ros(factory(2)), ["/navigator"], 1)
    assert names_of(picture.boxes) == {"/navigator", "/robot_video", "/new_pose"}
    assert picture.notes[-1] == "Drawn: within 1 step of /navigator; 3 of 11 elements"


def test_a_wildcard_near_by_brings_those_who_use_it() -> None:
    picture = narrow.around(ros(care_home()), ["/blur"], 2)
    assert {"/camera/*", "/recorder"} <= names_of(picture.boxes)


def test_names_that_nothing_has_are_errors_with_the_nearest() -> None:
    with pytest.raises(DrawingError, match=r"--around: .*'/navigatr'; did you mean /navigator"):
        narrow.around(ros(factory(2)), ["/navigatr"], 1)
    with pytest.raises(DrawingError, match=r"--robot: there is no robot 'r2'"):
        narrow.of_robot(ros(factory(2)), "r2")


def test_a_finding_is_found_by_the_beginning_of_its_id() -> None:
    found = factory(2).analysis
    assert narrow.the_finding(found, "7ac677").leak.name == "/archive_server"
    for wrong in ("7ac", "ffff0000", ""):
        with pytest.raises(DrawingError, match=r"--finding: there is no finding .*such as"):
            narrow.the_finding(found, wrong)


def test_a_robot_is_drawn_with_what_it_is_joined_to() -> None:
    elements = (*(Element("node", "/n", r) for r in ("r1", "r2", "r3")), Element("topic", "/t"), Element("topic", "/u"))
    flows = (Flow(0, 3, "publish"), Flow(1, 4, "publish"), Flow(3, 1, "subscribe"), Flow(4, 2, "subscribe"))
    system = System(3, 2, [], {}, {})
    system.graph = lambda: FlowGraph(elements, flows, (), ())  # type: ignore[method-assign]
    picture = narrow.of_robot(views.ros_view(system.analyse()), "r1")
    assert {box.key for box in picture.boxes} == {("r1", "node", "/n"), ("", "topic", "/t")}


@pytest.mark.parametrize(
    ("by", "expected"),
    [("enclave", {"/care_home/planning": {"/navigator", "/cmd_vel"}}), ("namespace", {}), ("robot", {})],
)
def test_groups(by: str, expected: dict[str, set[str]]) -> None:
    """A channel is in a group if all that it is joined to are."""
    picture = narrow.grouped(ros(care_home()), by, care_home().analysis.graph.profiles)
    groups: dict[str, set[str]] = {}
    for box in picture.boxes:
        groups.setdefault(box.group, set()).update(box.names)
    assert all(names <= groups[f"enclave {group}"] for group, names in expected.items())
    assert "/camera/image" in groups[""]


def test_what_carries_a_category_can_be_chosen_in_the_ros_view() -> None:
    found = factory(2).analysis
    picture = narrow.carrying(views.ros_view(found), found)
    assert names_of(picture.boxes) == names_of(views.privacy_view(PathsToLeaks(found)).boxes)


if __name__ == "__main__":
    for name, picture in pictures().items():
        (GOLDEN / f"{name}.dot").write_text(dot(picture), "utf-8", newline="\n")
