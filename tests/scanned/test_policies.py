"""The measure of a scan against a policy of others, on a pair made up for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.scan.checkout import read_checkout
from tests.helpers.checkouts import put_checkout
from tests.scanned.policies import (
    FOUND,
    LOST,
    NAMED,
    NODE,
    UNSURE,
    Measure,
    Scanned,
    Use,
    measured,
    pairs,
    policy_uses,
    scanned_uses,
)

if TYPE_CHECKING:
    from pathlib import Path

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/"><profiles>
  <profile ns="/robot" node="camera">
    <topics publish="ALLOW"><topic>image</topic><topic>rosout</topic><topic>lost</topic><topic>any*</topic></topics>
    <topics subscribe="DENY"><topic>denied</topic></topics>
    <services reply="ALLOW"><service>look/_action/send_goal</service><service>~/get_state</service></services>
  </profile>
  <profile ns="/" node="nav_rclcpp_node"><topics publish="ALLOW"><topic>plan</topic></topics></profile>
  <profile ns="/" node="transform_listener_impl_55fdeb81ca40">
    <topics subscribe="ALLOW"><topic>tf</topic></topics>
  </profile>
</profiles></enclave></enclaves></policy>
"""


def test_a_policy_states_uses_by_name_and_what_every_node_has_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "policy.xml").write_text(POLICY, "utf-8")
    assert policy_uses([read_policy(str(tmp_path / "policy.xml"))]) == {
        Use("/robot/camera", "publish", "/robot/image"),
        Use("/robot/camera", "publish", "/robot/lost"),
        Use("/robot/camera", "execute", "/robot/look"),
        Use("/nav", "publish", "/plan"),
        Use("/transform_listener_impl", "subscribe", "/tf"),
    }


def test_a_scan_says_what_the_launch_file_makes_of_the_names(tmp_path: Path) -> None:
    (tmp_path / "policy.xml").write_text(POLICY, "utf-8")
    launch = "launch/guide.launch.py"
    scanned = scanned_uses(read_checkout(str(put_checkout(tmp_path / "guide")), launches=(launch,)), (launch,))
    measure = measured(policy_uses([read_policy(str(tmp_path / "policy.xml"))]), scanned)
    assert {use.name: sort for use, sort in measure.true.items()} == {
        "/robot/image": FOUND, "/robot/lost": LOST, "/robot/look": LOST, "/plan": NODE,
    }  # fmt: skip
    assert not measure.wrong
    with pytest.raises(ValueError, match="other"):
        scanned_uses(read_checkout(str(tmp_path / "guide")), ("other.launch.py",))


def test_each_use_is_found_unsure_named_or_lost_and_only_what_is_sure_can_be_wrong() -> None:
    sure, weak, gap, lost, absent = (Use("/a", "publish", f"/{name}") for name in ("s", "w", "g", "l", "n"))
    gap, absent = gap._replace(role="request"), absent._replace(node="/b")
    listens = Use("/a", "subscribe", "/tf")
    uses = {sure: "literal", weak: "package", Use("/a", "publish", "/x"): "launch", Use("/a", "reply", "/y"): "guessed"}
    scanned = Scanned(uses | {listens: "literal"}, frozenset({"/a"}), frozenset({("/a", "request")}))
    true = frozenset({sure, weak, gap, lost, absent})
    wrong = {Use("/a", "publish", "/x")}
    assert measured(true, scanned) == Measure(
        {sure: FOUND, weak: UNSURE, gap: NAMED, lost: LOST, absent: NODE}, frozenset(wrong | {listens})
    )
    by_tf = true | {Use("/transform_listener_impl", "subscribe", "/tf")}
    assert measured(by_tf, scanned).wrong == wrong


def test_the_pairs_are_public_commits_and_policies_of_the_corpus(corpus: Path) -> None:
    assert [pair.system for pair in pairs()] == sorted(pair.system for pair in pairs())
    for pair in pairs():
        assert all(len(commit) == 40 for _, commit in pair.checkouts)
        assert all((corpus / "policies" / file).is_file() for file in pair.policies)
