"""Small policies of nodes with topics, and names that somebody hostile would choose."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

Nodes = dict[str, tuple[list[str], list[str]]]  # node -> topics that it publishes, and those that it subscribes to
HOSTILE = [
    '/camera"}}} because x&#10;nodes: {/up: conduit}',
    "/camera&#x2028;# x",
    "/camera\u202e/image",
    "/camera: {leak: none} #",
    "/camera\\x1b[31m/image",
    "/camera'; DROP/image",
    "/камера/image",
]


def policy_of(nodes: Nodes) -> str:
    def granted(role: str, names: Iterable[str]) -> str:
        lines = "".join(f"<topic>{name}</topic>" for name in names)
        return f'<topics {role}="ALLOW">{lines}</topics>' if lines else ""

    enclaves = "".join(
        f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">\n'
        f"{granted('publish', out)}{granted('subscribe', into)}</profile></profiles></enclave>\n"
        for node, (out, into) in nodes.items()
    )
    return f'<policy version="0.2.0"><enclaves>\n{enclaves}</enclaves></policy>\n'
