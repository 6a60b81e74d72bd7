"""``rosprivacy explore`` as a process: it prints a link that works and ends by Ctrl+C; more in tests/explorer."""

from __future__ import annotations

import http.client
import re
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlencode, urlsplit

import pytest

from tests.helpers.explorers import BARE, FACTORY, node

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.helpers.command import Cli

SECONDS = 60


@contextmanager
def started(*options: str, **environment: str) -> Iterator[tuple[subprocess.Popen[str], list[str]]]:
    """The program, and the lines that it has printed up to the link and what it says of it."""
    words = [sys.executable, "-u", "-m", "rosprivacy", "explore", str(BARE), "--no-open", *options]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={"PATH": "", **environment}
    ) as process:
        assert process.stdout
        lines = [process.stdout.readline() for _ in range(3 if "SSH_CONNECTION" in environment else 2)]
        try:
            yield process, lines
        finally:
            process.send_signal(signal.SIGINT)
            try:
                process.communicate(timeout=SECONDS)
            except subprocess.TimeoutExpired:
                process.kill()  # or the end of ``with`` would wait for ever
                raise


def entered(line: str) -> tuple[http.client.HTTPConnection, dict[str, str]]:
    """A connection behind the link, and what a browser then sends."""
    found = re.search(r"http://127\.0\.0\.1:(\d+)/enter\?token=\S+", line)
    assert found, line
    there = urlsplit(found[0])
    asking = http.client.HTTPConnection(there.netloc, timeout=SECONDS)
    asking.request("GET", f"{there.path}?{there.query}")
    answer = asking.getresponse()
    answer.read()
    assert answer.status == 200
    headers = {"cookie": answer.headers["set-cookie"].partition(";")[0], "origin": f"http://{there.netloc}"}
    return asking, {**headers, "content-type": "application/x-www-form-urlencoded"}


def post(asking: http.client.HTTPConnection, headers: dict[str, str], path: str, **form: str) -> tuple[int, str | None]:
    """Send a form about the first version of the page, or about the one that is named; status, and where to go on."""
    asking.request("POST", path, urlencode({"version": "0", **form}), headers)
    answer = asking.getresponse()
    answer.read()
    return answer.status, answer.headers["location"]


def page(asking: http.client.HTTPConnection, headers: dict[str, str], path: str = "/") -> str:
    asking.request("GET", path, headers=headers)
    return asking.getresponse().read().decode()


CAMERA = {"element": node("/robot_camera"), "role": "source", "brings": "Video"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "words"),
    [(("--lang", "de"), "Zu entscheiden"), (("--review", "--lang", "fr"), "Toutes les réponses sont enregistrées")],
    ids=["page", "review"],
)
def test_the_link_opens_the_page_and_what_is_saved_stands_in_the_named_file(
    tmp_path: Path, options: tuple[str, ...], words: str
) -> None:
    """In the reader's language, and with who answered."""
    labels = tmp_path / "new.labels.yaml"
    with started("-l", str(labels), *options) as (process, lines):
        asking, headers = entered(lines[0])
        assert post(asking, headers, "/label", **CAMERA, by="A. Lee")[0] == 303
        status, there = post(asking, headers, "/save", version="1")
        assert status == 303
        assert words in page(asking, headers, there or "/")
        assert post(asking, headers, "/undo")[0] == 409
        asking.close()
    assert process.returncode == 0
    assert '/robot_camera: {source: [Video], author: "A. Lee"}' in labels.read_text("utf-8")


def test_a_decision_goes_to_the_file_that_the_command_names(tmp_path: Path) -> None:
    decisions = tmp_path / "new.decisions.yaml"
    options = ("-l", str(FACTORY / "run2.labels.yaml"), "--decisions", str(decisions))
    with started(*options) as (process, lines):
        asking, headers = entered(lines[0])
        assert post(asking, headers, "/decide", finding="dc5715a35ba5591a", choice="mitigate", owner="A. Lee")[0] == 303
        asking.close()
    assert process.returncode == 0
    assert "id: dc5715a35ba5591a" in decisions.read_text("utf-8")


