"""What is asked about although nothing names it: nodes that get nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.labelling.knowledge import UserFiles
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import policy

OPERATED = ("OperatorInput", "may")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def sources(node: str, label: str = "", rules: str = "", reader: str = "/m</w") -> dict[str, str]:
    """What the first node is suggested as a source of, with how sure."""
    Path("p.xml").write_text(policy(node, reader), "utf-8")
    Path("l.yaml").write_text(f"labels: 1\n{label}\n", "utf-8")
    Path("own.yaml").write_text(f"name_rules: 1\n{rules}\n", "utf-8")
    found = suggest_labels(("p.xml",), ("l.yaml",), Settings(), UserFiles(rules=("own.yaml",))).proposals
    own = (one for one in found if one.label.element.name == node.partition(">")[0])
    return {one.label.kind: str(one.confidence) for one in own if one.label.role == "source"}


@pytest.mark.parametrize(
    ("node", "type_", "asked"),
    [
        ("/n>/cmd_vel", "", True),  # velocities come from somewhere
        ("/n>/base/cmd_vel", "", True),
        ("/n>/cmd_vel</scan", "", False),  # it may make them of that
        ("/n>/chatter", "", False),
        ("/demo>/cmd_vel", "", True),  # somebody may act on a demonstration, too
        ("/n>/w", "std_msgs/msg/String", True),  # it can be anything
        ("/n>/w", "a/msg/Unknown", True),
        ("/n>/w", "sensor_msgs/msg/Imu", False),  # made for something else
        ("/n>/w", "", False),  # nobody knows what it is
        ("/n>/w</scan", "std_msgs/msg/String", False),  # it may be made of that
        ("/camera>/w", "std_msgs/msg/String", False),  # something else says what it brings in
        ("/test_n>/w", "std_msgs/msg/String", True),  # somebody starts a test
    ],
)
def test_a_node_that_gets_nothing_may_be_operated(node: str, type_: str, *, asked: bool) -> None:
    label = f"topics: {{/w: {{types: [{type_}]}}}}" if type_ else ""
    assert (OPERATED in sources(node, label, reader="/m>/scan</cmd_vel,/base/cmd_vel,/chatter,/w").items()) == asked


def test_a_rule_without_words_is_about_such_nodes() -> None:
    rules = "unprompted: [{kinds: [StaffBadge], why: ours}]"
    assert [*sources("/n>/w", "topics: {/w: {types: [std_msgs/msg/String]}}", rules)] == ["StaffBadge"]
