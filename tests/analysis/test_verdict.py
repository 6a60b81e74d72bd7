"""Rule S12 stands once: of a system, and of each of its robots."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.answer import Analysis, Verdict, robot_verdicts
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.doubts import judged
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.model import UNREAD_FILE, Doubt, Element, Place
from tests.helpers.systems import HIERARCHY, System, statement, systems

UNREAD = (Doubt(UNREAD_FILE, place=Place("part.xml", 3), message="not read"),)


def one_robot(analysis: Analysis, *, unread: bool = False) -> Verdict:
    return robot_verdicts(analysis, ["r"], lambda _: "r", ["r"] if unread else [])["r"]


@pytest.mark.parametrize("leak", [False, True])
@pytest.mark.parametrize("is_open", [False, True])
@pytest.mark.parametrize("known", [False, True])
def test_a_finding_decides_then_what_is_open_then_what_is_known(*, leak: bool, is_open: bool, known: bool) -> None:
    expected = "leak" if leak else "undetermined" if is_open or not known else "no-leak-found"
    assert str(Verdict.of(leak=leak, is_open=is_open, grounded=known)) == expected


@given(systems(), st.booleans(), st.booleans())
def test_the_verdict_on_the_only_robot_is_that_on_the_system(system: System, accepted: bool, unread: bool) -> None:  # noqa: FBT001
    options = Options(accepts=(lambda _: True) if accepted else None)
    try:
        analysis = judged(system.analyse(options), UNREAD if unread else ())
    except InputErrors:
        return
    assert one_robot(analysis, unread=unread) is analysis.verdict


def test_what_is_accepted_is_no_leak_of_a_robot_either() -> None:
    """The case that differed: the database's two copies of the rule did not know that a finding can be accepted."""
    system = System(2, 1, [(0, 2), (2, 1)], {0: [statement("source", "Face")], 1: [statement("leak", "Face")]}, {})
    system.said[2] = [statement("sensitive", "Face")]
    assert one_robot(system.analyse()) is Verdict.LEAK
    analysis = system.analyse(Options(accepts=lambda _: True))
    assert [finding.accepted for finding in analysis.findings] == [True]
    assert one_robot(analysis) is analysis.verdict is Verdict.NO_LEAK_FOUND
    assert one_robot(analysis, unread=True) is Verdict.UNDETERMINED


@given(systems(), st.data())
def test_a_system_leaks_if_one_of_its_robots_does(system: System, data: st.DataObject) -> None:
    """And nothing is said to have no leak where one of its robots that data reaches is not settled."""
    graph = system.graph()
    robots = [data.draw(st.sampled_from("ab")) for _ in graph.elements]
    graph = replace(graph, elements=tuple(replace(e, robot=r) for e, r in zip(graph.elements, robots, strict=True)))
    try:
        analysis = analyse(graph, system.bound(), HIERARCHY)
    except InputErrors:
        return
    told = robot_verdicts(analysis, "ab", lambda element: element.robot)
    assert (analysis.verdict is Verdict.LEAK) == (Verdict.LEAK in told.values())
    reached = {carried.element.robot for carried in analysis.carried}
    settled = bool(reached) and all(told[robot] is Verdict.NO_LEAK_FOUND for robot in reached)
    assert (analysis.verdict is Verdict.NO_LEAK_FOUND) == settled


def test_a_robot_that_no_data_reaches_is_not_settled() -> None:
    said = {0: [statement("source", "Face"), statement("no-leak")], 1: [statement("sensitive")]}
    analysis = System(1, 1, [(0, 1)], said, {}).analyse()
    told = robot_verdicts(analysis, ["", "other"], lambda element: element.robot)
    assert told == {"": Verdict.NO_LEAK_FOUND, "other": Verdict.UNDETERMINED}
    assert Element("node", "/n0") in {carried.element for carried in analysis.carried}
