"""Choices -> files of packages, about nodes and channels of ``BASE``, so that some of them match."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.suggesting.evidence import WHERE
from rosprivacy.analysis.suggesting.packages import USES
from rosprivacy.ingest.known_packages.package_file import METHODS
from tests.fuzzing.label_texts import written
from tests.fuzzing.words import KINDS

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

NAMES = ("n0", "n1", "n2", "arm", "eye", "n*", "*m", "other_node")
CHANNELS = {"topic": ("a", "b", "image", "~/x", "/c/image", "*/image"), "service": ("s", "~/y"), "action": ("spin",)}
TYPES = {"topic": "sensor_msgs/msg/Image", "service": "std_srvs/srv/Empty", "action": "nav2_msgs/action/Spin"}
SOURCE = {"at": "https://example.org/x", "version": "1.0", "read": "2026-11-23"}


def package(choices: Choices) -> dict[str, str]:
    nodes = [_node(choices) for _ in range(1 + choices.below(2))]
    sources = [SOURCE, SOURCE | {"commit": "ab12", "files": ["README.md"]}][: 1 + choices.below(2)]
    top = {"package": 1, "name": "own", "about": "One of ours.", "sources": sources, "nodes": nodes}
    return {"package.yaml": written(choices, top)}


def _node(choices: Choices) -> dict[str, Any]:
    node: dict[str, Any] = {"names": choices.some(NAMES, least=1), "says": [_claim(choices)]}
    for use, (kind, _) in USES.items():
        if choices.once_in(3):
            node[use] = {name: choices.pick((None, TYPES[kind])) for name in choices.some(CHANNELS[kind])}
    if choices.once_in(3):
        node["says"].append(_claim(choices))
    return node


def _claim(choices: Choices) -> dict[str, Any]:
    kind = choices.pick(KINDS)
    roles: tuple[dict[str, Any], ...] = (
        {"source": [kind]},
        {"leak": [kind], "to": choices.pick(WHERE)},
        {"derives": [{"from": kind, "to": choices.pick(KINDS)}]},
        {"sanitizer": {kind: str(choices.pick(METHODS))}},
        {"conduit": choices.pick(("all", [kind]))},
    )
    said = choices.pick(roles)
    return {**said, "why": "it does", **({"confidence": "may"} if choices.once_in(3) else {})}
