"""``scan`` says what code makes, with lines; other commands take the folder as they take a policy."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from tests.helpers.checkouts import put_checkout
from tests.helpers.command import Cli, refused

if TYPE_CHECKING:
    from pathlib import Path

LABELS = "labels: 1\nnodes:\n  /robot/camera: {source: [Video]}\n  /uploader: {leak: [Video]}\n"
LEAK, UNDETERMINED, BAD = 1, 4, 2


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    put_checkout(tmp_path / "robot")
    (tmp_path / "l.yaml").write_text(LABELS)
    return tmp_path


def test_it_says_nodes_channels_and_what_lies_outside(cli: Cli, robot: Path) -> None:
    done = cli("scan", "robot", cwd=robot)
    assert done.returncode == UNDETERMINED
    assert "2 nodes, 2 channels" in done.stdout
    assert "/uploader" in done.stdout
    assert "cloud.example" in done.stdout


def test_what_it_writes_is_answered_as_the_folder_is(cli: Cli, robot: Path) -> None:
    assert cli("scan", "robot", "-o", "r.policy.xml", cwd=robot).returncode == UNDETERMINED
    written = cli("analyze", "r.policy.xml", "--types", "r.types.yaml", "-l", "l.yaml", "-f", "json", cwd=robot)
    direct = cli("analyze", "robot", "-l", "l.yaml", "-f", "json", cwd=robot)
    assert written.returncode == direct.returncode == LEAK
    steps = [json.loads(done.stdout)["findings"][0]["steps"] for done in (written, direct)]
    assert steps[0] == steps[1]
    lines = [(line["file"], line["line"], line["basis"]) for step in steps[0] for line in step["policy"]]
    assert lines == [("robot/guide/camera.py", 11, "launch"), ("robot/guide/uploader.py", 10, "launch")]


def test_a_launch_file_that_records_all_is_a_way_out(cli: Cli, robot: Path) -> None:
    launch = robot / "robot" / "launch" / "guide.launch.py"
    record = "from launch.actions import ExecuteProcess\n"
    text = launch.read_text().replace("    ])\n", "        ExecuteProcess(cmd='ros2 bag record -a'.split()),\n    ])\n")
    launch.write_text(record + text)
    done = cli("try", "robot", cwd=robot)
    assert done.returncode == UNDETERMINED
    assert "/robot/camera -> /robot/image -> /* -> /rosbag2_recorder" in done.stdout
    cli("scan", "robot", "-o", "r.policy.xml", cwd=robot)
    written = cli("try", "r.policy.xml", "--types", "r.types.yaml", cwd=robot)
    assert "-> /* -> /rosbag2_recorder" in written.stdout


def test_what_lies_outside_is_written_as_labels_to_review(cli: Cli, robot: Path) -> None:
    compose = "services:\n  broker:\n    image: eclipse-mosquitto\n    ports: ['1883:1883']\n"
    (robot / "robot" / "docker-compose.yml").write_text(compose)
    cli("scan", "robot", "-o", "r.policy.xml", cwd=robot)
    text = (robot / "r.outside.labels.yaml").read_text()
    assert '# suggest: may {"nodes": {"/uploader": {"leak"' in text
    assert "broker" in text
    done = cli("analyze", "r.policy.xml", "-l", "r.outside.labels.yaml", cwd=robot)
    assert done.returncode == UNDETERMINED, done.stderr


def test_data_that_is_logged_goes_to_log_files(cli: Cli, robot: Path) -> None:
    uploader = robot / "robot" / "guide" / "uploader.py"
    logged = "        self.get_logger().info(f'got {message.data}')\n        requests.post"
    uploader.write_text(uploader.read_text().replace("        requests.post", logged))
    done = cli("scan", "robot", "-o", "r.policy.xml", cwd=robot)
    assert "logged: data of channels" in done.stdout
    text = (robot / "r.outside.labels.yaml").read_text()
    assert "~/.ros/log" in text
    assert "uploader" in text


def test_a_saved_graph_keeps_lines_of_the_code(cli: Cli, robot: Path) -> None:
    cli("analyze", "robot", "-l", "l.yaml", "--save-graph", "g.json", cwd=robot)
    done = cli("analyze", "--add", "g.json", "-l", "l.yaml", "-f", "json", cwd=robot)
    steps = json.loads(done.stdout)["findings"][0]["steps"]
    assert [line["basis"] for step in steps for line in step["policy"]] == ["launch", "launch"]


def test_the_same_code_is_the_same_bytes_and_nothing_is_written_over(cli: Cli, robot: Path) -> None:
    for name in ("a", "b"):
        cli("scan", "robot", "-o", f"{name}.policy.xml", cwd=robot)
    assert (robot / "a.policy.xml").read_bytes() == (robot / "b.policy.xml").read_bytes()
    (line,) = refused(cli("scan", "robot", "-o", "a.policy.xml", cwd=robot))[:1]
    assert line.startswith("a.policy.xml: is there already")


def test_try_goes_from_a_checkout_to_the_way_out(cli: Cli, robot: Path) -> None:
    done = cli("try", "robot", cwd=robot)
    assert done.returncode == UNDETERMINED
    assert "/robot/camera -> /robot/image -> /uploader" in done.stdout
    assert "requests" in done.stdout


@pytest.mark.parametrize("command", [("suggest",), ("labels", "--init", "-o", "-"), ("graph", "-f", "mermaid")])
@pytest.mark.parametrize("name", ["robot", "robot/launch/guide.launch.py"])
def test_other_commands_take_a_folder_or_a_launch_file(
    cli: Cli, robot: Path, command: tuple[str, ...], name: str
) -> None:
    done = cli(*command, name, cwd=robot)
    assert done.returncode in (0, UNDETERMINED), done.stderr
    assert "/robot/image" in done.stdout or "robot/camera" in done.stdout


def test_the_verdict_of_code_is_undetermined_at_best(cli: Cli, robot: Path) -> None:
    reviewed = LABELS.replace("{leak: [Video]}", "conduit") + "channels:\n  /robot/image: sensitive\n"
    (robot / "l.yaml").write_text(reviewed)
    assert cli("analyze", "robot", "-l", "l.yaml", cwd=robot).returncode == UNDETERMINED


def test_sarif_results_stand_at_lines_of_the_code(cli: Cli, robot: Path) -> None:
    log = json.loads(cli("analyze", "robot", "-l", "l.yaml", "-f", "sarif", cwd=robot).stdout)
    uris = {
        place["physicalLocation"]["artifactLocation"]["uri"]
        for result in log["runs"][0]["results"]
        for place in result["locations"]
    }
    assert "robot/guide/uploader.py" in uris


def test_a_folder_with_a_policy_is_read_as_a_policy_and_scanned_as_code(cli: Cli, robot: Path) -> None:
    cli("scan", "robot", "-o", "r.policy.xml", cwd=robot)
    (robot / "r.policy.xml").rename(robot / "robot" / "r.policy.xml")
    assert "2 nodes, 2 channels" in cli("scan", "robot", cwd=robot).stdout
    done = cli("analyze", "robot", "-l", "l.yaml", cwd=robot)
    assert done.returncode == LEAK
    assert "source code of ROS 2 lies in robot, and is not read" in done.stdout
    assert "source code of ROS 2 lies" not in cli("analyze", "robot/r.policy.xml", "-l", "l.yaml", cwd=robot).stdout


@pytest.mark.parametrize(
    "words",
    [("nope",), ("robot", "l.yaml"), ("robot", "--launch", "nope"), ("robot", "robot", "--launch", "a"), ("l.yaml",)],
)
def test_bad_input_is_refused(cli: Cli, robot: Path, words: tuple[str, ...]) -> None:
    assert cli("scan", *words, cwd=robot).returncode in (BAD, UNDETERMINED if words[0] == words[-1] == "robot" else BAD)


def test_what_code_uses_is_evidence_for_suggestions(cli: Cli, robot: Path) -> None:
    assert "requests" in cli("suggest", "robot", cwd=robot).stdout


def test_a_project_can_begin_with_a_checkout(cli: Cli, robot: Path) -> None:
    assert cli("init", "--from-try", "robot", cwd=robot).returncode == 0
    assert "requests" in (robot / "robot.labels.yaml").read_text()
    assert cli("analyze", cwd=robot).returncode == UNDETERMINED


def test_a_folder_without_nodes_is_said_to_have_none(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "a.py").write_text("print('hello')\n")
    assert "no ROS 2 node" in refused(cli("analyze", "code", cwd=tmp_path))[0]
    assert cli("scan", "code", "-o", "p.xml", cwd=tmp_path).returncode == UNDETERMINED
    assert not (tmp_path / "p.xml").exists()


CAM = "nodl_version: 2\npublishers:\n  - {name: image, type: sensor_msgs/msg/Image}\n"
UP = "nodl_version: 2\nsubscriptions:\n  - {name: image, type: sensor_msgs/msg/Image}\n"


def test_descriptions_alone_lead_to_a_finding_at_their_lines(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "d").mkdir()
    (tmp_path / "d" / "camera.nodl.yaml").write_text(CAM)
    (tmp_path / "d" / "uploader.nodl.yaml").write_text(UP)
    (tmp_path / "l.yaml").write_text(LABELS.replace("/robot", ""))
    done = cli("analyze", "d", "-l", "l.yaml", "-f", "json", cwd=tmp_path)
    assert done.returncode == LEAK, done.stderr
    steps = json.loads(done.stdout)["findings"][0]["steps"]
    lines = [(line["file"], line["line"], line["basis"]) for step in steps for line in step["policy"]]
    assert lines == [("d/camera.nodl.yaml", 3, "description"), ("d/uploader.nodl.yaml", 3, "description")]
    assert cli("scan", "d", "-o", "r.policy.xml", cwd=tmp_path).returncode == UNDETERMINED
    written = cli("analyze", "r.policy.xml", "-l", "l.yaml", "--types", "r.types.yaml", "-f", "json", cwd=tmp_path)
    assert json.loads(written.stdout)["findings"][0]["steps"] == steps


@pytest.mark.parametrize("command", ["scan", "try", "suggest", "graph", "lint"])
def test_a_description_stands_where_a_policy_does(cli: Cli, tmp_path: Path, command: str) -> None:
    (tmp_path / "camera.nodl.yaml").write_text(CAM)
    done = cli(command, "camera.nodl.yaml", cwd=tmp_path)
    assert (done.returncode in (0, UNDETERMINED), "/camera" in done.stdout) == (True, command != "lint"), done.stderr


def test_a_description_that_cannot_be_read_is_one_line(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "camera.nodl.yaml").write_text("nodl_version: 3\n")
    (line,) = refused(cli("analyze", "camera.nodl.yaml", cwd=tmp_path))
    assert line.startswith("camera.nodl.yaml:1: ")
