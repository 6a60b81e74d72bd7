"""Which Neo4j the commands talk to: the user's own, or a private one that is started when it is needed."""

from __future__ import annotations

import logging
import os
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from rosprivacy.analysis.errors import DatabaseError, shown
from rosprivacy.private_neo4j import server
from rosprivacy.private_neo4j.jars import VERSION, bar, on_terminal
from rosprivacy.private_neo4j.state import locked, make_password, state_folder

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    import neo4j

    from rosprivacy.private_neo4j.jars import Progress

__all__ = ["Connection", "Status", "connection", "open_driver", "start", "state_folder", "status", "stop"]

USER = "neo4j"
UNTRUSTED = "name the file of its authority in SSL_CERT_FILE; an address with +ssc trusts any, for a trial"
SCHEMES = ("neo4j", "neo4j+s", "neo4j+ssc", "bolt", "bolt+s", "bolt+ssc")
START_LIMIT = 120.0  # seconds
CONNECT_LIMIT = 15.0
RETRY_LIMIT = 15.0  # the driver's own, 30 s, is long where a server has died
LOG_SHOWN = 3  # lines


@dataclass(frozen=True, slots=True)
class Connection:
    """Where a Neo4j is and who we are there.

    Attributes
    ----------
    uri, username, password
        The password is not shown in tracebacks.
    origin
        Where a person looks if the server does not let us in.
    database
        Of those that the server has; None for the one that is the user's own there.
    """

    uri: str
    username: str
    password: str = field(repr=False)
    origin: str = "NEO4J_USERNAME and NEO4J_PASSWORD"
    database: str | None = None


@dataclass(frozen=True, slots=True)
class Status:
    """Of the private server.

    Attributes
    ----------
    running
        Whether its process is there.
    uri, browser
        The Bolt address and the page of the Neo4j Browser; None while it is stopped.
    version
        Of Neo4j.
    folder, password_file
        The state folder, and where in it the password is kept.
    """

    running: bool
    uri: str | None
    browser: str | None
    version: str
    folder: Path
    password_file: Path


def status() -> Status:
    """Return how the private server is; this starts nothing and waits for nothing."""
    folder = state_folder()
    found = server.running(folder)
    return Status(
        running=found is not None,
        uri=_bolt(found) if found else None,
        browser=f"http://{server.HOST}:{found.http}/browser/" if found else None,
        version=found.version if found else VERSION,
        folder=folder,
        password_file=server.password_file(folder),
    )


def start(progress: Progress = bar) -> Connection:
    """Start the private server if it does not run, and wait until it answers. It goes on when this program ends.

    Every start gives it a new password.

    Parameters
    ----------
    progress
        Wraps the server's libraries and their number while they are fetched, the first time.
    """
    with locked() as folder:
        found = server.running(folder)
        if found:
            return _ready(folder, found, 0)
        log = server.log_file(folder)
        written = log.stat().st_size if log.exists() else 0
        if on_terminal():
            print("Starting the private Neo4j; this takes some seconds", file=sys.stderr)
        try:
            return _renewed(folder, _ready(folder, server.launch(folder, progress), written))
        except BaseException:  # also Ctrl-C: what nobody waits for any more is not left behind half started
            found = server.running(folder)
            if found:
                server.terminate(folder, found)
            raise


def stop() -> bool:
    """Stop the private server; return whether there was one to stop."""
    if not server.running(state_folder()):
        return False
    with locked() as folder:
        found = server.running(folder)
        if found:
            server.terminate(folder, found)
        return found is not None


def connection(uri: str | None) -> Connection:
    """Return the Neo4j to use: the one named, the one in ``NEO4J_URI``, or the private one, started if need be.

    User name and password of a named one stand in ``NEO4J_USERNAME`` and ``NEO4J_PASSWORD``: other users of the
    machine can read a command line. ``NEO4J_DATABASE`` names one of its databases.

    Parameters
    ----------
    uri
        Of a server, without user name and password.

    Raises
    ------
    DatabaseError
        If the address is none, the password is missing, or there is no server named and no ``[local]`` extra.
    """
    uri = uri or os.environ.get("NEO4J_URI")
    if not uri:
        return start()
    _check(uri)
    password = os.environ.get("NEO4J_PASSWORD")
    if not password:
        raise DatabaseError(f"{shown(uri)}: NEO4J_PASSWORD is not set; put the password into this environment variable")
    username, database = os.environ.get("NEO4J_USERNAME") or USER, os.environ.get("NEO4J_DATABASE")
    return Connection(uri, username, password, database=database or None)


