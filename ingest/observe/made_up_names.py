"""Names that a program makes up at each start -> one name, for listed generators only (rule S16).

In: an observation. Out: the same with such names folded, and which rule folded what. Two nodes that may have lived at
one time are never folded, nor ``/cam_1`` and ``/cam_2``: nobody lists what made these.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from rosprivacy.ingest.observe.observation import added_up

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.ingest.observe.observation import Observation, Span

# What names of one generator begin with, and what it puts after it at each start.
GENERATORS = (
    ("transform_listener_impl", "address", r"(?:0x)?[0-9a-f]{6,16}"),  # tf2_ros::TransformListener
    ("interactive_marker_display", "address", r"(?:0x)?[0-9a-f]{6,16}"),  # rviz
    ("launch_ros", "process id", r"[0-9]{1,10}"),  # launch_ros
    ("_ros2cli", "process id", r"[0-9]{1,10}"),  # ros2cli
    ("_ros2cli_daemon", "domain and digest", r"[0-9]{1,3}_[0-9a-f]{8,64}"),  # ros2cli's daemon
    ("moveit", "random number", r"[0-9]{6,20}"),  # MoveIt's own node
)
_RULES = tuple((base, what, re.compile(rf"(.*/){base}_{made}", re.ASCII)) for base, what, made in GENERATORS)


@dataclass(frozen=True, slots=True)
class Folded:
    """Names that became one.

    Attributes
    ----------
    name
        What they are called now.
    names
        As they were seen, sorted.
    rule
        Of the generator, for people.
    """

    name: str
    names: tuple[str, ...]
    rule: str


def plain_name(name: str) -> tuple[str, str]:
    """Return a name without what a listed generator made up, and the rule; the name itself and '' if there is none.

    >>> plain_name("/a/transform_listener_impl_5591c2d0")
    ('/a/transform_listener_impl', 'transform_listener_impl_<address>')
    >>> plain_name("/cam_1"), plain_name("/launch_ros_4711")
    (('/cam_1', ''), ('/launch_ros', 'launch_ros_<process id>'))
    """
    for base, what, expression in _RULES:
        if match := expression.fullmatch(name):
            return f"{match[1]}{base}", f"{base}_<{what}>"
    return name, ""


def with_folded_names(observation: Observation) -> tuple[Observation, tuple[Folded, ...]]:
    """Return an observation with made-up names folded where no two of them may have lived at one time."""
    folded = tuple(_foldable(observation))
    new = {name: one.name for one in folded for name in one.names}
    if not new:
        return observation, ()
    nodes = tuple(
        replace(node, name=new.get(node.name, node.name), enclave=_moved(node.enclave, new))
        for node in observation.nodes
    )
    endpoints = tuple(
        replace(one, node=new.get(one.node, one.node), name=_moved(one.name, new)) for one in observation.endpoints
    )
    return added_up((replace(observation, nodes=nodes, endpoints=endpoints),)), folded


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
    for plain, rule in sorted(rules.items()):
        names = sorted(groups[plain], key=lambda name: (lives[name].first, lives[name].last, name))
        if not any(lives[a].meets(lives[b]) for a, b in pairwise(names)):
            yield Folded(plain, tuple(sorted(names)), rule)


def _moved(name: str, new: Mapping[str, str]) -> str:
    """A channel of a node's own (its parameter services) goes with the node."""
    for old, plain in new.items():
        if name == old or name.startswith(f"{old}/"):
            return plain + name[len(old) :]
    return name
