"""What a decision remembers, and what of it has changed since (rule S10)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from rosprivacy.analysis.remembered import About, as_written, change_text, changes

THEN = About("declared", ("/a", "/b"), 2, frozenset({"r1", "r2"}))


@pytest.mark.parametrize(
    ("now", "what", "before", "today"),
    [
        (replace(THEN, view="enforced"), "view", "declared", "enforced"),
        (replace(THEN, path=("/a", "/x", "/b")), "path", "/a -> /b", "/a -> /x -> /b"),
        (replace(THEN, disjoint_paths=3), "disjoint_paths", "2", "3"),
        (replace(THEN, robots=frozenset({"r1", "r2", "r3"})), "robots", "2", "3, +r3"),
        (replace(THEN, robots=frozenset({"r1"})), "robots", "2", "1"),
        (replace(THEN, robots=frozenset({"r1", "r3"})), "robots", "2", "2, +r3"),
    ],
)
def test_each_thing_that_changes_is_told(now: About, what: str, before: str, today: str) -> None:
    (change,) = changes(THEN, now)
    assert (change.aspect, change.before, change.now) == (what, before, today)
    assert change_text([change]).endswith(" now")


def test_nothing_is_told_where_nothing_changed_or_nothing_is_known() -> None:
    assert changes(THEN, THEN) == ()
    assert changes(None, THEN) == changes(THEN, None) == ()
    less: list[dict[str, Any]] = [{"view": ""}, {"path": ()}, {"disjoint_paths": 0}, {"robots": frozenset()}]
    for unknown in less:
        assert changes(replace(THEN, **unknown), THEN) == ()


def test_of_many_robots_that_joined_some_are_named_and_the_rest_counted() -> None:
    (change,) = changes(THEN, replace(THEN, robots=THEN.robots | {f"s{n}" for n in range(9)}))
    assert change.now == "11, +s0, +s1, +s2, +s3, +s4, +4"


def test_a_robot_that_was_not_there_is_not_known() -> None:
    assert THEN.knew(("r1", "r2"))
    assert THEN.knew(("r1", ""))  # a leak on no robot
    assert not THEN.knew(("r3", ""))
    assert not THEN.knew(("r1", "r3"))
    assert About().knew(("r3", "r3"))


def test_what_is_written_is_what_is_known() -> None:
    assert as_written(THEN) == {
        "view": "declared", "path": ["/a", "/b"], "disjoint_paths": 2, "robots": ["r1", "r2"],
    }  # fmt: skip
    assert as_written(About()) == {}
