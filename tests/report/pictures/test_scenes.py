"""What is drawn of a system, seen from an element: whole paths, no more boxes than asked for, the rest counted."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.findings.witness import WhyCarried, Witness
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.pictures.joined import Joined, choose
from rosprivacy.report.pictures.looks import ALLOWED, UNTOUCHED
from rosprivacy.report.pictures.scenes import Scenes, folded_by_place
from tests.helpers.graphs import care_home, factory
from tests.helpers.more_systems import wildcards
from tests.helpers.pictures import names_of
from tests.helpers.systems import analysed, systems

if TYPE_CHECKING:
    from tests.helpers.systems import System


@given(st.one_of(systems(), wildcards()), st.integers(1, 12))
def test_paths_are_drawn_whole_and_the_rest_is_counted(system: System, most: int) -> None:
    """Rule S11: of each element as focus."""
    analysis = analysed(system)
    if analysis is None:
        return
    scenes, why = Scenes(analysis), WhyCarried(analysis)
    every = {element.identity for element in analysis.graph.elements}
    standard = {analysis.graph.elements[vertex].identity for vertex in analysis.spread.standard}
    for element in analysis.graph.elements:
        picture = scenes.of(element.identity, limit=most).picture
        drawn = {(box.robot, box.kind, name) for box in picture.boxes for name in box.names}
        assert element.identity in drawn
        asked = [c for one in analysis.open if one.element.identity == element.identity for c in one.categories]
        lengths = [len(path.steps) for c in asked or analysis.emitted if (path := why.path(element, c))]
        numbered = {int(line.words): line for line in picture.lines if line.words}
        if lengths:
            assert len(numbered) <= min(lengths)  # another leg of the element can be nearer
            steps = [numbered[number] for number in range(1, len(numbered) + 1)]
            assert all(one.target == other.source for one, other in pairwise(steps))
            if steps and steps[-1].target != element.identity:  # the last step is on a line that was taken before
                assert (steps[-1].target, element.identity) in {(one.source, one.target) for one in steps}
        undrawn = len(every - standard - drawn)
        assert any(f"{undrawn} element" in note for note in picture.notes) == bool(undrawn)
        paths = {e.identity for c in analysis.emitted if (path := why.path(element, c)) for e in path.elements}
        leaks = max((len(finding.witness) for finding in analysis.findings), default=0)
        assert len(picture.boxes) <= max(most, len(paths) + leaks + 1)


@given(st.one_of(systems(), wildcards()))
def test_of_a_finding_its_own_path_is_numbered(system: System) -> None:
    """There may be a shorter one to the same place, from another source."""
    analysis = analysed(system)
    if analysis is None:
        return
    for finding in analysis.findings:
        way = Witness(finding.witness, finding.steps)
        picture = Scenes(analysis).of(finding.leak.identity, way=way).picture
        steps = list(pairwise(element.identity for element in finding.witness))
        numbered = {int(line.words): (line.source, line.target) for line in picture.lines if line.words}
        assert numbered == {n: ends for n, ends in enumerate(steps, 1) if steps.index(ends) == n - 1}


def test_the_paths_to_leaks_are_drawn_and_where_nothing_is_in_hand_nothing_else() -> None:
    analysis = factory(2).analysis
    picture = Scenes(analysis).of().picture
    on_paths = {element.name for finding in analysis.findings if not finding.dismissed for element in finding.witness}
    assert names_of(picture.boxes) == on_paths


def test_a_kind_that_is_switched_off_is_not_drawn() -> None:
    analysis = care_home().analysis
    names = names_of(Scenes(analysis).of(kinds={"Voice"}).picture.boxes)
    assert "/microphone" in names
    assert "/camera" not in names


def test_where_all_kinds_are_switched_off_none_is_drawn() -> None:
    scenes = Scenes(care_home().analysis)
    assert not scenes.of(kinds=()).picture.boxes
    picture = scenes.of(("", "node", "/camera"), kinds=()).picture
    assert all(box.look == UNTOUCHED for box in picture.boxes)
    assert not any(line.carries for line in (*picture.lines, *scenes.whole_system(kinds=()).picture.lines))


def test_where_nothing_leaks_it_is_drawn_where_data_goes_and_where_it_ends() -> None:
    picture = Scenes(factory(5).analysis).of().picture
    assert picture.boxes
    assert picture.title.startswith("Where ")


def test_an_element_that_no_data_gets_to_is_drawn_with_what_it_is_joined_to() -> None:
    scene = Scenes(care_home().analysis).of(("", "node", "/lidar"), kinds={"Voice"})
    box = next(box for box in scene.picture.boxes if box.key == scene.focus)
    assert box.look == UNTOUCHED
    assert "none of Voice gets there" in scene.picture.title
    assert any(line.look == ALLOWED for line in scene.picture.lines if scene.focus in (line.source, line.target))


@pytest.mark.parametrize("focus", [("", "node", "/nobody"), None])
def test_an_element_that_is_not_there_is_none(focus: tuple[str, str, str] | None) -> None:
    scenes = Scenes(factory(2).analysis)
    assert scenes.of(focus).focus is None
    assert scenes.of(focus).picture.boxes == scenes.of().picture.boxes


@given(st.one_of(systems(), wildcards()), st.integers(1, 12))
def test_a_whole_system_has_every_element_and_every_step_of_data(system: System, most: int) -> None:
    """Each element is a box, in a group, or a channel on a line; a line is there if and only if data goes so."""
    analysis = analysed(system)
    if analysis is None:
        return
    spread, elements = analysis.spread, analysis.graph.elements
    joined = Joined(analysis)
    every, _ = joined.elements()
    core = set(choose(joined, None, analysis.emitted, most).core)
    bits = sum(map(spread.forms_of, analysis.emitted))
    folded = folded_by_place(joined, core, bits, most, IN_ENGLISH)
    counted = sum(int(box.words[0].split()[0]) for box in folded.boxes)
    assert counted + len(folded.single) + len(core) + folded.channels == len(every | core)
    assert len(folded.boxes) + len(folded.single) <= most
    groups = {box.key[2]: box.key for box in folded.boxes}
    box_of = {key: key for key in (*core, *folded.single)}
    for element in elements:
        if not element.is_channel and element.identity not in box_of:
            level = "/" if element.is_node else f"/{element.kind}"
            box_of[element.identity] = groups.get(level) or groups["/"]
    steps = [(f.source, f.target) for index, f in enumerate(analysis.graph.flows) if spread.along(index) & bits]
    expected = set()
    for start in {v for v, _ in steps if elements[v].identity in box_of}:
        waiting, seen = [start], {start}
        while waiting:
            here = waiting.pop()
            for there in {b for a, b in steps if a == here}:
                ends = box_of[elements[start].identity], box_of.get(elements[there].identity)
                if ends[1] is None and there not in seen:
                    seen.add(there)
                    waiting.append(there)
                elif ends[1] is not None and ends[0] != ends[1]:
                    expected.add(ends)
    assert {(line.source, line.target) for line in folded.lines} == expected


def test_a_large_system_is_drawn_whole_in_groups() -> None:
    analysis = care_home().analysis
    small = Scenes(analysis).whole_system(limit=16).picture
    assert {box.kind for box in small.boxes} >= {"group"}
    assert len(small.boxes) <= 16
    large = Scenes(analysis).whole_system().picture
    standard = {analysis.graph.elements[vertex].identity for vertex in analysis.spread.standard}
    assert {box.key for box in large.boxes} == {e.identity for e in analysis.graph.elements} - standard
