"""The server of the page: an application and a socket go in; it answers on this machine only, until it is stopped.

The socket is bound here and handed to uvicorn, so that the port is known before anybody is told of it.
"""

from __future__ import annotations

import gc
import getpass
import os
import socket
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, reason, shown
from rosprivacy.explorer.web.guard import ADDRESS

if TYPE_CHECKING:
    from collections.abc import Mapping

    import uvicorn
    from starlette.types import ASGIApp

GARBAGE = 100_000  # new objects after which it is looked for: once in some answers
SSH_PORT = "22"
SSH_PARTS = 4  # of SSH_CONNECTION: address and port of the client, address and port of the server


def bound_socket(port: int) -> socket.socket:
    """Return a socket of this machine alone; with port 0 the system chooses one."""
    try:
        return socket.create_server((ADDRESS, port))
    except OSError as error:
        problem, hint = f"cannot listen there: {reason(error)}", "name another port, or none"
        raise InputError(f"{ADDRESS}:{port}", 0, problem, hint) from None


def server(app: ASGIApp) -> uvicorn.Server:
    """Return a server that says nothing of itself and writes no list of what was asked: the link stands there."""
    import uvicorn  # noqa: PLC0415 - light start

    settings = uvicorn.Config(
        app,
        access_log=False,
        log_level="warning",
        server_header=False,
        proxy_headers=False,
        lifespan="off",
        ws="none",
        timeout_graceful_shutdown=1,
    )
    return uvicorn.Server(settings)


def collect_garbage() -> None:
    """Have Python look for garbage, as a program needs that runs for days: a command that ends soon need not.

    What is there by now stays, and is not looked through each time.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(GARBAGE, 10, 10)


def tunnel(port: int, environment: Mapping[str, str] = os.environ) -> str:
    """Return the line that brings the page to the machine from which a user came by SSH; empty where nobody did.

    Both ends have the same port, since the server answers to no other.

    >>> tunnel(8700, {"SSH_CONNECTION": "192.0.2.7 51234 192.0.2.9 22", "USER": "anna", "LOGNAME": "anna"})
    'ssh -N -L 8700:127.0.0.1:8700 anna@192.0.2.9'
    >>> tunnel(8700, {})
    ''
    """
    parts = environment.get("SSH_CONNECTION", "").split()
    if len(parts) != SSH_PARTS:
        return ""
    host, ssh_port = parts[2], parts[3]
    user = environment.get("LOGNAME") or environment.get("USER") or getpass.getuser()
    other = "" if ssh_port == SSH_PORT else f"-p {ssh_port} "
    return shown(f"ssh -N {other}-L {port}:{ADDRESS}:{port} {user}@{host}")
