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
from tests.helpers.observed import robot_text
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

ROBOTS = sorted((ROOT / "tests" / "cases" / "try").glob("*.yaml"))
OTHERS = sorted((ROOT / "tests" / "cases" / "try" / "by_others").glob("*.yaml"))  # written without the program


def test_the_example_is_one_of_these_robots() -> None:
    text = (ROOT / "examples" / "telepresence" / "graph.txt").read_text("utf-8")
    assert text == robot_text(yaml.safe_load((ROOT / "tests" / "cases" / "try" / "telepresence.yaml").read_text()))


@pytest.fixture
def graph(tmp_path: Path) -> Any:
    def write(robot: dict[str, Any]) -> Path:
        file = tmp_path / "graph.txt"
        file.write_text(robot_text(robot))
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


def test_what_does_not_count_beside_a_surer_source_is_named(cli: Cli, graph: Any) -> None:
    robot = yaml.safe_load((ROOT / "tests" / "cases" / "try" / "telepresence.yaml").read_text())
    (line,) = re.findall(r"^Not counted beside what is surer: .*", cli("try", graph(robot)).stdout, re.MULTILINE)
    assert "position of a robot with a person (/base_driver)" in line
    assert "video of persons" not in line  # the camera's, which counts


@pytest.mark.parametrize("file", OTHERS, ids=lambda file: file.stem)
def test_of_robots_by_others_no_worst_way_out_is_passed_over(cli: Cli, graph: Any, file: Path) -> None:
    """Two of the three at least are numbered; all are named."""
    robot = yaml.safe_load(file.read_text())
    done = cli("try", graph(robot))
    numbered = set(re.findall(r"^\d\. (/[^,]+), ", done.stdout, re.MULTILINE))
    worst = {way[2] for way in robot["truth"][:3]}
    assert len(numbered & worst) >= 2, done.stdout
    assert all(exit_ in done.stdout for exit_ in worst), done.stdout


@pytest.mark.parametrize("file", [*ROBOTS, *OTHERS], ids=lambda file: file.stem)
def test_every_true_way_out_is_named(cli: Cli, graph: Any, file: Path) -> None:
    """As a place where data gets out or ends, or as a node of which nobody knows what it does."""
    robot = yaml.safe_load(file.read_text())
    names = set(re.findall(r"/[\w/]+", cli("try", graph(robot)).stdout))
    assert {way[2] for way in robot["truth"] if "may be" not in way} <= names


def test_a_node_that_begins_data_and_gets_other_data_is_named(cli: Cli, graph: Any) -> None:
    """That it is suggested as a source says nothing of what it does with what it gets."""
    image, text = "sensor_msgs/msg/Image", "std_msgs/msg/String"
    robot = {
        "nodes": {
            "/front_cam": {"publishes": {"/image_raw": image}},
            "/robot_cam": {"publishes": {"/more/image_raw": image}, "subscribes": {"/image_raw": image}},
            "/end": {"subscribes": {"/more/image_raw": image, "/said": text}},
        }
    }
    (line,) = (line for line in cli("try", graph(robot)).stdout.splitlines() if line.startswith("Not known: what "))
    assert "/robot_cam" in line
    assert "/front_cam" not in line


def test_where_all_kinds_get_out_it_is_said_so(cli: Cli, graph: Any) -> None:
    sensors = {
        "/a": "sensor_msgs/msg/Image", "/b": "audio_common_msgs/msg/AudioData", "/c": "sensor_msgs/msg/LaserScan",
        "/d": "sensor_msgs/msg/NavSatFix", "/e": "sensor_msgs/msg/Joy", "/f": "people_msgs/msg/People",
    }  # fmt: skip
    nodes: dict[str, Any] = {f"/driver{name[1:]}": {"publishes": {name: kind}} for name, kind in sensors.items()}
    nodes |= {"/uploader": {"subscribes": sensors}, "/mqtt": {"subscribes": {"/a": sensors["/a"]}}}
    text = cli("try", graph({"nodes": nodes})).stdout
    first = r"^1\. /uploader, to a network\n   all \d+ kinds of data: Video, Voice, "
    assert re.search(first, text, re.MULTILINE), text


