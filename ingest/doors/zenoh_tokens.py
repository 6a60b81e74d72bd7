"""Liveliness tokens of rmw_zenoh -> nodes and endpoints (rule S16).

In: key expressions, and since when each is there. Out: ``Observation``. A token says which enclave, node, channel and
type it is of, so nothing has to be put together.

Source: rmw_zenoh, ``docs/design.md`` and ``liveliness_utils.cpp``: ``@ros2_lv/<domain>/<session>/<node id>/<entity
id>/<kind>/<enclave>/<namespace>/<node>`` and, for endpoints, ``/<name>/<type>/<hash>/<qos>`` with more after it since
2026. A slash within a part is ``%``; an empty part is ``%`` too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.doors.dds_names import ros_type
from rosprivacy.ingest.observe.observation import Observation, ObservedEndpoint, ObservedNode, Span
from rosprivacy.ingest.policies.observed_metadata import HIDDEN, REFUSED

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.ingest.observe.declared import Declared

DOOR = "zenoh"
ROOT = "@ros2_lv"
NODE = "NN"
ROLES = {"MP": "publish", "MS": "subscribe", "SS": "reply", "SC": "request"}
NODE_PARTS, ENDPOINT_PARTS = 9, 12
EMPTY = (
    "connected, and there is no token of ROS domain {domain}: nothing runs in it, or the access list of the router "
    "does not let us look (it has to allow liveliness_query and declare_liveliness_subscriber on @ros2_lv/**)"
)


def tokens_of(domain: int) -> str:
    """Return the key expression of all tokens of a domain; ``**`` alone matches no part that begins with ``@``."""
    return f"{ROOT}/{domain}/**"


def observation(
    tokens: Mapping[str, str], since: str, now: str, domain: int, declared: Iterable[Declared] = ()
) -> Observation:
    """Return what tokens say.

    Parameters
    ----------
    tokens
        Key -> since when it is there.
    since, now
        When somebody began to look, and this moment.
    declared
        What nodes have said of themselves so far.
    """
    nodes: list[ObservedNode] = []
    endpoints: list[ObservedEndpoint] = []
    remarks: list[str] = []
    for key, first in sorted(tokens.items()):
        token = _read(key, Span(first, now))
        if token is None:
            remarks.append(f"left out: {shown(repr(key))} is no token of rmw_zenoh that is known")
            continue
        node, endpoint = token
        nodes.append(node)
        endpoints += [endpoint] if endpoint else []
    gaps = {REFUSED: len(remarks)} if remarks else {}
    if not tokens:
        gaps, remarks = {HIDDEN: 1}, [EMPTY.format(domain=domain)]
    seen = Span(since, now)
    said = tuple(sorted(declared))
    return Observation((DOOR,), seen, tuple(nodes), tuple(endpoints), (domain,), gaps, tuple(remarks), said)


def _read(key: str, seen: Span) -> tuple[ObservedNode, ObservedEndpoint | None] | None:
    parts = key.split("/")
    if len(parts) < NODE_PARTS or parts[0] != ROOT:
        return None
    kind, enclave, namespace, name = parts[5], _plain(parts[6]), _plain(parts[7]), _plain(parts[8])
    node = ObservedNode(f"{namespace.rstrip('/')}/{name}", seen, enclave if enclave != "/" else "")
    if kind == NODE:
        return node, None
    if kind not in ROLES or len(parts) < ENDPOINT_PARTS:
        return None
    type_ = ros_type(parts[10])
    digest = parts[11] if type_ and parts[11].startswith("RIHS") else ""
    return node, ObservedEndpoint(node.name, ROLES[kind], _plain(parts[9]), seen, type_, digest, key, "", (DOOR,))


def _plain(part: str) -> str:
    return part.replace("%", "/")
