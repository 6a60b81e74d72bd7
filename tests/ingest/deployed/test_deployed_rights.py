"""What only one of two sides allows: of plain names exactly, whatever rules say it (rules S4, S5)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.deployed.deployed_inputs import read_deployed
from rosprivacy.ingest.deployed.differences import differences
from rosprivacy.ingest.deployed.permissions import Permissions, policy_of, read_permissions
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.keystores import grant, permissions, rule
from tests.helpers.permission_oracle import may

if TYPE_CHECKING:
    from pathlib import Path

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


@pytest.mark.corpus
@pytest.mark.parametrize("name", ["sample", "single_context", "minimal_action", "talker_listener", "add_two_ints"])
def test_the_permissions_that_sros2_makes_hold_what_the_policy_says(corpus: Path, name: str) -> None:
    sros2 = "ros2__sros2/sros2/test/policies"
    folder = corpus / "policies" / sros2
    policy = read_policy(str(folder / f"{name}.policy.xml"), include_root=str(folder))
    file = corpus / "dds" / sros2 / "permissions" / name / "permissions.xml"
    deployed, _ = read_deployed([str(file)], None, "2026-11-22", allow_unsigned=True)
    assert differences([policy], deployed) == ()
