"""Settings of programs: which channels they have to leave out, and what is written for them."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain

import pytest
from hypothesis import given

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.mitigation.channel_settings import (
    BRIDGE,
    COMMAND,
    LEFT_OUT,
    OTHERS,
    PARAMETER,
    RECORDER,
    SET,
    ChannelSetting,
    Program,
    RecognisedProgram,
    left_out,
)
from rosprivacy.analysis.model import Confidence
from tests.helpers.systems import HIERARCHY, System, analysed, systems


def setting(kind: str, names: str = LEFT_OUT, between: str = ", ") -> ChannelSetting:
    return ChannelSetting(kind, PARAMETER, SET, "[{names}]", names, "{name}", between, from_root=True, note="")


ALL_KINDS = Program("any", "any", BRIDGE, (setting("topic"), setting("topic", OTHERS), setting("service")), ())


@given(systems())
def test_without_the_channels_that_are_left_out_the_findings_are_gone(random: System) -> None:
    """Every node is taken for a program; what begins there, or comes past channels, no setting of it can keep away."""
    found = analysed(random)
    if found is None:
        return
    elements = found.graph.elements
    ends = [(elements[flow.source], elements[flow.target]) for flow in found.graph.flows]
    direct = {target for source, target in ends if not source.is_channel or source.leg == "request"}
    findings = [f for f in found.findings if f.leak.is_node and f.leak not in direct and f.leak != f.source]
    programs = [
        RecognisedProgram(vertex, ALL_KINDS, Confidence.MAY, "") for vertex, e in enumerate(elements) if e.is_node
    ]
    rows = left_out(found, findings, programs)
    assert {row.element for row in rows} == {finding.leak for finding in findings}
    cut = {(channel, row.element) for row in rows for channel in row.channels}
    gone = {i for i, flow in enumerate(found.graph.flows) if (elements[flow.source], elements[flow.target]) in cut}
    left = replace(random, edges=[edge for i, edge in enumerate(random.edges) if i not in gone], never={})
    kept = {i: flow for i, flow in enumerate(random.edges) if i not in gone}
    number = {edge: i for i, edge in enumerate(left.edges)}
    left.never = {number[edge]: random.never[i] for i, edge in kept.items() if i in random.never}
    after = analyse(left.graph(), left.bound(), HIERARCHY)
    assert not {f.id for f in after.findings} & {f.id for f in findings}


@given(systems())
def test_what_is_left_out_and_the_others_are_all_that_a_node_uses(random: System) -> None:
    found = analysed(random)
    if found is None:
        return
    elements = found.graph.elements
    programs = [
        RecognisedProgram(vertex, ALL_KINDS, Confidence.MAY, "") for vertex, e in enumerate(elements) if e.is_node
    ]
    for row in left_out(found, found.findings, programs):
        flows = [flow for flow in found.graph.flows if row.element in (elements[flow.source], elements[flow.target])]
        ends = chain.from_iterable((elements[flow.source], elements[flow.target]) for flow in flows)
        topics = {e.name for e in ends if e.kind == "topic" and not e.pattern}
        lists = [set(filter(None, one.text.strip("[]").split(", "))) for one in row.settings]
        assert lists[0] | lists[1] == topics
        assert not lists[0] & lists[1]
        assert lists[0] == {channel.name for channel in row.channels if channel.kind == "topic"}


@pytest.mark.parametrize(
    ("written", "between", "text"),
    [(True, " ", "[/a/b /c]"), (False, "|", "[a/b|c]")],
)
def test_names_are_written_as_the_program_takes_them(written: bool, between: str, text: str) -> None:  # noqa: FBT001
    one = setting("topic", between=between)._replace(from_root=written)
    assert one.written(["/a/b", "/c"], ["/d"]) == text


def test_bridges_are_told_before_recorders() -> None:
    from rosprivacy.analysis.example import factory

    found = analyse(*factory())
    recorder = Program("bag", "bag", RECORDER, (setting("topic")._replace(where=COMMAND),), ())
    number = {element.name: vertex for vertex, element in enumerate(found.graph.elements)}
    archive = RecognisedProgram(number["/archive"], recorder, Confidence.MAY, "")
    disk = [finding for finding in found.findings if finding.leak.name == "disk"]
    assert [row.element.name for row in left_out(found, disk, [archive])] == ["/archive"]
    assert left_out(found, disk, []) == ()
    assert left_out(found, [], [archive]) == ()
