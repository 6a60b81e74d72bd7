"""What only one of two sides allows: of plain names exactly, whatever rules say it (rules S4, S5)."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.deployed.differences import differences
from rosprivacy.ingest.deployed.permissions import Permissions, policy_of, read_permissions
from tests.helpers.keystores import grant, permissions, rule
from tests.helpers.permission_oracle import may

NAMES = ("rt/a", "rt/ab", "rt/b")
EXPRESSIONS = (*NAMES, "rt/*", "rt/a*", "rt/?")


def read(*rules: str) -> Permissions:
    return read_permissions(permissions(grant("/c", *rules)).encode(), "p.xml")


def compared(ours: Permissions, theirs: Permissions) -> list[tuple[bool, str]]:
    found = differences([policy_of(ours, None, ())], [policy_of(theirs, None, ())])
    return [(one.stated, one.dds) for one in found]


lists = st.lists(
    st.builds(
        rule,
        st.sampled_from(("allow", "deny")),
        st.lists(st.sampled_from(EXPRESSIONS), min_size=1, max_size=3).map(tuple),
    ),
    min_size=1,
    max_size=3,
)


@given(lists, lists)
def test_nothing_told_means_that_every_name_is_decided_alike(ours: list[str], theirs: list[str]) -> None:
    first, second = read(*ours), read(*theirs)
    told = compared(first, second)
    unlike = [n for n in NAMES if may(first.grants[0], 0, "publish", n) != may(second.grants[0], 0, "publish", n)]
    if unlike:
        assert told
    stated = {dds for is_stated, dds in told if is_stated}
    plain = {dds for dds in stated if dds in NAMES}
    assert all(not may(second.grants[0], 0, "publish", dds) for dds in plain)


@given(lists)
def test_a_side_does_not_differ_from_itself(rules: list[str]) -> None:
    assert compared(read(*rules), read(*rules)) == []


def test_a_deny_that_is_not_deployed_is_a_difference() -> None:
    ours = read(rule("deny", ("rt/b",)), rule("allow", ("rt/*",)))
    theirs = read(rule("allow", ("rt/*",)))
    assert compared(ours, theirs) == [(False, "rt/*")]
