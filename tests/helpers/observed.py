"""Observations as tests make them."""

from __future__ import annotations

from typing import Any

from rosprivacy.ingest.running.observation import Observation, ObservedEndpoint, ObservedNode, Span

AT = "2026-11-22T10:00:00Z"
EMPTY = ("Subscribers", "Publishers", "Service Servers", "Service Clients", "Action Servers", "Action Clients")


def at(minute: int) -> str:
    """A time of that morning."""
    return f"2026-11-22T10:{minute:02}:00Z"


def looked(*names: str, first: int = 0, last: int = 0, door: str = "text") -> Observation:
    """Nodes that were there from one minute to another."""
    span = Span(at(first), at(last))
    return Observation((door,), span, tuple(ObservedNode(name, span) for name in names))


def endpoint(
    node: str,
    role: str,
    name: str,
    kind: str = "",
    *,
    hash: str = "",  # noqa: A002 - as the field is called
    key: str = "",
    participant: str = "",
) -> ObservedEndpoint:
    """An endpoint that was seen once."""
    return ObservedEndpoint(node, role, name, Span(AT, AT), kind, hash, key, participant)


def saw(*endpoints: ObservedEndpoint, door: str = "text", **gaps: int) -> Observation:
    """An observation of some endpoints."""
    return Observation((door,), Span(AT, AT), (), endpoints, gaps={k.replace("_", "-"): n for k, n in gaps.items()})


def node_info(node: str, **sections: str) -> str:
    """What ``ros2 node info`` prints of a node; sections as ``publishers="/a: t/msg/T"``, entries with ; between."""
    lines = [node]
    for title in EMPTY:
        lines.append(f"  {title}:")
        entries = sections.get(title.lower().replace(" ", "_"), "")
        lines += [f"    {entry.strip()}" for entry in entries.split(";") if entry.strip()]
    return "\n".join([*lines, ""]) + "\n"


SECTIONS = {
    "subscribers": "subscribes", "publishers": "publishes", "service_servers": "serves", "service_clients": "calls",
    "action_servers": "acts", "action_clients": "asks",
}  # fmt: skip


def robot_text(robot: dict[str, Any]) -> str:
    """What ``ros2 node info`` prints of a robot of ``tests/cases/try``."""
    parts = []
    for name, said in robot["nodes"].items():
        sections = {
            section: "; ".join(f"{topic}: {kind}" for topic, kind in said.get(word, {}).items())
            for section, word in SECTIONS.items()
        }
        parts.append(node_info(name, **sections))
    return "".join(parts)
