"""Bounds are set by name; what is above one is refused with the number, the bound and how to raise it."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.bounds import BOUNDS, COUNTED, Bounds, Tally
from rosprivacy.analysis.errors import FleetError, InputErrors
from rosprivacy.analysis.model import Place


def test_bounds_are_set_by_name() -> None:
    assert Bounds.raised([]) == BOUNDS
    assert Bounds.raised(["robots=7", "name=8", "robots=9"]) == Bounds(robots=9, name=8)


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("robot=7", "--bound: 'robot' is none of name, "),
        ("robot=7", "; did you mean robots?"),
        ("Robots=7", "; did you mean robots?"),
        ("", "--bound: '' is none of "),
        ("\x1b[2J=1", "--bound: '\\\\x1b[2J' is none of "),
        ("robots", "--bound: 'robots' sets no bound; write a whole number above 0, as in robots=1000"),
        ("robots=", "'robots=' sets no bound"),
        ("robots=0", "'robots=0' sets no bound"),
        ("robots=-1", "'robots=-1' sets no bound"),
        ("robots=1e9", "'robots=1e9' sets no bound"),
        ("robots=1_000", "'robots=1_000' sets no bound"),
        ("robots=٣", "sets no bound"),
        ("robots=" + "9" * 10_000, "sets no bound"),
    ],
)
def test_what_sets_none_is_refused(written: str, message: str) -> None:
    with pytest.raises(InputErrors) as refused:
        Bounds.raised([written])
    (line,) = str(refused.value).splitlines()
    assert message in line


def test_all_that_is_wrong_is_told_at_once() -> None:
    with pytest.raises(InputErrors) as refused:
        Bounds.raised(["robot=7", "name=x"])
    assert len(refused.value.errors) == 2


@pytest.mark.parametrize("name", COUNTED)
def test_a_refusal_names_the_number_the_bound_and_the_option(name: str) -> None:
    what, hint = Bounds().refusal(name, 10**17)
    assert what.startswith("100,000,000,000,000,000 ")
    assert f"more than the bound of {getattr(BOUNDS, name):,}" in what
    assert hint.endswith(f"raise it with --bound {name}=N")


def test_a_tally_ends_above_its_bound_and_not_at_it() -> None:
    tally = Tally(Bounds(robots=3), "robots", FleetError)
    tally.add(3, Place("f.yaml", 1))
    with pytest.raises(InputErrors) as refused:
        tally.add(1, Place("f.yaml", 2))
    line = "f.yaml:2: more than the bound of 3 robots in the fleet; raise it with --bound robots=N"
    assert str(refused.value) == line
    assert isinstance(refused.value.errors[0], FleetError)
