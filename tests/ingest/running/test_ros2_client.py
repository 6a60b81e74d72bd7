"""Robots of ros2-client on DDS (RustDDS) and on Zenoh: what they declare is what is seen, and leads to a finding.

Both know who is in their domain, and see no ROS node of ours while we look.
"""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.policies.observed_metadata import NO_NODE
from rosprivacy.ingest.running.dds_door import DdsDoor
from rosprivacy.ingest.running.zenoh_door import ZenohDoor
from rosprivacy.observing import now
from tests.helpers import zenoh_tokens
from tests.helpers.command import run
from tests.helpers.ros2_client import ENDPOINTS, LOGS, NODES, PARAMETERS, robot

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.ingest.running.observation import Observation
    from tests.helpers.fastdds import Peer

pytestmark = [pytest.mark.slow, pytest.mark.thorough]
DOMAINS = iter(range(1 + os.getpid() % 20, 30))
LABELS = "labels: 1\nnodes:\n  /head/camera_driver: {source: [Video]}\n  /navigator: {leak: [Video]}\n"
PATH = ["/head/camera_driver", "/head/camera/image_raw", "/face_recognizer", "/faces", "/archive", "/save_footage"]


def joined(where: str) -> dict[str, str]:
    """Variables with which rmw_zenoh, and who works like it, joins a router."""
    settings = ['mode="client"', f'connect/endpoints=["{where}"]', "listen/endpoints=[]"]
    return {"ZENOH_CONFIG_OVERRIDE": ";".join([*settings, "scouting/multicast/enabled=false"])}


def looked(looks: Iterator[Observation], peer: Peer) -> tuple[Observation, set[str]]:
    """What is seen at the end, and what the peer says meanwhile of whom it sees."""
    both = [(seen, peer.does("seen")) for seen in looks]
    return both[-1][0], {said for _, said in both}


def endpoints(seen: Observation) -> set[tuple[str, str, str, str]]:
    return {(one.node, one.role, one.name, one.type) for one in seen.endpoints}


def nodes(said: str) -> set[str]:
    return {word for word in said.split() if word.startswith("/")}


def test_what_a_robot_declares_on_dds_is_what_is_seen(ros2_client: dict[str, Path]) -> None:
    """RustDDS lets no participant name an enclave, and reads /clock beside its nodes."""
    domain = next(DOMAINS)
    own = ENDPOINTS | LOGS | PARAMETERS | {("", "subscribe", "/clock", "builtin_interfaces/msg/Time")}
    with robot(ros2_client["dds_peer"], domain) as peer:
        seen, told = looked(DdsDoor(now, domain, interface="lo").looks(15), peer)
    assert {(node.name, node.enclave) for node in seen.nodes} == {(node, "") for node in NODES}
    assert endpoints(seen) == own
    assert set(seen.all_gaps) == {NO_NODE}
    # One participant of the robot sees the other one and ours; the other one hears of no nodes but those of the first.
    assert max(said.partition(" ")[0] for said in told) == "2"
    assert set().union(*map(nodes, told)) == NODES - {"/navigator"}
    print(f"DDS: {len(NODES)} nodes, {len(endpoints(seen))} endpoints; the peer said {sorted(told)}")


def test_what_a_robot_declares_on_zenoh_is_what_is_seen(ros2_client: dict[str, Path]) -> None:
    domain = next(DOMAINS)
    with zenoh_tokens.router() as where, robot(ros2_client["zenoh_peer"], domain, **joined(where)) as peer:
        seen, told = looked(ZenohDoor(now, domain, where).looks(3), peer)
        assert {(node.name, node.enclave) for node in seen.nodes} == {(node, "") for node in NODES}
        assert endpoints(seen) == ENDPOINTS | LOGS
        assert seen.all_gaps == {}
        assert set().union(*map(nodes, told)) == NODES
        with zenoh_tokens.session(where) as one:
            kept = one.liveliness().declare_token(zenoh_tokens.node(domain, "somebody"))
            while "/somebody" not in nodes(said := peer.does("seen")):
                pass
            kept.undeclare()
    print(f"Zenoh: {len(NODES)} nodes, {len(endpoints(seen))} endpoints; the peer said {sorted(told)}, then {said!r}")


def holds_the_finding(folder: Path, *door: str) -> None:
    """From a robot that runs to the planted finding, by two commands; what the robot sees is nothing of ours."""
    (folder / "labels.yaml").write_text(LABELS, "utf-8")
    done = run("observe", *door, "-o", "robot.policy.xml", cwd=folder)
    assert done.returncode == 0, done.stderr
    done = run("analyze", "robot.policy.xml", "-l", "labels.yaml", "-f", "json", cwd=folder)
    assert done.returncode == 1, done.stderr
    (finding,) = json.loads(done.stdout)["findings"]
    print(" -> ".join(element["name"] for element in finding["witness"]))
    assert [element["name"] for element in finding["witness"]] == [*PATH, "/navigator"]


def test_from_a_robot_on_dds_to_the_planted_finding(ros2_client: dict[str, Path], tmp_path: Path) -> None:
    domain = next(DOMAINS)
    with robot(ros2_client["dds_peer"], domain):
        holds_the_finding(tmp_path, "--dds", "--interface", "lo", "--domain", str(domain), "--for", "12s")


def test_from_a_robot_on_zenoh_to_the_planted_finding(ros2_client: dict[str, Path], tmp_path: Path) -> None:
    domain = next(DOMAINS)
    with zenoh_tokens.router() as where, robot(ros2_client["zenoh_peer"], domain, **joined(where)):
        holds_the_finding(tmp_path, "--zenoh", "--router", where, "--domain", str(domain), "--for", "3s")
