"""A look ends with what is there then, whatever ends it: nothing that came shortly before is lost (rule S16)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.policies.observed_metadata import STILL_CHANGING
from rosprivacy.ingest.running.doors import Pace, polled
from tests.helpers.observed import looked

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.running.observation import Observation

SLOW = Pace(told_after=(60,), settled=60)


def look(news: Iterator[bool], stops: Iterator[bool], seconds: float | None = None) -> list[tuple[str, list[str]]]:
    """The nodes and gaps that are told; a node that waits for something is told at the end only."""

    def seen(at_the_end: bool) -> Observation:  # noqa: FBT001 - as it is called
        return looked("/late") if at_the_end else looked("/early")

    told = polled(lambda: next(news), seen, SLOW, seconds, lambda _: next(stops))
    return [(one.nodes[0].name, list(one.all_gaps)) for one in told]


def test_who_stops_a_look_gets_what_still_waits_and_that_it_still_changed() -> None:
    assert look(iter([True, False]), iter([False, True])) == [("/late", [STILL_CHANGING])]


def test_where_nothing_has_come_nothing_changes() -> None:
    assert look(iter([False]), iter([True])) == [("/late", [])]


@pytest.mark.parametrize("seconds", [0, -1])
def test_a_look_of_no_time_tells_its_end(seconds: float) -> None:
    assert look(iter([]), iter([]), seconds) == [("/late", [])]


def test_what_is_quiet_is_told_before_the_end() -> None:
    at_once = Pace(told_after=(-1, -1), settled=-1)
    news, stops = iter([True, False, False, False]), iter([False, False, False, True])
    told = polled(lambda: next(news), lambda end: looked(f"/{end}"), at_once, None, lambda _: next(stops))
    assert [one.nodes[0].name for one in told] == ["/False", "/False", "/True"]
