"""``rosprivacy db``: the private Neo4j, started, stopped and asked after.

The password is never printed, only where it is kept: what a terminal shows is seen, recorded and pasted.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import typer

from rosprivacy.cli.help import Group
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from rosprivacy.private_neo4j.connection import Status

app = typer.Typer(cls=Group, no_args_is_help=True)


@app.command()
def start() -> None:
    """Start the private Neo4j if it does not run, and say where it is; fetch it the first time (155 MB)."""
    from rosprivacy.private_neo4j import connection

    connection.start()
    _print(_described(connection.status()))


@app.command()
def stop() -> None:
    """Stop the private Neo4j; its data stay."""
    from rosprivacy.private_neo4j import connection

    _print("Neo4j was running and is stopped" if connection.stop() else "Neo4j was not running")


@app.command()
def status() -> None:
    """Say whether the private Neo4j runs, and where."""
    from rosprivacy.private_neo4j import connection

    _print(_described(connection.status()))


@app.command()
def path() -> None:
    """Print the folder that holds the private Neo4j's data, settings, logs and password."""
    from rosprivacy.private_neo4j import connection

    _print(str(connection.state_folder()))


def _described(found: Status) -> str:
    from rosprivacy.private_neo4j.connection import USER

    if found.running:
        lines = [
            f"Neo4j {found.version} is running",
            f"Bolt:      {found.uri}",
            f"Browser:   {found.browser}",
            f"User name: {USER}",
            f"Password:  in {found.password_file}",
        ]
    else:
        lines = [f"Neo4j {found.version} is stopped; start it with: rosprivacy db start"]
    lines.append(f"Files:     {found.folder}")
    if os.environ.get("NEO4J_URI"):
        lines.append("Note:      NEO4J_URI is set, so the other commands use the server that it names")
    return "\n".join(lines)


def _print(text: str) -> None:
    emit(f"{text}\n", None)
