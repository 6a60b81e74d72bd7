"""``rosprivacy observe`` through the live doors, end to end: foreign peers on loopback, a policy, the planted finding.

DDS peers are Fast DDS, with GIDs of both lengths; Zenoh's tokens are declared as rmw_zenoh does. ``--watch`` tells who
comes, the finding that this makes, and who leaves.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import closing, contextmanager
from typing import TYPE_CHECKING

import pytest
import yaml

from tests.helpers.certificates import authority, signed
from tests.helpers.command import refused, run
from tests.helpers.zenoh_tokens import endpoint, free_endpoint, node, router, session

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from tests.helpers.command import Cli
    from tests.helpers.fastdds import Peer

LABELS = "labels: 1\nnodes:\n  /head/camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n"
IMAGE = "sensor_msgs::msg::dds_::Image_"
DOMAINS = iter(range(30 + os.getpid() % 30, 100))
SLACK = 30.0  # seconds; a loaded machine may take some
PROCESS_SECONDS = 20.0  # for the first analysis of a process beside others on a loaded machine; alone it takes one


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    return tmp_path


def camera(peer: Peer, domain: int, gid_bytes: int = 16) -> None:
    peer.does("participant", domain, "/robot/head", gid_bytes)
    peer.node("/head", "camera", ("writer", "rt/image", IMAGE))
    peer.does("announce")


def uplink(peer: Peer, domain: int, gid_bytes: int = 16) -> None:
    peer.does("participant", domain, "", gid_bytes)
    peer.node("/", "uplink", ("reader", "rt/image", IMAGE))
    peer.does("announce")


def holds_the_finding(robot: Path, made_up: int) -> None:
    """The planted finding, from the files that were written."""
    done = run("analyze", "robot.policy.xml", "-l", "labels.yaml", "-f", "json", cwd=robot)
    document = json.loads(done.stdout)
    assert done.returncode == 1, done.stderr
    witnesses = [[element["name"] for element in one["witness"]] for one in document["findings"]]
    assert witnesses == [["/head/camera", "/image", "/uplink"]]
    types = yaml.safe_load((robot / "robot.types.yaml").read_text())
    (entry,) = types["topics"]["/image"]
    assert (entry["type"], entry["writers"], entry["readers"]) == (
        "sensor_msgs/msg/Image",
        ["/head/camera"],
        ["/uplink"],
    )
    policy = (robot / "robot.policy.xml").read_text()
    assert 'path="/robot/head"' in policy
    assert policy.count('enclave="made-up"') == made_up


@pytest.mark.slow
@pytest.mark.parametrize("gid_bytes", [16, 24], ids=["Iron and later", "Humble"])
def test_from_a_dds_domain_to_the_planted_finding(peer: Peer, other: Peer, robot: Path, gid_bytes: int) -> None:
    domain = next(DOMAINS)
    camera(peer, domain, gid_bytes)
    uplink(other, domain, gid_bytes)
    for seconds in ("8s", "30s"):  # a loaded machine may need longer, and says so
        words = ["--dds", "--interface", "lo", "--domain", str(domain), "--for", seconds, "-o", "robot.policy.xml"]
        done = run("observe", *words, cwd=robot)
        if done.returncode == 0 and "known gap" not in done.stderr:
            break
        for file in robot.glob("robot.*"):
            file.unlink()
    assert done.returncode == 0, done.stderr
    assert "2 nodes, 1 channel: observed from " in done.stderr
    assert "known gap" not in done.stderr
    holds_the_finding(robot, made_up=1)


@pytest.mark.slow
@pytest.mark.xdist_group("zenoh")
@pytest.mark.parametrize("option", [["--zenoh"], ["--zenoh", "--router"]], ids=" ".join)
def test_from_a_zenoh_router_to_the_planted_finding(robot: Path, option: list[str]) -> None:
    with router() as where, session(where) as one:
        tokens = [
            node(7, "camera", "%robot%head", "%head"),
            endpoint(7, "MP", "camera", "/image", IMAGE, enclave="%robot%head", space="%head"),
            endpoint(7, "MS", "uplink", "/image", IMAGE),
        ]
        kept = [one.liveliness().declare_token(token) for token in tokens]
        words = [*option, where, "--for", "3s", "-o", "robot.policy.xml"]
        done = run("observe", *words, cwd=robot, ROS_DOMAIN_ID="7")
        assert kept
    assert done.returncode == 0, done.stderr
    assert "by zenoh" in done.stderr
    holds_the_finding(robot, made_up=1)


@pytest.fixture(scope="module")
def certificates(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Those of a router and of a client by one CA, and another CA that has signed nothing."""
    folder = tmp_path_factory.mktemp("certificates")
    authority(folder, "ca")
    authority(folder, "other")
    signed(folder, "router", "ca")
    signed(folder, "client", "ca")
    return folder


