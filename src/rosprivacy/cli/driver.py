"""The Neo4j that a command talks to."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from neo4j import Driver


def driver_of(server: str | None) -> AbstractContextManager[Driver]:
    """Open a driver to the server that is named, or to the private one."""
    from rosprivacy.private_neo4j.connection import connection, open_driver

    return open_driver(connection(server))
