"""A Zenoh router, and a session that declares liveliness tokens as rmw_zenoh does, on loopback."""

from __future__ import annotations

import json
import socket
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import zenoh

if TYPE_CHECKING:
    from collections.abc import Iterator

HASH = "RIHS01_" + "ab" * 32


def free_endpoint() -> str:
    """An address on which nobody listens."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{one.getsockname()[1]}"


def _settings(**values: object) -> Any:
    config = zenoh.Config()
    config.insert_json5("scouting/multicast/enabled", "false")
    for key, value in values.items():
        config.insert_json5(key.replace("__", "/"), json.dumps(value))
    return config


@contextmanager
def router(protocol: str = "tcp", where: str = "", **values: object) -> Iterator[str]:
    """A router, on a port that is free where none is named; yields where it is."""
    where = where or free_endpoint().replace("tcp/", f"{protocol}/")
    with zenoh.open(_settings(mode="router", listen__endpoints=[where], **values)):
        yield where


@contextmanager
def session(where: str, **values: object) -> Iterator[Any]:
    """A session of rmw_zenoh, as far as the graph goes."""
    latched = {"timestamping__enabled": True}  # what publishers that keep their messages need
    with zenoh.open(
        _settings(mode="client", connect__endpoints=[where], listen__endpoints=[], **latched, **values)
    ) as one:
        yield one


@contextmanager
def opened_alone(**values: object) -> Iterator[Any]:
    """A session that looks for nobody."""
    with zenoh.open(_settings(mode="peer", connect__endpoints=[], listen__endpoints=[], **values)) as one:
        yield one


def node(domain: int, name: str, enclave: str = "%", space: str = "%") -> str:
    """The token of a node."""
    return f"@ros2_lv/{domain}/aa/0/0/NN/{enclave}/{space}/{name}"


def endpoint(domain: int, kind: str, name: str, channel: str, type_: str, **more: str) -> str:
    """The token of an endpoint; ``more`` may name its enclave, namespace and hash, and what follows the token."""
    enclave, space, hashed = more.get("enclave", "%"), more.get("space", "%"), more.get("hashed", HASH)
    head = f"@ros2_lv/{domain}/aa/0/{abs(hash((kind, name, channel))) % 10**9}/{kind}/{enclave}/{space}/{name}"
    return f"{head}/{channel.replace('/', '%')}/{type_}/{hashed}/::,10:,:,:,,{more.get('after', '')}"
