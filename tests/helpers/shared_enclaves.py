"""A small system of which only the enforced view has a finding, as policies by enclaves; and a fleet of such."""

from __future__ import annotations

Enclaves = dict[str, dict[str, list[tuple[str, str, str]]]]
EXAMPLE = {"/robot": {"/camera": [("publish", "/video", "ALLOW")],
                      "/blur": [("subscribe", "/video", "ALLOW"), ("publish", "/blurred", "ALLOW")]},
           "/uplink": {"/uplink": [("subscribe", "/blurred", "ALLOW")]}}  # fmt: skip
EXAMPLE_LABELS = """labels: 1
nodes: {/camera: {source: [Video]}, /blur: {sanitizer: {Video: anonymise}}, /uplink: {leak: [Video]}}
channels: {/video: sensitive, /blurred: sensitive}
"""
THREE = {
    "/robot": {**EXAMPLE["/robot"], "/navigator": [("subscribe", "/scan", "ALLOW")]},
    "/uplink": EXAMPLE["/uplink"],
}
FLEET = """fleet: 1
models: {carrier: {policies: [p.xml], labels: [l.yaml]}}
robots:
  apart: {policies: [apart.xml], labels: [l.yaml]}
  open: {policies: [open.xml], labels: [l.yaml]}
groups: [{robots: 2, model: carrier}]
"""


def policy(enclaves: Enclaves) -> str:
    lines = ['<policy version="0.2.0"><enclaves>']
    for path, profiles in enclaves.items():
        lines.append(f'<enclave path="{path}"><profiles>')
        for node, rights in profiles.items():
            lines.append(f'<profile ns="/" node="{node[1:]}">')
            lines += [f'<topics {role}="{rule}"><topic>{topic}</topic></topics>' for role, topic, rule in rights]
            lines.append("</profile>")
        lines.append("</profiles></enclave>")
    return "\n".join([*lines, "</enclaves></policy>\n"])


def apart(enclaves: Enclaves, chosen: list[str]) -> Enclaves:
    """The policy that somebody writes who splits some enclaves: a DENY goes with each of their nodes."""
    found: Enclaves = {}
    for path, profiles in enclaves.items():
        denied = [right for rights in profiles.values() for right in rights if right[2] == "DENY"]
        for node, rights in profiles.items():
            where = f"{path}{node}" if path in chosen else path
            found.setdefault(where, {})[node] = [*rights, *denied] if path in chosen else rights
    return found