def tls(folder: Path, ca: str, client: str = "") -> dict[str, object]:
    """What a session file says of TLS; with a client's certificate also of mutual TLS."""
    own = {"connect_certificate": str(folder / f"{client}.pem"), "connect_private_key": str(folder / f"{client}.key")}
    return {"root_ca_certificate": str(folder / f"{ca}.pem"), **(own if client else {})}


@contextmanager
def secured_router(folder: Path, *, mutual: bool) -> Iterator[str]:
    """A router that shows a certificate, and asks for one where this is mutual; behind it one node."""
    shows = {"listen_certificate": str(folder / "router.pem"), "listen_private_key": str(folder / "router.key")}
    asks = {"root_ca_certificate": str(folder / "ca.pem"), "enable_mtls": mutual}
    with (
        router("tls", transport__link__tls={**shows, **asks}) as where,
        session(where, transport__link__tls={**tls(folder, "ca", "client"), "enable_mtls": mutual}) as one,
    ):
        kept = one.liveliness().declare_token(node(7, "camera"))
        yield where
        kept.undeclare()


def looked_by_file(robot: Path, where: str, **says: object) -> subprocess.CompletedProcess[str]:
    session_file = {"mode": "peer", "connect": {"endpoints": [where]}, "transport": {"link": {"tls": says}}}
    (robot / "session.json5").write_text("// mine\n" + json.dumps(session_file))
    words = ["--zenoh", "--session-file", "session.json5", "--domain", "7", "--for", "2s", "-o", "robot.policy.xml"]
    return run("observe", *words, cwd=robot)


@pytest.mark.slow
@pytest.mark.xdist_group("zenoh")
@pytest.mark.parametrize("client", ["", "client"], ids=["TLS", "mutual TLS"])
def test_a_session_file_with_tls_looks_behind_a_secured_router(robot: Path, certificates: Path, client: str) -> None:
    with secured_router(certificates, mutual=bool(client)) as where:
        done = looked_by_file(robot, where, **tls(certificates, "ca", client), enable_mtls=bool(client))
    assert done.returncode == 0, done.stderr
    assert "1 node, 0 channels: observed from " in done.stderr
    assert 'node="camera"' in (robot / "robot.policy.xml").read_text()


@pytest.mark.slow
@pytest.mark.xdist_group("zenoh")
@pytest.mark.parametrize("ca", ["other", "not there"])
def test_a_ca_that_has_not_signed_the_router_is_one_line(robot: Path, certificates: Path, ca: str) -> None:
    with secured_router(certificates, mutual=False) as where:
        done = looked_by_file(robot, where, **tls(certificates, ca))
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (3, "", 1)
    assert (
        f"no Zenoh router answers as session.json5 says: Unable to connect to any of [Single({where})]" in done.stderr
    )
    assert "or the certificates do not fit: see transport/link/tls in your session file" in done.stderr
    assert not (robot / "robot.policy.xml").exists()


