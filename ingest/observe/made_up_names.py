"""Names that a program makes up at each start -> one name, for listed generators only (rule S16).

In: an observation. Out: the same with such names folded, and which rule folded what. Two nodes that may have lived at
one time are never folded, nor ``/cam_1`` and ``/cam_2``: nobody lists what made these.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from rosprivacy.ingest.observe.observation import Folded, added_up, folded_together

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.ingest.observe.observation import Observation, Span

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
    """Return an observation with made-up names folded where no two of them may have lived at one time."""
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
        lives[node.name] = lives[node.name].with_(node.seen) if node.name in lives else node.seen
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