@pytest.mark.slow
def test_what_is_not_saved_is_told_at_the_end_and_is_kept(tmp_path: Path) -> None:
    with started("-l", str(tmp_path / "new.labels.yaml"), ROSPRIVACY_DATA=str(tmp_path)) as (process, lines):
        asking, headers = entered(lines[0])
        assert post(asking, headers, "/label", **CAMERA)[0] == 303
        asking.close()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=SECONDS)
    assert errors == "Not saved: what was said of 1 element; it is kept, and the same command offers to take it up\n"
    assert not (tmp_path / "new.labels.yaml").exists()


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ((BARE, "--fleet", "f.yaml"), "--fleet"),
        ((BARE, "--from-database"), "--from-database"),
        (("--from-database", "--decisions", "d.yaml"), "--decisions: is for policies and fleets"),
        (("--from-database", "--review"), "--review: has no file for answers in a database"),
        (("no.policy.xml",), "no.policy.xml: file not found"),
    ],
    ids=["fleet", "database beside policies", "decisions", "review", "no such file"],
)
def test_what_it_does_not_take_is_refused(cli: Cli, words: tuple[str | Path, ...], problem: str) -> None:
    done = cli("explore", *words)
    assert (done.returncode, problem in done.stderr) == (2, True), done.stderr


@pytest.mark.slow
def test_who_came_by_ssh_is_told_the_way() -> None:
    with started(SSH_CONNECTION="192.0.2.7 51234 192.0.2.9 22", LOGNAME="anna") as (_, lines):
        port = re.search(r":(\d+)/enter", lines[0])
        assert port
        assert f"ssh -N -L {port[1]}:127.0.0.1:{port[1]} anna@192.0.2.9" in lines[2]
        entered(lines[0])[0].close()  # it serves: Ctrl+C before that can be lost


@pytest.mark.slow
def test_no_argument_of_the_browser_holds_the_secret(tmp_path: Path) -> None:
    """Everybody on the machine can read what programs are called with; the file that is opened, its user alone."""
    browser, seen = tmp_path / "browser", tmp_path / "seen"
    browser.write_text(
        f"#!/bin/sh\nfor one; do printf '%s\\n' \"$one\"; done > {seen}.new\n/bin/mv {seen}.new {seen}\n"
    )
    browser.chmod(0o755)
    words = [sys.executable, "-u", "-m", "rosprivacy", "explore", str(BARE)]
    told = {"PATH": "", "HOME": str(tmp_path), "DISPLAY": ":9", "BROWSER": str(browser)}
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=told) as process:
        assert process.stdout
        line = process.stdout.readline()
        wait_until(seen.exists)
        (address,) = seen.read_text().split()
        page = Path(urlsplit(address).path)
        secret = line.rpartition("token=")[2].strip()
        assert secret not in address
        assert f"token={secret}'" in page.read_text()
        assert page.stat().st_mode & 0o777 == 0o600
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=SECONDS)
    assert not page.exists()


def wait_until(there: Callable[[], bool]) -> None:
    until = time.monotonic() + SECONDS
    while not there():
        assert time.monotonic() < until
        time.sleep(0.05)


@pytest.mark.slow
@pytest.mark.parametrize("of", [0, 60_000])
def test_a_form_that_is_broken_off_is_no_error_of_the_program(tmp_path: Path, of: int) -> None:
    with started("-l", str(tmp_path / "new.labels.yaml")) as (process, lines):
        asking, headers = entered(lines[0])
        asking.close()
        for _ in range(3):
            with socket.create_connection((asking.host, asking.port), timeout=SECONDS) as broken:
                said = {**headers, "host": f"{asking.host}:{asking.port}", "content-length": "60001"}
                head = "".join(f"{name}: {value}\r\n" for name, value in said.items())
                broken.sendall(f"POST /label HTTP/1.1\r\n{head}\r\n".encode() + b"x" * of)
        again = http.client.HTTPConnection(asking.host, asking.port, timeout=SECONDS)
        again.request("GET", "/", headers=headers)
        assert again.getresponse().status == 200
        again.close()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=SECONDS)
        assert errors == ""
