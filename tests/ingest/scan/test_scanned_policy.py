"""What a scan writes is a policy that sros2 reads, with the line of the code behind each grant, and is read back so."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy import analyze
from rosprivacy.analysis.model import OBSERVED, SCAN_GAP, SCANNED
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.policies.unsecured import is_observed
from rosprivacy.ingest.scan.scan_facts import CodePlace, Gap
from rosprivacy.ingest.scan.scanned_policy import policy_xml, scanned_policy, scanned_types, types_yaml
from rosprivacy.ingest.scan.systems import ChannelEnd, ScannedSystem, SystemNode
from rosprivacy.ingest.types.types_file import read_types

if TYPE_CHECKING:
    from pathlib import Path

IMAGE = "sensor_msgs/msg/Image"
CAMERA, VIEWER = CodePlace("cam.py", 34), CodePlace("view.py", 7)
SYSTEM = ScannedSystem(
    "robot.launch.py",
    (SystemNode("/camera", "literal", CAMERA), SystemNode("/viewer", "literal", VIEWER)),
    (
        ChannelEnd("/camera", "publish", "/image", IMAGE, "literal", CAMERA),
        ChannelEnd("/camera", "publish", "/image", IMAGE, "default", CodePlace("cam.py", 40)),
        ChannelEnd("/viewer", "subscribe", "/image", IMAGE, "launch", VIEWER),
    ),
    (Gap(CodePlace("cam.py", 50), "name", "it depends on <the robot>"),),
)


@pytest.fixture
def policy(tmp_path: Path) -> Path:
    file = tmp_path / "robot.policy.xml"
    file.write_bytes(policy_xml(SYSTEM, "robot"))
    return file


def test_each_grant_stands_at_its_line_of_the_code(policy: Path) -> None:
    grants = {
        (str(grant.place), grant.node, grant.role, grant.name, grant.basis) for grant in read_policy(str(policy)).grants
    }
    assert grants == {
        ("robot/cam.py:34", "/camera", "publish", "/image", "literal"),
        ("robot/cam.py:40", "/camera", "publish", "/image", "default"),
        ("robot/view.py:7", "/viewer", "subscribe", "/image", "launch"),
    }


def test_what_is_read_back_is_what_is_answered_at_once(policy: Path) -> None:
    written, direct = read_policy(str(policy)), scanned_policy(SYSTEM, "robot")
    plain = [{grant._replace(policy="") for grant in one.grants} for one in (written, direct)]
    assert plain[0] == plain[1]
    said = [[(one.code, one.message) for one in policy.diagnostics] for policy in (written, direct)]
    assert said[0] == said[1]


def test_gaps_are_at_their_lines_and_a_scan_is_never_whole(policy: Path) -> None:
    said = read_policy(str(policy)).diagnostics
    gaps = [one for one in said if one.code == SCAN_GAP]
    assert [str(gap.place) for gap in gaps[:-1]] == ["robot/cam.py:50"]
    assert "undetermined" in gaps[-1].message
    assert [one.code for one in said if one.code in (SCANNED, OBSERVED)] == [SCANNED]


def test_nothing_is_enforced_for_what_is_read_from_code(policy: Path) -> None:
    assert is_observed(read_policy(str(policy)))


def test_the_answer_is_undetermined_at_best_and_shows_lines_of_code(policy: Path, tmp_path: Path) -> None:
    labels = tmp_path / "l.yaml"
    labels.write_text(
        "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /viewer: conduit\nchannels:\n  /image: sensitive\n"
    )
    result = analyze(policies=[str(policy)], labels=[str(labels)])
    assert result.document()["verdict"] == "undetermined"
    labels.write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /viewer: {leak: [Video]}\n")
    (finding,) = analyze(policies=[str(policy)], labels=[str(labels)]).document()["findings"]
    lines = [(line["file"], line["line"], line["basis"]) for step in finding["steps"] for line in step["policy"]]
    assert lines == [("robot/cam.py", 34, "literal"), ("robot/cam.py", 40, "default"), ("robot/view.py", 7, "launch")]


def test_types_are_read_back(tmp_path: Path) -> None:
    file = tmp_path / "robot.types.yaml"
    file.write_text(types_yaml(SYSTEM, "robot"))
    direct = scanned_types(SYSTEM, "robot").channels
    assert (
        [(c.kind, c.name, [(t.type, t.ends) for t in c.types]) for c in read_types(str(file)).channels]
        == [(c.kind, c.name, [(t.type, t.ends) for t in c.types]) for c in direct]
        == [("topic", "/image", [(IMAGE, (("/camera",), ("/viewer",)))])]
    )


def test_a_node_with_an_end_of_unknown_type_limits_nothing() -> None:
    other = ChannelEnd("/camera", "publish", "/image", "", "literal", CodePlace("cam.py", 60))
    types = scanned_types(SYSTEM._replace(ends=(*SYSTEM.ends, other)), "robot")
    assert types.channels[0].types[0].ends == ((), ("/viewer",))


@pytest.mark.parametrize(
    "damage",
    [
        ('version="1" gaps', 'version="9" gaps'),
        ('gaps="1"', 'gaps="x"'),
        ("cam.py:34", "cam.py"),
        (' basis="literal"', ""),
    ],
)
def test_metadata_that_cannot_be_read_is_a_gap(policy: Path, damage: tuple[str, str]) -> None:
    policy.write_text(policy.read_text().replace(*damage))
    assert any("cannot be read" in one.message for one in read_policy(str(policy)).diagnostics if one.code == SCAN_GAP)


def test_gaps_that_were_taken_out_are_a_gap(policy: Path) -> None:
    lines = [line for line in policy.read_text().splitlines() if "<gap " not in line]
    policy.write_text("\n".join(lines))
    assert any("no more: 1" in one.message for one in read_policy(str(policy)).diagnostics if one.code == SCAN_GAP)


def test_the_same_system_is_the_same_bytes() -> None:
    again = SYSTEM._replace(gaps=SYSTEM.gaps)
    assert policy_xml(SYSTEM, "robot") == policy_xml(again, "robot")


def test_signs_that_no_xml_holds_do_not_stop_it() -> None:
    odd = SYSTEM._replace(gaps=(Gap(CodePlace("a\x01.py", 1), "name", "\x00\ud800"),))
    assert b"a.py" in policy_xml(odd, "robot")
