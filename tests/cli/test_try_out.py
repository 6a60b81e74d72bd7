"""``rosprivacy try``: the worst true ways out of four robots first; a suggestion is never an all-clear."""

from __future__ import annotations

import os
import pty
import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest
import yaml

from tests.helpers.command import cli, refused
from tests.helpers.observed import node_info
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

ROBOTS = sorted((ROOT / "tests" / "cases" / "try").glob("*.yaml"))


def text_of(robot: dict[str, Any]) -> str:
    """What ``ros2 node info`` prints of a robot."""
    parts = []
    for name, said in robot["nodes"].items():
        sections = {
            section: "; ".join(f"{topic}: {kind}" for topic, kind in said.get(word, {}).items())
            for section, word in (("publishers", "publishes"), ("subscribers", "subscribes"))
        }
        parts.append(node_info(name, **sections))
    return "".join(parts)


def test_the_example_is_one_of_these_robots() -> None:
    text = (ROOT / "examples" / "telepresence" / "graph.txt").read_text("utf-8")
    assert text == text_of(yaml.safe_load((ROOT / "tests" / "cases" / "try" / "telepresence.yaml").read_text()))


@pytest.fixture
def graph(tmp_path: Path) -> Any:
    def write(robot: dict[str, Any]) -> Path:
        file = tmp_path / "graph.txt"
        file.write_text(text_of(robot))
        return file

    return write


@pytest.mark.parametrize("file", ROBOTS, ids=lambda file: file.stem)
def test_two_of_the_three_worst_true_ways_come_first(cli: Cli, graph: Any, file: Path) -> None:
    robot = yaml.safe_load(file.read_text())
    done = cli("try", graph(robot))
    assert done.returncode == 4, done.stderr
    exits = re.findall(r"^\d\. (/[^,]+), ", done.stdout, re.MULTILINE)
    worst = robot["truth"][:3]
    assert len({tuple(way) for way in worst if way[2] in exits}) >= 2, done.stdout
    assert "/rosprivacy-try-" not in done.stdout
    for _, _, way_out in robot["truth"]:
        assert way_out in done.stdout, way_out


def test_nothing_is_written_and_what_is_stated_counts(cli: Cli, examples: Path, tmp_path: Path) -> None:
    policy, labels = (examples / "care-home" / f"care-home.{what}" for what in ("policy.xml", "labels.yaml"))
    done = cli("try", policy, "-l", labels, cwd=tmp_path)
    assert done.returncode == 1
    assert "This is stated, not suggested." in done.stdout
    assert done.stdout.splitlines()[-2].startswith("leak: ")
    assert not list(tmp_path.iterdir())


def test_where_nothing_is_seen_it_says_what_was_not_seen(cli: Cli, graph: Any) -> None:
    quiet = {
        "nodes": {
            "/alpha": {"publishes": {"/x": "std_msgs/msg/Empty"}},
            "/omega": {"subscribes": {"/x": "std_msgs/msg/Empty"}},
        }
    }
    done = cli("try", graph(quiet))
    assert done.returncode == 4
    assert "That is no all-clear" in done.stdout
    assert "Not known: what 2 nodes do with data: /alpha, /omega" in done.stdout
    assert "no-leak-found" not in done.stdout


def test_what_closes_a_way_never_counts(cli: Cli, graph: Any) -> None:
    """A node called blur is suggested as one that takes persons out: the way through it is shown all the same."""
    robot = {
        "nodes": {
            "/usb_cam": {"publishes": {"/image_raw": "sensor_msgs/msg/Image"}},
            "/face_anonymizer": {
                "subscribes": {"/image_raw": "sensor_msgs/msg/Image"},
                "publishes": {"/image_blurred": "sensor_msgs/msg/Image"},
            },
            "/uploader": {"subscribes": {"/image_blurred": "sensor_msgs/msg/Image"}},
        }
    }
    assert (
        "/usb_cam -> /image_raw -> /face_anonymizer -> /image_blurred -> /uploader" in cli("try", graph(robot)).stdout
    )


def test_what_is_no_input_is_refused(cli: Cli, graph: Any, examples: Path) -> None:
    text, policy = graph({"nodes": {"/a": {}}}), examples / "care-home" / "care-home.policy.xml"
    for words in ((), (text, policy), ("--ros2", policy)):
        assert cli("try", *words).returncode == 2


def test_init_keeps_what_try_has_shown(cli: Cli, graph: Any, tmp_path: Path) -> None:
    graph(yaml.safe_load(ROBOTS[0].read_text()))
    done = cli("init", "--from-try", "graph.txt", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    made = {"robot.policy.xml", "robot.types.yaml", "robot.labels.yaml", "rosprivacy.toml"}
    assert {file.name for file in tmp_path.iterdir()} == {"graph.txt", *made}
    assert "rosprivacy-" not in "".join((tmp_path / name).read_text() for name in made)
    first = cli("analyze", cwd=tmp_path)
    assert first.returncode == 4  # they are suggestions: nobody has said anything yet
    assert cli("labels", "--accept", "likely", "--by", "Ada", cwd=tmp_path).returncode == 0
    assert cli("try", cwd=tmp_path).returncode in (1, 4)
    before = {name: (tmp_path / name).read_bytes() for name in made}
    again = cli("init", "--from-try", "graph.txt", cwd=tmp_path)
    assert len(refused(again)) == 3  # all but the label file, which is taken as it is
    assert before == {name: (tmp_path / name).read_bytes() for name in made}


def test_init_asks_few_questions_and_only_on_a_terminal(cli: Cli, examples: Path, tmp_path: Path) -> None:
    assert "on a terminal" in cli("init", examples / "care-home" / "care-home.policy.xml", cwd=tmp_path).stderr
    assert (
        "lies outside"
        in cli("init", "--from-try", examples / "care-home" / "care-home.policy.xml", cwd=tmp_path).stderr
    )
    assert "POLICY" in cli("init", "--from-try", cwd=tmp_path).stderr
    assert not list(tmp_path.iterdir())


def test_names_that_no_project_file_can_state_are_refused(cli: Cli, examples: Path, tmp_path: Path) -> None:
    policy = tmp_path / "a\nb.policy.xml"
    policy.write_bytes((examples / "factory" / "node.xml").read_bytes())
    assert "such a name" in "".join(refused(cli("init", "--from-try", policy.name, cwd=tmp_path)))


def test_who_ends_the_questions_has_found_no_leak(examples: Path, tmp_path: Path) -> None:
    shutil.copytree(examples / "factory", tmp_path, dirs_exist_ok=True)
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "rosprivacy", "init", "before.policy.xml"]
    with subprocess.Popen(command, cwd=tmp_path, stdin=theirs, stdout=subprocess.PIPE) as process:
        os.write(ours, b"\x04")
        assert process.wait(60) == 130
    os.close(ours)
    os.close(theirs)
    assert not (tmp_path / "rosprivacy.toml").exists()
