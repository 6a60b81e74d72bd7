"""Names from discovery data, which anybody on the network can write -> names that a policy can have (rules S3, S16).

In: what an endpoint is called in DDS; an observation as a door has it. Out: its role, channel and type; the observation
without what no ROS node can be called (each is said in one line, and their number is a gap), with the parts of actions
together, and with names that a listed generator makes up at each start folded into one.

Source: *Topic and Service name mapping to DDS* of the ROS 2 design pages; rmw_dds_common for ``ros_discovery_info``.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.policies.joint_policies import LONGEST
from rosprivacy.ingest.policies.names import ACTION_SERVICES, ACTION_TOPICS
from rosprivacy.ingest.policies.observed_metadata import REFUSED
from rosprivacy.ingest.running.observation import ROLES, Folded, added_up, folded_together

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.ingest.running.observation import Observation, ObservedEndpoint, ObservedNode, Span

NODES_TOPIC = "ros_discovery_info"
_LEGS = {"rt": "", "rq": "Request", "rr": "Reply"}
_SERVICE_PART = re.compile(r"_(?:Request|Response)\Z")
SHOWN_AT_MOST = 20  # lines about names; more are counted
_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+", re.ASCII)
_TYPE = re.compile(r"[A-Za-z][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*){1,4}", re.ASCII)
_HASH = re.compile(r"RIHS[0-9]{2}_[0-9a-f]{64}", re.ASCII)
_PART = re.compile(rf"(.+)/_action/({'|'.join(ACTION_SERVICES + ACTION_TOPICS)})")
_OF_TYPE = ("SendGoal", "GetResult", "FeedbackMessage")
_SIDES = {"publish": "execute", "reply": "execute", "subscribe": "call", "request": "call"}
GOAL = "send_goal"
# What the last parts of names of one generator look like: what stays of them, what is made up at each start.
GENERATORS = (
    ("transform_listener_impl", "address", re.compile(r"transform_listener_impl_(?:0x)?[0-9a-f]{6,16}", re.ASCII)),
    (
        "interactive_marker_display",
        "address",
        re.compile(r"interactive_marker_display_(?:0x)?[0-9a-f]{6,16}", re.ASCII),
    ),
    ("launch_ros", "process id", re.compile(r"launch_ros_[0-9]{1,10}", re.ASCII)),
    ("_ros2cli", "process id", re.compile(r"_ros2cli_[0-9]{1,10}", re.ASCII)),
    ("_ros2cli_daemon", "domain and digest", re.compile(r"_ros2cli_daemon_[0-9]{1,3}_[0-9a-f]{8,64}", re.ASCII)),
    ("moveit", "random number", re.compile(r"moveit_[0-9]{6,20}", re.ASCII)),
)


def ros_channel(topic: str, writes: bool) -> tuple[str, str] | None:  # noqa: FBT001  a fact of the endpoint, not an option
    """Return the role of an endpoint and the name of its channel; None if the topic is no channel of ROS.

    A server reads requests and writes replies, a client the other way round (rule S2).

    >>> ros_channel("rt/image", writes=True), ros_channel("rr/addReply", writes=True)
    (('publish', '/image'), ('reply', '/add'))
    >>> ros_channel("Square", writes=True) is None
    True
    """
    prefix, _, rest = topic.partition("/")
    suffix = _LEGS.get(prefix)
    if suffix is None or not rest or not rest.endswith(suffix):
        return None
    name = "/" + rest.removesuffix(suffix)
    if prefix == "rt":
        return ("publish" if writes else "subscribe"), name
    return ("request" if writes == (prefix == "rq") else "reply"), name


def ros_type(dds_type: str) -> str:
    """Return a type as ROS names it; empty if it is none of ROS.

    >>> ros_type("sensor_msgs::msg::dds_::Image_"), ros_type("std_srvs::srv::dds_::Empty_Response_")
    ('sensor_msgs/msg/Image', 'std_srvs/srv/Empty')
    >>> ros_type("nav2_msgs::action::dds_::Spin_SendGoal_Request_"), ros_type("ShapeType")
    ('nav2_msgs/action/Spin_SendGoal', '')
    """
    parts = dds_type.split("::")
    if len(parts) != 4 or parts[2] != "dds_" or not parts[3].endswith("_"):  # noqa: PLR2004  package, kind, dds_, name
        return ""
    name = parts[3].removesuffix("_")
    return "/".join((parts[0], parts[1], name if parts[1] == "msg" else _SERVICE_PART.sub("", name)))


def user_data(data: bytes) -> dict[str, str]:
    """Return what participants and endpoints say beside their names: ``enclave=/path;``, ``typehash=RIHS01_…;``.

    >>> user_data(b"enclave=/robot/camera;")
    {'enclave': '/robot/camera'}
    """
    pairs = (part.partition("=") for part in data.decode(errors="replace").split(";"))
    return {key: value for key, sign, value in pairs if sign}


def whole_type(name: str, sort: str) -> str:
    """Return a type with ``msg``, ``srv`` or ``action`` in it; empty of what is none.

    >>> whole_type("std_msgs/String", "msg"), whole_type("std_msgs/msg/String", "msg"), whole_type("x", "msg")
    ('std_msgs/msg/String', 'std_msgs/msg/String', '')
    """
    package, *rest = name.split("/")
    parts = [package, *rest] if len(rest) > 1 else [package, sort, *rest]
    is_type = (
        len(parts) == len(("package", "msg", "Name"))
        and parts[1] == sort
        and all(part.isidentifier() for part in parts)
    )
    return "/".join(parts) if is_type and name.isascii() else ""


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
    more = [f"{len(distinct) - SHOWN_AT_MOST} more names like these"] if len(distinct) > SHOWN_AT_MOST else []
    gaps = {**observation.gaps, **({REFUSED: observation.gaps.get(REFUSED, 0) + lost} if lost else {})}
    remarks = (*observation.remarks, *distinct[:SHOWN_AT_MOST], *more)
    return replace(observation, nodes=nodes, endpoints=endpoints, gaps=gaps, remarks=remarks)


def _node(node: ObservedNode, lines: list[str]) -> ObservedNode | None:
    if not is_name(node.name):
        lines.append(f"left out: no ROS node can be called {shown(repr(node.name))}")
        return None
    if node.enclave and not is_enclave(node.enclave):
        lines.append(f"{shown(node.name)}: no enclave has the path {shown(repr(node.enclave))}; taken as none")
        return replace(node, enclave="")
    return node


def _endpoint(endpoint: ObservedEndpoint, lines: list[str]) -> ObservedEndpoint | None:
    if endpoint.node and not is_name(endpoint.node):
        lines.append(f"left out: no ROS node can be called {shown(repr(endpoint.node))}")
        return None
    if not is_name(endpoint.name):
        who = endpoint.node or endpoint.participant or "an endpoint of no node"
        lines.append(f"left out: {shown(who)}: no {ROLES[endpoint.role]} can be called {shown(repr(endpoint.name))}")
        return None
    if endpoint.type and not is_type(endpoint.type):
        lines.append(f"{endpoint.name}: {shown(repr(endpoint.type))} is no type; taken as not known")
        return replace(endpoint, type="", hash="")
    return endpoint if not endpoint.hash or _HASH.fullmatch(endpoint.hash) else replace(endpoint, hash="")


def whole_actions(endpoints: Iterable[ObservedEndpoint]) -> tuple[ObservedEndpoint, ...]:
    """Return endpoints with the parts of each action together, as a policy states it (rule S3).

    A node that sends goals calls the action, one that takes them executes it; its other parts go with it. What only
    listens to feedback or status is no client: it keeps its topic, so that nothing is granted that nobody did; the
    analysis takes that topic as the action's response all the same.
    """
    kept: list[ObservedEndpoint] = []
    parts: dict[tuple[str, str, str, str], list[ObservedEndpoint]] = defaultdict(list)
    for endpoint in endpoints:
        match = _PART.fullmatch(endpoint.name) if endpoint.role in _SIDES else None
        if match:
            parts[endpoint.node, endpoint.participant, _SIDES[endpoint.role], match[1]].append(endpoint)
        else:
            kept.append(endpoint)
    whole = {(one.node, one.participant, one.role, one.name) for one in kept if one.kind == "action"}
    for (node, participant, role, name), several in parts.items():
        goals = [one for one in several if one.name.endswith(f"/{GOAL}")]
        if goals:
            seen = several[0].span
            for one in several:
                seen = seen.with_(one.span)
            kept += [
                replace(goal, role=role, name=name, type=action_type(goal.type), hash="", span=seen) for goal in goals
            ]
        elif (node, participant, role, name) not in whole:
            kept += several
    return tuple(kept)


def action_type(name: str) -> str:
    """Return the type of an action from that of one of its parts; empty where the part does not tell it.

    >>> action_type("nav2_msgs/action/Spin_SendGoal"), action_type("action_msgs/srv/CancelGoal")
    ('nav2_msgs/action/Spin', '')
    """
    action, _, part = name.rpartition("_")
    return action if part in _OF_TYPE and "/action/" in action else ""


def plain_name(name: str) -> tuple[str, str]:
    """Return a name without what a listed generator made up, and the rule; the name itself and '' if there is none.

    >>> plain_name("/a/transform_listener_impl_5591c2d0")
    ('/a/transform_listener_impl', 'transform_listener_impl_<address>')
    >>> plain_name("/cam_1"), plain_name("/launch_ros_4711")
    (('/cam_1', ''), ('/launch_ros', 'launch_ros_<process id>'))
    """
    namespace, slash, last = name.rpartition("/")
    for base, what, expression in GENERATORS:
        if expression.fullmatch(last):
            return f"{namespace}{slash}{base}", f"{base}_<{what}>"
    return name, ""


def with_folded_names(observation: Observation) -> tuple[Observation, tuple[Folded, ...]]:
    """Return an observation with made-up names folded where no two of them may have lived at one time.

    Nor are ``/cam_1`` and ``/cam_2`` ever folded: nobody lists what made these.
    """
    folded = tuple(_foldable(observation))
    new = {name: one.name for one in folded for name in one.names}
    known = folded_together((*observation.folded, *folded))
    if not new:
        return observation, known
    nodes = tuple(
        replace(node, name=new.get(node.name, node.name), enclave=_moved(node.enclave, new))
        for node in observation.nodes
    )
    endpoints = tuple(
        replace(one, node=new.get(one.node, one.node), name=_moved(one.name, new)) for one in observation.endpoints
    )
    return added_up((replace(observation, nodes=nodes, endpoints=endpoints),)), known


def _foldable(observation: Observation) -> Iterator[Folded]:
    lives: dict[str, Span] = {}
    for node in observation.nodes:
        lives[node.name] = lives[node.name].with_(node.span) if node.name in lives else node.span
    groups: dict[str, set[str]] = defaultdict(set)
    rules: dict[str, str] = {}
    for name in lives:
        plain, rule = plain_name(name)
        groups[plain].add(name)
        if rule:
            rules[plain] = rule
    before = {one.name for one in observation.folded}  # that such a name was folded is told already
    for plain, rule in sorted(rules.items()):
        names = sorted(groups[plain], key=lambda name: (lives[name].first, lives[name].last, name))
        if not any(lives[a].meets(lives[b]) for a, b in pairwise(names)):
            yield Folded(plain, tuple(sorted(set(names) - (before & {plain}))), rule)


def _moved(name: str, new: Mapping[str, str]) -> str:
    """A channel of a node's own (its parameter services) goes with the node."""
    parts = name.split("/")
    for last in range(len(parts), 1, -1):
        head = "/".join(parts[:last])
        if head in new:
            return new[head] + name[len(head) :]
    return name