@contextmanager
def watching(robot: Path, *words: str) -> Iterator[tuple[subprocess.Popen[str], list[str]]]:
    """``observe --watch``, and the lines that it has printed so far."""
    command = [sys.executable, "-m", "rosprivacy", "observe", "--watch", "-l", "labels.yaml", *words]
    lines: list[str] = []
    with subprocess.Popen(
        command, cwd=robot, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ}
    ) as process:
        assert process.stdout is not None
        reader = threading.Thread(target=lambda: lines.extend(iter(process.stdout.readline, "")))  # type: ignore[union-attr]
        reader.start()
        try:
            yield process, lines
        finally:
            process.kill()
            reader.join()


def told(lines: list[str], what: str, seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if any(what in line for line in lines):
            return
        time.sleep(0.05)
    raise AssertionError((what, lines))


def discovered(domain: int, node: str) -> Generator[bool]:
    """Whether the middleware itself has told of a node by now: nothing but its readers, asked again and again."""
    from rosprivacy.ingest.running.dds_door import configuration
    from rosprivacy.ingest.running.dds_graph import DdsGraph
    from rosprivacy.ingest.running.dds_participant import joined

    graph = DdsGraph()
    with joined(domain, configuration(domain, (), "lo")) as readers:
        while True:
            readers.take(graph, "2026-11-22T10:00:00Z")
            yield any(one.name == node for of in graph.nodes.values() for one in of)
            time.sleep(0.02)


@pytest.mark.slow
def test_watch_tells_a_new_path_to_a_leak_and_who_leaves(peer: Peer, other: Peer, robot: Path) -> None:
    """It is told in at most twice the time that the middleware itself needs, measured beside it."""
    domain = next(DOMAINS)
    camera(peer, domain)
    words = ["--dds", "--interface", "lo", "--domain", str(domain), "-o", "robot.policy.xml"]
    with watching(robot, *words) as (process, lines), closing(discovered(domain, "/uplink")) as bare:
        told(lines, "/head/camera", SLACK)
        assert not any("new finding" in line for line in lines)
        uplink(other, domain)
        begun = time.monotonic()
        assert any(bare)
        own = time.monotonic() - begun
        told(lines, "! new finding", SLACK)
        assert time.monotonic() - begun <= 2 * own + PROCESS_SECONDS
        finding = next(line for line in lines if "new finding" in line)
        assert "Video: /head/camera -> /image -> /uplink" in finding
        seen = len(lines)
        other.does("leave")
        begun = time.monotonic()
        while not any("/uplink" in line for line in lines[seen:]):
            assert time.monotonic() - begun < SLACK, lines
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)  # as a supervisor ends it; tests of the other door send Ctrl-C
        assert process.wait(timeout=SLACK) == 0
    holds_the_finding(robot, made_up=1)  # what was seen once stays (S16)


@pytest.mark.parametrize(("door", "package"), [("--dds", "cyclonedds"), ("--zenoh", "zenoh")], ids=["DDS", "Zenoh"])
def test_a_missing_package_is_one_line_that_names_what_to_install(door: str, package: str, tmp_path: Path) -> None:
    (tmp_path / "hidden").mkdir()
    (tmp_path / "hidden" / f"{package}.py").write_text("raise ImportError('not installed here')\n")
    done = run("observe", door, cwd=tmp_path, PYTHONPATH=str(tmp_path / "hidden"))
    (line,) = refused(done)
    assert f"install the extra [{door.removeprefix('--')}]" in line
    assert "--text" in line


def test_no_router_is_one_line_and_exit_code_3(tmp_path: Path) -> None:
    done = run("observe", "--zenoh", "--router", free_endpoint(), "--for", "1s", cwd=tmp_path)
    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    assert "no Zenoh router answers at" in done.stderr


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["--zenoh", "--peer", "127.0.0.1"],
        ["--dds", "--router", "tcp/127.0.0.1:1"],
        ["--dds", "tcp/127.0.0.1:1"],
        ["--text", "a.txt", "b.txt"],
        ["--zenoh", "tcp/127.0.0.1:1", "--router", "tcp/127.0.0.1:1"],
        ["--dds", "--domain", "233"],
    ],
    ids=" ".join,
)
def test_options_that_do_not_go_together_are_refused(words: list[str], cli: Cli, tmp_path: Path) -> None:
    done = cli("observe", *words, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
