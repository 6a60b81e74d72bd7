"""Systems with labels that the explorer is measured on: TurtleBot3, and made-up ones of 2,000 elements."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from measure import corpus

from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

POLICY = "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml"
TURTLEBOT = """labels: 1
nodes:
  /turtlebot3_laserscan: {source: [HomeMap]}
  /turtlebot3_diff_drive: {source: [Location]}
  /bt_navigator: {leak: [HomeMap]}
  /rviz2: {leak: [Location]}
"""
NODES, GROUP, KINDS = 800, 40, 24


def turtlebot(folder: Path) -> tuple[str, str]:
    """Write labels of TurtleBot3; return the names of its policy and of them."""
    (folder / "tb3.yaml").write_text(TURTLEBOT, "utf-8")
    return str(corpus() / POLICY), str(folder / "tb3.yaml")


def large(folder: Path, *, apart: bool) -> tuple[str, str]:
    """Write a policy of 2,000 elements with 5,000 flows, and labels of 24 kinds.

    Parameters
    ----------
    apart
        Whether a gateway after every 40 nodes lets nothing out: a kind then gets to a twentieth of the system, else
        from one end to the other.
    """
    random = Random(1)  # noqa: S311 - repeatable
    profiles = []
    for node in range(NODES):
        first = node // GROUP * GROUP if apart else max(0, node - 9)
        last = first + GROUP - 1 if apart else node + 9
        writes = "".join(f"<topic>/t{random.randint(first, last)}</topic>" for _ in range(3))
        reads = "".join(f"<topic>/t{random.randint(first, last)}</topic>" for _ in range(3))
        more = f"<topic>/only{node}</topic>" if node % 2 else ""
        if apart and node % GROUP == GROUP - 1:
            more += f"<topic>/t{node + 1}</topic>"  # into the next group
        topics = f'<topics publish="ALLOW">{writes}{more}</topics><topics subscribe="ALLOW">{reads}</topics>'
        profile = f'<profiles><profile ns="/" node="n{node}">{topics}</profile></profiles>'
        profiles.append(f'<enclave path="/e{node}">{profile}</enclave>')
    name = "apart" if apart else "joined"
    policy, labels = folder / f"{name}.xml", folder / f"{name}.yaml"
    policy.write_text(f'<policy version="0.2.0"><enclaves>{"".join(profiles)}</enclaves></policy>', "utf-8")
    kinds = sorted(load().categories)[:KINDS]
    says: dict[int, list[str]] = {}
    for place, kind in enumerate(kinds):
        at = place * (NODES // KINDS)
        says.setdefault(at, []).append(f"source: [{kind}]")
        says.setdefault(at + 3, []).append(f"leak: [{kind}]")
    if apart:
        says |= {node: ["sanitizer: {PersonalData: drop}"] for node in range(GROUP - 1, NODES, GROUP)}
    lines = [f"  /n{node}: {{{', '.join(some)}}}\n" for node, some in sorted(says.items())]
    labels.write_text("labels: 1\nnodes:\n" + "".join(lines), "utf-8")
    return str(policy), str(labels)
