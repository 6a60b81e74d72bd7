"""Names (rule S4): each row is one sentence of the SROS 2 policy semantics."""

import re
from fnmatch import fnmatchcase

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.policies.names import (
    covers,
    dds_names,
    endpoints,
    is_pattern,
    literal_prefix,
    matcher,
    overlaps,
    resolve,
)

EXPRESSIONS = st.text("ab/*?[]!-^", max_size=7)
NAMES = st.text("ab/-!^]", max_size=6)


@pytest.mark.parametrize(
    ("written", "namespace", "node", "full"),
    [
        ("/scan", "/robot", "lidar", "/scan"),  # absolute: as it is
        ("scan", "/", "lidar", "/scan"),  # relative: namespace + name
        ("scan", "/robot", "lidar", "/robot/scan"),
        ("~/state", "/robot", "lidar", "/robot/lidar/state"),  # private: namespace + node + rest
        ("~state", "/", "lidar", "/lidarstate"),  # no slash is added
        ("~", "/", "lidar", "/lidar"),
        (" scan ", "/", "lidar", "/ scan "),  # nothing is trimmed
        ("x", "", "lidar", "/x"),  # an empty namespace is the root
        ("x", "a", "lidar", "a/x"),  # a namespace without / is not repaired
    ],
)
def test_resolve(written: str, namespace: str, node: str, full: str) -> None:
    assert resolve(written, namespace, node) == full


def test_a_star_crosses_slashes_but_not_the_namespace() -> None:
    assert is_pattern("/robot/*")
    assert covers("/robot/*", "/robot/camera/image")
    assert not covers("/robot/*", "/robot2/camera")


@pytest.mark.parametrize(
    ("role", "kind", "writes", "reads"),
    [
        ("publish", "topic", {"rt/x"}, set()),
        ("subscribe", "topic", set(), {"rt/x"}),
        ("request", "service", {"rq/xRequest"}, {"rr/xReply"}),
        ("reply", "service", {"rr/xReply"}, {"rq/xRequest"}),
        (
            "call",
            "action",
            {f"rq/x/_action/{part}Request" for part in ("send_goal", "cancel_goal", "get_result")},
            {f"rr/x/_action/{part}Reply" for part in ("send_goal", "cancel_goal", "get_result")}
            | {"rt/x/_action/feedback", "rt/x/_action/status"},
        ),
    ],
)
def test_a_role_opens_these_dds_topics(role: str, kind: str, writes: set[str], reads: set[str]) -> None:
    opened = endpoints(role, kind, "/x")
    assert {e.dds for e in opened if e.writes} == writes
    assert {e.dds for e in opened if not e.writes} == reads


def test_execute_mirrors_call() -> None:
    call, execute = endpoints("call", "action", "/x"), endpoints("execute", "action", "/x")
    assert {(e.dds, e.leg, not e.writes) for e in call} == {(e.dds, e.leg, e.writes) for e in execute}


@pytest.mark.parametrize(
    ("role", "kind", "name", "legs"),
    [
        ("publish", "topic", "/x/_action/feedback", {(True, "response")}),
        ("subscribe", "topic", "/x/_action/status", {(False, "response")}),
        ("request", "service", "/x/_action/send_goal", {(True, "request"), (False, "response")}),
        ("reply", "service", "/x/_action/get_result", {(False, "request"), (True, "response")}),
    ],
)
def test_the_parts_of_an_action_are_folded_into_it(
    role: str, kind: str, name: str, legs: set[tuple[bool, str]]
) -> None:
    """Rule S3; generate_policy writes actions so."""
    opened = endpoints(role, kind, name)
    assert {(e.kind, e.name) for e in opened} == {("action", "/x")}
    assert {(e.writes, e.leg) for e in opened} == legs
    assert {e.dds for e in opened} <= {dds for leg in ("request", "response") for dds in dds_names("action", "/x", leg)}


