"""A made-up vehicle of the size of a large public one: 119 nodes in ONE enclave, as generated policies often have it.

Stages from sensing to what leaves the vehicle; each node reads from nodes before it and has the standard channels that
every ROS node has. With labels for as many kinds of data as one likes: as declared, filters clean all that leaves.
"""

from __future__ import annotations

import json
from random import Random
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

NODES = 119
STAGES = ("sensing", "perception", "localization", "planning", "control", "system", "remote")
PARAMETERS = (
    "describe_parameters", "get_parameters", "get_parameter_types", "list_parameters", "set_parameters",
    "set_parameters_atomically",
)  # fmt: skip
WRITES, READS, ASKS = 3, 4, 0.7  # of a node: topics, topics of others, services that it asks
FILTERS, UPLINKS = 32, 2  # the last nodes: those that clean, and those that read from these only


def names() -> list[str]:
    """Return the nodes, in the order of their stages."""
    return [f"/{STAGES[number * len(STAGES) // NODES]}/unit_{number:03}" for number in range(NODES)]


def policy() -> str:
    """Return the text of the policy."""
    draw, nodes = Random(1), names()  # noqa: S311 - no secret
    written = {node: [f"{node}/out_{number}" for number in range(WRITES)] for node in nodes}
    lines = ['<policy version="0.2.0"><enclaves><enclave path="/vehicle"><profiles>']
    for at, node in enumerate(nodes):
        before = [
            topic
            for other in nodes[-FILTERS - UPLINKS if at >= NODES - UPLINKS else 0 : at]
            for topic in written[other]
        ]
        stage, _, name = node.rpartition("/")
        lines.append(f'<profile ns="{stage}" node="{name}">')
        lines.append(_told("topic", "publish", [*written[node], "/rosout", "/parameter_events"]))
        lines.append(_told("topic", "subscribe", draw.sample(before, min(READS, len(before)))))
        lines.append(_told("service", "reply", [f"{node}/{name}" for name in PARAMETERS]))
        if draw.random() < ASKS:
            lines.append(_told("service", "request", [f"{draw.choice(nodes)}/list_parameters"]))
        lines.append("</profile>")
    return "\n".join([*lines, "</profiles></enclave></enclaves></policy>\n"])


def _told(kind: str, role: str, channels: Sequence[str]) -> str:
    told = "".join(f"<{kind}>{name}</{kind}>" for name in channels)
    return f'<{kind}s {role}="ALLOW">{told}</{kind}s>' if told else ""


def labels(kinds: Sequence[str]) -> str:
    """Return a label file (JSON is YAML too): a source of each kind, two uplinks, and filters before them."""
    nodes = names()
    said: dict[str, dict[str, object]] = {node: {"conduit": list(kinds)} for node in nodes}
    for number, kind in enumerate(kinds):
        others = [one for one in kinds if one != kind]
        said[nodes[number]] = {"source": [kind], **({"conduit": others} if others else {})}
    for node in nodes[-FILTERS - UPLINKS :]:
        said[node] = {"sanitizer": dict.fromkeys(kinds, "anonymise")}
    for node in nodes[-UPLINKS:]:
        said[node] = {"leak": list(kinds)}
    return json.dumps({"labels": 1, "nodes": said}, indent=1)
