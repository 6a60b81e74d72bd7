"""Names from discovery data, which anybody on the network can write -> those that a ROS node can have (rule S16).

In: an observation as a door has it. Out: the same without what no ROS node can be called; each is said in one line, and
their number is a gap, so that nothing is lost in silence. A type that is none is left out alone: it is not known then.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.observe.observation import ROLES
from rosprivacy.ingest.policies.joint_policies import LONGEST
from rosprivacy.ingest.policies.observed_metadata import REFUSED

if TYPE_CHECKING:
    from rosprivacy.ingest.observe.observation import Observation, ObservedEndpoint, ObservedNode

TOLD = 20  # lines about names; more are counted
_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+", re.ASCII)
_TYPE = re.compile(r"[A-Za-z][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*){1,4}", re.ASCII)
_HASH = re.compile(r"RIHS[0-9]{2}_[0-9a-f]{64}", re.ASCII)


def is_name(name: str) -> bool:
    """Return whether a node or channel can have a name.

    >>> is_name("/robot/camera_1"), is_name("/a b"), is_name("/a*"), is_name("camera"), is_name("/1st")
    (True, False, False, False, False)
    """
    return len(name) <= LONGEST and _NAME.fullmatch(name) is not None


def is_enclave(path: str) -> bool:
    r"""Return whether an enclave can have a path; the root alone is one.

    >>> is_enclave("/"), is_enclave("/robot/cam"), is_enclave("/robot\n")
    (True, True, False)
    """
    return path == "/" or is_name(path)


def is_type(name: str) -> bool:
    """Return whether an interface can have a name.

    >>> is_type("sensor_msgs/msg/Image"), is_type("Image"), is_type("a/b<c>")
    (True, False, False)
    """
    return len(name) <= LONGEST and _TYPE.fullmatch(name) is not None


def with_good_names(observation: Observation) -> Observation:
    """Return an observation without names that no ROS node can have."""
    lines: list[str] = []
    nodes = tuple(kept for node in observation.nodes if (kept := _node(node, lines)))
    endpoints = tuple(good for one in observation.endpoints if (good := _endpoint(one, lines)))
    lost = len(observation.nodes) - len(nodes) + len(observation.endpoints) - len(endpoints)
    if not lines:
        return observation
    distinct = sorted(set(lines))
    more = [f"{len(distinct) - TOLD} more names like these"] if len(distinct) > TOLD else []
    gaps = {**observation.gaps, **({REFUSED: observation.gaps.get(REFUSED, 0) + lost} if lost else {})}
    remarks = (*observation.remarks, *distinct[:TOLD], *more)
    return replace(observation, nodes=nodes, endpoints=endpoints, gaps=gaps, remarks=remarks)


def _node(node: ObservedNode, lines: list[str]) -> ObservedNode | None:
    if not is_name(node.name):
        lines.append(f"left out: no ROS node can be called {shown(repr(node.name))}")
        return None
    if node.enclave and not is_enclave(node.enclave):
        lines.append(f"{shown(node.name)}: no enclave has the path {shown(repr(node.enclave))}; taken as none")
        return replace(node, enclave="")
    return node


def _endpoint(one: ObservedEndpoint, lines: list[str]) -> ObservedEndpoint | None:
    if one.node and not is_name(one.node):
        lines.append(f"left out: no ROS node can be called {shown(repr(one.node))}")
        return None
    if not is_name(one.name):
        who = one.node or one.participant or "an endpoint of no node"
        lines.append(f"left out: {shown(who)}: no {ROLES[one.role]} can be called {shown(repr(one.name))}")
        return None
    if one.type and not is_type(one.type):
        lines.append(f"{one.name}: {shown(repr(one.type))} is no type; taken as not known")
        return replace(one, type="", hash="")
    return one if not one.hash or _HASH.fullmatch(one.hash) else replace(one, hash="")
