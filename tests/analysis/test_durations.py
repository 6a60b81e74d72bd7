"""Durations are read as ISO 8601 writes them and compared from every day on from which they can differ."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.durations import parse
from tests.helpers.brute import longer

DURATIONS = st.builds("P{}{}".format, st.integers(0, 800), st.sampled_from("DMY"))


@pytest.mark.parametrize(
    ("ours", "theirs", "is_longer"),
    [
        ("P30D", "P30D", False),
        ("P31D", "P30D", True),
        ("P12M", "P1Y", False),
        ("P52W", "P1Y", False),
        ("P53W", "P1Y", True),
        ("PT24H", "P1D", False),
        ("PT24H1S", "P1D", True),
        ("P1M", "P31D", False),  # never longer
        ("P1M", "P30D", True),  # in January
        ("P30D", "P1M", True),  # in February
        ("P28D", "P1M", False),
        ("P1Y", "P365D", True),  # in a leap year
        ("P1Y", "P366D", False),
        ("PT0S", "PT0S", False),
        ("P0.5Y", "P6M", False),
    ],
)
def test_how_long_is_longer(ours: str, theirs: str, is_longer: bool) -> None:  # noqa: FBT001 - a column
    assert parse(ours).can_be_longer(parse(theirs)) is is_longer


@given(DURATIONS, DURATIONS)
def test_four_days_tell_as_much_as_all_of_400_years(ours: str, theirs: str) -> None:
    assert parse(ours).can_be_longer(parse(theirs)) == longer(ours, theirs)


@given(DURATIONS, DURATIONS, DURATIONS)
def test_two_durations_are_added(ours: str, more: str, theirs: str) -> None:
    assert (parse(ours) + parse(more)).can_be_longer(parse(theirs)) == longer(f"{ours} {more}", theirs)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("30 days", "not an ISO 8601 duration"),
        ("30", "not an ISO 8601 duration"),
        ("", "not an ISO 8601 duration"),
        ("P", "not an ISO 8601 duration"),
        ("PT", "not an ISO 8601 duration"),
        ("P1H", "not an ISO 8601 duration"),
        ("P1DT", "not an ISO 8601 duration"),
        ("p30d", "not an ISO 8601 duration"),
        ("-P1D", "not an ISO 8601 duration"),
        ("P1.5M", "a part of a month"),
        ("P1001Y", "longer than a thousand years"),
        ("P9999999999D", "longer than a thousand years"),
        ("P99999999999Y", "longer than a thousand years"),
    ],
)
def test_what_is_no_duration(text: str, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        parse(text)