def test_pictures_do_not_leave_by_diagnostics_where_there_is_another_way(cli: Cli, graph: Any) -> None:
    """The way that is shown goes along channels whose types are made for the data; the other comes after it."""
    image, said = "sensor_msgs/msg/Image", "diagnostic_msgs/msg/DiagnosticArray"
    robot = {
        "nodes": {
            "/usb_cam": {"publishes": {"/image_raw": image, "/diagnostics": said}},
            "/overlay": {"subscribes": {"/image_raw": image}, "publishes": {"/lines": image}},
            "/rosbag2_recorder": {"subscribes": {"/lines": image, "/diagnostics": said}},
            "/uploader": {"subscribes": {"/diagnostics": said}},
        }
    }
    text = cli("try", graph(robot)).stdout
    assert "Video: /usb_cam -> /image_raw -> /overlay -> /lines -> /rosbag2_recorder" in text
    assert re.findall(r"^\d\. (/[^,]+), ", text, re.MULTILINE) == ["/rosbag2_recorder", "/uploader"]
    assert text.count("only along channels whose types are made for other data") == 1


def test_where_data_ends_it_may_get_out_and_who_lets_out_what_comes_later_is_told(cli: Cli, graph: Any) -> None:
    """A node with a name that tells nothing; and a bridge that reads only when somebody connects."""
    image, count = "sensor_msgs/msg/Image", "std_msgs/msg/UInt32"
    robot = {
        "nodes": {
            "/usb_cam": {"publishes": {"/image_raw": image}},
            "/kx7": {"subscribes": {"/image_raw": image}, "publishes": {"/kx7/count": count}},
            "/foxglove_bridge": {"publishes": {"/x": count}},
        }
    }
    text = cli("try", graph(robot)).stdout
    assert "1. /kx7, where to is not known" in text
    assert "Video: /usb_cam -> /image_raw -> /kx7" in text
    assert "nothing was seen to get there: /foxglove_bridge" in text


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
    assert "Not known: what 2 nodes do with data: /omega, /alpha" in done.stdout
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


@pytest.mark.parametrize("file", OTHERS, ids=lambda file: file.stem)
def test_init_writes_a_label_file_that_people_open(cli: Cli, graph: Any, tmp_path: Path, file: Path) -> None:
    """Only what brings data in, makes it or lets it out: what else could be said is found again by suggest."""
    graph(yaml.safe_load(file.read_text()))
    assert cli("init", "--from-try", "graph.txt", cwd=tmp_path).returncode == 0
    text = (tmp_path / "robot.labels.yaml").read_text()
    assert len(text) < 12_000
    roles = set(re.findall(r'": \{"(\w+)": ', text))
    assert roles <= {"source", "leak", "derives"}
    assert "leak" in roles


def test_init_keeps_what_try_has_shown(cli: Cli, graph: Any, tmp_path: Path) -> None:
    graph(yaml.safe_load(ROBOTS[0].read_text()))
    done = cli("init", "--from-try", "graph.txt", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    made = {"robot.policy.xml", "robot.types.yaml", "robot.labels.yaml", "rosprivacy.toml"}
    assert {file.name for file in tmp_path.iterdir()} == {"graph.txt", *made}
    assert "rosprivacy-" not in "".join((tmp_path / name).read_text() for name in made)
    first = cli("analyze", cwd=tmp_path)
    assert first.returncode == 4  # they are suggestions: nobody has said anything yet
    (line,) = (line for line in first.stderr.splitlines() if " to answer: " in line)
    assert line in done.stdout
    assert line.split()[0] == str((tmp_path / "robot.labels.yaml").read_text().count("\n# suggest: "))
    assert " to answer: " not in cli("analyze", "-q", cwd=tmp_path).stderr
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
