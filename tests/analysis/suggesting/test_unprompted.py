"""Who commands the robot and is told nothing: somebody may act on it (issue 21)."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.labelling.knowledge import UserFiles
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import policy


@pytest.mark.parametrize(
    ("node", "operated"),
    [
        ("/n>/cmd_vel", True),
        ("/n>/base/cmd_vel", True),
        ("/n>/cmd_vel</scan", False),  # it may make them of that
        ("/n>/chatter", False),
        ("/demo>/cmd_vel", True),  # somebody may act on a demonstration, too
    ],
)
def test_velocities_come_from_somewhere(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    node: str,
    operated: bool,  # noqa: FBT001 - a row of the table
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy(node, "/m>/scan</cmd_vel,/base/cmd_vel,/chatter"), "utf-8")
    found = suggest_labels(("p.xml",), (), Settings()).proposals
    said = {(one.label.kind, str(one.confidence)) for one in found if one.label.role == "source"}
    assert (("OperatorInput", "may") in said) == operated


@pytest.mark.parametrize(
    ("node", "type_", "asked"),
    [
        ("/n>/w", "std_msgs/msg/String", True),  # it can be anything
        ("/n>/w", "a/msg/Unknown", True),
        ("/n>/w", "sensor_msgs/msg/Imu", False),  # made for something else
        ("/n>/w", "", False),  # nobody knows what it is
        ("/n>/w</scan", "std_msgs/msg/String", False),  # it may be made of that
        ("/camera>/w", "std_msgs/msg/String", False),  # something else says what it brings in
        ("/test_n>/w", "std_msgs/msg/String", True),  # somebody starts a test
    ],
)
def test_a_node_that_is_told_nothing_and_of_which_nothing_is_known_is_asked_about(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    node: str,
    type_: str,
    asked: bool,  # noqa: FBT001 - a row of the table
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy(node, "/m>/scan</w"), "utf-8")
    Path("l.yaml").write_text(f"labels: 1\ntopics: {{/w: {{types: [{type_}]}}}}\n" if type_ else "labels: 1\n")
    found = suggest_labels(("p.xml",), ("l.yaml",), Settings()).proposals
    of_node = [one for one in found if one.label.role == "source" and one.label.element.name == node.partition(">")[0]]
    assert (("OperatorInput", "may") in {(one.label.kind, str(one.confidence)) for one in of_node}) == asked


def test_a_rule_without_words_is_about_such_nodes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy("/n>/w", "/m</w"), "utf-8")
    Path("l.yaml").write_text("labels: 1\ntopics: {/w: {types: [std_msgs/msg/String]}}\n", "utf-8")
    Path("own.yaml").write_text("name_rules: 1\nunprompted: [{kinds: [StaffBadge], why: ours}]\n", "utf-8")
    found = suggest_labels(("p.xml",), ("l.yaml",), Settings(), UserFiles(rules=("own.yaml",))).proposals
    assert [one.label.kind for one in found if one.label.role == "source"] == ["StaffBadge"]