@pytest.mark.parametrize(
    ("role", "kind", "name"),
    [
        ("publish", "topic", "/x/_action/other"),  # no part of an action
        ("publish", "topic", "/x/_action/send_goal"),  # a part, but of a service
        ("request", "service", "/x/_action/feedback"),
        ("publish", "topic", "/*/_action/feedback"),  # a wildcard stays one
    ],
)
def test_what_is_not_a_part_of_an_action_is_left_as_it_is(role: str, kind: str, name: str) -> None:
    assert {(e.kind, e.name) for e in endpoints(role, kind, name)} == {(kind, name)}


@given(EXPRESSIONS, NAMES)
def test_covers_agrees_with_fnmatch_on_names(pattern: str, name: str) -> None:
    """But for ranges that run backwards, of which Python's makes something else."""
    if "[^" not in pattern and not is_pattern(name):
        assert matcher(pattern)(name) == covers(pattern, name)
        if not any(low > high for low, high in re.findall(r"(?s)(?=(.)-(.))", pattern)):
            assert covers(pattern, name) == fnmatchcase(name, pattern)


@pytest.mark.parametrize(
    ("pattern", "covered", "others"),
    [("/[b-a!x]", ("/!", "/x"), ("/a", "/b", "/y")), ("/[\\-[!a]", ("/!", "/a"), ("/b", "/["))],
)
def test_a_range_that_runs_backwards_has_nothing(
    pattern: str, covered: tuple[str, ...], others: tuple[str, ...]
) -> None:
    """Found by fuzzing: Python's ``fnmatch`` takes the range out and then negates what is left."""
    assert all(covers(pattern, name) and overlaps(pattern, name) for name in covered)
    assert not any(covers(pattern, name) or overlaps(pattern, name) for name in others)


@given(EXPRESSIONS, NAMES)
def test_what_covers_a_name_overlaps_it(pattern: str, name: str) -> None:
    if not is_pattern(name):
        assert covers(pattern, name) == overlaps(pattern, name) == overlaps(name, pattern)


def test_a_caret_negates_as_it_does_in_glibc() -> None:
    assert covers("/[^a]", "/b")
    assert not covers("/[^a]", "/a")


@given(EXPRESSIONS, EXPRESSIONS, NAMES)
def test_two_expressions_that_cover_one_name_overlap(a: str, b: str, name: str) -> None:
    """No wildcard publisher may be lost to a wildcard subscriber."""
    if not is_pattern(name) and covers(a, name) and covers(b, name):
        assert overlaps(a, b)
        assert overlaps(b, a)


@given(EXPRESSIONS, EXPRESSIONS, NAMES)
def test_an_expression_covers_what_those_that_it_covers_do(a: str, b: str, name: str) -> None:
    """``covers`` on two expressions takes data out (DENY, mundane), so its True has to be certain."""
    if not is_pattern(name) and is_pattern(b) and covers(a, b) and covers(b, name):
        assert covers(a, name)


@pytest.mark.parametrize(
    ("a", "b", "meet"),
    [
        ("rt/a*", "rt/*b", True),
        ("rt/a*", "rt/b*", False),
        ("rt/?", "rt/ab", False),
        ("rt/[a-c]x", "rt/[!a-b]x", True),
        ("rt/[a-c]x", "rt/[!a-c]x", False),
        ("rt/*/image", "rt/cam/*", True),
    ],
)
def test_overlap(a: str, b: str, *, meet: bool) -> None:
    assert overlaps(a, b) is meet


@given(EXPRESSIONS, NAMES)
def test_the_literal_prefix_begins_every_name_that_is_covered(pattern: str, name: str) -> None:
    if not is_pattern(name) and covers(pattern, name):
        assert name.startswith(literal_prefix(pattern))


def test_endless_expressions_are_compared_in_bounded_time() -> None:
    long = "/" + "a*" * 2000 + "b"
    assert overlaps(long, long.replace("b", "?"))
    assert not overlaps(long, long.replace("b", "c"))
    assert covers("/" + "a*" * 1000, "/" + "a?*" * 1000)
    assert not covers("/" + "a?*" * 1000, "/" + "a*" * 1000)
