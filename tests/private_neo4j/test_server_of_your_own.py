"""A server as people have it: behind TLS, with an authority of their own; and a copy of the private one as a backup.

The server is the real one. What stands before it ends the TLS, as a gateway does.
"""

from __future__ import annotations

import shutil
import socket
import ssl
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

import pytest

from rosprivacy.private_neo4j import connection
from tests.helpers.certificates import authority, signed
from tests.helpers.command import run

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.private_neo4j.connection import Connection

pytestmark = [pytest.mark.database, pytest.mark.slow]
THERE = "MATCH (n:OfMyOwn) RETURN n.note AS note"
ADDED = "MERGE (n:OfMyOwn {note: 'by hand'}) RETURN n.note"


@pytest.fixture
def gateway(neo4j_server: Connection, tmp_path: Path) -> Iterator[int]:
    """The port of what takes TLS, with a certificate of the authority ``own``, and gives it to the server."""
    authority(tmp_path, "own")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(*signed(tmp_path, "server", "own"))
    host, _, port = neo4j_server.uri.rpartition("/")[2].rpartition(":")

    def serve(taken: socket.socket) -> None:
        with (
            suppress(OSError),
            context.wrap_socket(taken, server_side=True) as client,
            socket.create_connection((host, int(port))) as server,
        ):
            back = Thread(target=relay, args=(server, client), daemon=True)
            back.start()
            relay(client, server)
            back.join()

    def accept() -> None:
        with suppress(OSError):
            while True:
                Thread(target=serve, args=(listener.accept()[0],), daemon=True).start()

    with socket.create_server(("127.0.0.1", 0)) as listener:
        Thread(target=accept, daemon=True).start()
        yield listener.getsockname()[1]


def relay(source: socket.socket, target: socket.socket) -> None:
    with suppress(OSError):
        while data := source.recv(1 << 16):
            target.sendall(data)
        target.shutdown(socket.SHUT_WR)


def asked(port: int, to: Connection, authority: str) -> tuple[int, str, str]:
    uri = f"bolt+s://127.0.0.1:{port}"
    done = run(
        "query", "--cypher", "RETURN 42 AS answer", "-f", "csv",
        NEO4J_URI=uri, NEO4J_USERNAME="neo4j", NEO4J_PASSWORD=to.password, SSL_CERT_FILE=authority,
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


def test_a_certificate_of_an_authority_that_is_named_is_taken(
    gateway: int, neo4j_server: Connection, tmp_path: Path
) -> None:
    assert asked(gateway, neo4j_server, str(tmp_path / "own.pem")) == (0, "answer\n42\n", "")


def test_any_other_is_refused_in_one_line_that_says_why(gateway: int, neo4j_server: Connection) -> None:
    code, output, errors = asked(gateway, neo4j_server, "")
    assert (code, output, len(errors.splitlines())) == (3, "", 1)
    assert "its certificate is not trusted: unable to get local issuer certificate; " in errors
    assert neo4j_server.password not in errors


def test_a_copy_of_the_folder_is_a_backup(private_neo4j: Connection, tmp_path: Path) -> None:
    """Of the private server, while it is stopped: what a person added by hand is in it."""
    with connection.open_driver(private_neo4j) as driver:
        driver.execute_query(ADDED)
    folder = Path(run("db", "path").stdout.strip())
    assert run("db", "stop").returncode == 0
    shutil.copytree(folder, tmp_path / "data" / folder.name)
    data = str(tmp_path / "data")
    try:
        found = run("query", "--cypher", THERE, "-f", "csv", seconds=180, ROSPRIVACY_DATA=data)
        assert (found.returncode, found.stdout) == (0, "note\nby hand\n")
    finally:
        assert run("db", "stop", ROSPRIVACY_DATA=data).returncode == 0
