"""Flows of meetings are those that are stored, with the same numbers, whoever asks for them and how."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.many_flows import MATCHES, Flows, Meeting, Right, leaving, number, one_by_one, parted
from rosprivacy.analysis.model import Flow, Place

SOME = st.sets(st.integers(0, 9), max_size=10)


@st.composite
def flows(draw: st.DrawFn) -> tuple[Flows, tuple[Flow, ...]]:
    """Flows with meetings that share no pair, and the same flows stored."""
    free = {(a, b) for a in range(10) for b in range(10)}
    meetings = []
    for _ in range(draw(st.integers(1, 3))):
        written, read = (tuple(sorted(draw(SOME))) for _ in range(2))
        of = draw(st.sampled_from(("", "written", "read")))
        of_written, of_read = (
            tuple(Right(f"{side} {vertex}") for vertex in ends) if of == side else ()
            for side, ends in (("written", written), ("read", read))
        )
        meeting = Meeting(written, read, of_written, of_read)
        if meeting.size and free.issuperset(meeting.pairs()):
            free.difference_update(meeting.pairs())
            meetings.append(meeting)
    roles = st.sets(st.sampled_from(("publish", "subscribe", MATCHES)), min_size=1)
    stored = (
        [Flow(*ends, role) for ends in draw(st.sets(st.sampled_from(sorted(free)))) for role in draw(roles)]
        if free
        else []
    )
    every = [*stored, *(_flow(meeting, *pair) for meeting in meetings for pair in meeting.pairs())]
    first, all_ = (tuple(sorted(some, key=lambda f: (f.source, f.target, f.role))) for some in (stored, every))
    return Flows(first, tuple(meetings)), all_


def _flow(meeting: Meeting, source: int, target: int) -> Flow:
    role = f"written {source}" if meeting.of_written else f"read {target}" if meeting.of_read else MATCHES
    return Flow(source, target, role)


@given(flows())
def test_flows_of_meetings_are_as_if_they_were_stored(pair: tuple[Flows, tuple[Flow, ...]]) -> None:
    some, stored = pair
    assert len(some) == len(stored)
    assert [some[at] for at in range(len(stored))] == list(some) == list(stored)
    assert some == stored
    assert not stored or some[-1] == stored[-1]
    assert some[1:3] == stored[1:3]
    assert leaving(some) == leaving(stored)
    with pytest.raises(IndexError):
        some[len(stored)]


@given(flows(), st.sets(st.integers(0, 99)))
def test_each_flow_is_told_by_itself_or_in_one_meeting(pair: tuple[Flows, tuple[Flow, ...]], special: set[int]) -> None:
    some, stored = pair
    special = {at for at in special if at < len(stored)}
    own, meetings = parted(some, special)
    rows = dict(own)
    assert list(rows) == sorted(rows)
    assert special <= rows.keys()
    rows |= {number(some, *ends): _flow(meeting, *ends) for meeting in meetings for ends in meeting.pairs()}
    assert rows == dict(enumerate(stored))
    assert [some[at] for at in rows] == [stored[at] for at in rows]  # also after some were told by themselves


def test_more_pairs_than_the_bound_are_not_made_one_by_one() -> None:
    meeting = Meeting(tuple(range(100)), tuple(range(100, 200)))
    some = Flows((), (meeting,), Bounds(flows=9_999), Place("policy.xml", 7))
    assert len(some) == 10_000
    assert some[9_999] == Flow(99, 199, MATCHES)
    for asking in (list, one_by_one, lambda flows: parted(flows, range(0, 10_000, 101))):
        with pytest.raises(InputErrors, match=r"^policy.xml:7: more than the bound of 9,999 flows .* --bound flows=N$"):
            asking(some)