@contextmanager
def open_driver(to: Connection) -> Iterator[neo4j.Driver]:
    """Open a driver, see that the server answers, and close it at the end.

    What a query does wrong is not touched here; that the server is lost in the middle of it is.
    """
    import neo4j  # noqa: PLC0415 - light start
    from neo4j.exceptions import AuthError, DriverError, Neo4jError, ServiceUnavailable, SessionExpired  # noqa: PLC0415

    # The driver's log and the server's hints on queries are not for users; who sets up logging still gets them.
    logging.getLogger("neo4j").addHandler(logging.NullHandler())
    place = shown(to.uri)
    verified = False
    try:
        with neo4j.GraphDatabase.driver(
            to.uri,
            auth=(to.username, to.password),
            connection_timeout=CONNECT_LIMIT,
            max_transaction_retry_time=RETRY_LIMIT,
            notifications_min_severity="OFF",
            telemetry_disabled=True,
        ) as driver:
            driver.verify_connectivity()
            if to.database:  # a driver has no setting for it, and every session that is opened here is of one database
                driver.session = partial(driver.session, database=to.database)  # type: ignore[method-assign]
                with driver.session() as session:
                    session.run("RETURN 1").consume()
            verified = True
            yield driver
    except AuthError as error:
        raise DatabaseError(f"{place}: user name or password is not accepted; check {to.origin}") from error
    except (ServiceUnavailable, SessionExpired) as error:
        if (distrust := _distrust(error)) and not verified:
            problem, hint = f"its certificate is not trusted: {distrust}", UNTRUSTED
        else:
            problem = f"{'the server is lost' if verified else 'no Neo4j answers there'}: {_first_line(error)}"
            hint = "start it, or check address and network"
        raise DatabaseError(f"{place}: {problem}; {hint}") from error
    except (DriverError, Neo4jError) as error:
        if verified:
            raise
        code = str(getattr(error, "code", ""))
        if "DatabaseNotFound" in code:
            problem = f"it has no database {shown(to.database or '')}; check NEO4J_DATABASE"
            raise DatabaseError(f"{place}: {problem}") from error
        if "AuthenticationRateLimit" in code:
            problem = "user name or password was not accepted several times, so the server lets nobody in for a while"
            raise DatabaseError(f"{place}: {problem}; check {to.origin}, then try again") from error
        raise DatabaseError(f"{place}: {_first_line(error)}; check the address and the server") from error


def _check(uri: str) -> None:
    """Refuse what the driver would misread: it takes port 99999 for 34463, and shows passwords in its messages."""
    try:
        parts = urlsplit(uri)
        port = parts.port
    except ValueError:
        parts, port = urlsplit(""), None
    if parts.username is not None or parts.password is not None:
        hint = "put them into NEO4J_USERNAME and NEO4J_PASSWORD"
        raise DatabaseError(f"--neo4j or NEO4J_URI: user name and password do not belong in the address; {hint}")
    if parts.scheme not in SCHEMES or not parts.hostname or port == 0:
        hint = f"write one like bolt://localhost:7687 ({', '.join(SCHEMES)})"
        raise DatabaseError(f"{shown(uri)}: is not the address of a Neo4j; {hint}")


def _distrust(error: BaseException | None) -> str:
    """What is wrong with a certificate, if that is behind an error of the driver."""
    import ssl  # noqa: PLC0415 - light start

    while error is not None:
        if isinstance(error, ssl.SSLCertVerificationError):
            return error.verify_message
        error = error.__cause__ or error.__context__
    return ""


def _first_line(error: Exception) -> str:
    return shown(str(error).partition("\n")[0].rstrip(":"))


def _bolt(running: server.Server) -> str:
    return f"bolt://{server.HOST}:{running.bolt}"


def _ready(folder: Path, running: server.Server, written: int) -> Connection:
    """Wait until the server answers Bolt and the page of the browser can be asked for.

    Parameters
    ----------
    written
        How much of the log is older than this start.
    """
    end = time.monotonic() + START_LIMIT
    while time.monotonic() < end:
        # Bolt comes first and the page a moment later; a refused attempt of the driver costs more than this look.
        if server.listens(folder, running):
            return _let_in(folder, running)
        if not server.running(folder):
            raise DatabaseError(_failure(folder, "the private server ended while it started", written))
        time.sleep(0.1)
    problem = f"the private server does not listen on its ports within {START_LIMIT:.0f} s"
    raise DatabaseError(_failure(folder, problem, written))


def _let_in(folder: Path, running: server.Server) -> Connection:
    """Connect with the password that is kept, or with the next one if a start was broken off while it was taken."""
    to = Connection(_bolt(running), USER, server.read_password(folder), str(server.password_file(folder)))
    later = server.next_password_file(folder)
    try:
        with open_driver(to):
            return to
    except DatabaseError:
        if not later.exists():
            raise
    to = replace(to, password=later.read_text("ascii"))
    with open_driver(to):
        later.replace(server.password_file(folder))
        return to


def _renewed(folder: Path, to: Connection) -> Connection:
    """Give the server a new password: one that somebody learnt is worth nothing after the next start."""
    later = server.next_password_file(folder)
    new = make_password(later)
    with open_driver(to) as driver:
        change = "ALTER CURRENT USER SET PASSWORD FROM $old TO $new"
        driver.execute_query(change, old=to.password, new=new, database_="system")
    later.replace(server.password_file(folder))
    return replace(to, password=new)


def _failure(folder: Path, problem: str, written: int) -> str:
    log = server.log_file(folder)
    with log.open("rb") as file:
        file.seek(written)
        text = file.read().decode("utf-8", "replace")
    # Java's stack frames fill the end of the log and say nothing to a user.
    lines = [line.strip() for line in text.splitlines() if line.strip() and not line.startswith(("\t", " "))]
    said = " | ".join(shown(line) for line in lines[-LOG_SHOWN:])
    return f"{shown(str(log))}: {problem}: {said}; read the log and try again"
