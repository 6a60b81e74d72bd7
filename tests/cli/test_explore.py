"""``rosprivacy explore`` as a process: it prints a link that works and ends by Ctrl+C; more in tests/explorer."""

from __future__ import annotations

import http.client
import re
import signal
import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING
from urllib.parse import urlencode, urlsplit

import pytest

from tests.helpers.explorers import BARE, FACTORY, node

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

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
            process.communicate(timeout=SECONDS)


def entered(line: str) -> tuple[http.client.HTTPConnection, dict[str, str]]:
    """A connection behind the link, and what a browser then sends."""
    found = re.search(r"http://127\.0\.0\.1:(\d+)/enter\?token=\S+", line)
    assert found, line
    there = urlsplit(found[0])
    asking = http.client.HTTPConnection(there.netloc, timeout=SECONDS)
    asking.request("GET", f"{there.path}?{there.query}")
    answer = asking.getresponse()
    answer.read()
    assert answer.status == 303
    headers = {"cookie": answer.headers["set-cookie"].partition(";")[0], "origin": f"http://{there.netloc}"}
    return asking, {**headers, "content-type": "application/x-www-form-urlencoded"}


def test_the_link_opens_the_page_and_what_is_saved_stands_in_the_named_file(tmp_path: Path) -> None:
    labels = tmp_path / "new.labels.yaml"
    with started("-l", str(labels), "--lang", "de") as (process, lines):
        asking, headers = entered(lines[0])
        asking.request("GET", "/", headers=headers)
        assert "Zu entscheiden" in asking.getresponse().read().decode()
        said = {"version": "0", "element": node("/robot_camera"), "role": "source", "brings": "Video"}
        for path, form, status in (("/label", said, 303), ("/save", {"version": "1"}, 303), ("/undo", said, 409)):
            asking.request("POST", path, urlencode(form), headers)
            answer = asking.getresponse()
            answer.read()
            assert answer.status == status
        asking.close()
    assert process.returncode == 0
    assert "/robot_camera: {source: [Video]}" in labels.read_text("utf-8")


def test_a_review_asks_in_the_readers_language_and_saves_who_answered(tmp_path: Path) -> None:
    labels = tmp_path / "new.labels.yaml"
    with started("-l", str(labels), "--review", "--lang", "fr") as (process, lines):
        asking, headers = entered(lines[0])
        said = {"version": "0", "element": node("/robot_camera"), "role": "source", "brings": "Video", "by": "A. Lee"}
        for path, form in (("/label", said), ("/save", {"version": "1"})):
            asking.request("POST", path, urlencode(form), headers)
            answer = asking.getresponse()
            answer.read()
            assert answer.status == 303
        asking.request("GET", answer.headers["location"], headers=headers)
        assert "Toutes les réponses sont enregistrées" in asking.getresponse().read().decode()
        asking.close()
    assert process.returncode == 0
    assert "A. Lee" in labels.read_text("utf-8")


def test_a_decision_goes_to_the_file_that_the_command_names(tmp_path: Path) -> None:
    labels, decisions = str(FACTORY / "run2.labels.yaml"), tmp_path / "new.decisions.yaml"
    with started("-l", labels, "--decisions", str(decisions)) as (process, lines):
        asking, headers = entered(lines[0])
        said = {"version": "0", "finding": "dc5715a35ba5591a", "choice": "mitigate", "owner": "A. Lee"}
        asking.request("POST", "/decide", urlencode(said), headers)
        answer = asking.getresponse()
        answer.read()
        assert answer.status == 303
        asking.close()
    assert process.returncode == 0
    assert "id: dc5715a35ba5591a" in decisions.read_text("utf-8")


def test_what_is_not_saved_is_told_at_the_end(tmp_path: Path) -> None:
    with started("-l", str(tmp_path / "new.labels.yaml")) as (process, lines):
        asking, headers = entered(lines[0])
        said = {"version": "0", "element": node("/robot_camera"), "role": "source", "brings": "Video"}
        asking.request("POST", "/label", urlencode(said), headers)
        assert asking.getresponse().status == 303
        asking.close()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=SECONDS)
    assert errors == "Not saved: what was said of 1 element\n"
    assert not (tmp_path / "new.labels.yaml").exists()


def test_who_came_by_ssh_is_told_the_way() -> None:
    with started(SSH_CONNECTION="192.0.2.7 51234 192.0.2.9 22", LOGNAME="anna") as (_, lines):
        port = re.search(r":(\d+)/enter", lines[0])
        assert port
        assert f"ssh -N -L {port[1]}:127.0.0.1:{port[1]} anna@192.0.2.9" in lines[2]


@pytest.mark.parametrize("option", [("--fleet", "f.yaml"), ("--from-database",)])
def test_what_it_does_not_take_is_refused(cli: Cli, option: tuple[str, ...]) -> None:
    assert cli("explore", str(BARE), *option).returncode == 2


def test_nothing_is_decided_about_a_database(cli: Cli) -> None:
    done = cli("explore", "--from-database", "--decisions", "d.yaml")
    assert done.returncode == 2
    assert "--decisions: is for policies and fleets" in done.stderr


def test_a_review_of_a_database_has_no_file_for_answers(cli: Cli) -> None:
    done = cli("explore", "--from-database", "--review")
    assert done.returncode == 2
    assert "--review: has no file for answers in a database" in done.stderr


def test_a_policy_that_is_not_there_is_one_line(cli: Cli, tmp_path: Path) -> None:
    done = cli("explore", "no.policy.xml", cwd=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
