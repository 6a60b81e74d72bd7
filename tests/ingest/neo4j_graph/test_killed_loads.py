"""Who writes the database, or the database itself, is killed in mid-load: a robot is there whole or not at all."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.private_neo4j import connection, server
from tests.helpers import java
from tests.helpers.command import LINE
from tests.helpers.forked_runs import OF_SOCKETS, Forked, Run
from tests.helpers.graphs import CARE, FACTORY, dump
from tests.helpers.paths import ROOT
from tests.helpers.plain import STOP_AT_THE_END

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.private_neo4j.connection import Connection

State = tuple[set[str], list[str]]
OTHER = ("load", f"{CARE}/care-home.policy.xml", "-l", f"{CARE}/care-home.labels.yaml", "--robot", "other")
FIRST = ("load", f"{FACTORY}/before.policy.xml", "-l", f"{FACTORY}/run3.labels.yaml", "--robot", "r")
SECOND = ("load", f"{FACTORY}/after.policy.xml", "-l", f"{FACTORY}/run5.labels.yaml", "--robot", "r")
GONE = ("unload", "--robot", "r")
SMALL = "from rosprivacy.ingest.neo4j_graph import loading; loading.BATCH = 500"  # many transactions
AT_ONCE = "import neo4j; neo4j.Session.execute_write = lambda self, work, *a, **k: work(self, *a, **k)"  # each commits
HALF = (
    "MATCH (r:Robot) WHERE r.elements <> COUNT { (r)<-[:OF_ROBOT]-(e WHERE NOT e:Intake) } "
    "OR r.flows <> COUNT { (r)<-[:OF_ROBOT]-()-[:FLOWS_TO]->() } RETURN r.name"
)
PATIENCE = 60.0  # seconds
OTHERS = "SHOW TRANSACTIONS YIELD currentQuery WHERE NOT currentQuery STARTS WITH 'SHOW' RETURN count(*)"


@dataclass
class Database:
    """A database, and the program that writes to it."""

    program: Forked
    driver: Driver

    def run(self, arguments: tuple[str, ...], at: int = 0, victim: int = 0, before: str = "") -> tuple[int, str, int]:
        """Exit code, standard error, and how often it sent something."""
        ended = self.program(Run(arguments, str(ROOT), OF_SOCKETS, at, victim=victim, before=before))
        return ended.code, ended.error, len(ended.made)

    def is_after(self, *commands: tuple[str, ...]) -> State:
        """What is there after some commands, from nothing on."""
        self.driver.execute_query("MATCH (n) DETACH DELETE n")
        for arguments in commands:
            assert self.run(arguments, before=SMALL)[0] == 0
        return self.now()

    def now(self) -> State:
        """What is there, when the server has seen that the client is gone."""
        end = time.monotonic() + PATIENCE
        while self.driver.execute_query(OTHERS).records[0][0]:
            assert time.monotonic() < end
        return dump(self.driver, without=("version",))


@pytest.fixture
def shared(neo4j_server: Connection) -> Iterator[Database]:
    assert neo4j_server
    with connection.open_driver(connection.connection(None)) as driver, Forked(ROOT, OTHER) as program:
        yield Database(program, driver)


def moments(sent: int, kills: int, every: int) -> list[int]:
    """Some of the calls with which a run sends something, each when it begins or when it ends."""
    number = kills if every == 1 else 1  # a server that is cold takes seconds for each load
    return sorted(Random(kills).sample(range(1, sent + 1), number))  # noqa: S311 - repeatable


def small_fleet(folder: Path) -> Path:
    """The fleet of the examples, with one or two robots of each model."""
    shutil.copytree(ROOT / "examples" / "fleet", folder)
    file = folder / "fleet.yaml"
    file.write_text(re.sub(r"robots: \d+", "robots: 2", file.read_text("utf-8")), "utf-8")
    return file


@pytest.mark.slow
@pytest.mark.database
class TestTheClientIsKilled:
    @pytest.mark.parametrize(("command", "kills"), [(SECOND, 16), (GONE, 10)], ids=["loads", "unloads"])
    def test_that_writes_a_robot(self, shared: Database, command: tuple[str, ...], kills: int, every: int) -> None:
        """The robot is as it was or as it is to be; the command that was killed ends its work when it runs again."""
        old = shared.is_after(OTHER, FIRST)
        new = shared.is_after(OTHER, *((SECOND,) if command == SECOND else ()))
        assert old != new
        shared.is_after(OTHER, FIRST)
        sent = shared.run(command)[2]
        states = []
        for at in moments(sent, kills, every):
            shared.is_after(OTHER, FIRST)
            assert shared.run(command, at)[0] == -signal.SIGKILL
            states.append(shared.now())
            assert states[-1] in (old, new)
            assert shared.run(command)[0] == (2 if command == GONE and states[-1] == new else 0)
            assert shared.now() == new
        assert old in states or every > 1

    def test_that_loads_a_fleet(self, shared: Database, tmp_path: Path, every: int) -> None:
        fleet = ("load", "--fleet", str(small_fleet(tmp_path / "fleet")))
        new = shared.is_after(OTHER, fleet)
        shared.is_after(OTHER)
        sent = shared.run(fleet, before=SMALL)[2]
        for at in moments(sent, 14, every):
            other = shared.is_after(OTHER)
            assert shared.run(fleet, at, before=SMALL)[0] == -signal.SIGKILL
            shared.now()
            assert shared.driver.execute_query(HALF).records == []
            assert other[0] <= shared.now()[0]
            assert shared.run(fleet)[0] == 0
            assert shared.now() == new

    def test_and_without_transactions_it_is_seen(self, shared: Database) -> None:
        """That the tests above can fail."""
        old, new = shared.is_after(OTHER, FIRST), shared.is_after(OTHER, SECOND)
        shared.is_after(OTHER, FIRST)
        sent = shared.run(SECOND, before=AT_ONCE)[2]
        for at in range(sent, 0, -2):
            shared.is_after(OTHER, FIRST)
            shared.run(SECOND, at, before=AT_ONCE)
            if shared.now() not in (old, new):
                return
        pytest.fail("none was half")


@pytest.fixture
def own_server(local_extra: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A private Neo4j that nobody else uses; it is stopped at the end, however that comes."""
    assert local_extra is None
    for name in ("NEO4J_URI", "NEO4J_USERNAME", "NEO4J_PASSWORD"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("ROSPRIVACY_DATA", str(tmp_path / "data"))
    monkeypatch.setenv("ROSPRIVACY_NEO4J_HEAP", "256m")
    monkeypatch.setenv("JDK_JAVA_OPTIONS", java.options(java.SERIAL))
    with subprocess.Popen([sys.executable, "-c", STOP_AT_THE_END], stdin=subprocess.PIPE, start_new_session=True):
        yield


@pytest.mark.slow
@pytest.mark.database
@pytest.mark.usefixtures("own_server")
def test_the_server_is_killed(every: int) -> None:
    """The client says so in one line, or had done its work; after a start nothing is half, and loading goes on.

    Who starts it is killed first, in the moment in which the server is there and nobody has noted it.
    """
    with Forked(ROOT) as program:
        starter = program(Run(("db", "start"), str(ROOT), ("fork_exec",), at=4))  # the first process sets the password
        assert starter.code == -signal.SIGKILL, starter
        end = time.monotonic() + PATIENCE
        while not connection.status().running:  # for a moment after its birth a process has no command line yet
            assert time.monotonic() < end
    with Forked(ROOT, OTHER) as program:
        with connection.open_driver(connection.start()) as driver:
            database = Database(program, driver)
            old, new = database.is_after(OTHER, FIRST), database.is_after(OTHER, SECOND)
            database.is_after(OTHER, FIRST)
            sent = database.run(SECOND)[2]
            database.is_after(OTHER, FIRST)
        for at in moments(sent, 20, every):
            found = server.running(connection.state_folder())
            assert found
            code, error, _ = database.run(SECOND, at, victim=found.pid)
            assert code in (0, 3), error
            assert code == 0 or [bool(LINE.match(line)) for line in error.splitlines()] == [True], error
            with connection.open_driver(connection.start()) as driver:
                database = Database(program, driver)
                left = database.now()
                assert left in (old, new)
                assert left == new or code == 3
                assert database.run(SECOND)[0] == 0
                assert database.now() == new
                assert database.is_after(OTHER, FIRST) == old
